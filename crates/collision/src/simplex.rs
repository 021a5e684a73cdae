//! Closest point of a simplex of one to four points to the origin.
//!
//! The Voronoi regions are decided by the signs of barycentric coordinates, as in the signed volumes method of Montanari,
//! Petrinic & Barbieri (2017); a point, edge or face is a candidate as soon as a sign allows it, and the nearest candidate
//! wins, so a sign lost to rounding costs nothing. Departing from it, distance and direction do not come from the weighted
//! sum of the vertices, which cancels when shapes are 1e-6 of their size apart, but from the feature itself: the plane
//! normal of a triangle (for an edge of A against an edge of B that is their cross product), the twice orthogonalised
//! rejection from a segment. The direction then stays exact to rounding at any gap.

use glam::DVec3;

use crate::support::DifferencePoint;

/// Vectors shorter than this times the largest coordinate at hand are rounding noise: four units in the last place.
pub(crate) const NOISE: f64 = 4.0 * f64::EPSILON;

/// Two edges whose sine squared is less meet in the point of a needle.
const NEEDLE: f64 = 1e-3;

/// One to four vertices of the Minkowski difference, with the barycentric weights of the point nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex {
    vertices: [DifferencePoint; 4],
    weights: [f64; 4],
    len: usize,
}

/// Point of a simplex nearest to the origin, as a direction and a distance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Nearest {
    /// Unit vector from the origin towards the point; zero if the point is the origin itself.
    pub(crate) normal: DVec3,
    /// Distance of the point from the origin [m].
    pub(crate) distance: f64,
}

/// Which of the simplex's vertices span the nearest feature, with what weights. Normalised only once it is chosen.
#[derive(Clone, Copy)]
struct Candidate {
    /// From the origin towards the nearest point, of any length.
    towards: DVec3,
    /// Of a face the absolute product of `towards` with a point of it; else `towards` ends at the nearest point.
    volume: Option<f64>,
    /// Squared distance [m²].
    square: f64,
    corners: [usize; 3],
    weights: [f64; 3],
    len: usize,
}

impl Simplex {
    pub(crate) const EMPTY: Self = Self {
        vertices: [DifferencePoint::NONE; 4],
        weights: [0.0; 4],
        len: 0,
    };

    pub(crate) fn vertices(&self) -> &[DifferencePoint] {
        &self.vertices[..self.len]
    }

    /// Barycentric weights of the nearest point, after [`Simplex::reduce`].
    pub(crate) fn weights(&self) -> &[f64] {
        &self.weights[..self.len]
    }

    /// A triangle, its nearest point not yet known.
    pub(crate) fn triangle(vertices: [DifferencePoint; 3]) -> Self {
        let [p, q, r] = vertices;
        Self {
            vertices: [p, q, r, DifferencePoint::NONE],
            weights: [0.0; 4],
            len: 3,
        }
    }

    /// Adds a vertex; a fifth is ignored.
    pub(crate) fn push(&mut self, vertex: DifferencePoint) {
        if self.len < 4 {
            self.vertices[self.len] = vertex;
            self.len += 1;
        }
    }

    pub(crate) fn contains_vertex(&self, vertex: &DifferencePoint) -> bool {
        self.vertices().iter().any(|own| own.same_vertices(vertex))
    }

    /// Largest distance of a vertex from the origin [m].
    pub(crate) fn scale(&self) -> f64 {
        self.vertices()
            .iter()
            .fold(0.0, |largest: f64, vertex| {
                largest.max(vertex.point.length_squared())
            })
            .sqrt()
    }

    /// Keeps only the vertices of the feature nearest to the origin (collision.3). `None`: four vertices that enclose the origin, all kept.
    pub(crate) fn reduce(&mut self) -> Option<Nearest> {
        let best = match self.len {
            0 => return None,
            1 => self.on_vertex(0),
            2 => self.on_segment(0, 1),
            3 => self.on_triangle(0, 1, 2),
            _ => self.on_tetrahedron()?,
        };
        let vertices = self.vertices;
        for (slot, &corner) in best.corners[..best.len].iter().enumerate() {
            self.vertices[slot] = vertices[corner];
            self.weights[slot] = best.weights[slot];
        }
        self.len = best.len;
        Some(best.nearest())
    }

