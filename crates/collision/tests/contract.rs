//! The contract of `closest_points` on random pairs of every kind of shape, from far apart to deep inside, at sizes from
//! micrometres to kilometres: moving B by the separation begins or ends contact, and the two supporting planes along the
//! normal are exactly that far apart. Depths are compared with all separating axes.

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, Point, PointSet, Rim, Rounded, Segment, SimplexCache, SupportMap,
    SupportPoint, Triangle, closest_points, overlap,
};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;
use proptest::prelude::{
    ProptestConfig, Strategy, TestCaseError, prop_assert, prop_oneof, proptest,
};
use proptest::test_runner::RngSeed;

#[derive(Clone, Debug)]
enum Shape {
    Point(Point),
    Segment(Segment),
    Triangle(Triangle),
    Cuboid(Cuboid),
    Points(Vec<DVec3>),
    Capsule(Rounded<Segment>),
}

impl Shape {
    fn with<T>(&self, ask: impl FnOnce(&dyn SupportMap) -> T) -> T {
        match self {
            Self::Point(shape) => ask(shape),
            Self::Segment(shape) => ask(shape),
            Self::Triangle(shape) => ask(shape),
            Self::Cuboid(shape) => ask(shape),
            Self::Points(points) => ask(&PointSet(points)),
            Self::Capsule(shape) => ask(shape),
        }
    }

    /// Vertices of the core.
    fn vertices(&self) -> Vec<DVec3> {
        let count = match self {
            Self::Point(_) => 1,
            Self::Segment(_) | Self::Capsule(_) => 2,
            Self::Triangle(_) => 3,
            Self::Cuboid(_) => 8,
            Self::Points(points) => u32::try_from(points.len()).unwrap_or(0),
        };
        (0..count).map(|index| self.vertex(index)).collect()
    }
}

impl SupportMap for Shape {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.with(|shape| shape.support(direction, start))
    }

    fn rough_support(&self, direction: DVec3) -> Option<SupportPoint> {
        self.with(|shape| shape.rough_support(direction))
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.with(|shape| shape.vertex(index))
    }

    fn radius(&self) -> f64 {
        self.with(|shape| shape.radius())
    }

    fn interior_point(&self) -> DVec3 {
        self.with(|shape| shape.interior_point())
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        self.with(|shape| shape.core_segment())
    }

    fn core_box(&self) -> Option<DVec3> {
        self.with(|shape| shape.core_box())
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        self.with(|shape| shape.rim(index))
    }

    fn core_face_count(&self) -> u32 {
        self.with(|shape| shape.core_face_count())
    }

    fn core_face(&self, face: u32) -> DVec3 {
        self.with(|shape| shape.core_face(face))
    }
}

