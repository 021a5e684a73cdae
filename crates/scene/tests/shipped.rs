//! The shipped scenes load from their folder and show what their README says.
#![allow(clippy::unwrap_used, reason = "a failed step fails the test")]

use std::path::{Path, PathBuf};

use pliant_scene::{Disk, Scene, read_trajectory};
use pliant_sim::{State, TickInput, tick, visual_penetration};

const NAMES: [&str; 6] = [
    "any_mesh",
    "probe_on_box",
    "probe_on_ellipsoid",
    "probe_through_plate",
    "slot",
    "two_objects",
];

fn scene(name: &str) -> Scene {
    let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let path = folder.join(format!("{name}.ron"));
    let text = std::fs::read_to_string(&path).unwrap();
    Scene::from_str(&text, &path.display().to_string()).unwrap()
}

#[test]
fn all_scenes_are_listed_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut found: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    found.sort();
    assert_eq!(found, NAMES);
}

/// A direction that passes the one place where the generator's frame is undefined would spin the tool about its own axis
/// from one row to the next.
#[test]
fn every_shipped_motion_is_one_that_a_hand_can_make() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/trajectories");
    let mut motions = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.display().to_string();
        let motion = read_trajectory(&std::fs::read(&path).unwrap(), &name).unwrap();
        motions += 1;
        let ticks = (0..).map(|tick| motion.start() + f64::from(tick) * 1e-3);
        for time in ticks.take_while(|time| *time <= motion.end()) {
            let (_, twist) = motion.sample(time);
            let (linear, angular) = (twist.linear.length(), twist.angular.length());
            assert!(linear <= 0.2, "{name}, {time} s: {linear} m/s");
            assert!(angular <= 3.0, "{name}, {time} s: {angular} rad/s");
        }
    }
    assert_eq!(motions, NAMES.len());
}

#[test]
fn a_third_of_each_run_is_contact_at_forces_a_hand_applies() {
    for name in NAMES {
        let built = scene(name).build(&Disk).unwrap();
        let dt = 1.0 / f64::from(built.rate_hz);
        let start = built.trajectory.start();
        let pose = |time: f64| built.trajectory.sample(start + time).0;
        let mut state = State::new(&built.world, pose(0.0));
        let (mut ticks, mut contacts, mut force, mut speed) = (0_u32, 0_u32, 0.0_f64, 0.0_f64);
        while f64::from(ticks) * dt < built.seconds {
            let time = f64::from(ticks) * dt;
            let input = TickInput {
                world_from_haptic: pose(time),
            };
            let output = tick(&built.world, &mut state, &input, dt);
            assert!(
                visual_penetration(&built.world, &state) <= 1e-9,
                "{name} at {time} s"
            );
            ticks += 1;
            contacts += u32::from(output.contacts > 0);
            force = force.max(output.wrench.force.length());
            // Of the tip, 100 mm from the handle.
            let tip = |time| pose(time).transform_point(glam::DVec3::X * 0.1);
            speed = speed.max((tip(time + dt) - tip(time)).length() / dt);
        }
        assert!(
            (6.0..=10.0).contains(&built.seconds),
            "{name}: {} s",
            built.seconds
        );
        assert!(
            3 * contacts >= ticks,
            "{name}: {contacts} of {ticks} ticks in contact"
        );
        assert!((2.0..=8.0).contains(&force), "{name}: {force} N");
        assert!(speed <= 0.2, "{name}: {speed} m/s");
    }
}
