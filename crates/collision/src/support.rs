//! Support mappings: the one operation GJK, EPA and the casts ask of a convex shape (Gilbert, Johnson & Keerthi 1988;
//! van den Bergen 1999, "A Fast and Robust GJK Implementation", §2).
//!
//! A shape is a polytope *core* with numbered vertices and a rounding radius around it. The algorithms see cores only and
//! account for the radii in closed form, so a capsule is a segment and shallow contact of round shapes never needs EPA.

use glam::{DMat3, DVec3};
use pliant_spatial::Pose;

use crate::rims::Rim;

/// A vertex of a core, found as the furthest along a direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportPoint {
    /// Number of the vertex: what [`SupportMap::vertex`] takes and warm starts remember.
    pub index: u32,
    /// Its position in the shape's frame [m].
    pub point: DVec3,
}

/// A convex shape: the hull of finitely many numbered vertices, swollen by [`SupportMap::radius`].
///
/// Implementations must be deterministic, allocate nothing, and accept any index: one past the end counts as the last
/// vertex, so that a cache filled by other shapes costs time and never correctness.
pub trait SupportMap {
    /// Vertex of the core furthest along `direction` (shape's frame, any length, non-zero). `start` is the index of a
    /// vertex to start climbing from, `u32::MAX` where none is known: a hint, it never changes how far the answer reaches.
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint;

    /// Some vertex about as far along `direction` as any, at a cost that does not grow with the core: with these a search
    /// that knows nothing yet takes its first steps. `None` where [`SupportMap::support`] costs no more.
    fn rough_support(&self, _direction: DVec3) -> Option<SupportPoint> {
        None
    }

    /// Position of a vertex of the core in the shape's frame [m].
    fn vertex(&self, index: u32) -> DVec3;

    /// Rounding radius around the core [m], ≥ 0.
    fn radius(&self) -> f64 {
        0.0
    }

    /// Some point of the core [m], at a bounded cost: local origin of the algorithms and first guess.
    fn interior_point(&self) -> DVec3;

    /// The ends of the core [m] where it is a segment, or a point as two equal ends: allows closed forms.
    fn core_segment(&self) -> Option<[DVec3; 2]> {
        None
    }

    /// The circle that a vertex is on, where the core has circles and stands for them by very many vertices.
    fn rim(&self, _index: u32) -> Option<Rim> {
        None
    }

    /// Half lengths of the sides [m] where the core is a box about the origin, its sides along the axes: allows closed forms.
    fn core_box(&self) -> Option<DVec3> {
        None
    }

    /// How many faces [`SupportMap::core_face`] lists: all of the core's, or none where that would be many or is unknown.
    fn core_face_count(&self) -> u32 {
        0
    }

    /// Outward unit normal of a face of the core; all together, the planes in which they support it bound the core.
    fn core_face(&self, _face: u32) -> DVec3 {
        DVec3::ZERO
    }
}

impl<S: SupportMap + ?Sized> SupportMap for &S {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        (**self).support(direction, start)
    }

    fn rough_support(&self, direction: DVec3) -> Option<SupportPoint> {
        (**self).rough_support(direction)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        (**self).vertex(index)
    }

    fn radius(&self) -> f64 {
        (**self).radius()
    }

    fn interior_point(&self) -> DVec3 {
        (**self).interior_point()
    }

    fn core_segment(&self) -> Option<[DVec3; 2]> {
        (**self).core_segment()
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        (**self).rim(index)
    }

    fn core_box(&self) -> Option<DVec3> {
        (**self).core_box()
    }

    fn core_face_count(&self) -> u32 {
        (**self).core_face_count()
    }

    fn core_face(&self, face: u32) -> DVec3 {
        (**self).core_face(face)
    }
}

/// A vertex of the Minkowski difference: `point` = `p_b − p_a` for vertex `a` of A and vertex `b` of B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DifferencePoint {
    pub(crate) point: DVec3,
    pub(crate) a: u32,
    pub(crate) b: u32,
}

impl DifferencePoint {
    /// No vertex at all: what fills buffers, and the start of a climb where nothing is known.
    pub(crate) const NONE: Self = Self {
        point: DVec3::ZERO,
        a: u32::MAX,
        b: u32::MAX,
    };

