//! The hierarchy itself: boxes of anything numbered, built once, refitted in place.
//!
//! Leaves are made first ([`super::cluster`]), then joined by obvhs (PLOC with reinsertion, Meister & Bittner 2018 and
//! 2022), no primitive split, then copied into nodes of 32 bytes in which parents come before children, so that a refit is one backward sweep. Content on which PLOC grows
//! deeper than a traversal's stack holds (boxes in geometric progression) is built by median splits instead.

use std::ops::Range;
use std::time::Duration;

use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use pliant_mesh::Aabb;

use super::cluster::{self, Group};
use super::frame::{UnitBox, UnitFrame};
use super::stack::{DEPTH_LIMIT, Stack};

/// How obvhs builds: leaves stay as they come.
const BUILD: BvhBuildParams = BvhBuildParams {
    search_depth_threshold: 0,
    reinsertion_batch_ratio: 0.1,
    post_collapse_reinsertion_batch_ratio_multiplier: 0.0,
    max_prims_per_leaf: 1,
    ..BvhBuildParams::medium_build()
};

/// Largest leaf of a balanced tree.
const BALANCED_LEAF: usize = 4;

/// A node: inner if `count` is 0, with children at `first` and `first + 1`; else a leaf over slots from `first`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) bounds: UnitBox,
    pub(crate) first: u32,
    pub(crate) count: u32,
}

/// A binary hierarchy over numbered boxes.
pub(crate) struct BoxTree {
    pub(crate) frame: UnitFrame,
    pub(crate) nodes: Vec<Node>,
    /// Number of the primitive in each slot; leaves own ranges of slots.
    pub(crate) primitives: Vec<u32>,
    /// Box of each slot.
    pub(crate) boxes: Vec<UnitBox>,
}

impl Node {
    const EMPTY: Self = Self {
        bounds: UnitBox::EMPTY,
        first: 0,
        count: 0,
    };

    /// Slots of a leaf.
    pub(crate) fn slots(&self) -> Range<usize> {
        let first = self.first as usize;
        first..first + self.count as usize
    }
}

impl BoxTree {
    /// Builds the tree; `bounds` [m] hold all boxes that are bounded.
    pub(super) fn new(bounds: &Aabb, boxes: impl Iterator<Item = Aabb>) -> Self {
        let frame = UnitFrame::around(bounds);
        let in_order: Vec<UnitBox> = boxes.map(|bounds| frame.enclose(&bounds)).collect();
        if in_order.is_empty() {
            return Self {
                frame,
                nodes: Vec::new(),
                primitives: Vec::new(),
                boxes: Vec::new(),
            };
        }
        let mut elapsed = Duration::ZERO;
        let (groups, order) = cluster::groups(&in_order);
        let built = build_bvh2(&groups, BUILD, &mut elapsed);
        let (nodes, primitives) =
            copied(&built, &groups, &order).unwrap_or_else(|| balanced(&in_order));
        let boxes = primitives
            .iter()
            .map(|&primitive| in_order[primitive as usize])
            .collect();
        let mut tree = Self {
            frame,
            nodes,
            primitives,
            boxes,
        };
        tree.refit_nodes();
        tree
    }

    /// New boxes for the same primitives; keeps the tree's shape and allocates nothing.
    pub(super) fn refit(&mut self, bounds: &Aabb, of: impl Fn(u32) -> Aabb) {
        self.frame = UnitFrame::around(bounds);
        for (unit, &primitive) in self.boxes.iter_mut().zip(&self.primitives) {
            *unit = self.frame.enclose(&of(primitive));
        }
        self.refit_nodes();
    }

    fn refit_nodes(&mut self) {
        for index in (0..self.nodes.len()).rev() {
            let node = self.nodes[index];
            let first = node.first as usize;
            self.nodes[index].bounds = if node.count > 0 {
                self.boxes[node.slots()]
                    .iter()
                    .fold(UnitBox::EMPTY, |all, one| all.union(one))
            } else {
                let (left, right) = (&self.nodes[first].bounds, &self.nodes[first + 1].bounds);
                left.union(right)
            };
        }
    }

