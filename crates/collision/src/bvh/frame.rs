//! Boxes in `f32`, rounded outward, in a frame where the whole has size about one.
//!
//! Both steps from metres, the map into the unit frame and the rounding, are monotone: boxes that meet in `f64` meet here,
//! also where they only touch. A distance between mapped boxes is a lower bound of the true one up to [`SLACK`].

use glam::{DVec3, Vec3A};
use pliant_mesh::Aabb;

/// Slack of comparisons in the unit frame, relative to the largest coordinate: a hundred units in the last place of
/// `f64`, far below the `f32` rounding of the boxes.
pub(crate) const SLACK: f64 = 2e-14;

/// Coordinates of boxes are cut here, far outside the unit frame, so that areas stay finite in `f32` also for unbounded
/// boxes. Cutting is monotone and shortens distances only.
const EDGE: f64 = 1e15;

/// A box in the unit frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct UnitBox {
    pub(crate) min: [f32; 3],
    pub(crate) max: [f32; 3],
}

/// Monotone map from metres to a frame in which the content has size about one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct UnitFrame {
    pub(crate) centre: DVec3,
    pub(crate) per_metre: f64,
}

impl UnitFrame {
    /// The frame that brings `bounds` to [−1, 1]; that of metres where it is empty, unbounded or a point.
    pub(super) fn around(bounds: &Aabb) -> Self {
        let half = 0.5 * bounds.size().max_element();
        if half.is_finite() && half >= 0.0 {
            let per_metre = if half.is_normal() { 1.0 / half } else { 1.0 };
            Self {
                centre: bounds.center(),
                per_metre,
            }
        } else {
            Self {
                centre: DVec3::ZERO,
                per_metre: 1.0,
            }
        }
    }

    /// A point [m] in the unit frame.
    pub(crate) fn point(&self, point: DVec3) -> DVec3 {
        (point - self.centre) * self.per_metre
    }

    /// A corner of a box [m], cut to the frame's edge.
    pub(super) fn corner(&self, corner: DVec3) -> DVec3 {
        self.point(corner)
            .clamp(DVec3::splat(-EDGE), DVec3::splat(EDGE))
    }

    /// The `f32` box around a box [m]; [`UnitBox::EMPTY`] for an empty one or NaN (collision.40).
    pub(super) fn enclose(&self, bounds: &Aabb) -> UnitBox {
        if !bounds.min.cmple(bounds.max).all() {
            return UnitBox::EMPTY;
        }
        UnitBox {
            min: self
                .corner(bounds.min)
                .as_vec3()
                .to_array()
                .map(f32::next_down),
            max: self
                .corner(bounds.max)
                .as_vec3()
                .to_array()
                .map(f32::next_up),
        }
    }
}

impl UnitBox {
    /// Holds nothing.
    pub(super) const EMPTY: Self = Self {
        min: [f32::INFINITY; 3],
        max: [f32::NEG_INFINITY; 3],
    };

    pub(crate) fn corners(&self) -> (DVec3, DVec3) {
        (
            DVec3::from_array(self.min.map(f64::from)),
            DVec3::from_array(self.max.map(f64::from)),
        )
    }

    /// Where the box is, roughly, for builders that cannot do with infinite numbers.
    pub(super) fn or_origin(self) -> Self {
        if self.min[0].is_finite() {
            return self;
        }
        Self {
            min: [0.0; 3],
            max: [0.0; 3],
        }
    }

    pub(super) fn union(&self, other: &Self) -> Self {
        let pick = |of: fn(f32, f32) -> f32, a: [f32; 3], b: [f32; 3]| {
            [of(a[0], b[0]), of(a[1], b[1]), of(a[2], b[2])]
        };
        Self {
            min: pick(f32::min, self.min, other.min),
            max: pick(f32::max, self.max, other.max),
        }
    }
}

impl UnitBox {
    /// The box as obvhs has it.
    pub(super) fn to_obvhs(self) -> obvhs::aabb::Aabb {
        obvhs::aabb::Aabb {
            min: Vec3A::from_array(self.min),
            max: Vec3A::from_array(self.max),
        }
    }
}
