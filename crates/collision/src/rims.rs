//! Answers on cylinders and cones to the last digits.
//!
//! GJK and EPA meet a rim in chords. A chord that is short enough to lie on the circle is too short to tell its normal: at
//! best half the digits of a direction are right, and around an axis, where all directions are nearly equally deep, EPA's
//! buffers end before even those. But the vertices found tell *which* rims, edges and corners are met, and on these the
//! supports are known as functions of the direction. What remains is a smooth problem with two unknowns (collision.11):
//! the direction in which the pairs of features met are equally high and the way out crosses the surface between them.

use glam::DVec3;

use crate::gjk::{ClosestPoints, Plane};
use crate::simplex::Simplex;
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

mod feature;
mod foot;
mod memory;
mod search;

use feature::FeaturePair;
pub use feature::Rim;
pub(crate) use feature::key;
pub(crate) use memory::Memory;
use search::{Run, Search};

/// An answer with what a later query starts from.
#[derive(Clone, Copy)]
pub(crate) struct Answer {
    pub(crate) found: ClosestPoints,
    pub(crate) memory: Memory,
}

/// The answer of a plane found by GJK or EPA made exact (collision.11). `None` where no rim is met, or nothing better was found.
pub(crate) fn settle<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    plane: &Plane,
) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    meets(difference, &plane.simplex)
        .then(|| refine(difference, plane))
        .flatten()
}

/// Whether a vertex of a simplex is on a rim.
pub(crate) fn meets<A, B>(difference: &MinkowskiDifference<'_, A, B>, simplex: &Simplex) -> bool
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let turned = |vertex: &DifferencePoint| FeaturePair::of(difference, vertex).is_turned();
    simplex.vertices().iter().any(turned)
}

/// Whether a support has both its features in common with corners of a face.
pub(crate) fn shares_features<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    corners: &[DifferencePoint; 3],
    support: &DifferencePoint,
) -> bool
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let pair = FeaturePair::of(difference, support);
    corners
        .iter()
        .any(|corner| FeaturePair::of(difference, corner) == pair)
}

/// [`settle`], given up where it comes close to an answer that is known already.
pub(crate) fn settle_elsewhere<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    plane: &Plane,
    corners: &[DifferencePoint; 3],
    known: &Memory,
    around: f64,
) -> (bool, Option<Answer>)
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut search = Search::new(difference, plane);
    search.origin.1 = around;
    for corner in corners {
        search.take(FeaturePair::of(difference, corner));
    }
    search.known =
        Search::from_memory(difference, known).map(|known| (known.outward, known.pairs, known.len));
    search.settle(plane);
    (search.wandered, search.answer())
}

#[inline(never)]
fn refine<A, B>(difference: &MinkowskiDifference<'_, A, B>, plane: &Plane) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut search = Search::new(difference, plane);
    search.settle(plane);
    search.answer()
}

/// The local answer nearest to a remembered one, at a placement nearby: certified as a bound of the depth like any other, and
/// among directions equally deep the one reached without turning. `None` where the search does not close.
#[inline(never)]
pub(crate) fn resume<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    memory: &Memory,
) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut search = Search::from_memory(difference, memory)?;
    search.try_discs();
    if !search.is_settled() && search.run() == Run::Lost {
        return settle_towards(difference, memory.outward());
    }
    search.is_settled().then(|| search.answer()).flatten()
}

/// The local answer found from a direction alone. `None` where the search does not close.
pub(crate) fn settle_towards<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    outward: DVec3,
) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let support = difference.support(outward, &DifferencePoint::NONE);
    let mut simplex = Simplex::EMPTY;
    simplex.push(support);
    let mut search = Search::from_pair(difference, outward, &support);
    search.try_discs();
    if !search.is_settled() {
        search.descend(&simplex);
    }
    search.is_settled().then(|| search.answer()).flatten()
}

/// The axes of the rims that a vertex is on, both ways, in A's frame; zero where there is none.
pub(crate) fn axes<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    vertex: &DifferencePoint,
) -> [DVec3; 4]
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let pair = FeaturePair::of(difference, vertex);
    let of_a = pair.a.rim().map_or(DVec3::ZERO, |rim| rim.axis);
    let of_b = pair.b.rim().map_or(DVec3::ZERO, |rim| rim.axis);
    let of_b = difference.direction_in_a(of_b);
    [of_a, -of_a, of_b, -of_b]
}

/// The answer in a direction if the way out leads through a disc square to it.
pub(crate) fn through_disc<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    outward: DVec3,
) -> Option<Answer>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if outward == DVec3::ZERO {
        return None;
    }
    let support = difference.support(outward, &DifferencePoint::NONE);
    let mut search = Search::from_pair(difference, outward, &support);
    search.try_discs();
    search.is_settled().then(|| search.answer()).flatten()
}
