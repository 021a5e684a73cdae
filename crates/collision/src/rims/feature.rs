//! The parts of shapes, and of their difference, on which supports move smoothly.

use glam::DVec3;

use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

/// A circle of vertices of a core.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Of the circle, in the shape's frame [m].
    pub centre: DVec3,
    /// Unit vector normal to its plane, either way.
    pub axis: DVec3,
    /// [m]
    pub radius: f64,
}

impl Rim {
    /// Furthest point along a unit direction, and the tangent there whose dyad is the derivative of that point: its
    /// square is the radius over the part of the direction in the circle's plane. `None` for a direction normal to it.
    fn furthest(&self, direction: DVec3) -> Option<(DVec3, DVec3)> {
        let radial = direction - self.axis * self.axis.dot(direction);
        let outward = radial.try_normalize()?;
        // Orthogonal to rounding of itself.
        let outward = (outward - self.axis * self.axis.dot(outward)).normalize();
        let bend = (self.radius / radial.length()).sqrt();
        Some((
            self.centre + outward * self.radius,
            self.axis.cross(outward) * bend,
        ))
    }
}

/// Part of a shape on which its support moves smoothly: a vertex or a rim.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Feature {
    Vertex(DVec3),
    Rim(Rim),
}

impl Feature {
    fn of<S: SupportMap + ?Sized>(shape: &S, index: u32) -> Self {
        shape
            .rim(index)
            .map_or_else(|| Self::Vertex(shape.vertex(index)), Self::Rim)
    }

    /// Furthest point along a unit direction and the tangent whose dyad is its derivative.
    pub(crate) fn furthest(&self, direction: DVec3) -> Option<(DVec3, DVec3)> {
        match self {
            Self::Vertex(point) => Some((*point, DVec3::ZERO)),
            Self::Rim(rim) => rim.furthest(direction),
        }
    }

    pub(crate) fn rim(self) -> Option<Rim> {
        match self {
            Self::Vertex(_) => None,
            Self::Rim(rim) => Some(rim),
        }
    }

    /// Which quarter of a rim is met in a direction.
    fn quarter(self, direction: DVec3) -> u64 {
        let Self::Rim(rim) = self else { return 0 };
        let (u, w) = rim.axis.any_orthonormal_pair();
        u64::from(direction.dot(u) >= 0.0) << 1 | u64::from(direction.dot(w) >= 0.0)
    }

    /// The same number for the same vertex or rim.
    fn key<S: SupportMap + ?Sized>(shape: &S, index: u32) -> u64 {
        let numbers = match shape.rim(index) {
            None => [0, 0, u64::from(index)],
            Some(rim) => rim.centre.to_array().map(f64::to_bits),
        };
        numbers.into_iter().fold(0, mix)
    }
}

/// Scatters numbers that differ little (the odd multiplier of Knuth's multiplicative hash, on 64 bits).
fn mix(sum: u64, number: u64) -> u64 {
    // Turned, or the same number twice would be none.
    let mixed = (sum.rotate_left(23) ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 29)
}

/// Part of the difference on which its support moves smoothly.
#[derive(Clone, Copy)]
pub(crate) struct FeaturePair {
    pub(crate) a: Feature,
    pub(crate) b: Feature,
    /// Vertices of A and B that it was found by: on a rim, any of its own.
    pub(crate) vertices: [u32; 2],
}

/// However they were found.
impl PartialEq for FeaturePair {
    fn eq(&self, other: &Self) -> bool {
        self.a == other.a && self.b == other.b
    }
}

impl FeaturePair {
    /// The pair that a vertex of the difference belongs to.
    pub(crate) fn of<A, B>(
        difference: &MinkowskiDifference<'_, A, B>,
        vertex: &DifferencePoint,
    ) -> Self
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        Self {
            a: Feature::of(difference.a, vertex.a),
            b: Feature::of(difference.b, vertex.b),
            vertices: [vertex.a, vertex.b],
        }
    }

    pub(crate) fn is_turned(&self) -> bool {
        matches!(self.a, Feature::Rim(_)) || matches!(self.b, Feature::Rim(_))
    }
}

/// The same number for the same set of vertices and rims under a face, in about the same direction: a rim may be met on
/// opposite sides.
pub(crate) fn key<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    corners: &[DifferencePoint; 3],
    outward: DVec3,
) -> u64
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut keys = corners.map(|corner| {
        let of_a = Feature::key(difference.a, corner.a);
        mix(of_a, Feature::key(difference.b, corner.b))
    });
    keys.sort_unstable();
    // Twice the same pair is once.
    if keys[0] == keys[1] {
        keys[0] = 0;
    }
    if keys[1] == keys[2] {
        keys[1] = 0;
    }
    keys.sort_unstable();
    let pair = FeaturePair::of(difference, &corners[0]);
    let of_a = pair.a.quarter(-outward);
    let of_b = pair.b.quarter(difference.direction_in_b(outward));
    keys.into_iter().fold(of_a << 2 | of_b, mix)
}
