//! The growing polytope of EPA: triangles with neighbours in buffers of fixed size.

use glam::DVec3;

use crate::simplex::Simplex;
use crate::support::DifferencePoint;

/// What became of an attempt to add a vertex.
pub(crate) enum Growth {
    /// The vertex is in.
    Grown,
    /// A buffer is full; nothing changed.
    NoRoom,
    /// Rounding has made the horizon something else than a loop; nothing changed.
    Torn,
}

/// Lifecycle of a slot of the face buffer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Status {
    Free,
    Open,
    /// Part of the boundary, but never to be grown again.
    Closed,
}

#[derive(Clone, Copy)]
struct Face {
    normal: DVec3,
    /// Signed distance of the face's plane from the origin [m].
    height: f64,
    corners: [u16; 3],
    /// `across[k]`: the face behind the edge from corner k to corner k + 1.
    across: [u16; 3],
    status: Status,
    visible: bool,
}

impl Face {
    const FREE: Self = Self {
        normal: DVec3::ZERO,
        height: 0.0,
        corners: [0; 3],
        across: [0; 3],
        status: Status::Free,
        visible: false,
    };
}

/// An edge between what the new vertex sees and what it does not.
#[derive(Clone, Copy)]
struct HorizonEdge {
    from: u16,
    to: u16,
    /// The face beyond, which stays, and the number of this edge in it.
    beyond: u16,
    edge_of_beyond: u16,
}

impl HorizonEdge {
    const NONE: Self = Self {
        from: 0,
        to: 0,
        beyond: 0,
        edge_of_beyond: 0,
    };
}

const NONE: u16 = u16::MAX;

/// A closed surface of triangles wound outward.
pub(crate) struct Polytope<const VERTICES: usize, const FACES: usize> {
    vertices: [DifferencePoint; VERTICES],
    vertex_count: u16,
    faces: [Face; FACES],
    /// Slots in use or freed; beyond it all are untouched.
    face_end: u16,
    face_count: u16,
}

impl<const VERTICES: usize, const FACES: usize> Polytope<VERTICES, FACES> {
    pub(crate) fn new(tetrahedron: &[DifferencePoint; 4]) -> Self {
        let mut polytope = Self {
            vertices: [DifferencePoint::ZERO; VERTICES],
            vertex_count: 4,
            faces: [Face::FREE; FACES],
            face_end: 4,
            face_count: 4,
        };
        let mut corners = *tetrahedron;
        let [p, q, r, s] = tetrahedron.map(|vertex| vertex.point);
        if (q - p).cross(r - p).dot(s - p) > 0.0 {
            corners.swap(1, 2);
        }
        polytope.vertices[..4].copy_from_slice(&corners);
        polytope.set_face(0, [0, 1, 2], [3, 2, 1]);
        polytope.set_face(1, [0, 2, 3], [0, 2, 3]);
        polytope.set_face(2, [2, 1, 3], [0, 3, 1]);
        polytope.set_face(3, [1, 0, 3], [0, 1, 2]);
        polytope
    }

    /// The open face with the smallest signed height.
    pub(crate) fn lowest_open_face(&self) -> Option<u16> {
        let mut lowest = None;
        let mut height = f64::INFINITY;
        for index in 0..self.face_end {
            let face = &self.faces[usize::from(index)];
            if face.status == Status::Open && face.height < height {
                height = face.height;
                lowest = Some(index);
            }
        }
        lowest
    }

    /// Outward unit normal and signed height of a face.
    pub(crate) fn plane(&self, face: u16) -> (DVec3, f64) {
        let face = &self.faces[usize::from(face)];
        (face.normal, face.height)
    }

    pub(crate) fn corner(&self, face: u16) -> DifferencePoint {
        self.vertices[usize::from(self.faces[usize::from(face)].corners[0])]
    }

    pub(crate) fn contains_vertex(&self, vertex: &DifferencePoint) -> bool {
        self.vertices[..usize::from(self.vertex_count)]
            .iter()
            .any(|own| own.same_vertices(vertex))
    }

    /// Takes a face out of the search; it stays part of the surface.
    pub(crate) fn close(&mut self, face: u16) {
        self.faces[usize::from(face)].status = Status::Closed;
    }

    /// Of the faces not higher than `limit`, the feature whose point nearest to the origin is nearest to `exit`: where the
    /// way out meets the surface, also when coplanar triangles or opposite sides are equally near.
    pub(crate) fn feature_at(&self, exit: DVec3, limit: f64) -> Simplex {
        let mut best = (f64::INFINITY, Simplex::EMPTY);
        for face in &self.faces[..usize::from(self.face_end)] {
            if face.status == Status::Free || face.height > limit {
                continue;
            }
            let corners = face
                .corners
                .map(|corner| self.vertices[usize::from(corner)]);
            let mut simplex = Simplex::triangle(corners, [0.0; 3]);
            if let Some(nearest) = simplex.reduce() {
                let miss = (nearest.normal * nearest.distance).distance(exit);
                if miss < best.0 {
                    best = (miss, simplex);
                }
            }
        }
        if best.1.vertices().is_empty() {
            best.1.push(self.vertices[0]);
            best.1.reduce();
        }
        best.1
    }

