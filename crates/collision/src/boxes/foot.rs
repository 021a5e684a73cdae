//! Points of two boxes: in a supporting plane of their difference, and next to each other.

use glam::DVec3;

use super::{Boxes, FLUSH, Pair, Plane};

/// Sine below which two half sides in the plane of a face count as parallel.
const PARALLEL: f64 = 1e-12;

/// How often both boxes are projected on. From a face next to the nearest feature the first round ends on it.
const ROUNDS: usize = 2;

/// A generator of the difference that lies in its supporting plane.
#[derive(Clone, Copy)]
struct Free {
    side: DVec3,
    /// A's three first.
    number: usize,
}

/// The generators in a supporting plane.
struct Flush {
    sides: [Free; 6],
    count: usize,
}

impl Boxes {
    /// The points whose difference is the origin's foot on a plane. A foot outside the difference gives points on that face
    /// nearby.
    pub(super) fn on_face(&self, plane: &Plane) -> Pair {
        let (a, b) = (plane.normal, plane.normal_in_b);
        let rises = [a * self.half_a, b * self.half_b].map(|rise| rise.to_array());
        // One side of each box is crossed whatever its length, else the point might lie inside a tiny one.
        let steepest = [a.abs().max_position(), b.abs().max_position()];
        let corner_a = self.half_a.copysign(a);
        let corner_b = -self.half_b.copysign(b);
        let mut ends = [corner_a.to_array(), corner_b.to_array()];
        let mut flush = Flush {
            sides: [Free::NONE; 6],
            count: 0,
        };
        for body in 0..2 {
            for k in 0..3 {
                if rises[body][k].abs() <= FLUSH * self.extent && k != steepest[body] {
                    ends[body][k] = 0.0;
                    flush.add(3 * body + k, self.side(body, k));
                }
            }
        }
        let [core_a, in_b] = ends.map(DVec3::from_array);
        let target = plane.normal * plane.separation + core_a - self.offset - self.in_a(in_b);
        let parts = flush.parts(plane.normal, target);
        let (mut core_a, mut core_b) = (core_a, self.offset + self.in_a(in_b));
        for (free, part) in flush.sides().iter().zip(parts) {
            let moved = free.side * part.clamp(-1.0, 1.0);
            if free.number < 3 {
                core_a -= moved;
            } else {
                core_b += moved;
            }
        }
        Pair {
            plane: *plane,
            core_a,
            core_b,
        }
    }

    /// The closest points of two boxes apart whose nearest feature is an edge or a vertex of the difference, from a point of A
    /// near it: each box is projected on in turn, which ends at once where one of the points is a vertex (collision.14).
    pub(super) fn projected(&self, near: DVec3) -> Pair {
        let Self { half_a, half_b, .. } = *self;
        let (core_a, in_b) = self.near(near);
        let core_b = self.offset + self.in_a(in_b);
        // The longest side along which the points may slide: made orthogonal to it the direction is exact at any gap.
        let (of_a, of_b) = (core_a.abs().cmplt(half_a), in_b.abs().cmplt(half_b));
        let mut longest = (0.0, DVec3::ZERO);
        for k in 0..3 {
            if of_a.test(k) && half_a[k] > longest.0 {
                longest = (half_a[k], self.side(0, k));
            }
            if of_b.test(k) && half_b[k] > longest.0 {
                longest = (half_b[k], self.side(1, k));
            }
        }
        let (_, side) = longest;
        let mut between = core_b - core_a;
        if longest.0 > 0.0 {
            between -= side * (between.dot(side) / side.length_squared());
        }
        Pair {
            plane: self.plane_across(between.normalize()),
            core_a,
            core_b,
        }
    }

    /// Points of an axis whose foot rounding puts outside the face: among faces that are coplanar to rounding the next one may
    /// hold it. Moved along the normal until they touch, the boxes share a point there.
    #[inline(never)]
    pub(super) fn beside(&self, plane: &Plane, near: DVec3) -> Pair {
        let way = plane.normal * plane.separation;
        let touching = Self {
            offset: self.offset - way,
            ..*self
        };
        let (core_a, in_b) = touching.near(near);
        Pair {
            plane: *plane,
            core_a,
            core_b: self.offset + self.in_a(in_b),
        }
    }

