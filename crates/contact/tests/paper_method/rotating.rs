//! Figure 5: turning in contact hands over to a new pair of points.
//!
//! After a hand-over the tool touches at the nearest pair and all others are further away, so what is left is the tolerance below
//! which an overlap is not looked at (1e-9 m) and the rounding of the query.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4};

use glam::{DQuat, DVec3};
use pliant_contact::PaperEvent;
use pliant_spatial::Pose;

use crate::scene::{Bench, MM, aligned, corner_up, cuboid, mm, obstacle, placed, rod};

const OVERLAP: f64 = 1.1e-9;

#[test]
fn fig5_on_a_face() {
    let middle = mm(50.0, 0.0, 0.0);
    let above = placed(DQuat::IDENTITY, middle, mm(0.0, 0.0, 28.5));
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), rod(3.0 * MM, 1), above);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    // Tip down, then tip up: one of the two dips the end that was not in contact.
    for (pitch, end) in [(10.0_f64, 100.0), (-10.0, 0.0)] {
        let turned = placed(
            DQuat::from_rotation_y(pitch.to_radians()),
            middle,
            mm(0.0, 0.0, 27.0),
        );
        let log = bench.lead_about(middle, &turned, 40);
        assert!(log.deepest < OVERLAP && log.widest < 1e-6, "{log:?}");
        let outcome = bench.advance(&turned);
        let point = outcome.tool_point.unwrap();
        assert!(
            (point.x - end * MM).abs() < 1e-9 && (point.z + 3.0 * MM).abs() < 1e-9,
            "{point}"
        );
        // The lower end rests on the face: height of the handle from the geometry of the turned rod.
        let lowest = outcome.world_from_visual.transform_point(point);
        assert!((lowest.z - 25.0 * MM).abs() < 1e-9);
    }
    let back = placed(DQuat::from_rotation_y(0.1), middle, mm(0.0, 0.0, 27.0));
    assert!(bench.lead_about(middle, &back, 40).backed_off());
}

#[test]
fn fig5_with_tool_edge_on_object_edge() {
    // Rolled about its own axis past 45° the rod leaves the box edge with one of its edges and meets it with the next.
    let out = DVec3::new(1.0, 0.0, 1.0) * FRAC_1_SQRT_2;
    let along = DVec3::new(1.0, 0.0, -1.0) * FRAC_1_SQRT_2;
    let edge_down = DVec3::new(0.0, 1.0, 1.0) * FRAC_1_SQRT_2;
    let rotation = aligned([DVec3::X, edge_down], [along, out]);
    let middle = mm(50.0, 0.0, 0.0);
    let on_edge = mm(50.0, 8.0, 25.0);
    let half_diagonal = 3.0 * MM * std::f64::consts::SQRT_2;
    let above = placed(rotation, middle, on_edge + (half_diagonal + 0.5 * MM) * out);
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), rod(3.0 * MM, 1), above);
    // Flat, the rod is 4.24 − 3 mm thinner: pressed in further than that.
    bench.lead_by(-2.5 * MM * out, 50);
    let first = bench.advance(&bench.tracker.world_from_haptic());
    let first = first.tool_point.unwrap();
    assert!(first.distance(mm(50.0, -3.0, -3.0)) < 1e-9, "{first}");

    let half_turn = DQuat::from_axis_angle(along, 0.75 * FRAC_PI_4) * rotation;
    let turned = DQuat::from_axis_angle(along, 1.5 * FRAC_PI_4) * rotation;
    let depth = bench.tracker.world_from_haptic().transform_point(middle);
    let same = bench.lead_about(middle, &placed(half_turn, middle, depth), 30);
    let log = bench.lead_about(middle, &placed(turned, middle, depth), 30);
    assert!(!same.backed_off() && log.backed_off(), "{same:?} {log:?}");
    assert!(log.deepest < OVERLAP && same.deepest < OVERLAP, "{log:?}");
    // The strip that stands for the box edge is as high above it as its half width allows.
    assert!(log.widest < 0.5e-4 && same.widest < 0.5e-4, "{log:?}");
    let now = bench.advance(&bench.tracker.world_from_haptic());
    let point = now.tool_point.unwrap();
    let same_edge = (point - first).with_x(0.0).length();
    assert!(
        (same_edge - 6.0 * MM).abs() < 1e-6,
        "{point}: the next edge is 6 mm away"
    );
}

#[test]
fn fig5_with_tool_face_on_object_vertex() {
    // The box edge that falls towards +x does so at atan(1/√2) = 35.26°: a rod tilted further meets it with its tip.
    let on_tool = mm(50.0, 0.0, -3.0);
    let above = placed(DQuat::IDENTITY, on_tool, mm(0.0, 0.0, 0.5));
    let mut bench = Bench::new(corner_up(), rod(3.0 * MM, 1), above);
    bench.lead_by(mm(0.0, 0.0, -3.5), 70);
    let tilted = |degrees: f64| {
        let turn = DQuat::from_rotation_y(degrees.to_radians());
        placed(turn, on_tool, mm(0.0, 0.0, -3.0))
    };
    let below = bench.lead_about(on_tool, &tilted(35.0), 70);
    assert!(below.events.is_empty(), "{below:?}");
    assert!(below.deepest < OVERLAP && below.widest < 1e-9, "{below:?}");
    let beyond = bench.lead_about(on_tool, &tilted(40.0), 10);
    let handed_over = beyond.events.iter().find_map(|e| match e {
        PaperEvent::BackedOff { from, to, .. } => Some((*from, *to)),
        _ => None,
    });
    let (from, to) = handed_over.unwrap();
    assert!(from.distance(on_tool) < 1e-9);
    assert!(
        (to.x - 100.0 * MM).abs() < 1e-9 && (to.z + 3.0 * MM).abs() < 1e-9,
        "{to}"
    );
    assert!(
        beyond.deepest < OVERLAP && beyond.widest < 0.5e-4,
        "{beyond:?}"
    );
}
