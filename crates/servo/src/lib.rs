//! The haptic loop: reads a device, advances the world by one tick, sends the wrench back; in virtual or real time.
//!
//! Simulation time is tick count over rate, never a clock reading, so pacing decides when a tick runs and nothing about
//! what it computes: the same device motion gives the same bytes in virtual time, in real time and after any stall. No
//! thread is started here and a tick does not allocate, lock or log.

mod clock;
mod pacer;
mod rate;
mod run;
mod servo;
#[cfg(test)]
mod test_bench;

pub use clock::{Clock, ManualClock, MonotonicClock};
pub use pacer::{Pacer, PacingReport};
pub use rate::{Rate, RateError};
pub use run::{run_paced, run_virtual};
pub use servo::{Sample, Servo, ServoError, ServoParts};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
