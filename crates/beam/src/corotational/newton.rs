//! Newton's method with safeguards: steps of bounded turn, loads raised in parts when all at once fails, and the way off an
//! unstable equilibrium (beam.25).

use glam::DVec3;

use crate::corotational::{AnchoredLoads, Corotational};
use crate::linear::Definiteness;

/// Largest turn of a node in one step [rad]: beyond, the tangent says little.
const LONGEST_TURN: f64 = 0.5;

/// Parts into which loads are divided at the most, each a power of two.
const FINEST_PART: f64 = 1.0 / 1024.0;

/// Turn of the node that turns most in the kick off an unstable equilibrium [rad].
const KICK: f64 = 0.05;

/// Springs, in units of the beam's bending stiffness, that every step has: a round beam that has buckled is as happy with any turn of
/// its shape about the load, and without them rounding would take it there. They cost a step at most.
const STEADY: f64 = 1e-3;

/// Residual, times the largest load, that is rounding of the stiffest elements: where nothing else holds a shape, as the turn of a
/// buckled round beam about its load, it makes steps without end.
const FAINT: f64 = 1e-9;

/// Longest of such steps [rad].
const WANDER: f64 = 2e-3;

/// The springs with which a shape that [`Corotational::solve`] finds must be stable.
const NEUTRAL: f64 = 1e-6;

/// Rounds of inverse iteration for the direction of that kick.
const INVERSE_ROUNDS: u32 = 4;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Last step at which a solution counts as found, next one in a tick: turns [rad], and displacements by the beam's length.
    pub tolerance: f64,
    /// Iterations of one solution, per part of the load.
    pub most_iterations: u32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-9,
            most_iterations: 30,
        }
    }
}

/// Whether a solution would stay by itself, as dead loads tell; follower loads leave it open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stability {
    /// It stays.
    Stable,
    /// The loads were above a critical one, and the beam has left the unstable shape for a stable one beside it.
    Buckled,
    /// It is in balance, but the least disturbance would take it away.
    Unstable,
}

/// What became of a solution.
#[derive(Clone, Copy, Debug, PartialEq)]
#[must_use]
pub struct Outcome {
    /// Within the tolerance, and the whole load is on.
    pub converged: bool,
    /// Part of the load that the present shape holds, 0 to 1.
    pub held: f64,
    /// Iterations in all.
    pub iterations: u32,
    /// Size of the last step: the largest turn [rad] or displacement by the beam's length.
    pub step: f64,
    /// Whether the shape is stable.
    pub stability: Stability,
}

/// When a solution counts as found.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stop {
    /// The last step was short.
    Seen,
    /// The next would be, as steps have shrunk.
    Estimated,
}

/// One run of Newton's method at one load.
struct Run {
    converged: bool,
    iterations: u32,
    step: f64,
    definiteness: Definiteness,
}

