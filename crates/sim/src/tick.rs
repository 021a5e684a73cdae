//! One servo period.

use glam::DVec3;
use pliant_contact::{ConstrainedOutcome, ConstrainedTracker, Contact, PaperTracker};
use pliant_spatial::{Pose, Wrench};

use crate::{Method, World};

/// Time over which the force rises from zero after a start inside an object [s].
const RAMP_SECONDS: f64 = 0.5;

/// What changes from tick to tick: both tools.
#[derive(Clone, Debug)]
pub struct State {
    world_from_haptic: Pose,
    tracker: Tracker,
    /// Part of the force that is rendered; below 1 only after a start inside an object.
    ramp: f64,
}

#[derive(Clone, Debug)]
enum Tracker {
    Constrained(Box<ConstrainedTracker>),
    Paper(Box<PaperTracker>),
}

/// Input of one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TickInput {
    /// Handle pose of the haptic tool: where the hand is.
    pub world_from_haptic: Pose,
}

/// Result of one tick.
#[derive(Clone, Copy, Debug)]
pub struct TickOutput {
    /// Handle pose of the haptic tool.
    pub world_from_haptic: Pose,
    /// Handle pose of the visual tool.
    pub world_from_visual: Pose,
    /// Load on the hand: world axes, torque about the haptic handle's origin.
    pub wrench: Wrench,
    /// Places that press.
    pub contacts: u32,
    /// The strongest of them.
    pub contact: Option<Contact>,
    /// Distance of the two handles [m]: how far the haptic tool has been pushed past the visual one.
    pub penetration_of_haptic: f64,
    /// The visual tool is held at its last free orientation, or has no free place yet.
    pub held: bool,
    /// The solver reached its cap; the pose is free but may still move.
    pub capped: bool,
    /// Energy in the coupling spring [J].
    pub coupling_energy: f64,
}

impl State {
    /// Both tools at the first haptic pose. Where the tool overlaps objects the visual tool is moved out at once and the force
    /// rises from zero.
    pub fn new(world: &World, world_from_haptic: Pose) -> Self {
        let (obstacles, segments) = (world.obstacles(), &world.tool().segments[..]);
        match world.method() {
            Method::Constrained => {
                let tracker = ConstrainedTracker::new(obstacles, segments, world_from_haptic);
                Self {
                    world_from_haptic,
                    ramp: if tracker.started_inside() { 0.0 } else { 1.0 },
                    tracker: Tracker::Constrained(Box::new(tracker)),
                }
            }
            Method::Paper(parameters) => Self {
                world_from_haptic,
                ramp: 1.0,
                tracker: Tracker::Paper(Box::new(PaperTracker::new(
                    obstacles,
                    segments,
                    parameters,
                    world_from_haptic,
                ))),
            },
        }
    }

    /// Handle pose of the visual tool.
    pub fn world_from_visual(&self) -> Pose {
        match &self.tracker {
            Tracker::Constrained(tracker) => tracker.world_from_visual(),
            Tracker::Paper(tracker) => tracker.world_from_visual(),
        }
    }

    /// The separating-plane tracker, for judges and drawings; `None` under the paper's method.
    pub fn constrained(&self) -> Option<&ConstrainedTracker> {
        match &self.tracker {
            Tracker::Constrained(tracker) => Some(tracker),
            Tracker::Paper(_) => None,
        }
    }

    /// The paper's tracker, for judges and drawings; `None` under the separating-plane method.
    pub fn paper(&self) -> Option<&PaperTracker> {
        match &self.tracker {
            Tracker::Constrained(_) => None,
            Tracker::Paper(tracker) => Some(tracker),
        }
    }
}

