//! A convex shape at a placement against the mesh: its boxes along the axes of both frames, lower bounds of the separation
//! from boxes, planes and directions, and how far its points have moved since another placement.
//!
//! Every bound here is the height of a pair of supporting planes along some unit vector, or the distance of two boxes, and
//! so never above the signed separation of what the boxes hold. Bounds are lowered by their rounding.

use glam::{DMat3, DVec3};
use pliant_spatial::Pose;

use crate::bvh::frame::{SLACK, UnitBox, UnitFrame};
use crate::bvh::triangle::unit_normal;
use crate::{ClosestPoints, SimplexCache, SupportMap, Triangle, closest_points};

use super::faces::{Faces, Verdict};
use super::segment::against_triangle;

/// Box of a shape along the axes of its own frame [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LocalBox {
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

/// Vertices to start climbing from, one per axis direction of each frame.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Starts {
    own: [u32; 6],
    mesh: [u32; 6],
}

/// A shape, its placement and its boxes.
pub(super) struct Placed<'s, S: ?Sized> {
    pub(super) shape: &'s S,
    pub(super) mesh_from_shape: &'s Pose,
    pub(super) local: LocalBox,
    /// Ends of the core in the mesh's frame, where it is a segment.
    segment: Option<[DVec3; 2]>,
    faces: Faces,
    radius: f64,
    frame: UnitFrame,
    mesh_from_shape_rotation: DMat3,
    shape_from_mesh_rotation: DMat3,
    /// Rounding of heights and distances [m].
    pub(super) slack: f64,
    unit: UnitBoxes,
}

/// The boxes in the tree's unit frame.
pub(super) struct UnitBoxes {
    pub(super) metres: f64,
    pub(super) slack: f64,
    /// Along the mesh's axes.
    pub(super) centre: DVec3,
    pub(super) half: DVec3,
    /// Along the shape's axes: the centre in the mesh's frame, the half lengths along the shape's.
    pub(super) own_centre: DVec3,
    /// The shape's origin.
    pub(super) origin: DVec3,
    pub(super) own_half: DVec3,
    pub(super) shape_from_mesh: DMat3,
    pub(super) spread: DMat3,
}

impl LocalBox {
    pub(super) fn centre(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// No point of the shape's core is further from the centre [m].
    pub(super) fn reach(&self) -> f64 {
        0.5 * (self.max - self.min).length()
    }
}

impl<'s, S: SupportMap + ?Sized> Placed<'s, S> {
    pub(super) fn new(
        shape: &'s S,
        mesh_from_shape: &'s Pose,
        frame: &UnitFrame,
        starts: &mut Starts,
    ) -> Self {
        let rotation = DMat3::from_quat(mesh_from_shape.rotation);
        let inverse = rotation.transpose();
        let radius = shape.radius();
        let translation = mesh_from_shape.translation;
        let own = extents(shape, &DMat3::IDENTITY, &mut starts.own);
        let along_mesh = extents(shape, &inverse, &mut starts.mesh);
        let local = LocalBox {
            min: own.0 - radius,
            max: own.1 + radius,
        };
        let segment = shape
            .core_segment()
            .map(|ends| ends.map(|end| rotation * end + translation));
        let size = local.min.abs().max(local.max.abs()).max_element();
        let coordinate = translation.abs().max_element() + frame.centre.abs().max_element();
        let per_metre = frame.per_metre;
        let centre = 0.5 * (along_mesh.0 + along_mesh.1) + (translation - frame.centre);
        let own_centre = rotation * local.centre() + (translation - frame.centre);
        let unit = UnitBoxes {
            metres: 1.0 / per_metre,
            slack: SLACK * (1.0 + (coordinate + size) * per_metre),
            centre: centre * per_metre,
            half: (0.5 * (along_mesh.1 - along_mesh.0) + radius) * per_metre,
            own_centre: own_centre * per_metre,
            origin: (translation - frame.centre) * per_metre,
            own_half: 0.5 * (local.max - local.min) * per_metre,
            shape_from_mesh: inverse,
            spread: absolute(&inverse),
        };
        Self {
            shape,
            mesh_from_shape,
            local,
            segment,
            faces: Faces::new(shape, &rotation),
            radius,
            frame: *frame,
            mesh_from_shape_rotation: rotation,
            shape_from_mesh_rotation: inverse,
            slack: 1e-15 * (coordinate + size + 1.0 / per_metre),
            unit,
        }
    }

    pub(super) fn unit(&self) -> &UnitBoxes {
        &self.unit
    }

    /// Lower bound [m] of the separation from anything in a box of the tree (collision.41).
    pub(super) fn bound_of_box(&self, bounds: &UnitBox) -> f64 {
        let unit = &self.unit;
        let (min, max) = bounds.corners();
        let (centre, half) = (0.5 * (min + max), 0.5 * (max - min));
        let along_mesh = (centre - unit.centre).abs() - (half + unit.half);
        let across = if self.faces.is_empty() {
            let along_own = (unit.shape_from_mesh * (centre - unit.own_centre)).abs()
                - (unit.spread * half + unit.own_half);
            outside(along_own)
        } else {
            let from_origin = centre - unit.origin;
            self.faces.bound_of_box(from_origin, half, &self.frame)
                - self.radius * self.frame.per_metre
        };
        (outside(along_mesh).max(across) - unit.slack) * unit.metres
    }

