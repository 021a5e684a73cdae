//! Shapes against meshes where the answer is known by hand.

use glam::{DQuat, DVec3};
use pliant_collision::{
    Cuboid, MeshCache, MeshContact, MeshFeature, Point, PointSet, Rounded, Segment, SimplexCache,
    SupportMap, Triangle, TriangleBvh, cast_shape, closest_points,
};
use pliant_mesh::TriangleMesh;
use pliant_mesh::generate::{cuboid, latitude_longitude_ellipsoid};
use pliant_spatial::Pose;
use proptest::prelude::{Strategy, prop_assert, prop_oneof, proptest};

const SPHERE: Rounded<Point> = Rounded {
    core: Point(DVec3::ZERO),
    radius: 0.01,
};

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose::from_translation(DVec3::new(x, y, z))
}

/// A flat floor at z = 0 of 2·n² triangles over [0, 1]².
fn floor(n: u32) -> TriangleMesh {
    let side = n + 1;
    let positions = (0..side * side)
        .map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0) / f64::from(n))
        .collect();
    let triangles = (0..n * n)
        .flat_map(|cell| {
            let a = cell / n * side + cell % n;
            let (b, c, d) = (a + 1, a + side + 1, a + side);
            [[a, b, c], [a, c, d]]
        })
        .collect();
    TriangleMesh::new(positions, triangles).expect("valid")
}

fn ask(mesh: &TriangleMesh, shape: &impl SupportMap, pose: &Pose, margin: f64) -> Vec<MeshContact> {
    let bvh = TriangleBvh::new(mesh);
    bvh.contacts(mesh, shape, pose, margin, &mut MeshCache::default())
        .to_vec()
}

#[test]
fn a_box_flat_on_a_floor_is_one_plateau() {
    let mesh = floor(20);
    let tool = Cuboid {
        half: DVec3::new(0.1, 0.07, 0.05),
    };
    let found = ask(&mesh, &tool, &at(0.5, 0.5, 0.05 - 1e-4), 0.0);
    assert_eq!(found.len(), 1, "{found:?}");
    let contact = &found[0];
    assert!((contact.closest.normal - DVec3::Z).length() < 1e-12);
    assert!((contact.closest.separation + 1e-4).abs() < 1e-15);
    assert_eq!(contact.feature, MeshFeature::Face);
    let bvh = TriangleBvh::new(&mesh);
    let cache = &mut MeshCache::default();
    let every = bvh.every_contact(&mesh, &tool, &at(0.5, 0.5, 0.05 - 1e-4), 0.0, cache);
    assert!(every.len() > 30, "{}", every.len());
}

#[test]
fn a_corner_an_edge_and_a_face_are_told_apart() {
    let mesh = cuboid(DVec3::splat(0.1)).expect("valid");
    let corner = ask(&mesh, &SPHERE, &at(0.105, 0.105, 0.105), 0.0);
    assert_eq!(corner.len(), 1);
    assert!(matches!(corner[0].feature, MeshFeature::Vertex(_)));
    let expected = 0.005 * 3.0_f64.sqrt() - 0.01;
    assert!((corner[0].closest.separation - expected).abs() < 1e-16);
    let edge = ask(&mesh, &SPHERE, &at(0.105, 0.013, 0.105), 0.0);
    assert_eq!(edge.len(), 1);
    assert!(matches!(edge[0].feature, MeshFeature::Edge(_)));
    let face = ask(&mesh, &SPHERE, &at(0.109, 0.013, 0.04), 0.0);
    assert_eq!((face.len(), face[0].feature), (1, MeshFeature::Face));
    // A groove: both walls count.
    let groove = vec![
        DVec3::new(-1.0, 0.0, 1.0),
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(1.0, 0.0, 1.0),
        DVec3::new(-1.0, 5.0, 1.0),
        DVec3::new(0.0, 5.0, 0.0),
        DVec3::new(1.0, 5.0, 1.0),
    ];
    let walls = vec![[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4]];
    let groove = TriangleMesh::new(groove, walls).expect("valid");
    let found = ask(&groove, &SPHERE, &at(0.0, 2.0, 0.0141), 0.0);
    assert_eq!(found.len(), 2, "{found:?}");
}

