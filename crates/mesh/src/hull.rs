//! Convex hull of points: quickhull (C. B. Barber, D. P. Dobkin and H. Huhdanpaa, "The quickhull algorithm
//! for convex hulls", ACM TOMS 22(4), 1996) decided by exact orientation predicates (J. R. Shewchuk,
//! "Adaptive precision floating-point arithmetic and fast robust geometric predicates", 1997).
//!
//! Which faces a point sees is decided exactly, so the surface is at every step the exact hull of the points
//! taken so far: closed, convex, without a triangle of zero area, whatever the rounding. Where the paper
//! merges faces to survive rounding, nothing is needed here. A tolerance enters only in the choice of points:
//! those that stick out by no more than [`SKIN`] are left out, so noise in flat sides makes no slivers.
//!
//! Faces are taken in the order in which they came to be, so that the hull grows finer everywhere at once. Finished one
//! region after the other, a fine rim faces coarse rest through fans of thousands of slivers, and each further point of a
//! flat ring replaces such a fan.
//!
//! Two libraries were measured on 13 point sets before this was written. `quickhull` 0.1.0 works in `f32`: on
//! the 27,461 points of a tooth its hull leaves points outside by 47 % of the size, it returns triangles
//! without area on a tube and accepts collinear and coincident points. `chull` 0.2.4 takes 0.9 to 1.2 s for
//! 6,338 points on an ellipsoid and leaves points of the tooth 8e-5 outside.

use std::collections::VecDeque;

use glam::DVec3;
use robust::{Coord3D, orient3d};
use thiserror::Error;

use crate::digits::number;
use crate::triangle_mesh::compacted;
use crate::{Aabb, MeshError, TriangleMesh};

/// How far points may stay outside the hull, relative to the diagonal of their bounds: above the rounding of
/// rotated coordinates (1e-16), far below what any model resolves.
pub const SKIN: f64 = 1e-12;

/// Height of the widest tetrahedron, relative to the size, at which points count as lying in one plane.
const FLAT: f64 = 1e-9;

/// Why points have no hull.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum HullError {
    /// A position that is no place, or too many points.
    #[error(transparent)]
    Points(#[from] MeshError),
    /// Too few points.
    #[error("{count} point(s) enclose no volume: a hull needs at least four")]
    TooFew {
        /// How many there are.
        count: usize,
    },
    /// All at one place, on one line or in one plane.
    #[error(
        "all {count} points lie {shape} (within {} over a size of {}): they enclose no volume",
        number(*.thickness), number(*.size)
    )]
    Degenerate {
        /// Number of points.
        count: usize,
        /// "at one place", "on a line" or "in a plane".
        shape: &'static str,
        /// How far they leave that shape [m].
        thickness: f64,
        /// Diagonal of their bounds [m].
        size: f64,
    },
}

/// The convex hull of `points` [m] as a closed triangle mesh wound outward. Only vertices of the hull are
/// kept, in the order of the points; the same points give the same mesh.
///
/// # Errors
/// Fewer than four points, a non-finite one, or all in one plane, on one line or at one place.
pub fn convex_hull(points: &[DVec3]) -> Result<TriangleMesh, HullError> {
    let count = points.len();
    if count < 4 {
        return Err(HullError::TooFew { count });
    }
    // Only for its checks of finite positions and of the count.
    TriangleMesh::new(points.to_vec(), vec![[0, 1, 2]])?;
    let hull = Hull::around(points)?;
    let triangles: Vec<[u32; 3]> = hull
        .faces
        .iter()
        .filter(|f| f.alive)
        .map(|f| f.corners)
        .collect();
    Ok(compacted(points, &triangles))
}

struct Face {
    /// Counter-clockwise seen from outside.
    corners: [u32; 3],
    /// The face beyond the edge from corner k to corner k + 1.
    neighbours: [u32; 3],
    twice_area: f64,
    /// Points above this face by more than the skin, each on one face only.
    outside: Vec<u32>,
    alive: bool,
}

struct Hull<'a> {
    points: &'a [DVec3],
    faces: Vec<Face>,
    /// Faces that may have points outside, oldest first.
    pending: VecDeque<u32>,
    skin: f64,
}

/// An edge of the region seen from a new point: its ends, in the direction of the region's face, and the
/// face beyond it.
struct HorizonEdge {
    from: u32,
    to: u32,
    beyond: u32,
}

impl<'a> Hull<'a> {
    /// The whole hull, dead faces included.
    fn around(points: &'a [DVec3]) -> Result<Self, HullError> {
        let size = Aabb::from_points(points).diagonal();
        let simplex = first_simplex(points, size)?;
        let mut hull = Hull::new(points, simplex, SKIN * size);
        while let Some(face) = hull.pending.pop_front() {
            hull.take_farthest(face);
        }
        Ok(hull)
    }

