//! The method of the paper breaks an invariant, and the judge sees it.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec3};
use pliant_contact::PaperParameters;
use pliant_sim::Method;
use pliant_spatial::Pose;
use pliant_tests::bodies::{Setting, ToolKind, world};
use pliant_tests::judge::{cone_residual, fresh_planes};
use pliant_tests::motion::{RADII, play};

use crate::contact_share;

/// The lowest corner of a rod that leans by 10° goes round the ellipsoid's pole at 0.1 m/s in circles of 38 mm, from 1 mm over the
/// surface to 1–3 mm under it.
fn circling(t: f64) -> Pose {
    let rotation =
        DQuat::from_rotation_x(10.0_f64.to_radians()) * DQuat::from_rotation_y(FRAC_PI_2);
    let depth = if t < 1.0 {
        3e-3 * t - 1e-3
    } else {
        2e-3 - 1e-3 * (TAU * 0.2 * (t - 1.0)).sin()
    };
    let (y, x) = (0.1 / 0.038 * t).sin_cos();
    let (x, y) = (0.038 * x, 0.038 * y);
    let z = RADII.z * (1.0 - (x / RADII.x).powi(2) - (y / RADII.y).powi(2)).sqrt();
    let lowest = DVec3::new(0.1, -3e-3, -3e-3);
    Pose::new(rotation, DVec3::new(x, y, z - depth) - rotation * lowest)
}

/// Largest cone residual on contact ticks of 10 s [m].
fn residual(method: Method) -> f64 {
    let world = world(Setting::LatitudeLongitude, ToolKind::Rod.tool(1), method);
    let whole = ToolKind::Rod.tool(1).segments.remove(0);
    let outputs = play(&world, circling, 10_000);
    assert!(contact_share(&outputs) > 0.9, "{method:?}");
    outputs
        .iter()
        .filter(|output| output.contacts > 0)
        .map(|output| {
            let visual = output.world_from_visual;
            let planes = fresh_planes(world.obstacles(), &whole, &visual);
            let push = visual.translation - output.world_from_haptic.translation;
            cone_residual(&planes, push)
        })
        .fold(0.0, f64::max)
}

/// Increments along the tracked feature drift away from the place nearest to the hand; planes solved together do not.
#[test]
fn the_cone_residual_tells_drift_from_the_nearest_free_place() {
    let paper = residual(Method::Paper(PaperParameters::default()));
    assert!(paper > 0.01, "{paper} m, drift of more than 10 mm expected");
    let constrained = residual(Method::Constrained);
    assert!(constrained <= 1e-8, "{constrained:e} m");
}
