//! Support polygons against a look at every vertex, on coarse, curved and finely cut surfaces.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3, IVec3};
use pliant_collision::SupportMap;
use pliant_mesh::{ConvexMesh, Feature, TriangleMesh, generate};

use super::super::feature::feature_under;
use super::{MOST, SLAB, SlabWalk};

const HALF: f64 = 0.05;

/// A cube of 100 mm whose faces are cut into `cells` × `cells` squares of two triangles.
fn cut_cube(cells: i32) -> ConvexMesh {
    let mut index = BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut number = |grid: IVec3| {
        *index.entry(grid.to_array()).or_insert_with(|| {
            positions.push((grid.as_dvec3() * (2.0 / f64::from(cells)) - 1.0) * HALF);
            u32::try_from(positions.len() - 1).expect("few vertices")
        })
    };
    for (axis, side) in (0..3).flat_map(|axis| [(axis, 0), (axis, cells)]) {
        let at = |i: i32, j: i32| {
            let mut grid = [0; 3];
            grid[axis] = side;
            grid[(axis + 1) % 3] = i;
            grid[(axis + 2) % 3] = j;
            IVec3::from_array(grid)
        };
        for (i, j) in (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j))) {
            let [a, b, c, d] =
                [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)].map(&mut number);
            triangles.extend(if side == 0 {
                [[a, c, b], [a, d, c]]
            } else {
                [[a, b, c], [a, c, d]]
            });
        }
    }
    let mesh = TriangleMesh::new(positions, triangles).expect("a cube");
    ConvexMesh::from_triangles(&mesh).expect("a cube is convex")
}

fn support(mesh: &ConvexMesh, direction: DVec3) -> (Vec<u32>, bool) {
    let top = mesh.support(direction, 0).index;
    let mut walk = SlabWalk::new(mesh.positions().len());
    let found = walk.visit(mesh, direction, top);
    (found.vertices.to_vec(), found.is_flat_face)
}

fn in_slab(mesh: &ConvexMesh, direction: DVec3) -> Vec<u32> {
    let heights: Vec<f64> = mesh.positions().iter().map(|p| p.dot(direction)).collect();
    let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    (0..)
        .zip(&heights)
        .filter(|(_, height)| **height >= top - SLAB)
        .map(|(vertex, _)| vertex)
        .collect()
}

#[test]
fn a_slab_of_few_vertices_is_taken_whole() {
    let mesh = generate::latitude_longitude_ellipsoid(DVec3::new(0.06, 0.05, 0.04), 96, 67);
    let mesh = ConvexMesh::from_triangles(&mesh.expect("sizes")).expect("convex");
    let mut several = 0;
    for step in 0..500 {
        let turn = DQuat::from_rotation_z(0.37 * f64::from(step));
        let direction = turn * DQuat::from_rotation_y(6e-3 * f64::from(step)) * DVec3::Z;
        let expected = in_slab(&mesh, direction);
        let (mut found, flat) = support(&mesh, direction);
        found.sort_unstable();
        assert!(!flat && expected.len() <= MOST);
        assert_eq!(found, expected, "direction {direction}");
        several += u32::from(expected.len() > 1);
    }
    assert!(several > 30, "{several} of 500");
}

#[test]
fn a_finely_cut_face_has_the_corners_of_the_face() {
    let mesh = cut_cube(40);
    for tilt in [0.0, 3e-6] {
        for axis in [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Z] {
            let direction =
                DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), tilt) * axis;
            let (found, flat) = support(&mesh, direction);
            assert!(flat);
            let mut corners = 0;
            for vertex in found {
                let p = mesh.positions()[vertex as usize];
                assert!((p.dot(axis) - HALF).abs() < 1e-12);
                // A direction straight across a side may also give a point on it, which the hull drops.
                corners += u32::from((p.abs() - HALF).abs().max_element() < 1e-12);
            }
            assert_eq!(corners, 4, "{axis} tilted by {tilt}");
        }
    }
}

#[test]
fn a_finely_cut_face_tilted_out_of_the_slab_leaves_its_edge() {
    let mesh = cut_cube(40);
    let direction = DQuat::from_rotation_y(4e-5) * DVec3::Z;
    let (found, flat) = support(&mesh, direction);
    assert!(flat);
    assert_eq!(found.len(), 2);
    for vertex in found {
        let p = mesh.positions()[vertex as usize];
        assert!((p.y.abs() - HALF).abs() < 1e-12 && (p.x - HALF).abs() < 1e-12);
    }
}

#[test]
fn the_triangle_under_a_point_of_a_finely_cut_face_is_found() {
    let mesh = cut_cube(24);
    let mut walk = SlabWalk::new(mesh.positions().len());
    let top = mesh.support(DVec3::Z, 0).index;
    let found = walk.visit(&mesh, DVec3::Z, top);
    let mut last = None;
    for step in 0..200 {
        let t = 0.05 * f64::from(step);
        let point = DVec3::new(0.03 * t.sin(), 0.04 * (0.7 * t).cos(), HALF);
        let feature = feature_under(mesh.topology(), &found, (DVec3::Z, point), last);
        last = Some(feature);
        let Feature::Face(face) = feature else {
            panic!("{feature:?}");
        };
        let [a, b, c] = mesh.topology().face_corners(face);
        for (from, to) in [(a, b), (b, c), (c, a)] {
            // The first walks start at a corner of the cube and may take some ticks.
            assert!(step < 3 || (to - from).cross(point - from).z >= -1e-12);
        }
    }
}

#[test]
fn a_finely_cut_curve_keeps_its_highest_vertices() {
    let mesh = generate::fibonacci_ellipsoid(DVec3::splat(2e-3), 120_000).expect("sizes");
    let mesh = ConvexMesh::from_triangles(&mesh).expect("convex");
    let mut narrowed = 0;
    for step in 0..100 {
        let turn = DQuat::from_rotation_z(0.37 * f64::from(step));
        let direction = turn * DQuat::from_rotation_y(3e-2 * f64::from(step)) * DVec3::Z;
        let all = in_slab(&mesh, direction);
        let (found, flat) = support(&mesh, direction);
        assert!(!flat && !found.is_empty() && found.len() <= MOST);
        let height = |vertex: &u32| mesh.positions()[*vertex as usize].dot(direction);
        let lowest = found.iter().map(height).fold(f64::INFINITY, f64::min);
        let left_out = all.iter().filter(|vertex| !found.contains(vertex));
        let highest = left_out.map(height).fold(f64::NEG_INFINITY, f64::max);
        assert!(found.iter().all(|vertex| all.contains(vertex)) && lowest > highest);
        narrowed += u32::from(found.len() < all.len());
    }
    assert!(narrowed > 10, "{narrowed}");
}

#[test]
fn a_ring_at_one_height_is_taken_or_left_as_a_whole() {
    // The ring around the pole is 0.24 µm below it and has 40 vertices.
    let mesh = generate::latitude_longitude_ellipsoid(DVec3::splat(0.05), 40, 1000).expect("sizes");
    let mesh = ConvexMesh::from_triangles(&mesh).expect("convex");
    let (found, flat) = support(&mesh, DVec3::Z);
    assert!(!flat);
    assert_eq!(found.len(), 1);
}
