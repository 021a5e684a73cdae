//! Generators against closed forms; hulls and convexity on point sets of every awkward kind; invariants of
//! half-edges and pseudonormals on random hulls.

#![expect(
    clippy::unwrap_used,
    reason = "tests stop at the first surprise and say what they skip"
)]

use std::f64::consts::PI;
use std::io::{Write as _, stderr};

use glam::{DQuat, DVec3};
use pliant_mesh::{
    CONVEXITY_TOLERANCE, ConvexMesh, ConvexityError, FaceId, HalfEdgeId, HalfEdgeMesh, HullError,
    TriangleMesh, VertexId, convex_hull, generate, load,
};
use proptest::prelude::{Strategy, prop};
use proptest::{prop_assert, prop_assert_eq, proptest};

fn euler(mesh: &TriangleMesh) -> i64 {
    let topology = HalfEdgeMesh::new(mesh).unwrap();
    assert!(topology.is_closed());
    topology.euler_number()
}

/// Cross-section of a regular polygon with n corners on a unit circle, over π.
fn polygon_share(n: u32) -> f64 {
    let angle = 2.0 * PI / f64::from(n);
    angle.sin() / angle
}

#[test]
fn volumes_follow_their_closed_forms() {
    let n = 24;
    let disc = PI * polygon_share(n);
    let cases = [
        (
            "cuboid",
            generate::cuboid(DVec3::new(1.0, 2.0, 3.0)),
            48.0,
            2,
        ),
        ("plate", generate::plate(0.1, 0.2, 0.001), 2e-5, 2),
        ("cylinder", generate::cylinder(0.5, 3.0, n), disc * 0.75, 2),
        (
            "frustum",
            generate::cone([0.5, 0.2], 3.0, n),
            disc * (0.25 + 0.1 + 0.04),
            2,
        ),
        ("cone", generate::cone([0.5, 0.0], 3.0, n), disc * 0.25, 2),
        (
            "tip first",
            generate::cone([0.0, 0.5], 3.0, n),
            disc * 0.25,
            2,
        ),
        ("tube", generate::tube(0.5, 0.3, 3.0, n), disc * 0.48, 0),
    ];
    for (name, mesh, volume, characteristic) in cases {
        let mesh = mesh.unwrap();
        assert!(
            (mesh.signed_volume() / volume - 1.0).abs() < 1e-14,
            "{name}: {}",
            mesh.signed_volume()
        );
        assert_eq!(euler(&mesh), characteristic, "{name}");
        assert!(mesh.degenerate_triangles().is_empty(), "{name}");
        assert_eq!(
            ConvexMesh::from_triangles(&mesh).is_ok(),
            name != "tube",
            "{name}"
        );
    }
    assert!(
        (generate::cuboid(DVec3::new(1.0, 2.0, 3.0))
            .unwrap()
            .surface_area()
            - 88.0)
            .abs()
            < 1e-13
    );
    let plate = generate::plate(0.1, 0.2, 0.001).unwrap().bounds();
    assert_eq!((plate.max.z, plate.min.x, plate.max.y), (0.0, -0.05, 0.1));
}

#[test]
fn round_solids_approach_theirs_from_below() {
    let ball = 4.0 / 3.0 * PI * 0.1 * 0.08 * 0.06;
    let coarse =
        generate::latitude_longitude_ellipsoid(DVec3::new(0.1, 0.08, 0.06), 48, 32).unwrap();
    let fine = generate::latitude_longitude_ellipsoid(DVec3::new(0.1, 0.08, 0.06), 96, 64).unwrap();
    let (coarse, fine) = (
        1.0 - coarse.signed_volume() / ball,
        1.0 - fine.signed_volume() / ball,
    );
    assert!(
        fine > 0.0 && (coarse / fine - 4.0).abs() < 0.02,
        "second order: {coarse} {fine}"
    );

    let capsule = generate::capsule(0.5, 2.0, 128, 64).unwrap();
    let exact = PI * 0.25 * 2.0 + 4.0 / 3.0 * PI * 0.125;
    let error = 1.0 - capsule.signed_volume() / exact;
    assert!(error > 0.0 && error < 1e-3, "{error}");
    assert_eq!(
        (capsule.bounds().min.x, capsule.bounds().max.x),
        (-0.5, 2.5)
    );
    ConvexMesh::from_triangles(&capsule).unwrap();
}

