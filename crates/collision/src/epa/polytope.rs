//! The growing polytope of EPA: triangles with neighbours in buffers of fixed size.

use glam::DVec3;

use crate::epa::nearest_to;
use crate::epa::surface::Surface;
use crate::simplex::{Simplex, cross_of};
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

/// Corners and neighbours of a face; `across[k]` is the face behind the edge from corner k to corner k + 1.
#[derive(Clone, Copy)]
struct Face {
    corners: [u16; 3],
    across: [u16; 3],
    live: bool,
    visible: bool,
}

/// An edge between what the new vertex sees and what it does not.
#[derive(Clone, Copy)]
struct HorizonEdge {
    from: u16,
    to: u16,
    /// The face beyond, which stays, and the number of this edge in it.
    beyond: u16,
    edge_of_beyond: u16,
    /// The face raised on the edge.
    slot: u16,
}

impl Face {
    const FREE: Self = Self {
        corners: [0; 3],
        across: [0; 3],
        live: false,
        visible: false,
    };
}

impl HorizonEdge {
    const NONE: Self = Self {
        from: 0,
        to: 0,
        beyond: 0,
        edge_of_beyond: 0,
        slot: 0,
    };
}

const NONE: u16 = u16::MAX;

/// A closed surface of triangles wound outward. What each step scans lies in arrays of its own.
pub(crate) struct Polytope<const VERTICES: usize, const FACES: usize> {
    vertices: [DifferencePoint; VERTICES],
    vertex_count: usize,
    faces: [Face; FACES],
    /// Outward normals, twice the faces' areas long: most faces go before their unit normal is asked for.
    normals: [DVec3; FACES],
    /// Their products with a point of the face [m³].
    volumes: [f64; FACES],
    /// Distances of the faces' planes from the origin, squared but with their sign [m²]; infinite without area.
    heights: [f64; FACES],
    /// The same of faces that may still grow; infinite for all others.
    open: [f64; FACES],
    /// Slots in use or freed; beyond it all are untouched.
    face_end: usize,
    face_count: usize,
    /// Scratch of [`Polytope::grow`].
    visible: [u16; FACES],
    horizon: [HorizonEdge; FACES],
    leaving: [u16; VERTICES],
}

impl<const VERTICES: usize, const FACES: usize> Polytope<VERTICES, FACES> {
    /// No faces yet; [`Polytope::start`] or [`Polytope::recall`] comes next. Filled in place: it is several KiB large.
    pub(crate) fn empty() -> Self {
        Self {
            vertices: [DifferencePoint::NONE; VERTICES],
            vertex_count: 0,
            faces: [Face::FREE; FACES],
            normals: [DVec3::ZERO; FACES],
            volumes: [0.0; FACES],
            heights: [f64::INFINITY; FACES],
            open: [f64::INFINITY; FACES],
            face_end: 0,
            face_count: 0,
            visible: [0; FACES],
            horizon: [HorizonEdge::NONE; FACES],
            leaving: [NONE; VERTICES],
        }
    }

    /// The surface of a tetrahedron with volume.
    pub(crate) fn start(&mut self, tetrahedron: &[DifferencePoint; 4]) {
        let mut corners = *tetrahedron;
        let [p, q, r, s] = tetrahedron.map(|vertex| vertex.point);
        if (q - p).cross(r - p).dot(s - p) > 0.0 {
            corners.swap(1, 2);
        }
        self.vertices[..4].copy_from_slice(&corners);
        self.vertex_count = 4;
        self.face_end = 4;
        self.face_count = 4;
        self.set_face(0, [0, 1, 2], [3, 2, 1]);
        self.set_face(1, [0, 2, 3], [0, 2, 3]);
        self.set_face(2, [2, 1, 3], [0, 3, 1]);
        self.set_face(3, [1, 0, 3], [0, 1, 2]);
    }

    /// A surface of an earlier placement, its vertices at the present one.
    pub(crate) fn recall(&mut self, surface: &Surface, vertices: &[DifferencePoint]) {
        self.vertices[..vertices.len()].copy_from_slice(vertices);
        self.vertex_count = vertices.len();
        self.face_count = surface.faces().len();
        self.face_end = self.face_count;
        for (slot, &(corners, across)) in surface.faces().iter().enumerate() {
            self.set_face(slot, corners.map(u16::from), across.map(u16::from));
        }
    }

