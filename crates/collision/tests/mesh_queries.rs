//! Shapes against meshes, compared with the definition applied to every triangle, and warm queries with cold ones.

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, MeshCache, MeshContact, MeshFeature, Point, PointSet, Rounded, Segment,
    SimplexCache, SupportMap, Triangle, TriangleBvh, closest_points,
};
use pliant_mesh::generate::{cuboid, latitude_longitude_ellipsoid, tube};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn direction(random: &mut ChaCha8Rng) -> DVec3 {
    loop {
        let v = DVec3::from_array([(); 3].map(|()| random.random_range(-1.0..1.0)));
        if (0.1..1.0).contains(&v.length()) {
            return v.normalize();
        }
    }
}

fn rotation(random: &mut ChaCha8Rng) -> DQuat {
    DQuat::from_axis_angle(direction(random), random.random_range(0.0..3.1))
}

fn moved(mesh: &TriangleMesh, to: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    let positions = mesh.positions().iter().map(|&p| to(p)).collect();
    TriangleMesh::new(positions, mesh.triangles().to_vec()).expect("valid")
}

fn bumpy(sectors: u32, bands: u32) -> TriangleMesh {
    let sphere = latitude_longitude_ellipsoid(DVec3::ONE, sectors, bands).expect("valid");
    moved(&sphere, |p| {
        p * (0.1 + 0.008 * (9.0 * p.x).sin() * (7.0 * p.y + 1.0).cos() + 0.003 * (23.0 * p.z).sin())
    })
}

/// Every position once per triangle, as an STL file has them.
fn soup(mesh: &TriangleMesh) -> TriangleMesh {
    let count = u32::try_from(mesh.triangles().len()).expect("small");
    let positions = (0..count).flat_map(|t| mesh.corners(t)).collect();
    let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    TriangleMesh::new(positions, triangles).expect("valid")
}

/// One large triangle and one without area beside it.
fn degenerate() -> TriangleMesh {
    let p = DVec3::new;
    let positions = vec![
        p(-0.1, -0.1, 0.0),
        p(0.1, -0.1, 0.0),
        p(0.0, 0.1, 0.0),
        p(0.0, 0.0, 0.02),
        p(0.05, 0.0, 0.02),
        p(0.1, 0.0, 0.02),
    ];
    let triangles = vec![[0, 1, 2], [3, 4, 5], [3, 3, 5], [4, 4, 4]];
    TriangleMesh::new(positions, triangles).expect("valid")
}

fn meshes() -> Vec<(&'static str, TriangleMesh)> {
    let sphere = latitude_longitude_ellipsoid(DVec3::splat(0.1), 96, 6).expect("valid");
    let far = Pose::new(DQuat::from_rotation_x(1.0), DVec3::new(1e3, -2e3, 5e2));
    vec![
        ("bumpy", bumpy(30, 17)),
        ("bumpy soup", soup(&bumpy(16, 9))),
        ("slivers", sphere),
        ("box", cuboid(DVec3::new(0.1, 0.07, 0.05)).expect("valid")),
        ("sheet", cuboid(DVec3::new(0.1, 0.1, 1e-4)).expect("valid")),
        ("tube", tube(0.07, 0.05, 0.2, 24).expect("valid")),
        ("tiny", moved(&bumpy(16, 9), |p| p * 1e-5)),
        ("far", bumpy(16, 9).transformed(&far)),
        ("degenerate", degenerate()),
    ]
}

const PRISM: [DVec3; 8] = [
    DVec3::new(-0.5, -0.2, -0.12),
    DVec3::new(-0.5, 0.2, -0.12),
    DVec3::new(-0.5, -0.2, 0.12),
    DVec3::new(-0.5, 0.2, 0.12),
    DVec3::new(0.5, -0.08, -0.05),
    DVec3::new(0.5, 0.08, -0.05),
    DVec3::new(0.5, -0.08, 0.05),
    DVec3::new(0.5, 0.08, 0.05),
];

