//! Clocks to pace by: the machine's, and one that a test turns by hand.

use std::cell::Cell;
use std::hint::spin_loop;
use std::thread;
use std::time::{Duration, Instant};

/// A clock that never goes back.
pub trait Clock {
    /// Time since some fixed instant.
    fn now(&self) -> Duration;

    /// Returns at `deadline` or later, at once when it has passed.
    fn wait_until(&self, deadline: Duration);
}

/// The machine's monotonic clock, from its creation. Waiting sleeps until 100 µs before the deadline, then spins.
#[derive(Clone, Copy, Debug)]
pub struct MonotonicClock {
    start: Instant,
}

/// How long before a deadline sleeping ends and spinning begins. The kernel wakes a normal thread 85 to 115 µs late (25 to
/// 45 µs at real-time priority). Longer costs processor time: 100 µs is a tenth of a core at 1 kHz.
const SPIN: Duration = Duration::from_micros(100);

impl MonotonicClock {
    /// A clock that reads zero now.
    pub fn new() -> Self {
        Self {
            start: Instant::now(),
        }
    }
}

impl Default for MonotonicClock {
    fn default() -> Self {
        Self::new()
    }
}

impl Clock for MonotonicClock {
    fn now(&self) -> Duration {
        self.start.elapsed()
    }

    fn wait_until(&self, deadline: Duration) {
        let sleep = deadline.saturating_sub(self.now()).saturating_sub(SPIN);
        if !sleep.is_zero() {
            thread::sleep(sleep);
        }
        while self.now() < deadline {
            spin_loop();
        }
    }
}

/// A clock that stands still until it is waited on or advanced. Waiting takes no real time.
#[derive(Clone, Debug, Default)]
pub struct ManualClock {
    now: Cell<Duration>,
}

impl ManualClock {
    /// A clock that reads zero.
    pub const fn new() -> Self {
        Self {
            now: Cell::new(Duration::ZERO),
        }
    }

    /// Lets `duration` pass: work that takes this long, or a stall.
    pub fn advance(&self, duration: Duration) {
        self.now.set(self.now.get() + duration);
    }
}

impl Clock for ManualClock {
    fn now(&self) -> Duration {
        self.now.get()
    }

    fn wait_until(&self, deadline: Duration) {
        self.now.set(self.now.get().max(deadline));
    }
}

#[cfg(test)]
mod tests {
    use super::{Clock, ManualClock, MonotonicClock};
    use std::time::Duration;

    #[test]
    fn the_machine_clock_never_wakes_early() {
        let clock = MonotonicClock::new();
        for step in [0, 50, 300, 2000] {
            let deadline = clock.now() + Duration::from_micros(step);
            clock.wait_until(deadline);
            assert!(clock.now() >= deadline);
        }
        let past = clock.now();
        clock.wait_until(Duration::ZERO);
        assert!(clock.now() >= past);
    }

    #[test]
    fn the_manual_clock_jumps_to_the_deadline_and_not_back() {
        let clock = ManualClock::new();
        clock.wait_until(Duration::from_millis(3));
        assert_eq!(clock.now(), Duration::from_millis(3));
        clock.wait_until(Duration::from_millis(1));
        assert_eq!(clock.now(), Duration::from_millis(3));
        clock.advance(Duration::from_millis(2));
        assert_eq!(clock.now(), Duration::from_millis(5));
    }
}
