//! The hierarchy against brute force over all triangles.

use glam::DVec3;
use pliant_collision::{Point, SimplexCache, Triangle, TriangleBvh, cast_ray, closest_points};
use pliant_mesh::generate::{cuboid, latitude_longitude_ellipsoid, tube};
use pliant_mesh::{Aabb, ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;
use proptest::prelude::{Strategy, TestCaseError, prop_assert, prop_assert_eq, proptest};

const CENTRE: DVec3 = DVec3::new(3.0, -2.0, 5.0);
const RADII: DVec3 = DVec3::new(0.05, 0.04, 0.03);

fn direction() -> impl Strategy<Value = DVec3> {
    let range = -1.0..1.0;
    (range.clone(), range.clone(), range)
        .prop_map(|(x, y, z)| DVec3::new(x, y, z))
        .prop_filter("a direction", |v| v.length() > 0.01)
}

/// Far from the origin, so that the coordinates are large beside the size.
fn ellipsoid() -> TriangleMesh {
    latitude_longitude_ellipsoid(RADII, 24, 15)
        .expect("valid")
        .transformed(&Pose::from_translation(CENTRE))
}

fn triangle_count(mesh: &TriangleMesh) -> u32 {
    u32::try_from(mesh.triangles().len()).expect("small")
}

fn brute_closest(mesh: &TriangleMesh, point: DVec3) -> f64 {
    (0..triangle_count(mesh))
        .map(|triangle| {
            let shape = Triangle(mesh.corners(triangle));
            let pose = Pose::from_translation(point);
            closest_points(
                &shape,
                &Point(DVec3::ZERO),
                &pose,
                &mut SimplexCache::default(),
            )
            .separation
            .abs()
        })
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn single_triangle_and_box() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]).expect("valid");
    let bvh = TriangleBvh::new(&mesh);
    let found = bvh
        .closest_point(&mesh, DVec3::new(0.2, 0.2, 0.4), f64::INFINITY)
        .expect("no limit");
    assert!((found.distance - 0.4).abs() < 1e-15 && found.triangle == 0);
    let (triangle, hit) = bvh
        .cast_ray(
            &mesh,
            DVec3::new(0.2, 0.2, 0.4),
            DVec3::NEG_Z,
            f64::INFINITY,
        )
        .expect("hit");
    assert!(triangle == 0 && (hit.distance - 0.4).abs() < 1e-15 && hit.normal == DVec3::Z);
    assert!(
        bvh.cast_ray(&mesh, DVec3::Z, DVec3::Z, f64::INFINITY)
            .is_none()
    );
    let ray = bvh.cast_ray(&mesh, DVec3::new(0.2, 0.2, 0.4), DVec3::NEG_Z, 0.399);
    assert!(ray.is_none());
}

#[test]
fn rays_do_not_slip_between_triangles() {
    let mesh = ellipsoid();
    let bvh = TriangleBvh::new(&mesh);
    for triangle in 0..triangle_count(&mesh) {
        let [p, q, r] = mesh.corners(triangle);
        for target in [p, q, r, p.midpoint(q), q.midpoint(r), q.lerp(r, 0.3)] {
            let Some(outward) = (target - CENTRE).try_normalize() else {
                continue;
            };
            let hit = bvh
                .cast_ray(&mesh, CENTRE, outward, 1.0)
                .expect("closed mesh");
            assert!((hit.1.point - target).length() < 1e-12, "{target}");
        }
    }
}

/// From a hundred and ten thousand sizes away the point on an edge is known to eleven and nine digits only.
#[test]
fn rays_from_afar_do_not_slip_between_triangles() {
    let mesh = ellipsoid();
    let bvh = TriangleBvh::new(&mesh);
    for triangle in 0..triangle_count(&mesh) {
        let [p, q, r] = mesh.corners(triangle);
        for target in [p.midpoint(q), q.midpoint(r), q.lerp(r, 0.3)] {
            let Some(outward) = (target - CENTRE).try_normalize() else {
                continue;
            };
            for away in [10.0, 1e3] {
                let hit = bvh.cast_ray(&mesh, target + outward * away, -outward, f64::INFINITY);
                let (_, hit) = hit.expect("closed mesh");
                assert!(
                    (hit.point - target).length() < 1e-12 * away,
                    "{target} {away}"
                );
            }
        }
    }
}

