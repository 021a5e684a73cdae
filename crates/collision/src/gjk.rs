//! GJK: distance, closest points and common normal of two convex shapes.
//!
//! Gilbert, Johnson & Keerthi (1988); incremental with a cached simplex as van den Bergen (1999, §4), who also gives the
//! lower bound used to stop. Departures: the simplex is solved as [`crate::simplex`] says; the only stopping rule is the
//! duality gap, the distance of the nearest point found less the height of the supporting plane through the last support
//! point, relative to the size of the difference; a support point met again, or four rounds without progress, mean that
//! rounding bounds the gap, and the round with the smallest gap is returned. The separation reported is the height of the
//! supporting plane: certified, never above the true one but for rounding.

use glam::DVec3;
use pliant_spatial::Pose;

use crate::boxes;
use crate::epa::{self, Surface};
use crate::rims;
use crate::segments::Segments;
use crate::simplex::{NOISE, Nearest, Simplex};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

/// The duality gap at which a search stops, times the largest coordinate of the difference: a few dozen units in the last
/// place. Smaller values only run into the repeated-support stop.
pub(crate) const GAP_TOLERANCE: f64 = 8e-15;

/// The gap, times the largest coordinate, at which rough supports have served: a few times what they fall short of the
/// furthest on a round shape.
const ROUGH: f64 = 0.02;

/// Rounds of GJK. Coherent queries take 1 to 4, cold ones on 10⁴ faces about 15; the cap bounds degenerate input.
const ROUND_LIMIT: u32 = 96;

/// Rounds that may pass without the distance shrinking: degenerate simplices improve the normal before the distance.
const STALL_LIMIT: u32 = 4;

/// Where the last query ended, as vertex indices of both shapes: start of the next one at a nearby placement.
///
/// Keep one per pair of shapes. A cache filled by other shapes is harmless and merely slow. No heap, about 600 bytes.
/// It also decides among directions equally deep: the way out stays where it was to 1e-12 of the size.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SimplexCache {
    pairs: [[u32; 2]; 4],
    len: u32,
    /// Where EPA ended, if the last query did.
    surface: Surface,
    of_boxes: boxes::Feature,
    /// Where an overlap on rims was settled, if the last query's was.
    of_rims: rims::Memory,
}

/// Nearest points of two shapes, or deepest ones in overlap; everything in A's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPoints {
    /// Point on A's surface [m].
    pub witness_a: DVec3,
    /// Point on B's surface [m]; `witness_b − witness_a = separation · normal` to rounding.
    pub witness_b: DVec3,
    /// Unit vector from A to B. No point of A lies further along it, and no point of B less far, than
    /// `separation` demands: it is the normal of a pair of supporting planes at that distance.
    pub normal: DVec3,
    /// Signed gap [m]: positive apart, negative the depth of the shallowest overlap.
    pub separation: f64,
}

impl ClosestPoints {
    /// How far the witness points are from being `separation · normal` apart [m]: rounding, unless the search gave out. Then
    /// `separation` is a bound certified by its planes, no gap smaller and no depth larger than it says, the points lie on
    /// the shapes all the same, and this measures what is missing.
    pub fn doubt(&self) -> f64 {
        (self.witness_b - self.witness_a - self.normal * self.separation).length()
    }
}

/// How a search on the cores ended.
pub(crate) enum Exit {
    /// Apart, by a certified amount.
    Apart(Plane),
    /// The cores overlap, or touch as far as rounding tells; the simplex is EPA's seed.
    Meeting(Simplex),
}

/// A supporting plane of the difference with the feature that it touches.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    /// Signed height of the plane over the origin along `normal` [m], cores only.
    pub(crate) separation: f64,
    pub(crate) simplex: Simplex,
}

/// What a search is for, hence when it may stop.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Goal {
    /// The distance to rounding.
    Distance,
    /// A plane that keeps the cores at least this far apart [m], or the certainty that none does.
    Above(f64),
}

