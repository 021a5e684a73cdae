//! The convexity test: local at every edge, then global.
//!
//! A fine mesh can be concave by a vanishing amount at every edge and still have a deep dimple, so edges
//! alone prove nothing. Let Θ be the sum of all concave dihedral angles, D the size and r the distance from
//! the centroid to the nearest face plane. A plane section through the centroid meets each edge at most once
//! and turns the wrong way there by at most D/r times the edge's angle, so no vertex is more than Θ·D²/r
//! above a face plane. When that bound is not small enough (printed decimals, `f32`), the definition itself is
//! tested ([`planes`]). Faces thinner than the tolerance have no plane to speak of and are held to the hull
//! otherwise ([`slivers`]).
//! One winding around the centroid excludes branched surfaces that satisfy all planes.

use glam::DVec3;

use self::planes::Tree;
use self::rounded::Rounded;
use super::ConvexityError;
use crate::triangle_mesh::altitude;
use crate::{EdgeId, FaceId, HalfEdgeMesh, TriangleMesh, VertexId};

mod planes;
mod rounded;
mod slivers;

/// Volume over area, relative to the size, below which a mesh has no inside: rounding then decides the sign
/// of the volume.
const FLAT: f64 = 1e-10;

/// Share of the tolerance that the summed concave angles may use up before all planes are tested: the bound is
/// an estimate, the test exact.
const BOUND_SHARE: f64 = 0.1;

/// Returns the centroid [m] of a mesh that passes.
pub(super) fn check(
    topology: &HalfEdgeMesh,
    mesh: &TriangleMesh,
    relative_tolerance: f64,
) -> Result<DVec3, ConvexityError> {
    check_pieces(topology, mesh)?;
    let rounded = Rounded::new(mesh);
    let centroid = check_inside(mesh, &rounded)?;
    let size = mesh.bounds().diagonal();
    let tolerance = relative_tolerance * size;
    let thick: Vec<bool> = faces_of(topology)
        .map(|f| altitude(topology.face_corners(f)) > tolerance)
        .collect();
    let concave_angle = check_edges(topology, &thick, tolerance)?;
    check_winding(&rounded, centroid)?;
    let nearest = faces_of(topology)
        .filter(|f| thick[f.index()])
        .map(|f| {
            topology
                .face_normal(f)
                .dot(topology.face_corners(f)[0] - centroid)
        })
        .fold(f64::INFINITY, f64::min);
    // Without thick faces nothing is known: `nearest` and the sum are infinite.
    let proven = nearest > 0.0
        && concave_angle.is_finite()
        && concave_angle * size * size <= BOUND_SHARE * tolerance * nearest;
    if !proven {
        let tree = Tree::new(topology, &thick);
        check_planes(topology, &tree, tolerance)?;
        check_slivers(topology, &tree, &thick, (tolerance, centroid))?;
    }
    Ok(centroid)
}

fn faces_of(topology: &HalfEdgeMesh) -> impl Iterator<Item = FaceId> {
    (0..).take(topology.face_count()).map(FaceId)
}

/// Closed, and in one piece.
fn check_pieces(topology: &HalfEdgeMesh, mesh: &TriangleMesh) -> Result<(), ConvexityError> {
    if let Some(&border) = topology.boundary_loops().first() {
        let ends = topology.edge_vertices(topology.edge(border));
        return Err(ConvexityError::Open {
            loops: topology.boundary_loops().len(),
            edge: ends.map(|v| topology.position(v)),
        });
    }
    let shells = mesh.shells();
    if shells != 1 {
        return Err(ConvexityError::Shells { shells });
    }
    Ok(())
}

/// The centroid [m] of a mesh with a positive volume.
fn check_inside(mesh: &TriangleMesh, rounded: &Rounded<'_>) -> Result<DVec3, ConvexityError> {
    let (volume, centroid) = rounded.volume_and_centroid();
    let size = mesh.bounds().diagonal();
    let thickness = volume.abs() / mesh.surface_area();
    if thickness.is_nan() || thickness <= FLAT * size {
        return Err(ConvexityError::Flat { thickness, size });
    }
    if volume < 0.0 {
        return Err(ConvexityError::InsideOut { volume });
    }
    Ok(centroid)
}

