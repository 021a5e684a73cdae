//! The curve against closed forms, and what happens to awkward time stamps.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use pliant_spatial::{Pose, Twist, rotation_vector};
use proptest::prelude::*;

use super::{MergeReport, TimedPose, Trajectory, TrajectoryError};

fn at(time: f64, position: DVec3) -> TimedPose {
    TimedPose {
        time,
        pose: Pose::from_translation(position),
    }
}

fn along_x(rows: &[(f64, f64)]) -> Trajectory {
    let samples: Vec<_> = rows.iter().map(|&(t, x)| at(t, DVec3::X * x)).collect();
    Trajectory::new(&samples).unwrap()
}

fn x(trajectory: &Trajectory, time: f64) -> f64 {
    trajectory.sample(time).0.translation.x
}

/// Uneven times: gaps between 0.03 and 0.17 s.
fn uneven_times(count: usize) -> Vec<f64> {
    let mut time = -0.4;
    (0..count)
        .map(|i| {
            time += 0.03 + 0.07 * (1.0 + (i as f64 * 2.4).sin());
            time
        })
        .collect()
}

fn wavy(time: f64) -> DVec3 {
    DVec3::new((3.0 * time).sin(), (2.0 * time).cos(), time * time) * 0.05
}

#[test]
fn passes_through_its_samples() {
    let samples: Vec<_> = uneven_times(30).iter().map(|&t| at(t, wavy(t))).collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    assert_eq!(trajectory.merged(), MergeReport::default());
    for sample in &samples {
        let (pose, _) = trajectory.sample(sample.time);
        assert!((pose.translation - sample.pose.translation).length() < 1e-16);
    }
    assert_eq!(trajectory.knots().len(), 30);
    assert!((trajectory.duration() - (samples[29].time - samples[0].time)).abs() < 1e-15);
}

#[test]
fn linear_motion_is_exact() {
    let (offset, velocity) = (DVec3::new(0.1, -0.2, 0.3), DVec3::new(0.4, 0.05, -0.7));
    let times = uneven_times(25);
    let samples: Vec<_> = times
        .iter()
        .map(|&t| at(t, offset + velocity * t))
        .collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    for i in 0..1000 {
        let time = trajectory.start() + trajectory.duration() * f64::from(i) / 1000.0;
        let (pose, twist) = trajectory.sample(time);
        assert!((pose.translation - offset - velocity * time).length() < 1e-15);
        assert!((twist.linear - velocity).length() < 1e-13, "{time}");
    }
}

#[test]
fn cubic_polynomials_are_reproduced_away_from_the_ends() {
    let cubic = |t: f64| DVec3::new(t * t * t, 1.0 - 2.0 * t * t, 0.5 * t * t * t - t);
    let slope = |t: f64| DVec3::new(3.0 * t * t, -4.0 * t, 1.5 * t * t - 1.0);
    let samples: Vec<_> = uneven_times(120).iter().map(|&t| at(t, cubic(t))).collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    // The natural ends are wrong by the second derivative there; the error dies by 2 + √3 or so per knot: 40 knots in,
    // by about 1e-22.
    let (first, last) = (samples[40].time, samples[80].time);
    for i in 0..2000 {
        let time = first + (last - first) * f64::from(i) / 1999.0;
        let (pose, twist) = trajectory.sample(time);
        assert!((pose.translation - cubic(time)).length() < 1e-12, "{time}");
        assert!((twist.linear - slope(time)).length() < 1e-10, "{time}");
    }
    let near_end = trajectory.start() + 0.02;
    assert!((trajectory.sample(near_end).0.translation - cubic(near_end)).length() > 1e-7);
}

#[test]
fn ends_are_natural_and_held() {
    let samples: Vec<_> = uneven_times(20).iter().map(|&t| at(t, wavy(t))).collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    let (start, end, step) = (trajectory.start(), trajectory.end(), 1e-5);
    let velocity = |t: f64| trajectory.sample(t).1.linear;
    assert!((velocity(start + step) - velocity(start)).length() / step < 1e-3);
    assert!((velocity(end) - velocity(end - step)).length() / step < 1e-3);
    for (time, sample) in [(start - 1.0, samples[0]), (end + 1e-9, samples[19])] {
        let (pose, twist) = trajectory.sample(time);
        assert_eq!(pose.translation, sample.pose.translation);
        assert_eq!(twist, Twist::ZERO);
    }
    assert_eq!(
        trajectory.sample(f64::NAN).0,
        trajectory.sample(start - 1.0).0
    );
}

