//! Slivers hide no concavity, and none is refused on a convex solid.

use std::f64::consts::TAU;

use crate::{ConvexMesh, ConvexityError, TriangleMesh, generate};
use glam::{DQuat, DVec3};
use pliant_spatial::Pose;

/// A bar of 1 × 0.2 × 0.2 whose cross-section along y has the upper outline given from left to right; caps fan from the
/// lower left corner.
fn bar(upper: &[[f64; 2]]) -> TriangleMesh {
    let outline: Vec<[f64; 2]> = [[0.0, 0.0], [1.0, 0.0]]
        .into_iter()
        .chain(upper.iter().rev().copied())
        .collect();
    let count = u32::try_from(outline.len()).unwrap();
    let mut positions = Vec::new();
    for y in [0.0, 0.2] {
        positions.extend(outline.iter().map(|&[x, z]| DVec3::new(x, y, z)));
    }
    let mut triangles = Vec::new();
    for i in 0..count {
        let j = (i + 1) % count;
        triangles.extend([[i, i + count, j], [j, i + count, j + count]]);
    }
    for i in 1..count - 1 {
        triangles.extend([[0, i, i + 1], [count, count + i + 1, count + i]]);
    }
    let mesh = TriangleMesh::new(positions, triangles).unwrap();
    if mesh.signed_volume() < 0.0 {
        mesh.reversed()
    } else {
        mesh
    }
}

/// The upper outline with a V groove of 45° in the middle, each wall in so many steps.
fn grooved(depth: f64, steps: i32) -> TriangleMesh {
    let wall = (-steps..=steps).map(|i| {
        let off = depth * f64::from(i) / f64::from(steps);
        [0.5 + off, 0.2 - depth + off.abs()]
    });
    let upper: Vec<[f64; 2]> = [[0.0, 0.2]]
        .into_iter()
        .chain(wall)
        .chain([[1.0, 0.2]])
        .collect();
    bar(&upper)
}

#[test]
fn grooves_with_walls_of_slivers_are_found() {
    // Steps of about 3e-6 along the walls.
    for (depth, steps) in [(0.005, 2357), (0.02, 9428)] {
        let error = ConvexMesh::from_triangles(&grooved(depth, steps)).unwrap_err();
        let ConvexityError::SunkenFace {
            position,
            depth: found,
            tolerance,
            ..
        } = error
        else {
            panic!("{error}")
        };
        assert!(found > tolerance && found <= depth + tolerance, "{found}");
        assert!(
            (position.x - 0.5).abs() < depth && position.z < 0.2,
            "{position}"
        );
    }
}

#[test]
fn a_waist_of_slivers_between_two_circles_on_the_hull_is_found() {
    // All vertices are corners of the hull, but the chords between the circles run inside: half as wide at the middle.
    let (count, shift) = (40_000_u32, 13_333);
    let mut positions = Vec::new();
    for z in [-0.5, 0.5] {
        let angle = |i: u32| TAU * f64::from(i) / f64::from(count);
        positions.extend(
            (0..count).map(|i| DVec3::new(0.03 * angle(i).cos(), 0.03 * angle(i).sin(), z)),
        );
    }
    positions.extend([DVec3::new(0.0, 0.0, -0.5), DVec3::new(0.0, 0.0, 0.5)]);
    let mut triangles = Vec::new();
    for i in 0..count {
        let (j, k, l) = (
            (i + 1) % count,
            (i + shift) % count,
            (i + shift + 1) % count,
        );
        let (k, l) = (k + count, l + count);
        triangles.extend([
            [i, j, k],
            [j, l, k],
            [j, i, 2 * count],
            [k, l, 2 * count + 1],
        ]);
    }
    let mesh = TriangleMesh::new(positions, triangles).unwrap();
    let error = ConvexMesh::from_triangles(&mesh).unwrap_err();
    assert!(
        matches!(error, ConvexityError::SunkenFace { depth, .. } if depth > 1e-3),
        "{error}"
    );
}

#[test]
fn convex_solids_of_slivers_pass() {
    let turn = Pose::new(
        DQuat::from_xyzw(0.1, 0.5, -0.3, 0.8).normalize(),
        DVec3::ONE,
    );
    // A roof whose ridge is rounded in steps of 3e-6.
    let ridge = (-1000..=1000).map(|i| {
        let off = 3e-6 * f64::from(i);
        [0.5 + off, 0.2 + 0.01 - (off * off + 1e-4).sqrt()]
    });
    let upper: Vec<[f64; 2]> = ridge.collect();
    // A half cylinder, its arc in steps of 8e-6.
    let arc = (1..200_000).map(|i| {
        let angle = TAU * f64::from(i) / 400_000.0;
        [0.5 - 0.5 * angle.cos(), 0.5 * angle.sin()]
    });
    let arc: Vec<[f64; 2]> = arc.collect();
    let shapes = [
        bar(&upper),
        bar(&arc),
        generate::cylinder(5e-4, 0.1, 4096).unwrap(),
        generate::cone([5e-4, 0.0], 0.1, 4096).unwrap(),
        generate::latitude_longitude_ellipsoid(DVec3::new(0.05, 0.003, 0.004), 1500, 5).unwrap(),
        generate::capsule(1e-3, 1.0, 2000, 20).unwrap(),
    ];
    for shape in shapes {
        ConvexMesh::from_triangles(&shape).unwrap();
        // As a file of `f32` gives it.
        let single = |p: &DVec3| turn.transform_point(*p).as_vec3().as_dvec3();
        let positions = shape.positions().iter().map(single).collect();
        let single = TriangleMesh::new(positions, shape.triangles().to_vec()).unwrap();
        ConvexMesh::from_triangles(&single).unwrap();
    }
}
