//! One vocabulary of failures for all devices; each kind is one that a caller can act on.

use thiserror::Error;

/// Why a device gave no state or took no command.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DeviceError {
    /// The device is gone.
    #[error("device `{device}` is disconnected; plug it in again and restart the session")]
    Disconnected {
        /// Name of the device.
        device: String,
    },
    /// The device is there but did not answer in time.
    #[error(
        "device `{device}` sent nothing for {waited_s:?} s; check its cable and power, then re-arm it"
    )]
    TimedOut {
        /// Name of the device.
        device: String,
        /// How long the caller waited [s].
        waited_s: f64,
    },
    /// The system refuses access to the device.
    #[error("no access to device `{device}`: {remedy}")]
    AccessDenied {
        /// Name of the device.
        device: String,
        /// What the user has to do, in words.
        remedy: String,
    },
    /// The device cannot be used before something is done to it.
    #[error("device `{device}` is not ready: {remedy}")]
    NotReady {
        /// Name of the device.
        device: String,
        /// What the user has to do, in words.
        remedy: String,
    },
    /// The device answered, but not with a state that can be true.
    #[error(
        "device `{device}` sent an unusable sample: {reason}; render no force until a good one arrives"
    )]
    InvalidSample {
        /// Name of the device.
        device: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The commanded wrench cannot be rendered.
    #[error(
        "device `{device}` was commanded a wrench that is not finite: force ({:?}, {:?}, {:?}) N, torque ({:?}, {:?}, {:?}) N·m; \
         the command before it stays, send a finite one",
        wrench.force.x, wrench.force.y, wrench.force.z, wrench.torque.x, wrench.torque.y, wrench.torque.z
    )]
    InvalidCommand {
        /// Name of the device.
        device: String,
        /// The wrench as commanded, in device axes [N, N·m].
        wrench: pliant_spatial::Wrench,
    },
    /// A simulated device was asked for a time that is none.
    #[error("device `{device}` was read at {time_s:?} s; read it at a finite time")]
    InvalidTime {
        /// Name of the device.
        device: String,
        /// The time as given [s].
        time_s: f64,
    },
}
