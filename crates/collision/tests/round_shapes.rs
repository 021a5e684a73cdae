//! Cylinders and cones where the distance or depth has a closed form, in three sizes, in both roles, by all queries.

use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cone, Cuboid, Cylinder, Point, Rim, Rounded, SimplexCache, SupportMap,
    SupportPoint, cast_ray, cast_shape, closest_points, distance, overlap,
};
use pliant_spatial::Pose;

/// Of the size.
const TOLERANCE: f64 = 1e-9;

/// A shape and the same shape enlarged.
trait Scaled: SupportMap + Copy {
    fn scaled(&self, factor: f64) -> Self;
}

impl Scaled for Cylinder {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            half_length: self.half_length * factor,
            radius: self.radius * factor,
        }
    }
}

impl Scaled for Cone {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            half_length: self.half_length * factor,
            base_radius: self.base_radius * factor,
            top_radius: self.top_radius * factor,
        }
    }
}

impl Scaled for Cuboid {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            half: self.half * factor,
        }
    }
}

impl Scaled for Point {
    fn scaled(&self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl<S: Scaled> Scaled for Rounded<S> {
    fn scaled(&self, factor: f64) -> Self {
        Self {
            core: self.core.scaled(factor),
            radius: self.radius * factor,
        }
    }
}

/// Counts the support calls of a shape.
struct Counted<'s, S> {
    shape: S,
    calls: &'s Cell<u32>,
}

impl<S: SupportMap> SupportMap for Counted<'_, S> {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.calls.set(self.calls.get() + 1);
        self.shape.support(direction, start)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.shape.vertex(index)
    }

    fn radius(&self) -> f64 {
        self.shape.radius()
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        self.shape.rim(index)
    }

    fn interior_point(&self) -> DVec3 {
        self.shape.interior_point()
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        self.shape.core_segment()
    }
}

fn inverse(pose: &Pose) -> Pose {
    let back = pose.rotation.conjugate();
    Pose::new(back, -(back * pose.translation))
}

/// Separation of the supporting planes across a normal.
fn gap(a: &impl SupportMap, b: &impl SupportMap, a_from_b: &Pose, normal: DVec3) -> f64 {
    let on_a = a.support(normal, 0).point;
    let on_b = b.support(a_from_b.rotation.conjugate() * -normal, 0).point;
    (a_from_b.transform_point(on_b) - on_a).dot(normal) - (a.radius() + b.radius())
}

/// Every query on a pair of about unit size, as it is, tiny and huge, and with the roles swapped.
fn check<A: Scaled, B: Scaled>(a: &A, b: &B, a_from_b: &Pose, expected: f64) {
    for factor in [1.0, 1e-6, 1e4] {
        let (a, b) = (a.scaled(factor), b.scaled(factor));
        let pose = Pose::new(a_from_b.rotation, a_from_b.translation * factor);
        check_queries(&a, &b, &pose, [expected * factor, factor]);
        check_queries(&b, &a, &inverse(&pose), [expected * factor, factor]);
    }
}

fn check_queries<A: SupportMap, B: SupportMap>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
    [expected, size]: [f64; 2],
) {
    let mut cache = SimplexCache::default();
    for how in ["cold", "warm"] {
        let found = closest_points(a, b, a_from_b, &mut cache);
        let ClosestPoints {
            witness_a,
            witness_b,
            normal,
            separation,
        } = found;
        let tell = format!("{how}, size {size}: {expected:e} expected, {found:?}");
        assert!((separation - expected).abs() <= TOLERANCE * size, "{tell}");
        assert!((normal.length() - 1.0).abs() < 1e-12, "{tell}");
        let gap = gap(a, b, a_from_b, normal);
        assert!((gap - separation).abs() <= TOLERANCE * size, "{gap} {tell}");
        let oblique = (witness_b - witness_a) - normal * separation;
        assert!(oblique.length() <= TOLERANCE * size, "{oblique} {tell}");
    }
    let mut cache = SimplexCache::default();
    let meets = overlap(a, b, a_from_b, &mut cache);
    let apart = distance(a, b, a_from_b, &mut SimplexCache::default());
    if expected.abs() > 1e-12 * size {
        assert_eq!(meets, expected < 0.0);
        assert_eq!(apart.is_some(), expected > 0.0);
    }
    if expected > 1e-12 * size {
        let normal = apart.expect("apart").normal;
        let motion = -normal * (expected + 0.2 * size);
        let hit = cast_shape(a, b, a_from_b, motion, &mut SimplexCache::default());
        let travelled = hit.expect("thrown at it").fraction * motion.length();
        assert!((travelled - expected).abs() <= TOLERANCE * size);
    }
}

