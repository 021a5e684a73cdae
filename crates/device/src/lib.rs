//! Haptic devices as the servo sees them, the map between their workspace and the world, and scripted motion.
//!
//! A device is read for a pose and written a wrench, both in its own frame and SI units. It knows no world, no contact and
//! no clock: whoever drives it says what time it is. [`WorkspaceMap`] is the only place where device and world frames meet.

mod device;
mod error;
mod scripted;
mod trajectory;
mod workspace;

pub use device::{Axes, DeviceInfo, DeviceKind, DeviceState, HapticDevice};
pub use error::DeviceError;
pub use scripted::ScriptedDevice;
pub use trajectory::{MergeReport, QUATERNION_TOLERANCE, TimedPose, Trajectory, TrajectoryError};
pub use workspace::{WorkspaceMap, WorkspaceMapError};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
