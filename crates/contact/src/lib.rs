//! Contact of a rigid haptic tool with convex objects.
//!
//! Two methods over the same geometry: [`ConstrainedTracker`], certified separating planes solved together, and the contact
//! tracking of Laycock & Day (2003). Neither knows of devices, springs or time: they place a *visual tool* for a given
//! *haptic tool*, and say what it touches.

mod constrained;
mod obstacle;
mod paper;
mod qp;
mod share;
mod touching;

pub use constrained::{ConstrainedOutcome, ConstrainedTracker, MAX_CONTACTS, SKIN};
pub use obstacle::{Contact, Obstacle};
pub use paper::{PaperEvent, PaperEvents, PaperOutcome, PaperParameters, PaperTracker};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
