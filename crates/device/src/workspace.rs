//! The map between the frame of a device and the world.
//!
//! Lengths grow by the position scale s (world per device), forces by the force scale f (device per world), angles stay.
//! A spring of stiffness `K_world` therefore feels like `K_device` = s·f·`K_world`.
//!
//! Torque takes the factor f/s: a lever of length l in the world is l/s at the device, and the force on it is f times
//! that of the world. With this factor the power of torque and of force changes alike, by f/s, so that a passive world
//! stays passive at the device; s and f applied to force alone would create or destroy energy in a turn.

use pliant_spatial::{Pose, Twist, Wrench};
use thiserror::Error;

use crate::DeviceState;

/// Placement and scale of a device in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkspaceMap {
    world_from_device: Pose,
    position_scale: f64,
    force_scale: f64,
}

/// Why a workspace map is refused.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum WorkspaceMapError {
    /// A scale is zero, negative or not finite.
    #[error("workspace map: {name} is {value:?}; it must be a finite number above zero")]
    Scale {
        /// `position_scale` or `force_scale`.
        name: &'static str,
        /// The value as given.
        value: f64,
    },
    /// The placement is not finite or its quaternion is not of unit length.
    #[error(
        "workspace map: world_from_device must have finite numbers and a unit quaternion; \
         its quaternion (x, y, z, w) = ({:?}, {:?}, {:?}, {:?}) has norm {:?}, its translation is ({:?}, {:?}, {:?}) m",
        pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w, pose.rotation.length(),
        pose.translation.x, pose.translation.y, pose.translation.z
    )]
    Placement {
        /// The placement as given.
        pose: Pose,
    },
}

impl WorkspaceMap {
    /// Device and world coincide, both scales are 1.
    pub const IDENTITY: Self = Self {
        world_from_device: Pose::IDENTITY,
        position_scale: 1.0,
        force_scale: 1.0,
    };

    /// A device whose origin and axes lie at `world_from_device` [m], with s = `position_scale` (world per device) and
    /// f = `force_scale` (device per world). The quaternion may be off unit length by
    /// [`QUATERNION_TOLERANCE`](crate::QUATERNION_TOLERANCE) and is then normalised.
    ///
    /// # Errors
    /// [`WorkspaceMapError`] when a scale is not a finite number above zero or the placement is not one.
    pub fn new(
        world_from_device: Pose,
        position_scale: f64,
        force_scale: f64,
    ) -> Result<Self, WorkspaceMapError> {
        for (name, value) in [
            ("position_scale", position_scale),
            ("force_scale", force_scale),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(WorkspaceMapError::Scale { name, value });
            }
        }
        let rotation = world_from_device.rotation;
        let norm_error = (rotation.length() - 1.0).abs();
        if !world_from_device.is_finite() || norm_error > crate::QUATERNION_TOLERANCE {
            return Err(WorkspaceMapError::Placement {
                pose: world_from_device,
            });
        }
        Ok(Self {
            world_from_device: Pose::new(rotation.normalize(), world_from_device.translation),
            position_scale,
            force_scale,
        })
    }

    /// Placement of the device frame in the world [m].
    pub fn world_from_device(&self) -> Pose {
        self.world_from_device
    }

    /// s: length in the world per length at the device.
    pub fn position_scale(&self) -> f64 {
        self.position_scale
    }

    /// f: force at the device per force in the world.
    pub fn force_scale(&self) -> f64 {
        self.force_scale
    }

    /// `world_from_handle` of a handle at `device_from_handle`. Allocates nothing.
    pub fn pose_to_world(&self, device_from_handle: &Pose) -> Pose {
        self.world_from_device
            * Pose::new(
                device_from_handle.rotation,
                device_from_handle.translation * self.position_scale,
            )
    }

    /// `device_from_handle` of a handle at `world_from_handle`: undoes [`Self::pose_to_world`]. Allocates nothing.
    pub fn pose_to_device(&self, world_from_handle: &Pose) -> Pose {
        let scaled = self.world_from_device.inverse() * *world_from_handle;
        Pose::new(scaled.rotation, scaled.translation / self.position_scale)
    }

    /// A velocity in device axes, in world axes and world lengths. Allocates nothing.
    pub fn twist_to_world(&self, twist: &Twist) -> Twist {
        Twist {
            linear: self
                .world_from_device
                .transform_vector(twist.linear * self.position_scale),
            angular: self.world_from_device.transform_vector(twist.angular),
        }
    }

    /// A device reading in the world; the buttons stay. Allocates nothing.
    pub fn state_to_world(&self, state: &DeviceState) -> DeviceState {
        DeviceState {
            pose: self.pose_to_world(&state.pose),
            twist: self.twist_to_world(&state.twist),
            buttons: state.buttons,
        }
    }

    /// A wrench in world axes about the handle origin, in device axes about the handle origin: force times f, torque times
    /// f/s (why: see the head of this file). Allocates nothing.
    pub fn wrench_to_device(&self, wrench: &Wrench) -> Wrench {
        let torque_scale = self.force_scale / self.position_scale;
        Wrench {
            force: self
                .world_from_device
                .inverse_transform_vector(wrench.force)
                * self.force_scale,
            torque: self
                .world_from_device
                .inverse_transform_vector(wrench.torque)
                * torque_scale,
        }
    }

    /// What a spring of `world_stiffness` [N/m] feels like at the device [N/m]: s·f·K.
    pub fn stiffness_to_device(&self, world_stiffness: f64) -> f64 {
        self.position_scale * self.force_scale * world_stiffness
    }
}

