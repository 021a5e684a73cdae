//! The verdict on one answer of the crate, by the oracle and by the answer's own certificate.

use glam::DVec3;
use pliant_collision::{ClosestPoints, SimplexCache, closest_points, distance, overlap};
use pliant_spatial::Pose;

use super::families::Pair;
use super::shape::Shape;
use super::truth::Oracle;

mod cast;

/// Largest error allowed, relative to the size.
pub const TOLERANCE: f64 = 1e-9;

/// Errors above this share of the size are counted: a good implementation leaves none on ordinary pairs.
pub const BLUR: f64 = 1e-12;

/// What a unit vector's length may be off.
const UNIT_SLACK: f64 = 1e-12;

/// Doubt of the oracle, relative to the coordinates, above which it is no judge.
const ORACLE_SLACK: f64 = 1e-12;

/// What an answer got wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fault {
    /// A number that is none.
    NotFinite,
    /// The signed distance.
    Separation,
    /// The length of the normal.
    NotUnit,
    /// The supporting planes across the normal are not as far apart as the separation says.
    Normal,
    /// The witness points are not apart by separation times normal.
    Contract,
    /// A witness point lies outside its shape.
    Outside,
    /// `distance` disagrees.
    Distance,
    /// `overlap` disagrees.
    Overlap,
    /// A cast along the normal does not hit after the separation, or one into overlap not at all.
    Cast,
    /// The plane of a cast's hit does not separate the shapes there and before.
    CastNormal,
    /// The point of a cast's hit is not on both shapes there.
    CastWitness,
    /// The answer proves the oracle wrong.
    Oracle,
}

/// How one answer went.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Error of the separation, relative to the size.
    pub error: f64,
    /// What went wrong, with how much of the size by.
    pub faults: Vec<(Fault, f64)>,
}

impl Verdict {
    fn limit(&mut self, fault: Fault, measure: f64, limit: f64) {
        // What is not a number is above every limit.
        if measure.is_nan() || measure > limit {
            self.faults.push((fault, measure));
        }
    }
}

/// A pair at a placement with the truth about it.
pub struct Question<'p> {
    shapes: [&'p Shape; 2],
    a_from_b: Pose,
    size: f64,
    oracle: Oracle<'p>,
    /// Signed distance of the rounded shapes [m].
    truth: f64,
    /// The oracle cannot say.
    pub undecided: bool,
    /// Error that rounding alone may cause [m].
    rounding: f64,
}

impl<'p> Question<'p> {
    /// Asks the oracle.
    pub fn new(pair: &'p Pair, a_from_b: &Pose) -> Self {
        let [a, b] = [&*pair.shapes[0], &*pair.shapes[1]];
        let oracle = Oracle::new(a, b, a_from_b);
        let far = |shape: &Shape| shape.core.vertices[0].length();
        let span = oracle.span() + far(a) + far(b);
        let (cores, doubt) = oracle.truth(|| {
            let mut cache = SimplexCache::default();
            a.with(|a| b.with(|b| closest_points(a, b, a_from_b, &mut cache).normal))
        });
        Self {
            shapes: [a, b],
            a_from_b: *a_from_b,
            size: pair.size,
            truth: cores - (a.radius + b.radius),
            undecided: doubt.is_nan() || doubt.abs() > ORACLE_SLACK * span,
            rounding: 1e-14 * span,
            oracle,
        }
    }

    /// The truth [m].
    pub fn separation(&self) -> f64 {
        self.truth
    }

    fn ask<R>(
        &self,
        f: impl FnOnce(&dyn pliant_collision::SupportMap, &dyn pliant_collision::SupportMap) -> R,
    ) -> R {
        let [a, b] = self.shapes;
        a.with(|a| b.with(|b| f(a, b)))
    }

    /// Judges the answer from `cache`.
    pub fn closest(&self, cache: &mut SimplexCache) -> Verdict {
        let found = self.ask(|a, b| closest_points(a, b, &self.a_from_b, cache));
        let mut verdict = Verdict::default();
        self.judge(&found, &mut verdict);
        verdict
    }

    /// Judges all other queries, from scratch and from the cache of another pair.
    pub fn others(&self, foreign: &SimplexCache) -> Verdict {
        let mut verdict = Verdict::default();
        self.swapped(&mut verdict);
        let mut cache = *foreign;
        let found = self.ask(|a, b| closest_points(a, b, &self.a_from_b, &mut cache));
        self.judge(&found, &mut verdict);
        // Within rounding of touching either answer is right.
        let band = BLUR * self.size + self.rounding;
        for cache in [SimplexCache::default(), *foreign] {
            let mut fresh = cache;
            let meets = self.ask(|a, b| overlap(a, b, &self.a_from_b, &mut fresh));
            if self.truth.abs() > band && meets != (self.truth < 0.0) {
                verdict
                    .faults
                    .push((Fault::Overlap, self.truth / self.size));
            }
            let mut fresh = cache;
            match self.ask(|a, b| distance(a, b, &self.a_from_b, &mut fresh)) {
                Some(found) => self.judge(&found, &mut verdict),
                None => verdict.limit(Fault::Distance, self.truth, band),
            }
        }
        self.casts(&found, &mut verdict);
        verdict
    }

    fn swapped(&self, verdict: &mut Verdict) {
        let back = self.a_from_b.rotation.conjugate();
        let b_from_a = Pose::new(back, -(back * self.a_from_b.translation));
        let mut cache = SimplexCache::default();
        let found = self.ask(|a, b| closest_points(b, a, &b_from_a, &mut cache));
        let there = |point: DVec3| self.a_from_b.rotation * point;
        self.judge(
            &ClosestPoints {
                witness_a: there(found.witness_b) + self.a_from_b.translation,
                witness_b: there(found.witness_a) + self.a_from_b.translation,
                normal: -there(found.normal),
                separation: found.separation,
            },
            verdict,
        );
    }

