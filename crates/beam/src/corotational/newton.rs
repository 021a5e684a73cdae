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

/// Rounds of inverse iteration for the direction of that kick.
const INVERSE_ROUNDS: u32 = 4;

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Last step at which a solution counts as found: turns [rad], and displacements by the beam's length.
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
    /// The last step was within the tolerance and the whole load is on.
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

/// One run of Newton's method at one load.
struct Run {
    converged: bool,
    iterations: u32,
    step: f64,
    definiteness: Definiteness,
}

impl Corotational {
    /// Iterates from the present shape with the whole load, at most so often, and keeps what it has: for a tick. The next call
    /// carries on from there. A beam thrown off course comes back to its last shape. Allocates nothing.
    pub fn iterate(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Outcome {
        self.held.copy_from(&self.state);
        let run = self.newton(loads, 1.0, settings);
        let lost = !run.step.is_finite();
        if lost {
            self.state.copy_from(&self.held);
        }
        self.outcome(&run, if lost { 0.0 } else { 1.0 })
    }

    /// Solves from the present shape, if need be from rest and in parts, and leaves an unstable shape for a stable one. Where a load
    /// cannot be held, the shape is that of the largest part which can, and the outcome says so. Allocates nothing.
    pub fn solve(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Outcome {
        let from = self.newton(loads, 1.0, settings);
        let mut outcome = self.outcome(&from, 1.0);
        if !from.converged {
            self.reset();
            outcome = self.in_parts(loads, settings, from.iterations);
        }
        if outcome.converged
            && outcome.stability == Stability::Unstable
            && loads.followers.is_empty()
        {
            outcome = self.leave_unstable(loads, settings, outcome);
        }
        outcome
    }

    fn outcome(&self, run: &Run, held: f64) -> Outcome {
        Outcome {
            converged: run.converged && held >= 1.0,
            held,
            iterations: run.iterations,
            step: run.step,
            stability: match run.definiteness {
                Definiteness::Positive => Stability::Stable,
                Definiteness::Indefinite(_) | Definiteness::Singular => Stability::Unstable,
            },
        }
    }

    /// Raises the load from nothing: parts that fail are halved, parts that go well doubled.
    fn in_parts(&mut self, loads: &AnchoredLoads, settings: &Settings, before: u32) -> Outcome {
        let (mut held, mut part) = (0.0, 0.5);
        let mut iterations = before;
        self.held.copy_from(&self.state);
        loop {
            let share = f64::min(held + part, 1.0);
            let mut run = self.newton(loads, share, settings);
            iterations += run.iterations;
            run.iterations = iterations;
            if run.converged {
                held = share;
                self.held.copy_from(&self.state);
                if held >= 1.0 {
                    return self.outcome(&run, held);
                }
                part = f64::min(2.0 * part, 1.0 - held);
            } else {
                self.state.copy_from(&self.held);
                part *= 0.5;
                if part < FINEST_PART {
                    return self.outcome(&run, held);
                }
            }
        }
    }

    /// Newton's method at a share of the load.
    fn newton(&mut self, loads: &AnchoredLoads, share: f64, settings: &Settings) -> Run {
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
            run.definiteness = self.tangent.factorise();
            if run.definiteness == Definiteness::Singular {
                run.step = f64::NAN;
                return run;
            }
            self.tangent.solve(&mut self.unknowns);
            run.iterations += 1;
            run.step = self.step_size();
            if !run.step.is_finite() {
                return run;
            }
            self.advance((LONGEST_TURN / run.step).min(1.0));
            if run.step <= settings.tolerance {
                run.converged = true;
                return run;
            }
        }
        run
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
            if let Some(descent) = self.descend(loads, settings) {
                iterations += descent;
                let run = self.newton(loads, 1.0, settings);
                iterations += run.iterations;
                if run.converged && run.definiteness == Definiteness::Positive {
                    return Outcome {
                        iterations,
                        step: run.step,
                        stability: Stability::Buckled,
                        ..unstable
                    };
                }
            }
        }
        self.state.copy_from(&self.held);
        Outcome {
            iterations,
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
    fn descend(&mut self, loads: &AnchoredLoads, settings: &Settings) -> Option<u32> {
        // Springs to the present place, in units of the tip's bending stiffness.
        let first = self.stiffness[0].natural.rotations[0];
        let moment = first.y_axis.y.min(first.z_axis.z) * self.beam.elements()[0].chord;
        let length = self.beam.length();
        let unit = moment / (length * length);
        let mut springs = 1.0;
        for iteration in 0..10 * settings.most_iterations {
            self.assemble(loads, 1.0)?;
            let residual_step = self.shifted_step(unit, springs)?;
            if residual_step == Definiteness::Positive {
                let step = self.step_size();
                if !step.is_finite() {
                    return None;
                }
                self.advance((0.5 * LONGEST_TURN / step).min(1.0));
                if step < 1e-3 && springs <= 1.0 / 64.0 {
                    return Some(iteration);
                }
                springs *= 0.5;
            } else {
                springs *= 4.0;
            }
        }
        None
    }

    /// The step of the present residual with springs on the diagonal.
    fn shifted_step(&mut self, unit: f64, springs: f64) -> Option<Definiteness> {
        let share = unit * springs / self.unknowns.len() as f64;
        let length = self.beam.length();
        let (diagonal, _, _) = self.tangent.blocks();
        for block in diagonal {
            for axis in 0..3 {
                block[axis][axis] += share / length;
                block[3 + axis][3 + axis] += share * length * 1e-2;
            }
        }
        match self.tangent.factorise() {
            Definiteness::Singular => None,
            definiteness => {
                if definiteness == Definiteness::Positive {
                    self.tangent.solve(&mut self.unknowns);
                }
                Some(definiteness)
            }
        }
    }
}