    fn new(points: &'a [DVec3], simplex: [u32; 4], skin: f64) -> Self {
        let mut hull = Hull {
            points,
            faces: Vec::new(),
            pending: VecDeque::new(),
            skin,
        };
        let [a, b, c, d] = simplex;
        for (corners, neighbours) in [
            ([a, b, c], [1, 2, 3]),
            ([b, a, d], [0, 3, 2]),
            ([c, b, d], [0, 1, 3]),
            ([a, c, d], [0, 2, 1]),
        ] {
            hull.add_face(corners, neighbours);
        }
        let others = (0..)
            .take(points.len())
            .filter(|p| !simplex.contains(p))
            .collect();
        hull.assign(others, &[0, 1, 2, 3]);
        hull
    }

    /// Adds the point highest over `face` and replaces the faces it sees by a cone to their border.
    fn take_farthest(&mut self, face: u32) {
        let this = &self.faces[face as usize];
        if !this.alive {
            return;
        }
        let base = self.points[this.corners[0] as usize];
        let heights: Vec<(u32, f64)> = this
            .outside
            .iter()
            .map(|&p| (p, self.height(face, p)))
            .collect();
        let top = heights
            .iter()
            .fold(f64::NEG_INFINITY, |top, h| top.max(h.1));
        let ties = heights
            .iter()
            .filter(|h| h.1 >= top - self.skin)
            .map(|h| h.0);
        let Some(apex) = corner_of(self.points, ties, base) else {
            return;
        };
        let (seen, horizon) = self.horizon(face, apex);
        let mut orphans = Vec::new();
        for &f in &seen {
            let face = &mut self.faces[f as usize];
            face.alive = false;
            orphans.append(&mut face.outside);
        }
        orphans.retain(|&p| p != apex);
        let first = self.next_face();
        let ring = u32::try_from(horizon.len()).expect("fewer edges than points");
        for (i, edge) in (0..ring).zip(&horizon) {
            let before = first + (i + ring - 1) % ring;
            let after = first + (i + 1) % ring;
            let new = self.add_face([edge.from, edge.to, apex], [edge.beyond, after, before]);
            let beyond = &mut self.faces[edge.beyond as usize];
            let side = (0..3)
                .find(|&k| beyond.corners[k] == edge.to)
                .expect("neighbours share the edge");
            beyond.neighbours[side] = new;
        }
        let cone: Vec<u32> = (first..first + ring).collect();
        self.assign(orphans, &cone);
    }

    /// The faces that `apex` sees, and their border as a ring in counter-clockwise order: a depth-first walk
    /// that enters each face through one edge and visits the others in turn.
    fn horizon(&mut self, start: u32, apex: u32) -> (Vec<u32>, Vec<HorizonEdge>) {
        let mut seen = vec![start];
        let mut ring = Vec::new();
        self.faces[start as usize].alive = false;
        // Face, next side to look at, sides left.
        let mut stack = vec![(start, 0, 3)];
        while let Some((face, side, left)) = stack.pop() {
            if left == 0 {
                continue;
            }
            stack.push((face, (side + 1) % 3, left - 1));
            let this = &self.faces[face as usize];
            let beyond = this.neighbours[side];
            let (from, to) = (this.corners[side], this.corners[(side + 1) % 3]);
            if !self.faces[beyond as usize].alive {
                continue;
            }
            if self.orientation(beyond, apex) > 0.0 {
                self.faces[beyond as usize].alive = false;
                seen.push(beyond);
                let entry = (0..3)
                    .find(|&k| self.faces[beyond as usize].corners[k] == to)
                    .expect("neighbours share the edge");
                stack.push((beyond, (entry + 1) % 3, 2));
            } else {
                ring.push(HorizonEdge { from, to, beyond });
            }
        }
        (seen, ring)
    }

    /// Gives each point to the first of `faces` it is above.
    fn assign(&mut self, points: Vec<u32>, faces: &[u32]) {
        for p in points {
            if let Some(&f) = faces.iter().find(|&&f| self.height(f, p) > self.skin) {
                self.faces[f as usize].outside.push(p);
            }
        }
        let busy = faces
            .iter()
            .copied()
            .filter(|&f| !self.faces[f as usize].outside.is_empty());
        self.pending.extend(busy);
    }

    fn add_face(&mut self, corners: [u32; 3], neighbours: [u32; 3]) -> u32 {
        let [a, b, c] = corners.map(|v| self.points[v as usize]);
        let index = self.next_face();
        self.faces.push(Face {
            corners,
            neighbours,
            twice_area: (b - a).cross(c - a).length().max(f64::MIN_POSITIVE),
            outside: Vec::new(),
            alive: true,
        });
        index
    }

    fn next_face(&self) -> u32 {
        u32::try_from(self.faces.len()).expect("a hull makes fewer faces than u32 counts")
    }

