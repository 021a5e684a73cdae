//! Support mapping of a convex mesh by hill climbing over its edges: in coherent queries the answer is the start or a
//! neighbour of it, whatever the number of faces.

use glam::DVec3;
use pliant_mesh::{ConvexMesh, FaceId};

use crate::shapes::{numbered, scan};
use crate::support::{SupportMap, SupportPoint};

/// Up to this many vertices a scan of all of them is no slower than a cold climb (measured: they cross near 32).
const SCAN_LIMIT: usize = 32;

impl SupportMap for ConvexMesh {
    /// Climbs along the edges from `start`, always to the highest neighbour; strict ascent ends on any mesh, and on a
    /// convex one a vertex without a higher neighbour is the highest of all.
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        let positions = self.positions();
        if positions.len() <= SCAN_LIMIT {
            return scan(positions, direction);
        }
        let mut index = (start as usize).min(positions.len() - 1);
        let mut height = positions[index].dot(direction);
        loop {
            let mut next = index;
            #[expect(
                clippy::cast_possible_truncation,
                reason = "vertices are numbered by u32 throughout"
            )]
            for &neighbour in self.neighbours(index as u32) {
                let candidate = positions[neighbour as usize].dot(direction);
                if candidate > height {
                    height = candidate;
                    next = neighbour as usize;
                }
            }
            if next == index {
                break;
            }
            index = next;
        }
        numbered(index, positions[index])
    }

    fn vertex(&self, index: u32) -> DVec3 {
        let positions = self.positions();
        positions[(index as usize).min(positions.len() - 1)]
    }

    fn interior_point(&self) -> DVec3 {
        self.centroid()
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "faces are numbered by u32 throughout"
    )]
    fn core_face_count(&self) -> u32 {
        self.topology().face_count() as u32
    }

    fn core_face(&self, face: u32) -> DVec3 {
        self.topology()
            .face_normal(FaceId(face.min(self.core_face_count() - 1)))
    }
}