#[test]
fn a_turn_at_constant_rate_is_exact_also_through_sign_flips() {
    let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
    let rate = 4.0;
    let samples: Vec<_> = uneven_times(40)
        .iter()
        .enumerate()
        .map(|(i, &time)| {
            let rotation = DQuat::from_axis_angle(axis, rate * time);
            let rotation = if i % 3 == 0 { -rotation } else { rotation };
            TimedPose {
                time,
                pose: Pose::from_rotation(rotation),
            }
        })
        .collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    let mut previous = trajectory.sample(trajectory.start()).0.rotation;
    for i in 0..1000 {
        let time = trajectory.start() + trajectory.duration() * f64::from(i) / 1000.0;
        let (pose, twist) = trajectory.sample(time);
        let expected = DQuat::from_axis_angle(axis, rate * time);
        assert!(rotation_vector(pose.rotation * expected.conjugate()).length() < 1e-14);
        assert!((twist.angular - axis * rate).length() < 1e-12);
        assert!(previous.dot(pose.rotation) > 0.99, "sign flip at {time}");
        previous = pose.rotation;
    }
}

#[test]
fn half_a_turn_between_samples_keeps_to_its_reported_rate() {
    let samples = [0.0, 1.0].map(|time| TimedPose {
        time,
        pose: Pose::from_rotation(DQuat::from_rotation_y(PI * time)),
    });
    let trajectory = Trajectory::new(&samples).unwrap();
    let (middle, twist) = trajectory.sample(0.5);
    assert!((twist.angular.length() - PI).abs() < 1e-14);
    let turned = rotation_vector(middle.rotation);
    assert!((turned - twist.angular * 0.5).length() < 1e-14);
}

#[test]
fn a_single_sample_is_held() {
    let only = at(3.0, DVec3::new(1.0, 2.0, 3.0));
    let trajectory = Trajectory::new(&[only]).unwrap();
    for time in [-1.0, 3.0, 9.0] {
        assert_eq!(trajectory.sample(time), (only.pose, Twist::ZERO));
    }
    assert!(trajectory.duration().abs() < 1e-300);
}

#[test]
fn duplicates_are_averaged_and_counted() {
    let trajectory = along_x(&[
        (0.0, 0.0),
        (0.1, 0.1),
        (0.1, 0.3),
        (0.1 + 4e-10, 0.5),
        (0.2, 0.2),
        (0.2, 0.2),
    ]);
    let expected = MergeReport {
        duplicates: 3,
        near_duplicates: 0,
    };
    assert_eq!(trajectory.merged(), expected);
    let middle = trajectory.knots().nth(1).unwrap();
    assert!((middle.pose.translation.x - 0.3).abs() < 1e-16);
    // A row joins by its distance from the first row of the group, so a chain of tiny steps cannot swallow a recording.
    let rows: Vec<_> = (0..3000).map(|i| (f64::from(i) * 0.6e-9, 0.0)).collect();
    assert_eq!(along_x(&rows).merged().duplicates, 1500);
}

#[test]
fn stamps_of_the_size_of_unix_time_are_duplicates_within_their_resolution() {
    let start = 1.7e9;
    let next = f64::from_bits(f64::to_bits(start + 0.1) + 2);
    let rows = [
        (start, 0.0),
        (start + 0.1, 0.1),
        (next, 0.1),
        (start + 0.2, 0.2),
    ];
    assert_eq!(along_x(&rows).merged().duplicates, 1);
}

#[test]
fn duplicate_orientations_are_averaged_whatever_their_signs() {
    let turned = |angle: f64| Pose::from_rotation(DQuat::from_rotation_z(angle));
    let flipped = Pose::from_rotation(-DQuat::from_rotation_z(0.4));
    let samples = [(0.0, turned(0.0)), (1.0, turned(0.2)), (1.0, flipped)]
        .map(|(time, pose)| TimedPose { time, pose });
    let trajectory = Trajectory::new(&samples).unwrap();
    let angle = rotation_vector(trajectory.sample(1.0).0.rotation);
    assert!((angle - DVec3::Z * 0.3).length() < 1e-15);
}

