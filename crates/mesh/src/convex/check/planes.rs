//! The highest vertex over any face plane (mesh.10), by branch and bound over pairs of groups: neighbouring faces against
//! neighbouring vertices (A. G. Gray and A. W. Moore, "'N-body' problems in statistical learning", NIPS 13, 2001).
//!
//! One tree over the vertices serves both sides, since a face belongs to its first corner. On a convex surface only faces
//! and vertices close to each other are ever compared one by one, so the time grows with the number of faces.

use glam::DVec3;

use crate::{Aabb, FaceId, HalfEdgeMesh};

/// Vertices per leaf; below this a bound costs more than it saves.
const LEAF: usize = 8;

/// A vertex above a face plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Excess {
    /// Height over the plane [m].
    pub(super) height: f64,
    pub(super) face: FaceId,
    pub(super) vertex: u32,
}

/// A vertex relative to the middle of the mesh.
#[derive(Clone, Copy)]
struct Point {
    position: DVec3,
    vertex: u32,
}

/// The plane of a face: `normal · p = offset`, relative to the middle of the mesh.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
    face: FaceId,
}

/// Vertices `points.start..points.end` and the faces they own.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Box around the vertices.
    center: DVec3,
    half: DVec3,
    /// No vertex is farther from the centre.
    radius: f64,
    /// Unit vector, mean of the normals, and a bound of `outward · (p − center)`: the box is not flat where the surface is.
    outward: DVec3,
    top: f64,
    /// Box around the normals.
    normal: DVec3,
    spread: DVec3,
    /// Lower bound of `normal · (a − center)` for a point a of each plane; infinite without faces.
    lowest: f64,
    start: usize,
    end: usize,
    /// The second child, the first being the next node; 0 for leaves.
    second: usize,
}

/// Vertices, and the planes of thick faces, in nested groups.
pub(super) struct Tree {
    /// Middle of the mesh, where the groups have their origin.
    middle: DVec3,
    nodes: Vec<Node>,
    points: Vec<Point>,
    planes: Vec<Plane>,
    /// Per point: where its planes begin; one more at the end.
    first_plane: Vec<usize>,
}

impl Tree {
    /// With the planes of the faces for which `thick` holds.
    pub(super) fn new(topology: &HalfEdgeMesh, thick: &[bool]) -> Self {
        let middle = topology.bounds().center();
        let of = |(vertex, &p): (u32, &DVec3)| Point {
            position: p - middle,
            vertex,
        };
        let mut tree = Self {
            middle,
            nodes: Vec::new(),
            points: (0..).zip(topology.positions()).map(of).collect(),
            planes: Vec::new(),
            first_plane: Vec::new(),
        };
        tree.split(0, tree.points.len());
        tree.own_planes(topology, thick, middle);
        // Children come after their parents.
        for index in (0..tree.nodes.len()).rev() {
            tree.face_outward(index);
        }
        tree
    }

    /// Halves the points along the longest side of their box, down to leaves.
    fn split(&mut self, start: usize, end: usize) {
        let points = &mut self.points[start..end];
        let bounds = points
            .iter()
            .fold(Aabb::EMPTY, |bounds, p| bounds.including(p.position));
        let index = self.nodes.len();
        self.nodes.push(Node {
            center: bounds.center(),
            half: 0.5 * bounds.size(),
            radius: 0.5 * bounds.diagonal(),
            outward: DVec3::ZERO,
            top: 0.0,
            normal: DVec3::ZERO,
            spread: DVec3::ZERO,
            lowest: f64::INFINITY,
            start,
            end,
            second: 0,
        });
        if points.len() <= LEAF {
            return;
        }
        let axis = bounds.size().max_position();
        let middle = points.len() / 2;
        points.select_nth_unstable_by(middle, |p, q| {
            let along = p.position[axis].total_cmp(&q.position[axis]);
            along.then(p.vertex.cmp(&q.vertex))
        });
        self.split(start, start + middle);
        self.nodes[index].second = self.nodes.len();
        self.split(start + middle, end);
    }