fn cylinder(half_length: f64, radius: f64) -> Cylinder {
    Cylinder {
        half_length,
        radius,
    }
}

/// Pointed; half an opening of atan 0.5.
fn cone() -> Cone {
    Cone {
        half_length: 0.4,
        base_radius: 0.4,
        top_radius: 0.0,
    }
}

/// 2 m wide, its top at z = 0.
const FLOOR: Cuboid = Cuboid {
    half: DVec3::new(2.0, 2.0, 0.5),
};

fn over_floor(rotation: DQuat, height: f64) -> Pose {
    Pose::new(rotation, DVec3::new(0.13, -0.21, 0.5 + height))
}

#[test]
fn cylinder_and_ball_or_point() {
    let body = cylinder(0.5, 0.3);
    for radius in [0.0, 0.2] {
        for angle in [0.0, 0.3, FRAC_PI_2, 2.0, -2.5] {
            let outward = DVec3::new(f64::cos(angle), f64::sin(angle), 0.0);
            let at = |radial: f64, z: f64, expected: f64| {
                let pose = Pose::from_translation(outward * radial + DVec3::Z * z);
                let expected = expected - radius;
                if radius == 0.0 {
                    check(&body, &Point(DVec3::ZERO), &pose, expected);
                }
                check(
                    &body,
                    &Rounded::sphere(DVec3::ZERO, radius),
                    &pose,
                    expected,
                );
            };
            at(0.8, 0.1, 0.5);
            at(0.3 + 1e-7, -0.2, 1e-7);
            at(0.1, 1.0, 0.5);
            at(0.6, 0.9, 0.5);
            at(0.6, -0.9, 0.5);
            at(0.2, 0.0, -0.1);
            at(0.2, 0.45, -0.05);
            at(0.3 - 1e-6, 0.1, -1e-6);
            at(0.01, -0.1, -0.29);
        }
        let flat = cylinder(0.2, 0.9);
        check(
            &flat,
            &Rounded::sphere(DVec3::ZERO, radius),
            &Pose::IDENTITY,
            -0.2 - radius,
        );
    }
}

#[test]
fn cylinder_on_a_floor_upright_lying_and_tilted() {
    let body = cylinder(0.5, 0.3);
    for gap in [0.4, 1e-3, 1e-7, 0.0, -1e-7, -1e-3, -0.1] {
        for spin in [0.0, 0.7] {
            let spin = DQuat::from_rotation_z(spin);
            check(&FLOOR, &body, &over_floor(spin, 0.5 + gap), gap);
            let lying = spin * DQuat::from_rotation_x(FRAC_PI_2);
            check(&FLOOR, &body, &over_floor(lying, 0.3 + gap), gap);
            for tilt in [1e-12_f64, 1e-7, 1e-3, 0.4, 1.2] {
                let tilted = spin * DQuat::from_rotation_y(tilt);
                let reach = 0.5 * tilt.cos() + 0.3 * tilt.sin();
                check(&FLOOR, &body, &over_floor(tilted, reach + gap), gap);
            }
        }
    }
}

#[test]
fn cylinders_coaxial_parallel_and_crossed() {
    let (a, b) = (cylinder(0.5, 0.3), cylinder(0.4, 0.2));
    let quarter = DQuat::from_rotation_x(FRAC_PI_2);
    for gap in [0.3, 1e-7, 0.0, -1e-7, -0.05] {
        for spin in [0.0, 0.4] {
            let spin = DQuat::from_rotation_z(spin);
            check(&a, &b, &Pose::new(spin, DVec3::Z * (0.9 + gap)), gap);
            let aside = DVec3::new(0.6, 0.8, 0.0) * (0.5 + gap);
            check(&a, &b, &Pose::new(spin, aside + DVec3::Z * 0.1), gap);
            let crossed = Pose::new(quarter, DVec3::new(0.5 + gap, 0.05, -0.1));
            check(&a, &b, &crossed, gap);
        }
    }
    check(&a, &b, &Pose::new(quarter, DVec3::ZERO), -0.5);
    check(&a, &b, &Pose::new(quarter, DVec3::X * 0.1), -0.4);
    // Coaxial and short: the way out is along the axis.
    let short = cylinder(0.1, 0.3);
    check(&short, &short, &Pose::IDENTITY, -0.2);
    check(
        &short,
        &short,
        &Pose::from_translation(DVec3::Z * 0.05),
        -0.15,
    );
}

