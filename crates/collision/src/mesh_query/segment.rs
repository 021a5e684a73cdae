//! Segment against triangle in closed form: apart by the nearest pair of features, piercing by the shallowest face of
//! the Minkowski difference.
//!
//! The difference of a segment and a triangle is a prism: the triangle swept along the segment. Its depth at the origin is
//! the least over its five faces, two parallel to the triangle and one per edge (Ericson 2005, §5.1.9–10 for the distances).
//! Every normal is computed from the two features that meet (plane, cross product of two lines, orthogonalised rejection),
//! so that it stays exact at any gap, as in [`crate::simplex`].

use glam::DVec3;

use crate::ClosestPoints;
use crate::bvh::triangle::{barycentric, from_segment, over_inside, unit_normal};

/// Lines closer to parallel than this sine have no common normal of use; the ends of the segments then decide.
const PARALLEL: f64 = 1e-12;

/// Distances below this times the size are rounding.
const TOUCHING: f64 = 4.0 * f64::EPSILON;

const EDGES: [(usize, usize, usize); 3] = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];

/// A separating or supporting pair: point of the triangle, unit normal towards the segment, signed separation.
#[derive(Clone, Copy)]
struct Pair {
    on_triangle: DVec3,
    normal: DVec3,
    separation: f64,
}

/// Nearest or deepest points of a triangle (A) and a segment of the given radius around it (B), in one frame [m] (collision.43).
pub(crate) fn against_triangle(
    corners: &[DVec3; 3],
    [a, b]: [DVec3; 2],
    radius: f64,
) -> ClosestPoints {
    // Relative to a corner the coordinates are as small as the shapes.
    let origin = corners[0];
    let local = corners.map(|corner| corner - origin);
    let ends = [a - origin, b - origin];
    let plane = unit_normal(&local);
    let pair = piercing(&local, plane, ends).unwrap_or_else(|| apart(&local, plane, ends));
    let on_triangle = pair.on_triangle + origin;
    let separation = pair.separation - radius;
    ClosestPoints {
        witness_a: on_triangle,
        witness_b: on_triangle + pair.normal * separation,
        normal: pair.normal,
        separation,
    }
}

/// The way out of a triangle that the segment pierces; `None` if it does not.
fn piercing(corners: &[DVec3; 3], normal: Option<DVec3>, [a, b]: [DVec3; 2]) -> Option<Pair> {
    let normal = normal?;
    let (of_a, of_b) = (normal.dot(a - corners[0]), normal.dot(b - corners[0]));
    let rise = of_b - of_a;
    if of_a * of_b > 0.0 || rise == 0.0 {
        return None;
    }
    let point = a + (b - a) * (-of_a / rise);
    if barycentric(corners, point).iter().any(|&w| w < 0.0) {
        return None;
    }
    let (low, high, bottom, top) = if rise > 0.0 {
        (of_a, of_b, a, b)
    } else {
        (of_b, of_a, b, a)
    };
    let mut best = Pair {
        on_triangle: bottom - normal * low,
        normal,
        separation: low,
    };
    if -high > best.separation {
        best = Pair {
            on_triangle: top - normal * high,
            normal: -normal,
            separation: -high,
        };
    }
    let along = b - a;
    for (i, j, opposite) in EDGES {
        let edge = corners[j] - corners[i];
        let cross = edge.cross(along);
        let sine_scaled = cross.length();
        if sine_scaled <= PARALLEL * edge.length() * along.length() {
            continue;
        }
        let outward = cross / sine_scaled;
        let outward = if outward.dot(corners[opposite] - corners[i]) > 0.0 {
            -outward
        } else {
            outward
        };
        // Both lines lie across the normal: any of their points measures the height.
        let separation = outward.dot(point - corners[i]);
        if separation > best.separation {
            let on_edge = (a - corners[i]).cross(along).dot(cross) / (sine_scaled * sine_scaled);
            best = Pair {
                on_triangle: corners[i] + edge * on_edge.clamp(0.0, 1.0),
                normal: outward,
                separation,
            };
        }
    }
    Some(best)
}

