//! Signed distance by search over directions, for bodies that are no polytopes.
//!
//! g(n), the gap between the supporting planes across a unit direction n, never exceeds the signed distance, and reaches it
//! for some n (see [`super::oracle`]). Apart, g is concave where it is positive and any ascent finds that n; in overlap it
//! has many summits, hence a grid over the sphere, the directions in which such bodies are often nearest, and an ascent
//! (Nelder & Mead 1965, on the plane that touches the sphere) from the best few. The search only ever errs low: it refutes an
//! answer that is too deep. That none is too shallow, the answer's own normal shows, and apart its witness points do.

use glam::{DMat3, DVec3};
use pliant_spatial::Pose;

use super::round::{Turned, height_of};
use super::shape::Shape;

/// Directions of the grid: 4° apart.
const GRID: u32 = 2000;

/// Summits climbed; a neighbour of a higher start is none of its own.
const CLIMBS: usize = 6;

/// Steps of one climb, and how often it starts anew where it ended: simplices collapse on ridges.
const STEPS: u32 = 120;
const RESTARTS: u32 = 3;

/// Two shapes at a placement, in A's axes about a point of A.
pub struct Search<'s> {
    shapes: [&'s Shape; 2],
    turned: [Option<Turned>; 2],
    origins: [DVec3; 2],
    rotation: DMat3,
    offset: DVec3,
}

impl<'s> Search<'s> {
    /// Places B.
    pub fn new(a: &'s Shape, b: &'s Shape, a_from_b: &Pose) -> Self {
        let shapes = [a, b];
        let turned = shapes.map(|shape| shape.body.turned());
        let origins = shapes.map(|shape| match shape.body.turned() {
            Some(_) => DVec3::ZERO,
            None => shape.core.vertices[0],
        });
        let rotation = DMat3::from_quat(a_from_b.rotation);
        Self {
            shapes,
            turned,
            origins,
            rotation,
            offset: rotation * origins[1] + (a_from_b.translation - origins[0]),
        }
    }

    /// Gap between the supporting planes of the cores across a unit direction in A's frame, from A to B [m].
    pub fn gap(&self, normal: DVec3) -> f64 {
        let in_b = self.rotation.transpose() * -normal;
        normal.dot(self.offset) - self.height(0, normal) - self.height(1, in_b)
    }

    /// Largest coordinate of the difference [m].
    pub fn span(&self) -> f64 {
        let [a, b] = self.shapes.map(|shape| shape.core.extent());
        self.offset.length() + a + b
    }

    /// Distance of a point in A's frame from the core of A, and of a point in B's frame from that of B [m].
    pub fn distances(&self, point_in_a: DVec3, point_in_b: DVec3) -> [f64; 2] {
        [(0, point_in_a), (1, point_in_b)].map(|(which, point)| match self.turned[which] {
            Some(body) => body.distance_to(point),
            None => self.shapes[which].core.distance_to(point),
        })
    }

    /// A point in A's frame as one in B's.
    pub fn in_b(&self, point_in_a: DVec3) -> DVec3 {
        let relative = (point_in_a - self.origins[0]) - self.offset;
        self.rotation.transpose() * relative + self.origins[1]
    }

    /// The largest gap found and its direction; never above the signed distance of the cores.
    pub fn best(&self) -> (f64, DVec3) {
        let mut starts: Vec<(f64, DVec3)> = fibonacci()
            .chain(self.likely())
            .map(|direction| (self.gap(direction), direction))
            .collect();
        starts.sort_by(|p, q| q.0.total_cmp(&p.0));
        let mut climbed: Vec<DVec3> = Vec::new();
        let mut best = starts[0];
        for (_, start) in starts {
            if climbed.len() == CLIMBS {
                break;
            }
            if climbed.iter().any(|other| other.dot(start) > 0.99) {
                continue;
            }
            climbed.push(start);
            best = higher(best, self.climb(start, 0.05));
        }
        best
    }

    /// The nearest summit from a direction on, the first steps as wide as told [rad].
    pub fn climb(&self, start: DVec3, width: f64) -> (f64, DVec3) {
        let mut best = (self.gap(start), start);
        let mut width = width;
        for _ in 0..RESTARTS {
            best = higher(best, self.ascend(best.1, width));
            width *= 1e-3;
        }
        best
    }

    fn height(&self, which: usize, direction: DVec3) -> f64 {
        match self.turned[which] {
            Some(body) => body.height(direction),
            None => height_of(&self.shapes[which].core, self.origins[which], direction),
        }
    }

    /// Axes and sides of round bodies and faces of the others.
    fn likely(&self) -> impl Iterator<Item = DVec3> {
        let mut directions = Vec::new();
        for which in [0, 1] {
            let own = if let Some(body) = self.turned[which] {
                body.directions()
            } else {
                let faces = self.shapes[which].core.triangles.iter();
                faces.map(|face| face.normal).collect()
            };
            for direction in own.into_iter().filter_map(DVec3::try_normalize) {
                let in_a = if which == 0 {
                    direction
                } else {
                    self.rotation * direction
                };
                directions.extend([in_a, -in_a]);
            }
        }
        let towards = self.offset.try_normalize();
        directions.into_iter().chain(towards)
    }

    /// Nelder and Mead's simplex of three directions, with their usual factors.
    fn ascend(&self, start: DVec3, width: f64) -> (f64, DVec3) {
        let (u, v) = start.any_orthonormal_pair();
        let at = |direction: DVec3| {
            let unit = direction.normalize();
            (self.gap(unit), unit)
        };
        let corners = [start, start + u * width, start + v * width];
        let mut simplex = corners.map(at);
        for _ in 0..STEPS {
            simplex.sort_by(|p, q| q.0.total_cmp(&p.0));
            let [best, second, worst] = simplex;
            let middle = best.1.midpoint(second.1);
            let away = middle - worst.1;
            let reflected = at(middle + away);
            simplex[2] = if reflected.0 > best.0 {
                higher(reflected, at(middle + away * 2.0))
            } else if reflected.0 > second.0 {
                reflected
            } else {
                let side = if reflected.0 > worst.0 { 0.5 } else { -0.5 };
                let contracted = at(middle + away * side);
                if contracted.0 <= worst.0.max(reflected.0) {
                    simplex[1] = at(best.1.midpoint(second.1));
                    at(best.1.midpoint(worst.1))
                } else {
                    contracted
                }
            };
        }
        simplex.into_iter().fold(simplex[0], higher)
    }
}

fn higher(p: (f64, DVec3), q: (f64, DVec3)) -> (f64, DVec3) {
    if q.0 > p.0 { q } else { p }
}

/// Directions evenly over the sphere, on a spiral of golden angles.
fn fibonacci() -> impl Iterator<Item = DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..GRID).map(move |i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(GRID);
        let (sine, cosine) = (golden * f64::from(i)).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cosine, radius * sine, z)
    })
}
