//! Ways out through the flat discs of cylinders and cones.

use crate::rims::search::Search;
use crate::support::{DifferencePoint, SupportMap};

/// Cosine of a normal with the axis of a disc that might be the face met.
const NEARLY_SQUARE: f64 = 0.999_999;

impl<A, B> Search<'_, '_, A, B>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    /// The planes of the rims' discs where they are almost the one found: three corners of a rim close to each other
    /// tell its plane badly.
    pub(in crate::rims) fn try_discs(&mut self) {
        let difference = self.difference;
        let found = self.outward;
        for pair in self.pairs.into_iter().take(self.len) {
            for (side, rim) in [pair.a.rim(), pair.b.rim()].into_iter().enumerate() {
                let Some(rim) = rim else { continue };
                let axis = if side == 0 {
                    rim.axis
                } else {
                    difference.direction_in_a(rim.axis)
                };
                let along = axis.dot(found);
                if along.abs() < NEARLY_SQUARE {
                    continue;
                }
                let outward = axis * along.signum();
                let support = difference.support(outward, &DifferencePoint::NONE);
                let reach = support.point.dot(outward);
                let exit = outward * reach;
                let mut points = [
                    difference.a.vertex(support.a),
                    difference.b.vertex(support.b),
                ];
                points[side] = rim.centre;
                let aside = exit - difference.difference(points[0], points[1]);
                // The disc met need not be the highest one: what is across its plane stays missing.
                let flat = aside - outward * outward.dot(aside);
                let within = flat.clamp_length_max(rim.radius);
                points[side] += if side == 0 {
                    -within
                } else {
                    difference.direction_in_b(within)
                };
                let miss = exit - difference.difference(points[0], points[1]);
                self.offer(outward, reach, points, miss);
            }
        }
    }
}