    /// Height of a point over a face [m]; the sign is exact.
    fn height(&self, face: u32, point: u32) -> f64 {
        self.orientation(face, point) / self.faces[face as usize].twice_area
    }

    /// Six times the volume between a face and a point, positive above; the sign is exact (mesh.12).
    fn orientation(&self, face: u32, point: u32) -> f64 {
        let [a, b, c] = self.faces[face as usize]
            .corners
            .map(|v| coordinates(self.points[v as usize]));
        -orient3d(a, b, c, coordinates(self.points[point as usize]))
    }
}

fn coordinates(p: DVec3) -> Coord3D<f64> {
    Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    }
}

/// A wide tetrahedron: the farthest pair among the extremes of the axes, the point farthest from their line,
/// the one farthest from that plane; the last lies below the first three.
fn first_simplex(points: &[DVec3], size: f64) -> Result<[u32; 4], HullError> {
    let degenerate = |shape, thickness| HullError::Degenerate {
        count: points.len(),
        shape,
        thickness,
        size,
    };
    let middle = Aabb::from_points(points).center();
    let farthest = |measure: &dyn Fn(DVec3) -> f64, base: DVec3| {
        let top = points
            .iter()
            .fold(f64::NEG_INFINITY, |top, &p| top.max(measure(p)));
        let ties = (0..)
            .zip(points)
            .filter(|&(_, &p)| measure(p) >= top - SKIN * size);
        (
            corner_of(points, ties.map(|(i, _)| i), base).unwrap_or(0),
            top,
        )
    };
    let at = |i: u32| points[i as usize];
    let extremes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
        let ends = [
            farthest(&|p| p.dot(axis), middle).0,
            farthest(&|p| -p.dot(axis), middle).0,
        ];
        (ends, at(ends[0]).distance(at(ends[1])))
    });
    let ([a, b], _) = *extremes
        .iter()
        .max_by(|p, q| p.1.total_cmp(&q.1))
        .expect("three axes");
    // 1e-90 m: products of three such lengths would underflow.
    if size <= 1e-90 {
        return Err(degenerate("at one place", size));
    }
    let along = (at(b) - at(a)).normalize_or_zero();
    let (c, width) = farthest(&|p| (p - at(a)).cross(along).length(), at(a));
    if width <= FLAT * size {
        return Err(degenerate("on a line", width));
    }
    let normal = (at(b) - at(a)).cross(at(c) - at(a)).normalize_or_zero();
    let (d, thickness) = farthest(&|p| (p - at(a)).dot(normal).abs(), at(a));
    if thickness <= FLAT * size {
        return Err(degenerate("in a plane", thickness));
    }
    let below = (at(d) - at(a)).dot(normal) < 0.0;
    Ok(if below { [a, b, c, d] } else { [b, a, c, d] })
}

/// Of points that tie, the farthest from `base`, so that a corner of a flat side is taken and not a point
/// amid its edge; the first of equals.
fn corner_of(points: &[DVec3], ties: impl Iterator<Item = u32>, base: DVec3) -> Option<u32> {
    let mut best: Option<(u32, f64)> = None;
    for i in ties {
        let distance = points[i as usize].distance_squared(base);
        if best.is_none_or(|(_, farthest)| distance > farthest) {
            best = Some((i, distance));
        }
    }
    best.map(|(i, _)| i)
}

#[cfg(test)]
mod tests {
    use super::Hull;
    use glam::{DQuat, DVec2, DVec3};
    use std::f64::consts::TAU;

    #[test]
    fn flat_rings_make_few_faces_more_than_they_keep() {
        const COUNT: u32 = 8000;
        let on_circle = |i: u32, of: u32| DVec2::from_angle(TAU * f64::from(i) / f64::from(of));
        let turn = DQuat::from_rotation_y(0.7);
        let disc = |i: u32| on_circle(i / 2, COUNT / 2).extend(1e-3 * f64::from(i % 2));
        let wave = |i: u32| {
            let around = on_circle(i, COUNT);
            around.extend(1e-3 * around.x * around.y)
        };
        let shapes: [&dyn Fn(u32) -> DVec3; 3] = [&disc, &|i| turn * disc(i), &wave];
        for shape in shapes {
            let points: Vec<DVec3> = (0..COUNT).map(shape).collect();
            let hull = Hull::around(&points).unwrap();
            // Every corner is kept: 2 n - 4 faces. Some 4 n are made in all; hundreds of n finishing region by region.
            let kept = hull.faces.iter().filter(|f| f.alive).count();
            assert_eq!(kept, 2 * COUNT as usize - 4);
            let made = hull.faces.len();
            assert!(
                made < 12 * COUNT as usize,
                "{made} faces for {COUNT} points"
            );
        }
    }
}
