//! Placements that cost other implementations half their digits: nearly parallel segments, needles, exact touching.

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, PointSet, Rounded, Segment, SimplexCache, closest_points, distance,
};
use pliant_spatial::Pose;

/// Distance by which an answer breaks `witness_b − witness_a = separation · normal` [m].
fn broken(found: &ClosestPoints) -> f64 {
    (found.witness_b - found.witness_a - found.normal * found.separation).length()
}

/// End beside end, one segment 1e-10 m aslant: the nearest point is 3e-15 m inside it, the plane across the end 8e-15 m short.
#[test]
fn a_slant_at_the_end_of_a_segment_shows_in_the_normal() {
    let a = Segment {
        a: DVec3::Y * 1.25e-6,
        b: DVec3::new(0.0, 1.25e-6, 1.25e-6),
    };
    let b = Segment {
        a: DVec3::X * -1.027_584_075_927_734_3e-10,
        b: DVec3::Z * -4e-6,
    };
    for [a, b] in [[a, b], [b, a]] {
        let found = closest_points(&a, &b, &Pose::IDENTITY, &mut SimplexCache::default());
        let expected = 1.25e-6_f64.hypot(1.027_584_075_927_734_3e-10);
        assert!((found.separation - expected).abs() < 1e-20, "{found:?}");
        assert!(broken(&found) < 1e-20, "{found:?}");
    }
}

/// A face with the newest vertex, tilted by 2e-9, is as near to rounding as the one without it, and 4e-6 m long.
#[test]
fn a_sliver_as_near_as_the_face_before_it_is_taken() {
    let rod = PointSet(&[
        DVec3::new(-1e-23, -4e-6, -1.234_313_726_425_170_7e-6),
        DVec3::new(9.313_225_746_154_784e-15, -5e-23, 4.9e-22),
    ]);
    let plate = Cuboid {
        half: DVec3::new(4.9e-22, 9.313_225_746_154_784e-15, 3.125e-8),
    };
    let turn = DQuat::from_xyzw(
        -0.015_624_206_527_661_326,
        -4.999_746_088_851_626e-18,
        -0.007_781_468_032_220_489,
        0.999_847_654_858_301_2,
    );
    let before = Pose::new(turn, DVec3::new(-7.8e-22, -1e-23, 0.0));
    let mut cache = SimplexCache::default();
    closest_points(&rod, &plate, &before, &mut cache);
    for _ in 0..2 {
        let found = closest_points(&rod, &plate, &Pose::IDENTITY, &mut cache);
        assert!(
            (found.separation - 9.313_225e-15).abs() < 1e-20,
            "{found:?}"
        );
        let apart = distance(&rod, &plate, &Pose::IDENTITY, &mut cache);
        assert!(apart.is_some());
    }
}

#[test]
fn segments_that_cross_almost_parallel_touch() {
    let half = DVec3::new(0.3, -0.1, 0.2);
    let segment = Segment { a: -half, b: half };
    let across = half.cross(DVec3::X).normalize();
    for angle in [1e-15, 1e-12, 1e-10, 1e-8, 1e-6, 1e-3] {
        let turned = Pose::new(DQuat::from_axis_angle(across, angle), DVec3::ZERO);
        let found = closest_points(&segment, &segment, &turned, &mut SimplexCache::default());
        assert!(found.separation.abs() < 1e-15, "{angle:e} {found:?}");
        assert!(broken(&found) < 1e-15, "{angle:e} {found:?}");
        // Supporting: no end of either passes the plane.
        let reach = (turned.rotation * half).dot(found.normal).abs() + half.dot(found.normal).abs();
        assert!(reach < 1e-15, "{angle:e} {reach:e}");
    }
}

#[test]
fn capsules_that_pass_almost_parallel_keep_their_gap() {
    let segment = Segment {
        a: DVec3::NEG_X,
        b: DVec3::X,
    };
    let capsule = Rounded {
        core: segment,
        radius: 0.1,
    };
    for angle in [0.0, 1e-14, 1e-9, 1e-7, 1e-4] {
        for height in [0.5, 0.2 + 1e-9, 0.1, 1e-4] {
            let pose = Pose::new(DQuat::from_rotation_z(angle), DVec3::Z * height);
            let found = closest_points(&capsule, &capsule, &pose, &mut SimplexCache::default());
            assert!(
                (found.separation - (height - 0.2)).abs() < 1e-15,
                "{angle:e} {found:?}"
            );
            assert!((found.normal - DVec3::Z).length() < 1e-12, "{found:?}");
        }
    }
}

#[test]
fn a_long_needle_through_a_small_box_keeps_the_contract() {
    // 10⁴ : 1, so that a plane taken at the wrong corner of a triangle is off by 1e-8 of the box.
    let needle = Segment {
        a: DVec3::new(-6000.0, -900.0, 2300.0),
        b: DVec3::new(6000.0, 900.0, -2300.0),
    };
    let small = Cuboid {
        half: DVec3::new(0.4, 0.5, 0.3),
    };
    for step in 0..200 {
        let angle = 0.1 * f64::from(step);
        let axis = DVec3::new(angle.sin(), angle.cos(), 1.0).normalize();
        let pose = Pose::new(
            DQuat::from_axis_angle(axis, 3.0 * angle),
            DVec3::new(0.1, 0.2 * angle.sin(), -0.1),
        );
        let found = closest_points(&needle, &small, &pose, &mut SimplexCache::default());
        assert!(
            broken(&found) < 1e-10,
            "{step} {found:?} {:e}",
            broken(&found)
        );
        // The box may move out along the normal: the needle then is the line beside its supporting corner.
        let along = pose.rotation.inverse() * found.normal;
        let needle_top = needle.b.dot(found.normal).max(needle.a.dot(found.normal));
        let reach = pose.translation.dot(found.normal) - small.half.dot(along.abs()) - needle_top;
        assert!((reach - found.separation).abs() < 1e-9, "{step} {found:?}");
    }
}

#[test]
fn overlap_warm_is_overlap_cold() {
    // Steps small and large, so that surfaces are confirmed, grown and given up.
    let a = Cuboid {
        half: DVec3::new(0.5, 0.3, 0.4),
    };
    let b = Cuboid {
        half: DVec3::new(0.3, 0.35, 0.25),
    };
    for (seed, stride) in [(0.0, 1e-3), (1.0, 1e-2), (2.0, 0.1), (3.0, 0.7)] {
        let mut warm = SimplexCache::default();
        for step in 0..400 {
            let phase = seed + stride * f64::from(step);
            let axis = DVec3::new(phase.sin(), (1.3 * phase).cos(), 0.4).normalize();
            let pose = Pose::new(
                DQuat::from_axis_angle(axis, 1.7 * phase),
                DVec3::new((0.9 * phase).sin(), (1.1 * phase).sin(), 0.3) * 0.4,
            );
            let found = closest_points(&a, &b, &pose, &mut warm);
            let cold = closest_points(&a, &b, &pose, &mut SimplexCache::default());
            assert!(
                (found.separation - cold.separation).abs() < 1e-14,
                "{stride} {step}: {found:?} {cold:?}"
            );
            assert!(broken(&found) < 1e-14, "{stride} {step}: {found:?}");
        }
    }
}