/// Shapes of a given length, with and without listed faces, with closed forms and without.
fn shapes(size: f64) -> Vec<(&'static str, Box<dyn SupportMap>)> {
    let points: &'static [DVec3] = PRISM.map(|p| p * size).to_vec().leak();
    let segment = Segment {
        a: DVec3::X * (-0.5 * size),
        b: DVec3::X * (0.5 * size),
    };
    let radii = DVec3::new(0.5, 0.2, 0.1) * size;
    let many = latitude_longitude_ellipsoid(radii, 12, 8).expect("valid");
    let half = DVec3::new(0.4, 0.1, 0.02) * size;
    vec![
        ("prism", Box::new(ConvexMesh::hull(points).expect("valid"))),
        ("points", Box::new(PointSet(points))),
        ("segment", Box::new(segment)),
        (
            "capsule",
            Box::new(Rounded {
                core: segment,
                radius: 0.1 * size,
            }),
        ),
        (
            "sphere",
            Box::new(Rounded {
                core: Point(DVec3::ZERO),
                radius: 0.2 * size,
            }),
        ),
        (
            "rounded box",
            Box::new(Rounded {
                core: Cuboid { half },
                radius: 0.05 * size,
            }),
        ),
        (
            "ellipsoid",
            Box::new(ConvexMesh::from_triangles(&many).expect("valid")),
        ),
    ]
}

fn extent(mesh: &TriangleMesh) -> f64 {
    mesh.bounds().diagonal()
}

/// A placement with the shape's centre near the surface, now and then far away or in the middle.
fn placement(mesh: &TriangleMesh, random: &mut ChaCha8Rng) -> Pose {
    let count = u32::try_from(mesh.triangles().len()).expect("small");
    let [p, q, r] = mesh.corners(random.random_range(0..count));
    let near = 0.15 * random.random_range(0.0..1.0_f64).powi(2) * extent(mesh);
    let at = match random.random_range(0..20) {
        0 => mesh.bounds().center(),
        1 => mesh.bounds().center() + direction(random) * extent(mesh),
        _ => (p + q + r) / 3.0 + direction(random) * near,
    };
    Pose::new(rotation(random), at)
}

/// Every triangle by the general query, whatever the shape.
fn brute(
    mesh: &TriangleMesh,
    shape: &dyn SupportMap,
    pose: &Pose,
    margin: f64,
) -> Vec<(u32, ClosestPoints)> {
    (0..)
        .take(mesh.triangles().len())
        .map(|triangle| {
            let corners = Triangle(mesh.corners(triangle));
            let cache = &mut SimplexCache::default();
            (triangle, closest_points(&corners, shape, pose, cache))
        })
        .filter(|(_, closest)| closest.separation <= margin)
        .collect()
}

/// Positions a triangle has among its corners furthest along the normal.
fn feature(mesh: &TriangleMesh, triangle: u32, normal: DVec3) -> Vec<DVec3> {
    let corners = mesh.corners(triangle);
    let size = (corners[1] - corners[0])
        .length()
        .max((corners[2] - corners[0]).length());
    let height = |p: DVec3| normal.dot(p - corners[0]);
    let top = corners
        .iter()
        .map(|&p| height(p))
        .fold(f64::NEG_INFINITY, f64::max);
    let mut found: Vec<DVec3> = Vec::new();
    for corner in corners {
        if height(corner) >= top - 1e-9 * size && !found.contains(&corner) {
            found.push(corner);
        }
    }
    found
}

/// The definition, word for word.
fn minima_by_definition(
    mesh: &TriangleMesh,
    hits: &[(u32, ClosestPoints)],
    level: f64,
) -> Vec<u32> {
    let features: Vec<_> = hits
        .iter()
        .map(|(t, c)| feature(mesh, *t, c.normal))
        .collect();
    let holds = |triangle: u32, points: &[DVec3]| {
        let corners = mesh.corners(triangle);
        points.iter().all(|p| corners.contains(p))
    };
    let minima: Vec<usize> = (0..hits.len())
        .filter(|&i| {
            let lower = |other: &(u32, ClosestPoints)| {
                holds(other.0, &features[i]) && other.1.separation < hits[i].1.separation - level
            };
            features[i].len() == 3 || !hits.iter().any(lower)
        })
        .collect();
    let mut plateau: Vec<usize> = minima.clone();
    loop {
        let mut changed = false;
        for x in 0..minima.len() {
            for y in 0..minima.len() {
                let (i, j) = (minima[x], minima[y]);
                let common = features[i].iter().any(|p| features[j].contains(p));
                let (a, b) = (&hits[i].1, &hits[j].1);
                let level = (a.separation - b.separation).abs() <= level
                    && (a.normal - b.normal).length() < 1e-6;
                if common && level && plateau[y] < plateau[x] {
                    plateau[x] = plateau[y];
                    changed = true;
                }
            }
        }
        if !changed {
            break;
        }
    }
    let mut named: Vec<u32> = plateau.iter().map(|&i| hits[i].0).collect();
    named.sort_unstable();
    named.dedup();
    named
}

