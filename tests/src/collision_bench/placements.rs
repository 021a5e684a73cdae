//! Placements of a benchmark: random ones, and sequences of 0.1 % of the size and 0.1° a step, each at a gap or depth imposed
//! along the normal.

use glam::{DQuat, DVec3};
use pliant_collision::{SimplexCache, SupportMap, closest_points};
use pliant_spatial::Pose;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use crate::collision::families::{power, rotation};
use crate::collision::kinds::unit;

/// Steps of a coherent sequence.
pub const STEPS: usize = 100;

/// How far in or out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// Gaps of 1e-3 to 1 of the size.
    Separated,
    /// Depths of this part of the size.
    Deep(f64),
}

/// Two shapes and the smaller one's size [m].
pub struct Pair<'s, A, B> {
    /// At rest.
    pub a: &'s A,
    /// Moved.
    pub b: &'s B,
    /// Of the smaller [m].
    pub size: f64,
    /// Distance at which they are apart whatever their turn [m].
    pub reach: f64,
}

impl<A: SupportMap, B: SupportMap> Pair<'_, A, B> {
    /// A random placement in a state.
    pub fn random(&self, state: State, random: &mut ChaCha8Rng) -> Pose {
        let separation = self.separation(state, random);
        self.start(separation, random)
    }

    /// A sequence in a state.
    pub fn sequence(&self, state: State, random: &mut ChaCha8Rng) -> Vec<Pose> {
        let separation = self.separation(state, random);
        let mut pose = self.start(separation, random);
        let turn = DQuat::from_axis_angle(unit(random), 0.1_f64.to_radians());
        let mut heading = unit(random);
        let mut poses = Vec::with_capacity(STEPS);
        while poses.len() < STEPS {
            poses.push(pose);
            // The heading wanders: a straight line would leave the shape.
            heading = (heading + 0.1 * unit(random)).normalize();
            let moved = Pose::new(
                (turn * pose.rotation).normalize(),
                pose.translation + heading * (1e-3 * self.size),
            );
            pose = self.imposed(moved, separation).unwrap_or(pose);
        }
        poses
    }

    fn separation(&self, state: State, random: &mut ChaCha8Rng) -> f64 {
        match state {
            State::Separated => self.size * power(random, -3.0, 0.0),
            State::Deep(part) => -part * self.size,
        }
    }

    fn start(&self, separation: f64, random: &mut ChaCha8Rng) -> Pose {
        loop {
            let direction = unit(random);
            let side = unit(random) * (self.size * random.random_range(0.0..0.4));
            let apart = Pose::new(rotation(random), direction * self.reach + side);
            if let Some(pose) = self.imposed(apart, separation) {
                return pose;
            }
        }
    }

    /// Moved along the normal until the separation is the one wanted.
    fn imposed(&self, mut pose: Pose, separation: f64) -> Option<Pose> {
        for _ in 0..16 {
            let mut cache = SimplexCache::default();
            let found = closest_points(self.a, self.b, &pose, &mut cache);
            let miss = found.separation - separation;
            if miss.abs() < 1e-9 * self.size {
                return Some(pose);
            }
            pose.translation -= found.normal * miss;
        }
        None
    }
}

/// Largest distance of a shape's surface from its frame's origin [m].
pub fn reach(shape: &impl SupportMap) -> f64 {
    extent(shape, |low, high| low.abs().max(high.abs()))
}

/// Largest side of the box around a shape [m].
pub fn size(shape: &impl SupportMap) -> f64 {
    extent(shape, |low, high| high - low)
}

fn extent(shape: &impl SupportMap, measure: impl Fn(f64, f64) -> f64) -> f64 {
    DVec3::AXES
        .into_iter()
        .map(|axis| {
            let top = shape.support(axis, 0).point.dot(axis) + shape.radius();
            let bottom = shape.support(-axis, 0).point.dot(axis) - shape.radius();
            measure(bottom, top)
        })
        .fold(0.0, f64::max)
}
