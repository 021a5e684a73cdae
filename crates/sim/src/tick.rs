//! One servo period.

use glam::DVec3;
use pliant_contact::{ConstrainedOutcome, ConstrainedTracker, Contact, PaperTracker, SKIN};
use pliant_spatial::{Pose, Wrench};

use crate::{Method, World};

/// Time over which the force of [`Method::Constrained`] rises from zero after a start inside an object [s].
pub const RAMP_SECONDS: f64 = 0.5;

/// What changes from tick to tick: both tools.
#[derive(Clone, Debug)]
pub struct State {
    world_from_haptic: Pose,
    /// A usable haptic pose has been seen.
    placed: bool,
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
    /// rises from zero. A pose that is no placement is taken as the identity until a tick brings a good one.
    pub fn new(world: &World, world_from_haptic: Pose) -> Self {
        let placed = world_from_haptic.is_placement();
        let world_from_haptic = if placed {
            world_from_haptic.normalized()
        } else {
            Pose::IDENTITY
        };
        let (obstacles, segments) = (world.obstacles(), &world.tool().segments[..]);
        match world.method() {
            Method::Constrained => {
                let tracker = ConstrainedTracker::new(obstacles, segments, world_from_haptic);
                Self {
                    world_from_haptic,
                    placed,
                    ramp: if tracker.started_inside() { 0.0 } else { 1.0 },
                    tracker: Tracker::Constrained(Box::new(tracker)),
                }
            }
            Method::Paper(parameters) => Self {
                world_from_haptic,
                placed,
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

/// Moves `state` by one period of `dt` seconds. A pose that is no placement (not finite, or no unit quaternion) is replaced by the last
/// good one, a `dt` that is not positive counts as 0. `state` belongs to `world`. Allocates nothing.
pub fn tick(world: &World, state: &mut State, input: &TickInput, dt: f64) -> TickOutput {
    let dt = if dt.is_finite() { dt.max(0.0) } else { 0.0 };
    let last = state.world_from_haptic;
    let haptic = if input.world_from_haptic.is_placement() {
        input.world_from_haptic.normalized()
    } else {
        last
    };
    state.world_from_haptic = haptic;
    let pressed = match &mut state.tracker {
        Tracker::Constrained(tracker) => {
            let target = if !state.placed && input.world_from_haptic.is_placement() {
                tracker.restart();
                state.ramp = 0.0;
                haptic.translation
            } else {
                coupled_target(world, tracker.world_from_visual(), last, haptic, dt)
            };
            let outcome =
                tracker.advance(world.obstacles(), &world.tool().segments, &haptic, target);
            Pressed::from_constrained(&outcome)
        }
        Tracker::Paper(tracker) => {
            let outcome = tracker.advance(world.obstacles(), &world.tool().segments, &haptic);
            Pressed::from_paper(outcome.world_from_visual, outcome.contact, &haptic)
        }
    };
    state.placed |= input.world_from_haptic.is_placement();
    let output = output(world, &pressed, &haptic, state.ramp);
    state.ramp = if pressed.inside {
        0.0
    } else if output.penetration_of_haptic < SKIN {
        1.0
    } else {
        (state.ramp + dt / RAMP_SECONDS).min(1.0)
    };
    output
}

/// Where the coupling pulls the visual tool: the haptic position, delayed by the damper. The position that minimises
/// ½k|x − h|² + (b/2Δt)|(x − x₀) − (h − h₀)|² (contact.14): the damper acts on visual relative to haptic motion.
fn coupled_target(world: &World, visual: Pose, last: Pose, haptic: Pose, dt: f64) -> DVec3 {
    let coupling = world.coupling();
    if coupling.linear_damping <= 0.0 {
        return haptic.translation;
    }
    let k = coupling.linear_stiffness;
    let b = coupling.linear_damping;
    let offset = visual.translation - last.translation;
    haptic.translation + offset * (b / (k * dt + b))
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
    fn from_constrained(outcome: &ConstrainedOutcome) -> Self {
        Self {
            world_from_visual: outcome.world_from_visual,
            contacts: outcome.contacts().map(|_| 1).sum(),
            contact: outcome.contacts().next().copied(),
            push: outcome.push,
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
    let offset = pressed.world_from_visual.translation - haptic.translation;
    TickOutput {
        world_from_haptic: *haptic,
        world_from_visual: pressed.world_from_visual,
        wrench: Wrench {
            force: pressed.push * (k * ramp),
            torque: pressed.moment * (k * ramp),
        },
        contacts: pressed.contacts,
        contact: pressed.contact,
        penetration_of_haptic: offset.length(),
        held: pressed.held,
        capped: pressed.capped,
        coupling_energy: 0.5 * k * offset.length_squared(),
    }
}
