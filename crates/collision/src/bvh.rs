//! Bounding volume hierarchy over the triangles of a mesh: box, ray and closest-point queries.
//!
//! The tree is obvhs' binary one (PLOC with reinsertion, Meister & Bittner 2018 and 2022), no triangle split. Its boxes are
//! `f32` in a frame centred on the mesh and scaled to unit size, rounded outward; every mapping from metres to that frame
//! is monotone, so nothing is missed. Rays and closest points are solved in `f64` on the mesh's own corners.

use std::time::Duration;

use glam::{DVec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::{Boundable, BvhBuildParams};
use pliant_mesh::{Aabb, TriangleMesh};

use crate::cast::RayHit;

mod stack;
mod triangle;

use stack::Stack;

/// Slack of comparisons in the unit frame, relative to the largest coordinate: a hundred units in the last place of
/// `f64`, far below the `f32` rounding of the boxes.
const SLACK: f64 = 2e-14;

/// A hierarchy over one [`TriangleMesh`]; queries that need corners take the same mesh again.
pub struct TriangleBvh {
    tree: Bvh2,
    /// Box of each triangle in the order of the tree's leaves.
    boxes: Vec<UnitBox>,
    frame: UnitFrame,
}

/// A point of a mesh's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Triangle that holds it.
    pub triangle: u32,
    /// Its position, in the mesh's frame [m].
    pub point: DVec3,
    /// Distance to the query point [m].
    pub distance: f64,
}

/// A box in the unit frame.
#[derive(Clone, Copy)]
struct UnitBox {
    min: [f32; 3],
    max: [f32; 3],
}

/// Monotone map from the mesh's frame to one in which the mesh has size about one.
struct UnitFrame {
    centre: DVec3,
    per_metre: f64,
}

/// A ray in the unit frame.
struct UnitRay {
    origin: DVec3,
    direction: DVec3,
    slack: f64,
}

impl Boundable for UnitBox {
    fn aabb(&self) -> obvhs::aabb::Aabb {
        obvhs::aabb::Aabb {
            min: Vec3A::from_array(self.min),
            max: Vec3A::from_array(self.max),
        }
    }
}

impl TriangleBvh {
    /// Builds the tree: about 3 ms for 10⁴ triangles, 0.5 s for 10⁶.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let bounds = mesh.bounds();
        let half = 0.5 * bounds.size().max_element();
        let frame = UnitFrame {
            centre: bounds.center(),
            per_metre: if half.is_normal() { 1.0 / half } else { 1.0 },
        };
        let in_order: Vec<UnitBox> = mesh
            .triangles()
            .iter()
            .map(|corners| {
                let corners = corners.map(|corner| mesh.positions()[corner as usize]);
                frame.enclose(&Aabb::from_points(&corners))
            })
            .collect();
        let mut elapsed = Duration::ZERO;
        let tree = build_bvh2(&in_order, BvhBuildParams::medium_build(), &mut elapsed);
        let boxes = tree
            .primitive_indices
            .iter()
            .map(|&triangle| in_order[triangle as usize])
            .collect();
        Self { tree, boxes, frame }
    }

    /// Calls `visit` with every triangle whose bounding box meets `bounds` (mesh's frame [m]). Boxes apart by less than
    /// 1e-7 of the mesh's size may be reported too; none that meet are missed. Allocates nothing.
    pub fn overlapping(&self, bounds: &Aabb, mut visit: impl FnMut(u32)) {
        let wanted = (self.frame.point(bounds.min), self.frame.point(bounds.max));
        let meets =
            |node: (DVec3, DVec3)| node.0.cmple(wanted.1).all() && wanted.0.cmple(node.1).all();
        let mut stack = Stack::new();
        stack.push(0, 0.0);
        while let Some((index, _)) = stack.pop() {
            let Some(node) = self.tree.nodes.get(index as usize) else {
                continue;
            };
            if !meets(corners_of(node)) {
                continue;
            }
            if node.prim_count == 0 {
                stack.push(node.first_index + 1, 0.0);
                stack.push(node.first_index, 0.0);
                continue;
            }
            for slot in leaf(node) {
                if meets(self.boxes[slot].corners()) {
                    visit(self.tree.primitive_indices[slot]);
                }
            }
        }
    }

    /// First triangle a ray meets within `max_distance` [m], from either side, with the normal of its winding.
    /// `direction_unit` has unit length; all in the mesh's frame. Triangles without area are not hit. Allocates nothing.
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn cast_ray(
        &self,
        mesh: &TriangleMesh,
        origin: DVec3,
        direction_unit: DVec3,
        max_distance: f64,
    ) -> Option<(u32, RayHit)> {
        let ray = UnitRay::new(self.frame.point(origin), direction_unit);
        let mut best: Option<(u32, RayHit)> = None;
        let mut reach = max_distance;
        let mut search = self.nearest_first(|corners| ray.entry(corners));
        while let Some(slot) = search.next(reach * self.frame.per_metre + ray.slack) {
            let triangle = self.tree.primitive_indices[slot];
            let corners = mesh.corners(triangle);
            if let Some(hit) = triangle::cast_ray(&corners, origin, direction_unit)
                && hit.distance <= reach
            {
                reach = hit.distance;
                best = Some((triangle, hit));
            }
        }
        best
    }

    /// Point of the surface nearest to `point`, both in the mesh's frame [m], if one lies within `max_distance` [m]. A
    /// tight `max_distance`, such as the last answer plus the motion since, is what makes repeated queries fast.
    /// Allocates nothing.
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn closest_point(
        &self,
        mesh: &TriangleMesh,
        point: DVec3,
        max_distance: f64,
    ) -> Option<SurfacePoint> {
        let centre = self.frame.point(point);
        let slack = SLACK * (1.0 + centre.abs().max_element());
        let mut best: Option<SurfacePoint> = None;
        let mut reach = max_distance;
        let mut search =
            self.nearest_first(|(min, max)| (centre.clamp(min, max) - centre).length());
        while let Some(slot) = search.next(reach * self.frame.per_metre + slack) {
            let triangle = self.tree.primitive_indices[slot];
            let nearest = triangle::closest_point(&mesh.corners(triangle), point);
            let distance = nearest.distance(point);
            if distance <= reach {
                reach = distance;
                best = Some(SurfacePoint {
                    triangle,
                    point: nearest,
                    distance,
                });
            }
        }
        best
    }

    /// Triangles in the order of a traversal that enters the child with the smaller `bound` first.
    fn nearest_first<F: Fn((DVec3, DVec3)) -> f64>(&self, bound: F) -> Search<'_, F> {
        let mut stack = Stack::new();
        if let Some(root) = self.tree.nodes.first() {
            stack.push(0, bound(corners_of(root)));
        }
        Search {
            bvh: self,
            bound,
            stack,
            leaf: 0..0,
        }
    }
}