    /// What a later query may start from; nothing where it is too large or the origin not below every face.
    pub(crate) fn remember(&self, surface: &mut Surface) {
        surface.clear();
        let mut number = [u8::MAX; VERTICES];
        let mut renamed = [u8::MAX; FACES];
        let mut count = 0;
        for (slot, name) in renamed[..self.face_end].iter_mut().enumerate() {
            if self.faces[slot].live {
                if !self.is_below(slot) || count == u8::MAX {
                    return;
                }
                *name = count;
                count += 1;
            }
        }
        for face in self.faces[..self.face_end].iter().filter(|face| face.live) {
            for corner in face.corners.map(usize::from) {
                if number[corner] == u8::MAX {
                    let vertex = &self.vertices[corner];
                    number[corner] = match surface.add_vertex([vertex.a, vertex.b]) {
                        Some(index) => index,
                        None => return,
                    };
                }
            }
            let corners = face.corners.map(|corner| number[usize::from(corner)]);
            let across = face.across.map(|beyond| renamed[usize::from(beyond)]);
            if !surface.add_face(corners, across) {
                return;
            }
        }
    }

    /// The open face with the smallest signed height.
    pub(crate) fn lowest_open_face(&self) -> Option<usize> {
        let mut lowest = 0;
        let mut height = f64::INFINITY;
        for (slot, &candidate) in self.open[..self.face_end].iter().enumerate() {
            if candidate < height {
                height = candidate;
                lowest = slot;
            }
        }
        (height < f64::INFINITY).then_some(lowest)
    }

    /// The faces lower than a height.
    pub(crate) fn faces_below(&self, height: f64) -> impl Iterator<Item = usize> {
        let limit = height * height.abs();
        (0..self.face_end).filter(move |&slot| self.faces[slot].live && self.heights[slot] < limit)
    }

    pub(crate) fn corners(&self, face: usize) -> [DifferencePoint; 3] {
        self.faces[face]
            .corners
            .map(|corner| self.vertices[usize::from(corner)])
    }

    /// Outward unit normal and signed height of a face.
    pub(crate) fn plane(&self, face: usize) -> (DVec3, f64) {
        let inverse = 1.0 / self.normals[face].length();
        (self.normals[face] * inverse, self.volumes[face] * inverse)
    }

    pub(crate) fn corner(&self, face: usize) -> DifferencePoint {
        self.vertices[usize::from(self.faces[face].corners[0])]
    }

    pub(crate) fn contains_vertex(&self, vertex: &DifferencePoint) -> bool {
        self.vertices[..self.vertex_count]
            .iter()
            .any(|own| own.same_vertices(vertex))
    }

    /// Takes a face out of the search; it stays part of the surface.
    pub(crate) fn close(&mut self, face: usize) {
        self.open[face] = f64::INFINITY;
    }

    pub(crate) fn vertices(&self) -> &[DifferencePoint] {
        &self.vertices[..self.vertex_count]
    }

    /// Whether every face has the origin strictly below its plane.
    pub(crate) fn encloses_origin(&self) -> bool {
        (0..self.face_end).all(|slot| !self.faces[slot].live || self.is_below(slot))
    }

    fn is_below(&self, slot: usize) -> bool {
        self.heights[slot] > 0.0 && self.heights[slot] < f64::INFINITY
    }

    /// Where the way out at `exit` meets the surface: among faces not higher than `limit`, or among all where none of those
    /// comes closer than `miss` [m] because rounding has put the right one above.
    pub(crate) fn feature_at(&self, exit: DVec3, limit: f64, miss: f64) -> Simplex {
        let below = |limit: f64| {
            let limit = limit * limit.abs();
            let faces = self.faces[..self.face_end].iter().zip(&self.heights);
            faces
                .filter(move |(face, height)| face.live && **height <= limit)
                .map(|(face, _)| {
                    face.corners
                        .map(|corner| self.vertices[usize::from(corner)])
                })
        };
        let (distance, simplex) = nearest_to(exit, below(limit));
        if distance <= miss {
            return simplex;
        }
        let (_, mut simplex) = nearest_to(exit, below(f64::INFINITY));
        if simplex.vertices().is_empty() {
            simplex.push(self.vertices[0]);
            simplex.reduce();
        }
        simplex
    }

    /// Replaces all faces that `vertex` sees by the cone from it to their horizon. A face is seen from more than
    /// `tolerance` [m] above its plane; `seen` always is.
    pub(crate) fn grow(&mut self, seen: usize, vertex: DifferencePoint, tolerance: f64) -> Growth {
        let removed = self.flood(seen, vertex.point, tolerance);
        let edges = self.trace_horizon(removed);
        let full = self.vertex_count >= VERTICES || self.face_count - removed + edges > FACES;
        if full || !self.is_union_of_loops(edges) {
            for &face in &self.visible[..removed] {
                self.faces[usize::from(face)].visible = false;
            }
            return if full { Growth::NoRoom } else { Growth::Torn };
        }
        for &face in &self.visible[..removed] {
            self.faces[usize::from(face)] = Face::FREE;
            self.open[usize::from(face)] = f64::INFINITY;
        }
        self.vertices[self.vertex_count] = vertex;
        self.vertex_count += 1;
        self.face_count = self.face_count + edges - removed;
        self.raise_cone(edges, removed);
        Growth::Grown
    }