fn vector() -> impl Strategy<Value = DVec3> {
    let range = -1.0..1.0;
    (range.clone(), range.clone(), range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn shape() -> impl Strategy<Value = Shape> {
    let segment = || (vector(), vector()).prop_map(|(a, b)| Segment { a, b });
    prop_oneof![
        vector().prop_map(|p| Shape::Point(Point(p))),
        segment().prop_map(Shape::Segment),
        (vector(), vector(), vector()).prop_map(|(p, q, r)| Shape::Triangle(Triangle([p, q, r]))),
        vector().prop_map(|v| Shape::Cuboid(Cuboid { half: v.abs() })),
        // Needles and plates, 1000:1.
        (vector(), 1e-3..1.0, 1e-3..1.0).prop_map(|(v, y, z)| Shape::Cuboid(Cuboid {
            half: v.abs() * DVec3::new(1.0, y * y, z * z)
        })),
        proptest::collection::vec(vector(), 4..40).prop_map(Shape::Points),
        (segment(), 0.01..0.5).prop_map(|(core, radius)| Shape::Capsule(Rounded { core, radius })),
    ]
}

/// Poses at random, and parallel ones whose offset is a multiple of a half: touching and coincident pairs abound.
fn pose() -> impl Strategy<Value = Pose> {
    let halves = |v: DVec3| (v * 2.0).round() * 0.5;
    prop_oneof![
        (vector(), vector(), 0.0..3.0).prop_map(|(axis, offset, reach)| Pose::new(
            DQuat::from_scaled_axis(axis * 3.0),
            offset * reach
        )),
        vector().prop_map(move |offset| Pose::from_translation(halves(offset * 2.0))),
        // Parallel but for a tilt down to rounding.
        (vector(), vector(), -16..-3).prop_map(move |(axis, offset, exponent)| Pose::new(
            DQuat::from_scaled_axis(axis * 10_f64.powi(exponent)),
            halves(offset * 2.0)
        )),
    ]
}

fn scaled(shape: &Shape, factor: f64) -> Shape {
    match shape {
        Shape::Point(point) => Shape::Point(Point(point.0 * factor)),
        Shape::Segment(Segment { a, b }) => Shape::Segment(Segment {
            a: *a * factor,
            b: *b * factor,
        }),
        Shape::Triangle(triangle) => Shape::Triangle(Triangle(triangle.0.map(|p| p * factor))),
        Shape::Cuboid(cuboid) => Shape::Cuboid(Cuboid {
            half: cuboid.half * factor,
        }),
        Shape::Points(points) => Shape::Points(points.iter().map(|&p| p * factor).collect()),
        Shape::Capsule(Rounded { core, radius }) => Shape::Capsule(Rounded {
            core: Segment {
                a: core.a * factor,
                b: core.b * factor,
            },
            radius: radius * factor,
        }),
    }
}

fn height_of(shape: &Shape, direction: DVec3) -> f64 {
    shape.support(direction, 0).point.dot(direction)
}

/// Signed gap between the supporting planes along a unit `normal`.
fn support_gap(a: &Shape, b: &Shape, a_from_b: &Pose, normal: DVec3) -> f64 {
    let in_b = a_from_b.inverse_transform_vector(normal);
    let nearest_of_b = normal.dot(a_from_b.translation) - height_of(b, -in_b);
    nearest_of_b - height_of(a, normal) - a.radius() - b.radius()
}

/// Largest support gap over the normals of all triangles and over all pairs of differences of vertices: every separating
/// axis of two polytopes is among them, so this is the exact signed distance in overlap.
fn all_separating_axes(a: &Shape, b: &Shape, a_from_b: &Pose) -> f64 {
    let of_a = a.vertices();
    let of_b: Vec<DVec3> = b
        .vertices()
        .iter()
        .map(|&p| a_from_b.transform_point(p))
        .collect();
    let edges = |points: &[DVec3]| -> Vec<DVec3> {
        let pairs = points.iter().enumerate();
        pairs
            .flat_map(|(i, &p)| points[..i].iter().map(move |&q| p - q))
            .collect()
    };
    let all: Vec<DVec3> = edges(&of_a).into_iter().chain(edges(&of_b)).collect();
    let mut best = f64::NEG_INFINITY;
    for (i, first) in all.iter().enumerate() {
        for second in &all[..i] {
            let cross = first.cross(*second);
            if cross.length() <= 1e-9 * first.length() * second.length() {
                continue;
            }
            let normal = cross.normalize();
            best = best.max(support_gap(a, b, a_from_b, normal));
            best = best.max(support_gap(a, b, a_from_b, -normal));
        }
    }
    best
}

fn check(a: &Shape, b: &Shape, pose: &Pose, scale: f64) -> Result<ClosestPoints, TestCaseError> {
    let mut cache = SimplexCache::default();
    let found = closest_points(a, b, pose, &mut cache);
    let tolerance = 1e-13 * scale * 10.0;
    prop_assert!((found.normal.length() - 1.0).abs() < 1e-14, "{found:?}");
    let gap = support_gap(a, b, pose, found.normal);
    prop_assert!(
        (gap - found.separation).abs() < tolerance,
        "{gap} {found:?}"
    );
    let span = found.witness_b - found.witness_a;
    prop_assert!(
        (span - found.separation * found.normal).length() < tolerance,
        "{found:?}"
    );
    let shifted = |margin: f64| {
        let by = margin - found.separation;
        Pose::new(pose.rotation, pose.translation + found.normal * by)
    };
    let fresh = SimplexCache::default;
    prop_assert!(
        !overlap(a, b, &shifted(1e-9 * scale), &mut fresh()),
        "{found:?}"
    );
    // Contact itself: points and segments pass through each other, so a further step would part them again.
    let touching = closest_points(a, b, &shifted(0.0), &mut fresh());
    prop_assert!(
        touching.separation.abs() < tolerance,
        "{found:?} {touching:?}"
    );
    let again = closest_points(a, b, pose, &mut cache);
    prop_assert!(
        (again.separation - found.separation).abs() < tolerance,
        "{found:?} {again:?}"
    );
    Ok(found)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, rng_seed: RngSeed::Fixed(20_031), ..ProptestConfig::default() })]

    #[test]
    fn separation_normal_and_witnesses_belong_together(
        a in shape(), b in shape(), pose in pose(), exponent in -6..=4,
    ) {
        let scale = 10_f64.powi(exponent);
        let pose = Pose::new(pose.rotation, pose.translation * scale);
        check(&scaled(&a, scale), &scaled(&b, scale), &pose, scale)?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, rng_seed: RngSeed::Fixed(20_031), ..ProptestConfig::default() })]

    #[test]
    fn depth_is_that_of_the_best_separating_axis(
        points in proptest::collection::vec(vector(), 4..8), cuboid in vector(), pose in pose(),
    ) {
        let a = Shape::Points(points);
        let b = Shape::Cuboid(Cuboid { half: cuboid.abs() });
        let found = closest_points(&a, &b, &pose, &mut SimplexCache::default());
        if found.separation <= 0.0 {
            let exact = all_separating_axes(&a, &b, &pose);
            prop_assert!((found.separation - exact).abs() < 1e-12, "{exact} {found:?}");
        }
    }

    #[test]
    fn a_shape_on_itself_is_as_deep_as_it_is_thin(points in proptest::collection::vec(vector(), 4..8)) {
        let shape = Shape::Points(points);
        let found = closest_points(&shape, &shape, &Pose::IDENTITY, &mut SimplexCache::default());
        let exact = all_separating_axes(&shape, &shape, &Pose::IDENTITY);
        prop_assert!((found.separation - exact).abs() < 1e-12, "{exact} {found:?}");
    }

    #[test]
    fn climbing_finds_what_scanning_finds(
        points in proptest::collection::vec(vector(), 40..200), towards in vector(), start in 0_u32..300,
    ) {
        let hull = ConvexMesh::hull(&points)
            .map_err(|error| TestCaseError::fail(error.to_string()))?;
        let climbed = hull.support(towards, start).point.dot(towards);
        let scanned = PointSet(hull.positions()).support(towards, 0).point.dot(towards);
        prop_assert!((climbed - scanned).abs() < 1e-14, "{climbed} {scanned}");
    }
}

