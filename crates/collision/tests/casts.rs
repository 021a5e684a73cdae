//! Casts against closed forms and against their own definition.

use glam::{DQuat, DVec3};
use pliant_collision::{
    Cone, Cuboid, Point, Rounded, Segment, SimplexCache, cast_ray, cast_shape, distance, overlap,
};
use pliant_spatial::Pose;
use proptest::prelude::{Strategy, prop_assert, proptest};

const BOX: Cuboid = Cuboid {
    half: DVec3::new(0.3, 0.2, 0.1),
};

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    let range = -size..size;
    (range.clone(), range.clone(), range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Entry of a ray into an axis-parallel box: the latest of the three slab entries, unless a slab is left before.
fn slab_entry(half: DVec3, origin: DVec3, direction: DVec3) -> Option<f64> {
    let t0 = (-half - origin) / direction;
    let t1 = (half - origin) / direction;
    let entry = t0.min(t1).max_element();
    let exit = t0.max(t1).min_element();
    (entry <= exit && entry >= 0.0).then_some(entry)
}

/// A unit ball at offset 0.5: 3 − √0.75 from −3, however far the ray may go.
#[test]
fn the_length_allowed_to_a_ray_does_not_matter() {
    let ball = Rounded::sphere(DVec3::ZERO, 1.0);
    let expected = 3.0 - 0.75_f64.sqrt();
    for longest in [5.0, 1e9, 1e15, f64::MAX, f64::INFINITY] {
        let hit = cast_ray(&ball, DVec3::new(-3.0, 0.5, 0.0), DVec3::X, longest).expect("hit");
        assert!((hit.distance - expected).abs() < 1e-14, "{longest} {hit:?}");
        assert!(cast_ray(&ball, DVec3::new(-3.0, 1.05, 0.0), DVec3::X, longest).is_none());
    }
}

/// Thrown back along the normal from 7e-7 m beside a rim: the last stops are rounding away from it, on either side.
#[test]
fn a_point_beside_a_disc_is_met_at_its_rim() {
    let disc = Cone {
        half_length: 0.0,
        base_radius: f64::from_bits(0x3fd7_5142_fd36_8d92),
        top_radius: 0.0,
    };
    let place = [
        0xbfd2_a373_ea6b_0f9b,
        0xbfcc_05ac_8f52_0227,
        0x3ea3_8a60_9612_0000,
    ];
    let pose = Pose::from_translation(DVec3::from_array(place.map(f64::from_bits)));
    let point = Point(DVec3::ZERO);
    let found = distance(&disc, &point, &pose, &mut SimplexCache::default()).expect("apart");
    let motion = -found.normal * (found.separation + 0.18);
    let hit = cast_shape(&disc, &point, &pose, motion, &mut SimplexCache::default());
    let travelled = hit.expect("thrown at it").fraction * motion.length();
    assert!((travelled - found.separation).abs() < 1e-12, "{travelled}");
}

/// What is met first is also the end of the shape along the ray: flat targets square to it, and points.
#[test]
fn an_endless_ray_meets_targets_without_depth() {
    let plate = Cuboid {
        half: DVec3::new(0.3, 0.2, 0.0),
    };
    for i in 0..2000 {
        let away = 0.37 + 0.013_7 * f64::from(i);
        let off = DVec3::new(0.1, -0.07, 0.0);
        let hit = cast_ray(&plate, off + DVec3::Z * away, DVec3::NEG_Z, f64::INFINITY);
        assert!((hit.expect("plate").distance - away).abs() <= 4e-16 * away);
        let towards = DVec3::new(f64::from(i) - 1000.0, 300.0, -700.0).normalize();
        let hit = cast_ray(&Point(off), off - towards * away, towards, f64::INFINITY);
        assert!((hit.expect("point").distance - away).abs() <= 1e-14 * away);
    }
}

#[test]
fn lengths_that_are_none_hit_nothing() {
    for longest in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        assert!(cast_ray(&BOX, DVec3::X, DVec3::NEG_X, longest).is_none());
        assert!(cast_ray(&BOX, DVec3::ZERO, DVec3::X, longest).is_none());
    }
    let pose = Pose::from_translation(DVec3::X);
    for motion in [DVec3::NAN, DVec3::NEG_X * f64::INFINITY] {
        let cache = &mut SimplexCache::default();
        assert!(cast_shape(&BOX, &BOX, &pose, motion, cache).is_none());
    }
}