/// The nearest pair of features: ends over the triangle, corners beside the segment, edges across it.
fn apart(corners: &[DVec3; 3], normal: Option<DVec3>, [a, b]: [DVec3; 2]) -> Pair {
    let mut best = Pair {
        on_triangle: corners[0],
        normal: DVec3::ZERO,
        separation: f64::INFINITY,
    };
    for end in [a, b] {
        if let Some((on_triangle, towards, separation)) = over_inside(corners, normal, end) {
            let pair = Pair {
                on_triangle,
                normal: towards,
                separation,
            };
            best = nearer(best, pair);
        }
    }
    for &corner in corners {
        let (to_corner, _) = from_segment(a, b, corner);
        best = nearer(best, between(corner, -to_corner));
    }
    for (i, j, _) in EDGES {
        for end in [a, b] {
            let (from_edge, _) = from_segment(corners[i], corners[j], end);
            best = nearer(best, between(end - from_edge, from_edge));
        }
        if let Some(pair) = across(corners[i], corners[j], [a, b]) {
            best = nearer(best, pair);
        }
    }
    let size = (b - a).abs().max(corners[1].abs()).max(corners[2].abs());
    if best.separation <= TOUCHING * size.max_element() {
        return touching(corners, normal, [a, b], best);
    }
    best
}

/// Of a pair that touches, whose own direction is rounding or nothing, the direction that supports both best: one of the
/// prism's faces does, and where the prism is flat its plane.
fn touching(corners: &[DVec3; 3], plane: Option<DVec3>, [a, b]: [DVec3; 2], pair: Pair) -> Pair {
    let mut best = Pair {
        separation: f64::NEG_INFINITY,
        ..pair
    };
    let along = b - a;
    let edges = EDGES.map(|(i, j, _)| corners[j] - corners[i]);
    let longest = edges.into_iter().fold(along, |best, edge| {
        if edge.length_squared() > best.length_squared() {
            edge
        } else {
            best
        }
    });
    let crosses = edges.map(|edge| edge.cross(along).normalize_or_zero());
    let plane = plane.unwrap_or(DVec3::ZERO);
    let beside = longest.any_orthogonal_vector().normalize_or(DVec3::Z);
    for direction in [
        pair.normal,
        plane,
        crosses[0],
        crosses[1],
        crosses[2],
        beside,
    ] {
        if direction == DVec3::ZERO {
            continue;
        }
        for normal in [direction, -direction] {
            let top = corners
                .iter()
                .map(|corner| corner.dot(normal))
                .fold(f64::NEG_INFINITY, f64::max);
            let separation = a.dot(normal).min(b.dot(normal)) - top;
            if separation > best.separation {
                best.normal = normal;
                best.separation = separation;
            }
        }
    }
    best
}

fn nearer(best: Pair, other: Pair) -> Pair {
    if other.separation < best.separation {
        other
    } else {
        best
    }
}

/// The pair whose points are `offset` apart.
fn between(on_triangle: DVec3, offset: DVec3) -> Pair {
    let separation = offset.length();
    Pair {
        on_triangle,
        normal: if separation > 0.0 {
            offset / separation
        } else {
            DVec3::ZERO
        },
        separation,
    }
}

/// Nearest points of an edge and the segment where both are inner points.
fn across(from: DVec3, to: DVec3, [a, b]: [DVec3; 2]) -> Option<Pair> {
    let (edge, along) = (to - from, b - a);
    let cross = edge.cross(along);
    let squared = cross.length_squared();
    if squared <= PARALLEL * PARALLEL * edge.length_squared() * along.length_squared() {
        return None;
    }
    let between = a - from;
    let on_edge = between.cross(along).dot(cross) / squared;
    let on_segment = between.cross(edge).dot(cross) / squared;
    let inner = 0.0..=1.0;
    if !(inner.contains(&on_edge) && inner.contains(&on_segment)) {
        return None;
    }
    let on_triangle = from + edge * on_edge;
    let normal = cross / squared.sqrt();
    // The points are nearly one above the other: what their rounding adds sideways, the product drops.
    let height = normal.dot((a + along * on_segment) - on_triangle);
    Some(Pair {
        on_triangle,
        normal: if height < 0.0 { -normal } else { normal },
        separation: height.abs(),
    })
}
