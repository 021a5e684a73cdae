//! A device that plays a recorded or computed motion.

use glam::DVec3;
use pliant_spatial::Wrench;

use crate::{Axes, DeviceError, DeviceInfo, DeviceKind, DeviceState, HapticDevice, Trajectory};

/// Plays a [`Trajectory`] open loop: time 0 of the caller is the start of the trajectory, and after its end the last pose
/// is held. It renders no force and says so; what it is sent is kept for inspection.
#[derive(Clone, Debug)]
pub struct ScriptedDevice {
    info: DeviceInfo,
    trajectory: Trajectory,
    last_wrench: Wrench,
}

impl ScriptedDevice {
    /// A device called `name` that plays `trajectory` (`device_from_handle` over time).
    pub fn new(name: impl Into<String>, trajectory: Trajectory) -> Self {
        let (mut lowest, mut highest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for sample in trajectory.knots() {
            lowest = lowest.min(sample.pose.translation);
            highest = highest.max(sample.pose.translation);
        }
        let info = DeviceInfo {
            name: name.into(),
            kind: DeviceKind::Scripted,
            sensed: Axes::TranslationAndRotation,
            actuated: Axes::None,
            max_force: 0.0,
            max_torque: 0.0,
            max_stiffness: f64::INFINITY,
            max_damping: f64::INFINITY,
            workspace_size: highest - lowest,
        };
        Self {
            info,
            trajectory,
            last_wrench: Wrench::ZERO,
        }
    }

    /// The motion that is played.
    pub fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// The wrench last sent, in device axes, torque about the handle origin [N, N·m]; zero before the first.
    pub fn last_wrench(&self) -> Wrench {
        self.last_wrench
    }
}

impl HapticDevice for ScriptedDevice {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    /// Allocates nothing.
    fn read(&mut self, time_s: f64) -> Result<DeviceState, DeviceError> {
        if !time_s.is_finite() {
            return Err(DeviceError::InvalidTime {
                device: self.info.name.clone(),
                time_s,
            });
        }
        let (pose, twist) = self.trajectory.sample(self.trajectory.start() + time_s);
        Ok(DeviceState {
            pose,
            twist,
            buttons: 0,
        })
    }

    /// Allocates nothing.
    fn write(&mut self, wrench: &Wrench) -> Result<(), DeviceError> {
        if !wrench.is_finite() {
            return Err(DeviceError::InvalidCommand {
                device: self.info.name.clone(),
                wrench: *wrench,
            });
        }
        self.last_wrench = *wrench;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::ScriptedDevice;
    use crate::{Axes, DeviceError, HapticDevice, TimedPose, Trajectory};
    use glam::DVec3;
    use pliant_spatial::{Pose, Twist, Wrench};

    fn device() -> ScriptedDevice {
        let samples = [5.0, 6.0, 7.0].map(|time| TimedPose {
            time,
            pose: Pose::from_translation(DVec3::new(0.1 * time, 0.0, -0.2 * time)),
        });
        ScriptedDevice::new("line", Trajectory::new(&samples).unwrap())
    }

    #[test]
    fn time_zero_is_the_first_sample_and_the_end_is_held() {
        let mut device = device();
        let first = device.read(0.0).unwrap();
        assert!((first.pose.translation - DVec3::new(0.5, 0.0, -1.0)).length() < 1e-15);
        assert!((first.twist.linear - DVec3::new(0.1, 0.0, -0.2)).length() < 1e-14);
        let after = device.read(10.0).unwrap();
        assert!((after.pose.translation - DVec3::new(0.7, 0.0, -1.4)).length() < 1e-15);
        assert_eq!(after.twist, Twist::ZERO);
    }

    #[test]
    fn motion_ignores_force_and_the_info_says_that_none_is_rendered() {
        let (mut pushed, mut free) = (device(), device());
        let wrench = Wrench::from_force_at(DVec3::new(5.0, 0.0, 0.0), DVec3::Y);
        pushed.write(&wrench).unwrap();
        assert_eq!(pushed.last_wrench(), wrench);
        assert_eq!(pushed.read(0.7).unwrap(), free.read(0.7).unwrap());
        assert_eq!(pushed.info().actuated, Axes::None);
        assert_eq!(
            (pushed.info().max_force, pushed.info().max_torque),
            (0.0, 0.0)
        );
        let size = pushed.info().workspace_size;
        assert!((size - DVec3::new(0.2, 0.0, 0.4)).length() < 1e-15);
    }

    #[test]
    fn what_is_not_finite_is_refused_and_changes_nothing() {
        let mut device = device();
        let good = Wrench::from_force_at(DVec3::X, DVec3::ZERO);
        device.write(&good).unwrap();
        let bad = Wrench::from_force_at(DVec3::new(0.0, f64::NAN, 0.0), DVec3::ZERO);
        assert!(matches!(
            device.write(&bad),
            Err(DeviceError::InvalidCommand { .. })
        ));
        assert_eq!(device.last_wrench(), good);
        assert!(matches!(
            device.read(f64::NAN),
            Err(DeviceError::InvalidTime { .. })
        ));
    }
}
