//! The support polygon of a convex mesh: its vertices within a slab below a supporting plane, at a bounded cost (contact.9).
//!
//! Few vertices lie in a slab of 1 µm on the objects of most scenes, but their number grows with the tessellation. Up to
//! [`MOST`] are taken as they are. Beyond that, the highest [`MOST`] tell what the surface is like:
//!
//! - *Curved*: the slab is narrowed until it holds no more than [`MOST`]. The full patch has a radius of √(2 R · 1 µm) at the radius of
//!   curvature R, and the narrowed one lies in it.
//! - *Flat*: a face cut into many triangles. Its corners are found by climbing in directions tilted by [`TILT`], so
//!   that the triangles inside are never visited.

use glam::DVec3;
use pliant_collision::SupportMap;
use pliant_mesh::ConvexMesh;

/// Vertices this close to the supporting plane belong to the support polygon [m]: ten skins, so that a face held at the skin counts
/// whole, and a 100 mm face tilted by 1e-5 rad counts as an edge.
pub(crate) const SLAB: f64 = 1e-6;
/// Vertices of a slab that are taken one by one. The 12,672-face ellipsoids have up to 6 in a slab, boxes and prisms as many as corners.
const MOST: usize = 16;
/// A narrowed slab ends this far above the first vertex left out [m]: vertices at one height (a ring around a pole) stay or go together.
const TIE: f64 = 1e-9;
/// Radius of curvature R over the object's radius r above which a surface counts as flat. Both the full and the narrowed patch lie
/// within √(2 R · 1 µm) of the highest point, so they differ by 2.2 mm at most on an object of r = 60 mm.
const FLAT: f64 = 10.0;
/// Tilt of the directions that find the corners of a flat face [rad]: what makes the end of a 100 mm face leave the slab.
pub(crate) const TILT: f64 = 1e-5;
/// Corners of a flat face at most: of a disc with more, less than 0.5 % of the radius is cut off.
const MOST_CORNERS: usize = 64;

/// A vertex and its height along the direction of the walk [m].
#[derive(Clone, Copy, Debug)]
struct Entry {
    vertex: u32,
    height: f64,
    expanded: bool,
}

/// Support polygon of one body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Support<'w> {
    /// The highest vertices first, or corners in order around a flat face; never empty.
    pub(crate) vertices: &'w [u32],
    /// The vertices are the corners of a flat face of many triangles.
    pub(crate) is_flat_face: bool,
}

/// Scratch of the walk over the neighbour graph of one mesh after another.
#[derive(Clone, Debug)]
pub(crate) struct SlabWalk {
    /// Walk that last met a vertex.
    met: Vec<u64>,
    current: u64,
    /// Highest vertices met, falling; one more than are taken.
    highest: Vec<Entry>,
    /// Vertices of the slab, the highest first, or corners in order around a flat face.
    found: Vec<u32>,
}

impl SlabWalk {
    /// For meshes of up to `vertices` vertices.
    pub(crate) fn new(vertices: usize) -> Self {
        Self {
            met: vec![0; vertices],
            current: 0,
            highest: Vec::with_capacity(MOST + 2),
            found: Vec::with_capacity(MOST_CORNERS),
        }
    }

    /// Vertices a support polygon has at most.
    pub(crate) const MOST: usize = MOST_CORNERS;