#[test]
fn both_kinds_of_the_12672_face_object() {
    let radii = DVec3::new(0.05, 0.04, 0.03);
    for (sectors, bands) in [(96, 67), (64, 100), (72, 89)] {
        let mesh = generate::latitude_longitude_ellipsoid(radii, sectors, bands).unwrap();
        assert_eq!(
            (mesh.positions().len(), mesh.triangles().len()),
            (6338, 12672)
        );
        assert_eq!(euler(&mesh), 2);
        ConvexMesh::from_triangles(&mesh).unwrap();
    }
    let spiral = generate::fibonacci_ellipsoid(radii, 6338).unwrap();
    assert_eq!(
        (spiral.positions().len(), spiral.triangles().len()),
        (6338, 12672)
    );
    // Strictly convex: no tolerance at all.
    ConvexMesh::new(HalfEdgeMesh::new(&spiral).unwrap(), 0.0).unwrap();
    assert_eq!(spiral, generate::fibonacci_ellipsoid(radii, 6338).unwrap());
}

#[test]
fn printed_decimals_stay_within_the_tolerance() {
    let exact = generate::latitude_longitude_ellipsoid(DVec3::new(1.0, 0.8, 0.6), 96, 67).unwrap();
    let print = |p: &DVec3| DVec3::from_array(p.to_array().map(|x| (x * 1e6).round() / 1e6));
    let printed = TriangleMesh::new(
        exact.positions().iter().map(print).collect(),
        exact.triangles().to_vec(),
    )
    .unwrap();
    ConvexMesh::from_triangles(&printed).unwrap();
    let error = ConvexMesh::new(HalfEdgeMesh::new(&printed).unwrap(), 1e-9)
        .err()
        .unwrap();
    assert!(
        matches!(error, ConvexityError::ConcaveEdge { .. }),
        "{error}"
    );
}

#[test]
fn generators_refuse_what_is_no_solid() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(generate::cuboid(DVec3::new(1.0, bad, 1.0)).is_err());
        assert!(generate::cylinder(bad, 1.0, 8).is_err());
        assert!(generate::cylinder(1.0, bad, 8).is_err());
        assert!(generate::capsule(1.0, bad, 8, 4).is_err());
        assert!(generate::tube(1.0, 0.5, bad, 8).is_err());
        assert!(generate::fibonacci_ellipsoid(DVec3::new(1.0, 1.0, bad), 100).is_err());
    }
    assert!(generate::cone([0.0, 0.0], 1.0, 8).is_err());
    assert!(generate::cone([-0.1, 1.0], 1.0, 8).is_err());
    assert!(generate::cylinder(1.0, 1.0, 2).is_err());
    assert!(generate::latitude_longitude_ellipsoid(DVec3::ONE, 8, 1).is_err());
    assert!(generate::latitude_longitude_ellipsoid(DVec3::ONE, u32::MAX, 4).is_err());
    assert!(generate::fibonacci_ellipsoid(DVec3::ONE, 3).is_err());
    assert!(generate::tube(1.0, 1.0, 1.0, 8).is_err());
}

/// Every point is inside or within `skin` of the hull.
fn holds_all(hull: &ConvexMesh, points: &[DVec3], skin: f64) -> bool {
    let topology = hull.topology();
    (0..).take(topology.face_count()).map(FaceId).all(|f| {
        let (n, base) = (topology.face_normal(f), topology.face_corners(f)[0]);
        points.iter().all(|p| n.dot(*p - base) <= skin)
    })
}