impl Corotational {
    /// Iterates from the present shape with the whole load, at most so often, until the next step would be within the tolerance, and
    /// keeps what it has: for a tick. The next call
    /// carries on from there. A beam thrown off course comes back to its last shape. Allocates nothing.
    pub fn iterate(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Outcome {
        self.held.copy_from(&self.state);
        let run = self.newton(loads, (1.0, Stop::Estimated), settings);
        let lost = !run.step.is_finite();
        if lost {
            self.state.copy_from(&self.held);
        }
        run.outcome(if lost { 0.0 } else { 1.0 })
    }

    /// Solves from the present shape, if need be from rest and in parts, and leaves an unstable shape for a stable one. Where a load
    /// cannot be held, the shape is that of the largest part which can, and the outcome says so. Allocates nothing.
    pub fn solve(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Outcome {
        let from = self.newton(loads, (1.0, Stop::Seen), settings);
        let mut outcome = from.outcome(1.0);
        if !from.converged {
            self.reset();
            outcome = self.in_parts(loads, settings, from.iterations);
        }
        if outcome.converged && loads.followers.is_empty() && self.is_unstable(loads) {
            outcome = self.leave_unstable(loads, settings, outcome);
        }
        outcome
    }

    /// Raises the load from nothing: parts that fail are halved, parts that go well doubled.
    fn in_parts(&mut self, loads: &AnchoredLoads, settings: &Settings, before: u32) -> Outcome {
        let (mut held, mut part) = (0.0, 0.5);
        let mut iterations = before;
        self.held.copy_from(&self.state);
        loop {
            let share = f64::min(held + part, 1.0);
            let mut run = self.newton(loads, (share, Stop::Seen), settings);
            iterations += run.iterations;
            run.iterations = iterations;
            if run.converged {
                held = share;
                self.held.copy_from(&self.state);
                if held >= 1.0 {
                    return run.outcome(held);
                }
                part = f64::min(2.0 * part, 1.0 - held);
            } else {
                self.state.copy_from(&self.held);
                part *= 0.5;
                if part < FINEST_PART {
                    return run.outcome(held);
                }
            }
        }
    }

    /// Newton's method at a share of the load.
    fn newton(
        &mut self,
        loads: &AnchoredLoads,
        (share, stop): (f64, Stop),
        settings: &Settings,
    ) -> Run {
        let mut run = Run {
            converged: false,
            iterations: 0,
            step: f64::INFINITY,
            definiteness: Definiteness::Singular,
        };
        while run.iterations < settings.most_iterations {
            if self.assemble(loads, share).is_none() {
                run.step = f64::NAN;
                return run;
            }
            let faint = self.residual_size() <= FAINT * share * loads.size(self.beam.length());
            self.add_springs(STEADY);
            run.definiteness = self.tangent.factorise();
            if run.definiteness == Definiteness::Singular {
                run.step = f64::NAN;
                return run;
            }
            self.tangent.solve(&mut self.unknowns);
            run.iterations += 1;
            let before = run.step;
            run.step = self.step_size();
            if !run.step.is_finite() {
                return run;
            }
            if faint && run.step <= WANDER && run.step > 0.1 * before {
                run.converged = true;
                return run;
            }
            self.advance((LONGEST_TURN / run.step).min(1.0));
            // Steps shrink at least as fast as they just did.
            let left = match stop {
                Stop::Estimated if before.is_finite() && run.step < before => {
                    run.step * (run.step / before)
                }
                _ => run.step,
            };
            if left <= settings.tolerance {
                run.converged = true;
                return run;
            }
        }
        run
    }

    /// Whether the least disturbance would take the present shape away. Leaves the tangent factorised.
    fn is_unstable(&mut self, loads: &AnchoredLoads) -> bool {
        if self.assemble(loads, 1.0).is_none() {
            return true;
        }
        self.add_springs(NEUTRAL);
        self.tangent.factorise() != Definiteness::Positive
    }

    /// The largest force, or moment by the beam's length, of the residual in `unknowns` [N].
    fn residual_size(&self) -> f64 {
        let per_length = 1.0 / self.beam.length();
        self.unknowns.iter().fold(0.0, |largest: f64, residual| {
            let force = DVec3::from_slice(&residual[..3]).length();
            let moment = DVec3::from_slice(&residual[3..]).length() * per_length;
            largest.max(force).max(moment)
        })
    }

    /// The largest turn [rad] or displacement by the beam's length of the step in `unknowns`.
    fn step_size(&self) -> f64 {
        let per_length = 1.0 / self.beam.length();
        self.unknowns.iter().fold(0.0, |largest: f64, step| {
            let moved = DVec3::from_slice(&step[..3]).length() * per_length;
            let turned = DVec3::from_slice(&step[3..]).length();
            // Unlike `max` this keeps what is not a number.
            let own = if moved > turned { moved } else { turned };
            if own <= largest { largest } else { own }
        })
    }

    /// From an unstable equilibrium down to a stable one: a kick along its softest shape, then steps that can only go down, the
    /// tangent made definite by springs to where the beam is.
    fn leave_unstable(
        &mut self,
        loads: &AnchoredLoads,
        settings: &Settings,
        unstable: Outcome,
    ) -> Outcome {
        self.held.copy_from(&self.state);
        let mut iterations = unstable.iterations;
        self.softest_shape();
        let size = self.step_size();
        if size.is_finite() && size > 0.0 {
            self.turn_without_stretch(KICK / size);
            if let Some((descent, step)) = self.descend(loads, settings) {
                return Outcome {
                    iterations: iterations + descent,
                    step,
                    stability: Stability::Buckled,
                    ..unstable
                };
            }
            iterations += 10 * settings.most_iterations;
        }
        self.state.copy_from(&self.held);
        Outcome {
            iterations,
            stability: Stability::Unstable,
            ..unstable
        }
    }

    /// The shape in which the present tangent, already factorised, is softest, into `unknowns`: inverse iteration from a bend
    /// mostly about y, so that of equal ways out always the same is taken.
    fn softest_shape(&mut self) {
        let count = self.unknowns.len();
        for (node, unknown) in self.unknowns.iter_mut().enumerate() {
            let along = (node + 1) as f64 / count as f64;
            *unknown = [0.0, 0.6 * along, along, 0.0, 0.0, 0.0];
        }
        for _ in 0..INVERSE_ROUNDS {
            self.tangent.solve(&mut self.unknowns);
            let size = self.step_size();
            let upward = self.unknowns[count - 1][2] >= 0.0;
            let factor = if upward { 1.0 } else { -1.0 } / size;
            for value in self.unknowns.iter_mut().flatten() {
                *value *= factor;
            }
        }
    }

    /// Steps downhill until the tangent itself is definite and steps are short. Returns the iterations, `None` if it did not get there.
    fn descend(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Option<(u32, f64)> {
        let mut springs = 1.0;
        for iteration in 1..=10 * settings.most_iterations {
            self.assemble(loads, 1.0)?;
            let faint = self.residual_size() <= FAINT * loads.size(self.beam.length());
            self.add_springs(springs);
            match self.tangent.factorise() {
                Definiteness::Singular => return None,
                Definiteness::Indefinite(_) => springs *= 4.0,
                Definiteness::Positive => {
                    self.tangent.solve(&mut self.unknowns);
                    let step = self.step_size();
                    if !step.is_finite() {
                        return None;
                    }
                    self.advance((0.5 * LONGEST_TURN / step).min(1.0));
                    let found = step <= settings.tolerance || faint && step <= WANDER;
                    if found && springs <= STEADY {
                        return Some((iteration, step));
                    }
                    springs = f64::max(0.5 * springs, STEADY);
                }
            }
        }
        None
    }

    /// Springs from every node to its present place, in units of the beam's own bending stiffness. They do not change what is in
    /// balance, only the steps to it.
    fn add_springs(&mut self, springs: f64) {
        let first = self.stiffness[0].natural.rotations[0];
        let moment = first.y_axis.y.min(first.z_axis.z) * self.beam.elements()[0].chord;
        let length = self.beam.length();
        let share = springs * moment / (length * length * self.unknowns.len() as f64);
        let (diagonal, _, _) = self.tangent.blocks();
        for block in diagonal {
            for axis in 0..3 {
                block[axis][axis] += share / length;
                block[3 + axis][3 + axis] += share * length * 1e-2;
            }
        }
    }
}

impl Run {
    fn outcome(&self, held: f64) -> Outcome {
        Outcome {
            converged: self.converged && held >= 1.0,
            held,
            iterations: self.iterations,
            step: self.step,
            stability: match self.definiteness {
                Definiteness::Positive => Stability::Stable,
                Definiteness::Indefinite(_) | Definiteness::Singular => Stability::Unstable,
            },
        }
    }
}