/// A coherent slide of a box over a mesh of many faces: warm answers equal cold ones.
#[test]
fn warm_starts_change_nothing_but_the_time() {
    let mesh =
        pliant_mesh::generate::latitude_longitude_ellipsoid(DVec3::new(0.05, 0.04, 0.03), 96, 67)
            .expect("valid");
    let ellipsoid = ConvexMesh::from_triangles(&mesh).expect("convex");
    let tool = Cuboid {
        half: DVec3::new(0.05, 0.004, 0.002),
    };
    let mut cache = SimplexCache::default();
    let (mut apart, mut inside) = (0, 0);
    for step in 0..400 {
        let time = 0.01 * f64::from(step);
        let pose = Pose::new(
            DQuat::from_scaled_axis(DVec3::new(time, 0.5 * time, -0.3)),
            DVec3::new(time.sin(), time.cos(), 0.2).normalize()
                * (0.045 + 0.02 * (3.0 * time).sin()),
        );
        let warm = closest_points(&ellipsoid, &tool, &pose, &mut cache);
        let cold = closest_points(&ellipsoid, &tool, &pose, &mut SimplexCache::default());
        assert!(
            (warm.separation - cold.separation).abs() < 1e-14,
            "{step} {warm:?} {cold:?}"
        );
        // Hovering at 1e-7 m, the certified separation is the distance, and the normal is exact enough to show it.
        let shift = warm.normal * (1e-7 - warm.separation);
        let near = Pose::new(pose.rotation, pose.translation + shift);
        let hover = closest_points(&ellipsoid, &tool, &near, &mut cache);
        let top = ellipsoid.support(hover.normal, 0).point.dot(hover.normal);
        let downward = near.inverse_transform_vector(-hover.normal);
        let bottom = near.transform_point(tool.support(downward, 0).point);
        let gap = bottom.dot(hover.normal) - top;
        assert!((hover.separation - 1e-7).abs() < 1e-14, "{step} {hover:?}");
        assert!(
            (gap - hover.separation).abs() < 1e-15,
            "{step} {gap:e} {hover:?}"
        );
        let span = (hover.witness_b - hover.witness_a).length();
        assert!((span - hover.separation).abs() < 1e-14, "{step} {hover:?}");
        if warm.separation > 0.0 {
            apart += 1;
        } else {
            inside += 1;
        }
    }
    assert!(apart > 50 && inside > 50, "{apart} {inside}");
}
