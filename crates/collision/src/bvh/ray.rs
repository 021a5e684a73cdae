//! A ray against the boxes of a tree.

use glam::DVec3;

use super::frame::{SLACK, UnitBox};

/// A ray in the unit frame.
pub(super) struct UnitRay {
    origin: DVec3,
    direction: DVec3,
    /// Widens the boxes against rounding of the slab test.
    pub(super) slack: f64,
}

impl UnitRay {
    pub(super) fn new(origin: DVec3, direction: DVec3) -> Self {
        Self {
            origin,
            direction,
            slack: SLACK * (1.0 + origin.abs().max_element()),
        }
    }

    /// Distance at which the ray enters a box, 0 from inside, infinite if it passes by.
    pub(super) fn entry(&self, bounds: &UnitBox) -> f64 {
        let (min, max) = bounds.corners();
        slabs(
            min - self.origin - self.slack,
            max - self.origin + self.slack,
            self.direction,
        )
    }
}

/// Where the line `t · direction`, t ≥ 0, enters the box from `low` to `high`; infinite if it does not.
pub(crate) fn slabs(low: DVec3, high: DVec3, direction: DVec3) -> f64 {
    let (mut entry, mut exit) = (0.0, f64::INFINITY);
    for axis in 0..3 {
        let slope = direction[axis];
        if slope == 0.0 {
            if low[axis] > 0.0 || high[axis] < 0.0 {
                return f64::INFINITY;
            }
            continue;
        }
        let (t0, t1) = (low[axis] / slope, high[axis] / slope);
        entry = f64::max(entry, t0.min(t1));
        exit = f64::min(exit, t0.max(t1));
    }
    if entry <= exit { entry } else { f64::INFINITY }
}
