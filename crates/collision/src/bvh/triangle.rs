//! Exact queries on one triangle.

use glam::DVec3;

use crate::cast::RayHit;
use crate::simplex::Simplex;
use crate::support::DifferencePoint;

/// Barycentric slack of a ray on an edge, so that rays cannot slip between two triangles that share it.
const EDGE_SLACK: f64 = 1e-12;

/// Ray against the plane of a triangle, then barycentric coordinates of the hit relative to a corner.
pub(super) fn cast_ray(corners: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<RayHit> {
    let [p, q, r] = *corners;
    let (pq, pr) = (q - p, r - p);
    let normal = pq.cross(pr).try_normalize()?;
    let distance = normal.dot(p - origin) / normal.dot(direction);
    // Also refuses the quotients of a parallel ray.
    if !distance.is_finite() || distance < 0.0 {
        return None;
    }
    let point = origin + direction * distance;
    let cross = pq.cross(pr);
    let area_squared = cross.length_squared();
    let foot = point - p;
    let weight_q = foot.cross(pr).dot(cross) / area_squared;
    let weight_r = pq.cross(foot).dot(cross) / area_squared;
    let inside = weight_q >= -EDGE_SLACK
        && weight_r >= -EDGE_SLACK
        && weight_q + weight_r <= 1.0 + EDGE_SLACK;
    inside.then_some(RayHit {
        distance,
        point,
        normal,
    })
}

/// Point of a triangle, degenerate ones included, nearest to `point`.
pub(super) fn closest_point(corners: &[DVec3; 3], point: DVec3) -> DVec3 {
    let mut simplex = Simplex::EMPTY;
    for &corner in corners {
        simplex.push(DifferencePoint {
            point: corner - point,
            a: 0,
            b: 0,
        });
    }
    simplex.reduce();
    let offset: DVec3 = simplex
        .vertices()
        .iter()
        .zip(simplex.weights())
        .map(|(vertex, &weight)| vertex.point * weight)
        .sum();
    point + offset
}
