//! The convex shapes of this crate as support mappings.

use glam::DVec3;

use crate::rims::Rim;
use crate::support::{SupportMap, SupportPoint};

/// A single point [m]; with a radius around it, a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point(pub DVec3);

/// A straight segment [m]; with a radius around it, a capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// One end [m].
    pub a: DVec3,
    /// The other end [m]; may coincide with `a`.
    pub b: DVec3,
}

/// A triangle of any shape, degenerate ones included [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle(pub [DVec3; 3]);

/// A box centred on its frame's origin, its sides along the axes. Zero half lengths make plates, sticks and points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Half lengths of the sides [m], ≥ 0.
    pub half: DVec3,
}

/// The convex hull of borrowed points [m], in any order, inner points allowed. No hull is built: each support call scans
/// the points, which suits the few dozen vertices of a deformed tool segment. An empty set counts as the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointSet<'a>(pub &'a [DVec3]);

/// A shape with a rounding radius added around it; a `Rounded<Segment>` is a capsule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounded<S> {
    /// The shape that is rounded.
    pub core: S,
    /// Added to the core's own radius [m], ≥ 0.
    pub radius: f64,
}

impl Rounded<Point> {
    /// A ball [m].
    pub fn sphere(centre: DVec3, radius: f64) -> Self {
        Self {
            core: Point(centre),
            radius,
        }
    }
}

impl Rounded<Segment> {
    /// The segment between two points with a radius around it [m].
    pub fn capsule(a: DVec3, b: DVec3, radius: f64) -> Self {
        Self {
            core: Segment { a, b },
            radius,
        }
    }
}

impl SupportMap for Point {
    fn support(&self, _direction: DVec3, _start: u32) -> SupportPoint {
        SupportPoint {
            index: 0,
            point: self.0,
        }
    }

    fn vertex(&self, _index: u32) -> DVec3 {
        self.0
    }

    fn interior_point(&self) -> DVec3 {
        self.0
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        Some([self.0; 2])
    }
}

impl SupportMap for Segment {
    fn support(&self, direction: DVec3, _start: u32) -> SupportPoint {
        let index = u32::from((self.b - self.a).dot(direction) > 0.0);
        SupportPoint {
            index,
            point: self.vertex(index),
        }
    }

    fn vertex(&self, index: u32) -> DVec3 {
        if index == 0 { self.a } else { self.b }
    }

    fn interior_point(&self) -> DVec3 {
        self.a.midpoint(self.b)
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        Some([self.a, self.b])
    }
}

impl SupportMap for Triangle {
    fn support(&self, direction: DVec3, _start: u32) -> SupportPoint {
        scan(&self.0, direction)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.0[(index as usize).min(2)]
    }

    fn interior_point(&self) -> DVec3 {
        (self.0[0] + self.0[1] + self.0[2]) / 3.0
    }
}

impl SupportMap for Cuboid {
    /// Bit k of the index is set where coordinate k is positive.
    fn support(&self, direction: DVec3, _start: u32) -> SupportPoint {
        let index = u32::from(direction.x >= 0.0)
            | u32::from(direction.y >= 0.0) << 1
            | u32::from(direction.z >= 0.0) << 2;
        SupportPoint {
            index,
            point: self.vertex(index),
        }
    }

    fn vertex(&self, index: u32) -> DVec3 {
        let signed = |bit: u32, half: f64| if index & bit == 0 { -half } else { half };
        DVec3::new(
            signed(1, self.half.x),
            signed(2, self.half.y),
            signed(4, self.half.z),
        )
    }

    fn interior_point(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn core_box(&self) -> Option<DVec3> {
        Some(self.half)
    }

    fn core_face_count(&self) -> u32 {
        6
    }

    fn core_face(&self, face: u32) -> DVec3 {
        let axis = DVec3::AXES[(face / 2).min(2) as usize];
        if face.is_multiple_of(2) { axis } else { -axis }
    }
}

impl SupportMap for PointSet<'_> {
    fn support(&self, direction: DVec3, _start: u32) -> SupportPoint {
        scan(self.0, direction)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        let point = self.0.get(index as usize).or(self.0.last());
        point.copied().unwrap_or(DVec3::ZERO)
    }

    /// Halfway between two of the points: in the hull, at no cost in their number.
    fn interior_point(&self) -> DVec3 {
        let middle = self.0.get(self.0.len() / 2);
        match (self.0.first(), middle) {
            (Some(first), Some(middle)) => first.midpoint(*middle),
            _ => DVec3::ZERO,
        }
    }
}

impl<S: SupportMap> SupportMap for Rounded<S> {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.core.support(direction, start)
    }

    fn rough_support(&self, direction: DVec3) -> Option<SupportPoint> {
        self.core.rough_support(direction)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.core.vertex(index)
    }

    fn radius(&self) -> f64 {
        self.core.radius() + self.radius
    }

    fn interior_point(&self) -> DVec3 {
        self.core.interior_point()
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        self.core.core_segment()
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        self.core.rim(index)
    }

    fn core_box(&self) -> Option<DVec3> {
        self.core.core_box()
    }

    fn core_face_count(&self) -> u32 {
        self.core.core_face_count()
    }

    fn core_face(&self, face: u32) -> DVec3 {
        self.core.core_face(face)
    }
}

/// Furthest of all points along `direction`; the first of equals.
pub(crate) fn scan(points: &[DVec3], direction: DVec3) -> SupportPoint {
    let mut best = 0;
    let mut height = f64::NEG_INFINITY;
    for (index, point) in points.iter().enumerate() {
        let candidate = point.dot(direction);
        if candidate > height {
            height = candidate;
            best = index;
        }
    }
    numbered(best, points.get(best).copied().unwrap_or(DVec3::ZERO))
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "vertices are numbered by u32 throughout"
)]
pub(crate) fn numbered(index: usize, point: DVec3) -> SupportPoint {
    SupportPoint {
        index: index as u32,
        point,
    }
}
