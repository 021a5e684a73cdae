//! Supports of up to three places in one direction, and the point between them.

use glam::DVec3;

use crate::simplex::cross_of;

/// Height of a triangle of places that is no triangle, times its longest side.
const COLLINEAR: f64 = 1e-10;

/// The support of a place in a direction.
#[derive(Clone, Copy, Default)]
pub(crate) struct Foot {
    pub(crate) in_a: DVec3,
    pub(crate) in_b: DVec3,
    pub(crate) point: DVec3,
    /// Tangents whose dyads add up to the derivative of the point by the direction.
    pub(crate) bends: [DVec3; 2],
    /// Share of the point of the surface that is met.
    pub(crate) weight: f64,
}

/// The direction nearest to `outward` in which all feet are equally high; `None` where they are on one line and no
/// direction stands out.
pub(crate) fn level(outward: DVec3, feet: &[Foot]) -> Option<DVec3> {
    match feet {
        [p, q] => {
            let along = (q.point - p.point).try_normalize()?;
            let level = (outward - along * along.dot(outward)).try_normalize()?;
            Some((level - along * along.dot(level)).normalize())
        }
        [p, q, r] => {
            let (cross, _) = cross_of([p.point, q.point, r.point]);
            let longest = (p.point.distance_squared(q.point))
                .max(q.point.distance_squared(r.point))
                .max(r.point.distance_squared(p.point));
            if cross.length() <= COLLINEAR * longest {
                return None;
            }
            let normal = cross.normalize();
            Some(if normal.dot(outward) < 0.0 {
                -normal
            } else {
                normal
            })
        }
        _ => Some(outward),
    }
}

/// The one of feet on a line that the others make up: between the ends.
pub(crate) fn between(feet: &[Foot]) -> usize {
    let corner = |index: usize| feet[index % feet.len()].point;
    let sides = (0..feet.len()).map(|index| corner(index + 1).distance_squared(corner(index + 2)));
    let longest = sides
        .enumerate()
        .max_by(|(_, one), (_, other)| one.total_cmp(other));
    longest.map_or(0, |(index, _)| index)
}

/// Weights with which the feet make up the point of their line or plane nearest to `exit`.
pub(crate) fn weigh(feet: &mut [Foot], exit: DVec3) {
    match feet {
        [p] => p.weight = 1.0,
        [p, q] => {
            let along = q.point - p.point;
            let share = (exit - p.point).dot(along) / along.length_squared();
            (p.weight, q.weight) = (1.0 - share, share);
        }
        [p, q, r] => {
            let (pq, pr) = (q.point - p.point, r.point - p.point);
            let cross = pq.cross(pr);
            let foot = exit - p.point;
            q.weight = foot.cross(pr).dot(cross) / cross.length_squared();
            r.weight = pq.cross(foot).dot(cross) / cross.length_squared();
            p.weight = 1.0 - q.weight - r.weight;
        }
        _ => {}
    }
}

/// The least weight and whose it is.
pub(crate) fn least_weight(feet: &[Foot]) -> Option<(usize, f64)> {
    let weights = feet.iter().map(|foot| foot.weight).enumerate();
    weights.min_by(|(_, one), (_, other)| one.total_cmp(other))
}
