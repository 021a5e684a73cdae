//! Rigid tools on convex objects by certified separating planes.
//!
//! The visual tool takes the orientation of the haptic tool and is, in position, the point nearest to it in the free convex cell that its
//! separating planes bound. One plane per (obstacle, segment) pair; its normal comes from closest-point detection and counts
//! only when certified by two support calls, so no tick can penetrate or tunnel from a free start. Detection of contact, sliding,
//! walking over features and release are not separate steps: they are the multipliers of one small problem, solved again with
//! fresh normals until it stands still. With a single plane the visual tool moves by exactly the C of Laycock & Day (2003, eq. 2),
//! without drift.
//!
//! The rigid limit of the constraint-based six-degree-of-freedom proxy (Ortega, Redon & Coquillart 2007), with positions instead of
//! accelerations, and of the god-object of Zilles & Salisbury (1995), with a tool instead of a point.

mod cell;
mod feature;
mod patch;
mod report;
mod shading;
mod slab;
mod start;

use glam::{DQuat, DVec3};
use pliant_mesh::ConvexMesh;
use pliant_spatial::{Pose, rotation_vector};

pub use cell::SKIN;
use cell::{Bodies, Cell};
use report::{Pull, Reporter};

use crate::qp::{ActiveSet, nearest_point};
use crate::{Contact, Obstacle};

/// Detection and projection are repeated at most this often in a tick; at 8 no test motion leaves a residual, at 4 one tick in 10⁴ does.
const MAX_ROUNDS: u32 = 24;
/// Standing still: the tool moved less than this [m] ...
const STILL: f64 = 1e-9;
/// ... and no holding normal turned by more than this (chord of unit vectors). Both are needed: near corners steps halve while the
/// normal still turns.
const STEADY_NORMAL: f64 = 1e-4;
/// Attempts to reach the haptic orientation, each with a halved turn after a failure.
const TURN_ATTEMPTS: u32 = 8;

/// A turn by Δθ changes plane offsets by at most Δθ times the tool's reach; a wedge between planes amplifies that. Beyond this factor (a wedge of
/// 29°) the turn counts as impossible: in a slot narrower than the turned tool the planes are almost opposite, and the point
/// where they meet lies anywhere along the slot.
const MAX_AMPLIFICATION: f64 = 4.0;

/// Planes that can press at once.
pub const MAX_CONTACTS: usize = 3;

/// Result of one tick.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedOutcome {
    /// Handle pose of the visual tool.
    pub world_from_visual: Pose,
    /// Pressing contacts, the strongest first.
    contacts: [Option<Contact>; MAX_CONTACTS],
    /// Displacement [m] whose product with the coupling stiffness is the force on the hand: visual minus haptic position, its
    /// direction shaded where an obstacle asks for it.
    pub push: DVec3,
    /// Moment of that displacement about the haptic handle origin [m²]: times the stiffness it is the torque.
    pub moment: DVec3,
    /// The haptic orientation could not be reached; the last free one is kept.
    pub held: bool,
    /// The round cap was reached: the pose is valid but may still move next tick.
    pub capped: bool,
    /// Rounds of detection and projection used.
    pub rounds: u32,
    /// The tool started inside obstacles and no common exit has been found yet: no force.
    pub inside: bool,
}

impl ConstrainedOutcome {
    /// Pressing contacts, the strongest first.
    pub fn contacts(&self) -> impl Iterator<Item = &Contact> {
        self.contacts.iter().flatten()
    }
}

/// The visual tool and its separating planes.
#[derive(Clone, Debug)]
pub struct ConstrainedTracker {
    cell: Cell,
    reporter: Reporter,
    /// Farthest point of the tool from the handle origin [m].
    reach: f64,
    separated: bool,
    started_inside: bool,
}

/// What one tick's search ended with.
struct Search {
    active: ActiveSet,
    rounds: u32,
    capped: bool,
}

impl ConstrainedTracker {
    /// A visual tool at the haptic pose; where it overlaps, it leaves each obstacle along one normal, the shallowest exit.
    /// `segments` are in the handle frame.
    pub fn new(obstacles: &[Obstacle], segments: &[ConvexMesh], world_from_haptic: Pose) -> Self {
        let bodies = Bodies {
            obstacles,
            segments,
        };
        let mut cell = Cell::new(bodies, world_from_haptic);
        let start = start::separate(&mut cell, bodies, world_from_haptic);
        Self {
            cell,
            reporter: Reporter::new(bodies),
            reach: segments
                .iter()
                .flat_map(ConvexMesh::positions)
                .map(|p| p.length())
                .fold(0.0, f64::max),
            separated: start != start::Start::Inside,
            started_inside: start != start::Start::Free,
        }
    }

    /// Handle pose of the visual tool.
    pub fn world_from_visual(&self) -> Pose {
        self.cell.pose
    }

    /// The tool overlapped an obstacle when it was created.
    pub fn started_inside(&self) -> bool {
        self.started_inside
    }

    /// Smallest gap over all pairs, certified by support calls along the kept normals [m].
    pub fn certified_gap(&self) -> f64 {
        self.cell.smallest_gap()
    }

    /// Kept unit normal (world, obstacle to tool) and certified gap [m] of a pair, for judges and drawings.
    ///
    /// # Panics
    /// When there is no such obstacle or segment.
    pub fn separating_plane(&self, object: u32, segment: u32) -> (DVec3, f64) {
        let pair = self.cell.group(object as usize).start + segment as usize;
        (self.cell.pairs[pair].normal, self.cell.gap(pair))
    }

