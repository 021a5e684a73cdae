//! Natural cubic spline through points at uneven times (de Boor 1978, ch. IV): second derivatives by one tridiagonal solve.

use glam::DVec3;

/// Second derivatives [m/s²] at the knots of the C² cubic spline through `positions` [m] at strictly increasing `times`
/// [s], zero at both ends.
///
/// With gaps hᵢ and slopes sᵢ: hᵢ₋₁ mᵢ₋₁ + 2 (hᵢ₋₁ + hᵢ) mᵢ + hᵢ mᵢ₊₁ = 6 (sᵢ − sᵢ₋₁), solved by elimination without
/// pivots, which diagonal dominance allows.
pub(super) fn natural_second_derivatives(times: &[f64], positions: &[DVec3]) -> Vec<DVec3> {
    let count = times.len();
    let mut second = vec![DVec3::ZERO; count];
    let mut upper = vec![0.0; count];
    let gap = |i: usize| times[i + 1] - times[i];
    let slope = |i: usize| (positions[i + 1] - positions[i]) / gap(i);
    for i in 1..count.saturating_sub(1) {
        let (before, after) = (gap(i - 1), gap(i));
        let pivot = 2.0 * (before + after) - before * upper[i - 1];
        upper[i] = after / pivot;
        second[i] = ((slope(i) - slope(i - 1)) * 6.0 - second[i - 1] * before) / pivot;
    }
    for i in (1..count.saturating_sub(1)).rev() {
        let next = second[i + 1];
        second[i] -= next * upper[i];
    }
    second
}

/// One end of a spline segment.
pub(super) struct SplineEnd {
    /// [s]
    pub(super) time: f64,
    /// [m]
    pub(super) position: DVec3,
    /// Second derivative [m/s²].
    pub(super) second: DVec3,
}

/// Position [m] and velocity [m/s] at `time` [s] on the segment from `start` to `end`. Allocates nothing.
pub(super) fn evaluate(start: &SplineEnd, end: &SplineEnd, time: f64) -> (DVec3, DVec3) {
    let h = end.time - start.time;
    let (a, b) = ((end.time - time) / h, (time - start.time) / h);
    let position = start.position * a
        + end.position * b
        + (start.second * (a * a * a - a) + end.second * (b * b * b - b)) * (h * h / 6.0);
    let velocity = (end.position - start.position) / h
        + (end.second * (3.0 * b * b - 1.0) - start.second * (3.0 * a * a - 1.0)) * (h / 6.0);
    (position, velocity)
}
