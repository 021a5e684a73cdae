//! Placement of one frame in another: a rotation followed by a translation.

use std::ops::Mul;

use glam::{DQuat, DVec3};

/// Placement of frame `b` in frame `a`: `p_in_a = rotation · p_in_b + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Unit quaternion that turns vectors of `b` into `a`.
    pub rotation: DQuat,
    /// Origin of `b` in `a` [m].
    pub translation: DVec3,
}

impl Pose {
    /// Both frames coincide.
    pub const IDENTITY: Self = Self {
        rotation: DQuat::IDENTITY,
        translation: DVec3::ZERO,
    };

    /// From a unit rotation and the origin of `b` in `a` [m].
    pub const fn new(rotation: DQuat, translation: DVec3) -> Self {
        Self {
            rotation,
            translation,
        }
    }

    /// Parallel frames, `b`'s origin at `translation` [m].
    pub const fn from_translation(translation: DVec3) -> Self {
        Self::new(DQuat::IDENTITY, translation)
    }

    /// Common origin, `b` turned by the unit quaternion `rotation`.
    pub const fn from_rotation(rotation: DQuat) -> Self {
        Self::new(rotation, DVec3::ZERO)
    }

    /// A point of `b` [m], in `a`.
    pub fn transform_point(&self, point_in_b: DVec3) -> DVec3 {
        self.rotation * point_in_b + self.translation
    }

    /// A direction of `b`, in `a`.
    pub fn transform_vector(&self, vector_in_b: DVec3) -> DVec3 {
        self.rotation * vector_in_b
    }

    /// A point of `a` [m], in `b`.
    pub fn inverse_transform_point(&self, point_in_a: DVec3) -> DVec3 {
        self.rotation.conjugate() * (point_in_a - self.translation)
    }

    /// A direction of `a`, in `b`.
    pub fn inverse_transform_vector(&self, vector_in_a: DVec3) -> DVec3 {
        self.rotation.conjugate() * vector_in_a
    }

    /// `b_from_a`.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self::new(rotation, -(rotation * self.translation))
    }

    /// Straight line in translation, shortest arc in rotation; `t` = 0 is `self`, 1 is `end`.
    #[must_use]
    pub fn interpolate(&self, end: &Self, t: f64) -> Self {
        Self::new(
            self.rotation.slerp(end.rotation, t).normalize(),
            self.translation.lerp(end.translation, t),
        )
    }

    /// Every number is finite.
    pub fn is_finite(&self) -> bool {
        self.rotation.is_finite() && self.translation.is_finite()
    }

    /// Finite, and the quaternion's length within 1e-3 of one: [`Pose::normalized`] then loses nothing that was meant.
    pub fn is_placement(&self) -> bool {
        self.is_finite() && (self.rotation.length() - 1.0).abs() <= 1e-3
    }

    /// With the quaternion brought to unit length.
    #[must_use]
    pub fn normalized(&self) -> Self {
        Self::new(self.rotation.normalize(), self.translation)
    }
}

impl Mul for Pose {
    type Output = Self;

    /// `a_from_b * b_from_c` = `a_from_c`; the rotation is kept at unit length.
    fn mul(self, b_from_c: Self) -> Self {
        Self::new(
            (self.rotation * b_from_c.rotation).normalize(),
            self.transform_point(b_from_c.translation),
        )
    }
}

/// Axis times angle [rad] of a unit quaternion, the angle in [0, π] (logarithm of the rotation).
pub fn rotation_vector(rotation: DQuat) -> DVec3 {
    let q = if rotation.w < 0.0 {
        -rotation
    } else {
        rotation
    };
    let axis_sine = DVec3::new(q.x, q.y, q.z);
    let sine = axis_sine.length();
    // Below 1e-9 the series 2·v is exact to 1e-18 and the quotient is not defined at 0.
    if sine < 1e-9 {
        axis_sine * 2.0
    } else {
        axis_sine * (2.0 * sine.atan2(q.w) / sine)
    }
}

/// The rotation about `vector` by its length [rad] (exponential of the rotation vector).
pub fn quaternion_from_rotation_vector(vector: DVec3) -> DQuat {
    DQuat::from_scaled_axis(vector)
}

#[cfg(test)]
mod tests {
    use super::{Pose, quaternion_from_rotation_vector, rotation_vector};
    use glam::{DQuat, DVec3};

    fn sample() -> Pose {
        Pose::new(
            DQuat::from_scaled_axis(DVec3::new(0.4, -1.1, 0.7)),
            DVec3::new(0.1, -0.2, 0.3),
        )
    }

    #[test]
    fn inverse_undoes_the_placement() {
        let p = DVec3::new(-0.3, 0.8, 0.05);
        let pose = sample();
        assert!((pose.inverse_transform_point(pose.transform_point(p)) - p).length() < 1e-15);
        assert!((pose.inverse().transform_point(pose.transform_point(p)) - p).length() < 1e-15);
        assert!(((pose * pose.inverse()).transform_point(p) - p).length() < 1e-15);
    }

    #[test]
    fn product_applies_the_right_factor_first() {
        let p = DVec3::new(0.2, 0.1, -0.4);
        let other = Pose::from_translation(DVec3::X);
        let both = sample() * other;
        let expected = sample().transform_point(other.transform_point(p));
        assert!((both.transform_point(p) - expected).length() < 1e-15);
    }

    #[test]
    fn only_finite_nearly_unit_poses_are_placements() {
        let scaled = |factor: f64| Pose::new(sample().rotation * factor, sample().translation);
        assert!(sample().is_placement() && scaled(1.0005).is_placement());
        assert!(!scaled(0.5).is_placement() && !scaled(0.0).is_placement());
        assert!(!Pose::from_translation(DVec3::NAN).is_placement());
        assert!(!Pose::from_rotation(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)).is_placement());
        assert!((scaled(1.0005).normalized().rotation.length() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn rotation_vector_inverts_the_exponential() {
        for scale in [0.0, 1e-12, 1e-6, 0.3, 3.0] {
            let v = DVec3::new(0.6, -0.48, 0.64) * scale;
            let back = rotation_vector(quaternion_from_rotation_vector(v));
            assert!((back - v).length() <= 1e-12 * scale.max(1e-3), "{scale}");
        }
        let long_way = -quaternion_from_rotation_vector(DVec3::X * 0.2);
        assert!((rotation_vector(long_way) - DVec3::X * 0.2).length() < 1e-15);
    }
}
