//! Two convex shapes at a placement, and what every query must say about them.

use arbitrary::Arbitrary;
use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, PointSet, Rim, Rounded, Segment, SimplexCache, SupportMap, SupportPoint,
    cast_ray, cast_shape, closest_points, distance, overlap,
};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

use crate::mesh::judge_hull;

/// Largest error of any answer, relative to the largest coordinate at hand.
pub(crate) const TOLERANCE: f64 = 1e-9;

/// Points of one shape: enough for every degeneracy, few enough for thousands of runs a second.
const MOST_POINTS: usize = 16;

/// Two shapes, how they lie to each other, and where the second goes.
#[derive(Arbitrary, Debug)]
pub struct Pair {
    a: Description,
    b: Description,
    placement: Placement,
    next: Placement,
    motion: [Number; 3],
    /// Power of ten of all lengths, modulo 13, from 1e-6 on.
    size: u8,
}

#[derive(Arbitrary, Debug)]
pub(crate) enum Description {
    Points(Vec<[Number; 3]>),
    Hull(Vec<[Number; 3]>),
    Box([Number; 3]),
    Capsule([Number; 3], [Number; 3], u8),
}

#[derive(Arbitrary, Debug)]
pub(crate) struct Placement {
    turn: Turn,
    offset: [Number; 3],
}

#[derive(Arbitrary, Debug)]
pub(crate) enum Turn {
    None,
    /// Parallel but for rounding.
    Hair([i8; 3]),
    Quarter([i8; 3]),
    Any([Number; 3]),
}

/// A coordinate: on a coarse grid, where ties abound, beside it by rounding, or anywhere in between.
#[derive(Arbitrary, Clone, Copy, Debug)]
pub(crate) enum Number {
    Grid(i8),
    Beside(i8, i8),
    Fine(i32),
    Tiny(i8),
}

/// A shape of any kind.
pub(crate) enum Shape {
    Points(Vec<DVec3>),
    Hull(ConvexMesh),
    Box(Cuboid),
    Capsule(Rounded<Segment>),
}

impl Number {
    /// In [-4, 4].
    pub(crate) fn get(self) -> f64 {
        match self {
            Self::Grid(value) => f64::from(value) / 32.0,
            Self::Beside(value, by) => {
                f64::from(value) / 32.0 * (1.0 + f64::from(by) * f64::EPSILON)
            }
            Self::Fine(value) => f64::from(value) / f64::from(1 << 29),
            Self::Tiny(value) => f64::from(value) * 1e-17,
        }
    }
}

pub(crate) fn vector(numbers: [Number; 3]) -> DVec3 {
    DVec3::from(numbers.map(Number::get))
}

pub(crate) fn points(numbers: &[[Number; 3]], size: f64) -> Vec<DVec3> {
    numbers
        .iter()
        .take(MOST_POINTS)
        .map(|&n| vector(n) * size)
        .collect()
}

impl Description {
    /// The shape; hulls without a volume stay sets of points.
    pub(crate) fn shape(&self, size: f64) -> Shape {
        match self {
            Self::Points(numbers) => Shape::Points(points(numbers, size)),
            Self::Hull(numbers) => {
                let points = points(numbers, size);
                judge_hull(&points).map_or(Shape::Points(points), Shape::Hull)
            }
            Self::Box(numbers) => Shape::Box(Cuboid {
                half: vector(*numbers).abs() * size,
            }),
            Self::Capsule(a, b, radius) => Shape::Capsule(Rounded {
                core: Segment {
                    a: vector(*a) * size,
                    b: vector(*b) * size,
                },
                radius: f64::from(*radius) / 64.0 * size,
            }),
        }
    }
}

impl Placement {
    pub(crate) fn pose(&self, size: f64) -> Pose {
        let rotation = match self.turn {
            Turn::None => DQuat::IDENTITY,
            Turn::Hair(axis) => DQuat::from_scaled_axis(DVec3::from(axis.map(f64::from)) * 1e-17),
            Turn::Quarter(axis) => {
                let [x, y, z] = axis.map(|part| f64::from(part) * std::f64::consts::FRAC_PI_2);
                DQuat::from_rotation_x(x) * DQuat::from_rotation_y(y) * DQuat::from_rotation_z(z)
            }
            Turn::Any(axis) => DQuat::from_scaled_axis(vector(axis)),
        };
        Pose::new(rotation.normalize(), vector(self.offset) * size)
    }
}