    /// Marks what `point` sees, starting at `seen`; returns how many faces.
    fn flood(&mut self, seen: usize, point: DVec3, tolerance: f64) -> usize {
        self.visible[0] = narrow(seen);
        self.faces[seen].visible = true;
        let (mut removed, mut next) = (1, 0);
        while next < removed {
            let across = self.faces[usize::from(self.visible[next])].across;
            next += 1;
            for slot in across {
                let beyond = usize::from(slot);
                if !self.faces[beyond].visible && self.sees(beyond, point, tolerance) {
                    self.faces[beyond].visible = true;
                    self.visible[removed] = slot;
                    removed += 1;
                }
            }
        }
        removed
    }

    /// Whether a point lies more than `tolerance` [m] above a face.
    fn sees(&self, face: usize, point: DVec3, tolerance: f64) -> bool {
        let normal = self.normals[face];
        let above = normal.dot(point) - self.volumes[face];
        above > 0.0 && above * above > tolerance * tolerance * normal.length_squared()
    }

    /// Lists the edges around the visible faces; returns how many. More than the buffer holds are not listed.
    fn trace_horizon(&mut self, removed: usize) -> usize {
        let mut edges = 0;
        for &index in &self.visible[..removed] {
            let face = self.faces[usize::from(index)];
            for k in 0..3 {
                let beyond = self.faces[usize::from(face.across[k])];
                if beyond.visible || edges == FACES {
                    continue;
                }
                let to = face.corners[(k + 1) % 3];
                let edge_of_beyond = beyond.corners.iter().position(|&corner| corner == to);
                self.horizon[edges] = HorizonEdge {
                    from: face.corners[k],
                    to,
                    beyond: face.across[k],
                    edge_of_beyond: edge_of_beyond.map_or(0, narrow),
                    slot: NONE,
                };
                edges += 1;
            }
        }
        edges
    }

    /// Every vertex on the horizon is left by exactly one edge and reached by one.
    fn is_union_of_loops(&mut self, edges: usize) -> bool {
        let horizon = &self.horizon[..edges];
        let mut whole = edges >= 3;
        for edge in horizon {
            let slot = &mut self.leaving[usize::from(edge.from)];
            whole &= *slot == NONE;
            *slot = 0;
        }
        whole &= horizon
            .iter()
            .all(|edge| self.leaving[usize::from(edge.to)] != NONE);
        for edge in horizon {
            self.leaving[usize::from(edge.from)] = NONE;
        }
        whole
    }

    /// One new face per horizon edge up to the newest vertex, in the slots that became free first.
    fn raise_cone(&mut self, edges: usize, removed: usize) {
        let apex = narrow(self.vertex_count - 1);
        for number in 0..edges {
            let slot = if number < removed {
                self.visible[number]
            } else {
                self.untouched_slot()
            };
            self.horizon[number].slot = slot;
            self.leaving[usize::from(self.horizon[number].from)] = slot;
            self.faces[usize::from(slot)].live = true;
        }
        for number in 0..edges {
            let edge = self.horizon[number];
            let following = self.leaving[usize::from(edge.to)];
            self.faces[usize::from(edge.beyond)].across[usize::from(edge.edge_of_beyond)] =
                edge.slot;
            // The neighbour across the edge from the apex is told by the face before, below.
            let own = usize::from(edge.slot);
            self.set_face(
                own,
                [edge.from, edge.to, apex],
                [edge.beyond, following, NONE],
            );
        }
        for number in 0..edges {
            let edge = self.horizon[number];
            let following = usize::from(self.leaving[usize::from(edge.to)]);
            self.faces[following].across[2] = edge.slot;
        }
        for number in 0..edges {
            self.leaving[usize::from(self.horizon[number].from)] = NONE;
        }
    }

    /// A free slot of the face buffer; the caller has counted them.
    fn untouched_slot(&mut self) -> u16 {
        if self.face_end < FACES {
            self.face_end += 1;
            return narrow(self.face_end - 1);
        }
        let free = self.faces.iter().position(|face| !face.live);
        narrow(free.unwrap_or(0))
    }

    fn set_face(&mut self, slot: usize, corners: [u16; 3], across: [u16; 3]) {
        let points = corners.map(|corner| self.vertices[usize::from(corner)].point);
        let (normal, base) = cross_of(points);
        let volume = normal.dot(base);
        let area_squared = normal.length_squared();
        // A face without area belongs to the surface but has no plane to grow along.
        let height = if area_squared > 0.0 {
            volume / area_squared * volume.abs()
        } else {
            f64::INFINITY
        };
        self.normals[slot] = normal;
        self.volumes[slot] = volume;
        self.heights[slot] = height;
        self.open[slot] = height;
        self.faces[slot] = Face {
            corners,
            across,
            live: true,
            visible: false,
        };
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "buffers hold at most 2048 faces"
)]
fn narrow(number: usize) -> u16 {
    number as u16
}
