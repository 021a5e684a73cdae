//! Banded LU, as the paper has it: only the diagonals that hold anything, 45 × 19 = 855 numbers for its tool. The matrix is
//! positive definite, so no rows are exchanged and the band stays as it is.

use crate::beam::Beam;
use crate::linear::{Unknowns, assemble};

/// A banded matrix and its factors. Row i holds columns i − m … i + m.
#[derive(Clone, Debug)]
pub struct BandedLu {
    size: usize,
    half_band: usize,
    stiffness: Vec<f64>,
    factors: Vec<f64>,
}

impl BandedLu {
    /// The stiffness matrix of a beam, clamped at its root; not yet factorised.
    pub fn of(beam: &Beam, unknowns: Unknowns) -> Self {
        let size = beam.elements().len() * unknowns.per_node();
        let half_band = unknowns.half_band();
        let width = 2 * half_band + 1;
        let mut stiffness = vec![0.0; size * width];
        assemble(beam, unknowns, |row, column, value| {
            stiffness[row * width + column + half_band - row] += value;
        });
        Self {
            size,
            half_band,
            factors: stiffness.clone(),
            stiffness,
        }
    }

    /// Number of unknowns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// How many numbers are stored: size × (2 half bands + 1).
    pub fn stored(&self) -> usize {
        self.stiffness.len()
    }

    /// K = L U. Returns whether all pivots are above 0. Allocates nothing.
    pub fn factorise(&mut self) -> bool {
        self.factors.copy_from_slice(&self.stiffness);
        let (n, m) = (self.size, self.half_band);
        let width = 2 * m + 1;
        for column in 0..n {
            let last = (column + m).min(n - 1);
            let reach = last - column;
            let (done, rest) = self.factors.split_at_mut((column + 1) * width);
            let pivot_row = &done[column * width + m..];
            let pivot = pivot_row[0];
            if pivot.is_nan() || pivot <= 0.0 {
                return false;
            }
            let inverse = 1.0 / pivot;
            for (below, row) in rest.chunks_exact_mut(width).take(reach).enumerate() {
                let own = &mut row[m - 1 - below..];
                let factor = own[0] * inverse;
                own[0] = factor;
                for (value, above) in own[1..=reach].iter_mut().zip(&pivot_row[1..=reach]) {
                    *value -= factor * above;
                }
            }
        }
        true
    }

    /// R into D, after [`BandedLu::factorise`]. Allocates nothing.
    ///
    /// # Panics
    /// When `vector` is not as long as the matrix is wide.
    pub fn solve(&self, vector: &mut [f64]) {
        let (n, m) = (self.size, self.half_band);
        assert_eq!(vector.len(), n, "one value per unknown");
        let width = 2 * m + 1;
        for row in 0..n {
            let first = row.saturating_sub(m);
            let factors = &self.factors[row * width + m + first - row..row * width + m];
            let sum: f64 = factors
                .iter()
                .zip(&vector[first..row])
                .map(|(f, v)| f * v)
                .sum();
            vector[row] -= sum;
        }
        for row in (0..n).rev() {
            let last = (row + m).min(n - 1);
            let factors = &self.factors[row * width + m..];
            let after = &vector[row + 1..=last];
            let sum: f64 = factors[1..].iter().zip(after).map(|(f, v)| f * v).sum();
            vector[row] = (vector[row] - sum) / factors[0];
        }
    }
}
