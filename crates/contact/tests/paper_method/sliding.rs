//! Figure 4: the tool slides over an edge or a corner and a ray finds its new contact point.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec3};
use pliant_contact::PaperEvent;
use pliant_mesh::Feature;
use pliant_spatial::Pose;

use crate::scene::{Bench, MM, aligned, corner_up, cuboid, mm, obstacle, placed, rod};

/// Tip down by `pitch` beyond the box edge x = 50 mm, the underside's middle `above` [m] over the edge.
fn over_the_edge(pitch: f64, above: f64) -> Pose {
    let rotation = DQuat::from_rotation_y(pitch);
    let normal = rotation * DVec3::Z;
    placed(
        rotation,
        mm(50.0, 0.0, -3.0),
        mm(50.0, 0.0, 25.0) + above * normal,
    )
}

#[test]
fn fig4_over_a_box_edge() {
    let pitch = 20.0_f64.to_radians();
    let object = obstacle(cuboid(), Pose::IDENTITY);
    let mut bench = Bench::new(object, rod(3.0 * MM, 1), over_the_edge(pitch, 0.5 * MM));
    // Drawn outward by 10 mm the haptic tool comes out by 3.4 mm.
    bench.lead(&over_the_edge(pitch, -4.5 * MM), 100);
    let before = bench.advance(&bench.tracker.world_from_haptic());
    let step = 0.1 * MM;
    let log = bench.lead_by(DVec3::X * (100.0 * step), 100);
    let after = bench.advance(&bench.tracker.world_from_haptic());
    assert_eq!(log.slid(), 100, "{log:?}");
    // The old point of the object stays, the tool runs over it and sinks along its own slope.
    let moved = after.world_from_visual.translation - before.world_from_visual.translation;
    let expected = DVec3::new(1.0, 0.0, -pitch.tan()) * (100.0 * step);
    assert!(moved.distance(expected) < 1e-9, "{moved}");
    let slid = after.tool_point.unwrap() - before.tool_point.unwrap();
    assert!(
        slid.distance(DVec3::NEG_X * (100.0 * step / pitch.cos())) < 1e-9,
        "{slid}"
    );
    assert!(log.deepest < 1e-9 && log.widest < 1e-9, "{log:?}");
}

#[test]
fn fig4_flat_on_the_box_until_its_end_passes() {
    // The rod covers the box from x = 20 to 50 mm and is drawn outward by 25 mm.
    let object = obstacle(cuboid(), Pose::IDENTITY);
    let start = Pose::from_translation(mm(20.0, 0.0, 28.5));
    let mut bench = Bench::new(object, rod(3.0 * MM, 1), start);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let log = bench.lead_by(mm(25.0, 0.0, 0.0), 250);
    assert!(log.slid() > 0, "{log:?}");
    assert!(log.deepest < 1e-9 && log.widest < 1e-9, "{log:?}");
    let lifted = bench.tracker.world_from_visual().translation - mm(45.0, 0.0, 28.0);
    assert!(lifted.length() < 1e-9, "{lifted}");
}

#[test]
fn fig4_with_tool_edge_on_object_edge() {
    let out = DVec3::new(1.0, 0.0, 1.0) * FRAC_1_SQRT_2;
    let along = DVec3::new(1.0, 0.0, -1.0) * FRAC_1_SQRT_2;
    let edge_down = DVec3::new(0.0, 1.0, 1.0) * FRAC_1_SQRT_2;
    let rotation = aligned([DVec3::X, edge_down], [along, out]);
    let on_edge = mm(50.0, 8.0, 25.0);
    let above = placed(rotation, mm(50.0, -3.0, -3.0), on_edge + 0.5 * MM * out);
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), rod(3.0 * MM, 1), above);
    bench.lead_by(-1.5 * MM * out, 30);
    let before = bench.tracker.world_from_visual();
    let log = bench.lead_by(10.0 * MM * along, 500);
    let after = bench.advance(&bench.tracker.world_from_haptic());
    assert!(log.slid() > 400, "{} slides", log.slid());
    let moved = after.world_from_visual.translation - before.translation;
    assert!(moved.distance(10.0 * MM * along) < 1e-9, "{moved}");
    let contact = after.contact.unwrap();
    assert!(matches!(contact.feature, Feature::Edge(_)));
    assert!(
        contact.point.distance(on_edge) <= 0.5e-4 + 1e-12,
        "{}",
        contact.point
    );
    let tool_point = after.tool_point.unwrap();
    assert!(
        tool_point.distance(mm(40.0, -3.0, -3.0)) <= 0.5e-4 + 1e-9,
        "{tool_point}"
    );
    assert!(log.deepest < 1e-9 && log.widest < 1e-9, "{log:?}");
}

#[test]
fn fig4_with_tool_face_on_object_vertex() {
    let on_tool = mm(50.0, 0.0, -3.0);
    let above = placed(DQuat::IDENTITY, on_tool, mm(0.0, 0.0, 0.5));
    let mut bench = Bench::new(corner_up(), rod(3.0 * MM, 1), above);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let log = bench.lead_by(mm(10.0, 2.0, 0.0), 100);
    let after = bench.advance(&bench.tracker.world_from_haptic());
    assert_eq!(log.slid(), 100, "{log:?}");
    for event in &log.events {
        let PaperEvent::SlidByRay { from, to } = event else {
            panic!("{event:?}")
        };
        assert!((*to - *from).distance(mm(-0.1, -0.02, 0.0)) < 1e-9);
    }
    assert!(matches!(after.contact.unwrap().feature, Feature::Vertex(_)));
    let visual = after.world_from_visual.translation;
    assert!(visual.distance(mm(-40.0, 2.0, 3.0)) < 1e-9, "{visual}");
    assert!(log.deepest < 1e-9 && log.widest < 1e-9, "{log:?}");
}
