//! Trajectories from any bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::judge_place;
use pliant_scene::read_trajectory;

const FILE: &str = "m.csv";

fuzz_target!(|bytes: &[u8]| {
    let trajectory = match read_trajectory(bytes, FILE) {
        Ok(trajectory) => trajectory,
        Err(error) => return judge_place(&error, FILE, bytes),
    };
    let (start, end) = (trajectory.start(), trajectory.end());
    assert!(start <= end && start.is_finite() && end.is_finite());
    for part in 0..=8 {
        let (pose, twist) = trajectory.sample(start + (end - start) * f64::from(part) / 8.0);
        assert!(pose.is_placement(), "{pose:?}");
        assert!(
            !twist.linear.is_nan() && !twist.angular.is_nan(),
            "{twist:?}"
        );
    }
    if let Ok(faster) = trajectory.retimed(3.0) {
        assert!(faster.duration() <= trajectory.duration());
    }
});
