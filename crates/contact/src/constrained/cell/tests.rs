//! Certificates and adoption, on a rod in two halves over a table.

use glam::{DQuat, DVec3};
use pliant_mesh::{ConvexMesh, generate};
use pliant_spatial::Pose;

use super::{Bodies, Cell, SKIN};
use crate::Obstacle;

fn block(half: DVec3) -> ConvexMesh {
    let mesh = generate::cuboid(half).expect("positive sizes");
    ConvexMesh::from_triangles(&mesh).expect("a box is convex")
}

/// Top face at z = 0.
fn table() -> [Obstacle; 1] {
    [Obstacle {
        shape: block(DVec3::new(0.1, 0.1, 0.01)),
        world_from_object: Pose::from_translation(DVec3::new(0.0, 0.0, -0.01)),
        shading_threshold: None,
    }]
}

/// Two halves of a rod of 100 × 6 × 6 mm along x, its middle at the origin.
fn halves() -> [ConvexMesh; 2] {
    [-1.0, 1.0].map(|side| {
        let mesh = generate::cuboid(DVec3::new(0.025, 0.003, 0.003)).expect("positive sizes");
        let moved = mesh.transformed(&Pose::from_translation(DVec3::X * (0.025 * side)));
        ConvexMesh::from_triangles(&moved).expect("a box is convex")
    })
}

/// Runs `check` on a cell whose tool is `gap` above the table, with fresh planes.
fn with_cell(gap: f64, check: impl FnOnce(&mut Cell, Bodies<'_>)) {
    let (obstacles, segments) = (table(), halves());
    let bodies = Bodies {
        obstacles: &obstacles,
        segments: &segments,
    };
    let pose = Pose::from_translation(DVec3::Z * (0.003 + gap));
    let mut cell = Cell::new(bodies, pose);
    cell.refresh_all(bodies);
    check(&mut cell, bodies);
}

#[test]
fn detection_finds_the_face_and_its_gap() {
    with_cell(2e-3, |cell, _| {
        for pair in 0..2 {
            assert!((cell.pairs[pair].normal - DVec3::Z).length() < 1e-12);
            assert!((cell.gap(pair) - 2e-3).abs() < 1e-15);
        }
    });
}

#[test]
fn a_normal_that_two_supports_do_not_certify_is_refused_and_nothing_changes() {
    with_cell(SKIN, |cell, bodies| {
        let kept = cell.pairs[0];
        let tilt = |angle: f64| DQuat::from_rotation_y(angle) * DVec3::Z;
        // The end of the half is 50 mm off: a tilt of 1e-3 cuts 50 µm into it.
        for refused in [tilt(1e-3), -DVec3::Z, DVec3::X, DVec3::NAN, DVec3::ZERO] {
            assert!(!cell.accept(bodies, 0, refused), "{refused}");
            let now = cell.pairs[0];
            assert!(now.normal == kept.normal, "{refused}");
            assert!(now.obstacle_bound.to_bits() == kept.obstacle_bound.to_bits());
            assert!(now.segment_bound.to_bits() == kept.segment_bound.to_bits());
        }
        assert!(cell.accept(bodies, 0, tilt(1e-9)));
    });
}

#[test]
fn a_certificate_needs_a_quarter_of_the_skin() {
    with_cell(0.24 * SKIN, |cell, bodies| {
        assert!(!cell.accept(bodies, 0, DVec3::Z));
    });
    with_cell(0.26 * SKIN, |cell, bodies| {
        assert!(cell.accept(bodies, 0, DVec3::Z));
    });
}

/// The rod's first half reaches 10 mm over the table's edge, the second half is beyond it: its own nearest points give a leaning normal that the rod
/// as a whole does not have.
#[test]
fn a_covered_half_adopts_the_plane_of_the_other() {
    with_cell(1e-3, |cell, bodies| {
        cell.pose.translation.x = 0.11;
        cell.detect(bodies, 1);
        assert!(cell.pairs[1].normal.x > 0.9, "{}", cell.pairs[1].normal);
        cell.refresh_all(bodies);
        assert!((cell.pairs[0].normal - DVec3::Z).length() < 1e-12);
        assert!(cell.pairs[1].normal == cell.pairs[0].normal);
        assert_eq!(cell.leader(1), 0);
    });
}

#[test]
fn a_saved_cell_comes_back_whole() {
    with_cell(1e-3, |cell, bodies| {
        let (kept, rotation) = (cell.pairs[1], cell.pose.rotation);
        cell.save();
        cell.turn(bodies, DQuat::from_rotation_y(0.04));
        assert!(cell.pairs[1].segment_bound.to_bits() != kept.segment_bound.to_bits());
        cell.swap_saved();
        assert!(cell.pairs[1].segment_bound.to_bits() == kept.segment_bound.to_bits());
        assert!(cell.pairs[1].normal == kept.normal && cell.pose.rotation == rotation);
    });
}
