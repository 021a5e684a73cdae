//! The stiffness method for small deflections: K D = R with the root clamped.
//!
//! Three factorisations of the same matrix stand side by side: dense LU and banded LU as in Laycock & Day (2003, §5), and a
//! block-tridiagonal one that makes use of each node touching only its neighbours. In the handle's frame K never changes, so it
//! is factorised once and every tick only substitutes.

use glam::DVec3;

use crate::beam::Beam;
use crate::element::{Matrix12, rotated, stiffness_10, stiffness_12};
use crate::load::{Displacement, Loading};

mod banded;
mod block;
mod consistent;
mod dense;

pub use banded::BandedLu;
pub use block::{BlockTridiagonal, Definiteness};
pub use dense::DenseLu;

pub(crate) use block::{Block, inverse};
pub use consistent::consistent_loads;

/// Unknowns of each node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknowns {
    /// u, v, w, `r_y`, `r_z`: the paper's, for straight tools in the handle's frame.
    WithoutTwist,
    /// u, v, w, `r_x`, `r_y`, `r_z`: any beam.
    Six,
}

impl Unknowns {
    /// How many a node has.
    pub fn per_node(self) -> usize {
        match self {
            Self::WithoutTwist => 5,
            Self::Six => 6,
        }
    }

    /// Sub-diagonals of the assembled matrix: a node and the one before it.
    pub fn half_band(self) -> usize {
        2 * self.per_node() - 1
    }
}

/// Calls `add(row, column, value)` for every entry of every element that belongs to free unknowns, in the root's frame; entries at one
/// place add up (beam.5). Unknowns of the first node are left out: it is clamped.
///
/// # Panics
/// For a beam bent at rest and [`Unknowns::WithoutTwist`], whose elements cannot be turned into one frame.
pub fn assemble(beam: &Beam, unknowns: Unknowns, mut add: impl FnMut(usize, usize, f64)) {
    assert!(
        unknowns == Unknowns::Six || beam.is_straight(),
        "without twist only straight beams can be assembled"
    );
    let per_node = unknowns.per_node();
    for (index, element) in beam.elements().iter().enumerate() {
        let mut scatter = |row: usize, column: usize, value: f64| {
            let first = index * per_node;
            if let (Some(row), Some(column)) = (
                (first + row).checked_sub(per_node),
                (first + column).checked_sub(per_node),
            ) {
                add(row, column, value);
            }
        };
        match unknowns {
            Unknowns::WithoutTwist => each(&stiffness_10(element), &mut scatter),
            Unknowns::Six => each(&in_root_frame(beam, index), &mut scatter),
        }
    }
}

fn each<const N: usize>(matrix: &[[f64; N]; N], add: &mut impl FnMut(usize, usize, f64)) {
    for (row, values) in matrix.iter().enumerate() {
        for (column, value) in values.iter().enumerate() {
            add(row, column, *value);
        }
    }
}

/// Stiffness of an element in the root's frame.
fn in_root_frame(beam: &Beam, index: usize) -> Matrix12 {
    let element = &beam.elements()[index];
    rotated(&stiffness_12(element), &element.rest)
}

/// A beam with its block-tridiagonal factor: solves for all nodes, and recovers anything in between. Owns its workspace.
#[derive(Clone, Debug)]
pub struct StiffnessMethod {
    beam: Beam,
    factor: BlockTridiagonal,
    /// Load and then displacement of the free nodes.
    nodes: Vec<[f64; 6]>,
}

impl StiffnessMethod {
    /// Assembles and factorises.
    pub fn new(beam: Beam) -> Self {
        let mut factor = BlockTridiagonal::new(beam.elements().len());
        assemble(&beam, Unknowns::Six, |row, column, value| {
            factor.add(row, column, value);
        });
        factor.factorise();
        let nodes = vec![[0.0; 6]; beam.elements().len()];
        Self {
            beam,
            factor,
            nodes,
        }
    }

    /// The beam.
    pub fn beam(&self) -> &Beam {
        &self.beam
    }

    /// Solves for a loading. Allocates nothing.
    pub fn solve(&mut self, loading: &Loading<'_>) {
        self.nodes.fill([0.0; 6]);
        consistent_loads(&self.beam, loading, |node, load| {
            if let Some(free) = node.checked_sub(1) {
                for (sum, value) in self.nodes[free].iter_mut().zip(load) {
                    *sum += value;
                }
            }
        });
        self.factor.solve(&mut self.nodes);
    }

    /// Displacement of a node after [`StiffnessMethod::solve`]; node 0 is the root.
    pub fn node(&self, index: usize) -> Displacement {
        index
            .checked_sub(1)
            .map_or_else(Displacement::default, |free| {
                let [u, v, w, rx, ry, rz] = self.nodes[free];
                Displacement {
                    translation: DVec3::new(u, v, w),
                    rotation: DVec3::new(rx, ry, rz),
                }
            })
    }
}