    /// Replaces all faces that `vertex` sees by the cone from it to their horizon. A face is seen from more than
    /// `tolerance` [m] above its plane; `seen` always is.
    pub(crate) fn grow(&mut self, seen: u16, vertex: DifferencePoint, tolerance: f64) -> Growth {
        let mut horizon = [HorizonEdge::NONE; FACES];
        let mut visible = [0_u16; FACES];
        let (edges, removed) =
            self.flood(seen, vertex.point, tolerance, &mut visible, &mut horizon);
        let horizon = &horizon[..edges];
        let visible = &visible[..removed];
        let full = usize::from(self.vertex_count) >= VERTICES
            || usize::from(self.face_count) - removed + edges > FACES;
        let mut leaving = [NONE; VERTICES];
        if full || !is_union_of_loops(horizon, &mut leaving) {
            for &face in visible {
                self.faces[usize::from(face)].visible = false;
            }
            return if full { Growth::NoRoom } else { Growth::Torn };
        }
        for &face in visible {
            self.faces[usize::from(face)] = Face::FREE;
        }
        let apex = self.vertex_count;
        self.vertices[usize::from(apex)] = vertex;
        self.vertex_count += 1;
        self.face_count = self.face_count + narrow(edges) - narrow(removed);
        self.raise_cone(apex, horizon, visible, &mut leaving);
        Growth::Grown
    }

    /// Marks what `point` sees, starting at `seen`; returns the numbers of horizon edges and of visible faces.
    fn flood(
        &mut self,
        seen: u16,
        point: DVec3,
        tolerance: f64,
        visible: &mut [u16; FACES],
        horizon: &mut [HorizonEdge; FACES],
    ) -> (usize, usize) {
        visible[0] = seen;
        self.faces[usize::from(seen)].visible = true;
        let (mut edges, mut removed, mut next) = (0, 1, 0);
        while next < removed {
            let index = visible[next];
            let face = self.faces[usize::from(index)];
            next += 1;
            for k in 0..3 {
                let beyond = &mut self.faces[usize::from(face.across[k])];
                if beyond.visible {
                    continue;
                }
                if beyond.normal.dot(point) - beyond.height > tolerance {
                    beyond.visible = true;
                    visible[removed] = face.across[k];
                    removed += 1;
                }
            }
        }
        for &index in &visible[..removed] {
            let face = self.faces[usize::from(index)];
            for k in 0..3 {
                let beyond = self.faces[usize::from(face.across[k])];
                if beyond.visible || edges == FACES {
                    continue;
                }
                let to = face.corners[(k + 1) % 3];
                let edge_of_beyond = beyond.corners.iter().position(|&corner| corner == to);
                horizon[edges] = HorizonEdge {
                    from: face.corners[k],
                    to,
                    beyond: face.across[k],
                    edge_of_beyond: edge_of_beyond.map_or(0, narrow),
                };
                edges += 1;
            }
        }
        (edges, removed)
    }

    /// One new face per horizon edge, in the slots that became free first.
    fn raise_cone(
        &mut self,
        apex: u16,
        horizon: &[HorizonEdge],
        freed: &[u16],
        leaving: &mut [u16; VERTICES],
    ) {
        let mut slots = [NONE; FACES];
        for (number, edge) in horizon.iter().enumerate() {
            let slot = if number < freed.len() {
                freed[number]
            } else {
                self.untouched_slot()
            };
            slots[number] = slot;
            leaving[usize::from(edge.from)] = slot;
        }
        let mut arriving = [NONE; VERTICES];
        for (number, edge) in horizon.iter().enumerate() {
            arriving[usize::from(edge.to)] = slots[number];
        }
        for (number, edge) in horizon.iter().enumerate() {
            let following = leaving[usize::from(edge.to)];
            let preceding = arriving[usize::from(edge.from)];
            self.faces[usize::from(edge.beyond)].across[usize::from(edge.edge_of_beyond)] =
                slots[number];
            self.set_face(
                slots[number],
                [edge.from, edge.to, apex],
                [edge.beyond, following, preceding],
            );
        }
    }

    /// A free slot of the face buffer; the caller has counted them.
    fn untouched_slot(&mut self) -> u16 {
        let end = usize::from(self.face_end);
        if end < FACES {
            self.face_end += 1;
            // Claimed at once, so that the next call sees it taken.
            self.faces[end].status = Status::Closed;
            return narrow(end);
        }
        let free = self
            .faces
            .iter()
            .position(|face| face.status == Status::Free)
            .unwrap_or(0);
        self.faces[free].status = Status::Closed;
        narrow(free)
    }

    fn set_face(&mut self, slot: u16, corners: [u16; 3], across: [u16; 3]) {
        let [p, q, r] = corners.map(|corner| self.vertices[usize::from(corner)].point);
        let cross = (q - p).cross(r - p);
        let length = cross.length();
        // A face without area belongs to the surface but has no plane to grow along.
        let (normal, height, status) = if length > 0.0 {
            let normal = cross / length;
            (normal, normal.dot(p), Status::Open)
        } else {
            (DVec3::ZERO, f64::INFINITY, Status::Closed)
        };
        self.faces[usize::from(slot)] = Face {
            normal,
            height,
            corners,
            across,
            status,
            visible: false,
        };
    }
}

/// Every vertex on the horizon is left by exactly one edge. `leaving` is scratch and comes back marked.
fn is_union_of_loops<const VERTICES: usize>(
    horizon: &[HorizonEdge],
    leaving: &mut [u16; VERTICES],
) -> bool {
    for edge in horizon {
        let slot = &mut leaving[usize::from(edge.from)];
        if *slot != NONE {
            return false;
        }
        *slot = 0;
    }
    horizon.len() >= 3
        && horizon
            .iter()
            .all(|edge| leaving[usize::from(edge.to)] != NONE)
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "buffers hold at most 2048 faces"
)]
fn narrow(number: usize) -> u16 {
    number as u16
}