/// Nearest points and normal of two shapes at a placement, by GJK, or by EPA where the cores overlap.
///
/// Contract: `witness_b − witness_a = separation · normal`; translating B by `−separation · normal` ends an overlap or
/// closes a gap. The normal and the separation belong together to 1e-14 of the shapes' size at any gap.
/// Touching counts as overlap, here and in [`overlap`] and [`distance`]. Allocates nothing.
pub fn closest_points<A, B>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
    cache: &mut SimplexCache,
) -> ClosestPoints
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if let Some(found) = closed_form(a, b, a_from_b, cache) {
        return found;
    }
    let difference = MinkowskiDifference::new(a, b, a_from_b);
    if !cache.surface.is_empty()
        && let Some(plane) = epa::shallowest_from(&mut cache.surface, &difference)
    {
        return witnesses(&difference, &plane);
    }
    match search(&difference, cache, Goal::Distance) {
        Exit::Apart(plane) => {
            cache.remember(&plane.simplex);
            cache.surface.clear();
            cache.of_rims = rims::Memory::default();
            witnesses(&difference, &plane)
        }
        Exit::Meeting(simplex) => {
            // The tetrahedron around the origin, not the face found: a sliver from that face to the far side would cost
            // EPA more rounds than it saves.
            cache.remember(&simplex);
            epa::shallowest(
                &difference,
                &simplex,
                &mut cache.surface,
                &mut cache.of_rims,
            )
        }
    }
}

/// Nearest points and normal of two shapes, or `None` if they touch or overlap. GJK alone; allocates nothing.
pub fn distance<A, B>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
    cache: &mut SimplexCache,
) -> Option<ClosestPoints>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if let Some(found) = closed_form(a, b, a_from_b, cache) {
        return (found.separation > 0.0).then_some(found);
    }
    let difference = MinkowskiDifference::new(a, b, a_from_b);
    match search(&difference, cache, Goal::Distance) {
        Exit::Apart(plane) => {
            cache.remember(&plane.simplex);
            let closest = witnesses(&difference, &plane);
            (closest.separation > 0.0).then_some(closest)
        }
        Exit::Meeting(simplex) => {
            cache.remember(&simplex);
            None
        }
    }
}

/// Whether two shapes touch or overlap: stops at the first separating plane. Allocates nothing.
pub fn overlap<A, B>(a: &A, b: &B, a_from_b: &Pose, cache: &mut SimplexCache) -> bool
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let radii = a.radius() + b.radius();
    if let (Some(of_a), Some(of_b)) = (a.core_segment(), b.core_segment()) {
        return between_segments(of_a, of_b, a_from_b, [radii, 0.0]).separation <= 0.0;
    }
    if let (Some(of_a), Some(of_b)) = (a.core_box(), b.core_box())
        && let Some(found) = boxes::overlap([of_a, of_b], a_from_b, radii, &mut cache.of_boxes)
    {
        return found;
    }
    let difference = MinkowskiDifference::new(a, b, a_from_b);
    match search(&difference, cache, Goal::Above(radii)) {
        Exit::Apart(plane) => {
            cache.remember(&plane.simplex);
            plane.separation <= radii
        }
        Exit::Meeting(simplex) => {
            cache.remember(&simplex);
            true
        }
    }
}

/// The answer without a search: segments, boxes and what is rounded of them. `None` for other shapes, and for boxes in the
/// rare case that rounding leaves open.
#[inline]
fn closed_form<A, B>(
    a: &A,
    b: &B,
    a_from_b: &Pose,
    cache: &mut SimplexCache,
) -> Option<ClosestPoints>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let radii = [a.radius(), b.radius()];
    if let (Some(of_a), Some(of_b)) = (a.core_segment(), b.core_segment()) {
        return Some(between_segments(of_a, of_b, a_from_b, radii));
    }
    let halves = [a.core_box()?, b.core_box()?];
    boxes::closest(halves, a_from_b, radii, &mut cache.of_boxes)
}

/// Closed form for capsules, spheres and what is thinner.
fn between_segments(
    [a0, a1]: [DVec3; 2],
    [b0, b1]: [DVec3; 2],
    a_from_b: &Pose,
    [radius_a, radius_b]: [f64; 2],
) -> ClosestPoints {
    let middle = a0.midpoint(a1);
    let segments = Segments {
        half_a: (a1 - a0) * 0.5,
        half_b: a_from_b.rotation * ((b1 - b0) * 0.5),
        offset: a_from_b.rotation * b0.midpoint(b1) + (a_from_b.translation - middle),
    };
    let found = segments.nearest();
    let core_a = middle + segments.half_a * found.on_a;
    let separation = found.separation - (radius_a + radius_b);
    let witness_a = core_a + found.normal * radius_a;
    ClosestPoints {
        witness_a,
        witness_b: witness_a + found.normal * separation,
        normal: found.normal,
        separation,
    }
}

impl SimplexCache {
    pub(crate) fn remember(&mut self, simplex: &Simplex) {
        self.len = 0;
        for (pair, vertex) in self.pairs.iter_mut().zip(simplex.vertices()) {
            *pair = [vertex.a, vertex.b];
            self.len += 1;
        }
    }

