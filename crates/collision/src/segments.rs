//! Segment against segment in closed form, points included: nearest points, and the normal also where they cross.
//!
//! Ericson (2005, §5.1.9) with two departures that keep ten more digits between nearly parallel lines: the parameters come
//! from the cross product w = u × v instead of the determinant uu·vv − (uv)², and the normal of lines that pass each other
//! is w made orthogonal to u once more. Its error against v then is that of w times the sine between u and v.

use glam::DVec3;

use crate::simplex::NOISE;

/// Distances below this times the size do not tell a direction by themselves.
const TOUCHING: f64 = 1e-9;

/// Cross products of vectors below this times their lengths are rounding.
const PARALLEL: f64 = 4.0 * f64::EPSILON;

/// Two segments about their middles: A is `half_a`·s, B is `offset` + `half_b`·t, with s and t in [−1, 1].
pub(crate) struct Segments {
    pub(crate) half_a: DVec3,
    pub(crate) half_b: DVec3,
    pub(crate) offset: DVec3,
}

/// The nearest point of A and a pair of supporting planes between the segments.
pub(crate) struct Nearest {
    /// Parameter of the point of A nearest to B.
    pub(crate) on_a: f64,
    /// Unit, from A to B.
    pub(crate) normal: DVec3,
    /// Gap between the supporting planes [m]; zero, to rounding, where the segments cross.
    pub(crate) separation: f64,
}

impl Segments {
    /// (collision.5)
    pub(crate) fn nearest(&self) -> Nearest {
        let cross = self.common_normal();
        let (on_a, gap) = self.parameters(cross);
        let size = self.half_a.length() + self.half_b.length();
        let distance = gap.length();
        let mut best = Nearest {
            on_a,
            normal: DVec3::X,
            separation: f64::NEG_INFINITY,
        };
        if distance > 0.0 {
            best.offer(gap / distance, self, 0.0);
        }
        if distance <= TOUCHING * size || distance == 0.0 {
            let longest = if self.half_a.length_squared() >= self.half_b.length_squared() {
                self.half_a
            } else {
                self.half_b
            };
            let across =
                cross.unwrap_or_else(|| longest.any_orthogonal_vector().normalize_or(DVec3::Z));
            // Only if it tells more than rounding: else the gap knows better where the segments came from.
            let rounding = NOISE * size;
            best.offer(across, self, rounding);
            best.offer(-across, self, rounding);
        }
        best
    }

    /// Unit vector at right angles to both; `None` if they are parallel or points.
    fn common_normal(&self) -> Option<DVec3> {
        let cross = self.half_a.cross(self.half_b);
        let (a, b) = (self.half_a.length_squared(), self.half_b.length_squared());
        if cross.length_squared() <= PARALLEL * PARALLEL * a * b {
            return None;
        }
        let unit = cross.normalize();
        Some((unit - self.half_a * (unit.dot(self.half_a) / a)).normalize())
    }

    /// Parameter of the point of A nearest to B and the vector from there to B.
    fn parameters(&self, cross: Option<DVec3>) -> (f64, DVec3) {
        let Self {
            half_a,
            half_b,
            offset,
        } = *self;
        if let Some(normal) = cross {
            let volume = half_a.cross(half_b).dot(normal);
            let on_a = offset.cross(half_b).dot(normal) / volume;
            let on_b = offset.cross(half_a).dot(normal) / volume;
            if on_a.abs() <= 1.0 && on_b.abs() <= 1.0 {
                let gap = normal * normal.dot(offset);
                return (self.beside_b(on_a), gap);
            }
        }
        let mut best = (0.0, DVec3::INFINITY);
        let mut offer = |on_a: f64, gap: DVec3| {
            let (own, least) = (gap.length_squared(), best.1.length_squared());
            let rounding = 2.0 * NOISE * least;
            // Of equally near ones the gap across which the planes are further apart: on long segments a normal may be
            // a little off where the distance does not show it.
            let nearer = if own + rounding < least || least == f64::INFINITY {
                true
            } else {
                own <= least + rounding
                    && self.gap_along(gap.normalize_or_zero())
                        > self.gap_along(best.1.normalize_or_zero())
            };
            if nearer {
                best = (on_a, gap);
            }
        };
        for end in [-1.0, 1.0] {
            let (on_a, gap) = beside(half_a, offset + half_b * end);
            offer(on_a, gap);
            let (_, gap) = beside(half_b, half_a * end - offset);
            offer(end, -gap);
        }
        best
    }

    /// Where lines cross under a tiny angle rounding shifts the place along them, and may shift it past the end of B: then the
    /// point of A beside that end.
    fn beside_b(&self, on_a: f64) -> f64 {
        let along = self.half_b.dot(self.half_a * on_a - self.offset);
        let whole = self.half_b.length_squared();
        if along.abs() <= whole {
            return on_a;
        }
        let end = self.offset + self.half_b * along.signum();
        (self.half_a.dot(end) / self.half_a.length_squared()).clamp(-1.0, 1.0)
    }

    /// Gap between the supporting planes along a direction [m].
    fn gap_along(&self, normal: DVec3) -> f64 {
        normal.dot(self.offset) - normal.dot(self.half_a).abs() - normal.dot(self.half_b).abs()
    }
}

impl Nearest {
    /// Takes a direction whose gap is wider by more than a margin [m].
    fn offer(&mut self, normal: DVec3, segments: &Segments, margin: f64) {
        let separation = segments.gap_along(normal);
        if separation > self.separation + margin {
            self.normal = normal;
            self.separation = separation;
        }
    }
}

/// Parameter of the point of the segment ±`half` nearest to `point`, and the vector from there.
fn beside(half: DVec3, point: DVec3) -> (f64, DVec3) {
    let length_squared = half.length_squared();
    let along = half.dot(point);
    if along.abs() >= length_squared {
        // Also for a segment without length.
        let end = if along < 0.0 { -1.0 } else { 1.0 };
        return (end, point - half * end);
    }
    let parameter = along / length_squared;
    let rejection = point - half * parameter;
    (
        parameter,
        rejection - half * (rejection.dot(half) / length_squared),
    )
}