#[test]
fn inner_wall_of_a_tube_is_found() {
    let mesh = tube(0.02, 0.01, 0.1, 64).expect("valid");
    let bvh = TriangleBvh::new(&mesh);
    let found = bvh
        .closest_point(&mesh, DVec3::new(0.05, 0.0, 0.0), 1.0)
        .expect("found");
    let inradius = 0.01 * (std::f64::consts::PI / 64.0).cos();
    assert!((found.distance - inradius).abs() < 1e-14, "{found:?}");
}

proptest! {
    #[test]
    fn closest_point_is_that_of_brute_force(way in direction(), height in 0.0..3.0) {
        let mesh = ellipsoid();
        let bvh = TriangleBvh::new(&mesh);
        let point = CENTRE + way * RADII * height;
        let expected = brute_closest(&mesh, point);
        let found = bvh.closest_point(&mesh, point, f64::INFINITY)
            .ok_or_else(|| TestCaseError::fail("nothing"))?;
        prop_assert!((found.distance - expected).abs() < 1e-15, "{found:?} {expected}");
        prop_assert!(((found.point - point).length() - found.distance).abs() < 1e-15);
        let tight = bvh.closest_point(&mesh, point, expected * (1.0 + 1e-9) + 1e-14);
        prop_assert!(tight.is_some_and(|tight| tight.point == found.point));
        prop_assert!(bvh.closest_point(&mesh, point, expected * 0.999 - 1e-14).is_none());
    }

    #[test]
    fn rays_agree_with_the_convex_cast(from in direction(), to in direction()) {
        let mesh = ellipsoid();
        let bvh = TriangleBvh::new(&mesh);
        let convex = ConvexMesh::from_triangles(&mesh)
            .map_err(|error| TestCaseError::fail(error.to_string()))?;
        let origin = CENTRE + from.normalize() * 0.2;
        let ray = (CENTRE + to * 0.04 - origin).normalize();
        let found = bvh.cast_ray(&mesh, origin, ray, 1.0);
        let expected = cast_ray(&convex, origin, ray, 1.0);
        prop_assert_eq!(found.is_some(), expected.is_some());
        if let (Some((_, found)), Some(expected)) = (found, expected) {
            prop_assert!((found.distance - expected.distance).abs() < 1e-11, "{found:?} {expected:?}");
        }
    }

    #[test]
    fn box_query_finds_every_triangle_whose_box_meets(way in direction(), half in 0.0..0.02) {
        let mesh = ellipsoid();
        let bvh = TriangleBvh::new(&mesh);
        let centre = CENTRE + way * RADII;
        let wanted = Aabb { min: centre - half, max: centre + half };
        let mut found = Vec::new();
        bvh.overlapping(&wanted, |triangle| found.push(triangle));
        found.sort_unstable();
        prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "no triangle twice");
        let nearly = wanted.inflated(1e-7 * 0.1);
        for triangle in 0..triangle_count(&mesh) {
            let bounds = Aabb::from_points(&mesh.corners(triangle));
            let reported = found.binary_search(&triangle).is_ok();
            prop_assert!(reported || !bounds.overlaps(&wanted));
            prop_assert!(!reported || bounds.overlaps(&nearly));
        }
    }
}

#[test]
fn box_touching_a_face_counts() {
    let mesh = cuboid(DVec3::splat(0.1)).expect("valid");
    let bvh = TriangleBvh::new(&mesh);
    let mut count = 0;
    let beside = Aabb {
        min: DVec3::new(0.1, -0.01, -0.01),
        max: DVec3::new(0.2, 0.01, 0.01),
    };
    bvh.overlapping(&beside, |_| count += 1);
    assert_eq!(count, 2, "the two triangles of the +x face");
}
