//! Support mapping of a convex mesh by hill climbing over its edges: in coherent queries the answer is the start or a
//! neighbour of it, whatever the number of faces (collision.9).

use glam::DVec3;
use pliant_mesh::{ConvexMesh, FaceId};

use crate::shapes::scan;
use crate::support::{SupportMap, SupportPoint};

/// Up to this many vertices a scan of all of them is no slower than a cold climb (measured: they cross near 32).
const SCAN_LIMIT: usize = 32;

/// Steps after which the table of directions is asked: coherent queries take one or two.
const PATIENCE: u32 = 2;

impl SupportMap for ConvexMesh {
    /// Climbs along the edges from `start`, always to the highest neighbour; strict ascent ends on any mesh, and on a
    /// convex one a vertex without a higher neighbour is the highest of all. A long way is cut short by the mesh's table of
    /// directions.
    #[inline]
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        let positions = self.positions();
        if positions.len() <= SCAN_LIMIT {
            return scan(positions, direction);
        }
        climb(self, direction, start)
    }

    fn rough_support(&self, direction: DVec3) -> Option<SupportPoint> {
        let positions = self.positions();
        (positions.len() > SCAN_LIMIT).then(|| {
            let index = self.vertex_towards(direction);
            SupportPoint {
                index,
                point: positions[index as usize],
            }
        })
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

/// The furthest vertex of a mesh, from `start` or from its table of directions.
#[inline(never)]
fn climb(mesh: &ConvexMesh, direction: DVec3, start: u32) -> SupportPoint {
    let positions = mesh.positions();
    let mut index = if (start as usize) < positions.len() {
        start
    } else {
        mesh.vertex_towards(direction)
    };
    let mut height = positions[index as usize].dot(direction);
    for step in 0_u32.. {
        if step == PATIENCE {
            let other = mesh.vertex_towards(direction);
            let of_other = positions[other as usize].dot(direction);
            if of_other > height {
                (index, height) = (other, of_other);
            }
        }
        let mut next = index;
        for &neighbour in mesh.neighbours(index) {
            let candidate = positions[neighbour as usize].dot(direction);
            if candidate > height {
                height = candidate;
                next = neighbour;
            }
        }
        if next == index {
            break;
        }
        index = next;
    }
    SupportPoint {
        index,
        point: positions[index as usize],
    }
}