    /// Calls `visit` with every primitive whose box meets `bounds` [m].
    pub(super) fn overlapping(&self, bounds: &Aabb, mut visit: impl FnMut(u32)) {
        let (low, high) = (self.frame.corner(bounds.min), self.frame.corner(bounds.max));
        let meets = |unit: &UnitBox| {
            let (min, max) = unit.corners();
            min.cmple(high).all() && low.cmple(max).all()
        };
        let mut stack = Stack::new();
        if !self.nodes.is_empty() {
            stack.push(0, 0.0);
        }
        while let Some((index, _)) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !meets(&node.bounds) {
                continue;
            }
            if node.count == 0 {
                stack.push(node.first + 1, 0.0);
                stack.push(node.first, 0.0);
                continue;
            }
            for slot in node.slots() {
                if meets(&self.boxes[slot]) {
                    visit(self.primitives[slot]);
                }
            }
        }
    }

    /// Slots in the order of a traversal that enters the child with the smaller `bound` first.
    pub(crate) fn nearest_first<F: Fn(&UnitBox) -> f64>(&self, bound: F) -> Search<'_, F> {
        let mut stack = Stack::new();
        if let Some(root) = self.nodes.first() {
            stack.push(0, bound(&root.bounds));
        }
        Search {
            tree: self,
            bound,
            stack,
            leaf: 0..0,
        }
    }
}

/// A depth-first traversal under way; the limit shrinks as the caller finds better answers.
pub(crate) struct Search<'t, F> {
    tree: &'t BoxTree,
    bound: F,
    stack: Stack,
    leaf: Range<usize>,
}

impl<F: Fn(&UnitBox) -> f64> Search<'_, F> {
    /// The slot of the next primitive whose box is bounded by `limit`, if any.
    pub(crate) fn next(&mut self, limit: f64) -> Option<usize> {
        // An infinite bound is a miss also when the search is unlimited.
        let limit = limit.min(f64::MAX);
        loop {
            for slot in self.leaf.by_ref() {
                if (self.bound)(&self.tree.boxes[slot]) <= limit {
                    return Some(slot);
                }
            }
            let (index, bound) = self.stack.pop()?;
            if bound > limit {
                continue;
            }
            let nodes = &self.tree.nodes;
            let node = &nodes[index as usize];
            if node.count > 0 {
                self.leaf = node.slots();
                continue;
            }
            let (left, right) = (node.first, node.first + 1);
            let of_left = (self.bound)(&nodes[left as usize].bounds);
            let of_right = (self.bound)(&nodes[right as usize].bounds);
            let mut children = [(left, of_left), (right, of_right)];
            if of_left < of_right {
                children.swap(0, 1);
            }
            for (child, bound) in children {
                if bound <= limit {
                    self.stack.push(child, bound);
                }
            }
        }
    }
}

/// obvhs' tree with parents before children and slots in the order of the leaves; `None` if it is too deep or lacks a
/// primitive.
fn copied(built: &Bvh2, groups: &[Group], order: &[u32]) -> Option<(Vec<Node>, Vec<u32>)> {
    let mut nodes = Vec::with_capacity(built.nodes.len());
    let mut primitives = Vec::with_capacity(order.len());
    let mut waiting = vec![(0_usize, 0_usize, 0_usize)];
    nodes.push(Node::EMPTY);
    while let Some((from, to, depth)) = waiting.pop() {
        if depth > DEPTH_LIMIT {
            return None;
        }
        let node = built.nodes.get(from)?;
        let first = node.first_index as usize;
        if node.is_leaf() {
            // Leaves of the builder hold one group each.
            let group = groups.get(*built.primitive_indices.get(first)? as usize)?;
            nodes[to].count = index(group.count);
            nodes[to].first = index(primitives.len());
            primitives.extend_from_slice(order.get(group.start..group.start + group.count)?);
        } else {
            let children = nodes.len();
            nodes[to].first = index(children);
            nodes.extend([Node::EMPTY; 2]);
            waiting.push((first + 1, children + 1, depth + 1));
            waiting.push((first, children, depth + 1));
        }
    }
    (primitives.len() == order.len()).then_some((nodes, primitives))
}