impl Shape {
    fn ask<T>(&self, ask: impl FnOnce(&dyn SupportMap) -> T) -> T {
        match self {
            Self::Points(points) => ask(&PointSet(points)),
            Self::Hull(hull) => ask(hull),
            Self::Box(cuboid) => ask(cuboid),
            Self::Capsule(capsule) => ask(capsule),
        }
    }
}

impl SupportMap for Shape {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.ask(|shape| shape.support(direction, start))
    }

    fn rough_support(&self, direction: DVec3) -> Option<SupportPoint> {
        self.ask(|shape| shape.rough_support(direction))
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.ask(|shape| shape.vertex(index))
    }

    fn radius(&self) -> f64 {
        self.ask(|shape| shape.radius())
    }

    fn interior_point(&self) -> DVec3 {
        self.ask(|shape| shape.interior_point())
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        self.ask(|shape| shape.core_segment())
    }

    fn core_box(&self) -> Option<DVec3> {
        self.ask(|shape| shape.core_box())
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        self.ask(|shape| shape.rim(index))
    }

    fn core_face_count(&self) -> u32 {
        self.ask(|shape| shape.core_face_count())
    }

    fn core_face(&self, face: u32) -> DVec3 {
        self.ask(|shape| shape.core_face(face))
    }
}

/// Panics unless all queries keep their contract on this pair, cold and with what other queries left behind.
pub fn judge_pair(pair: &Pair) {
    let size = 10_f64.powi(i32::from(pair.size % 13) - 6);
    let (a, b) = (pair.a.shape(size), pair.b.shape(size));
    let mut warm = SimplexCache::default();
    let first = judge_placement(&a, &b, &pair.placement.pose(size), &mut warm);
    judge_placement(&a, &b, &pair.next.pose(size), &mut warm);
    let again = judge_placement(&a, &b, &pair.placement.pose(size), &mut warm);
    let scale = coordinates(&a, &b, &pair.placement.pose(size));
    assert!(
        (first.separation - again.separation).abs() <= TOLERANCE * scale,
        "warm {again:?}, cold {first:?}"
    );
    judge_casts(
        &a,
        &b,
        &pair.placement.pose(size),
        vector(pair.motion) * size,
    );
}

/// The largest coordinate of a shape in its own frame.
pub(crate) fn reach(shape: &Shape) -> f64 {
    let furthest = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let furthest = furthest.map(|axis| shape.support(axis, 0).point.abs().max_element());
    furthest.fold(shape.radius(), f64::max)
}

/// The largest coordinate that occurs in the query.
fn coordinates(a: &Shape, b: &Shape, a_from_b: &Pose) -> f64 {
    reach(a) + reach(b) + a_from_b.translation.abs().max_element()
}

/// Signed gap between the supporting planes of both shapes along a unit normal.
fn support_gap(a: &Shape, b: &Shape, a_from_b: &Pose, normal: DVec3) -> f64 {
    let in_b = a_from_b.inverse_transform_vector(normal);
    let nearest_of_b = normal.dot(a_from_b.transform_point(b.support(-in_b, 0).point)) - b.radius();
    nearest_of_b - normal.dot(a.support(normal, 0).point) - a.radius()
}

fn judge_placement(
    a: &Shape,
    b: &Shape,
    a_from_b: &Pose,
    warm: &mut SimplexCache,
) -> ClosestPoints {
    let scale = coordinates(a, b, a_from_b);
    let error = TOLERANCE * scale;
    let cold = closest_points(a, b, a_from_b, &mut SimplexCache::default());
    for closest in [cold, closest_points(a, b, a_from_b, warm)] {
        let ClosestPoints {
            witness_a,
            witness_b,
            normal,
            separation,
        } = closest;
        assert!(
            separation.is_finite() && witness_a.is_finite() && witness_b.is_finite(),
            "{closest:?}"
        );
        assert!(
            (normal.length() - 1.0).abs() <= 1e-9,
            "no unit normal: {closest:?}"
        );
        let step = witness_b - witness_a - normal * separation;
        assert!(
            step.length() <= error,
            "the witnesses are {step} off: {closest:?}"
        );
        let gap = support_gap(a, b, a_from_b, normal);
        assert!(
            (gap - separation).abs() <= error,
            "the supports are {gap} apart: {closest:?}"
        );
        assert!(
            (separation - cold.separation).abs() <= error,
            "warm {closest:?}, cold {cold:?}"
        );
        judge_shallowest(a, b, a_from_b, &closest);
    }
    let apart = distance(a, b, a_from_b, warm);
    if cold.separation.abs() > error {
        assert_eq!(
            apart.is_some(),
            cold.separation > 0.0,
            "{apart:?}, {cold:?}"
        );
        let overlaps = overlap(a, b, a_from_b, warm);
        assert_eq!(overlaps, cold.separation < 0.0, "{cold:?}");
    }
    if let Some(apart) = apart {
        assert!(
            (apart.separation - cold.separation).abs() <= error,
            "{apart:?}, {cold:?}"
        );
    }
    cold
}

