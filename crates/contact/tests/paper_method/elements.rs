//! Section 6: the tool in ten elements; the one that meets the object becomes the Contact Element.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec3};
use pliant_contact::PaperEvent;
use pliant_spatial::Pose;

use crate::scene::{Bench, Log, MM, aligned, corner_up, cuboid, mm, obstacle, placed, rod};

/// Contact Elements in the order in which they took over.
fn elements(log: &Log) -> Vec<u32> {
    let changes = log.events.iter();
    changes
        .filter_map(|e| match e {
            PaperEvent::ElementChanged { to, .. } => Some(*to),
            _ => None,
        })
        .collect()
}

#[test]
fn turning_on_a_face_changes_the_contact_element() {
    let middle = mm(50.0, 0.0, 0.0);
    let pitched = |degrees: f64, z: f64| {
        let turn = DQuat::from_rotation_y(degrees.to_radians());
        placed(turn, middle, mm(0.0, 0.0, z))
    };
    let mut bench = Bench::new(
        obstacle(cuboid(), Pose::IDENTITY),
        rod(3.0 * MM, 10),
        pitched(10.0, 40.0),
    );
    // Tip down by sin(10°)·50 mm + cos(10°)·3 mm = 11.6 mm under the middle.
    let touched = bench.lead(&pitched(10.0, 27.0), 130);
    assert!(touched.events.contains(&PaperEvent::Detected {
        object: 0,
        segment: 9
    }));
    let log = bench.lead_about(middle, &pitched(-10.0, 27.0), 200);
    assert_eq!(elements(&log).last(), Some(&0), "{log:?}");
    assert!(log.deepest < 1.1e-9 && log.widest < 1e-6, "{log:?}");
}

#[test]
fn tool_edge_on_object_edge_passes_from_element_to_element() {
    let out = DVec3::new(1.0, 0.0, 1.0) * FRAC_1_SQRT_2;
    let along = DVec3::new(1.0, 0.0, -1.0) * FRAC_1_SQRT_2;
    let edge_down = DVec3::new(0.0, 1.0, 1.0) * FRAC_1_SQRT_2;
    let rotation = aligned([DVec3::X, edge_down], [along, out]);
    let on_edge = mm(50.0, 8.0, 25.0);
    let above = placed(rotation, mm(55.0, -3.0, -3.0), on_edge + 0.5 * MM * out);
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), rod(3.0 * MM, 10), above);
    bench.lead_by(-1.5 * MM * out, 30);
    let start = bench.advance(&bench.tracker.world_from_haptic());
    assert_eq!(start.contact.unwrap().segment, 5);
    let log = bench.lead_by(25.0 * MM * along, 500);
    assert_eq!(elements(&log), [4, 3], "{log:?}");
    assert!(log.deepest < 1.1e-9 && log.widest < 1e-9, "{log:?}");

    // Turned about the box edge to 5° past the side face, which ends 50 mm below: the element 50 mm / cos 5° further along takes over.
    let pivot = mm(30.0, -3.0, -3.0);
    let turned = DQuat::from_rotation_y(50.0_f64.to_radians()) * rotation;
    let at = bench.tracker.world_from_haptic().transform_point(pivot);
    let log = bench.lead_about(pivot, &placed(turned, pivot, at), 100);
    assert_eq!(elements(&log), [8], "{log:?}");
    let point = bench.advance(&bench.tracker.world_from_haptic()).tool_point;
    let below = 30.0 * MM + 50.0 * MM / 5.0_f64.to_radians().cos();
    assert!((point.unwrap().x - below).abs() < 1.0 * MM, "{point:?}");
    assert!(log.deepest < 1.1e-9, "{log:?}");
}

#[test]
fn tool_face_on_object_vertex_passes_from_element_to_element() {
    let above = placed(DQuat::IDENTITY, mm(55.0, 0.0, -3.0), mm(0.0, 0.0, 0.5));
    let mut bench = Bench::new(corner_up(), rod(3.0 * MM, 10), above);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let log = bench.lead_by(mm(25.0, 0.0, 0.0), 250);
    assert_eq!(elements(&log), [4, 3], "{log:?}");
    assert!(log.deepest < 1.1e-9 && log.widest < 1e-9, "{log:?}");

    let pivot = mm(30.0, 0.0, -3.0);
    let deeper = bench.lead_by(mm(0.0, 0.0, -2.0), 40);
    assert!(deeper.events.is_empty(), "{deeper:?}");
    let turned = DQuat::from_rotation_y(40.0_f64.to_radians());
    let log = bench.lead_about(pivot, &placed(turned, pivot, mm(0.0, 0.0, -3.0)), 80);
    assert_eq!(elements(&log).last(), Some(&9), "{log:?}");
    assert!(log.deepest < 1.1e-9, "{log:?}");
}