    /// A point of A, and one of B in B, by projecting in turn.
    fn near(&self, near: DVec3) -> (DVec3, DVec3) {
        let Self { half_a, half_b, .. } = *self;
        let (mut core_a, mut in_b) = (near, near);
        for _ in 0..ROUNDS {
            in_b = self.in_b(core_a - self.offset).clamp(-half_b, half_b);
            core_a = (self.offset + self.in_a(in_b)).clamp(-half_a, half_a);
        }
        (core_a, in_b)
    }

    /// A generator of the difference: half a side of A backwards or of B.
    fn side(&self, body: usize, k: usize) -> DVec3 {
        if body == 0 {
            DVec3::AXES[k] * -self.half_a[k]
        } else {
            self.axes_b[k] * self.half_b[k]
        }
    }
}

impl Free {
    const NONE: Self = Self {
        side: DVec3::ZERO,
        number: 0,
    };
}

impl Flush {
    fn add(&mut self, number: usize, side: DVec3) {
        self.sides[self.count] = Free { side, number };
        self.count += 1;
    }

    fn sides(&self) -> &[Free] {
        &self.sides[..self.count]
    }

    /// The parts of each side that add up to `target`, a vector in the plane across `normal`. They are in [−1, 1] if the
    /// target lies in the face.
    fn parts(&self, normal: DVec3, target: DVec3) -> [f64; 6] {
        if let [p, q] = self.sides()
            && let Some([of_p, of_q]) = of_two([p.side, q.side], normal, target)
        {
            return [of_p, of_q, 0.0, 0.0, 0.0, 0.0];
        }
        self.of_several(normal, target)
    }

    /// The face is a zonotope again, a polygon: the ray towards the target leaves it through the side with the largest gauge
    /// g, and with the parts at that point shrunk by g the sum ends on the target (collision.13).
    #[inline(never)]
    fn of_several(&self, normal: DVec3, target: DVec3) -> [f64; 6] {
        let sides = self.sides();
        let mut parts = [0.0; 6];
        let mut exit: Option<(f64, DVec3)> = None;
        for free in sides {
            let across = normal.cross(free.side);
            let reach: f64 = sides.iter().map(|other| across.dot(other.side).abs()).sum();
            // All are parallel: the target is then among them.
            let flat = reach <= PARALLEL * free.side.length_squared();
            let gauge = if flat {
                0.0
            } else {
                across.dot(target) / reach
            };
            let further = exit.is_none_or(|(best, _)| gauge.abs() > best.abs());
            if free.side != DVec3::ZERO && further {
                exit = Some((gauge, free.side));
            }
        }
        let Some((gauge, side)) = exit else {
            return parts;
        };
        let across = normal.cross(side);
        let (mut rest, mut along) = (target, 0.0);
        for (part, free) in parts.iter_mut().zip(sides) {
            if parallel(across, side, free.side) {
                along += side.dot(free.side).abs();
            } else {
                *part = gauge * across.dot(free.side).signum();
                rest -= free.side * *part;
            }
        }
        let share = side.dot(rest) / along;
        for (part, free) in parts.iter_mut().zip(sides) {
            if parallel(across, side, free.side) {
                *part = share * side.dot(free.side).signum();
            }
        }
        parts
    }
}

/// Parts of two vectors in the plane across `normal` that add up to `target`; `None` if they are parallel.
fn of_two([p, q]: [DVec3; 2], normal: DVec3, target: DVec3) -> Option<[f64; 2]> {
    let across = q.cross(normal);
    if parallel(across, q, p) {
        return None;
    }
    let of_p = across.dot(target) / across.dot(p);
    // From what is left, so that the sum is right however small the angle between the two.
    let of_q = (target - p * of_p).dot(q) / q.length_squared();
    Some([of_p, of_q])
}

/// Whether `other` is parallel to `side`, to which `across` is square and as long.
fn parallel(across: DVec3, side: DVec3, other: DVec3) -> bool {
    let product = across.dot(other);
    product * product <= PARALLEL * PARALLEL * side.length_squared() * other.length_squared()
}