/// Moves `state` by one period of `dt` seconds. A pose that is not finite is replaced by the last one. Allocates nothing.
pub fn tick(world: &World, state: &mut State, input: &TickInput, dt: f64) -> TickOutput {
    let last = state.world_from_haptic;
    let haptic = if input.world_from_haptic.is_finite() {
        input.world_from_haptic
    } else {
        last
    };
    state.world_from_haptic = haptic;
    let pressed = match &mut state.tracker {
        Tracker::Constrained(tracker) => {
            let target = coupled_target(world, tracker.world_from_visual(), last, haptic, dt);
            let outcome =
                tracker.advance(world.obstacles(), &world.tool().segments, &haptic, target);
            Pressed::from_constrained(&outcome, target)
        }
        Tracker::Paper(tracker) => {
            let outcome = tracker.advance(world.obstacles(), &world.tool().segments, &haptic);
            Pressed::from_paper(outcome.world_from_visual, outcome.contact, &haptic)
        }
    };
    state.ramp = if pressed.inside {
        0.0
    } else if pressed.contacts == 0 {
        1.0
    } else {
        (state.ramp + dt / RAMP_SECONDS).min(1.0)
    };
    output(world, &pressed, &haptic, state.ramp)
}

/// Where the coupling pulls the visual tool: the haptic position, delayed by the damper. The position that minimises
/// ½k|x − h|² + (b/2Δt)|(x − x₀) − (h − h₀)|² (contact.14): the damper acts on visual relative to haptic motion.
fn coupled_target(world: &World, visual: Pose, last: Pose, haptic: Pose, dt: f64) -> DVec3 {
    let coupling = world.coupling();
    if coupling.linear_damping <= 0.0 {
        return haptic.translation;
    }
    let k = coupling.linear_stiffness;
    let rate = coupling.linear_damping / dt;
    let offset = visual.translation - last.translation;
    haptic.translation + offset * (rate / (k + rate))
}

/// What a method found, before stiffness.
struct Pressed {
    world_from_visual: Pose,
    contacts: u32,
    contact: Option<Contact>,
    push: DVec3,
    moment: DVec3,
    held: bool,
    capped: bool,
    /// No free place has been found yet.
    inside: bool,
}

impl Pressed {
    fn from_constrained(outcome: &ConstrainedOutcome, target: DVec3) -> Self {
        // The reaction of all contacts together points from the target to the visual tool. Undamped, the spring does too; a damper that
        // trails a turning normal could make it pull, and contact never pulls.
        let reaction = (outcome.world_from_visual.translation - target).normalize_or_zero();
        let push = outcome.push - reaction * outcome.push.dot(reaction).min(0.0);
        Self {
            world_from_visual: outcome.world_from_visual,
            contacts: outcome.contacts().map(|_| 1).sum(),
            contact: outcome.contacts().next().copied(),
            push,
            moment: outcome.moment,
            held: outcome.held,
            capped: outcome.capped,
            inside: outcome.inside,
        }
    }

    fn from_paper(world_from_visual: Pose, contact: Option<Contact>, haptic: &Pose) -> Self {
        let push = world_from_visual.translation - haptic.translation;
        let moment = contact.map_or(DVec3::ZERO, |c| (c.point - haptic.translation).cross(push));
        Self {
            world_from_visual,
            contacts: u32::from(contact.is_some()),
            contact,
            push,
            moment,
            held: false,
            capped: false,
            inside: false,
        }
    }
}

fn output(world: &World, pressed: &Pressed, haptic: &Pose, ramp: f64) -> TickOutput {
    let k = world.coupling().linear_stiffness;
    TickOutput {
        world_from_haptic: *haptic,
        world_from_visual: pressed.world_from_visual,
        wrench: Wrench {
            force: pressed.push * (k * ramp),
            torque: pressed.moment * (k * ramp),
        },
        contacts: pressed.contacts,
        contact: pressed.contact,
        penetration_of_haptic: pressed.push.length(),
        held: pressed.held,
        capped: pressed.capped,
        coupling_energy: 0.5 * k * pressed.push.length_squared(),
    }
}