    pub(crate) fn same_vertices(&self, other: &Self) -> bool {
        self.a == other.a && self.b == other.b
    }
}

/// The Minkowski difference B − A of two cores in A's frame.
///
/// Vertices enter relative to an interior point of their own shape, and the offset between the two is rounded once: the
/// shape of the difference is then exact to 1e-16 of the shapes' size wherever their frames' origins lie.
pub(crate) struct MinkowskiDifference<'s, A: ?Sized, B: ?Sized> {
    pub(crate) a: &'s A,
    pub(crate) b: &'s B,
    pub(crate) a_from_b: &'s Pose,
    a_from_b_rotation: DMat3,
    b_from_a_rotation: DMat3,
    origin_in_a: DVec3,
    origin_in_b: DVec3,
    offset: DVec3,
}

impl<'s, A: SupportMap + ?Sized, B: SupportMap + ?Sized> MinkowskiDifference<'s, A, B> {
    pub(crate) fn new(a: &'s A, b: &'s B, a_from_b: &'s Pose) -> Self {
        let rotation = DMat3::from_quat(a_from_b.rotation);
        let origin_in_a = a.interior_point();
        let origin_in_b = b.interior_point();
        Self {
            a,
            b,
            a_from_b,
            a_from_b_rotation: rotation,
            b_from_a_rotation: rotation.transpose(),
            origin_in_a,
            origin_in_b,
            offset: rotation * origin_in_b + (a_from_b.translation - origin_in_a),
        }
    }

    /// Some point of the difference.
    pub(crate) fn interior_point(&self) -> DVec3 {
        self.offset
    }

    /// Vertex of the difference furthest along `direction`, climbing from the vertices of `start` (collision.1).
    #[inline]
    pub(crate) fn support(&self, direction: DVec3, start: &DifferencePoint) -> DifferencePoint {
        let on_a = self.a.support(-direction, start.a);
        let on_b = self.b.support(self.b_from_a_rotation * direction, start.b);
        DifferencePoint {
            point: self.difference(on_a.point, on_b.point),
            a: on_a.index,
            b: on_b.index,
        }
    }

    /// Some vertex of the difference about as far along `direction` as any; `None` where the furthest costs no more.
    #[inline]
    pub(crate) fn rough_support(&self, direction: DVec3) -> Option<DifferencePoint> {
        let in_b = self.b_from_a_rotation * direction;
        let (on_a, on_b) = match (self.a.rough_support(-direction), self.b.rough_support(in_b)) {
            (None, None) => return None,
            (on_a, on_b) => (
                on_a.unwrap_or_else(|| self.a.support(-direction, u32::MAX)),
                on_b.unwrap_or_else(|| self.b.support(in_b, u32::MAX)),
            ),
        };
        Some(DifferencePoint {
            point: self.difference(on_a.point, on_b.point),
            a: on_a.index,
            b: on_b.index,
        })
    }

    /// The vertex of the difference made of two given vertices, at this placement.
    #[inline]
    pub(crate) fn vertex(&self, a: u32, b: u32) -> DifferencePoint {
        DifferencePoint {
            point: self.difference(self.a.vertex(a), self.b.vertex(b)),
            a,
            b,
        }
    }

    /// Larger distance of the two shapes' vertices from their interior points [m].
    pub(crate) fn size_at(&self, vertex: &DifferencePoint) -> f64 {
        let of_a = self.a.vertex(vertex.a).distance(self.origin_in_a);
        of_a.max(self.b.vertex(vertex.b).distance(self.origin_in_b))
    }

    /// A direction of A's frame in B's.
    pub(crate) fn direction_in_b(&self, direction: DVec3) -> DVec3 {
        self.b_from_a_rotation * direction
    }

    /// A direction of B's frame in A's.
    pub(crate) fn direction_in_a(&self, direction: DVec3) -> DVec3 {
        self.a_from_b_rotation * direction
    }

    /// The point of the difference made of a point of each shape in its own frame.
    #[inline]
    pub(crate) fn difference(&self, point_in_a: DVec3, point_in_b: DVec3) -> DVec3 {
        self.a_from_b_rotation * (point_in_b - self.origin_in_b) - (point_in_a - self.origin_in_a)
            + self.offset
    }
}
