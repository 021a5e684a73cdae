//! Cross products of almost parallel vectors in twice the working precision (Dekker 1971; Ogita, Rump & Oishi 2005), so
//! that the oracle knows the common normal of two edges that differ by 1e-15 rad.

use glam::DVec3;

/// A number as the unevaluated sum of two.
type Double = (f64, f64);

/// q − p without rounding, as two vectors of which the second holds what the first lost.
#[derive(Clone, Copy)]
pub struct Difference {
    high: DVec3,
    low: DVec3,
    length_squared: f64,
}

impl Difference {
    /// From p to q.
    pub fn new(p: DVec3, q: DVec3) -> Self {
        let high = q - p;
        let back = high - q;
        let low = (q - (high - back)) - (p + back);
        Self {
            high,
            low,
            length_squared: high.length_squared(),
        }
    }

    /// Rounded to the nearest.
    pub fn rounded(&self) -> DVec3 {
        self.high
    }

    /// Its square.
    pub fn length_squared(&self) -> f64 {
        self.length_squared
    }

    fn component(&self, axis: usize) -> Double {
        (self.high[axis], self.low[axis])
    }
}

/// Cross product, right to rounding in every component that is not smaller than 1e-28 of the lengths multiplied.
#[inline]
pub fn cross(u: &Difference, v: &Difference) -> DVec3 {
    let plain = u.high.cross(v.high);
    // The plain product is wrong by 1e-16 of the lengths multiplied: no matter where it is not small.
    if plain.length_squared() > 1e-4 * u.length_squared * v.length_squared {
        return plain;
    }
    exact_cross(u, v)
}

#[cold]
fn exact_cross(u: &Difference, v: &Difference) -> DVec3 {
    let part = |i: usize, j: usize| {
        minor(
            [u.component(i), v.component(j)],
            [u.component(j), v.component(i)],
        )
    };
    DVec3::new(part(1, 2), part(2, 0), part(0, 1))
}

/// a·b − c·d.
fn minor([a, b]: [Double; 2], [c, d]: [Double; 2]) -> f64 {
    let (first, second) = (product(a, b), product(c, d));
    let sum = first.0 - second.0;
    let back = sum - first.0;
    let lost = (first.0 - (sum - back)) - (second.0 + back);
    sum + (lost + (first.1 - second.1))
}

fn product(a: Double, b: Double) -> Double {
    let high = a.0 * b.0;
    (high, a.0.mul_add(b.0, -high) + (a.0 * b.1 + a.1 * b.0))
}

#[cfg(test)]
mod tests {
    use super::{Difference, cross};
    use glam::DVec3;

    #[test]
    fn tilts_far_below_rounding_are_seen() {
        // Both start 1e3 away from the origin; their directions differ by one part in 2^60 along y.
        let p = DVec3::new(1024.0, 0.0, 0.0);
        let u = Difference::new(p, DVec3::new(1024.0, 0.0, 1.0));
        let v = Difference::new(p, DVec3::new(1024.0, 2f64.powi(-60), 1.0));
        assert_eq!(cross(&u, &v), DVec3::new(-(2f64.powi(-60)), 0.0, 0.0));
    }

    #[test]
    fn what_a_difference_loses_is_kept() {
        // 1 − 2^-60 rounds to 1; the tilt of v against u is what was lost.
        let u = Difference::new(DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0));
        let v = Difference::new(
            DVec3::new(2f64.powi(-60), 0.0, 0.0),
            DVec3::new(1.0, 1.0, 0.0),
        );
        assert_eq!(v.rounded(), DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(cross(&u, &v), DVec3::Z * 2f64.powi(-60));
    }
}
