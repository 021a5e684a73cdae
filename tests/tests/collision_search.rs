//! The oracle of cylinders and cones is judged before it judges: by the enumerating oracle on polytopes, by polygons of many
//! corners, and by closed forms.

use glam::{DQuat, DVec3};
use pliant_collision::{Cone, Cylinder};
use pliant_spatial::Pose;
use pliant_tests::collision::core::Core;
use pliant_tests::collision::families::Family;
use pliant_tests::collision::kinds::{Form, Kind, unit};
use pliant_tests::collision::oracle::Scene;
use pliant_tests::collision::round::Turned;
use pliant_tests::collision::search::Search;
use pliant_tests::collision::shape::{Body, Shape};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// On polytopes both oracles know the answer: the search never claims more, and finds all of it.
#[test]
fn search_agrees_with_enumeration_on_polytopes() {
    let kinds = [
        Kind::Cuboid,
        Kind::Prism,
        Kind::Hull16,
        Kind::Triangle,
        Kind::Segment,
    ];
    for family in [
        Family::Apart,
        Family::Penetrating,
        Family::Concentric,
        Family::AxisAligned,
    ] {
        for (number, a) in kinds.into_iter().enumerate() {
            for (shift, seed) in (0..8_u64).enumerate() {
                let b = kinds[(number + shift) % kinds.len()];
                let pair = family.pair([a, b], seed);
                let [a, b] = [&*pair.shapes[0], &*pair.shapes[1]];
                let truth = Scene::new(&a.core, &b.core, &pair.a_from_b)
                    .truth()
                    .separation;
                let (found, normal) = Search::new(a, b, &pair.a_from_b).best();
                assert!(found <= truth + 1e-13, "{found} {truth}");
                assert!((normal.length() - 1.0).abs() < 1e-14);
                assert!(found >= truth - 1e-9 * pair.size, "{found} {truth}");
            }
        }
    }
}

fn many_corners(body: &Turned) -> Core {
    let outline = |radius: f64, z: f64| {
        let corner = move |i: i32| {
            let angle = std::f64::consts::TAU * f64::from(i) / 720.0;
            DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
        };
        (0..720).map(corner)
    };
    let [base, top] = body.radii;
    let points: Vec<DVec3> = outline(base, -body.half_length)
        .chain(outline(top, body.half_length))
        .collect();
    Core::of_points(&points)
}

#[test]
fn heights_and_distances_are_those_of_polygons_with_many_corners() {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    for kind in [Kind::Cylinder, Kind::Cone, Kind::Cone] {
        let body = kind.shape(&Form::PLAIN, &mut random).body.turned();
        let body = body.expect("a solid of revolution");
        let core = many_corners(&body);
        for _ in 0..200 {
            let direction = unit(&mut random);
            let heights = core.vertices.iter().map(|vertex| vertex.dot(direction));
            let height = heights.fold(f64::NEG_INFINITY, f64::max);
            let more = body.height(direction) - height;
            assert!((-1e-15..1e-5).contains(&more), "{more}");
            let point = unit(&mut random) * random.random_range(0.0..1.5);
            let less = core.distance_to(point) - body.distance_to(point);
            assert!((-1e-15..1e-5).contains(&less), "{less} {body:?} {point}");
        }
    }
}

#[test]
fn closed_forms_are_found() {
    let shape = |body| Shape::new(body, 0.0);
    let rod = shape(Body::Cylinder(Cylinder {
        half_length: 0.5,
        radius: 0.2,
    }));
    let cone = shape(Body::Cone(Cone {
        half_length: 0.4,
        base_radius: 0.4,
        top_radius: 0.0,
    }));
    let floor = shape(Body::Cuboid(DVec3::new(2.0, 2.0, 0.5)));
    let quarter = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let half = DQuat::from_rotation_x(std::f64::consts::PI);
    for gap in [0.3, 1e-6, -1e-6, -0.1] {
        let beside = DVec3::new(0.6, 0.8, 0.0) * (0.4 + gap);
        for (a, b, pose) in [
            (&rod, &rod, Pose::from_translation(beside)),
            (&rod, &rod, Pose::new(quarter, DVec3::X * (0.4 + gap))),
            (&floor, &rod, Pose::from_translation(DVec3::Z * (1.0 + gap))),
            (&floor, &rod, Pose::new(quarter, DVec3::Z * (0.7 + gap))),
            (&floor, &cone, Pose::new(half, DVec3::Z * (0.9 + gap))),
        ] {
            let found = Search::new(a, b, &pose).best().0;
            assert!((found - gap).abs() < 1e-12, "{found} {gap}");
        }
    }
}
