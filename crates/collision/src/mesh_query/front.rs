//! The front: a cut through the tree below which nothing was within reach when last looked at, and the triangles above it.
//!
//! Each node of the cut and each triangle carries a *key*: a certified lower bound of its separation plus the distance the
//! shape had travelled when the bound was found. A separation changes by no more than the shape's points move, so what has
//! `key > travelled + limit` is further than `limit` without another look (a temporally coherent front as of Li & Chen
//! 1998, with certified distances in place of overlap flags). A query refines the rest: nodes down to triangles, triangles
//! by the direction that last kept them apart, then by the exact query from its last simplex.

use glam::DVec3;
use pliant_mesh::TriangleMesh;

use crate::bvh::TriangleBvh;
use crate::bvh::stack::Stack;
use crate::{ClosestPoints, SimplexCache, SupportMap};

use super::faces::Verdict;
use super::placed::Placed;

/// A front this many entries longer than twice its length when new is started afresh: it trails behind the shape.
const SURPLUS: usize = 256;

/// What is remembered of a triangle.
#[derive(Clone, Copy, Debug)]
struct Known {
    triangle: u32,
    /// The direction that last kept it apart, from the triangle to the shape; zero if none did.
    direction: DVec3,
    simplex: SimplexCache,
}

/// The cut and the triangles above it; keys apart from the rest, to be scanned quickly.
#[derive(Debug, Default)]
pub(super) struct Front {
    node_keys: Vec<f64>,
    nodes: Vec<u32>,
    triangle_keys: Vec<f64>,
    triangles: Vec<Known>,
    /// Where the last exact query ended: the start for a triangle met for the first time, as a rule a neighbour.
    simplex: SimplexCache,
    /// Sum of the motions since the front was new [m].
    travelled: f64,
    fresh_len: usize,
}

/// What a refinement needs to know; the same throughout a query.
pub(super) struct Scene<'q, S: ?Sized> {
    pub(super) bvh: &'q TriangleBvh,
    pub(super) mesh: &'q TriangleMesh,
    pub(super) placed: &'q Placed<'q, S>,
}

/// What a query does with the triangles it meets.
pub(super) trait Visitor {
    /// Triangles further than this [m] do not matter; may shrink.
    fn limit(&self) -> f64;

    /// A triangle with its exact answer, possibly beyond the limit.
    fn visit(&mut self, triangle: u32, closest: &ClosestPoints);
}

impl Front {
    /// Forgets everything; the buffers stay.
    pub(super) fn clear(&mut self) {
        self.node_keys.clear();
        self.nodes.clear();
        self.triangle_keys.clear();
        self.triangles.clear();
        self.simplex = SimplexCache::default();
        self.travelled = 0.0;
        self.fresh_len = 0;
    }

    fn len(&self) -> usize {
        self.nodes.len() + self.triangles.len()
    }

    /// How far the shape has moved since the front is there [m].
    pub(super) fn travelled(&self) -> f64 {
        self.travelled
    }

    /// The shape moved by at most `distance` [m].
    pub(super) fn advance(&mut self, distance: f64) {
        self.travelled += distance;
    }

    /// Shows `visitor` every triangle within its limit, and some beyond (collision.45).
    pub(super) fn refine<S: SupportMap + ?Sized>(
        &mut self,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        if self.len() > 2 * self.fresh_len + SURPLUS {
            self.clear();
        }
        if self.len() == 0 {
            self.start(scene, visitor);
            return;
        }
        // Triangles first: the near ones shrink the limit.
        for index in 0..self.triangles.len() {
            if self.triangle_keys[index] > self.travelled + visitor.limit() {
                continue;
            }
            self.look_at(index, scene, visitor);
        }
        let mut index = 0;
        while index < self.nodes.len() {
            if self.node_keys[index] > self.travelled + visitor.limit() {
                index += 1;
                continue;
            }
            let node = self.nodes[index];
            let bound = scene
                .placed
                .bound_of_box(&scene.bvh.tree.nodes[node as usize].bounds);
            if bound > visitor.limit() {
                self.node_keys[index] = self.travelled + bound;
                index += 1;
                continue;
            }
            // The last entry takes its place, and is next.
            self.node_keys.swap_remove(index);
            self.nodes.swap_remove(index);
            self.open(node, bound, scene, visitor);
        }
    }