/// A depth-first traversal under way; the limit shrinks as the caller finds better answers.
struct Search<'b, F> {
    bvh: &'b TriangleBvh,
    bound: F,
    stack: Stack,
    leaf: std::ops::Range<usize>,
}

impl<F: Fn((DVec3, DVec3)) -> f64> Search<'_, F> {
    /// The slot of the next triangle whose box is bounded by `limit` (unit frame), if any.
    fn next(&mut self, limit: f64) -> Option<usize> {
        // An infinite bound is a miss also when the search is unlimited.
        let limit = limit.min(f64::MAX);
        loop {
            for slot in self.leaf.by_ref() {
                if (self.bound)(self.bvh.boxes[slot].corners()) <= limit {
                    return Some(slot);
                }
            }
            let (index, bound) = self.stack.pop()?;
            if bound > limit {
                continue;
            }
            let nodes = &self.bvh.tree.nodes;
            let node = &nodes[index as usize];
            if node.prim_count > 0 {
                self.leaf = leaf(node);
                continue;
            }
            let (left, right) = (node.first_index, node.first_index + 1);
            let of_left = (self.bound)(corners_of(&nodes[left as usize]));
            let of_right = (self.bound)(corners_of(&nodes[right as usize]));
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

impl UnitFrame {
    fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.per_metre
    }

    fn enclose(&self, bounds: &Aabb) -> UnitBox {
        UnitBox {
            min: self
                .point(bounds.min)
                .as_vec3()
                .to_array()
                .map(f32::next_down),
            max: self
                .point(bounds.max)
                .as_vec3()
                .to_array()
                .map(f32::next_up),
        }
    }
}

impl UnitBox {
    fn corners(&self) -> (DVec3, DVec3) {
        (
            DVec3::from_array(self.min.map(f64::from)),
            DVec3::from_array(self.max.map(f64::from)),
        )
    }
}

impl UnitRay {
    fn new(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            slack: SLACK * (1.0 + origin.abs().max_element()),
        }
    }

    /// Distance at which the ray enters a box, 0 from inside, infinite if it passes by.
    fn entry(&self, (min, max): (DVec3, DVec3)) -> f64 {
        let (mut entry, mut exit) = (0.0, f64::INFINITY);
        for axis in 0..3 {
            let low = min[axis] - self.origin[axis] - self.slack;
            let high = max[axis] - self.origin[axis] + self.slack;
            let slope = self.direction[axis];
            if slope == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return f64::INFINITY;
                }
                continue;
            }
            let (t0, t1) = (low / slope, high / slope);
            entry = f64::max(entry, t0.min(t1));
            exit = f64::min(exit, t0.max(t1));
        }
        if entry <= exit { entry } else { f64::INFINITY }
    }
}

fn corners_of(node: &Bvh2Node) -> (DVec3, DVec3) {
    let bounds = node.aabb();
    (bounds.min.as_dvec3(), bounds.max.as_dvec3())
}

/// Slots of a leaf's triangles.
fn leaf(node: &Bvh2Node) -> std::ops::Range<usize> {
    let first = node.first_index as usize;
    first..first + node.prim_count as usize
}