impl Default for WorkspaceMap {
    fn default() -> Self {
        Self::IDENTITY
    }
}

#[cfg(test)]
mod tests {
    use super::{WorkspaceMap, WorkspaceMapError};
    use glam::{DQuat, DVec3};
    use pliant_spatial::{Pose, Twist, Wrench, quaternion_from_rotation_vector};

    const S: f64 = 3.0;
    const F: f64 = 0.25;

    fn map() -> WorkspaceMap {
        let pose = Pose::new(
            DQuat::from_scaled_axis(DVec3::new(0.9, -0.4, 1.3)),
            DVec3::new(0.3, -0.1, 0.7),
        );
        WorkspaceMap::new(pose, S, F).unwrap()
    }

    fn handle() -> Pose {
        Pose::new(
            DQuat::from_scaled_axis(DVec3::new(-0.2, 1.1, 0.5)),
            DVec3::new(0.04, 0.02, -0.05),
        )
    }

    #[test]
    fn device_lengths_grow_by_s_and_the_inverse_undoes_it() {
        let map = map();
        let moved = Pose::new(handle().rotation, handle().translation + DVec3::X * 0.01);
        let step = map.pose_to_world(&moved).translation - map.pose_to_world(&handle()).translation;
        assert!((step.length() - S * 0.01).abs() < 1e-15);
        let back = map.pose_to_device(&map.pose_to_world(&handle()));
        assert!((back.translation - handle().translation).length() < 1e-15);
        assert!(back.rotation.dot(handle().rotation).abs() > 1.0 - 1e-15);
    }

    #[test]
    fn twist_is_the_derivative_of_the_mapped_pose() {
        let (map, dt) = (map(), 1e-6);
        let twist = Twist {
            linear: DVec3::new(0.2, -0.5, 0.3),
            angular: DVec3::new(1.0, 2.0, -0.7),
        };
        let at = |t: f64| {
            map.pose_to_world(&Pose::new(
                quaternion_from_rotation_vector(twist.angular * t) * handle().rotation,
                handle().translation + twist.linear * t,
            ))
        };
        let (before, after) = (at(-dt), at(dt));
        let mapped = map.twist_to_world(&twist);
        let linear = (after.translation - before.translation) / (2.0 * dt);
        let turn = after.rotation * before.rotation.conjugate();
        let angular = pliant_spatial::rotation_vector(turn) / (2.0 * dt);
        assert!((mapped.linear - linear).length() < 1e-8);
        assert!((mapped.angular - angular).length() < 1e-8);
    }

    #[test]
    fn a_world_spring_feels_s_f_times_as_stiff() {
        let (map, stiffness) = (map(), 800.0);
        let anchor = map.pose_to_world(&handle()).translation;
        let offset = DVec3::new(0.002, -0.001, 0.003);
        let moved = Pose::new(handle().rotation, handle().translation + offset);
        let force = (map.pose_to_world(&moved).translation - anchor) * -stiffness;
        let felt = map.wrench_to_device(&Wrench::from_force_at(force, DVec3::ZERO));
        let expected = offset * -(S * F * stiffness);
        assert!((felt.force - expected).length() < 1e-12);
        assert!((map.stiffness_to_device(stiffness) - S * F * stiffness).abs() < 1e-12);
    }

    #[test]
    fn power_of_force_and_of_torque_changes_by_the_same_factor() {
        let map = map();
        let twist = Twist {
            linear: DVec3::new(0.2, -0.5, 0.3),
            angular: DVec3::new(1.0, 2.0, -0.7),
        };
        let wrench = Wrench {
            force: DVec3::new(1.0, 4.0, -2.0),
            torque: DVec3::new(0.1, -0.3, 0.2),
        };
        let world = map.twist_to_world(&twist);
        let device = map.wrench_to_device(&wrench);
        let linear = (
            device.force.dot(twist.linear),
            wrench.force.dot(world.linear),
        );
        let angular = (
            device.torque.dot(twist.angular),
            wrench.torque.dot(world.angular),
        );
        assert!(linear.1.abs() > 0.01 && angular.1.abs() > 0.01);
        assert!((linear.0 - F / S * linear.1).abs() < 1e-15);
        assert!((angular.0 - F / S * angular.1).abs() < 1e-15);
    }

    #[test]
    fn torque_is_that_of_the_scaled_force_on_the_scaled_lever() {
        let map = map();
        let (force, lever) = (DVec3::new(1.0, -2.0, 0.5), DVec3::new(0.1, 0.05, -0.02));
        let felt = map.wrench_to_device(&Wrench::from_force_at(force, lever));
        let lever_at_device = map.world_from_device().inverse_transform_vector(lever) / S;
        let expected = Wrench::from_force_at(felt.force, lever_at_device);
        assert!((felt.torque - expected.torque).length() < 1e-16);
    }

    #[test]
    fn bad_scales_and_placements_are_refused_by_name() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let position = WorkspaceMap::new(Pose::IDENTITY, bad, 1.0);
            assert!(position.unwrap_err().to_string().contains("position_scale"));
            let force = WorkspaceMap::new(Pose::IDENTITY, 1.0, bad);
            assert!(force.unwrap_err().to_string().contains("force_scale"));
        }
        for pose in [
            Pose::from_translation(DVec3::new(f64::NAN, 0.0, 0.0)),
            Pose::from_rotation(DQuat::from_xyzw(0.0, 0.0, 0.0, 1.1)),
        ] {
            let refused = WorkspaceMap::new(pose, 1.0, 1.0);
            assert!(matches!(refused, Err(WorkspaceMapError::Placement { .. })));
        }
    }
}
