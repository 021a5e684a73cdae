//! Velocity and load of a rigid body.

use std::ops::{Add, AddAssign, Neg};

use glam::DVec3;

/// Velocity of a body: that of its reference point, and its turning rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// Velocity of the reference point [m/s].
    pub linear: DVec3,
    /// Angular velocity [rad/s].
    pub angular: DVec3,
}

impl Twist {
    /// At rest.
    pub const ZERO: Self = Self {
        linear: DVec3::ZERO,
        angular: DVec3::ZERO,
    };
}

/// Force and torque about a reference point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force [N].
    pub force: DVec3,
    /// Torque about the reference point [N·m].
    pub torque: DVec3,
}

impl Wrench {
    /// No load.
    pub const ZERO: Self = Self {
        force: DVec3::ZERO,
        torque: DVec3::ZERO,
    };

    /// A force [N] whose line of action passes through `lever` [m] from the reference point.
    pub fn from_force_at(force: DVec3, lever: DVec3) -> Self {
        Self {
            force,
            torque: lever.cross(force),
        }
    }

    /// The same load about a reference point moved by `offset` [m].
    #[must_use]
    pub fn about(&self, offset: DVec3) -> Self {
        Self {
            force: self.force,
            torque: self.torque - offset.cross(self.force),
        }
    }

    /// Every number is finite.
    pub fn is_finite(&self) -> bool {
        self.force.is_finite() && self.torque.is_finite()
    }
}

impl Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            torque: self.torque + other.torque,
        }
    }
}

impl AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Neg for Wrench {
    type Output = Self;

    fn neg(self) -> Self {
        Self {
            force: -self.force,
            torque: -self.torque,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Wrench;
    use glam::DVec3;

    #[test]
    fn moving_the_reference_point_to_the_line_of_action_leaves_no_torque() {
        let lever = DVec3::new(0.1, -0.3, 0.2);
        let wrench = Wrench::from_force_at(DVec3::new(2.0, 1.0, -4.0), lever);
        assert!(wrench.torque.length() > 0.1);
        assert!(wrench.about(lever).torque.length() < 1e-15);
    }
}
