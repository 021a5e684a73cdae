//! The bounds hold for every node and pair of nodes, and the search agrees with a scan of all pairs.

use super::{Excess, Point, Tree};
use crate::{HalfEdgeMesh, TriangleMesh, generate};
use glam::{DQuat, DVec3};
use pliant_spatial::Pose;

/// Numbers in [−1, 1) that look like noise.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        f64::from((state >> 32) as u32) / f64::from(1_u32 << 31) - 1.0
    }
}

fn by_every_pair(topology: &HalfEdgeMesh, thick: &[bool]) -> Excess {
    let mut worst = Excess {
        height: f64::NEG_INFINITY,
        face: crate::FaceId(0),
        vertex: 0,
    };
    for face in super::super::faces_of(topology).filter(|f| thick[f.index()]) {
        let (normal, base) = (topology.face_normal(face), topology.face_corners(face)[0]);
        for (vertex, p) in (0..).zip(topology.positions()) {
            let height = normal.dot(p - base);
            if height > worst.height {
                worst = Excess {
                    height,
                    face,
                    vertex,
                };
            }
        }
    }
    worst
}

/// Convex bodies, noise on all vertices, and one dent of each depth, turned and far from the origin.
fn bodies() -> Vec<TriangleMesh> {
    let turn = Pose::new(
        DQuat::from_xyzw(0.1, 0.7, -0.3, 0.6).normalize(),
        DVec3::splat(30.0),
    );
    let smooth = [
        generate::latitude_longitude_ellipsoid(DVec3::new(1.0, 0.7, 0.2), 24, 17).unwrap(),
        generate::fibonacci_ellipsoid(DVec3::new(0.3, 1.0, 0.8), 300).unwrap(),
        generate::capsule(0.2, 1.0, 24, 6).unwrap(),
        generate::cylinder(1.0, 0.1, 150).unwrap(),
        generate::latitude_longitude_ellipsoid(DVec3::new(1.0, 0.9, 0.01), 40, 41).unwrap(),
    ];
    let mut bodies = Vec::new();
    for (seed, mesh) in (1..).zip(&smooth) {
        for size in [0.0, 1e-9, 1e-7, 1e-5, 1e-3, 1e-1] {
            let mut noise = noise(seed);
            let mut positions: Vec<DVec3> = mesh
                .positions()
                .iter()
                .map(|p| p + size * DVec3::new(noise(), noise(), noise()))
                .collect();
            let rough = TriangleMesh::new(positions.clone(), mesh.triangles().to_vec());
            bodies.push(rough.unwrap().transformed(&turn));
            let middle = positions.len() / 2;
            positions[middle] *= 1.0 - 10.0 * size;
            let dented = TriangleMesh::new(positions, mesh.triangles().to_vec());
            bodies.push(dented.unwrap().transformed(&turn));
        }
    }
    bodies
}

#[test]
fn agrees_with_every_pair() {
    let mut found = 0;
    for (number, mesh) in bodies().iter().enumerate() {
        let topology = HalfEdgeMesh::new(mesh).unwrap();
        let mut thick = vec![true; topology.face_count()];
        if number % 3 == 0 {
            thick.iter_mut().step_by(5).for_each(|thick| *thick = false);
        }
        let truth = by_every_pair(&topology, &thick).height.max(0.0);
        for tolerance in [0.0, 1e-6, 0.5 * truth, truth - 1e-12, truth + 1e-12] {
            let worst = Tree::new(&topology, &thick).highest(tolerance);
            if truth > tolerance + 1e-13 {
                let worst = worst.expect("a vertex above a plane");
                assert!((worst.height - truth).abs() < 1e-13, "{worst:?} {truth}");
                let base = topology.face_corners(worst.face)[0];
                let offset = topology.positions()[worst.vertex as usize] - base;
                let height = topology.face_normal(worst.face).dot(offset);
                assert!((height - truth).abs() < 1e-13 && thick[worst.face.index()]);
                found += 1;
            } else {
                assert!(worst.is_none_or(|w| w.height < truth + 1e-13), "{worst:?}");
            }
        }
    }
    assert!(found > 50, "{found}");
}

#[test]
fn bounds_of_every_node_hold() {
    for mesh in bodies().iter().step_by(5) {
        let topology = HalfEdgeMesh::new(mesh).unwrap();
        let tree = Tree::new(&topology, &vec![true; topology.face_count()]);
        for node in &tree.nodes {
            for plane in tree.planes_of(node) {
                let height = plane.offset - plane.normal.dot(node.center);
                assert!(height >= node.lowest - 1e-14, "{height} {node:?}");
                let off = (plane.normal - node.normal).abs() - node.spread;
                assert!(off.max_element() <= 1e-15, "{off} {node:?}");
            }
            let mut noise = noise(7);
            let nearby = || node.outward + 0.3 * DVec3::new(noise(), noise(), noise());
            let near: Vec<DVec3> = std::iter::repeat_with(nearby).take(10).collect();
            for direction in near.into_iter().chain(DVec3::AXES) {
                let farthest = tree.points[node.start..node.end]
                    .iter()
                    .map(|p| direction.dot(p.position - node.center))
                    .fold(f64::NEG_INFINITY, f64::max);
                assert!(node.reach_flat(direction) >= farthest - 1e-14, "{node:?}");
                assert!(node.reach(direction) >= farthest - 1e-14, "{node:?}");
            }
        }
    }
}

#[test]
fn no_pair_of_nodes_with_a_vertex_above_a_plane_is_passed_over() {
    for mesh in bodies().iter().step_by(7) {
        let topology = HalfEdgeMesh::new(mesh).unwrap();
        let tree = Tree::new(&topology, &vec![true; topology.face_count()]);
        for owner in tree.nodes.iter().filter(|n| n.end - n.start <= 40) {
            for group in &tree.nodes {
                let highest = tree.planes_of(owner).iter().flat_map(|plane| {
                    let points = &tree.points[group.start..group.end];
                    let height = |p: &Point| plane.normal.dot(p.position) - plane.offset;
                    points.iter().map(height)
                });
                let highest = highest.fold(f64::NEG_INFINITY, f64::max);
                assert!(
                    !owner.is_above(group, highest - 1e-13),
                    "{highest} {owner:?}"
                );
            }
        }
    }
}

#[test]
fn the_farthest_vertex_is_that_of_a_scan() {
    for mesh in bodies().iter().step_by(5) {
        let topology = HalfEdgeMesh::new(mesh).unwrap();
        // Without planes groups have boxes alone.
        for planes in [true, false] {
            let tree = Tree::new(&topology, &vec![planes; topology.face_count()]);
            let mut noise = noise(11);
            for direction in (0..50).map(|_| DVec3::new(noise(), noise(), noise()).normalize()) {
                let heights = topology.positions().iter().map(|p| direction.dot(*p));
                let truth = heights.fold(f64::NEG_INFINITY, f64::max);
                let (vertex, height) = tree.farthest(direction, 0.0);
                let own = direction.dot(topology.positions()[vertex as usize]);
                assert!((height - truth).abs() < 1e-13, "{height} {truth}");
                assert!((own - truth).abs() < 1e-13, "{own} {truth}");
            }
        }
    }
}
