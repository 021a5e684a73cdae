//! Stiffness matrices of single elements.
//!
//! Order of unknowns: (u, v, w, `r_x`, `r_y`, `r_z`) of node 1, then of node 2, along and about the element's own axes; in the plane
//! x–y a rotation `r_z` turns v up, in the plane x–z a rotation `r_y` turns w down. The paper's element (Laycock & Day 2003, §5) leaves
//! the twist `r_x` out: 10 unknowns, right for straight tools in the handle's frame.

use glam::DMat3;

use crate::beam::Element;
use crate::natural::NaturalStiffness;

/// Stiffness of an element with six unknowns a node, rows by columns [N/m, N, N·m].
pub type Matrix12 = [[f64; 12]; 12];

/// Stiffness of an element without twist, five unknowns a node (u, v, w, `r_y`, `r_z`).
pub type Matrix10 = [[f64; 10]; 10];

/// Where the unknowns of the 10-DOF element are among the twelve.
const WITHOUT_TWIST: [usize; 10] = [0, 1, 2, 4, 5, 6, 7, 8, 10, 11];

/// Stiffness in the element's own axes (beam.3).
pub fn stiffness_12(element: &Element) -> Matrix12 {
    let NaturalStiffness {
        axial,
        coupling,
        rotations,
    } = &element.stiffness;
    let rows = deformations(element.chord);
    let mut matrix = [[0.0; 12]; 12];
    let mut add = |i: usize, j: usize, value: f64| {
        for (row, own) in rows[i].iter().zip(&mut matrix) {
            for (column, entry) in rows[j].iter().zip(own) {
                *entry += row * value * column;
            }
        }
    };
    add(0, 0, *axial);
    for end in 0..2 {
        for (axis, coupling) in coupling[end].to_array().into_iter().enumerate() {
            let row = 1 + 3 * end + axis;
            add(0, row, coupling);
            add(row, 0, coupling);
            for other in 0..3 {
                add(
                    row,
                    1 + 3 * end + other,
                    rotations[2 * end].col(other)[axis],
                );
                if end == 0 {
                    let value = rotations[1].col(other)[axis];
                    add(row, 4 + other, value);
                    add(4 + other, row, value);
                }
            }
        }
    }
    matrix
}

/// What the unknowns do to the element: rows stretch, then rotations of node 1 and of node 2 from the chord; about x the chord turns
/// with neither.
fn deformations(length: f64) -> [[f64; 12]; 7] {
    let mut rows = [[0.0; 12]; 7];
    (rows[0][0], rows[0][6]) = (-1.0, 1.0);
    let tilt = 1.0 / length;
    for (row, rotation) in [(1, 3), (4, 9)] {
        for axis in 0..3 {
            rows[row + axis][rotation + axis] = 1.0;
        }
        // The chord turns about −y as w grows, about z as v does.
        (rows[row + 1][2], rows[row + 1][8]) = (-tilt, tilt);
        (rows[row + 2][1], rows[row + 2][7]) = (tilt, -tilt);
    }
    rows
}

/// The paper's element, in its own axes: no twist, no torsional stiffness (beam.4).
pub fn stiffness_10(element: &Element) -> Matrix10 {
    let full = stiffness_12(element);
    WITHOUT_TWIST.map(|row| WITHOUT_TWIST.map(|column| full[row][column]))
}

/// A stiffness in axes that `rotation` takes the element's to: T K Tᵀ with one 3 × 3 block per vector (Laycock & Day 2003, eq. 4).
pub fn rotated(matrix: &Matrix12, rotation: &DMat3) -> Matrix12 {
    let mut turned = [[0.0; 12]; 12];
    for row in 0..4 {
        for column in 0..4 {
            let block = DMat3::from_cols_array_2d(
                &[0, 1, 2].map(|j| [0, 1, 2].map(|i| matrix[3 * row + i][3 * column + j])),
            );
            let block = *rotation * block * rotation.transpose();
            for i in 0..3 {
                for j in 0..3 {
                    turned[3 * row + i][3 * column + j] = block.col(j)[i];
                }
            }
        }
    }
    turned
}
