//! The verdict on one case of a reference file, by the rules of the format.

use glam::{DQuat, DVec3};
use pliant_collision::{ClosestPoints, SimplexCache, closest_points};
use pliant_spatial::Pose;

use super::reference::{Case, Reference};
use super::shape::Shape;

/// What a unit vector's length may be off.
const UNIT_SLACK: f64 = 1e-12;

/// How a case went.
#[derive(Clone, Debug, Default)]
pub struct Verdict {
    /// Largest error of the signed distance, relative to the case's tolerance.
    pub worst_share: f64,
    /// Largest error of the signed distance [m].
    pub worst_error: f64,
    /// Every way in which an answer missed.
    pub faults: Vec<String>,
}

/// Asks every question of a case: with the cache `left` by the case before of the same shapes, from scratch, with the cache
/// that leaves, with the cache of a slightly different placement, and all but the first with the roles of A and B swapped.
pub fn judge(reference: &Reference, case: &Case, left: &mut SimplexCache) -> Verdict {
    let [a, b] = case.shapes.map(|shape| &reference.shapes[shape]);
    let mut verdict = Verdict::default();
    let forward = Question {
        shapes: [a, b],
        a_from_b: case.a_from_b,
        normal: case
            .normal
            .map(|normal| case.world_from_a.inverse_transform_vector(normal)),
        case,
    };
    forward.check("after another pair", left, &mut verdict);
    forward.ask("", &mut verdict);
    let swapped = Question {
        shapes: [b, a],
        a_from_b: inverse(&case.a_from_b),
        normal: forward
            .normal
            .map(|normal| -case.a_from_b.inverse_transform_vector(normal)),
        case,
    };
    swapped.ask("swapped, ", &mut verdict);
    verdict
}

fn inverse(pose: &Pose) -> Pose {
    Pose::new(
        pose.rotation.conjugate(),
        -(pose.rotation.conjugate() * pose.translation),
    )
}

/// A case in the roles in which it is asked.
struct Question<'r> {
    shapes: [&'r Shape; 2],
    a_from_b: Pose,
    /// In A's frame.
    normal: Option<DVec3>,
    case: &'r Case,
}

impl Question<'_> {
    fn ask(&self, roles: &str, verdict: &mut Verdict) {
        let mut cache = SimplexCache::default();
        for start in ["cold", "warm"] {
            self.check(&format!("{roles}{start}"), &mut cache, verdict);
        }
        // As a motion of 0.1 % of the size and 0.1° leaves it.
        let size = self.shapes[0].size().min(self.shapes[1].size());
        let axis = DVec3::new(0.6, -0.64, 0.48);
        let nearby = Pose::new(
            self.a_from_b.rotation * DQuat::from_axis_angle(axis, 0.1_f64.to_radians()),
            self.a_from_b.translation + DVec3::new(0.48, 0.6, -0.64) * (1e-3 * size),
        );
        let mut cache = SimplexCache::default();
        self.query(&nearby, &mut cache);
        self.check(&format!("{roles}from nearby"), &mut cache, verdict);
    }

    fn query(&self, a_from_b: &Pose, cache: &mut SimplexCache) -> ClosestPoints {
        let [a, b] = self.shapes;
        a.with(|a| b.with(|b| closest_points(a, b, a_from_b, cache)))
    }

    fn check(&self, how: &str, cache: &mut SimplexCache, verdict: &mut Verdict) {
        let found = self.query(&self.a_from_b, cache);
        let mut fail = |fault: String| verdict.faults.push(format!("{how}: {fault}"));
        self.check_numbers(&found, &mut fail);
        self.check_witnesses(&found, &mut fail);
        let error = (found.separation - self.case.signed_distance).abs();
        verdict.worst_error = verdict.worst_error.max(error);
        verdict.worst_share = verdict.worst_share.max(error / self.case.tolerance);
    }

    fn check_numbers(&self, found: &ClosestPoints, fail: &mut impl FnMut(String)) {
        let Case {
            signed_distance,
            tolerance,
            normal_tolerance,
            ..
        } = *self.case;
        let error = (found.separation - signed_distance).abs();
        if error.is_nan() || error > tolerance {
            fail(format!(
                "separation {:e} m, not {signed_distance:e}: off by {error:e}, allowed {tolerance:e}",
                found.separation
            ));
        }
        let length = found.normal.length();
        if length.is_nan() || (length - 1.0).abs() > UNIT_SLACK {
            fail(format!("normal of length {length}"));
        }
        if let Some(normal) = self.normal {
            let angle = found
                .normal
                .cross(normal)
                .length()
                .atan2(found.normal.dot(normal));
            if angle.is_nan() || angle > normal_tolerance {
                fail(format!(
                    "normal off by {angle:e} rad, allowed {normal_tolerance:e}"
                ));
            }
        }
    }

    fn check_witnesses(&self, found: &ClosestPoints, fail: &mut impl FnMut(String)) {
        let tolerance = self.case.tolerance;
        let between = found.witness_b - found.witness_a;
        let span = between.length();
        let miss = (span - self.case.signed_distance.abs()).abs();
        if miss.is_nan() || miss > tolerance {
            fail(format!("witness points {span:e} m apart, off by {miss:e}"));
        }
        let oblique = (between - found.normal * found.separation).length();
        if oblique.is_nan() || oblique > tolerance {
            fail(format!(
                "witness points are not apart by separation times normal: off by {oblique:e} m"
            ));
        }
        let places = [
            found.witness_a,
            self.a_from_b.inverse_transform_point(found.witness_b),
        ];
        for ((shape, place), name) in self.shapes.into_iter().zip(places).zip(["A", "B"]) {
            let outside = shape.core.distance_to(place) - shape.radius;
            if outside.is_nan() || outside > tolerance {
                fail(format!(
                    "witness point of {name} lies {outside:e} m outside it"
                ));
            }
        }
    }
}