/// Refuses the most concave edge; otherwise the sum of all concave angles [rad] (mesh.9). Infinite where faces too
/// thin to have a plane hide edges.
fn check_edges(
    topology: &HalfEdgeMesh,
    thick: &[bool],
    tolerance: f64,
) -> Result<f64, ConvexityError> {
    let mut sum = if thick.contains(&false) {
        f64::INFINITY
    } else {
        0.0
    };
    let mut worst: Option<(f64, EdgeId, FaceId, VertexId)> = None;
    for edge in (0..).take(topology.edge_count()).map(EdgeId) {
        let half = topology.half_edge_of_edge(edge);
        let base = topology.position(topology.origin(half));
        for (near, far) in [(half, topology.twin(half)), (topology.twin(half), half)] {
            let (Some(face), Some(other)) = (topology.face(near), topology.face(far)) else {
                continue;
            };
            if !thick[face.index()] || !thick[other.index()] {
                continue;
            }
            let vertex = topology.origin(topology.next(topology.next(far)));
            let offset = topology.position(vertex) - base;
            let height = topology.face_normal(face).dot(offset);
            if height > 0.0 {
                let along = topology.position(topology.origin(topology.twin(half))) - base;
                sum += height * along.length() / offset.cross(along).length();
            }
            if height > tolerance && worst.is_none_or(|(h, ..)| height > h) {
                worst = Some((height, edge, face, vertex));
            }
        }
    }
    worst.map_or(Ok(sum), |(height, edge, face, vertex)| {
        Err(ConvexityError::ConcaveEdge {
            edge,
            ends: topology.edge_vertices(edge).map(|v| topology.position(v)),
            face,
            vertex,
            height,
            tolerance,
        })
    })
}

/// One full turn around the centroid, no branches (mesh.11).
fn check_winding(rounded: &Rounded<'_>, center: DVec3) -> Result<(), ConvexityError> {
    let turns = rounded.turns(center);
    if (turns - 1.0).abs() < 1e-3 {
        Ok(())
    } else {
        Err(ConvexityError::Winding { turns })
    }
}

/// Refuses the highest vertex over any face plane (mesh.8).
fn check_planes(
    topology: &HalfEdgeMesh,
    tree: &Tree,
    tolerance: f64,
) -> Result<(), ConvexityError> {
    tree.highest(tolerance).map_or(Ok(()), |worst| {
        Err(ConvexityError::VertexAboveFace {
            vertex: VertexId(worst.vertex),
            position: topology.positions()[worst.vertex as usize],
            face: worst.face,
            height: worst.height,
            tolerance,
        })
    })
}

/// Refuses a thin face far below the hull (mesh.16).
fn check_slivers(
    topology: &HalfEdgeMesh,
    tree: &Tree,
    thick: &[bool],
    (tolerance, centroid): (f64, DVec3),
) -> Result<(), ConvexityError> {
    let found = slivers::sunken(topology, tree, thick, (tolerance, centroid));
    found.map_or(Ok(()), |sunken| {
        Err(ConvexityError::SunkenFace {
            face: sunken.face,
            position: topology.position(sunken.vertex),
            depth: sunken.depth,
            tolerance: sunken.allowed,
        })
    })
}

#[cfg(test)]
mod tests {
    use crate::{
        CONVEXITY_TOLERANCE, ConvexMesh, ConvexityError, HalfEdgeMesh, TriangleMesh, generate,
    };
    use glam::{DQuat, DVec3, EulerRot, Vec3Swizzles};
    use pliant_spatial::Pose;
    use std::f64::consts::TAU;

    /// Two apexes over a ring of `n` vertices that goes `turns` times around.
    fn bipyramid(n: u32, turns: u32, lower: f64) -> TriangleMesh {
        let mut positions = vec![DVec3::Z, -lower * DVec3::Z];
        let mut triangles = Vec::new();
        for i in 0..n {
            let angle = TAU * f64::from(i * turns) / f64::from(n);
            positions.push(DVec3::new(angle.cos(), angle.sin(), 0.0));
            let (a, b) = (2 + i, 2 + (i + 1) % n);
            triangles.extend([[a, b, 0], [b, a, 1]]);
        }
        TriangleMesh::new(positions, triangles).unwrap()
    }

