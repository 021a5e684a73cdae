//! Analytic hand motions: haptic handle pose as a function of time [s].

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use pliant_sim::{State, TickInput, TickOutput, World, tick};
use pliant_spatial::Pose;

use crate::bodies::{TOOL_LENGTH, handle_with_tip};
use crate::campaign::PERIOD;

/// Half axes of the campaign ellipsoids [m].
pub const RADII: DVec3 = DVec3::new(0.06, 0.05, 0.04);

/// Runs `ticks` ticks along a motion from its start and collects every output.
pub fn play(world: &World, motion: impl Fn(f64) -> Pose, ticks: u32) -> Vec<TickOutput> {
    let mut state = State::new(world, motion(0.0));
    (1..=ticks)
        .map(|index| {
            let input = TickInput {
                world_from_haptic: motion(f64::from(index) * PERIOD),
            };
            tick(world, &mut state, &input, PERIOD)
        })
        .collect()
}

/// The tool's tip circles the ellipsoid `depth` [m] under its surface, 60° above the equator plane tilted, one turn in 4 s (about 0.06 m/s); the tool leans
/// 30° from the surface normal. It starts outside and sinks in within 0.2 s.
pub fn tip_slide(depth: f64) -> impl Fn(f64) -> Pose {
    move |t| {
        let angle = TAU * t / 4.0;
        let up = DVec3::new(0.7 * angle.cos(), 0.7 * angle.sin(), 0.714).normalize();
        let sunk = depth * (t / 0.2).min(1.0) - 1e-3 * (1.0 - t / 0.2).max(0.0);
        let surface = up * RADII;
        let normal = (up / RADII).normalize();
        let lean = DQuat::from_axis_angle(normal.any_orthonormal_vector(), 0.52);
        handle_with_tip(surface - normal * sunk, -(lean * normal))
    }
}

/// The tool lies across the top of the ellipsoid `depth` [m] deep, its middle over the pole, and wanders by ±3 mm; it also turns about the vertical when
/// `turning` [rad/s] is not zero.
pub fn shaft_slide(depth: f64, turning: f64) -> impl Fn(f64) -> Pose {
    move |t| {
        let heading = DQuat::from_rotation_z(0.3 + turning * t);
        let axis = heading * DVec3::new(1.0, 0.0, -0.05).normalize();
        let sunk = depth * (t / 0.2).min(1.0) - 4e-3 * (1.0 - t / 0.2).max(0.0);
        let middle = DVec3::new(
            0.003 * (TAU * t / 0.7).sin(),
            0.003 * (TAU * t / 0.5).sin(),
            RADII.z + 3e-3 - sunk,
        );
        let rotation =
            heading * DQuat::from_rotation_arc(DVec3::X, DVec3::new(1.0, 0.0, -0.05).normalize());
        Pose::new(rotation, middle - axis * (0.5 * TOOL_LENGTH))
    }
}

/// A tool with the given axis, its middle moving straight down from `from` at `speed` [m/s] until `travel` [m], then resting.
pub fn press(axis: DVec3, from: DVec3, speed: f64, travel: f64) -> impl Fn(f64) -> Pose {
    let axis = axis.normalize();
    move |t| {
        let middle = from - DVec3::Z * (speed * t).min(travel);
        handle_with_tip(middle + axis * (0.5 * TOOL_LENGTH), axis)
    }
}
