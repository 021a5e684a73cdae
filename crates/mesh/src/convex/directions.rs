//! Where to start climbing: for every direction, roughly, a vertex that is nearly the furthest along it.

use glam::DVec3;

/// Vertices per cell. A finer table would find the furthest vertex in fewer steps and lose it to the cache.
const VERTICES_PER_CELL: usize = 8;

/// Most cells along a side of the cube: 13,824 in all, 54 KiB.
const MOST_CELLS: usize = 48;

/// The surface of a cube around the origin, each face cut into `side`² cells, with a vertex for each.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    side: usize,
    vertices: Vec<u32>,
}

impl Directions {
    /// `climb` gives the furthest vertex along a direction, started from a vertex.
    pub(super) fn new(vertex_count: usize, climb: impl Fn(DVec3, u32) -> u32) -> Self {
        let mut side = 1;
        while side < MOST_CELLS && 6 * side * side * VERTICES_PER_CELL < vertex_count {
            side += 1;
        }
        let mut vertices = Vec::with_capacity(6 * side * side);
        let mut last = 0;
        for cell in 0..6 * side * side {
            last = climb(middle(cell, side), last);
            vertices.push(last);
        }
        Self { side, vertices }
    }

    /// A vertex near the furthest one along `direction`, of any length.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a float to integer cast saturates, and the least of the cells is taken"
    )]
    pub(super) fn near(&self, direction: DVec3) -> u32 {
        let size = direction.abs();
        let axis = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let major = direction[axis];
        let face = 2 * axis + usize::from(major < 0.0);
        let half = 0.5 * self.side as f64;
        let scale = half / major.abs();
        let cell = |minor: f64| ((minor * scale + half) as usize).min(self.side - 1);
        let column = cell(direction[(axis + 1) % 3]);
        let row = cell(direction[(axis + 2) % 3]);
        self.vertices[(face * self.side + row) * self.side + column]
    }
}

/// Direction of the middle of a cell.
fn middle(cell: usize, side: usize) -> DVec3 {
    let (face, row, column) = (cell / (side * side), cell / side % side, cell % side);
    let axis = face / 2;
    let along = |index: usize| (2 * index + 1) as f64 / side as f64 - 1.0;
    let mut direction = DVec3::ZERO;
    direction[axis] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    direction[(axis + 1) % 3] = along(column);
    direction[(axis + 2) % 3] = along(row);
    direction
}

#[cfg(test)]
mod tests {
    use super::{Directions, middle};
    use glam::DVec3;

    #[test]
    fn middles_find_their_own_cell() {
        let table = Directions {
            side: 7,
            vertices: (0..6 * 49).collect(),
        };
        for cell in 0..6 * 49 {
            assert_eq!(table.near(middle(cell as usize, 7) * 3.0), cell);
        }
        // No direction at all, and none that can be compared, name some vertex.
        assert!(table.near(DVec3::ZERO) < 6 * 49);
        assert!(table.near(DVec3::NAN) < 6 * 49);
    }
}