    fn judge(&self, found: &ClosestPoints, verdict: &mut Verdict) {
        let ClosestPoints {
            witness_a,
            witness_b,
            normal,
            separation,
        } = *found;
        let finite = witness_a.is_finite() && witness_b.is_finite() && normal.is_finite();
        if !finite || !separation.is_finite() {
            verdict.faults.push((Fault::NotFinite, f64::NAN));
            return;
        }
        let tolerance = TOLERANCE + self.rounding / self.size;
        let error = (separation - self.truth).abs() / self.size;
        verdict.error = verdict.error.max(error);
        if !self.undecided {
            verdict.limit(Fault::Separation, error, tolerance);
        }
        verdict.limit(Fault::NotUnit, (normal.length() - 1.0).abs(), UNIT_SLACK);
        let [radius_a, radius_b] = self.shapes.map(|shape| shape.radius);
        let gap = self.oracle.gap(normal) - (radius_a + radius_b);
        verdict.limit(Fault::Normal, (separation - gap) / self.size, tolerance);
        verdict.limit(Fault::Oracle, (gap - self.truth) / self.size, tolerance);
        let oblique = (witness_b - witness_a) - normal * separation;
        verdict.limit(Fault::Contract, oblique.length() / self.size, tolerance);
        let [core_a, core_b] = self.oracle.distances(witness_a, witness_b);
        let outside = (core_a - radius_a).max(core_b - radius_b);
        verdict.limit(Fault::Outside, outside / self.size, tolerance);
    }
}

#[cfg(test)]
mod tests {
    use super::{Fault, Question, Verdict};
    use crate::collision::families::Pair;
    use crate::collision::shape::{Body, Shape};
    use glam::DVec3;
    use pliant_collision::{ClosestPoints, Cylinder};
    use pliant_spatial::Pose;
    use std::sync::Arc;

    /// Unit cubes `gap` [m] apart along x, and the right answer.
    fn cubes(gap: f64) -> (Pair, ClosestPoints) {
        let cube = Arc::new(Shape::new(Body::Cuboid(DVec3::splat(0.5)), 0.0));
        let pair = Pair {
            shapes: [cube.clone(), cube],
            a_from_b: Pose::from_translation(DVec3::X * (1.0 + gap)),
            size: 1.0,
        };
        let found = ClosestPoints {
            witness_a: DVec3::new(0.5, 0.1, 0.2),
            witness_b: DVec3::new(0.5 + gap, 0.1, 0.2),
            normal: DVec3::X,
            separation: gap,
        };
        (pair, found)
    }

    fn faults(gap: f64, spoil: impl Fn(&mut ClosestPoints)) -> Vec<Fault> {
        let (pair, mut found) = cubes(gap);
        spoil(&mut found);
        let mut verdict = Verdict::default();
        Question::new(&pair, &pair.a_from_b).judge(&found, &mut verdict);
        verdict.faults.into_iter().map(|(fault, _)| fault).collect()
    }

    /// Out along the axis where out through the side is shorter: nothing but the search can tell.
    #[test]
    fn too_deep_answers_on_round_bodies_are_refuted() {
        let body = |radius| {
            Body::Cylinder(Cylinder {
                half_length: 0.5,
                radius,
            })
        };
        let point = Arc::new(Shape::new(Body::Point(DVec3::ZERO), 0.0));
        let judged = |radius: f64| {
            let pair = Pair {
                shapes: [Arc::new(Shape::new(body(radius), 0.0)), point.clone()],
                a_from_b: Pose::IDENTITY,
                size: 1.0,
            };
            let found = ClosestPoints {
                witness_a: DVec3::Z * 0.5,
                witness_b: DVec3::ZERO,
                normal: DVec3::Z,
                separation: -0.5,
            };
            let mut verdict = Verdict::default();
            Question::new(&pair, &pair.a_from_b).judge(&found, &mut verdict);
            let faults: Vec<Fault> = verdict.faults.into_iter().map(|(fault, _)| fault).collect();
            faults
        };
        assert_eq!(judged(0.5 + 1e-8), []);
        assert_eq!(judged(0.5 - 1e-8), [Fault::Separation]);
        assert_eq!(judged(0.3), [Fault::Separation]);
    }

    #[test]
    fn right_answers_pass_and_each_fault_is_seen() {
        for gap in [0.25, 0.0, -0.125] {
            assert_eq!(faults(gap, |_| ()), []);
            assert!(faults(gap, |f| f.separation += 2e-9).contains(&Fault::Separation));
            assert!(faults(gap, |f| f.normal *= 1.0 + 1e-11).contains(&Fault::NotUnit));
            assert!(faults(gap, |f| f.normal = -f.normal).contains(&Fault::Normal));
            assert!(faults(gap, |f| f.normal = DVec3::Y).contains(&Fault::Normal));
            assert!(faults(gap, |f| f.witness_b.y += 2e-9).contains(&Fault::Contract));
            assert_eq!(faults(gap, |f| f.normal.x = f64::NAN), [Fault::NotFinite]);
            let shifted = |f: &mut ClosestPoints| {
                f.witness_a.y += 0.5;
                f.witness_b.y += 0.5;
            };
            assert_eq!(faults(gap, shifted), [Fault::Outside]);
        }
    }
}