    fn on_vertex(&self, corner: usize) -> Candidate {
        Candidate {
            towards: self.vertices[corner].point,
            volume: None,
            square: self.vertices[corner].point.length_squared(),
            corners: [corner, 0, 0],
            weights: [1.0, 0.0, 0.0],
            len: 1,
        }
    }

    fn on_segment(&self, i: usize, j: usize) -> Candidate {
        let start = self.vertices[i].point;
        let edge = self.vertices[j].point - start;
        let length_squared = edge.length_squared();
        let along = -start.dot(edge);
        if along <= 0.0 || length_squared == 0.0 {
            return self.on_vertex(i);
        }
        if along >= length_squared {
            return self.on_vertex(j);
        }
        let fraction = along / length_squared;
        let rejection = start + edge * fraction;
        // The first rejection is orthogonal to rounding of `start`; the second to rounding of itself.
        let rejection = rejection - edge * (rejection.dot(edge) / length_squared);
        Candidate {
            towards: rejection,
            volume: None,
            square: rejection.length_squared(),
            corners: [i, j, 0],
            weights: [1.0 - fraction, fraction, 0.0],
            len: 2,
        }
    }

    fn on_triangle(&self, i: usize, j: usize, k: usize) -> Candidate {
        let [i, j, k] = self.base_first([i, j, k]);
        let [p, q, r] = [i, j, k].map(|corner| self.vertices[corner].point);
        let (pq, pr) = (q - p, r - p);
        let cross = pq.cross(pr);
        let area_squared = cross.length_squared();
        let longest = (r - q).length_squared();
        let size = p.length_squared().max(longest);
        if area_squared <= NOISE * NOISE * size * longest {
            return self.nearest_edge([i, j, k], [true; 3]);
        }
        let inverse = 1.0 / area_squared;
        let volume = cross.dot(p);
        // Relative to a corner and within the plane the coordinates are as small as the triangle, not as the shapes.
        let foot = cross * (volume * inverse) - p;
        let weight_q = foot.cross(pr).dot(cross) * inverse;
        let weight_r = pq.cross(foot).dot(cross) * inverse;
        let weight_p = 1.0 - weight_q - weight_r;
        // A foot on an edge to rounding belongs to the face: its normal stays exact at any height, the edge's does not.
        let mut weights = [weight_p, weight_q, weight_r];
        let beyond = weights.map(|weight| weight <= 0.0);
        let inside = !beyond.contains(&true);
        let on_edge = || {
            let sides = [longest, pr.length_squared(), pq.length_squared()];
            weights.into_iter().zip(sides).all(|(weight, side)| {
                weight > 0.0 || weight * weight * area_squared < NOISE * NOISE * longest * side
            })
        };
        if inside || on_edge() {
            if !inside {
                // On an edge its weights are those of the edge: in a needle the others are rounding, magnified.
                let edge = self.nearest_edge([i, j, k], beyond);
                weights = [i, j, k].map(|corner| edge.weight_of(corner));
            }
            return Candidate {
                towards: if volume < 0.0 { -cross } else { cross },
                volume: Some(volume.abs()),
                square: volume * inverse * volume,
                corners: [i, j, k],
                weights,
                len: 3,
            };
        }
        self.nearest_edge([i, j, k], beyond)
    }

    /// The corners in the same order from the one opposite the longest edge on, where a needle's length spoils least.
    fn base_first(&self, [i, j, k]: [usize; 3]) -> [usize; 3] {
        let [p, q, r] = [i, j, k].map(|corner| self.vertices[corner].point);
        let (of_pq, of_qr, of_rp) = (
            p.distance_squared(q),
            q.distance_squared(r),
            r.distance_squared(p),
        );
        if of_qr >= of_pq && of_qr >= of_rp {
            [i, j, k]
        } else if of_rp >= of_pq {
            [j, k, i]
        } else {
            [k, i, j]
        }
    }