    /// A unit sphere of fine faces, pushed in smoothly around one pole: every edge is concave by less than
    /// 1e-3 of the size while the pole lies 0.17 below the rim.
    fn dimpled_sphere() -> TriangleMesh {
        let sphere = generate::latitude_longitude_ellipsoid(DVec3::ONE, 400, 200).unwrap();
        let push = |p: &DVec3| {
            let inside = (1.0 - (p.x * p.x + p.y * p.y) / 0.49).max(0.0);
            let upper = if p.z > 0.0 { 0.4 } else { 0.0 };
            *p - DVec3::Z * upper * inside.powi(2)
        };
        let positions = sphere.positions().iter().map(push).collect();
        TriangleMesh::new(positions, sphere.triangles().to_vec()).unwrap()
    }

    #[test]
    fn accepts_a_bipyramid() {
        ConvexMesh::from_triangles(&bipyramid(5, 1, 1.0)).unwrap();
    }

    #[test]
    fn refuses_a_pentagram_bipyramid_whose_edges_are_all_convex() {
        let error = ConvexMesh::from_triangles(&bipyramid(5, 2, 1.0)).unwrap_err();
        let ConvexityError::Winding { turns } = error else {
            panic!("{error}")
        };
        assert!((turns - 2.0).abs() < 1e-9, "{turns}");
    }

    #[test]
    fn refuses_a_doubly_wound_square_whose_vertices_are_under_all_planes() {
        let error = ConvexMesh::from_triangles(&bipyramid(8, 2, 1.0)).unwrap_err();
        assert!(matches!(error, ConvexityError::Winding { .. }), "{error}");
    }

    #[test]
    fn names_a_concave_edge_with_its_measure() {
        // The lower apex pushed up through the ring's plane to 0.2: the ring edges stay convex, those from
        // the lower apex become concave.
        let error = ConvexMesh::from_triangles(&bipyramid(4, 1, -0.2)).unwrap_err();
        let ConvexityError::ConcaveEdge {
            ends,
            height,
            tolerance,
            ..
        } = &error
        else {
            panic!("{error}")
        };
        assert!(ends.contains(&(0.2 * DVec3::Z)));
        // Plane through (1,0,0), (0,1,0), (0,0,0.2): x + y + 5z = 1; (-1,0,0) is 2/√27 from it.
        assert!((height - 2.0 / 27.0_f64.sqrt()).abs() < 1e-12, "{height}");
        assert!((tolerance - CONVEXITY_TOLERANCE * 2.0_f64.hypot(2.0).hypot(1.0)).abs() < 1e-12);
        assert!(error.to_string().contains("convex_hull: true"));
    }

    #[test]
    fn texts_are_short_name_no_unit_and_tell_how_to_take_the_hull() {
        let error = ConvexMesh::from_triangles(&bipyramid(4, 1, -0.2)).unwrap_err();
        let message = error.to_string();
        let hint = "use its hull (`convex_hull: true` in a scene, `ConvexMesh::hull` in code)";
        assert!(message.ends_with(hint), "{message}");
        for part in [
            " (0, 0, 0.2)",
            " is 0.3849 above the plane",
            "tolerance 3e-5; ",
        ] {
            assert!(message.contains(part), "{part}: {message}");
        }
        let inverted = generate::cuboid(DVec3::splat(0.05)).unwrap().reversed();
        let message = ConvexMesh::from_triangles(&inverted)
            .unwrap_err()
            .to_string();
        assert!(message.contains("signed volume is -0.001; "), "{message}");
        assert!(message.ends_with(hint), "{message}");
    }

    #[test]
    fn a_dimple_of_vanishing_edge_angles_is_found_globally() {
        let error = ConvexMesh::new(HalfEdgeMesh::new(&dimpled_sphere()).unwrap(), 1e-3)
            .err()
            .unwrap();
        let ConvexityError::VertexAboveFace {
            height, tolerance, ..
        } = error
        else {
            panic!("{error}")
        };
        assert!(height > 10.0 * tolerance, "{height} {tolerance}");
    }

