//! How often the servo ticks.

use std::time::Duration;

use thiserror::Error;

/// Ticks per second, between [`Rate::MIN_HZ`] and [`Rate::MAX_HZ`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rate {
    hz: u32,
}

/// The rate asked for is outside of what the servo can hold and a hand can bear.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[error(
    "servo rate {hz} Hz is outside {}..={} Hz; 1000 is usual",
    Rate::MIN_HZ,
    Rate::MAX_HZ
)]
pub struct RateError {
    /// The rate as given [Hz].
    pub hz: u32,
}

impl Rate {
    /// Below it, stiff contact rattles audibly and touch feels it [Hz].
    pub const MIN_HZ: u32 = 500;
    /// Above it, a period no longer holds the tail of the sleep (see [`MonotonicClock`](crate::MonotonicClock)) [Hz].
    pub const MAX_HZ: u32 = 10_000;
    /// 1000 Hz, the field's usual rate.
    pub const DEFAULT: Self = Self { hz: 1000 };

    /// `hz` ticks per second.
    ///
    /// # Errors
    /// [`RateError`] outside [`Self::MIN_HZ`]..=[`Self::MAX_HZ`].
    pub const fn new(hz: u32) -> Result<Self, RateError> {
        if hz < Self::MIN_HZ || hz > Self::MAX_HZ {
            return Err(RateError { hz });
        }
        Ok(Self { hz })
    }

    /// Ticks per second [Hz].
    pub const fn hz(self) -> u32 {
        self.hz
    }

    /// Simulated time per tick [s].
    pub fn dt(self) -> f64 {
        1.0 / f64::from(self.hz)
    }

    /// Simulated time of tick `tick` [s]: one rounded division, so that it does not drift.
    pub fn time_of(self, tick: u64) -> f64 {
        tick as f64 / f64::from(self.hz)
    }

    /// `ticks` periods, rounded down to a nanosecond once, so that deadlines do not drift.
    pub(crate) fn periods(self, ticks: u64) -> Duration {
        let hz = u64::from(self.hz);
        // Whole seconds apart from the rest: the product of nanoseconds would leave u64 after 18 s at 10⁹ ticks.
        let (seconds, rest) = (ticks / hz, ticks % hz);
        Duration::from_secs(seconds) + Duration::from_nanos(rest * 1_000_000_000 / hz)
    }
}

impl Default for Rate {
    fn default() -> Self {
        Self::DEFAULT
    }
}

#[cfg(test)]
mod tests {
    use super::{Rate, RateError};
    use std::time::Duration;

    #[test]
    fn rates_outside_the_range_are_refused_with_the_range() {
        for hz in [0, 499, 10_001, u32::MAX] {
            let error = Rate::new(hz).unwrap_err();
            assert_eq!(error, RateError { hz });
            assert!(error.to_string().contains("500..=10000 Hz"), "{error}");
        }
        for hz in [500, 1000, 10_000] {
            assert_eq!(Rate::new(hz).unwrap().hz(), hz);
        }
    }

    #[test]
    fn time_and_deadlines_do_not_drift_over_a_day() {
        let rate = Rate::new(3000).unwrap();
        let ticks = 86_400 * 3000;
        assert_eq!(rate.periods(ticks), Duration::from_hours(24));
        assert_eq!(
            rate.periods(ticks + 1).saturating_sub(rate.periods(ticks)),
            Duration::from_nanos(333_333)
        );
        assert!((rate.time_of(ticks) - 86_400.0).abs() < 1e-300);
        assert!((rate.dt() - 1.0 / 3000.0).abs() < 1e-300);
    }
}