    /// The vertices of the support polygon along `direction` (unit, mesh frame), `top` being a support vertex: those whose height is
    /// within `SLAB` of the height of `top`, or of them as many as the module allows.
    pub(crate) fn visit(&mut self, mesh: &ConvexMesh, direction: DVec3, top: u32) -> Support<'_> {
        let floor = direction.dot(mesh.positions()[top as usize]) - SLAB;
        self.collect_highest(mesh, direction, top, floor);
        self.found.clear();
        let floor = match self.highest.get(MOST) {
            None => floor,
            Some(_) if self.is_flat(mesh) => {
                self.collect_corners(mesh, direction, top, floor);
                return Support {
                    vertices: &self.found,
                    is_flat_face: true,
                };
            }
            Some(first_left_out) => first_left_out.height + TIE,
        };
        let inside = |entry: &&Entry| entry.vertex == top || entry.height >= floor;
        let taken = self.highest.iter().take(MOST).filter(inside);
        self.found.extend(taken.map(|entry| entry.vertex));
        Support {
            vertices: &self.found,
            is_flat_face: false,
        }
    }

    /// The `MOST` + 1 highest vertices not below `floor`. What lies above a plane hangs together on a convex mesh, so going on from
    /// the highest vertex that has not been looked at meets them all.
    fn collect_highest(&mut self, mesh: &ConvexMesh, direction: DVec3, top: u32, floor: f64) {
        self.current += 1;
        self.highest.clear();
        self.met[top as usize] = self.current;
        self.insert(top, floor + SLAB);
        let mut next = 0;
        while next < self.highest.len().min(MOST) {
            if self.highest[next].expanded {
                next += 1;
                continue;
            }
            self.highest[next].expanded = true;
            for &vertex in mesh.neighbours(self.highest[next].vertex) {
                let height = direction.dot(mesh.positions()[vertex as usize]);
                if height >= floor && self.met[vertex as usize] != self.current {
                    self.met[vertex as usize] = self.current;
                    next = next.min(self.insert(vertex, height));
                }
            }
        }
    }

    /// Puts a vertex in its place among the highest and returns the place; of equals the first met stays in front.
    fn insert(&mut self, vertex: u32, height: f64) -> usize {
        let mut place = self.highest.len();
        while place > 0 && self.highest[place - 1].height < height {
            place -= 1;
        }
        if place <= MOST {
            self.highest.truncate(MOST);
            let entry = Entry {
                vertex,
                height,
                expanded: false,
            };
            self.highest.insert(place, entry);
        }
        place
    }

    /// The highest vertices extend so far for what they fall that their surface counts as flat.
    fn is_flat(&self, mesh: &ConvexMesh) -> bool {
        let (first, last) = (self.highest[0], self.highest[MOST - 1]);
        let position = |entry: &Entry| mesh.positions()[entry.vertex as usize];
        let reach = self
            .highest
            .iter()
            .map(|entry| position(entry).distance_squared(position(&first)))
            .fold(0.0, f64::max);
        // A sphere of radius R falls by r²/2R at the distance r.
        reach >= 2.0 * FLAT * mesh.radius() * (first.height - last.height)
    }

    /// Corners of a flat face, those below `floor` left out: supports in tilted directions, first to four sides, then across every side of
    /// the polygon found so far until it has no more corners.
    fn collect_corners(&mut self, mesh: &ConvexMesh, normal: DVec3, top: u32, floor: f64) {
        let positions = mesh.positions();
        let height = |vertex: u32| normal.dot(positions[vertex as usize]);
        let (u, v) = normal.any_orthonormal_pair();
        let mut start = top;
        for across in [u, v, -u, -v] {
            start = mesh.support(normal + TILT * across, start).index;
            if !self.found.contains(&start) {
                self.found.push(start);
            }
        }
        while self.cut_corners(mesh, normal) {}
        self.found
            .retain(|&vertex| vertex == top || height(vertex) >= floor);
    }

    /// Looks once beyond every side of the polygon, so that a polygon with more than the most corners is cut evenly all around; whether
    /// there was a corner.
    fn cut_corners(&mut self, mesh: &ConvexMesh, normal: DVec3) -> bool {
        let positions = mesh.positions();
        let before = self.found.len();
        let mut side = 0;
        while side < self.found.len() && (2..MOST_CORNERS).contains(&self.found.len()) {
            let a = self.found[side];
            let b = self.found[(side + 1) % self.found.len()];
            let along = positions[b as usize] - positions[a as usize];
            let tilted = normal + TILT * along.cross(normal).normalize_or_zero();
            let beyond = mesh.support(tilted, a);
            let gain = tilted.dot(beyond.point - positions[a as usize]);
            side += 1;
            if gain > TILT * TIE && !self.found.contains(&beyond.index) {
                self.found.insert(side, beyond.index);
                side += 1;
            }
        }
        self.found.len() > before
    }
}

#[cfg(test)]
mod tests;
