//! Rows of a recording whose time stamps coincide, or nearly do, become one.
//!
//! An interpolating spline turns a jump d over a short gap h into the slope d/h and swings out by up to about
//! (4/27)·(d/h)·H in a neighbouring gap H. Two readings a microsecond apart would throw the curve by metres, so such rows are
//! averaged:
//! - **duplicates**: within [`DUPLICATE_GAP`] (or four units in the last place of the stamp, where that is more) of the
//!   first row of their group;
//! - **near-duplicates**: a gap below [`NEAR_DUPLICATE_RATIO`] of the median of the nine gaps around it. The median keeps
//!   a part of a recording that is sampled faster: five short gaps in a row are no accident. The swing that is left is
//!   about four times the jump at worst.

use glam::DQuat;
use pliant_spatial::Pose;

use super::TimedPose;

/// Rows closer in time than this are one reading [s]. Stamps are commonly written to a microsecond or nanosecond; no hand
/// moves measurably within it. Larger would merge what near-duplicates judge by context.
pub(super) const DUPLICATE_GAP: f64 = 1e-9;

/// Gaps below this part of the local median are near-duplicates. Larger merges honest jitter, smaller lets the curve swing
/// out further (four times the jump at 0.05).
pub(super) const NEAR_DUPLICATE_RATIO: f64 = 0.05;

/// Gaps on either side of a gap that form its local median.
const NEIGHBOURS: usize = 4;

/// How many rows of the input were averaged into others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MergeReport {
    /// Rows that had the time stamp of the row before them.
    pub duplicates: usize,
    /// Rows that followed the row before them within 5 % of the usual gap around there.
    pub near_duplicates: usize,
}

/// Stamps at most this far apart are equal [s], for stamps of the size of `time` [s].
pub(super) fn duplicate_gap(time: f64) -> f64 {
    DUPLICATE_GAP.max(4.0 * f64::EPSILON * time.abs())
}

/// Averages duplicates, then near-duplicates. `samples` are checked, in order, sign-aligned.
pub(super) fn merge(samples: &[TimedPose]) -> (Vec<TimedPose>, MergeReport) {
    let mut first_of_group = 0;
    let distinct = merge_groups(samples, |row| {
        let first = samples[first_of_group].time;
        let same = samples[row].time - first <= duplicate_gap(first);
        if !same {
            first_of_group = row;
        }
        same
    });
    let gaps: Vec<f64> = distinct
        .windows(2)
        .map(|pair| pair[1].time - pair[0].time)
        .collect();
    let merged = merge_groups(&distinct, |row| {
        gaps[row - 1] < NEAR_DUPLICATE_RATIO * local_median(&gaps, row - 1)
    });
    let report = MergeReport {
        duplicates: samples.len() - distinct.len(),
        near_duplicates: distinct.len() - merged.len(),
    };
    (merged, report)
}

/// Averages runs of rows; `joins_previous(row)` is asked once for each row but the first, in order.
fn merge_groups(
    samples: &[TimedPose],
    mut joins_previous: impl FnMut(usize) -> bool,
) -> Vec<TimedPose> {
    let mut merged = Vec::with_capacity(samples.len());
    let mut start = 0;
    for end in 1..=samples.len() {
        if end == samples.len() || !joins_previous(end) {
            merged.push(average(&samples[start..end]));
            start = end;
        }
    }
    merged
}

/// Mean time and position; the normalised sum of the quaternions, which are sign-aligned, so the sum cannot vanish.
fn average(group: &[TimedPose]) -> TimedPose {
    let [first, rest @ ..] = group else {
        unreachable!("a group holds the row that began it")
    };
    if rest.is_empty() {
        return *first;
    }
    // Offsets from the first row: sums of large stamps would lose the digits that tell the rows apart.
    let (mut time, mut offset) = (0.0, glam::DVec3::ZERO);
    let mut rotation = first.pose.rotation;
    for sample in rest {
        time += sample.time - first.time;
        offset += sample.pose.translation - first.pose.translation;
        rotation = add(rotation, sample.pose.rotation);
    }
    let count = group.len() as f64;
    TimedPose {
        time: first.time + time / count,
        pose: Pose::new(
            rotation.normalize(),
            first.pose.translation + offset / count,
        ),
    }
}

/// `sum` plus `next`, whichever sign of `next` is nearer.
fn add(sum: DQuat, next: DQuat) -> DQuat {
    if sum.dot(next) < 0.0 {
        sum - next
    } else {
        sum + next
    }
}

/// Median of the gaps around `gaps[at]`, it included (the upper one of an even number).
fn local_median(gaps: &[f64], at: usize) -> f64 {
    let window = &gaps[at.saturating_sub(NEIGHBOURS)..gaps.len().min(at + NEIGHBOURS + 1)];
    let mut sorted = [0.0; 2 * NEIGHBOURS + 1];
    let sorted = &mut sorted[..window.len()];
    sorted.copy_from_slice(window);
    sorted.sort_unstable_by(f64::total_cmp);
    sorted[window.len() / 2]
}