    /// Lists the planes of thick faces by the place of their first corner among the points.
    fn own_planes(&mut self, topology: &HalfEdgeMesh, thick: &[bool], middle: DVec3) {
        let mut place = vec![0_u32; self.points.len()];
        for (slot, point) in (0..).zip(&self.points) {
            place[point.vertex as usize] = slot;
        }
        let owners = || {
            let faces = super::faces_of(topology).filter(|f| thick[f.index()]);
            faces.map(|face| {
                let corner = topology.face_vertices(face)[0];
                (face, corner, place[corner.index()] as usize)
            })
        };
        self.first_plane = vec![0; self.points.len() + 1];
        for (.., owner) in owners() {
            self.first_plane[owner + 1] += 1;
        }
        for slot in 0..self.points.len() {
            self.first_plane[slot + 1] += self.first_plane[slot];
        }
        let mut next = self.first_plane.clone();
        let nothing = Plane {
            normal: DVec3::ZERO,
            offset: 0.0,
            face: FaceId(0),
        };
        self.planes = vec![nothing; self.first_plane[self.points.len()]];
        for (face, corner, owner) in owners() {
            let normal = topology.face_normal(face);
            self.planes[next[owner]] = Plane {
                normal,
                offset: normal.dot(topology.position(corner) - middle),
                face,
            };
            next[owner] += 1;
        }
    }

    fn planes_of(&self, node: &Node) -> &[Plane] {
        &self.planes[self.first_plane[node.start]..self.first_plane[node.end]]
    }

    /// Fills in what bounds the planes of a node, and its flat bound; its children have theirs.
    fn face_outward(&mut self, index: usize) {
        let mut node = self.nodes[index];
        let children = [index + 1, node.second].map(|child| self.nodes.get(child).copied());
        let is_leaf = node.second == 0;
        let normals = if is_leaf {
            self.planes_of(&node)
                .iter()
                .fold(Aabb::EMPTY, |bounds, plane| bounds.including(plane.normal))
        } else {
            let faced = children.iter().flatten().filter(|c| c.lowest.is_finite());
            faced.fold(Aabb::EMPTY, |bounds, child| {
                let (min, max) = (child.normal - child.spread, child.normal + child.spread);
                bounds.including(min).including(max)
            })
        };
        if normals.min.cmple(normals.max).all() {
            node.normal = normals.center();
            node.spread = 0.5 * normals.size();
            node.outward = node.normal.normalize_or_zero();
        }
        if is_leaf {
            let height = |plane: &Plane| plane.offset - plane.normal.dot(node.center);
            let heights = self.planes_of(&node).iter().map(height);
            node.lowest = heights.fold(f64::INFINITY, f64::min);
            let tops = self.points[node.start..node.end]
                .iter()
                .map(|p| node.outward.dot(p.position - node.center));
            node.top = tops.fold(f64::NEG_INFINITY, f64::max);
        } else {
            node.top = f64::NEG_INFINITY;
            for child in children.into_iter().flatten() {
                let step = child.center - node.center;
                let lowest = child.normal.dot(step) - child.spread.dot(step.abs()) + child.lowest;
                node.lowest = node.lowest.min(lowest);
                let top = node.outward.dot(step) + child.reach(node.outward);
                node.top = node.top.max(top);
            }
        }
        self.nodes[index] = node;
    }