/// Rows every 0.1 s along x = t/10, and one more row that comes `gap` after the fourth, 1 mm aside of it.
fn with_one_close_row(gap: f64) -> Vec<(f64, f64)> {
    let mut rows: Vec<_> = (0..10)
        .map(|i| (f64::from(i) * 0.1, f64::from(i) * 0.01))
        .collect();
    rows.insert(4, (0.3 + gap, 0.1 * (0.3 + gap) + 0.001));
    rows
}

#[test]
fn near_duplicates_do_not_throw_the_curve() {
    let jump = 0.001;
    for gap in [1e-8, 1e-6, 1e-4, 4.9e-3, 5.1e-3, 2e-2, 5e-2] {
        let trajectory = along_x(&with_one_close_row(gap));
        let merged = usize::from(gap < 0.05 * 0.1);
        assert_eq!(trajectory.merged().near_duplicates, merged, "{gap}");
        let mut swing = 0.0_f64;
        for i in 0..5000 {
            let time = 0.9 * f64::from(i) / 4999.0;
            swing = swing.max((x(&trajectory, time) - 0.1 * time).abs());
        }
        assert!(swing < 4.0 * jump, "gap {gap}: {swing} m off");
    }
}

#[test]
fn a_burst_of_faster_samples_is_kept() {
    let mut rows: Vec<_> = (0..5).map(|i| (f64::from(i) * 0.1, 0.0)).collect();
    rows.extend((1..=6).map(|i| (0.4 + f64::from(i) * 0.001, 0.0)));
    rows.extend((5..10).map(|i| (f64::from(i) * 0.1, 0.0)));
    assert_eq!(along_x(&rows).merged(), MergeReport::default());
}

#[test]
fn refusals_name_the_row_and_the_number() {
    let good = [
        at(0.0, DVec3::ZERO),
        at(0.1, DVec3::X),
        at(0.2, DVec3::ZERO),
    ];
    let refuse = |change: &dyn Fn(&mut TimedPose)| {
        let mut samples = good;
        change(&mut samples[2]);
        Trajectory::new(&samples).unwrap_err()
    };
    let cases = [
        (refuse(&|s| s.time = f64::NAN), "time"),
        (refuse(&|s| s.time = 1e13), "seconds"),
        (
            refuse(&|s| s.pose.translation.y = f64::INFINITY),
            "position y",
        ),
        (refuse(&|s| s.pose.translation.z = -2e6), "metres"),
        (refuse(&|s| s.pose.rotation.w = f64::NAN), "quaternion w"),
        (refuse(&|s| s.pose.rotation.w = 1.002), "norm 1.002"),
        (refuse(&|s| s.time = 0.05), "before 0.1 s"),
    ];
    for (error, words) in cases {
        assert_eq!(error.row(), Some(2), "{error}");
        assert!(error.to_string().contains(words), "{error}");
        assert!(error.to_string().contains("sample 2"), "{error}");
    }
    assert_eq!(Trajectory::new(&[]), Err(TrajectoryError::Empty));
    let mut nearly_unit = good;
    nearly_unit[1].pose.rotation.w = 1.0009;
    let rotation = Trajectory::new(&nearly_unit)
        .unwrap()
        .sample(0.1)
        .0
        .rotation;
    assert!((rotation.length() - 1.0).abs() < 1e-15);
}

#[test]
fn mapping_commutes_with_sampling() {
    let samples: Vec<_> = uneven_times(30)
        .iter()
        .map(|&time| TimedPose {
            time,
            pose: Pose::new(DQuat::from_scaled_axis(wavy(time) * 20.0), wavy(time)),
        })
        .collect();
    let trajectory = Trajectory::new(&samples).unwrap();
    let placement = Pose::new(
        DQuat::from_scaled_axis(DVec3::new(0.3, 0.9, -1.2)),
        DVec3::new(1.0, -2.0, 0.5),
    );
    let (scale, speed) = (2.5, 3.0);
    let mapped = trajectory
        .mapped(&placement, scale)
        .unwrap()
        .retimed(speed)
        .unwrap();
    assert!((mapped.duration() - trajectory.duration() / speed).abs() < 1e-14);
    for i in 0..500 {
        let elapsed = trajectory.duration() * f64::from(i) / 500.0;
        let (pose, twist) = trajectory.sample(trajectory.start() + elapsed);
        let (new_pose, new_twist) = mapped.sample(mapped.start() + elapsed / speed);
        let position = placement.transform_point(pose.translation * scale);
        assert!((new_pose.translation - position).length() < 1e-14);
        assert!(new_pose.rotation.dot(placement.rotation * pose.rotation) > 1.0 - 1e-14);
        let linear = placement.transform_vector(twist.linear * scale * speed);
        assert!((new_twist.linear - linear).length() < 1e-11);
        // At a knot rounding of the time may choose either segment.
        let angular = placement.transform_vector(twist.angular * speed);
        let near_knot = samples
            .iter()
            .any(|s| (s.time - trajectory.start() - elapsed).abs() < 1e-9);
        assert!(near_knot || (new_twist.angular - angular).length() < 1e-11);
    }
}

