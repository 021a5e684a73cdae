//! A random hand in closed loop: a mass pulled to moving targets, turned to random orientations, pushed back by the rendered force.

use glam::{DQuat, DVec3};
use pliant_spatial::{Pose, rotation_vector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::bodies::TOOL_LENGTH;

/// Fastest hand [m/s].
pub const MAX_SPEED: f64 = 1.0;
/// Fastest turn [rad/s].
pub const MAX_RATE: f64 = 10.0;

const MASS: f64 = 0.15;
const STIFFNESS: f64 = 900.0;
const DAMPING: f64 = 14.0;
/// The part of the rendered force that reaches the hand is capped here [N], so that it can push deep.
const MAX_FEEDBACK: f64 = 20.0;

/// Random hand of one campaign run.
#[derive(Clone, Debug)]
pub struct RandomHand {
    random: ChaCha8Rng,
    /// Half extent of the region the tool's middle is drawn to [m].
    reach: DVec3,
    pose: Pose,
    velocity: DVec3,
    target: DVec3,
    orientation: DQuat,
    rate: f64,
    remaining: f64,
}

impl RandomHand {
    /// Starts above the objects, the tool pointing down.
    pub fn new(seed: u64, reach: DVec3) -> Self {
        let pose = Pose::new(
            DQuat::from_rotation_arc(DVec3::X, -DVec3::Z),
            DVec3::new(0.0, 0.0, reach.z + 0.02 + TOOL_LENGTH),
        );
        Self {
            random: ChaCha8Rng::seed_from_u64(seed),
            reach,
            pose,
            velocity: DVec3::ZERO,
            target: pose.translation,
            orientation: pose.rotation,
            rate: 1.0,
            remaining: 0.0,
        }
    }

    /// Where the hand is.
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Moves by `dt` [s] under the force [N] it feels.
    pub fn advance(&mut self, force: DVec3, dt: f64) -> Pose {
        self.remaining -= dt;
        if self.remaining <= 0.0 {
            self.choose();
        }
        let feedback = force.clamp_length_max(MAX_FEEDBACK);
        let pull = (self.target - self.pose.translation) * STIFFNESS - self.velocity * DAMPING;
        self.velocity =
            (self.velocity + (pull + feedback) * (dt / MASS)).clamp_length_max(MAX_SPEED);
        self.pose.translation += self.velocity * dt;
        let away = rotation_vector(self.orientation * self.pose.rotation.conjugate());
        let turn = away.clamp_length_max(self.rate * dt);
        self.pose.rotation = (DQuat::from_scaled_axis(turn) * self.pose.rotation).normalize();
        self.pose
    }

    /// A new target: the tool's tip or middle on its way into or along the objects, a new orientation, a new turning rate. One in four is a
    /// side swing: the handle stays and the tool turns by up to a right angle as fast as a hand can.
    fn choose(&mut self) {
        let mut number = |low: f64, high: f64| self.random.random_range(low..high);
        let swing = number(0.0, 1.0) < 0.25;
        self.remaining = number(0.03, 0.15);
        if swing {
            let axis = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0));
            let turn = DQuat::from_scaled_axis(axis.normalize_or(DVec3::Z) * number(0.5, 1.6));
            self.orientation = (turn * self.pose.rotation).normalize();
            self.rate = MAX_RATE;
            return;
        }
        let axis = DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.6, 0.6));
        let roll = DQuat::from_rotation_x(number(-3.0, 3.0));
        self.orientation =
            (DQuat::from_rotation_arc(DVec3::X, axis.normalize_or(-DVec3::Z)) * roll).normalize();
        self.rate = number(0.2, MAX_RATE);
        let along = number(0.4, 1.0) * TOOL_LENGTH;
        let goal = self.reach * DVec3::new(number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 0.8));
        self.target = goal - self.orientation * DVec3::X * along;
    }
}
