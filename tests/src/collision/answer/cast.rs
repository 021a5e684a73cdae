//! The verdict on casts, by the hit's own certificate.
//!
//! The shapes touch at the pose of the hit: the plane across its normal separates them there, and its point is on both. It is
//! the first time they do: the height of B over that plane is linear along the motion, so a plane that separates the shapes
//! at the start as well keeps them apart at every moment in between. No moment need be sampled.

use glam::DVec3;
use pliant_collision::{CastHit, ClosestPoints, SimplexCache, cast_shape};
use pliant_spatial::Pose;

use super::{BLUR, Fault, Question, TOLERANCE, UNIT_SLACK, Verdict};
use crate::collision::truth::Oracle;

impl Question<'_> {
    /// Throws B at A from where it is apart: along the normal, and so that a point inside of it ends on one inside of A.
    pub(super) fn casts(&self, found: &ClosestPoints, verdict: &mut Verdict) {
        if self.truth <= BLUR * self.size + self.rounding {
            return;
        }
        // The distance falls one to one.
        let along = -found.normal * (self.truth + 0.25 * self.size);
        match self.thrown(along) {
            Some(hit) => {
                let travelled = hit.fraction * along.length();
                self.limit(verdict, Fault::Cast, (travelled - self.truth).abs());
                self.judge_hit(along, &hit, verdict);
            }
            None => verdict.faults.push((Fault::Cast, self.truth / self.size)),
        }
        let [middle_a, middle_b] = self.shapes.map(|shape| {
            let vertices = &shape.core.vertices;
            vertices.iter().sum::<DVec3>() / vertices.len() as f64
        });
        let aslant = middle_a - self.a_from_b.transform_point(middle_b);
        match self.thrown(aslant) {
            Some(hit) => self.judge_hit(aslant, &hit, verdict),
            // Two shapes without volume may pass each other within rounding.
            None => self.limit(verdict, Fault::Cast, -self.separation_after(aslant)),
        }
    }

    fn thrown(&self, motion: DVec3) -> Option<CastHit> {
        let mut cache = SimplexCache::default();
        self.ask(|a, b| cast_shape(a, b, &self.a_from_b, motion, &mut cache))
    }

    fn judge_hit(&self, motion: DVec3, hit: &CastHit, verdict: &mut Verdict) {
        let CastHit {
            fraction,
            normal,
            witness,
        } = *hit;
        let finite = fraction.is_finite() && normal.is_finite() && witness.is_finite();
        if !finite || !(0.0..=1.0).contains(&fraction) {
            verdict.faults.push((Fault::NotFinite, fraction));
            return;
        }
        verdict.limit(Fault::NotUnit, (normal.length() - 1.0).abs(), UNIT_SLACK);
        let there = self.oracle_after(motion * fraction);
        let [radius_a, radius_b] = self.shapes.map(|shape| shape.radius);
        let gap = self.oracle.gap(normal).min(there.gap(normal)) - (radius_a + radius_b);
        self.limit(verdict, Fault::CastNormal, -gap);
        // A point on a rounded surface lies over its core along the normal: this sees the normal of spheres to first order.
        let cores = there.distances(witness - normal * radius_a, witness + normal * radius_b);
        self.limit(verdict, Fault::CastWitness, cores[0].max(cores[1]));
    }

    /// Measures a length [m] by the tolerance of the pair.
    fn limit(&self, verdict: &mut Verdict, fault: Fault, length: f64) {
        let allowed = TOLERANCE + self.rounding / self.size;
        verdict.limit(fault, length / self.size, allowed);
    }

    fn oracle_after(&self, motion: DVec3) -> Oracle<'_> {
        let [a, b] = self.shapes;
        let moved = Pose::new(self.a_from_b.rotation, self.a_from_b.translation + motion);
        Oracle::new(a, b, &moved)
    }

    fn separation_after(&self, motion: DVec3) -> f64 {
        let [a, b] = self.shapes;
        self.oracle_after(motion).signed_distance().0 - (a.radius + b.radius)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use pliant_collision::CastHit;
    use pliant_spatial::Pose;

    use super::{Fault, Question, Verdict};
    use crate::collision::families::Pair;
    use crate::collision::shape::{Body, Shape};

    /// What is wrong with a hit of a shape that is thrown along −x at its like, from 2 m away.
    fn wrong(body: Body, radius: f64, motion: f64, hit: &CastHit) -> Vec<Fault> {
        let shape = Arc::new(Shape::new(body, radius));
        let pair = Pair {
            shapes: [shape.clone(), shape],
            a_from_b: Pose::from_translation(DVec3::X * 2.0),
            size: 1.0,
        };
        let mut verdict = Verdict::default();
        let question = Question::new(&pair, &pair.a_from_b);
        question.judge_hit(DVec3::NEG_X * motion, hit, &mut verdict);
        verdict.faults.into_iter().map(|(fault, _)| fault).collect()
    }

    /// The right hit of unit cubes or balls, spoilt.
    fn faults(body: Body, radius: f64, spoil: impl Fn(&mut CastHit)) -> Vec<Fault> {
        let mut hit = CastHit {
            fraction: 0.5,
            normal: DVec3::X,
            witness: DVec3::X * 0.5,
        };
        spoil(&mut hit);
        wrong(body, radius, 2.0, &hit)
    }

    fn of_cubes(spoil: impl Fn(&mut CastHit)) -> Vec<Fault> {
        faults(Body::Cuboid(DVec3::splat(0.5)), 0.0, spoil)
    }

    fn of_balls(spoil: impl Fn(&mut CastHit)) -> Vec<Fault> {
        faults(Body::Point(DVec3::ZERO), 0.5, spoil)
    }

    #[test]
    fn right_hits_pass_and_each_fault_of_a_hit_is_seen() {
        assert_eq!(of_cubes(|_| ()), []);
        assert_eq!(of_balls(|_| ()), []);
        assert_eq!(
            of_cubes(|hit| hit.witness.y = 0.4),
            [],
            "any point of the face"
        );
        let tilted = |hit: &mut CastHit| hit.normal = (hit.normal + DVec3::Y * 1e-6).normalize();
        assert_eq!(of_cubes(tilted), [Fault::CastNormal]);
        assert_eq!(of_balls(tilted), [Fault::CastWitness]);
        assert_eq!(of_cubes(|hit| hit.normal *= 1.0 + 1e-11), [Fault::NotUnit]);
        assert!(of_cubes(|hit| hit.normal = -hit.normal).contains(&Fault::CastNormal));
        let beside = |hit: &mut CastHit| hit.witness.y = 0.6;
        assert_eq!(of_cubes(beside), [Fault::CastWitness]);
        assert_eq!(of_balls(|hit| hit.witness.y = 1e-6), [Fault::CastWitness]);
        for spoil in [of_cubes, of_balls] as [fn(fn(&mut CastHit)) -> Vec<Fault>; 2] {
            assert_eq!(spoil(|hit| hit.witness.x += 2e-9), [Fault::CastWitness]);
            assert!(spoil(|hit| hit.fraction += 2e-9).contains(&Fault::CastNormal));
            assert!(spoil(|hit| hit.fraction -= 2e-9).contains(&Fault::CastWitness));
            assert_eq!(spoil(|hit| hit.fraction = f64::NAN), [Fault::NotFinite]);
        }
    }

    /// The far side is met by a plane as well, but that one does not separate the shapes at the start.
    #[test]
    fn the_last_touch_of_a_motion_is_not_its_first() {
        let last = CastHit {
            fraction: 1.0,
            normal: DVec3::NEG_X,
            witness: DVec3::X * -0.5,
        };
        let cube = Body::Cuboid(DVec3::splat(0.5));
        assert_eq!(wrong(cube, 0.0, 3.0, &last), [Fault::CastNormal]);
    }
}