#[test]
fn impossible_mappings_are_refused() {
    let trajectory = along_x(&[(0.0, 0.0), (1.0, 1.0)]);
    let not_positive =
        |result: Result<Trajectory, _>| matches!(result, Err(TrajectoryError::NotPositive { .. }));
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(not_positive(trajectory.mapped(&Pose::IDENTITY, bad)));
        assert!(not_positive(trajectory.retimed(bad)));
    }
    let far = trajectory.mapped(&Pose::IDENTITY, 1e300);
    assert!(matches!(
        far,
        Err(TrajectoryError::OutOfRange { row: 1, .. })
    ));
    let nowhere = Pose::from_translation(DVec3::NAN);
    let placed = trajectory.mapped(&nowhere, 1.0);
    assert!(matches!(placed, Err(TrajectoryError::Placement { .. })));
    for speed in [1e-300, 1e300] {
        assert_eq!(
            trajectory.retimed(speed),
            Err(TrajectoryError::Speed { speed })
        );
    }
}

proptest! {
    /// Position, velocity and acceleration agree on both sides of every knot, and velocity is the derivative of position.
    #[test]
    fn the_curve_is_twice_continuously_differentiable(
        rows in prop::collection::vec((0.02..0.2_f64, -0.1..0.1_f64, -0.1..0.1_f64), 3..25),
    ) {
        let mut time = 0.0;
        let samples: Vec<_> = rows
            .iter()
            .map(|&(gap, x, y)| {
                time += gap;
                at(time, DVec3::new(x, y, x - y))
            })
            .collect();
        let trajectory = Trajectory::new(&samples).unwrap();
        prop_assert_eq!(trajectory.knots().len(), samples.len());
        let step = 1e-6;
        let position = |t: f64| trajectory.sample(t).0.translation;
        let velocity = |t: f64| trajectory.sample(t).1.linear;
        for sample in &samples[1..samples.len() - 1] {
            let knot = sample.time;
            let before = (velocity(knot) - velocity(knot - step)) / step;
            let after = (velocity(knot + step) - velocity(knot)) / step;
            // The third derivative jumps, by up to some 1e5 m/s³ here.
            prop_assert!((after - before).length() < 1e6 * step, "{} {}", before, after);
            for t in [knot, knot + 0.013] {
                if t + step < trajectory.end() {
                    let derivative = (position(t + step) - position(t - step)) / (2.0 * step);
                    prop_assert!((derivative - velocity(t)).length() < 1e-7);
                }
            }
        }
    }
}

#[test]
fn refused_numbers_are_printed_with_exponents() {
    let refused = |samples: &[TimedPose]| Trajectory::new(samples).unwrap_err().to_string();
    let far = refused(&[at(0.0, DVec3::X * 1e300)]);
    assert!(far.contains("is 1e300, beyond"), "{far}");
    let late = refused(&[at(1e-300, DVec3::ZERO), at(-1e-300, DVec3::ZERO)]);
    assert!(late.contains("time -1e-300 s is before 1e-300 s"), "{late}");
    let mut turned = at(0.0, DVec3::ZERO);
    turned.pose.rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 1e-100);
    let turned = refused(&[turned]);
    assert!(turned.contains("norm 1e-100,"), "{turned}");
    let slow = along_x(&[(0.0, 0.0), (1.0, 1.0)]).retimed(-1e-300);
    let slow = slow.unwrap_err().to_string();
    assert!(slow.contains("is -1e-300;"), "{slow}");
    let fast = TrajectoryError::Speed { speed: 1e300 }.to_string();
    assert!(fast.contains("speed 1e300 leaves"), "{fast}");
    let pose = Pose::from_translation(DVec3::new(1e300, -1e-300, 0.0));
    let placed = TrajectoryError::Placement { pose }.to_string();
    assert!(placed.contains("(1e300, -1e-300, 0.0) m"), "{placed}");
}
