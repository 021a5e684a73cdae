//! Which vertices of a mesh lie at exactly the same place, so that neighbours are known on meshes that repeat vertices.

use glam::DVec3;

/// An empty slot of the table.
const FREE: u32 = u32::MAX;

/// For each vertex the lowest-numbered one at its position; `None` if every position occurs once.
///
/// One pass with an open-addressing table of vertex numbers, at most half full.
pub(super) fn representatives(positions: &[DVec3]) -> Option<Vec<u32>> {
    let mask = (2 * positions.len()).next_power_of_two() - 1;
    let mut table = vec![FREE; mask + 1];
    let mut repeats = false;
    let of: Vec<u32> = (0..)
        .zip(positions)
        .map(|(vertex, position)| {
            let mut slot = hash(*position) & mask;
            while table[slot] != FREE && positions[table[slot] as usize] != *position {
                slot = (slot + 1) & mask;
            }
            if table[slot] == FREE {
                table[slot] = vertex;
            } else {
                repeats = true;
            }
            table[slot]
        })
        .collect();
    repeats.then_some(of)
}

/// Mixes the bits of the coordinates (the finaliser of Steele, Lea & Flood 2014, `SplitMix64`).
#[expect(
    clippy::cast_possible_truncation,
    reason = "the table is smaller than 2³² entries"
)]
fn hash(position: DVec3) -> usize {
    // Negative zero is zero.
    let bits = (position + 0.0).to_array().map(f64::to_bits);
    let mut mixed = bits[0] ^ bits[1].rotate_left(21) ^ bits[2].rotate_left(42);
    mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    (mixed ^ mixed >> 31) as usize
}

#[cfg(test)]
mod tests {
    use super::representatives;
    use glam::DVec3;

    #[test]
    fn the_first_of_a_place_stands_for_all() {
        let mut positions: Vec<DVec3> = (0..5000)
            .map(|i| DVec3::new(f64::from(i % 50), f64::from(i / 50), 0.0))
            .collect();
        assert_eq!(representatives(&positions), None);
        positions.push(DVec3::new(-0.0, 0.0, -0.0));
        positions.push(DVec3::new(49.0, 99.0, 0.0));
        let of = representatives(&positions).expect("repeats");
        assert_eq!((of[5000], of[5001], of[4999], of[17]), (0, 4999, 4999, 17));
    }
}
