//! Stiffness matrices of single elements (beam.3, beam.4).
//!
//! Order of unknowns: (u, v, w, r_x, r_y, r_z) of node 1, then of node 2, along and about the element's own axes; in the plane
//! x–y a rotation r_z turns v up, in the plane x–z a rotation r_y turns w down. The paper's element (Laycock & Day 2003, §5) leaves
//! the twist r_x out: 10 unknowns, right for straight tools in the handle's frame.

use glam::DMat3;

use crate::beam::Element;
use crate::flexibility::NaturalStiffness;

/// Stiffness of an element with six unknowns a node, rows by columns [N/m, N, N·m].
pub type Matrix12 = [[f64; 12]; 12];

/// Stiffness of an element without twist, five unknowns a node (u, v, w, r_y, r_z).
pub type Matrix10 = [[f64; 10]; 10];

/// Where the unknowns of the 10-DOF element are among the twelve.
const WITHOUT_TWIST: [usize; 10] = [0, 1, 2, 4, 5, 6, 7, 8, 10, 11];

/// Stiffness in the element's own axes.
pub fn stiffness_12(element: &Element) -> Matrix12 {
    let length = element.chord;
    let natural = element.flexibility.stiffness(length);
    let rows = deformations(length);
    let mut matrix = [[0.0; 12]; 12];
    let NaturalStiffness {
        axial,
        torsion,
        about_y,
        about_z,
    } = natural;
    let mut add = |i: usize, j: usize, value: f64| {
        for (row, own) in rows[i].iter().zip(&mut matrix) {
            for (column, entry) in rows[j].iter().zip(own) {
                *entry += row * value * column;
            }
        }
    };
    add(0, 0, axial);
    add(1, 1, torsion);
    for (first, [k11, k12, k22]) in [(2, about_y), (4, about_z)] {
        add(first, first, k11);
        add(first, first + 1, k12);
        add(first + 1, first, k12);
        add(first + 1, first + 1, k22);
    }
    matrix
}

/// What the unknowns do to the element: rows stretch, twist, end rotations about y from the chord, and about z.
fn deformations(length: f64) -> [[f64; 12]; 6] {
    let mut rows = [[0.0; 12]; 6];
    (rows[0][0], rows[0][6]) = (-1.0, 1.0);
    (rows[1][3], rows[1][9]) = (-1.0, 1.0);
    let tilt = 1.0 / length;
    for (row, rotation) in [(2, 4), (3, 10)] {
        rows[row][rotation] = 1.0;
        // The chord turns about −y as w grows.
        (rows[row][2], rows[row][8]) = (-tilt, tilt);
    }
    for (row, rotation) in [(4, 5), (5, 11)] {
        rows[row][rotation] = 1.0;
        (rows[row][1], rows[row][7]) = (tilt, -tilt);
    }
    rows
}

/// The paper's element, in its own axes: no twist, no torsional stiffness.
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
