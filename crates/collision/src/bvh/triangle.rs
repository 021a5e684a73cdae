//! Exact queries on one triangle.

use glam::DVec3;

use crate::RayHit;

/// Distance of a ray's point from an edge that rounding explains, times the coordinates at hand: so much may lie outside a
/// triangle, or rays would slip between two that share the edge.
const EDGE_SLACK: f64 = 16.0 * f64::EPSILON;

/// A triangle whose altitude is below this times its longest side has no plane to speak of.
pub(crate) const FLAT: f64 = 1e-15;

/// Unit normal of a triangle by its winding; `None` without area.
pub(crate) fn unit_normal([p, q, r]: &[DVec3; 3]) -> Option<DVec3> {
    let (pq, pr) = (q - p, r - p);
    let cross = pq.cross(pr);
    let longest = pq.length_squared().max(pr.length_squared());
    let area = cross.length();
    (area > FLAT * longest && area.is_normal()).then(|| cross / area)
}

/// Ray against the plane of a triangle, then barycentric coordinates of the hit relative to a corner.
pub(super) fn cast_ray(corners: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<RayHit> {
    let normal = unit_normal(corners)?;
    let distance = normal.dot(corners[0] - origin) / normal.dot(direction);
    // Also refuses the quotients of a parallel ray.
    if !distance.is_finite() || distance < 0.0 {
        return None;
    }
    let point = origin + direction * distance;
    let [p, q, r] = *corners;
    let longest = p.distance(q).max(q.distance(r)).max(r.distance(p));
    let coordinates = origin.length() + distance + p.length() + longest;
    // Weights are distances from edges over altitudes, of which area over the longest side is the least.
    let slack = EDGE_SLACK * coordinates * longest / (q - p).cross(r - p).length();
    let inside = barycentric(corners, point)
        .iter()
        .all(|&weight| weight >= -slack);
    inside.then_some(RayHit {
        distance,
        point,
        normal,
    })
}

/// Weights of the corners for the foot of `point` in the plane of a triangle with area.
pub(crate) fn barycentric([p, q, r]: &[DVec3; 3], point: DVec3) -> [f64; 3] {
    let (pq, pr) = (q - p, r - p);
    let cross = pq.cross(pr);
    let area_squared = cross.length_squared();
    let foot = point - p;
    let of_q = foot.cross(pr).dot(cross) / area_squared;
    let of_r = pq.cross(foot).dot(cross) / area_squared;
    [1.0 - of_q - of_r, of_q, of_r]
}

/// Vector from the nearest point of a segment to `point`, orthogonal to the segment to rounding where the nearest point
/// is not an end, and the nearest point's fraction of the way from `start` to `end`.
pub(crate) fn from_segment(start: DVec3, end: DVec3, point: DVec3) -> (DVec3, f64) {
    let along = end - start;
    let length_squared = along.length_squared();
    let fraction = (point - start).dot(along) / length_squared;
    if fraction >= 1.0 {
        return (point - end, 1.0);
    }
    // NaN: the segment has no length.
    if fraction <= 0.0 || fraction.is_nan() {
        return (point - start, 0.0);
    }
    let rejection = (point - start) - along * fraction;
    // The first rejection is orthogonal to rounding of the input; the second to rounding of itself.
    let rejection = rejection - along * (rejection.dot(along) / length_squared);
    (rejection, fraction)
}

/// Point of a triangle, degenerate ones included, nearest to `point`, and the unit vector and distance from it to `point`.
/// The vector is zero if the two coincide, and the plane's normal to rounding over the triangle's inside.
pub(crate) fn nearest(corners: &[DVec3; 3], point: DVec3) -> (DVec3, DVec3, f64) {
    if let Some(answer) = over_inside(corners, unit_normal(corners), point) {
        return answer;
    }
    let mut best = (DVec3::ZERO, f64::INFINITY);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let (offset, _) = from_segment(corners[i], corners[j], point);
        let squared = offset.length_squared();
        if squared < best.1 {
            best = (offset, squared);
        }
    }
    let distance = best.0.length();
    let towards = if distance > 0.0 {
        best.0 / distance
    } else {
        DVec3::ZERO
    };
    (point - best.0, towards, distance)
}

/// [`nearest`] for a point over the inside of a triangle with area; `None` elsewhere.
pub(crate) fn over_inside(
    corners: &[DVec3; 3],
    normal: Option<DVec3>,
    point: DVec3,
) -> Option<(DVec3, DVec3, f64)> {
    let normal = normal?;
    if barycentric(corners, point).iter().any(|&w| w < 0.0) {
        return None;
    }
    let height = normal.dot(point - corners[0]);
    let towards = if height < 0.0 { -normal } else { normal };
    Some((point - normal * height, towards, height.abs()))
}