    fn start<S: SupportMap + ?Sized>(&mut self, scene: &Scene<'_, S>, visitor: &mut impl Visitor) {
        let Some(root) = scene.bvh.tree.nodes.first() else {
            return;
        };
        let bound = scene.placed.bound_of_box(&root.bounds);
        self.open(0, bound, scene, visitor);
        self.fresh_len = self.len();
    }

    /// Replaces a node by the cut below it.
    fn open<S: SupportMap + ?Sized>(
        &mut self,
        node: u32,
        bound: f64,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        let tree = &scene.bvh.tree;
        let mut stack = Stack::new();
        stack.push(node, bound);
        while let Some((index, bound)) = stack.pop() {
            if bound > visitor.limit() {
                self.node_keys.push(self.travelled + bound);
                self.nodes.push(index);
                continue;
            }
            let node = &tree.nodes[index as usize];
            if node.count == 0 {
                let mut children = [node.first, node.first + 1].map(|child| {
                    let bounds = &tree.nodes[child as usize].bounds;
                    (child, scene.placed.bound_of_box(bounds))
                });
                if children[0].1 < children[1].1 {
                    children.swap(0, 1);
                }
                for (child, bound) in children {
                    stack.push(child, bound);
                }
                continue;
            }
            for slot in node.slots() {
                self.meet(slot, scene, visitor);
            }
        }
    }

    /// Takes in a triangle.
    fn meet<S: SupportMap + ?Sized>(
        &mut self,
        slot: usize,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        let tree = &scene.bvh.tree;
        let triangle = tree.primitives[slot];
        let bound = scene.placed.bound_of_box(&tree.boxes[slot]);
        self.triangle_keys.push(self.travelled + bound);
        self.triangles.push(Known {
            triangle,
            direction: DVec3::ZERO,
            simplex: self.simplex,
        });
        if bound > visitor.limit() {
            return;
        }
        self.look_at(self.triangles.len() - 1, scene, visitor);
    }

    /// A triangle whose bound has expired: a new bound along the last direction, else what the shape's faces say, else
    /// the exact query.
    fn look_at<S: SupportMap + ?Sized>(
        &mut self,
        index: usize,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        let known = &mut self.triangles[index];
        let corners = scene.mesh.corners(known.triangle);
        if known.direction != DVec3::ZERO {
            let bound = scene.placed.bound_along(&corners, known.direction);
            if bound > visitor.limit() {
                self.triangle_keys[index] = self.travelled + bound;
                return;
            }
        }
        match scene.placed.judge(&corners) {
            Verdict::Bound(bound, direction) if bound > visitor.limit() => {
                self.triangle_keys[index] = self.travelled + bound;
                known.direction = direction;
            }
            Verdict::Bound(..) => self.solve(index, scene, visitor),
            Verdict::Exact(closest) => self.note(index, &closest, scene, visitor),
        }
    }

    fn solve<S: SupportMap + ?Sized>(
        &mut self,
        index: usize,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        let known = &mut self.triangles[index];
        let corners = scene.mesh.corners(known.triangle);
        let closest = scene.placed.closest_points(&corners, &mut known.simplex);
        self.simplex = known.simplex;
        self.note(index, &closest, scene, visitor);
    }

    /// An exact answer.
    fn note<S: SupportMap + ?Sized>(
        &mut self,
        index: usize,
        closest: &ClosestPoints,
        scene: &Scene<'_, S>,
        visitor: &mut impl Visitor,
    ) {
        let known = &mut self.triangles[index];
        // Along the normal of a hit there is no room: another look at it next time would be in vain.
        known.direction = if closest.separation > visitor.limit() {
            closest.normal
        } else {
            DVec3::ZERO
        };
        self.triangle_keys[index] = self.travelled + closest.separation - scene.placed.slack;
        visitor.visit(known.triangle, closest);
    }
}
