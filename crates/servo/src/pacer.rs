//! When the next tick runs: absolute deadlines, one period apart.
//!
//! Deadlines are computed from an origin, so waking late does not shift those that follow. A tick that begins a whole period
//! or more after its deadline is **late**: the periods that went by are skipped and the origin moves to the present, so
//! that the next tick comes one period later. Catching up instead would run ticks in a burst and send the hand forces of
//! several milliseconds at once.

use std::time::Duration;

use crate::{Clock, Rate};

/// Keeps the beat of a servo and counts where it was lost.
#[derive(Clone, Copy, Debug)]
pub struct Pacer {
    rate: Rate,
    /// Deadline of slot 0 since the last resynchronisation.
    origin: Duration,
    /// Slot of the next deadline, counted from the origin.
    slot: u64,
    report: PacingReport,
}

/// How well the beat was kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PacingReport {
    /// Ticks paced.
    pub ticks: u64,
    /// Ticks that began a period or more after their deadline.
    pub late_ticks: u64,
    /// Whole periods that went by without a tick because of those.
    pub skipped_periods: u64,
    /// Longest time from a deadline to the begin of its tick.
    pub max_lateness: Duration,
}

impl Pacer {
    /// The first deadline is `start`, in the time of the clock that will be waited on.
    pub fn new(rate: Rate, start: Duration) -> Self {
        Self {
            rate,
            origin: start,
            slot: 0,
            report: PacingReport::default(),
        }
    }

    /// Waits for the deadline of the next tick; returns how much later than it the tick begins. Allocates nothing.
    pub fn wait(&mut self, clock: &impl Clock) -> Duration {
        let deadline = self.next_deadline();
        clock.wait_until(deadline);
        let now = clock.now();
        let lateness = now.saturating_sub(deadline);
        let period = self.rate.periods(1);
        if lateness >= period {
            self.report.late_ticks += 1;
            self.report.skipped_periods += whole_periods(lateness, period);
            self.origin = now;
            self.slot = 0;
        }
        self.slot += 1;
        self.report.ticks += 1;
        self.report.max_lateness = self.report.max_lateness.max(lateness);
        lateness
    }

    /// When the next tick is due, in the time of the clock.
    pub fn next_deadline(&self) -> Duration {
        self.origin + self.rate.periods(self.slot)
    }

    /// The count so far.
    pub fn report(&self) -> PacingReport {
        self.report
    }
}

/// How many times `period` fits into `span`.
fn whole_periods(span: Duration, period: Duration) -> u64 {
    u64::try_from(span.as_nanos() / period.as_nanos()).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::{Pacer, PacingReport};
    use crate::{Clock, ManualClock, Rate};
    use std::time::Duration;

    const MS: Duration = Duration::from_millis(1);

    /// When ticks begin if tick `i` takes `work[i]`.
    fn beginnings(rate_hz: u32, work: &[Duration]) -> (Vec<Duration>, PacingReport) {
        let clock = ManualClock::new();
        clock.advance(Duration::from_secs(7));
        let start = clock.now();
        let mut pacer = Pacer::new(Rate::new(rate_hz).unwrap(), start);
        let mut begun = Vec::new();
        for &duration in work {
            pacer.wait(&clock);
            begun.push(clock.now().saturating_sub(start));
            clock.advance(duration);
        }
        (begun, pacer.report())
    }

    #[test]
    fn the_beat_is_exact_while_work_fits() {
        let (begun, report) = beginnings(3000, &vec![Duration::from_micros(300); 3001]);
        assert_eq!(begun[0], Duration::ZERO);
        assert_eq!(begun[3000], Duration::from_secs(1));
        let expected = PacingReport {
            ticks: 3001,
            ..PacingReport::default()
        };
        assert_eq!(report, expected);
    }

    #[test]
    fn a_tick_late_by_less_than_a_period_does_not_shift_the_next() {
        let work = [MS / 2, MS * 17 / 10, MS / 10, MS / 10];
        let (begun, report) = beginnings(1000, &work);
        assert_eq!(begun, [Duration::ZERO, MS, MS * 27 / 10, MS * 3]);
        assert_eq!((report.late_ticks, report.skipped_periods), (0, 0));
        assert_eq!(report.max_lateness, MS * 7 / 10);
    }

    #[test]
    fn a_stall_is_counted_once_and_never_caught_up() {
        let mut work = [MS / 10; 12];
        work[4] = MS * 204 / 10;
        let (begun, report) = beginnings(1000, &work);
        // Tick 4 begins at 4 ms and returns at 24.4 ms; tick 5 was due at 5 ms.
        assert_eq!(begun[5], MS * 244 / 10);
        assert_eq!((report.late_ticks, report.skipped_periods), (1, 19));
        assert_eq!(report.max_lateness, MS * 194 / 10);
        for pair in begun[5..].windows(2) {
            assert_eq!(pair[1].saturating_sub(pair[0]), MS);
        }
    }

    #[test]
    fn exactly_one_period_is_late_and_leaves_no_pair_of_ticks_together() {
        let (begun, report) = beginnings(1000, &[MS * 2, MS / 10, MS / 10]);
        assert_eq!(begun, [Duration::ZERO, MS * 2, MS * 3]);
        assert_eq!((report.late_ticks, report.skipped_periods), (1, 1));
    }

    #[test]
    fn work_that_never_fits_runs_back_to_back_and_is_counted() {
        let (begun, report) = beginnings(1000, &[MS * 3; 100]);
        for pair in begun.windows(2) {
            assert_eq!(pair[1].saturating_sub(pair[0]), MS * 3);
        }
        assert_eq!((report.late_ticks, report.skipped_periods), (99, 198));
    }
}