fn reach(shape: &dyn SupportMap) -> f64 {
    let side = |d: DVec3| shape.support(d, 0).point.dot(d) + shape.radius();
    0.5 * DVec3::AXES
        .map(|a| side(a) + side(-a))
        .iter()
        .map(|w| w * w)
        .sum::<f64>()
        .sqrt()
}

fn assert_same(case: &str, found: &[MeshContact], expected: &[(u32, ClosestPoints)], size: f64) {
    let numbers = |of: &[(u32, ClosestPoints)]| of.iter().map(|h| h.0).collect::<Vec<_>>();
    let triangles: Vec<u32> = found.iter().map(|hit| hit.triangle).collect();
    assert_eq!(triangles, numbers(expected), "{case}");
    for (hit, (_, expected)) in found.iter().zip(expected) {
        let closest = &hit.closest;
        let error = (closest.separation - expected.separation).abs();
        assert!(error <= 1e-12 * size, "{case}: {hit:?} {expected:?}");
        let gap = closest.witness_b - closest.witness_a;
        let error = (gap - closest.normal * closest.separation).length();
        assert!(error <= 1e-12 * size, "{case}: {hit:?}");
        assert!(
            (closest.normal.length() - 1.0).abs() < 1e-12,
            "{case}: {hit:?}"
        );
    }
}

#[test]
fn contacts_are_those_of_the_definition() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let (mut several, mut inside, mut none) = (0, 0, 0);
    for (mesh_name, mesh) in meshes() {
        let bvh = TriangleBvh::new(&mesh);
        let length = 0.4 * extent(&mesh);
        let size = extent(&mesh) + mesh.bounds().center().length();
        for (shape_name, shape) in shapes(length) {
            let mut cache = MeshCache::default();
            for trial in 0..24 {
                let pose = placement(&mesh, &mut random);
                let margin = [0.0, 0.02, -0.02, 0.3][trial % 4] * length;
                let case = format!("{shape_name} on {mesh_name}, {trial}, {pose:?}");
                let expected = brute(&mesh, &*shape, &pose, margin);
                let every = bvh.every_contact(&mesh, &*shape, &pose, margin, &mut cache);
                assert_same(&case, every, &expected, size);
                cache.clear();
                let found = bvh.contacts(&mesh, &*shape, &pose, margin, &mut cache);
                let level = 1e-11 * reach(&*shape);
                let wanted = minima_by_definition(&mesh, &expected, level);
                let triangles: Vec<u32> = found.iter().map(|hit| hit.triangle).collect();
                assert_eq!(triangles, wanted, "{case}");
                several += u32::from(found.len() > 1);
                none += u32::from(found.is_empty());
                inside += u32::from(found.iter().any(|hit| hit.closest.separation < 0.0));
            }
        }
    }
    assert!(
        several > 300 && inside > 300 && none > 50,
        "{several} {inside} {none}"
    );
}

/// Slow and quick motions, there and back, with pauses.
fn path(mesh: &TriangleMesh, random: &mut ChaCha8Rng, steps: usize) -> Vec<Pose> {
    let mut pose = placement(mesh, random);
    let (way, axis) = (direction(random), direction(random));
    (0..steps)
        .map(|step| {
            let speed = [1e-3, 1e-3, -5e-3, 0.0, 3e-2][step / 7 % 5];
            pose.translation += way * (speed * extent(mesh));
            pose.rotation = (DQuat::from_axis_angle(axis, 2.0 * speed) * pose.rotation).normalize();
            pose
        })
        .collect()
}