    #[test]
    fn needles_and_plates_far_thinner_than_the_tolerance_wind_once() {
        let turn = Pose::new(DQuat::from_euler(EulerRot::XYZ, 0.3, 0.8, -0.4), DVec3::ONE);
        for thin in [1e-5, 1e-7, 1e-8] {
            let shapes = [
                generate::cylinder(thin, 0.2, 32).unwrap(),
                generate::capsule(thin, 0.2, 32, 8).unwrap(),
                generate::cone([thin, 0.0], 0.2, 32).unwrap(),
                generate::plate(0.2, 0.1, thin).unwrap(),
                generate::cuboid(DVec3::new(thin, 0.1, 10.0 * thin)).unwrap(),
            ];
            for shape in shapes {
                ConvexMesh::from_triangles(&shape).unwrap();
                ConvexMesh::from_triangles(&shape.transformed(&turn)).unwrap();
                ConvexMesh::hull(shape.positions()).unwrap();
            }
        }
    }

    #[test]
    fn needles_of_few_sectors_are_solids_until_they_are_flat() {
        // Turned and far from the origin by their own length, where rounding is an even coat of 1e-16.
        let turn = Pose::new(DQuat::from_euler(EulerRot::XYZ, 0.3, 0.8, -0.4), DVec3::ONE);
        for (sectors, radius) in [(5, 1e-8), (3, 1e-9), (5, 3e-10), (7, 1e-10), (12, 1e-10)] {
            for needle in [
                generate::cylinder(radius, 0.2, sectors).unwrap(),
                generate::capsule(radius, 0.2, sectors, 4).unwrap(),
                generate::cone([radius, 0.0], 0.2, sectors).unwrap(),
            ] {
                let lying = ConvexMesh::from_triangles(&needle).unwrap();
                let turned = ConvexMesh::from_triangles(&needle.transformed(&turn)).unwrap();
                let off = turn.transform_point(lying.centroid()) - turned.centroid();
                assert!(off.length() < 1e-5, "{sectors} {radius}: {off}");
                // Off the axis by less than the needle is thick.
                assert!(lying.centroid().yz().length() < 0.1 * radius);
            }
        }
        let flat = generate::cylinder(1e-12, 0.2, 5).unwrap();
        let error = ConvexMesh::from_triangles(&flat.transformed(&turn)).unwrap_err();
        assert!(matches!(error, ConvexityError::Flat { .. }), "{error}");
    }

    #[test]
    fn a_thin_bipyramid_that_winds_twice_is_still_refused() {
        let thin = bipyramid(5, 2, 1.0);
        let positions = thin
            .positions()
            .iter()
            .map(|p| *p * DVec3::new(1e-7, 1e-7, 1.0));
        let thin = TriangleMesh::new(positions.collect(), thin.triangles().to_vec()).unwrap();
        let error = ConvexMesh::from_triangles(&thin).unwrap_err();
        assert!(matches!(error, ConvexityError::Winding { turns } if (turns - 2.0).abs() < 1e-6));
    }

    #[test]
    fn refuses_open_inverted_flat_and_multiple() {
        let cube = generate::cuboid(DVec3::ONE).unwrap();
        let error = ConvexMesh::from_triangles(&cube.reversed()).unwrap_err();
        assert_eq!(error, ConvexityError::InsideOut { volume: -8.0 });
        assert!(error.to_string().contains("inside out"));

        let open =
            TriangleMesh::new(cube.positions().to_vec(), cube.triangles()[1..].to_vec()).unwrap();
        let error = ConvexMesh::from_triangles(&open).unwrap_err();
        assert!(
            matches!(error, ConvexityError::Open { loops: 1, .. }),
            "{error}"
        );

        let flat = TriangleMesh::new(
            vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            vec![[0, 1, 2], [0, 2, 1]],
        );
        let error = ConvexMesh::from_triangles(&flat.unwrap()).unwrap_err();
        assert!(matches!(error, ConvexityError::Flat { .. }), "{error}");

        let mut positions = cube.positions().to_vec();
        positions.extend(cube.positions().iter().map(|p| p + 5.0));
        let mut triangles = cube.triangles().to_vec();
        triangles.extend(cube.triangles().iter().map(|t| t.map(|v| v + 8)));
        let error = ConvexMesh::from_triangles(&TriangleMesh::new(positions, triangles).unwrap())
            .unwrap_err();
        assert_eq!(error, ConvexityError::Shells { shells: 2 });
    }
}
