//! The surface that EPA ended with, as vertex indices: what warm starts it.

/// Vertices and faces kept; larger surfaces are not, they would cost more to place anew than to find again.
pub(super) const MOST_VERTICES: usize = 24;
pub(super) const MOST_FACES: usize = 2 * MOST_VERTICES - 4;

/// A closed surface of triangles between vertices of a Minkowski difference. No heap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Surface {
    vertices: [[u32; 2]; MOST_VERTICES],
    /// Corners, and the faces across the edges that start at them.
    faces: [([u8; 3], [u8; 3]); MOST_FACES],
    vertex_count: u8,
    face_count: u8,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            vertices: [[0; 2]; MOST_VERTICES],
            faces: [([0; 3], [0; 3]); MOST_FACES],
            vertex_count: 0,
            face_count: 0,
        }
    }
}

impl Surface {
    pub(crate) fn vertices(&self) -> &[[u32; 2]] {
        &self.vertices[..usize::from(self.vertex_count)]
    }

    pub(crate) fn faces(&self) -> &[([u8; 3], [u8; 3])] {
        &self.faces[..usize::from(self.face_count)]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.face_count == 0
    }

    pub(crate) fn clear(&mut self) {
        self.vertex_count = 0;
        self.face_count = 0;
    }

    /// The number of the new vertex; `None` and an empty surface where there is no room.
    pub(crate) fn add_vertex(&mut self, indices: [u32; 2]) -> Option<u8> {
        let number = self.vertex_count;
        let Some(slot) = self.vertices.get_mut(usize::from(number)) else {
            self.clear();
            return None;
        };
        *slot = indices;
        self.vertex_count += 1;
        Some(number)
    }

    /// Whether there was room; else the surface is empty.
    pub(crate) fn add_face(&mut self, corners: [u8; 3], across: [u8; 3]) -> bool {
        let Some(slot) = self.faces.get_mut(usize::from(self.face_count)) else {
            self.clear();
            return false;
        };
        *slot = (corners, across);
        self.face_count += 1;
        true
    }
}
