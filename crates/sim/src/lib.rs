//! One haptic tick as a pure function of state, input and time step.
//!
//! A [`World`] holds what does not change: the tool, the objects, the virtual coupling, the contact method. A [`State`] holds what
//! does. [`tick`] moves the state by one period and returns what the hand feels. There is no clock, no thread and no input or
//! output here, and a tick allocates nothing.

mod judge;
mod tick;
mod world;

pub use judge::visual_penetration;
pub use tick::{RAMP_SECONDS, State, TickInput, TickOutput, tick};
pub use world::{Method, Object, Tool, VirtualCoupling, World, WorldDescription, WorldError};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
