//! Dense LU with partial pivoting, as the paper has it: the full matrix, 45 × 45 = 2025 numbers for its tool.

use crate::beam::Beam;
use crate::linear::{Unknowns, assemble};

/// A dense matrix and its factors, row by row.
#[derive(Clone, Debug)]
pub struct DenseLu {
    size: usize,
    stiffness: Vec<f64>,
    factors: Vec<f64>,
    pivots: Vec<usize>,
}

impl DenseLu {
    /// The stiffness matrix of a beam, clamped at its root; not yet factorised.
    pub fn of(beam: &Beam, unknowns: Unknowns) -> Self {
        let size = beam.elements().len() * unknowns.per_node();
        let mut stiffness = vec![0.0; size * size];
        assemble(beam, unknowns, |row, column, value| {
            stiffness[row * size + column] += value;
        });
        Self {
            size,
            factors: stiffness.clone(),
            stiffness,
            pivots: vec![0; size],
        }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// K, row by row [N/m, N, N·m].
    pub fn stiffness(&self) -> &[f64] {
        &self.stiffness
    }

    /// P K = L U. Returns whether all pivots are other than 0. Allocates nothing.
    pub fn factorise(&mut self) -> bool {
        let n = self.size;
        self.factors.copy_from_slice(&self.stiffness);
        for column in 0..n {
            let mut pivot = column;
            for row in column + 1..n {
                if self.factors[row * n + column].abs() > self.factors[pivot * n + column].abs() {
                    pivot = row;
                }
            }
            self.pivots[column] = pivot;
            if pivot != column {
                for k in 0..n {
                    self.factors.swap(column * n + k, pivot * n + k);
                }
            }
            let (done, rest) = self.factors.split_at_mut((column + 1) * n);
            let pivot_row = &done[column * n..];
            if pivot_row[column] == 0.0 {
                return false;
            }
            let inverse = 1.0 / pivot_row[column];
            for row in rest.chunks_exact_mut(n) {
                let factor = row[column] * inverse;
                row[column] = factor;
                for (value, above) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]) {
                    *value -= factor * above;
                }
            }
        }
        true
    }

    /// R into D, after [`DenseLu::factorise`]. Allocates nothing.
    ///
    /// # Panics
    /// When `vector` is not as long as the matrix is wide.
    pub fn solve(&self, vector: &mut [f64]) {
        let n = self.size;
        assert_eq!(vector.len(), n, "one value per unknown");
        for row in 0..n {
            vector.swap(row, self.pivots[row]);
        }
        for row in 0..n {
            let (before, own) = vector.split_at_mut(row);
            let factors = &self.factors[row * n..row * n + row];
            own[0] -= dot(factors, before);
        }
        for row in (0..n).rev() {
            let (own, after) = vector[row..].split_at_mut(1);
            let factors = &self.factors[row * n + row + 1..(row + 1) * n];
            own[0] = (own[0] - dot(factors, after)) / self.factors[row * n + row];
        }
    }
}

fn dot(left: &[f64], right: &[f64]) -> f64 {
    left.iter().zip(right).map(|(l, r)| l * r).sum()
}
