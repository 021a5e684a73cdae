//! Faces of a shape with few of them, as separating directions: bounds for boxes, and the exact answer for triangles that
//! lie well inside the shape.
//!
//! The height of a triangle over the plane of a face bounds its separation from below. For a triangle that overlaps the
//! shape, the depth of any of its points bounds it from above, and the depth of a point in a convex polytope is the
//! least over the faces. Where the two meet, on the triangle's lowest point over its best face, that face is the answer
//! and EPA is not asked: on fine meshes so for nearly every triangle.

use glam::{DMat3, DVec3};

use crate::bvh::frame::UnitFrame;
use crate::{ClosestPoints, SupportMap};

/// Shapes with more distinct faces than this do without: the loop over them would cost more than it saves.
const ROOM: usize = 16;

/// Shapes that list more faces, duplicates counted, are not even looked through.
const LISTED: u32 = 48;

/// Normals closer than this are one face, listed as several triangles.
const SAME: f64 = 1e-14;

/// Supporting planes of a core in the mesh's frame.
pub(super) struct Faces {
    normals: [DVec3; ROOM],
    /// Height of the plane along the normal over the shape's origin [m].
    heights: [f64; ROOM],
    count: usize,
}

/// What the faces say about a triangle.
pub(super) enum Verdict {
    /// A lower bound of the core's separation [m] and its direction, from the triangle to the shape.
    Bound(f64, DVec3),
    /// The answer, for the core.
    Exact(ClosestPoints),
}

impl Faces {
    pub(super) const NONE: Self = Self {
        normals: [DVec3::ZERO; ROOM],
        heights: [0.0; ROOM],
        count: 0,
    };

    pub(super) fn new<S: SupportMap + ?Sized>(shape: &S, mesh_from_shape: &DMat3) -> Self {
        let mut faces = Self::NONE;
        let listed = shape.core_face_count();
        if listed > LISTED {
            return faces;
        }
        let mut own = [DVec3::ZERO; ROOM];
        let mut start = 0;
        for face in 0..listed {
            let normal = shape.core_face(face);
            let same = |other: &DVec3| (normal - *other).abs().max_element() <= SAME;
            if own[..faces.count].iter().any(same) {
                continue;
            }
            if faces.count == ROOM {
                return Self::NONE;
            }
            let support = shape.support(normal, start);
            start = support.index;
            own[faces.count] = normal;
            faces.normals[faces.count] = *mesh_from_shape * normal;
            faces.heights[faces.count] = support.point.dot(normal);
            faces.count += 1;
        }
        faces
    }

    pub(super) fn is_empty(&self) -> bool {
        self.count == 0
    }

    fn planes(&self) -> impl Iterator<Item = (DVec3, f64)> {
        let heights = &self.heights[..self.count];
        self.normals[..self.count]
            .iter()
            .copied()
            .zip(heights.iter().copied())
    }

    /// Lower bound of the core's separation from a box, all in the unit frame: centre relative to the shape's origin.
    pub(super) fn bound_of_box(&self, centre: DVec3, half: DVec3, frame: &UnitFrame) -> f64 {
        self.planes()
            .map(|(normal, height)| {
                normal.dot(centre) - normal.abs().dot(half) - height * frame.per_metre
            })
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// What is known of a triangle whose corners are given relative to the shape's origin, in the mesh's frame [m] (collision.42).
    pub(super) fn judge(&self, corners: &[DVec3; 3]) -> Verdict {
        let mut best = (f64::NEG_INFINITY, 0, 0);
        for (face, (normal, height)) in self.planes().enumerate() {
            let heights = corners.map(|corner| normal.dot(corner) - height);
            let (low, corner) = lowest(heights);
            if low > best.0 {
                best = (low, face, corner);
            }
        }
        let (bound, face, corner) = best;
        let direction = -self.normals[face];
        let deepest = corners[corner];
        let inside = |(normal, height): (DVec3, f64)| normal.dot(deepest) - height <= bound;
        if bound > 0.0 || !self.planes().all(inside) {
            return Verdict::Bound(bound, direction);
        }
        Verdict::Exact(ClosestPoints {
            witness_a: deepest,
            witness_b: deepest + direction * bound,
            normal: direction,
            separation: bound,
        })
    }
}

fn lowest(heights: [f64; 3]) -> (f64, usize) {
    let mut best = (heights[0], 0);
    for (corner, height) in heights.into_iter().enumerate().skip(1) {
        if height < best.0 {
            best = (height, corner);
        }
    }
    best
}
