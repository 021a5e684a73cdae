//! Which vertices of a mesh lie at exactly the same place.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::DVec3;

use super::TriangleMesh;

/// An empty slot of the table.
const FREE: u32 = u32::MAX;

/// Steps over taken slots per vertex before the table is given up: a good hash takes one, positions made to collide
/// take as many as there are vertices.
const STEPS_PER_VERTEX: usize = 16;

impl TriangleMesh {
    /// For each vertex the lowest-numbered one at its position (−0 is 0); `None` if every position occurs once.
    ///
    /// About 40 ms for half a million vertices, of which most is waiting for memory.
    pub fn coincident_vertices(&self) -> Option<Vec<u32>> {
        first_at(&self.positions)
    }

    /// The mesh with equal positions joined, a copy only where something changes. Vertices that no triangle uses may
    /// stay.
    pub(crate) fn joined(&self) -> Cow<'_, Self> {
        let repeats = |&[a, b, c]: &[u32; 3]| a == b || b == c || c == a;
        match first_at(&self.positions) {
            None if !self.triangles.iter().any(repeats) => Cow::Borrowed(self),
            first => Cow::Owned(self.merged(first).0),
        }
    }
}

/// For each position the first equal one; `None` if all differ.
pub(super) fn first_at(positions: &[DVec3]) -> Option<Vec<u32>> {
    let (first, distinct) = by_table(positions).unwrap_or_else(|| by_keyed_hash(positions));
    (distinct < positions.len()).then_some(first)
}

/// One pass with an open-addressing table of vertex numbers, at most half full: the first vertex at the place of each, and
/// how many places there are. `None` when too many positions collide.
fn by_table(positions: &[DVec3]) -> Option<(Vec<u32>, usize)> {
    let mask = (2 * positions.len()).next_power_of_two() - 1;
    let mut table = vec![FREE; mask + 1];
    let mut first = Vec::with_capacity(positions.len());
    let mut steps_left = STEPS_PER_VERTEX * positions.len();
    let mut distinct = 0;
    for (vertex, position) in (0..).zip(positions) {
        let mut slot = hash(*position) & mask;
        while table[slot] != FREE && positions[table[slot] as usize] != *position {
            slot = (slot + 1) & mask;
            steps_left = steps_left.checked_sub(1)?;
        }
        if table[slot] == FREE {
            table[slot] = vertex;
            distinct += 1;
        }
        first.push(table[slot]);
    }
    Some((first, distinct))
}

/// The same with the standard library's hash, which no file can foresee; several times slower.
fn by_keyed_hash(positions: &[DVec3]) -> (Vec<u32>, usize) {
    let mut known: HashMap<[u64; 3], u32> = HashMap::with_capacity(positions.len());
    let first: Vec<u32> = (0..)
        .zip(positions)
        .map(|(vertex, &position)| *known.entry(bits(position)).or_insert(vertex))
        .collect();
    (first, known.len())
}

/// Negative zero is zero.
fn bits(position: DVec3) -> [u64; 3] {
    (position + 0.0).to_array().map(f64::to_bits)
}

/// Mixes the bits of the coordinates (the finaliser of Steele, Lea & Flood 2014, `SplitMix64`).
#[expect(
    clippy::cast_possible_truncation,
    reason = "the table is smaller than 2³² entries"
)]
fn hash(position: DVec3) -> usize {
    let [x, y, z] = bits(position);
    let mut mixed = x ^ y.rotate_left(21) ^ z.rotate_left(42);
    mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    (mixed ^ mixed >> 31) as usize
}

#[cfg(test)]
mod tests {
    use super::{bits, by_keyed_hash, by_table, first_at, hash};
    use glam::DVec3;

    #[test]
    fn the_first_of_a_place_stands_for_all() {
        let mut positions: Vec<DVec3> = (0..5000)
            .map(|i| DVec3::new(f64::from(i % 50), f64::from(i / 50), 0.0))
            .collect();
        assert_eq!(first_at(&positions), None);
        assert_eq!(by_table(&positions), Some(by_keyed_hash(&positions)));
        positions.push(DVec3::new(-0.0, 0.0, -0.0));
        positions.push(DVec3::new(49.0, 99.0, 0.0));
        let first = first_at(&positions).expect("repeats");
        assert_eq!(
            (first[5000], first[5001], first[4999], first[17]),
            (0, 4999, 4999, 17)
        );
        assert_eq!(by_keyed_hash(&positions), (first.clone(), 5000));
        assert_eq!(by_table(&positions), Some((first, 5000)));
    }

    /// The first table alone would take 10¹⁰ steps.
    #[test]
    fn positions_made_to_collide_cost_no_more_than_a_second_table() {
        let [x, y, _] = bits(DVec3::new(1.5, 2.5, 0.0));
        let goal = x ^ y.rotate_left(21);
        let colliding: Vec<DVec3> = (0..150_000_u64)
            .map(|i| (y + i, goal ^ (y + i).rotate_left(21)))
            .map(|(y, x)| DVec3::new(f64::from_bits(x), f64::from_bits(y), 0.0))
            .filter(|p| p.is_finite() && hash(*p) == hash(DVec3::new(1.5, 2.5, 0.0)))
            .collect();
        assert!(colliding.len() > 100_000, "{}", colliding.len());
        assert_eq!(by_table(&colliding), None);
        assert_eq!(first_at(&colliding), None);
    }
}