    /// Nearest of the triangle's edges that lie opposite a corner marked in `beyond`.
    fn nearest_edge(&self, [i, j, k]: [usize; 3], beyond: [bool; 3]) -> Candidate {
        let edges = [(j, k), (k, i), (i, j)];
        let mut best: Option<Candidate> = None;
        for ((from, to), open) in edges.into_iter().zip(beyond) {
            if open {
                best = Some(nearer(best, self.on_segment(from, to)));
            }
        }
        best.unwrap_or_else(|| self.on_vertex(i))
    }

    /// Nearest face the origin lies beyond; `None` if it lies strictly inside all four.
    fn on_tetrahedron(&self) -> Option<Candidate> {
        let scale = self.scale();
        // No bound of rounding below is larger.
        let doubt = 8.0 * NOISE * scale * scale * scale;
        let mut best: Option<Candidate> = None;
        for (i, j, k, opposite) in [(0, 1, 2, 3), (0, 1, 3, 2), (0, 2, 3, 1), (1, 2, 3, 0)] {
            let [p, q, r, s] = [i, j, k, opposite].map(|corner| self.vertices[corner].point);
            let cross = (q - p).cross(r - p);
            let height = cross.dot(p);
            let side = cross.dot(s - p);
            let flat = || {
                // Edges carry the rounding of the coordinates, short ones most of it.
                let blur = NOISE * scale * (q - p).length().max((r - p).length());
                side.abs() <= NOISE * scale * cross.length() + blur * (s - p).length()
                    || height.abs() <= blur * p.length()
            };
            let flat = side.abs().min(height.abs()) <= doubt && flat();
            // The origin and the fourth vertex on different sides of the face, or nothing certain.
            if flat || side * height >= 0.0 {
                best = Some(nearer(best, self.on_triangle(i, j, k)));
            }
        }
        best
    }
}

impl Candidate {
    fn nearest(&self) -> Nearest {
        let length = self.towards.length();
        Nearest {
            normal: if length > 0.0 {
                self.towards / length
            } else {
                DVec3::ZERO
            },
            distance: self.volume.map_or(length, |volume| volume / length),
        }
    }

    fn weight_of(&self, corner: usize) -> f64 {
        let slot = self.corners[..self.len]
            .iter()
            .position(|&own| own == corner);
        slot.map_or(0.0, |slot| self.weights[slot])
    }
}

/// Unit normal of a triangle and its signed height over the origin; `None` without area.
#[inline]
pub(crate) fn plane_of(corners: [DVec3; 3]) -> Option<(DVec3, f64)> {
    let (cross, base) = cross_of(corners);
    let area_squared = cross.length_squared();
    if area_squared > 0.0 {
        let normal = cross / area_squared.sqrt();
        Some((normal, normal.dot(base)))
    } else {
        None
    }
}

/// Cross product of the edges at a corner of a triangle (p, q, r), along (q − p) × (r − p), and that corner (collision.4).
///
/// Of the three ways to take it a needle needs the one at the corner opposite its longest edge: the others lose as many
/// digits as it is long.
#[inline]
pub(crate) fn cross_of([p, q, r]: [DVec3; 3]) -> (DVec3, DVec3) {
    let (pq, pr) = (q - p, r - p);
    let cross = pq.cross(pr);
    let (of_pq, of_pr) = (pq.length_squared(), pr.length_squared());
    if cross.length_squared() >= NEEDLE * of_pq * of_pr {
        return (cross, p);
    }
    let qr = r - q;
    let of_qr = qr.length_squared();
    if of_pq >= of_pr.max(of_qr) {
        (qr.cross(-pr), r)
    } else if of_pr >= of_qr {
        (pq.cross(qr), q)
    } else {
        (cross, p)
    }
}

/// Of equals the later one: the face without the newest vertex comes first, and on it the search would not move.
fn nearer(best: Option<Candidate>, candidate: Candidate) -> Candidate {
    match best {
        Some(best) if best.square < candidate.square => best,
        _ => candidate,
    }
}
