//! Invariants of rigid contact on planned motions: force steps, side kept, torque, segments, slots, start inside, damping, and that the
//! paper's method breaks one of them.

mod forces;
mod paper;
mod places;
mod slots;
mod starts;
mod torques;

use pliant_sim::{Method, TickOutput, World};
use pliant_tests::bodies::{Setting, ToolKind, world};

/// Stiffness of the coupling [N/m].
const K: f64 = 1000.0;

fn constrained(setting: Setting, kind: ToolKind, segments: u32) -> World {
    world(setting, kind.tool(segments), Method::Constrained)
}

fn contact_share(outputs: &[TickOutput]) -> f64 {
    outputs.iter().filter(|o| o.contacts > 0).count() as f64 / outputs.len() as f64
}