#[test]
fn cone_against_floor_and_ball() {
    let cone = cone();
    let down = DQuat::from_rotation_x(PI);
    // Outward normal of the side.
    let side = DVec3::new(2.0, 0.0, 1.0).normalize();
    for gap in [0.3, 1e-7, 0.0, -1e-7, -0.05] {
        check(&FLOOR, &cone, &over_floor(down, 0.4 + gap), gap);
        check(&FLOOR, &cone, &over_floor(DQuat::IDENTITY, 0.4 + gap), gap);
        let tilted = DQuat::from_rotation_y(0.2) * down;
        check(
            &FLOOR,
            &cone,
            &over_floor(tilted, 0.4 * f64::cos(0.2) + gap),
            gap,
        );
        let lying = DQuat::from_rotation_arc(side, DVec3::NEG_Z);
        check(&FLOOR, &cone, &over_floor(lying, 0.4 * side.z + gap), gap);
        let ball = Rounded::sphere(DVec3::ZERO, 0.1);
        let on_side = DVec3::new(0.2, 0.0, 0.0) + side * (0.1 + gap);
        let spin = DQuat::from_rotation_z(0.9);
        check(&cone, &ball, &Pose::from_translation(spin * on_side), gap);
        let over_tip = DVec3::Z * (0.5 + gap.max(-0.1));
        if gap > -0.01 {
            check(&cone, &ball, &Pose::from_translation(over_tip), gap);
        }
        let under_base = DVec3::new(0.1, 0.05, -0.5 - gap);
        check(&cone, &ball, &Pose::from_translation(under_base), gap);
        let beyond_rim = DVec3::new(0.4, 0.0, -0.4) + DVec3::new(0.6, 0.0, -0.8) * (0.1 + gap);
        if gap > 0.0 {
            check(
                &cone,
                &ball,
                &Pose::from_translation(spin * beyond_rim),
                gap,
            );
        }
    }
    let frustum = Cone {
        half_length: 0.2,
        base_radius: 0.4,
        top_radius: 0.2,
    };
    let on_side = DVec3::new(0.3, 0.0, 0.0) + side * 0.25;
    check(
        &frustum,
        &Point(DVec3::ZERO),
        &Pose::from_translation(on_side),
        0.25,
    );
}

/// Depth in a pair that may have no single way out: certified, and at what cost in support calls of both shapes.
fn depth_and_calls<A: SupportMap + Copy, B: SupportMap + Copy>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
) -> (f64, u32) {
    let calls = Cell::new(0);
    let counted_a = Counted {
        shape: *a,
        calls: &calls,
    };
    let counted_b = Counted {
        shape: *b,
        calls: &calls,
    };
    let mut cache = SimplexCache::default();
    let found = closest_points(&counted_a, &counted_b, a_from_b, &mut cache);
    let gap = gap(a, b, a_from_b, found.normal);
    assert!((gap - found.separation).abs() <= TOLERANCE, "{found:?}");
    (-found.separation, calls.get())
}

/// All directions around a common axis are equally shallow: no polytope meets them all, the certified bound stands.
#[test]
fn coaxial_slender_bodies_end_in_bounded_effort() {
    let slender = cylinder(0.5, 0.2);
    let turned = Pose::new(DQuat::from_rotation_z(0.3), DVec3::ZERO);
    let shifted = Pose::from_translation(DVec3::Z * 0.01);
    let off_axis = Pose::from_translation(DVec3::X * 1e-9);
    let ball = Rounded::sphere(DVec3::ZERO, 0.1);
    let mut most = 0;
    for (pose, off) in [
        (Pose::IDENTITY, 0.0),
        (turned, 0.0),
        (shifted, 0.0),
        (off_axis, 1e-9),
    ] {
        for (expected, (depth, calls)) in [
            (0.4 - off, depth_and_calls(&slender, &slender, &pose)),
            (0.3 - off, depth_and_calls(&slender, &ball, &pose)),
        ] {
            assert!((depth - expected).abs() <= TOLERANCE, "{depth} {expected}");
            most = most.max(calls);
        }
    }
    assert!(most <= 2500, "{most}");
}

