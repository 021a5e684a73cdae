//! Block-tridiagonal factorisation: 6 × 6 blocks, one per node, and one between neighbours (beam.6).
//!
//! From the root on, S₁ = K₁₁, Sᵢ = Kᵢᵢ − Kᵢ,ᵢ₋₁ Sᵢ₋₁⁻¹ Kᵢ₋₁,ᵢ; the inverses of S are kept, so substitution is three small products
//! a node. Blocks are inverted with the largest pivots, which also serves tangents that are neither symmetric nor definite.

/// A 6 × 6 matrix, row by row.
pub(crate) type Block = [[f64; 6]; 6];

/// Stiffness between nodes and their neighbours, and its factors.
#[derive(Clone, Debug)]
pub struct BlockTridiagonal {
    diagonal: Vec<Block>,
    /// Row i + 1, column i.
    below: Vec<Block>,
    /// Row i, column i + 1.
    above: Vec<Block>,
    /// Inverses of the blocks S.
    inverse: Vec<Block>,
    /// Sᵢ⁻¹ Kᵢ,ᵢ₊₁.
    carried: Vec<Block>,
}

/// What a factorisation says of the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Definiteness {
    /// All pivots are above 0: a symmetric matrix is positive definite.
    Positive,
    /// So many pivots are below 0: a symmetric matrix has as many negative eigenvalues.
    Indefinite(usize),
    /// A pivot is 0 or not a number: there is no factor.
    Singular,
}

impl BlockTridiagonal {
    /// Zero, for so many nodes.
    pub fn new(nodes: usize) -> Self {
        let blocks = vec![[[0.0; 6]; 6]; nodes];
        let between = vec![[[0.0; 6]; 6]; nodes.saturating_sub(1)];
        Self {
            diagonal: blocks.clone(),
            below: between.clone(),
            above: between.clone(),
            inverse: blocks,
            carried: between,
        }
    }

    /// Sets all to zero. Allocates nothing.
    pub fn clear(&mut self) {
        for blocks in [&mut self.diagonal, &mut self.below, &mut self.above] {
            blocks.fill([[0.0; 6]; 6]);
        }
    }

    /// Adds to an entry, rows and columns counted over all nodes.
    ///
    /// # Panics
    /// For entries between nodes that are not neighbours.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let (node, other) = (row / 6, column / 6);
        let block = if node == other {
            &mut self.diagonal[node]
        } else if node == other + 1 {
            &mut self.below[other]
        } else {
            assert_eq!(node + 1, other, "only neighbours touch");
            &mut self.above[node]
        };
        block[row % 6][column % 6] += value;
    }

    /// The blocks (diagonal, below, above), to be added to.
    pub(crate) fn blocks(&mut self) -> (&mut [Block], &mut [Block], &mut [Block]) {
        (&mut self.diagonal, &mut self.below, &mut self.above)
    }

    /// Factorises what has been added. Allocates nothing.
    pub fn factorise(&mut self) -> Definiteness {
        let mut negative = 0;
        for node in 0..self.diagonal.len() {
            let mut block = self.diagonal[node];
            if let Some(before) = node.checked_sub(1) {
                subtract_product(&mut block, &self.below[before], &self.carried[before]);
            }
            let Some(sign_changes) = invert(&mut block) else {
                return Definiteness::Singular;
            };
            negative += sign_changes;
            self.inverse[node] = block;
            if let Some(above) = self.above.get(node) {
                self.carried[node] = product(&block, above);
            }
        }
        if negative == 0 {
            Definiteness::Positive
        } else {
            Definiteness::Indefinite(negative)
        }
    }

    /// R into D, after [`BlockTridiagonal::factorise`]. Allocates nothing.
    pub fn solve(&self, nodes: &mut [[f64; 6]]) {
        for node in 0..nodes.len() {
            if let Some(before) = node.checked_sub(1) {
                let known = nodes[before];
                multiply_add(&self.below[before], &known, -1.0, &mut nodes[node]);
            }
            let rest = nodes[node];
            nodes[node] = [0.0; 6];
            multiply_add(&self.inverse[node], &rest, 1.0, &mut nodes[node]);
        }
        for node in (0..nodes.len().saturating_sub(1)).rev() {
            let known = nodes[node + 1];
            multiply_add(&self.carried[node], &known, -1.0, &mut nodes[node]);
        }
    }
}

/// `sum` + `factor` · `matrix` · `vector`.
fn multiply_add(matrix: &Block, vector: &[f64; 6], factor: f64, sum: &mut [f64; 6]) {
    for (sum, row) in sum.iter_mut().zip(matrix) {
        let mut product = 0.0;
        for (value, other) in row.iter().zip(vector) {
            product += value * other;
        }
        *sum += factor * product;
    }
}

fn product(left: &Block, right: &Block) -> Block {
    let mut result = [[0.0; 6]; 6];
    for (own, row) in result.iter_mut().zip(left) {
        for (value, other) in row.iter().zip(right) {
            for (sum, entry) in own.iter_mut().zip(other) {
                *sum += value * entry;
            }
        }
    }
    result
}

fn subtract_product(from: &mut Block, left: &Block, right: &Block) {
    for (own, row) in from.iter_mut().zip(left) {
        for (value, other) in row.iter().zip(right) {
            for (sum, entry) in own.iter_mut().zip(other) {
                *sum -= value * entry;
            }
        }
    }
}

/// A pivot smaller than this times the diagonal it came from is not taken unseen.
const SMALL_PIVOT: f64 = 1e-6;

/// Inverts in place by Gauss–Jordan with pivots on the diagonal; returns how many are negative, which of a symmetric matrix is its
/// number of negative eigenvalues (Sylvester). `None`: there is none to divide by.
fn invert(block: &mut Block) -> Option<usize> {
    let original = *block;
    let mut negative = 0;
    for pivot in 0..6 {
        let value = block[pivot][pivot];
        if value.abs() < SMALL_PIVOT * original[pivot][pivot].abs() {
            *block = original;
            return invert_pivoted(block);
        }
        negative += usize::from(value < 0.0);
        eliminate(block, pivot);
    }
    block[5][5].is_finite().then_some(negative)
}

/// The same with the largest pivot first.
#[cold]
fn invert_pivoted(block: &mut Block) -> Option<usize> {
    let mut negative = 0;
    let mut open = [true; 6];
    for _ in 0..6 {
        let size = |index: &usize| block[*index][*index].abs();
        let pivot = (0..6)
            .filter(|index| open[*index])
            .max_by(|left, right| size(left).total_cmp(&size(right)))?;
        if size(&pivot) == 0.0 || !size(&pivot).is_finite() {
            return None;
        }
        open[pivot] = false;
        negative += usize::from(block[pivot][pivot] < 0.0);
        eliminate(block, pivot);
    }
    Some(negative)
}

/// Exchanges an unknown for its right-hand side.
#[inline]
fn eliminate(block: &mut Block, pivot: usize) {
    let mut row = block[pivot];
    let inverse = 1.0 / row[pivot];
    row[pivot] = 1.0;
    for value in &mut row {
        *value *= inverse;
    }
    // The pivot's own row comes out wrong here and is set below: a loop without a branch is faster.
    for own in block.iter_mut() {
        let factor = own[pivot];
        own[pivot] = 0.0;
        for (value, other) in own.iter_mut().zip(&row) {
            *value -= factor * other;
        }
    }
    block[pivot] = row;
}

/// The inverse of a matrix; `None` where there is none.
pub(crate) fn inverse(mut matrix: Block) -> Option<Block> {
    invert(&mut matrix).map(|_| matrix)
}
