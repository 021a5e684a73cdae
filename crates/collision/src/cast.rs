//! Ray and shape casts: when a moving point or shape first meets a convex shape.
//!
//! Van den Bergen (2004, "Ray Casting against General Convex Objects with Application to Continuous Collision
//! Detection"): each separating plane found on the way clips the motion. Departing from it, GJK is solved at every stop
//! instead of interleaved. The distance along a straight motion is a convex function, the height of the plane its tangent,
//! so the stops are Newton's iteration from below: monotone, never past the first contact, quadratic on round shapes, and
//! exact after one step once the plane is that of the face hit. Warm starts make a stop cost one or two GJK rounds.

use glam::DVec3;
use pliant_spatial::Pose;

use crate::gjk::{ClosestPoints, SimplexCache, closest_points, distance};
use crate::shapes::Point;
use crate::support::SupportMap;

/// Stops on the way; grazing a round shape halves the remaining distance per stop, anything else takes a handful.
const STOP_LIMIT: u32 = 64;

/// A gap smaller than this times the coordinates at hand is contact: rounding would not let it shrink further.
const CONTACT_TOLERANCE: f64 = 16.0 * f64::EPSILON;

/// The same for a gap at which the plane has turned away from the motion: of a shape without thickness seen edge on, say.
const TURNED_TOLERANCE: f64 = 1024.0 * f64::EPSILON;

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// Distance from the ray's origin [m].
    pub distance: f64,
    /// Point hit, in the frame of the query [m].
    pub point: DVec3,
    /// Unit outward normal of the surface there.
    pub normal: DVec3,
}

/// Where a moving shape first touches another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CastHit {
    /// Fraction of the motion travelled until contact, in [0, 1].
    pub fraction: f64,
    /// Unit normal from A to B at contact, in A's frame.
    pub normal: DVec3,
    /// The point of contact on A, in A's frame [m].
    pub witness: DVec3,
}

/// First hit of a ray with a convex shape within `max_distance` [m], in the shape's frame. `direction_unit` has unit
/// length, `max_distance` may be infinite. A ray that starts inside or on the shape hits at distance 0 with the normal of
/// the nearest way out. `None` for a negative distance, and for numbers that are none. Allocates nothing.
pub fn cast_ray<A>(
    shape: &A,
    origin: DVec3,
    direction_unit: DVec3,
    max_distance: f64,
) -> Option<RayHit>
where
    A: SupportMap + ?Sized,
{
    if max_distance.is_nan() || max_distance < 0.0 {
        return None;
    }
    // Where the shape ends along the ray. Twice as far is finite and, whatever the rounding, not short of a contact there.
    let last = shape.support(direction_unit, u32::MAX).point;
    let far = (last - origin).dot(direction_unit) + shape.radius();
    let max_distance = max_distance.min(2.0 * far.max(0.0));
    let pose = Pose::from_translation(origin);
    let hit = cast_shape(
        shape,
        &Point(DVec3::ZERO),
        &pose,
        direction_unit * max_distance,
        &mut SimplexCache::default(),
    )?;
    let travelled = hit.fraction * max_distance;
    Some(RayHit {
        distance: travelled,
        point: origin + direction_unit * travelled,
        normal: hit.normal,
    })
}

/// First contact of B, moving by `motion_of_b_in_a` [m] without turning, with A at rest. `None` if they stay apart.
/// Shapes that touch or overlap at the start meet at fraction 0. `None` too for a motion that is not finite. Allocates
/// nothing (collision.10).
pub fn cast_shape<A, B>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
    motion_of_b_in_a: DVec3,
    cache: &mut SimplexCache,
) -> Option<CastHit>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if !motion_of_b_in_a.is_finite() || !a_from_b.translation.is_finite() {
        return None;
    }
    let at = |fraction: f64| {
        Pose::new(
            a_from_b.rotation,
            a_from_b.translation + motion_of_b_in_a * fraction,
        )
    };
    let Some(mut last) = distance(a, b, a_from_b, cache) else {
        return Some(hit(0.0, &closest_points(a, b, a_from_b, cache)));
    };
    // The coordinates in which a stop is worked out.
    let scale = |closest: &ClosestPoints, fraction: f64| {
        closest.witness_a.abs().max_element()
            + at(fraction).translation.abs().max_element()
            + motion_of_b_in_a.abs().max_element() * fraction
    };
    let mut fraction = 0.0;
    let mut before = last.normal;
    for _ in 0..STOP_LIMIT {
        let approach = -last.normal.dot(motion_of_b_in_a);
        // Moving along or away from a separating plane never crosses it, unless rounding is all that separates.
        if approach <= 0.0 {
            let touches = last.separation <= TURNED_TOLERANCE * scale(&last, fraction);
            last.normal = before;
            return (fraction > 0.0 && touches).then(|| hit(fraction, &last));
        }
        let next = fraction + last.separation / approach;
        if next > 1.0 {
            return None;
        }
        let pose = at(next);
        let closest = distance(a, b, &pose, cache);
        let touching = |closest: &ClosestPoints| {
            closest.separation <= CONTACT_TOLERANCE * scale(closest, next) || next <= fraction
        };
        let Some(closest) = closest.filter(|closest| !touching(closest)) else {
            // So close that the new plane may be any: the last one is the one that is met. But round surfaces turn under the
            // last step, and their cores, which are apart, tell by how much.
            let met = closest_points(a, b, &pose, cache);
            if a.radius() + b.radius() > 0.0 {
                last.normal = met.normal;
            }
            last.witness_a = met.witness_a;
            return Some(hit(next, &last));
        };
        fraction = next;
        before = last.normal;
        last = closest;
    }
    Some(hit(fraction, &last))
}

/// The contact as seen from the last certified stop: its plane is the one that is met.
fn hit(fraction: f64, closest: &ClosestPoints) -> CastHit {
    CastHit {
        fraction,
        normal: closest.normal,
        witness: closest.witness_a,
    }
}
