//! Why samples do not make a trajectory.

use pliant_spatial::Pose;
use thiserror::Error;

/// Why samples, or a change of a trajectory, are refused. Rows are counted from 0 in the order given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TrajectoryError {
    /// There is no sample.
    #[error("the trajectory has no samples; give at least one pose")]
    Empty,
    /// A number is NaN or infinite.
    #[error(
        "trajectory sample {row} (counted from 0): {quantity} is {value:?}; give a finite number"
    )]
    NotFinite {
        /// Sample.
        row: usize,
        /// Which of its numbers.
        quantity: &'static str,
        /// The number as given.
        value: f64,
    },
    /// A number is so large that its unit cannot be right.
    #[error(
        "trajectory sample {row} (counted from 0): {quantity} is {value:?}, beyond ±{limit}; \
         times are in seconds and positions in metres"
    )]
    OutOfRange {
        /// Sample.
        row: usize,
        /// Which of its numbers.
        quantity: &'static str,
        /// The number as given or computed.
        value: f64,
        /// Largest magnitude accepted.
        limit: f64,
    },
    /// A time lies before that of the sample before it.
    #[error(
        "trajectory sample {row} (counted from 0): time {time:?} s is before {previous:?} s of the sample before it; \
         sort the samples by time"
    )]
    OutOfOrder {
        /// Sample.
        row: usize,
        /// Its time [s].
        time: f64,
        /// Time of the sample before it [s].
        previous: f64,
    },
    /// A quaternion is no rotation.
    #[error(
        "trajectory sample {row} (counted from 0): the quaternion has norm {norm:?}, a rotation has 1 (within {}); \
         check the column order qx, qy, qz, qw",
        super::QUATERNION_TOLERANCE
    )]
    Quaternion {
        /// Sample.
        row: usize,
        /// Length of its quaternion.
        norm: f64,
    },
    /// A scale or speed is zero, negative or not finite.
    #[error("trajectory {name} is {value:?}; it must be a finite number above zero")]
    NotPositive {
        /// `scale` or `speed`.
        name: &'static str,
        /// The number as given.
        value: f64,
    },
    /// A speed so extreme that the times of two samples would coincide or leave the range of times.
    #[error(
        "trajectory speed {speed:?} leaves no usable times between samples; choose one nearer 1"
    )]
    Speed {
        /// The speed as given.
        speed: f64,
    },
    /// The placement given is not a placement.
    #[error(
        "trajectory placement must have finite numbers and a unit quaternion; the norm of its quaternion is {:?}, its \
         translation is ({:?}, {:?}, {:?}) m",
        pose.rotation.length(), pose.translation.x, pose.translation.y, pose.translation.z
    )]
    Placement {
        /// The placement as given.
        pose: Pose,
    },
}

impl TrajectoryError {
    /// The sample at fault, counted from 0, when one is.
    pub fn row(&self) -> Option<usize> {
        match *self {
            Self::NotFinite { row, .. }
            | Self::OutOfRange { row, .. }
            | Self::OutOfOrder { row, .. }
            | Self::Quaternion { row, .. } => Some(row),
            Self::Empty
            | Self::NotPositive { .. }
            | Self::Speed { .. }
            | Self::Placement { .. } => None,
        }
    }
}