/// Offsets from a common axis of 1e-12 to 0.03, with azimuths and heights of all signs.
fn beside_the_axis() -> impl Iterator<Item = DVec3> {
    (0..120_u32).map(|i| {
        let away = 10f64.powf(-12.0 + 0.088 * f64::from(i));
        let azimuth = 2.4 * f64::from(i);
        let height = (f64::from(i % 7) - 3.0) / 3.0;
        DVec3::new(azimuth.cos(), azimuth.sin(), height) * away
    })
}

/// The deepest answer must be the least over the azimuths, not the crest on which a search along the offset starts.
#[test]
fn cylinders_beside_a_common_axis_leave_away_from_the_offset() {
    let body = cylinder(0.6, 0.25);
    for offset in beside_the_axis() {
        let across = offset.truncate().length();
        check_queries(
            &body,
            &body,
            &Pose::from_translation(offset),
            [across - 0.5, 1e-4],
        );
        let ball = Rounded::sphere(DVec3::ZERO, 0.1);
        check_queries(
            &body,
            &ball,
            &Pose::from_translation(offset),
            [across - 0.35, 1e-4],
        );
    }
}

/// Two circles of ways out, up and down: h(n) = 2 r c + offset · n on both, c the radial and s the axial part of a side's normal.
#[test]
fn cones_beside_a_common_axis_leave_on_the_shallower_side() {
    let body = cone();
    let (c, s) = (2.0 / 5f64.sqrt(), 1.0 / 5f64.sqrt());
    for offset in beside_the_axis() {
        let depth = 0.8 * c - c * offset.truncate().length() - s * offset.z.abs();
        check_queries(
            &body,
            &body,
            &Pose::from_translation(offset),
            [-depth, 1e-4],
        );
    }
}

/// A rim is met in chords; the plane, the points and the height must come from the circle.
#[test]
fn crossed_rims_answer_to_the_last_digits() {
    let (a, b) = (cylinder(0.5, 0.3), cylinder(0.4, 0.2));
    for i in 0..400_u32 {
        let turn = DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.3 + 0.011 * f64::from(i));
        let away = DVec3::new(0.3, 0.2 - 0.001 * f64::from(i), 0.1 + 0.001 * f64::from(i));
        let pose = Pose::new(turn, away * if i % 3 == 0 { 1.0 } else { 2.5 });
        let found = closest_points(&a, &b, &pose, &mut SimplexCache::default());
        let gap = gap(&a, &b, &pose, found.normal);
        assert!((gap - found.separation).abs() < 1e-14, "{found:?}");
        let oblique = found.witness_b - found.witness_a - found.normal * found.separation;
        assert!(oblique.length() < 1e-14, "{oblique} {found:?}");
    }
}

#[test]
fn rays_meet_sides_discs_and_tips() {
    let body = cylinder(0.5, 0.3);
    let hit = |origin: DVec3, towards: DVec3| {
        let direction = towards.normalize();
        cast_ray(&body, origin, direction, 10.0).map(|hit| (hit.distance, hit.normal))
    };
    let (distance, normal) = hit(DVec3::new(2.0, 0.18, 0.1), DVec3::NEG_X).expect("the side");
    assert!((distance - (2.0 - 0.24)).abs() < 1e-12);
    assert!((normal - DVec3::new(0.8, 0.6, 0.0)).length() < 1e-6);
    let (distance, normal) = hit(DVec3::new(0.1, 0.2, 3.0), DVec3::NEG_Z).expect("the disc");
    assert!((distance - 2.5).abs() < 1e-12);
    assert!((normal - DVec3::Z).length() < 1e-9);
    assert!(hit(DVec3::new(2.0, 0.3 + 1e-6, 0.0), DVec3::NEG_X).is_none());
    assert!(hit(DVec3::new(2.0, 0.0, 0.5 + 1e-6), DVec3::NEG_X).is_none());
    let onto_tip = cast_ray(&cone(), DVec3::Z * 2.0, DVec3::NEG_Z, 10.0).expect("the tip");
    assert!((onto_tip.distance - 1.6).abs() < 1e-12);
}