/// No direction separates the shapes by more than the separation, which is thus the distance or the least depth; and no
/// witness sticks out of its shape.
fn judge_shallowest(a: &Shape, b: &Shape, a_from_b: &Pose, closest: &ClosestPoints) {
    let error = TOLERANCE * coordinates(a, b, a_from_b);
    let witness_in_b = a_from_b.inverse_transform_point(closest.witness_b);
    let steps = [-1.0, 0.0, 1.0];
    let grid = steps
        .into_iter()
        .flat_map(move |x| steps.map(|y| DVec3::new(x, y, 0.0)))
        .flat_map(move |xy| steps.map(|z| xy + DVec3::Z * z))
        .filter(|direction| *direction != DVec3::ZERO);
    for step in grid {
        let around = [1e-2, 1e-5, 1e-8].map(|by| closest.normal + by * step);
        for direction in [step, a_from_b.transform_vector(step)]
            .into_iter()
            .chain(around)
        {
            let direction = direction.normalize();
            let gap = support_gap(a, b, a_from_b, direction);
            assert!(
                gap <= closest.separation + error,
                "{gap} apart along {direction}: {closest:?}"
            );
            let beyond = |shape: &Shape, point: DVec3, direction: DVec3| {
                let top = shape.support(direction, 0).point;
                direction.dot(point - top) - shape.radius()
            };
            let out = beyond(a, closest.witness_a, direction);
            assert!(out <= error, "witness A is {out} out: {closest:?}");
            let in_b = a_from_b.inverse_transform_vector(direction);
            let out = beyond(b, witness_in_b, in_b);
            assert!(out <= error, "witness B is {out} out: {closest:?}");
        }
    }
}

fn judge_casts(a: &Shape, b: &Shape, a_from_b: &Pose, motion: DVec3) {
    let at = |fraction: f64| Pose::new(a_from_b.rotation, a_from_b.translation + motion * fraction);
    let error = TOLERANCE * (coordinates(a, b, a_from_b) + motion.length());
    let gap = |pose: &Pose| closest_points(a, b, pose, &mut SimplexCache::default()).separation;
    match cast_shape(a, b, a_from_b, motion, &mut SimplexCache::default()) {
        Some(hit) => {
            assert!((0.0..=1.0).contains(&hit.fraction), "{hit:?}");
            assert!((hit.normal.length() - 1.0).abs() <= 1e-9, "{hit:?}");
            assert!(hit.witness.is_finite(), "{hit:?}");
            let gap = gap(&at(hit.fraction));
            assert!(gap <= error, "{gap} apart at the hit: {hit:?}");
            assert!(
                gap >= -error || hit.fraction == 0.0,
                "{gap} deep at the hit: {hit:?}"
            );
        }
        None => {
            for part in 0..=8 {
                let gap = gap(&at(f64::from(part) / 8.0));
                assert!(gap >= -error, "{gap} deep on a way that is called free");
            }
        }
    }
    let direction = motion.normalize_or(DVec3::X);
    if let Some(hit) = cast_ray(a, a_from_b.translation, direction, motion.length()) {
        assert!(
            hit.distance >= 0.0 && hit.distance <= motion.length() * (1.0 + 1e-12),
            "{hit:?}"
        );
        assert!(
            hit.point.is_finite() && (hit.normal.length() - 1.0).abs() <= 1e-9,
            "{hit:?}"
        );
    }
}
