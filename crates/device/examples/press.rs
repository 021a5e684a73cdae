//! Plays a press of 20 mm through a workspace map and prints what the world sees of it.
#![allow(clippy::print_stdout, reason = "the table is the result")]

use std::error::Error;

use glam::DVec3;
use pliant_device::{HapticDevice, ScriptedDevice, TimedPose, Trajectory, WorkspaceMap};
use pliant_spatial::{Pose, Wrench};

/// A spring in the world that pushes up below z = 0 [N/m].
const FLOOR_STIFFNESS: f64 = 500.0;

fn main() -> Result<(), Box<dyn Error>> {
    let samples =
        [(0.0, 0.01), (0.25, 0.0), (0.5, -0.01), (1.0, 0.01)].map(|(time, z)| TimedPose {
            time,
            pose: Pose::from_translation(DVec3::Z * z),
        });
    let mut device = ScriptedDevice::new("press", Trajectory::new(&samples)?);
    let map = WorkspaceMap::new(Pose::IDENTITY, 2.0, 0.5)?;
    println!(
        "{}: actuated {:?}",
        device.info().name,
        device.info().actuated
    );
    println!("time [s]  world z [mm]  world v [mm/s]  device force [N]");
    for step in 0..=10 {
        let time = f64::from(step) / 10.0;
        let state = map.state_to_world(&device.read(time)?);
        let depth = (-state.pose.translation.z).max(0.0);
        let force = DVec3::Z * (FLOOR_STIFFNESS * depth);
        device.write(&map.wrench_to_device(&Wrench::from_force_at(force, DVec3::ZERO)))?;
        println!(
            "{time:8.2} {:13.2} {:15.1} {:17.3}",
            state.pose.translation.z * 1e3,
            state.twist.linear.z * 1e3,
            device.last_wrench().force.z
        );
    }
    Ok(())
}
