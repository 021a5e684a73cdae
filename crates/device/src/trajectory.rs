//! Motion of a frame over time, from samples at any times.
//!
//! Position is the natural C² cubic spline through the samples, per axis; orientation turns at constant rate about a
//! fixed axis from one sample to the next (slerp; Shoemake, SIGGRAPH 1985), so angular velocity is constant per segment
//! and jumps at samples. Coinciding and nearly coinciding time stamps are averaged first (rules in `merge`).

mod error;
mod merge;
mod spline;
#[cfg(test)]
mod tests;

use glam::{DQuat, DVec3};
use pliant_spatial::{Pose, Twist, quaternion_from_rotation_vector, rotation_vector};

pub use error::TrajectoryError;
pub use merge::MergeReport;
use spline::SplineEnd;

/// Quaternions whose length is within this of 1 are normalised, others refused: room for three printed decimals, none
/// for exchanged columns or angles in degrees.
pub const QUATERNION_TOLERANCE: f64 = 1e-3;

/// Largest magnitude of a time stamp [s]: 30,000 years, where a stamp still resolves 0.1 ms.
const MAX_TIME: f64 = 1e12;

/// Largest magnitude of a coordinate [m]; beyond it the unit is wrong, and differences would lose the nanometre.
const MAX_COORDINATE: f64 = 1e6;

/// A pose at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimedPose {
    /// [s]
    pub time: f64,
    /// Placement of the moving frame in its reference frame [m].
    pub pose: Pose,
}

/// Motion of a frame, defined at all times: before the first and after the last sample it rests there.
#[derive(Clone, Debug, PartialEq)]
pub struct Trajectory {
    knots: Vec<Knot>,
    merged: MergeReport,
}

/// A sample with what the curve needs from its knot to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Knot {
    /// [s]
    time: f64,
    /// [m]
    position: DVec3,
    /// Second derivative of the position [m/s²].
    second: DVec3,
    /// Unit; in the same half-space as that of the knot before.
    rotation: DQuat,
    /// From here to the next knot, in reference axes [rad/s]; zero at the last.
    angular_velocity: DVec3,
}

impl Trajectory {
    /// Through `samples`, in order of time. Time stamps that coincide within 1e-9 s are averaged into one sample, and so
    /// are near-coincidences (a gap below 5 % of the median of the nine gaps around it) that would make the curve swing
    /// out; [`Self::merged`] tells how many.
    ///
    /// # Errors
    /// [`TrajectoryError`] names the sample: none at all, numbers that are not finite or beyond 1e12 s or 1e6 m, times
    /// out of order, quaternions off unit length by more than [`QUATERNION_TOLERANCE`].
    pub fn new(samples: &[TimedPose]) -> Result<Self, TrajectoryError> {
        let checked = check(samples)?;
        let (merged_samples, merged) = merge::merge(&checked);
        Ok(Self {
            knots: knots(&merged_samples),
            merged,
        })
    }

    /// Pose [m] and velocity [m/s, rad/s, reference axes] at `time` [s]. Outside the samples: the first or last pose, at
    /// rest (a NaN counts as before the first). At a sample the turning rate is that of the segment which begins there.
    /// Allocates nothing; O(log n).
    pub fn sample(&self, time: f64) -> (Pose, Twist) {
        let first = &self.knots[0];
        let last = &self.knots[self.knots.len() - 1];
        if time > last.time {
            return (last.pose(), Twist::ZERO);
        }
        if self.knots.len() == 1 || time.is_nan() || time < first.time {
            return (first.pose(), Twist::ZERO);
        }
        let after = self.knots.partition_point(|knot| knot.time <= time);
        let segment = after.clamp(1, self.knots.len() - 1) - 1;
        let (start, end) = (&self.knots[segment], &self.knots[segment + 1]);
        let (position, linear) = spline::evaluate(&start.spline_end(), &end.spline_end(), time);
        let turn = quaternion_from_rotation_vector(start.angular_velocity * (time - start.time));
        let pose = Pose::new((turn * start.rotation).normalize(), position);
        let twist = Twist {
            linear,
            angular: start.angular_velocity,
        };
        (pose, twist)
    }

    /// Time of the first sample [s].
    pub fn start(&self) -> f64 {
        self.knots[0].time
    }

    /// Time of the last sample [s].
    pub fn end(&self) -> f64 {
        self.knots[self.knots.len() - 1].time
    }

    /// From the first to the last sample [s]; 0 for a single one.
    pub fn duration(&self) -> f64 {
        self.end() - self.start()
    }

