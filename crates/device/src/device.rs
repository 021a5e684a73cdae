//! What every haptic device offers: a description of itself, a reading, a command.

use glam::DVec3;
use pliant_spatial::{Pose, Twist, Wrench};

use crate::DeviceError;

/// A device that measures a handle and may push back on it.
///
/// Frame `device` is fixed to the base of the device, `handle` to the part that is held. Implementations are owned by one
/// caller; `Send` lets it be a thread of its own.
pub trait HapticDevice: Send {
    /// What the device is and what it can render; constant while the device lives.
    fn info(&self) -> &DeviceInfo;

    /// The state of the handle at `time_s` [s], counted from the first tick. Simulated devices compute their state from it,
    /// hardware delivers its latest sample. Times never decrease between calls.
    ///
    /// # Errors
    /// See [`DeviceError`]; after an error the caller has no pose for this time and must not go on rendering the old one.
    fn read(&mut self, time_s: f64) -> Result<DeviceState, DeviceError>;

    /// Commands the wrench that acts on the hand: device axes, torque about the handle origin. It holds until the next
    /// call. A device renders the part that its actuated axes span, up to its limits.
    ///
    /// # Errors
    /// [`DeviceError::InvalidCommand`] when a number is not finite; the command before it stays. Others as for `read`.
    fn write(&mut self, wrench: &Wrench) -> Result<(), DeviceError>;
}

/// One reading of a device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeviceState {
    /// `device_from_handle`: placement of the handle in the frame of the device [m].
    pub pose: Pose,
    /// Velocity of the handle origin [m/s] and turning rate [rad/s], in device axes.
    pub twist: Twist,
    /// Bit `k` is set while button `k` is pressed.
    pub buttons: u32,
}

/// What a device is and what it can do, in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub struct DeviceInfo {
    /// Name for people, such as a model name.
    pub name: String,
    /// How the device comes by its motion.
    pub kind: DeviceKind,
    /// What it measures.
    pub sensed: Axes,
    /// What it can push against; [`Axes::None`] when it renders nothing.
    pub actuated: Axes,
    /// Largest force it renders [N]; 0 when it renders none.
    pub max_force: f64,
    /// Largest torque it renders [N·m]; 0 when it renders none.
    pub max_torque: f64,
    /// Largest stiffness that stays stable on it [N/m]. Infinite where force cannot act back on the motion, since then
    /// nothing can become unstable.
    pub max_stiffness: f64,
    /// Largest damping that may be commanded to it [N·s/m]; infinite as for stiffness.
    pub max_damping: f64,
    /// Edge lengths of the box within which the handle moves, along the device axes [m].
    pub workspace_size: DVec3,
}

/// How a device comes by its motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum DeviceKind {
    /// Plays a given motion whatever force it is sent (open loop).
    Scripted,
    /// Computes its motion from the force it is sent (closed loop).
    Simulated,
    /// Hardware, held by a hand.
    Physical,
}

/// Directions of motion that a device measures or drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Axes {
    /// None.
    None,
    /// The three translations.
    Translation,
    /// Three translations and three rotations.
    TranslationAndRotation,
}