#[test]
fn warm_queries_answer_what_cold_ones_do() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    let mut contacts = 0;
    for (mesh_name, mesh) in meshes() {
        let bvh = TriangleBvh::new(&mesh);
        let length = 0.4 * extent(&mesh);
        let size = extent(&mesh) + mesh.bounds().center().length();
        for (shape_name, shape) in shapes(length) {
            for _ in 0..3 {
                let mut warm = MeshCache::default();
                for (step, pose) in path(&mesh, &mut random, 70).iter().enumerate() {
                    let case = format!("{shape_name} on {mesh_name}, step {step}, {pose:?}");
                    // The same cache through every query, at changing margins.
                    let margin = [0.0, 0.05, 0.01][step / 3 % 3] * length;
                    let mut cold = MeshCache::default();
                    let expected = bvh.contacts(&mesh, &*shape, pose, margin, &mut cold);
                    let found = bvh.contacts(&mesh, &*shape, pose, margin, &mut warm);
                    let pairs: Vec<_> = expected.iter().map(|h| (h.triangle, h.closest)).collect();
                    assert_same(&case, found, &pairs, size);
                    let features = |of: &[MeshContact]| -> Vec<MeshFeature> {
                        of.iter().map(|hit| hit.feature).collect()
                    };
                    assert_eq!(features(found), features(expected), "{case}");
                    contacts += expected.len();
                    let nearest = bvh.deepest(&mesh, &*shape, pose, length, &mut warm);
                    let expected =
                        bvh.deepest(&mesh, &*shape, pose, length, &mut MeshCache::default());
                    assert_eq!(nearest.is_some(), expected.is_some(), "{case}");
                    if let (Some(a), Some(b)) = (nearest, expected) {
                        let error = (a.closest.separation - b.closest.separation).abs();
                        assert!(error <= 1e-12 * size, "{case}: {a:?} {b:?}");
                    }
                }
            }
        }
    }
    assert!(contacts > 5000, "{contacts}");
}

/// A ball and a box of the same extents: what is far from the one may be deep in the other.
#[test]
fn a_cache_left_by_another_shape_hides_nothing() {
    let mesh = latitude_longitude_ellipsoid(DVec3::new(0.05, 0.045, 0.04), 96, 67).expect("valid");
    let bvh = TriangleBvh::new(&mesh);
    let ball = Rounded::sphere(DVec3::ZERO, 0.01);
    let cube = Cuboid {
        half: DVec3::splat(0.01),
    };
    let corner_down = DQuat::from_rotation_arc(DVec3::ONE.normalize(), DVec3::NEG_Z);
    let pose = Pose::new(corner_down, DVec3::new(0.0, 0.0, 0.0545));
    let mut cache = MeshCache::default();
    assert!(
        bvh.contacts(&mesh, &ball, &pose, 0.0, &mut cache)
            .is_empty()
    );
    let warm = bvh.contacts(&mesh, &cube, &pose, 0.0, &mut cache).to_vec();
    let cold = bvh
        .contacts(&mesh, &cube, &pose, 0.0, &mut MeshCache::default())
        .to_vec();
    assert!(!cold.is_empty());
    assert_eq!(warm, cold);
}

#[test]
fn the_deepest_is_the_least_of_all() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for (mesh_name, mesh) in meshes() {
        let bvh = TriangleBvh::new(&mesh);
        let length = 0.3 * extent(&mesh);
        let size = extent(&mesh) + mesh.bounds().center().length();
        for (shape_name, shape) in shapes(length) {
            for _ in 0..12 {
                let pose = placement(&mesh, &mut random);
                let case = format!("{shape_name} on {mesh_name}, {pose:?}");
                let least = brute(&mesh, &*shape, &pose, f64::INFINITY)
                    .iter()
                    .map(|hit| hit.1.separation)
                    .fold(f64::INFINITY, f64::min);
                let cache = &mut MeshCache::default();
                let found = bvh.deepest(&mesh, &*shape, &pose, f64::INFINITY, cache);
                let found = found.expect("unlimited").closest.separation;
                assert!(
                    (found - least).abs() <= 1e-12 * size,
                    "{case}: {found} {least}"
                );
                let below = least - 1e-9 * size;
                let cache = &mut MeshCache::default();
                assert!(
                    bvh.deepest(&mesh, &*shape, &pose, below, cache).is_none(),
                    "{case}"
                );
            }
        }
    }
}
