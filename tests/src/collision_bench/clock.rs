//! Times of single queries: what the clock costs is subtracted, what the machine did meanwhile removed by repetition.

use std::hint::black_box;
use std::time::Instant;

use serde::Serialize;

/// A query's time is its smallest over so many passes.
const PASSES: usize = 5;

/// Median and 99th percentile over queries [ns].
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Times {
    /// Median [ns].
    pub p50: f64,
    /// 99th percentile [ns].
    pub p99: f64,
}

/// A clock that knows its own cost.
pub struct Clock {
    /// Of one reading [ns].
    overhead: u64,
}

impl Clock {
    /// Measures the cost of reading it.
    pub fn new() -> Self {
        let mut readings: Vec<u64> = (0..10_001).map(|_| elapsed(|| (), 0)).collect();
        readings.sort_unstable();
        Self {
            overhead: readings[readings.len() / 2],
        }
    }

    /// Times of `count` queries [ns]. In each pass `start` makes what the queries share, such as a cache, and `query` answers
    /// number i.
    pub fn times<S, R>(
        &self,
        count: usize,
        mut start: impl FnMut() -> S,
        mut query: impl FnMut(&mut S, usize) -> R,
    ) -> Vec<u64> {
        let mut best = vec![u64::MAX; count];
        for _ in 0..PASSES {
            let mut shared = start();
            for (index, best) in best.iter_mut().enumerate() {
                let time = elapsed(|| query(&mut shared, index), self.overhead);
                *best = (*best).min(time);
            }
        }
        best
    }
}

impl Default for Clock {
    fn default() -> Self {
        Self::new()
    }
}

impl Times {
    /// Of single times [ns]; `None` without any.
    pub fn of(mut times: Vec<u64>) -> Option<Self> {
        times.sort_unstable();
        let at = |per_mille: usize| {
            let last = times.len().checked_sub(1)?;
            times.get(last * per_mille / 1000).map(|&time| time as f64)
        };
        Some(Self {
            p50: at(500)?,
            p99: at(990)?,
        })
    }
}

fn elapsed<R>(query: impl FnOnce() -> R, overhead: u64) -> u64 {
    let start = Instant::now();
    black_box(query());
    let time = start.elapsed().as_nanos();
    u64::try_from(time)
        .unwrap_or(u64::MAX)
        .saturating_sub(overhead)
}
