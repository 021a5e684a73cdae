//! The hierarchy over whole objects: which of them a box, a ray or each other may touch.

use glam::DVec3;
use pliant_mesh::Aabb;

use super::ray::UnitRay;
use super::tree::BoxTree;

/// A hierarchy over the bounding boxes of numbered objects, all in one frame [m]. Boxes apart by less than 1e-6 of the
/// size of the whole may be reported as meeting; none that meet, touching included, are missed. Unbounded boxes are
/// allowed; an empty one ([`Aabb::EMPTY`]) is never reported.
pub struct ObjectBvh {
    tree: BoxTree,
    count: usize,
}

impl ObjectBvh {
    /// Builds the tree; object `i` is the one of `boxes[i]` [m].
    pub fn new(boxes: &[Aabb]) -> Self {
        Self {
            tree: BoxTree::new(&bounds_of(boxes), boxes.iter().copied()),
            count: boxes.len(),
        }
    }

    /// Takes the present boxes [m] of the same objects, in the same order, and keeps the tree's shape: cheap, but after
    /// large motions a new tree answers faster. Allocates nothing.
    ///
    /// # Panics
    /// When the number of boxes is not that of the objects.
    pub fn refit(&mut self, boxes: &[Aabb]) {
        assert_eq!(boxes.len(), self.count, "one box per object");
        self.tree
            .refit(&bounds_of(boxes), |object| boxes[object as usize]);
    }

    /// Calls `visit` with every object whose box meets `bounds` [m]. Allocates nothing.
    pub fn overlapping(&self, bounds: &Aabb, visit: impl FnMut(u32)) {
        self.tree.overlapping(bounds, visit);
    }

    /// Calls `visit` with the objects whose boxes a ray may meet, roughly nearest first. `visit` gets the object and the
    /// reach so far [m], at first `max_distance`, and answers with the reach that remains: its hit's distance, or the
    /// same reach on a miss. `direction_unit` has unit length. Allocates nothing.
    pub fn along_ray(
        &self,
        origin: DVec3,
        direction_unit: DVec3,
        max_distance: f64,
        mut visit: impl FnMut(u32, f64) -> f64,
    ) {
        let frame = &self.tree.frame;
        let ray = UnitRay::new(frame.point(origin), direction_unit);
        let mut reach = max_distance;
        let mut search = self.tree.nearest_first(|bounds| ray.entry(bounds));
        while let Some(slot) = search.next(reach * frame.per_metre + ray.slack) {
            reach = visit(self.tree.primitives[slot], reach).min(reach);
        }
    }

    /// Calls `visit` once with every pair of objects whose boxes meet, the smaller number first. `boxes` [m] are those
    /// of the last build or refit. Allocates nothing.
    pub fn pairs(&self, boxes: &[Aabb], mut visit: impl FnMut(u32, u32)) {
        for (object, bounds) in (0..).zip(boxes) {
            self.tree.overlapping(bounds, |other| {
                if other > object {
                    visit(object, other);
                }
            });
        }
    }
}

/// Box around all bounded ones.
fn bounds_of(boxes: &[Aabb]) -> Aabb {
    boxes
        .iter()
        .filter(|one| one.min.is_finite() && one.max.is_finite())
        .fold(Aabb::EMPTY, |all, one| all.union(one))
}
