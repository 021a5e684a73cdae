//! Axis-aligned boxes.

use glam::DVec3;

/// Axis-aligned box between two corners [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates [m].
    pub min: DVec3,
    /// Largest coordinates [m].
    pub max: DVec3,
}

impl Aabb {
    /// Holds nothing: the neutral element of [`Aabb::including`] and [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// Smallest box around points [m]; [`Aabb::EMPTY`] for none.
    pub fn from_points(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |b, &p| b.including(p))
    }

    /// Grown to hold `point` [m].
    #[must_use]
    pub fn including(&self, point: DVec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// Smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Every side moved out by `margin` [m].
    #[must_use]
    pub fn inflated(&self, margin: f64) -> Self {
        Self {
            min: self.min - margin,
            max: self.max + margin,
        }
    }

    /// Edge lengths [m].
    pub fn size(&self) -> DVec3 {
        self.max - self.min
    }

    /// Middle [m].
    pub fn center(&self) -> DVec3 {
        0.5 * (self.min + self.max)
    }

    /// Length of the space diagonal [m]: the size that relative tolerances refer to.
    pub fn diagonal(&self) -> f64 {
        self.size().length()
    }

    /// `point` [m] is inside or on the border.
    pub fn contains(&self, point: DVec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// The boxes share at least a point.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }
}

#[cfg(test)]
mod tests {
    use super::Aabb;
    use glam::DVec3;

    #[test]
    fn union_holds_both_and_empty_is_neutral() {
        let a = Aabb::from_points(&[DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)]);
        let b = Aabb::from_points(&[DVec3::new(-1.0, 5.0, 1.0)]);
        let u = a.union(&b);
        assert!(u.contains(DVec3::ZERO) && u.contains(b.min) && !a.contains(b.min));
        assert_eq!(u.size(), DVec3::new(2.0, 5.0, 3.0));
        assert_eq!(a.union(&Aabb::EMPTY), a);
        assert!(!a.overlaps(&b) && a.inflated(3.0).overlaps(&b));
        assert!(!Aabb::EMPTY.overlaps(&a));
    }
}