/// A tree by median splits along the longest side: depth ⌈log₂ n⌉ whatever the boxes.
fn balanced(boxes: &[UnitBox]) -> (Vec<Node>, Vec<u32>) {
    let mut primitives: Vec<u32> = (0..).take(boxes.len()).collect();
    let mut nodes = vec![Node::EMPTY];
    let mut waiting = vec![(0..boxes.len(), 0_usize)];
    while let Some((range, to)) = waiting.pop() {
        if range.len() <= BALANCED_LEAF {
            nodes[to].first = index(range.start);
            nodes[to].count = index(range.len());
            continue;
        }
        let owned = &mut primitives[range.clone()];
        let around = owned
            .iter()
            .fold(UnitBox::EMPTY, |all, &one| all.union(&boxes[one as usize]));
        let (min, max) = around.corners();
        let axis = (max - min).max_position();
        let key = |one: &u32| {
            let unit = &boxes[*one as usize];
            f64::from(unit.min[axis]) + f64::from(unit.max[axis])
        };
        let half = owned.len() / 2;
        owned.select_nth_unstable_by(half, |a, b| key(a).total_cmp(&key(b)).then(a.cmp(b)));
        let children = nodes.len();
        nodes[to].first = index(children);
        nodes.extend([Node::EMPTY; 2]);
        let middle = range.start + half;
        waiting.push((middle..range.end, children + 1));
        waiting.push((range.start..middle, children));
    }
    (nodes, primitives)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "primitives are numbered by u32, and there are at most twice as many nodes"
)]
fn index(of: usize) -> u32 {
    of as u32
}

#[cfg(test)]
mod tests {
    use super::{BoxTree, DEPTH_LIMIT, balanced};
    use glam::DVec3;
    use pliant_mesh::Aabb;

    /// Boxes in geometric progression: pairing neighbours chains them up.
    fn progression(count: i32) -> Vec<Aabb> {
        (0..count)
            .map(|k| {
                let corner = DVec3::splat(1.0) * 2.0_f64.powi(-k);
                Aabb {
                    min: corner,
                    max: corner * 1.01,
                }
            })
            .collect()
    }

    fn over(boxes: &[Aabb]) -> BoxTree {
        let bounds = boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(one));
        BoxTree::new(&bounds, boxes.iter().copied())
    }

    fn depth(tree: &BoxTree) -> usize {
        let mut deepest = 0;
        let mut waiting = vec![(0, 0)];
        while let Some((index, depth)) = waiting.pop() {
            deepest = deepest.max(depth);
            let node = &tree.nodes[index];
            if node.count == 0 {
                waiting.push((node.first as usize, depth + 1));
                waiting.push((node.first as usize + 1, depth + 1));
            }
        }
        deepest
    }

    #[test]
    fn no_tree_is_deeper_than_the_stack() {
        for count in [1, 2, 3, 10, 100, 400, 900] {
            let boxes = progression(count);
            let tree = over(&boxes);
            assert!(depth(&tree) <= DEPTH_LIMIT, "{count}: {}", depth(&tree));
            let mut found = Vec::new();
            tree.overlapping(
                &Aabb::from_points(&[DVec3::ZERO, DVec3::ONE * 2.0]),
                |one| {
                    found.push(one);
                },
            );
            found.sort_unstable();
            assert!(found.iter().copied().eq(0..u32::try_from(count).unwrap()));
        }
    }

    #[test]
    fn balanced_trees_hold_every_box_once() {
        let boxes = progression(1000);
        let reference = over(&boxes);
        let units: Vec<_> = boxes.iter().map(|b| reference.frame.enclose(b)).collect();
        let (nodes, mut primitives) = balanced(&units);
        let leaves: u32 = nodes.iter().map(|node| node.count).sum();
        assert_eq!(leaves, 1000);
        primitives.sort_unstable();
        assert!(primitives.into_iter().eq(0..1000));
    }
}