    /// The cached simplex at the present placement; a single support point where there is none.
    fn recall<A, B>(&self, difference: &MinkowskiDifference<'_, A, B>) -> Simplex
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let mut simplex = Simplex::EMPTY;
        for &[a, b] in &self.pairs[..self.len as usize] {
            simplex.push(difference.vertex(a, b));
        }
        if simplex.vertices().is_empty() {
            approach(difference)
        } else {
            simplex
        }
    }
}

/// A simplex from nothing: the search as far as rough supports lead. They are points of the difference all the same, only
/// their planes certify nothing; on 10⁴ faces this saves half of the climbs of a cold query (collision.9).
#[inline(never)]
fn approach<A, B>(difference: &MinkowskiDifference<'_, A, B>) -> Simplex
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let guess = difference.interior_point();
    let direction = if guess == DVec3::ZERO {
        DVec3::X
    } else {
        guess
    };
    let mut simplex = Simplex::EMPTY;
    let Some(first) = difference.rough_support(-direction) else {
        simplex.push(difference.support(-direction, &DifferencePoint::NONE));
        return simplex;
    };
    simplex.push(first);
    let mut scale = first.point.length();
    for _ in 0..ROUND_LIMIT {
        let Some(Nearest { normal, distance }) = simplex.reduce() else {
            break;
        };
        let Some(support) = difference.rough_support(-normal) else {
            break;
        };
        scale = scale.max(support.point.length());
        let gained = distance - normal.dot(support.point);
        if simplex.contains_vertex(&support) {
            break;
        }
        simplex.push(support);
        if gained <= ROUGH * scale {
            break;
        }
    }
    simplex
}

/// The search itself, on cores (collision.2).
pub(crate) fn search<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    cache: &SimplexCache,
    goal: Goal,
) -> Exit
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut simplex = cache.recall(difference);
    let mut best: Option<(f64, Plane)> = None;
    let mut shortest = f64::INFINITY;
    let mut stalled = 0;
    let mut start = simplex.vertices()[0];
    let mut scale = simplex.scale();
    for _ in 0..ROUND_LIMIT {
        let Some(Nearest { normal, distance }) = simplex.reduce() else {
            return Exit::Meeting(simplex);
        };
        if distance <= NOISE * scale {
            return Exit::Meeting(simplex);
        }
        let support = difference.support(-normal, &start);
        start = support;
        scale = scale.max(support.point.length());
        let separation = normal.dot(support.point).min(distance);
        let gap = distance - separation;
        if best.as_ref().is_none_or(|(smallest, _)| gap < *smallest) {
            let plane = Plane {
                normal,
                separation,
                simplex,
            };
            best = Some((gap, plane));
        }
        if distance < shortest {
            shortest = distance;
        } else {
            stalled += 1;
        }
        let enough = match goal {
            Goal::Distance => false,
            Goal::Above(height) => separation > height || distance <= height,
        };
        if enough
            || gap <= GAP_TOLERANCE * scale
            || stalled > STALL_LIMIT
            || simplex.contains_vertex(&support)
        {
            break;
        }
        simplex.push(support);
    }
    match best {
        Some((_, plane)) if plane.separation > 0.0 => Exit::Apart(plane),
        _ => Exit::Meeting(simplex),
    }
}

/// Witness points on the rounded surfaces from a plane and the feature it touches.
pub(crate) fn witnesses<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    plane: &Plane,
) -> ClosestPoints
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if let Some(settled) = rims::settle(difference, plane) {
        return settled.found;
    }
    touched(difference, plane)
}

/// Witness points where the plane touches the cores' simplex.
pub(crate) fn touched<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    plane: &Plane,
) -> ClosestPoints
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut core_a = DVec3::ZERO;
    let mut core_b_in_b = DVec3::ZERO;
    for (vertex, &weight) in plane.simplex.vertices().iter().zip(plane.simplex.weights()) {
        core_a += difference.a.vertex(vertex.a) * weight;
        core_b_in_b += difference.b.vertex(vertex.b) * weight;
    }
    let core_b = difference.a_from_b.transform_point(core_b_in_b);
    let (radius_a, radius_b) = (difference.a.radius(), difference.b.radius());
    ClosestPoints {
        witness_a: core_a + plane.normal * radius_a,
        witness_b: core_b - plane.normal * radius_b,
        normal: plane.normal,
        separation: plane.separation - (radius_a + radius_b),
    }
}
