//! A tetrahedron with volume from whatever simplex GJK ended on.

use glam::DVec3;

use crate::simplex::{NOISE, Simplex};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

/// What the difference is, seen from the simplex.
pub(crate) enum Seed {
    /// Four independent vertices of it.
    Solid([DifferencePoint; 4]),
    /// It has no volume; a unit normal of a plane that holds it.
    Flat(DVec3),
}

/// Completes a simplex: of the vertices at hand and the support points at right angles to what is there already, the one
/// that adds most, verified against rounding, at each step from point to segment to triangle to tetrahedron.
pub(crate) fn complete<A, B>(difference: &MinkowskiDifference<'_, A, B>, simplex: &Simplex) -> Seed
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut found = Search {
        difference,
        simplex,
        origin: simplex.vertices()[0],
        noise: 0.0,
    };
    found.noise = NOISE * found.extent();
    let p = found.origin;
    let Some(q) = found.furthest(DVec3::length, &[DVec3::X, DVec3::Y, DVec3::Z]) else {
        return Seed::Flat(DVec3::X);
    };
    let along = (q.point - p.point).normalize_or_zero();
    let (across, up) = along.any_orthonormal_pair();
    let Some(r) = found.furthest(
        |point| point.cross(along).length(),
        &[across, up, across + up, across - up],
    ) else {
        return Seed::Flat(across);
    };
    let normal = (q.point - p.point)
        .cross(r.point - p.point)
        .normalize_or_zero();
    match found.furthest(|point| point.dot(normal).abs(), &[normal]) {
        Some(s) => Seed::Solid([p, q, r, s]),
        None => Seed::Flat(normal),
    }
}

struct Search<'s, 'd, A: ?Sized, B: ?Sized> {
    difference: &'s MinkowskiDifference<'d, A, B>,
    simplex: &'s Simplex,
    origin: DifferencePoint,
    noise: f64,
}

impl<A: SupportMap + ?Sized, B: SupportMap + ?Sized> Search<'_, '_, A, B> {
    /// Largest coordinate of the difference, roughly. Four vertices around the origin tell it; fewer may all lie near the
    /// origin.
    fn extent(&self) -> f64 {
        let extent = self.simplex.scale();
        if self.simplex.vertices().len() == 4 {
            return extent;
        }
        let axes = [DVec3::X, DVec3::Y, DVec3::Z];
        axes.into_iter()
            .flat_map(|axis| [axis, -axis])
            .map(|axis| self.difference.support(axis, &self.origin).point.length())
            .fold(extent, f64::max)
    }

    /// The vertex that `measure` (of its position relative to the first one) puts furthest: one of the simplex where they
    /// are worth having, else the best support point along the directions and their opposites. `None`: all are noise.
    fn furthest(
        &self,
        measure: impl Fn(DVec3) -> f64,
        directions: &[DVec3],
    ) -> Option<DifferencePoint> {
        let measured =
            |vertex: DifferencePoint| (measure(vertex.point - self.origin.point), vertex);
        let better = |best: (f64, DifferencePoint), next: (f64, DifferencePoint)| {
            if next.0 > best.0 { next } else { best }
        };
        let nothing = (self.noise, self.origin);
        let own = self.simplex.vertices().iter().copied().map(measured);
        let best = own.fold(nothing, better);
        // A seed a thousand times thinner than it might be would be right, but its faces poorly determined.
        if best.0 > 1e3 * self.noise {
            return Some(best.1);
        }
        let reached = directions
            .iter()
            .flat_map(|&direction| [direction, -direction])
            .map(|direction| measured(self.difference.support(direction, &self.origin)));
        let best = reached.fold(best, better);
        (best.0 > self.noise).then_some(best.1)
    }
}