    /// The samples that the curve passes through, merged ones as one.
    pub fn knots(&self) -> impl ExactSizeIterator<Item = TimedPose> + '_ {
        self.knots.iter().map(|knot| TimedPose {
            time: knot.time,
            pose: knot.pose(),
        })
    }

    /// How many samples were merged into others because their times coincide.
    pub fn merged(&self) -> MergeReport {
        self.merged
    }

    /// The same motion in another frame: positions are multiplied by `scale` about the origin of the source frame, then
    /// the source frame is placed at `world_from_source` [m]. Orientations and times keep.
    ///
    /// # Errors
    /// [`TrajectoryError::NotPositive`] for `scale`, [`TrajectoryError::Placement`] for `world_from_source`,
    /// [`TrajectoryError::OutOfRange`] when a position ends up beyond 1e6 m (the row is that of a knot).
    pub fn mapped(&self, world_from_source: &Pose, scale: f64) -> Result<Self, TrajectoryError> {
        check_positive("scale", scale)?;
        let norm_error = (world_from_source.rotation.length() - 1.0).abs();
        if !world_from_source.is_finite() || norm_error > QUATERNION_TOLERANCE {
            return Err(TrajectoryError::Placement {
                pose: *world_from_source,
            });
        }
        let placement = Pose::new(
            world_from_source.rotation.normalize(),
            world_from_source.translation,
        );
        let mut mapped = self.clone();
        for (row, knot) in mapped.knots.iter_mut().enumerate() {
            knot.position = placement.transform_point(knot.position * scale);
            knot.second = placement.transform_vector(knot.second * scale);
            knot.rotation = (placement.rotation * knot.rotation).normalize();
            knot.angular_velocity = placement.transform_vector(knot.angular_velocity);
            check_position(row, knot.position)?;
        }
        Ok(mapped)
    }

    /// The same path from the same start time, `speed` times as fast.
    ///
    /// # Errors
    /// [`TrajectoryError::NotPositive`], or [`TrajectoryError::Speed`] when times would coincide or exceed 1e12 s.
    pub fn retimed(&self, speed: f64) -> Result<Self, TrajectoryError> {
        check_positive("speed", speed)?;
        let start = self.start();
        let mut retimed = self.clone();
        let mut previous = f64::NEG_INFINITY;
        for knot in &mut retimed.knots {
            let time = start + (knot.time - start) / speed;
            let distinct = time - previous > merge::duplicate_gap(time);
            if !distinct || time.abs() > MAX_TIME {
                return Err(TrajectoryError::Speed { speed });
            }
            knot.time = time;
            knot.second *= speed * speed;
            knot.angular_velocity *= speed;
            previous = time;
        }
        Ok(retimed)
    }
}

impl Knot {
    fn pose(&self) -> Pose {
        Pose::new(self.rotation, self.position)
    }

    fn spline_end(&self) -> SplineEnd {
        SplineEnd {
            time: self.time,
            position: self.position,
            second: self.second,
        }
    }
}

/// The curve through samples at strictly increasing times.
fn knots(samples: &[TimedPose]) -> Vec<Knot> {
    let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let positions: Vec<DVec3> = samples.iter().map(|s| s.pose.translation).collect();
    let second = spline::natural_second_derivatives(&times, &positions);
    let mut knots: Vec<Knot> = samples
        .iter()
        .zip(second)
        .map(|(sample, second)| Knot {
            time: sample.time,
            position: sample.pose.translation,
            second,
            rotation: sample.pose.rotation,
            angular_velocity: DVec3::ZERO,
        })
        .collect();
    for i in 1..knots.len() {
        let previous = knots[i - 1];
        if previous.rotation.dot(knots[i].rotation) < 0.0 {
            knots[i].rotation = -knots[i].rotation;
        }
        let turn = rotation_vector(knots[i].rotation * previous.rotation.conjugate());
        knots[i - 1].angular_velocity = turn / (knots[i].time - previous.time);
    }
    knots
}

/// The samples with unit quaternions, once every row is in order.
fn check(samples: &[TimedPose]) -> Result<Vec<TimedPose>, TrajectoryError> {
    if samples.is_empty() {
        return Err(TrajectoryError::Empty);
    }
    let mut checked: Vec<TimedPose> = Vec::with_capacity(samples.len());
    for (row, sample) in samples.iter().enumerate() {
        check_number(row, "time", sample.time, MAX_TIME)?;
        check_position(row, sample.pose.translation)?;
        let rotation = sample.pose.rotation;
        for (quantity, value) in [
            ("quaternion x", rotation.x),
            ("quaternion y", rotation.y),
            ("quaternion z", rotation.z),
            ("quaternion w", rotation.w),
        ] {
            if !value.is_finite() {
                return Err(TrajectoryError::NotFinite {
                    row,
                    quantity,
                    value,
                });
            }
        }
        let norm = rotation.length();
        if (norm - 1.0).abs() > QUATERNION_TOLERANCE {
            return Err(TrajectoryError::Quaternion { row, norm });
        }
        if let Some(before) = checked.last()
            && sample.time < before.time
        {
            return Err(TrajectoryError::OutOfOrder {
                row,
                time: sample.time,
                previous: before.time,
            });
        }
        checked.push(TimedPose {
            time: sample.time,
            pose: Pose::new(rotation.normalize(), sample.pose.translation),
        });
    }
    Ok(checked)
}

fn check_position(row: usize, position: DVec3) -> Result<(), TrajectoryError> {
    check_number(row, "position x", position.x, MAX_COORDINATE)?;
    check_number(row, "position y", position.y, MAX_COORDINATE)?;
    check_number(row, "position z", position.z, MAX_COORDINATE)
}

fn check_number(
    row: usize,
    quantity: &'static str,
    value: f64,
    limit: f64,
) -> Result<(), TrajectoryError> {
    if !value.is_finite() {
        return Err(TrajectoryError::NotFinite {
            row,
            quantity,
            value,
        });
    }
    if value.abs() > limit {
        return Err(TrajectoryError::OutOfRange {
            row,
            quantity,
            value,
            limit,
        });
    }
    Ok(())
}

fn check_positive(name: &'static str, value: f64) -> Result<(), TrajectoryError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(TrajectoryError::NotPositive { name, value })
    }
}