#[test]
fn touching_counts_at_margin_zero_and_nothing_is_found_beyond() {
    let mesh = floor(4);
    for height in [0.01, 0.01 + 1e-9] {
        let found = ask(&mesh, &SPHERE, &at(0.3, 0.3, height), 0.0);
        assert_eq!(found.len(), usize::from(height <= 0.01), "{height}");
    }
    assert!(ask(&mesh, &SPHERE, &at(0.3, 0.3, 5.0), 1.0).is_empty());
    assert!(ask(&mesh, &SPHERE, &at(1e9, -1e12, 1e300), 1.0).is_empty());
    let all = ask(&mesh, &SPHERE, &at(0.3, 0.3, 5.0), f64::INFINITY);
    assert_eq!(all.len(), 1, "{all:?}");
}

#[test]
fn bad_numbers_find_nothing() {
    let mesh = floor(4);
    let bvh = TriangleBvh::new(&mesh);
    let mut cache = MeshCache::default();
    for (pose, margin) in [
        (at(f64::NAN, 0.0, 0.0), 1.0),
        (at(0.0, f64::INFINITY, 0.0), 1.0),
        (
            Pose::new(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0), DVec3::ZERO),
            1.0,
        ),
        (Pose::IDENTITY, f64::NAN),
    ] {
        assert!(
            bvh.contacts(&mesh, &SPHERE, &pose, margin, &mut cache)
                .is_empty()
        );
        assert!(
            bvh.deepest(&mesh, &SPHERE, &pose, margin, &mut cache)
                .is_none()
        );
    }
    let good = bvh.contacts(&mesh, &SPHERE, &at(0.3, 0.3, 0.005), 0.0, &mut cache);
    assert_eq!(good.len(), 1, "and the cache still serves");
    let still = DVec3::new(f64::NAN, 0.0, 0.0);
    assert!(
        bvh.cast_shape(&mesh, &SPHERE, &at(0.3, 0.3, 1.0), still)
            .is_none()
    );
}

#[test]
fn a_shape_inside_a_closed_mesh_sees_its_walls() {
    let mesh = cuboid(DVec3::splat(0.1)).expect("valid");
    assert!(
        ask(&mesh, &SPHERE, &Pose::IDENTITY, 0.0).is_empty(),
        "no wall is touched"
    );
    let found = ask(&mesh, &SPHERE, &Pose::IDENTITY, 0.1);
    assert_eq!(found.len(), 6, "one per side: {found:?}");
    for hit in found {
        assert!((hit.closest.separation - 0.09).abs() < 1e-15);
    }
}

#[test]
fn a_capsule_through_a_thin_sheet_leaves_by_the_shorter_end() {
    let mesh = floor(1);
    for (radius, low, high) in [(0.0, 0.01, 0.3), (0.02, 0.03, 0.3), (0.02, 0.3, 0.001)] {
        let tool = Rounded {
            core: Segment {
                a: DVec3::Z * -low,
                b: DVec3::Z * high,
            },
            radius,
        };
        let turned = DQuat::from_rotation_z(0.4);
        let found = ask(
            &mesh,
            &tool,
            &Pose::new(turned, DVec3::new(0.6, 0.35, 0.0)),
            0.0,
        );
        assert_eq!(found.len(), 1, "{found:?}");
        let closest = found[0].closest;
        assert!((closest.separation + low.min(high) + radius).abs() < 1e-15);
        let out = if low < high { DVec3::Z } else { -DVec3::Z };
        assert!((closest.normal - out).length() < 1e-12);
    }
    // Near the border the way out is sideways.
    let needle = Segment {
        a: DVec3::Z * -1.0,
        b: DVec3::Z,
    };
    let found = ask(&mesh, &needle, &at(0.99, 0.35, 0.0), 0.0);
    assert!(
        (found[0].closest.separation + 0.01).abs() < 1e-15,
        "{found:?}"
    );
    assert!((found[0].closest.normal - DVec3::X).length() < 1e-12);
}