    /// The vertex highest above the plane of a thick face, if it is higher than `tolerance` [m].
    pub(super) fn highest(&self, tolerance: f64) -> Option<Excess> {
        let mut limit = tolerance;
        let mut worst = None;
        let mut stack = vec![(0, 0)];
        while let Some((faces, vertices)) = stack.pop() {
            let (owner, group) = (&self.nodes[faces], &self.nodes[vertices]);
            if owner.is_above(group, limit) {
                continue;
            }
            // The larger of the two is divided, both if they are alike.
            let ratio = owner.radius / group.radius;
            let divide_faces = owner.second != 0 && (group.second == 0 || ratio > 0.7);
            let divide_vertices = group.second != 0 && (owner.second == 0 || ratio < 1.4);
            if divide_faces && divide_vertices {
                stack.extend([(owner.second, group.second), (owner.second, vertices + 1)]);
                stack.extend([(faces + 1, group.second), (faces + 1, vertices + 1)]);
            } else if divide_faces {
                stack.extend([(owner.second, vertices), (faces + 1, vertices)]);
            } else if divide_vertices {
                stack.extend([(faces, group.second), (faces, vertices + 1)]);
            } else if let Some(found) = self.compare(owner, group, limit) {
                limit = found.height;
                worst = Some(found);
            }
        }
        worst
    }

    /// A vertex that none exceeds along `direction`, a unit vector, by more than `slack` [m], and its height [m] from the
    /// origin.
    pub(super) fn farthest(&self, direction: DVec3, slack: f64) -> (u32, f64) {
        let bound = |index: usize| {
            let node = &self.nodes[index];
            direction.dot(node.center) + node.reach(direction)
        };
        let mut best = (0, f64::NEG_INFINITY);
        let mut stack = vec![(0, bound(0))];
        while let Some((index, top)) = stack.pop() {
            if top <= best.1 + slack {
                continue;
            }
            let node = &self.nodes[index];
            if node.second == 0 {
                for point in &self.points[node.start..node.end] {
                    let height = direction.dot(point.position);
                    if height > best.1 {
                        best = (point.vertex, height);
                    }
                }
                continue;
            }
            // The more promising child is looked at first.
            let mut children = [index + 1, node.second].map(|child| (child, bound(child)));
            children.sort_by(|p, q| p.1.total_cmp(&q.1));
            stack.extend(children);
        }
        (best.0, best.1 + direction.dot(self.middle))
    }

    /// Every plane of one leaf against every vertex of another.
    fn compare(&self, owner: &Node, group: &Node, tolerance: f64) -> Option<Excess> {
        let mut limit = tolerance;
        let mut worst = None;
        for plane in self.planes_of(owner) {
            let to_center = plane.normal.dot(group.center) - plane.offset;
            if to_center + plane.normal.abs().dot(group.half) <= limit {
                continue;
            }
            for point in &self.points[group.start..group.end] {
                let height = plane.normal.dot(point.position) - plane.offset;
                if height > limit {
                    limit = height;
                    worst = Some(Excess {
                        height,
                        face: plane.face,
                        vertex: point.vertex,
                    });
                }
            }
        }
        worst
    }
}

impl Node {
    /// Bound of `direction · (p − center)` for the node's vertices: that of the box or of the ball cut flat, whichever is
    /// lower.
    fn reach(&self, direction: DVec3) -> f64 {
        direction
            .abs()
            .dot(self.half)
            .min(self.reach_flat(direction))
    }

    /// The bound by what is known along `outward`; infinite for directions that point inwards.
    fn reach_flat(&self, direction: DVec3) -> f64 {
        let along = direction.dot(self.outward);
        if along < 0.0 {
            return f64::INFINITY;
        }
        let aside = direction - along * self.outward;
        along * self.top + aside.length() * self.radius
    }

    /// Whether no vertex of `group` is higher than `limit` over a plane of this node (mesh.10).
    fn is_above(&self, group: &Self, limit: f64) -> bool {
        let step = group.center - self.center;
        let tilted = self.spread.dot(step.abs() + group.half);
        let allowed = limit + self.lowest - self.normal.dot(step) - tilted;
        self.normal.abs().dot(group.half) <= allowed || group.reach_flat(self.normal) <= allowed
    }
}

#[cfg(test)]
mod tests;
