//! The torque a hand feels when a 100 mm tool is pushed sideways at its tip.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use glam::{DQuat, DVec3};
use pliant_spatial::{Pose, Wrench};

fn main() {
    let world_from_handle = Pose::new(
        DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
        DVec3::new(0.0, 0.0, 0.05),
    );
    let tip_in_handle = DVec3::new(0.1, 0.0, 0.0);
    let tip = world_from_handle.transform_point(tip_in_handle);
    let load = Wrench::from_force_at(DVec3::X * 2.0, tip - world_from_handle.translation);
    println!(
        "tip at {tip} m; 2 N along x there is {} N·m at the handle",
        load.torque
    );
}