    /// One tick: the visual tool turns with `world_from_haptic` and moves to the free point nearest to `target`, which is the haptic
    /// position or, with a damped coupling, the point the coupling pulls to. A pose that is no placement, a target that is not finite, or
    /// bodies of another number than at creation change nothing and press nothing. Allocates nothing.
    pub fn advance(
        &mut self,
        obstacles: &[Obstacle],
        segments: &[ConvexMesh],
        world_from_haptic: &Pose,
        target: DVec3,
    ) -> ConstrainedOutcome {
        let bodies = Bodies {
            obstacles,
            segments,
        };
        let usable = world_from_haptic.is_placement() && target.is_finite();
        if !usable || !self.cell.fits(bodies) {
            return self.outcome_without_contact();
        }
        if !self.separated {
            let start = start::separate(&mut self.cell, bodies, *world_from_haptic);
            self.separated = start != start::Start::Inside;
            if !self.separated {
                return self.outcome_without_contact();
            }
        }
        let (held, active) = self.turn(bodies, world_from_haptic, target);
        let search = self.settle(bodies, target, active);
        let report = self.reporter.report(
            &mut self.cell,
            bodies,
            &search.active,
            &Pull {
                haptic: world_from_haptic.translation,
                target,
            },
        );
        ConstrainedOutcome {
            world_from_visual: self.cell.pose,
            contacts: report.contacts,
            push: report.push,
            moment: report.moment,
            held,
            capped: search.capped,
            rounds: search.rounds,
            inside: false,
        }
    }

    /// Forgets which side of the obstacles the tool is on: the next tick places it anew, as at creation.
    pub fn restart(&mut self) {
        self.separated = false;
    }

    fn outcome_without_contact(&self) -> ConstrainedOutcome {
        ConstrainedOutcome {
            world_from_visual: self.cell.pose,
            contacts: [None; MAX_CONTACTS],
            push: DVec3::ZERO,
            moment: DVec3::ZERO,
            held: true,
            capped: false,
            rounds: 0,
            inside: !self.separated,
        }
    }

    /// Takes over the haptic orientation with the kept normals (contact.4); when no position near is free at it, half the turn is tried,
    /// with detection after each success. Returns whether the tool is held short of it, and the planes that hold the position.
    fn turn(
        &mut self,
        bodies: Bodies<'_>,
        world_from_haptic: &Pose,
        target: DVec3,
    ) -> (bool, ActiveSet) {
        let mut part = 1.0;
        let mut refreshed = false;
        for _ in 0..TURN_ATTEMPTS {
            let free = self.cell.pose.rotation;
            let wanted = if part < 1.0 {
                free.slerp(world_from_haptic.rotation, part).normalize()
            } else {
                world_from_haptic.rotation
            };
            if let Some(active) = self.try_orientation(bodies, wanted, target) {
                if part >= 1.0 {
                    return (false, active);
                }
                self.cell.refresh_all(bodies);
                part = (2.0 * part).min(1.0);
            } else if refreshed {
                part *= 0.5;
            } else {
                // Normals of planes that were slack may be stale: they forbid more than the obstacles do. Fresh ones end one in eleven
                // holds in slots.
                self.cell.refresh_all(bodies);
                refreshed = true;
            }
        }
        let active = self.project(target).unwrap_or_default();
        (true, active)
    }

    /// Turns to `wanted` and moves to the nearest free position, or changes nothing when there is none or it lies out of proportion to
    /// the turn (contact.13).
    fn try_orientation(
        &mut self,
        bodies: Bodies<'_>,
        wanted: DQuat,
        target: DVec3,
    ) -> Option<ActiveSet> {
        let before = self.cell.pose;
        let angle = rotation_vector(wanted * before.rotation.conjugate()).length();
        if angle <= 0.0 {
            return self.project(target);
        }
        self.cell.save();
        self.cell.turn(bodies, wanted);
        let Some((position, active)) = nearest_point(self.cell.planes(), target) else {
            self.cell.swap_saved();
            return None;
        };
        let allowance = MAX_AMPLIFICATION * self.reach * angle;
        if (position - before.translation).length() > allowance {
            // The hand's own motion is no part of the turn: compare with where the tool would be without it.
            self.cell.swap_saved();
            let unturned = nearest_point(self.cell.planes(), target)
                .map_or(before.translation, |(position, _)| position);
            if (position - unturned).length() > allowance + STILL {
                return None;
            }
            self.cell.swap_saved();
        }
        self.cell.pose.translation = position;
        Some(active)
    }

    /// Moves to the point of the cell nearest to `target`; `None`, and no move, when rounding leaves the cell empty.
    fn project(&mut self, target: DVec3) -> Option<ActiveSet> {
        let (position, active) = nearest_point(self.cell.planes(), target)?;
        self.cell.pose.translation = position;
        Some(active)
    }

    /// Detection at the planes that hold, then projection, until nothing moves (contact.7). Every iterate is free, so the cap is graceful.
    fn settle(&mut self, bodies: Bodies<'_>, target: DVec3, active: ActiveSet) -> Search {
        let mut active = active;
        for round in 1..=MAX_ROUNDS {
            if active.is_empty() {
                return Search {
                    active,
                    rounds: round - 1,
                    capped: false,
                };
            }
            let turned = self.cell.refresh_active(bodies, &active);
            let before = self.cell.pose.translation;
            let Some(next) = self.project(target) else {
                return Search {
                    active,
                    rounds: round,
                    capped: true,
                };
            };
            active = next;
            let moved = (self.cell.pose.translation - before).length();
            if moved < STILL && turned < STEADY_NORMAL && self.cell.is_fresh(&active) {
                return Search {
                    active,
                    rounds: round,
                    capped: false,
                };
            }
        }
        Search {
            active,
            rounds: MAX_ROUNDS,
            capped: true,
        }
    }
}