#[test]
fn ray_meets_face_edge_and_corner_of_a_box() {
    let hit = cast_ray(&BOX, DVec3::new(0.1, 0.05, 1.0), DVec3::NEG_Z, 2.0).expect("face");
    assert!((hit.distance - 0.9).abs() < 1e-15);
    assert!((hit.normal - DVec3::Z).length() < 1e-14);
    let diagonal = DVec3::new(-1.0, 0.0, -1.0).normalize();
    let origin = DVec3::new(0.3, 0.0, 0.1) - diagonal * 0.5;
    let hit = cast_ray(&BOX, origin, diagonal, 2.0).expect("edge");
    assert!((hit.distance - 0.5).abs() < 1e-14, "{hit:?}");
    assert!((hit.point - DVec3::new(0.3, 0.0, 0.1)).length() < 1e-14);
    assert!(cast_ray(&BOX, origin, diagonal, 0.499).is_none());
    assert!(cast_ray(&BOX, origin, -diagonal, 2.0).is_none());
    let inside = cast_ray(&BOX, DVec3::new(0.0, 0.0, 0.08), DVec3::X, 1.0).expect("inside");
    assert!(inside.distance == 0.0 && (inside.normal - DVec3::Z).length() < 1e-14);
}

#[test]
fn ray_meets_a_sphere_also_when_grazing() {
    let sphere = Rounded {
        core: Point(DVec3::ZERO),
        radius: 0.5,
    };
    for offset in [0.0, 0.1, 0.4, 0.4999, 0.499_999_999] {
        let hit = cast_ray(&sphere, DVec3::new(-2.0, offset, 0.0), DVec3::X, 10.0).expect("hit");
        let expected = 2.0 - (0.25 - offset * offset).sqrt();
        assert!((hit.distance - expected).abs() < 1e-9, "{offset} {hit:?}");
        assert!((hit.normal - hit.point / 0.5).length() < 1e-9, "{offset}");
    }
    assert!(cast_ray(&sphere, DVec3::new(-2.0, 0.500_001, 0.0), DVec3::X, 10.0).is_none());
}

proptest! {
    #[test]
    fn rays_enter_boxes_where_the_slabs_say(origin in vector(1.0), target in vector(0.5)) {
        let Some(direction) = (target - origin).try_normalize() else { return Ok(()); };
        let outside = !overlap(&BOX, &Point(origin), &Pose::IDENTITY, &mut SimplexCache::default());
        if outside {
            let hit = cast_ray(&BOX, origin, direction, 10.0);
            let expected = slab_entry(BOX.half, origin, direction);
            match (hit, expected) {
                (Some(hit), Some(expected)) => {
                    prop_assert!((hit.distance - expected).abs() < 1e-12, "{hit:?} {expected}");
                    prop_assert!(hit.normal.dot(direction) < 0.0);
                }
                (None, None) => {}
                // Only a ray within rounding of an edge may be judged either way.
                (hit, expected) => prop_assert!(false, "{hit:?} {expected:?}"),
            }
        }
    }

    #[test]
    fn a_cast_stops_at_touching_and_never_sooner(
        axis in vector(3.0), from in vector(1.5), motion in vector(3.0), radius in 0.0..0.2,
    ) {
        let capsule = Rounded { core: Segment { a: DVec3::NEG_Z * 0.4, b: DVec3::Z * 0.4 }, radius };
        let pose = Pose::new(DQuat::from_scaled_axis(axis), from);
        let start = distance(&BOX, &capsule, &pose, &mut SimplexCache::default());
        let hit = cast_shape(&BOX, &capsule, &pose, motion, &mut SimplexCache::default());
        let moved = |fraction: f64| Pose::new(pose.rotation, from + motion * fraction);
        let gap = |fraction| distance(&BOX, &capsule, &moved(fraction), &mut SimplexCache::default())
            .map_or(0.0, |found| found.separation);
        match (start, hit) {
            (None, hit) => prop_assert!(hit.is_some_and(|hit| hit.fraction == 0.0)),
            (Some(_), Some(hit)) => {
                prop_assert!(gap(hit.fraction) < 1e-12, "{hit:?}");
                prop_assert!(hit.normal.dot(motion) < 0.0);
                for step in 0..10 {
                    let before = hit.fraction * f64::from(step) / 10.0;
                    prop_assert!(gap(before) > 0.0 || hit.fraction < 1e-9, "{hit:?} {before}");
                }
            }
            (Some(_), None) => {
                for step in 0..=20 {
                    prop_assert!(gap(f64::from(step) / 20.0) > 0.0);
                }
            }
        }
    }
}
