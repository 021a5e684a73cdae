//! First contact of a moving convex shape with a mesh.
//!
//! Boxes of the tree are met by the shape's boxes swept along the motion (slab tests along the axes of both frames), the
//! triangles of what is met first by [`cast_shape`], whose motion shrinks to the earliest contact so far.

use glam::DVec3;
use pliant_mesh::TriangleMesh;
use pliant_spatial::Pose;

use crate::bvh::TriangleBvh;
use crate::bvh::frame::UnitBox;
use crate::bvh::ray::slabs;
use crate::{CastHit, SimplexCache, SupportMap, Triangle, cast_shape};

use super::placed::{Placed, Starts};

/// Where a moving shape first touches a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshCastHit {
    /// The triangle touched; one of them where several are touched at once.
    pub triangle: u32,
    /// Fraction of the motion, normal from the mesh to the shape, and point of the triangle, in the mesh's frame.
    pub contact: CastHit,
}

impl TriangleBvh {
    /// First contact of `shape`, moving by `motion_in_mesh` [m] without turning, with the mesh. `None` if it stays clear
    /// or if the placement or motion is not finite. A shape that touches the mesh at the start meets it at fraction 0.
    /// Allocates nothing.
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn cast_shape<S: SupportMap + ?Sized>(
        &self,
        mesh: &TriangleMesh,
        shape: &S,
        mesh_from_shape: &Pose,
        motion_in_mesh: DVec3,
    ) -> Option<MeshCastHit> {
        if !mesh_from_shape.is_finite() || !motion_in_mesh.is_finite() {
            return None;
        }
        let frame = &self.tree.frame;
        let placed = Placed::new(shape, mesh_from_shape, frame, &mut Starts::default());
        let motion = motion_in_mesh * frame.per_metre;
        let mut best: Option<MeshCastHit> = None;
        let mut reach = 1.0;
        let mut search = self
            .tree
            .nearest_first(|bounds| placed.entry(bounds, motion));
        while let Some(slot) = search.next(reach) {
            let triangle = self.tree.primitives[slot];
            let corners = Triangle(mesh.corners(triangle));
            let cache = &mut SimplexCache::default();
            let hit = cast_shape(
                &corners,
                shape,
                mesh_from_shape,
                motion_in_mesh * reach,
                cache,
            );
            if let Some(mut contact) = hit {
                contact.fraction *= reach;
                if best.is_none() || contact.fraction < reach {
                    reach = contact.fraction;
                    best = Some(MeshCastHit { triangle, contact });
                }
            }
            if reach == 0.0 && best.is_some() {
                break;
            }
        }
        best
    }
}

impl<S: SupportMap + ?Sized> Placed<'_, S> {
    /// Lower bound of the fraction of a motion (unit frame) at which the shape meets anything in a box; infinite if never (collision.47).
    fn entry(&self, bounds: &UnitBox, motion: DVec3) -> f64 {
        let unit = self.unit();
        let (min, max) = bounds.corners();
        let slack = unit.slack + crate::bvh::frame::SLACK * motion.abs().max_element();
        let along_mesh = slabs(
            min - unit.centre - unit.half - slack,
            max - unit.centre + unit.half + slack,
            motion,
        );
        if along_mesh > 1.0 {
            return f64::INFINITY;
        }
        let centre = unit.shape_from_mesh * (0.5 * (min + max) - unit.own_centre);
        let half = unit.spread * (0.5 * (max - min)) + unit.own_half + slack;
        let along_own = slabs(centre - half, centre + half, unit.shape_from_mesh * motion);
        along_mesh.max(along_own)
    }
}