    /// What a few dot products tell about a triangle: a lower bound [m] of the separation, or even the answer.
    pub(super) fn judge(&self, corners: &[DVec3; 3]) -> Verdict {
        if let Some(ends) = self.segment {
            return Verdict::Exact(against_triangle(corners, ends, self.radius));
        }
        let origin = self.mesh_from_shape.translation;
        let relative = corners.map(|corner| corner - origin);
        if self.faces.is_empty() {
            let (bound, direction) = self.bound_of_triangle(&relative);
            return Verdict::Bound(bound, direction);
        }
        match self.faces.judge(&relative) {
            Verdict::Bound(bound, direction) => {
                Verdict::Bound(bound - self.radius - self.slack, direction)
            }
            Verdict::Exact(core) => {
                let witness_a = core.witness_a + origin;
                let separation = core.separation - self.radius;
                Verdict::Exact(ClosestPoints {
                    witness_a,
                    witness_b: witness_a + core.normal * separation,
                    normal: core.normal,
                    separation,
                })
            }
        }
    }

    /// A lower bound by the shape's own box and by the triangle's plane.
    fn bound_of_triangle(&self, relative: &[DVec3; 3]) -> (f64, DVec3) {
        let own = relative.map(|corner| self.shape_from_mesh_rotation * corner);
        let min = own[0].min(own[1]).min(own[2]);
        let max = own[0].max(own[1]).max(own[2]);
        let by_box = outside((min - self.local.max).max(self.local.min - max)) - self.slack;
        let Some(normal) = unit_normal(relative) else {
            return (by_box, DVec3::ZERO);
        };
        let side = (self.shape_from_mesh_rotation * normal).dot(self.local.centre() - own[0]);
        let towards = if side < 0.0 { -normal } else { normal };
        let by_plane = self.height_over(relative, towards);
        if by_plane >= by_box {
            (by_plane, towards)
        } else {
            (by_box, DVec3::ZERO)
        }
    }

    /// Lower bound [m] of the separation from a triangle along a unit direction, from the triangle to the shape.
    pub(super) fn bound_along(&self, corners: &[DVec3; 3], direction: DVec3) -> f64 {
        let origin = self.mesh_from_shape.translation;
        self.height_over(&corners.map(|corner| corner - origin), direction)
    }

    fn height_over(&self, relative: &[DVec3; 3], direction: DVec3) -> f64 {
        let own = self.shape_from_mesh_rotation * direction;
        let lowest = self.shape.support(-own, 0).point;
        let top = relative
            .iter()
            .map(|&corner| corner.dot(direction))
            .fold(f64::NEG_INFINITY, f64::max);
        lowest.dot(own) - self.radius - top - self.slack
    }

    /// The exact query against one triangle.
    pub(super) fn closest_points(
        &self,
        corners: &[DVec3; 3],
        cache: &mut SimplexCache,
    ) -> ClosestPoints {
        let triangle = Triangle(*corners);
        match self.segment {
            Some(ends) => against_triangle(corners, ends, self.radius),
            None => closest_points(&triangle, self.shape, self.mesh_from_shape, cache),
        }
    }

    /// No point of the shape has moved further [m] since the placement `before`, if the shape is as it was (collision.44).
    pub(super) fn motion_since(&self, before: &Pose) -> f64 {
        let centre = self.local.centre();
        let now = self.mesh_from_shape_rotation * centre + self.mesh_from_shape.translation;
        let shift = now.distance(before.transform_point(centre));
        let turn = before.rotation.conjugate() * self.mesh_from_shape.rotation;
        // The chord of the relative rotation by θ is 2 sin(θ/2) times the distance from its axis.
        shift + 2.0 * turn.xyz().length() * self.local.reach() + self.slack
    }
}

/// Lowest and highest vertices of the core along three directions, the columns of `own_from_axes`.
fn extents<S: SupportMap + ?Sized>(
    shape: &S,
    own_from_axes: &DMat3,
    starts: &mut [u32; 6],
) -> (DVec3, DVec3) {
    let mut low = DVec3::ZERO;
    let mut high = DVec3::ZERO;
    for axis in 0..3 {
        let direction = own_from_axes.col(axis);
        let above = shape.support(direction, starts[2 * axis]);
        let below = shape.support(-direction, starts[2 * axis + 1]);
        starts[2 * axis] = above.index;
        starts[2 * axis + 1] = below.index;
        high[axis] = above.point.dot(direction);
        low[axis] = below.point.dot(direction);
    }
    (low, high)
}

fn absolute(matrix: &DMat3) -> DMat3 {
    DMat3::from_cols(
        matrix.x_axis.abs(),
        matrix.y_axis.abs(),
        matrix.z_axis.abs(),
    )
}

/// Signed distance of two boxes from their gaps along three orthogonal axes.
fn outside(gaps: DVec3) -> f64 {
    let largest = gaps.max_element();
    if largest <= 0.0 {
        return largest;
    }
    gaps.max(DVec3::ZERO).length()
}