#[test]
fn hull_of_a_grid_is_its_box() {
    let turn = DQuat::from_scaled_axis(DVec3::new(0.4, 1.0, -0.3));
    for rotation in [DQuat::IDENTITY, turn] {
        let mut points: Vec<DVec3> = (0..1000)
            .map(|i| {
                rotation
                    * (DVec3::new(
                        f64::from(i % 10),
                        f64::from(i / 10 % 10),
                        f64::from(i / 100),
                    ) * 0.1)
            })
            .collect();
        points.extend_from_within(..200);
        let hull = ConvexMesh::hull(&points).unwrap();
        // Turned, edge and face points stick out by rounding; the skin keeps them off the hull.
        assert_eq!(
            (hull.positions().len(), hull.topology().face_count()),
            (8, 12)
        );
        assert!(holds_all(&hull, &points, 1e-12));
        assert!((hull.radius() - 0.9 * 0.75_f64.sqrt()).abs() < 1e-12);
    }
}

#[test]
fn degenerate_points_have_no_hull() {
    let line: Vec<DVec3> = (0..20)
        .map(|i| DVec3::new(0.1, 0.2, 0.3) * f64::from(i))
        .collect();
    let plane: Vec<DVec3> = (0..20)
        .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), f64::from(i % 5) * 0.3))
        .collect();
    let cases = [
        (vec![], "at least four"),
        (vec![DVec3::ZERO; 3], "at least four"),
        (vec![DVec3::ONE; 50], "at one place"),
        (line, "on a line"),
        (plane, "in a plane"),
        (
            vec![
                DVec3::ZERO,
                DVec3::X,
                DVec3::Y,
                DVec3::new(0.0, 0.0, f64::NAN),
            ],
            "finite",
        ),
        (
            vec![
                DVec3::ZERO,
                DVec3::X,
                DVec3::Y,
                DVec3::new(0.0, 0.0, 1e-300),
            ],
            "in a plane",
        ),
    ];
    for (points, expected) in cases {
        let error = ConvexMesh::hull(&points).err().unwrap().to_string();
        assert!(error.contains(expected), "{error}");
    }
    assert!(matches!(
        convex_hull(&[DVec3::ZERO; 2]),
        Err(HullError::TooFew { count: 2 })
    ));
}

#[test]
fn hulls_of_near_coplanar_and_near_coincident_points() {
    for noise in [1e-16, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5] {
        let points: Vec<DVec3> = (0..600)
            .map(|i| {
                let t = f64::from(i);
                let wobble =
                    DVec3::new((t * 12.9).sin(), (t * 78.2).sin(), (t * 37.7).sin()) * noise;
                let side = if i % 2 == 0 { 0.0 } else { 0.3 };
                DVec3::new(f64::from(i % 20) * 0.05, f64::from(i / 20) * 0.03, side) + wobble
            })
            .collect();
        let hull = ConvexMesh::hull(&points).unwrap_or_else(|e| panic!("{noise}: {e}"));
        assert!(holds_all(&hull, &points, 2e-5), "{noise}");
        assert_eq!(hull.topology().euler_number(), 2);
    }
}

#[test]
fn hulls_of_real_models() {
    let Ok(folder) = std::env::var("PLIANT_DATA") else {
        let _ = writeln!(stderr(), "skipped 9 hulls: PLIANT_DATA is not set");
        return;
    };
    let names = [
        "spot",
        "chai3d_molar_with_pulp",
        "derived_molar_access_mm_8k",
        "derived_molar_access_mm_55k",
        "trimesh_round_tube",
        "trimesh_featuretype",
        "trimesh_angle_block",
        "plus_stylus_example",
        "plus_needle_20cm",
    ];
    for name in names {
        let bytes = std::fs::read(format!("{folder}/meshes/{name}.obj")).unwrap();
        let points = load::obj(&bytes).unwrap().mesh.positions().to_vec();
        let hull = ConvexMesh::hull(&points).unwrap_or_else(|e| panic!("{name}: {e}"));
        let size = hull.bounds().diagonal();
        assert!(holds_all(&hull, &points, 1e-5 * size), "{name}");
        let again = ConvexMesh::hull(&points).unwrap();
        assert_eq!(again.positions(), hull.positions(), "{name}");
    }
}

