//! Curves thinned to the pixels they are drawn on.

/// A curve as points (time, value).
pub(super) type Curve = Vec<(f64, f64)>;

/// At most two points a column: the smallest and the largest value in it, in the order in which they occur.
pub(super) fn decimated(time: &[f64], values: &[f64], columns: usize) -> Curve {
    if values.len() <= 2 * columns {
        return time.iter().copied().zip(values.iter().copied()).collect();
    }
    let mut curve = Vec::with_capacity(2 * columns);
    for (times, values) in chunks(time, values, columns) {
        let index_of = |better: fn(f64, f64) -> bool| {
            (1..values.len()).fold(0, |best, i| {
                if better(values[i], values[best]) {
                    i
                } else {
                    best
                }
            })
        };
        let (low, high) = (index_of(|a, b| a < b), index_of(|a, b| a > b));
        for index in [low.min(high), low.max(high)] {
            curve.push((times[index], values[index]));
        }
    }
    curve
}

/// Smallest, median and largest value of each column.
pub(super) fn band(time: &[f64], values: &[f64], columns: usize) -> (Curve, Curve, Curve) {
    let (mut low, mut middle, mut high) = (Vec::new(), Vec::new(), Vec::new());
    for (times, values) in chunks(time, values, columns) {
        let mut sorted = values.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let at = times[times.len() / 2];
        low.push((at, sorted[0]));
        middle.push((at, sorted[sorted.len() / 2]));
        high.push((at, sorted[sorted.len() - 1]));
    }
    (low, middle, high)
}

/// Spans of time, each from a tick that is flagged to the next one that is not.
pub(super) fn spans(time: &[f64], flags: &[bool]) -> Curve {
    let mut spans: Curve = Vec::new();
    let mut before = false;
    for (index, (&now, &flag)) in time.iter().zip(flags).enumerate() {
        let next = time.get(index + 1).copied().unwrap_or(now);
        match (before, flag, spans.last_mut()) {
            (true, true, Some(span)) => span.1 = next,
            (false, true, _) => spans.push((now, next)),
            _ => {}
        }
        before = flag;
    }
    spans
}

/// The ticks in at most `columns` runs of equal length.
fn chunks<'a>(
    time: &'a [f64],
    values: &'a [f64],
    columns: usize,
) -> impl Iterator<Item = (&'a [f64], &'a [f64])> {
    let length = values.len().div_ceil(columns.max(1)).max(1);
    time.chunks(length).zip(values.chunks(length))
}

#[cfg(test)]
mod tests {
    use super::{band, decimated, spans};

    #[test]
    fn spans_last_until_the_next_tick_that_is_not_flagged() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        let flags = [true, false, true, true, false];
        assert_eq!(spans(&time, &flags), [(0.0, 1.0), (2.0, 4.0)]);
        assert!(spans(&time, &[false; 5]).is_empty());
        assert_eq!(spans(&[0.5], &[true]), [(0.5, 0.5)]);
    }

    #[test]
    fn no_spike_is_lost_and_few_points_remain() {
        let time: Vec<f64> = (0..100_000).map(f64::from).collect();
        let mut values = vec![1.0; 100_000];
        values[54_321] = 9.0;
        values[54_322] = -9.0;
        let curve = decimated(&time, &values, 1000);
        assert!(curve.len() <= 2000);
        assert!(curve.contains(&(54_321.0, 9.0)) && curve.contains(&(54_322.0, -9.0)));
        assert!(curve.is_sorted_by(|a, b| a.0 <= b.0));
        let (low, middle, high) = band(&time, &values, 500);
        assert_eq!((low.len(), middle.len(), high.len()), (500, 500, 500));
        assert!(high.iter().any(|point| (point.1 - 9.0).abs() < 1e-12));
        assert!(middle.iter().all(|point| (point.1 - 1.0).abs() < 1e-12));
    }

    #[test]
    fn short_curves_are_drawn_whole() {
        assert_eq!(
            decimated(&[0.0, 1.0], &[2.0, 3.0], 10),
            [(0.0, 2.0), (1.0, 3.0)]
        );
        assert!(decimated(&[], &[], 10).is_empty());
        assert!(band(&[], &[], 10).0.is_empty());
    }
}
