//! The oracle is judged before it judges: by closed forms, by the reference pairs, which other programs computed, and by
//! `parry3d-f64` on ordinary pairs.

use std::path::Path;

use glam::{DQuat, DVec3};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;
use pliant_tests::collision::core::Core;
use pliant_tests::collision::oracle::Scene;
use pliant_tests::collision::reference::read;
use pliant_tests::collision::shape::{Body, Shape};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn separation(a: &Core, b: &Core, a_from_b: &Pose) -> f64 {
    let truth = Scene::new(a, b, a_from_b).truth();
    assert!(
        truth.doubt.abs() <= 1e-13 * (a.extent() + b.extent()),
        "{truth:?}"
    );
    truth.separation
}

fn cuboid(half: DVec3) -> Core {
    Core::of_points(&Body::Cuboid(half).points())
}

#[test]
fn boxes_along_axes_are_apart_by_their_intervals() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for _ in 0..2000 {
        let mut vector = |low: f64, high: f64| {
            DVec3::from_array(std::array::from_fn(|_| random.random_range(low..high)))
        };
        let (half_a, half_b) = (vector(0.1, 1.0), vector(0.1, 1.0));
        let offset = vector(-2.5, 2.5);
        let gaps = offset.abs() - half_a - half_b;
        let apart = gaps.max(DVec3::ZERO).length();
        let expected = if apart > 0.0 {
            apart
        } else {
            gaps.max_element()
        };
        let pose = Pose::from_translation(offset);
        let found = separation(&cuboid(half_a), &cuboid(half_b), &pose);
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn flat_and_thin_cores_have_distances_too() {
    let square = Core::polygon(&[
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(-1.0, 1.0, 0.0),
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(1.0, -1.0, 0.0),
    ]);
    let point = Core::exhaustive(&[DVec3::ZERO]);
    let stick = Core::exhaustive(&[DVec3::NEG_Z, DVec3::Z]);
    let at = |x: f64, y: f64, z: f64| Pose::from_translation(DVec3::new(x, y, z));
    for (a, b, pose, expected) in [
        (&square, &square, at(2.5, 0.0, 0.0), 0.5),
        (&square, &square, at(5.0, 6.0, 0.0), 5.0),
        (&square, &square, at(0.5, 0.3, 0.0), 0.0),
        (&square, &square, at(0.5, 0.3, -0.2), 0.2),
        (&square, &point, at(0.2, 0.1, -0.7), 0.7),
        (&square, &stick, at(0.2, 0.1, 0.7), -0.3),
        (&square, &stick, at(0.9, 0.0, 0.0), -0.1),
        (&stick, &stick, at(0.0, 0.0, 2.25), 0.25),
        (&stick, &stick, at(3.0, 4.0, 1.0), 5.0),
        (&point, &point, at(0.0, 3.0, 4.0), 5.0),
        (&point, &stick, at(0.0, 0.0, 0.5), 0.0),
        // Not quite on it: the direction between the two is noise.
        (&point, &stick, at(1e-17, 0.0, 1.0), 0.0),
        (&point, &point, at(0.0, 0.0, 0.0), 0.0),
        (&stick, &stick, at(0.0, 0.0, 1.0), 0.0),
    ] {
        let found = separation(a, b, &pose);
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
}

#[test]
fn reference_pairs_agree() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/collision-open.json");
    let reference = read(&path).expect("the reference file is part of the project");
    let shapes: Vec<Shape> = reference
        .shapes
        .iter()
        .map(|shape| Shape::new(shape.body.clone(), shape.radius))
        .collect();
    for case in &reference.cases {
        let [a, b] = case.shapes.map(|shape| &shapes[shape]);
        let cores = separation(&a.core, &b.core, &case.a_from_b);
        let error = (cores - (a.radius + b.radius) - case.signed_distance).abs();
        let allowed = case.tolerance.min(2e-13 * (a.size() + b.size()));
        assert!(error <= allowed, "case {}: off by {error:e}", case.id);
    }
}

/// Rounding puts points of the seam between the two triangles beside both.
#[test]
fn seams_of_polygons_belong_to_them() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for _ in 0..1000 {
        let corner = |angle: f64| DVec3::new(angle.cos(), 0.7 * angle.sin(), 0.0);
        let start = random.random_range(0.0..1.0);
        let corners = [0.0, 1.4, 2.9, 4.6].map(|angle| corner(angle + start));
        let seam = corners[0].lerp(corners[2], random.random_range(0.0..1.0));
        assert!(Core::polygon(&corners).distance_to(seam) < 1e-15);
    }
}

fn random_hull(random: &mut ChaCha8Rng, count: usize) -> ConvexMesh {
    let points: Vec<DVec3> = (0..count).map(|_| unit(random)).collect();
    ConvexMesh::hull(&points).expect("points on a sphere span a hull")
}

fn unit(random: &mut ChaCha8Rng) -> DVec3 {
    loop {
        let p = DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
        if (0.1..1.0).contains(&p.length()) {
            return p.normalize();
        }
    }
}

#[test]
fn ordinary_hulls_agree_with_parry() {
    let vector = |v: DVec3| Vector::new(v.x, v.y, v.z);
    let polyhedron = |mesh: &ConvexMesh| {
        let points: Vec<Vector> = mesh.positions().iter().copied().map(vector).collect();
        ConvexPolyhedron::from_convex_hull(&points).expect("a convex mesh has a hull")
    };
    let mut random = ChaCha8Rng::seed_from_u64(2);
    let mut penetrating = 0;
    for _ in 0..300 {
        let meshes = [12, 20].map(|count| random_hull(&mut random, count));
        let [a, b] = [0, 1].map(|i| polyhedron(&meshes[i]));
        let cores = [0, 1].map(|i| Core::from_mesh(&meshes[i]));
        let q = DQuat::from_axis_angle(unit(&mut random), random.random_range(0.0..3.0));
        let t = unit(&mut random) * random.random_range(0.8..3.0);
        let found = separation(&cores[0], &cores[1], &Pose::new(q, t));
        let pose = ParryPose::from_parts(vector(t), Rotation::from_xyzw(q.x, q.y, q.z, q.w));
        let contact = query::contact(&ParryPose::IDENTITY, &a, &pose, &b, 100.0)
            .expect("convex polyhedra are supported")
            .expect("within 100 m");
        penetrating += u32::from(found < 0.0);
        assert!(
            (found - contact.dist).abs() < 1e-10,
            "{found} {}",
            contact.dist
        );
    }
    assert!((50..250).contains(&penetrating), "{penetrating}");
}