#[test]
fn lines_that_cross_have_a_common_normal() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0];
    let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]).expect("valid");
    let needle = Segment {
        a: DVec3::new(1.0, -1.0, -1.0),
        b: DVec3::new(1.0, 1.0, 1.0),
    };
    let found = ask(&mesh, &needle, &Pose::IDENTITY, 0.0);
    let normal = found[0].closest.normal;
    assert!(
        normal.x.abs() < 1e-15 && (normal.y + normal.z).abs() < 1e-15,
        "{normal}"
    );
    assert!(found[0].closest.separation.abs() < 1e-15);
}

#[test]
fn announced_deformations_are_followed() {
    let mesh = floor(30);
    let bvh = TriangleBvh::new(&mesh);
    let mut cache = MeshCache::default();
    for step in 0..200 {
        // One corner dives through the floor, inside the box of the others.
        let dip = 0.002 * f64::from(step);
        let mut points = [
            DVec3::new(-0.1, 0.0, -0.3),
            DVec3::X * 0.1,
            DVec3::Y * 0.1,
            DVec3::Z * 0.4,
            DVec3::ZERO,
        ];
        points[4].z = 0.2 - dip;
        let pose = at(0.5, 0.5, 0.301);
        if step > 0 {
            cache.deformed(0.002);
        }
        let shape = PointSet(&points);
        let warm = bvh.contacts(&mesh, &shape, &pose, 0.0, &mut cache).to_vec();
        assert_eq!(warm, ask(&mesh, &shape, &pose, 0.0), "{step}");
    }
}

#[test]
fn a_refitted_tree_answers_like_a_new_one() {
    let base = latitude_longitude_ellipsoid(DVec3::new(0.1, 0.08, 0.06), 24, 15).expect("valid");
    let mut bvh = TriangleBvh::new(&base);
    let mut cache = MeshCache::default();
    let tool = Cuboid {
        half: DVec3::new(0.05, 0.01, 0.02),
    };
    for step in 0..30 {
        let phase = 0.3 * f64::from(step);
        let drift = DVec3::new(0.0, 0.0, 2.0 * phase);
        let bent = base
            .positions()
            .iter()
            .map(|&p| p * (1.0 + 0.2 * (30.0 * p.x + phase).sin()) + drift);
        let mesh = TriangleMesh::new(bent.collect(), base.triangles().to_vec()).expect("valid");
        bvh.refit(&mesh);
        let rebuilt = TriangleBvh::new(&mesh);
        let turned = DQuat::from_rotation_y(0.5);
        let pose = Pose::new(turned, DVec3::new(0.0, 0.02, 0.07) + drift);
        let fresh = &mut MeshCache::default();
        let expected = rebuilt.contacts(&mesh, &tool, &pose, 0.01, fresh);
        let found = bvh.contacts(&mesh, &tool, &pose, 0.01, &mut cache);
        assert_eq!(found.len(), expected.len(), "{step}");
        for (a, b) in found.iter().zip(expected) {
            assert_eq!((a.triangle, a.feature), (b.triangle, b.feature));
            let error = (a.closest.separation - b.closest.separation).abs();
            assert!(error < 1e-14 && a.closest.normal.distance(b.closest.normal) < 1e-12);
        }
        let point = DVec3::new(0.3, 0.1, 0.0) + drift;
        let near = |bvh: &TriangleBvh| bvh.closest_point(&mesh, point, 1.0).map(|p| p.distance);
        assert_eq!(near(&bvh), near(&rebuilt));
        let ray = |bvh: &TriangleBvh| bvh.cast_ray(&mesh, point, -DVec3::X, 1.0);
        assert_eq!(ray(&bvh).map(|hit| hit.1), ray(&rebuilt).map(|hit| hit.1));
    }
}

