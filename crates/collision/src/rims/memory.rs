//! What is remembered of an answer on rims: the start of the search at a placement nearby.

use glam::DVec3;

use crate::rims::feature::FeaturePair;
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

/// A direction out of an overlap and the pairs of features levelled there. No heap, 52 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Memory {
    /// Bits of the direction's coordinates in A's frame: caches are compared.
    outward: [u64; 3],
    /// A vertex of A and one of B on each pair.
    pairs: [[u32; 2]; 3],
    len: u32,
}

impl Memory {
    pub(super) fn new(outward: DVec3, pairs: &[FeaturePair]) -> Self {
        let mut memory = Self {
            outward: outward.to_array().map(f64::to_bits),
            ..Self::default()
        };
        for (own, pair) in memory.pairs.iter_mut().zip(pairs) {
            *own = pair.vertices;
            memory.len += 1;
        }
        memory
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    pub(super) fn outward(&self) -> DVec3 {
        DVec3::from_array(self.outward.map(f64::from_bits))
    }

    /// The pairs' vertices at the present placement.
    pub(super) fn vertices<A, B>(
        &self,
        difference: &MinkowskiDifference<'_, A, B>,
    ) -> impl Iterator<Item = DifferencePoint>
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let pairs = self.pairs.into_iter().take(self.len as usize);
        pairs.map(|[a, b]| difference.vertex(a, b))
    }
}
