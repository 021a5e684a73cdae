//! The shallowest way out of an overlap on rims: EPA that leaves what is smooth to Newton.
//!
//! On rims a polytope approaches the difference with the square of its faces' size, and around a common axis, where all
//! directions are nearly equally deep, no number of faces ends EPA. Here a face grows only until it is flat enough and
//! its support lies on features that its own corners are on. From then on these features are smooth functions of the
//! direction, and (collision.11) settles them, once for each combination under the faces lower than the best answer. An answer
//! remembered bounds the depth from the start, and is kept where no other is shallower by more than [`TIE`].

use glam::DVec3;

use crate::epa::polytope::{Growth, Polytope};
use crate::epa::{grow, largest, nearest_to};
use crate::gjk::{ClosestPoints, GAP_TOLERANCE, Plane, touched};
use crate::rims::{self, Answer, Memory};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

/// Depth by which another direction must be shallower than the remembered one, times the largest coordinate.
const TIE: f64 = 1e-12;

/// How far the difference reaches over a face that is left to Newton, times that reach: about 0.2 rad of a circle.
const FLAT: f64 = 0.005;

/// The same where Newton's method has left the face's surroundings by more than steps downhill.
const FINE: f64 = 0.0005;

/// Faces that grow for that reason in one sweep: it bounds the time where all directions are nearly equally deep.
const PATIENCE: u32 = 24;

/// Of an answer that is given up for a search without the memory, with more faces, times the largest coordinate.
const DOUBT: f64 = 1e-12;

/// Most combinations of features that are settled in one sweep.
const MOST_FEATURES: usize = 96;

/// The best of the answers settled.
struct Best {
    answer: Option<Answer>,
    merit: f64,
    /// No direction is deeper than this [m], cores only.
    bound: f64,
    seen: [u64; MOST_FEATURES],
    count: usize,
    /// Faces that may still grow because Newton's method leads away from them.
    patience: u32,
}

/// The shallowest way out, and what to start from next time. `None` where buffers end or nothing settles. Allocates nothing.
#[inline(never)]
pub(super) fn sweep<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    tetrahedron: &[DifferencePoint; 4],
    memory: &Memory,
) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut polytope = Polytope::<128, 256>::empty();
    polytope.start(tetrahedron);
    let scale = largest(polytope.vertices());
    let tolerance = GAP_TOLERANCE * scale;
    let radii = difference.a.radius() + difference.b.radius();
    let mut best = Best::from(rims::resume(difference, memory), radii);
    best.consider_opposite(difference, scale);
    best.consider_discs(difference, tetrahedron, scale);
    while let Some(face) = polytope.lowest_open_face() {
        let (outward, height) = polytope.plane(face);
        if height >= best.bound - tolerance {
            break;
        }
        let corners = polytope.corners(face);
        let support = difference.support(outward, &corners[0]);
        let reach = outward.dot(support.point);
        let gap = reach - height;
        let known = polytope.contains_vertex(&support);
        if known
            || gap <= FLAT * reach + tolerance
                && rims::shares_features(difference, &corners, &support)
        {
            let believed = best.consider(difference, &corners, outward, [reach, gap], scale);
            let fine = gap <= FINE * reach + tolerance || best.patience == 0;
            best.patience -= u32::from(!(known || believed || fine));
            if known || believed || fine {
                polytope.close(face);
                continue;
            }
        }
        match grow(&mut polytope, face, support, tolerance) {
            Growth::Grown => {}
            Growth::Torn => {
                polytope.close(face);
                best.consider(difference, &corners, outward, [reach, gap], scale);
            }
            Growth::NoRoom => return None,
        }
    }
    if best.count == MOST_FEATURES {
        return None;
    }
    let closed = |answer: &Answer| answer.found.doubt() <= DOUBT * scale;
    best.answer.filter(closed)
}

impl Best {
    fn from(remembered: Option<Answer>, radii: f64) -> Self {
        let merit = remembered.map_or(f64::NEG_INFINITY, |answer| merit(&answer.found));
        let bound = remembered.map_or(f64::INFINITY, |answer| -answer.found.separation - radii);
        Self {
            answer: remembered,
            merit,
            bound,
            seen: [0; MOST_FEATURES],
            count: 0,
            patience: PATIENCE,
        }
    }

    /// Settles the features under a face unless they have been.
    fn consider<A, B>(
        &mut self,
        difference: &MinkowskiDifference<'_, A, B>,
        corners: &[DifferencePoint; 3],
        outward: DVec3,
        [reach, gap]: [f64; 2],
        scale: f64,
    ) -> bool
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let key = rims::key(difference, corners, outward);
        if self.seen[..self.count].contains(&key) {
            return true;
        }
        let plane = Plane {
            normal: -outward,
            separation: -reach,
            simplex: nearest_to(outward * reach, std::iter::once(*corners)).1,
        };
        let known = self.answer.map(|answer| answer.memory).unwrap_or_default();
        let around = 2.0 * (2.0 * gap.max(0.0) / reach).sqrt();
        let (wandered, answer) =
            rims::settle_elsewhere(difference, &plane, corners, &known, around);
        if !wandered && self.count < MOST_FEATURES {
            self.seen[self.count] = key;
            self.count += 1;
        }
        let answer = answer.unwrap_or_else(|| Answer {
            found: touched(difference, &plane),
            memory: Memory::default(),
        });
        self.offer(difference, answer, scale);
        !wandered
    }

    /// Against the remembered way out: on symmetric shapes the two change places.
    fn consider_opposite<A, B>(&mut self, difference: &MinkowskiDifference<'_, A, B>, scale: f64)
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let Some(answer) = self.answer else { return };
        let outward = answer.found.normal;
        let support = difference.support(outward, &DifferencePoint::NONE);
        let reach = outward.dot(support.point);
        if reach <= (1.0 + FLAT) * self.bound
            && let Some(answer) = rims::settle_towards(difference, outward)
        {
            self.offer(difference, answer, scale);
        }
    }

    /// The ways out square to the discs, which no number of chords of a rim tells exactly.
    fn consider_discs<A, B>(
        &mut self,
        difference: &MinkowskiDifference<'_, A, B>,
        tetrahedron: &[DifferencePoint; 4],
        scale: f64,
    ) where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        for outward in rims::axes(difference, &tetrahedron[0]) {
            if let Some(answer) = rims::through_disc(difference, outward) {
                self.offer(difference, answer, scale);
            }
        }
    }

    fn offer<A, B>(
        &mut self,
        difference: &MinkowskiDifference<'_, A, B>,
        answer: Answer,
        scale: f64,
    ) where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let own = merit(&answer.found);
        if own > self.merit + TIE * scale {
            self.merit = own;
            self.answer = Some(answer);
            let radii = difference.a.radius() + difference.b.radius();
            self.bound = self.bound.min(-answer.found.separation - radii);
        }
    }
}

/// Of equally deep ones that with the better witnesses.
fn merit(found: &ClosestPoints) -> f64 {
    found.separation - found.doubt()
}