fn vector() -> impl Strategy<Value = DVec3> {
    // Few values, so that parallel, touching and coplanar cases are common.
    let grid = (-2..=2, -2..=2, -2..=2)
        .prop_map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
    let range = -2.0..2.0;
    let any = (range.clone(), range.clone(), range).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    prop_oneof![grid, any]
}

proptest! {
    /// The closed form through a mesh of one triangle, against the general query.
    #[test]
    fn segments_and_points_in_closed_form(
        corners in (vector(), vector(), vector()), ends in (vector(), vector()), scale in -6..5, radius in 0.0..0.5,
    ) {
        let scale = 10.0_f64.powi(scale);
        let corners = [corners.0, corners.1, corners.2].map(|p| p * scale);
        let mesh = TriangleMesh::new(corners.to_vec(), vec![[0, 1, 2]]).expect("valid");
        let core = Segment { a: ends.0 * scale, b: ends.1 * scale };
        let capsule = Rounded { core, radius: radius * scale };
        let found = ask(&mesh, &capsule, &Pose::IDENTITY, f64::INFINITY);
        prop_assert!(found.len() == 1);
        let closest = &found[0].closest;
        let cache = &mut SimplexCache::default();
        let expected = closest_points(&Triangle(corners), &capsule, &Pose::IDENTITY, cache);
        let tolerance = 1e-13 * 4.0 * scale;
        prop_assert!((closest.separation - expected.separation).abs() <= tolerance, "{closest:?} {expected:?}");
        prop_assert!((closest.normal.length() - 1.0).abs() < 1e-12);
        // The contract: supporting planes along the normal exactly that far apart.
        let top = corners.iter().map(|p| p.dot(closest.normal)).fold(f64::NEG_INFINITY, f64::max);
        let low = core.a.dot(closest.normal).min(core.b.dot(closest.normal)) - capsule.radius;
        prop_assert!((low - top - closest.separation).abs() <= tolerance, "{closest:?}");
        prop_assert!((closest.witness_a.dot(closest.normal) - top).abs() <= tolerance);
    }

    #[test]
    fn casts_meet_the_triangle_that_comes_first(
        from in vector(), motion in vector(), axis in vector(), turn in 0.0..3.0, round in 0.0..0.02,
    ) {
        let mesh = latitude_longitude_ellipsoid(DVec3::new(0.1, 0.08, 0.06), 12, 8).expect("valid");
        let bvh = TriangleBvh::new(&mesh);
        let core = Cuboid { half: DVec3::new(0.03, 0.02, 0.01) };
        let tool = Rounded { core, radius: round };
        let rotation = DQuat::from_axis_angle(axis.normalize_or(DVec3::X), turn);
        let pose = Pose::new(rotation, from * 0.12);
        let motion = motion * 0.15;
        let first = (0..).take(mesh.triangles().len()).filter_map(|triangle| {
            let corners = Triangle(mesh.corners(triangle));
            cast_shape(&corners, &tool, &pose, motion, &mut SimplexCache::default())
        }).map(|hit| hit.fraction).min_by(f64::total_cmp);
        let found = bvh.cast_shape(&mesh, &tool, &pose, motion);
        prop_assert!(found.is_some() == first.is_some(), "{found:?} {first:?}");
        if let (Some(found), Some(first)) = (found, first) {
            prop_assert!((found.contact.fraction - first).abs() < 1e-11, "{found:?} {first}");
            let stop = Pose::new(rotation, pose.translation + motion * found.contact.fraction);
            let cache = &mut MeshCache::default();
            let deepest = bvh.deepest(&mesh, &tool, &stop, 1.0, cache).expect("near").closest;
            prop_assert!(first == 0.0 || deepest.separation.abs() < 1e-11, "{deepest:?}");
        }
    }
}