#[test]
fn convex_models_pass_as_they_are() {
    let Ok(folder) = std::env::var("PLIANT_DATA") else {
        let _ = writeln!(stderr(), "skipped 3 models: PLIANT_DATA is not set");
        return;
    };
    for (name, convex) in [
        ("generated_convex_ellipsoid_12672", true),
        ("trimesh_unit_sphere", true),
        ("spot", false),
    ] {
        let bytes = std::fs::read(format!("{folder}/meshes/{name}.obj")).unwrap();
        let mesh = load::obj(&bytes).unwrap().mesh.welded(0.0).0;
        let topology = HalfEdgeMesh::new(&mesh).unwrap();
        let result = ConvexMesh::new(topology, CONVEXITY_TOLERANCE);
        assert_eq!(result.is_ok(), convex, "{name}: {:?}", result.err());
    }
}

fn clouds() -> impl Strategy<Value = Vec<DVec3>> {
    // Coordinates from a coarse grid half of the time: many coplanar, collinear and coincident points.
    let coordinate = proptest::prop_oneof![(-4..=4_i32).prop_map(f64::from), -4.0..4.0_f64];
    prop::collection::vec(
        [coordinate.clone(), coordinate.clone(), coordinate].prop_map(DVec3::from_array),
        4..120,
    )
}

proptest! {
    #[test]
    fn random_hulls_are_sound(points in clouds()) {
        let Ok(hull) = ConvexMesh::hull(&points) else {
            prop_assert!(convex_hull(&points).is_err(), "a hull that was built must pass its check");
            return Ok(());
        };
        let mesh = hull.topology();
        prop_assert_eq!(mesh.euler_number(), 2);
        prop_assert_eq!(3 * mesh.face_count(), 2 * mesh.edge_count());
        prop_assert!(holds_all(&hull, &points, 2e-10));
        for h in (0..).take(mesh.half_edge_count()).map(HalfEdgeId) {
            prop_assert_eq!(mesh.twin(mesh.twin(h)), h);
            prop_assert!(mesh.twin(h) != h);
            prop_assert_eq!(mesh.next(mesh.next(mesh.next(h))), h);
            prop_assert_eq!(mesh.origin(mesh.next(h)), mesh.origin(mesh.twin(h)));
            prop_assert_eq!(mesh.edge(mesh.twin(h)), mesh.edge(h));
            prop_assert_eq!(mesh.face(mesh.next(h)), mesh.face(h));
        }
        for v in (0..).take(mesh.vertex_count()) {
            let normal = mesh.vertex_pseudonormal(VertexId(v));
            prop_assert!((normal.length() - 1.0).abs() < 1e-12);
            let p = mesh.position(VertexId(v));
            // The half space under the pseudonormal holds the whole convex body.
            prop_assert!(mesh.positions().iter().all(|q| normal.dot(*q - p) < 1e-9));
            prop_assert_eq!(hull.neighbours(v).len(), mesh.outgoing(VertexId(v)).count());
            prop_assert!(hull.neighbours(v).iter().all(|&n| hull.neighbours(n).contains(&v)));
            prop_assert!(points.contains(&p));
        }
    }

    #[test]
    fn hulls_do_not_depend_on_place_and_scale(points in clouds(), factor in 1e-6..1e6_f64, shift in -10.0..10.0_f64) {
        let Ok(hull) = ConvexMesh::hull(&points) else { return Ok(()) };
        let moved: Vec<DVec3> = points.iter().map(|p| (*p + shift) * factor).collect();
        let other = ConvexMesh::hull(&moved).unwrap();
        let expected = hull.topology().to_triangle_mesh().signed_volume() * factor.powi(3);
        let volume = other.topology().to_triangle_mesh().signed_volume();
        prop_assert!((volume / expected - 1.0).abs() < 1e-7, "{volume} {expected}");
        prop_assert!(((hull.centroid() + shift) * factor - other.centroid()).length() < 1e-6 * factor);
    }
}
