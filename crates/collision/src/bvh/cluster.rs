//! Leaves of a tree, made before the tree: boxes that are neighbours along a Morton curve join in mutually nearest pairs.
//!
//! These are the first rounds of PLOC (Meister & Bittner 2018) with search distance one, and the surface area heuristic
//! (`MacDonald` & Booth 1990) decides which pairs stay apart. A builder over the leaves has a quarter of the boxes to
//! sort, pair and reinsert, and no nodes to take away afterwards.

use obvhs::Boundable;
use obvhs::aabb::Aabb;

use super::frame::UnitBox;

/// Rounds of pairing. Each joins two thirds of the groups at best.
const ROUNDS: usize = 4;

/// Most primitives of a leaf.
const MOST: usize = 8;

/// Cost of a step down the tree relative to that of a primitive's test.
const STEP_COST: f32 = 3.0;

/// Bits per axis of a Morton code.
const BITS: u32 = 21;

/// Primitives that share a leaf: a range of the order in which all are listed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Group {
    pub(super) bounds: UnitBox,
    pub(super) start: usize,
    pub(super) count: usize,
}

impl Boundable for Group {
    fn aabb(&self) -> Aabb {
        self.bounds.to_obvhs()
    }
}

/// Groups over all of `boxes`, and the primitives in the order to which their ranges refer.
pub(super) fn groups(boxes: &[UnitBox]) -> (Vec<Group>, Vec<u32>) {
    let mut keys: Vec<(u64, u32)> = boxes.iter().map(morton).zip(0..).collect();
    keys.sort_unstable();
    let order: Vec<u32> = keys.iter().map(|key| key.1).collect();
    drop(keys);
    let single = |(start, &primitive): (usize, &u32)| Group {
        bounds: boxes[primitive as usize].or_origin(),
        start,
        count: 1,
    };
    let mut groups: Vec<Group> = order.iter().enumerate().map(single).collect();
    for _ in 0..ROUNDS {
        join_pairs(&mut groups);
    }
    (groups, order)
}

/// Joins every two neighbours that gain by it and have no better partner, in place.
fn join_pairs(groups: &mut Vec<Group>) {
    let mut cost_before = f32::INFINITY;
    let mut cost = groups.get(1).map_or(f32::INFINITY, |b| pair(&groups[0], b));
    let (mut read, mut write) = (0, 0);
    while read < groups.len() {
        let cost_after = match groups.get(read + 1..read + 3) {
            Some([b, c]) => pair(b, c),
            _ => f32::INFINITY,
        };
        let mut group = groups[read];
        if cost < cost_before && cost <= cost_after {
            let next = groups[read + 1];
            group.bounds = group.bounds.union(&next.bounds);
            group.count += next.count;
            read += 1;
            // What follows begins anew: its neighbour on this side is taken.
            cost_before = f32::INFINITY;
            cost = match groups.get(read + 1..read + 3) {
                Some([b, c]) => pair(b, c),
                _ => f32::INFINITY,
            };
        } else {
            cost_before = cost;
            cost = cost_after;
        }
        groups[write] = group;
        write += 1;
        read += 1;
    }
    groups.truncate(write);
}

/// Half the area around both; infinite if they shall stay apart.
fn pair(a: &Group, b: &Group) -> f32 {
    let count = a.count + b.count;
    let around = half_area(&a.bounds.union(&b.bounds));
    let apart = half_area(&a.bounds) * weight(a.count) + half_area(&b.bounds) * weight(b.count);
    if count <= MOST && around * (weight(count) - STEP_COST) <= apart {
        around
    } else {
        f32::INFINITY
    }
}

#[expect(clippy::cast_precision_loss, reason = "at most twice MOST")]
fn weight(count: usize) -> f32 {
    count as f32
}

fn half_area(bounds: &UnitBox) -> f32 {
    let [x, y, z] = [0, 1, 2].map(|axis| bounds.max[axis] - bounds.min[axis]);
    x * y + y * z + z * x
}

/// Place of a box's middle along the Morton curve through [−1, 1]³; what lies outside counts as on the border.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the cells; NaN becomes 0"
)]
fn morton(bounds: &UnitBox) -> u64 {
    let cells = f64::from(1_u32 << BITS);
    let axis = |axis: usize| {
        let middle = 0.5 * (f64::from(bounds.min[axis]) + f64::from(bounds.max[axis]));
        spread((0.5 * (middle + 1.0) * cells).clamp(0.0, cells - 1.0) as u64)
    };
    axis(0) << 2 | axis(1) << 1 | axis(2)
}

/// Moves bit k of the lowest 21 to bit 3 k.
fn spread(cell: u64) -> u64 {
    let mut bits = cell;
    for (shift, mask) in [
        (32, 0x001F_0000_0000_FFFF),
        (16, 0x001F_0000_FF00_00FF),
        (8, 0x100F_00F0_0F00_F00F),
        (4, 0x10C3_0C30_C30C_30C3),
        (2, 0x1249_2492_4924_9249),
    ] {
        bits = (bits | bits << shift) & mask;
    }
    bits
}

#[cfg(test)]
mod tests {
    use super::{Group, MOST, groups, morton, spread};
    use crate::bvh::frame::UnitBox;

    fn at(x: f32, y: f32, half: f32) -> UnitBox {
        UnitBox {
            min: [x - half, y - half, -half],
            max: [x + half, y + half, half],
        }
    }

    #[test]
    fn spread_moves_every_bit() {
        for bit in 0..21 {
            assert_eq!(spread(1 << bit), 1 << (3 * bit));
        }
        assert_eq!(spread((1 << 21) - 1), 0x1249_2492_4924_9249);
        let corner = |x| at(x, x, 0.0);
        assert!(morton(&corner(-9.0)) < morton(&corner(-0.5)));
        assert!(morton(&corner(0.5)) < morton(&corner(9.0)));
    }

    #[test]
    fn every_primitive_is_in_one_group_of_limited_size_within_its_bounds() {
        let mut boxes: Vec<UnitBox> = (0_u8..=255)
            .flat_map(|i| {
                (0_u8..20).map(move |j| (f32::from(i) / 128.0 - 1.0, f32::from(j) / 20.0))
            })
            .map(|(x, y)| at(x, y * y * y, 0.003 + 0.1 * (y * 90.0).sin().max(0.0)))
            .collect();
        boxes.push(UnitBox::EMPTY);
        for count in [0, 1, 2, 3, 10, boxes.len()] {
            let (found, order) = groups(&boxes[..count]);
            let mut next = 0;
            for Group {
                bounds,
                start,
                count,
            } in found
            {
                assert_eq!(start, next);
                assert!((1..=MOST).contains(&count));
                next += count;
                for &one in &order[start..next] {
                    let inside = boxes[one as usize].or_origin();
                    assert_eq!(bounds.union(&inside), bounds);
                }
            }
            assert_eq!(next, count);
            let mut sorted = order;
            sorted.sort_unstable();
            assert!(sorted.into_iter().eq((0..).take(count)));
        }
    }

    #[test]
    fn far_pairs_stay_apart_once_leaves_have_primitives_enough() {
        let mut boxes = vec![at(-0.9, -0.9, 0.001); 4];
        boxes.extend(vec![at(0.9, 0.9, 0.001); 4]);
        let (found, _) = groups(&boxes);
        assert!(
            found
                .iter()
                .all(|group| group.bounds.max[0] - group.bounds.min[0] < 0.01)
        );
    }
}
