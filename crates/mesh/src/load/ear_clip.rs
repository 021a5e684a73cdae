//! Cutting simple polygons into triangles by ear clipping (G. H. Meisters, "Polygons have ears", American
//! Mathematical Monthly 82(6), 1975), in the polygon's mean plane (normal by M. E. Newell).

use glam::{DVec2, DVec3};

/// Ear clipping takes a time that grows at least with the square of the corners.
const MAX_CONCAVE: usize = 4096;

/// Turns of less than this, relative to the square of the polygon's extent, count as straight on: well above
/// the rounding of coordinates turned into the polygon's plane.
const STRAIGHT: f64 = 1e-12;

/// How a polygon was cut.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Triangulation {
    /// As a fan.
    Convex,
    /// By ear clipping.
    Concave,
    /// No ear was left (self-intersecting, or all corners on a line): the rest as a fan.
    Failed,
    /// Nothing was cut: a concave polygon with more corners than this.
    TooLong(usize),
}

/// Appends the triangles of `polygon` (at least three corners) to `triangles`, with its winding.
pub(super) fn triangulate(
    positions: &[DVec3],
    polygon: &[u32],
    triangles: &mut Vec<[u32; 3]>,
) -> Triangulation {
    let Some(flat) = projected(positions, polygon) else {
        fan(polygon, triangles);
        return Triangulation::Failed;
    };
    let count = polygon.len();
    let turn = |i: usize| {
        cross(
            flat[(i + count - 1) % count],
            flat[i],
            flat[(i + 1) % count],
        )
    };
    if !winds_once(&flat) {
        fan(polygon, triangles);
        return Triangulation::Failed;
    }
    let extent = flat.iter().fold(0.0, |e: f64, p| e.max(p.length_squared()));
    let straight = STRAIGHT * extent;
    if (0..count).all(|i| turn(i) >= -straight) {
        fan_from_widest(polygon, &flat, straight, triangles);
        return Triangulation::Convex;
    }
    if count > MAX_CONCAVE {
        return Triangulation::TooLong(MAX_CONCAVE);
    }
    let mut ring: Vec<usize> = (0..count).collect();
    let mut start = 0;
    while ring.len() > 3 {
        let Some(ear) = ears_from(start, &flat, &ring).next() else {
            let rest: Vec<u32> = ring.iter().map(|&i| polygon[i]).collect();
            fan(&rest, triangles);
            return Triangulation::Failed;
        };
        let n = ring.len();
        triangles
            .push([ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]].map(|i| polygon[i]));
        ring.remove(ear);
        // Going on behind the last ear instead of from the front saves looking at the same corners again.
        start = ear;
    }
    triangles.push([polygon[ring[0]], polygon[ring[1]], polygon[ring[2]]]);
    Triangulation::Concave
}

/// Corners in the polygon's mean plane, counter-clockwise; none when it has no area.
fn projected(positions: &[DVec3], polygon: &[u32]) -> Option<Vec<DVec2>> {
    let base = positions[polygon[0] as usize];
    let points: Vec<DVec3> = polygon
        .iter()
        .map(|&v| positions[v as usize] - base)
        .collect();
    let normal: DVec3 = points
        .iter()
        .zip(points.iter().cycle().skip(1))
        .map(|(p, q)| p.cross(*q))
        .sum();
    let normal = normal.try_normalize()?;
    let (u, v) = normal.any_orthonormal_pair();
    Some(
        points
            .iter()
            .map(|p| DVec2::new(p.dot(u), p.dot(v)))
            .collect(),
    )
}

/// The outline of a simple polygon turns once to the left in all; a pentagram twice, a figure of eight never.
fn winds_once(flat: &[DVec2]) -> bool {
    let n = flat.len();
    let total: f64 = (0..n)
        .map(|i| {
            let (d, e) = (
                flat[(i + 1) % n] - flat[i],
                flat[(i + 2) % n] - flat[(i + 1) % n],
            );
            d.perp_dot(e).atan2(d.dot(e))
        })
        .sum();
    (total - std::f64::consts::TAU).abs() < 1.0
}

/// Places of ears in the ring, looked for from one place on.
fn ears_from(start: usize, flat: &[DVec2], ring: &[usize]) -> impl Iterator<Item = usize> {
    let n = ring.len();
    (0..n)
        .map(move |k| (start + k) % n)
        .filter(move |&i| is_ear(flat, ring, i))
}

fn is_ear(flat: &[DVec2], ring: &[usize], i: usize) -> bool {
    let n = ring.len();
    let (before, after) = ((i + n - 1) % n, (i + 1) % n);
    let [a, b, c] = [before, i, after].map(|k| flat[ring[k]]);
    if cross(a, b, c) <= 0.0 {
        return false;
    }
    ring.iter().enumerate().all(|(k, &corner)| {
        let p = flat[corner];
        let own = k == before || k == i || k == after || p == a || p == b || p == c;
        own || cross(a, b, p) < 0.0 || cross(b, c, p) < 0.0 || cross(c, a, p) < 0.0
    })
}

fn fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    triangles.extend((1..polygon.len() - 1).map(|i| [polygon[0], polygon[i], polygon[i + 1]]));
}

/// Fan of a convex polygon from a corner that is not straight, so that no triangle is without area.
fn fan_from_widest(polygon: &[u32], flat: &[DVec2], straight: f64, triangles: &mut Vec<[u32; 3]>) {
    let n = polygon.len();
    let smallest = |start: usize| {
        (1..n - 1)
            .map(|i| {
                cross(
                    flat[start],
                    flat[(start + i) % n],
                    flat[(start + i + 1) % n],
                )
            })
            .fold(f64::INFINITY, f64::min)
    };
    // The first corner will do unless it makes a triangle without area; long polygons are not searched.
    let start = if smallest(0) > straight || n > 64 {
        0
    } else {
        (0..n)
            .max_by(|&i, &j| smallest(i).total_cmp(&smallest(j)).then(j.cmp(&i)))
            .unwrap_or(0)
    };
    let turned: Vec<u32> = (0..n).map(|i| polygon[(start + i) % n]).collect();
    fan(&turned, triangles);
}

/// Twice the signed area of a triangle.
fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

#[cfg(test)]
mod tests {
    use super::{Triangulation, triangulate};
    use glam::{DQuat, DVec3};

    /// Area of the triangles, each of which must turn the way of `normal`.
    fn area(points: &[(f64, f64)], expected: &Triangulation) -> f64 {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -0.8, 0.5));
        let positions: Vec<DVec3> = points
            .iter()
            .map(|&(x, y)| turn * DVec3::new(x, y, 2.0))
            .collect();
        let polygon: Vec<u32> = (0..).take(points.len()).collect();
        let mut triangles = Vec::new();
        assert_eq!(triangulate(&positions, &polygon, &mut triangles), *expected);
        assert_eq!(triangles.len(), points.len() - 2);
        let normal = turn * DVec3::Z;
        let twice: Vec<f64> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| positions[v as usize]);
                (b - a).cross(c - a).dot(normal)
            })
            .collect();
        assert!(twice.iter().all(|&a| a > -1e-12), "{twice:?}");
        0.5 * twice.iter().sum::<f64>()
    }

    #[test]
    fn cuts_concave_polygons_to_their_area() {
        let arrow = [(0.0, 0.0), (2.0, 0.0), (0.5, 0.5), (0.0, 2.0)];
        assert!((area(&arrow, &Triangulation::Concave) - 1.0).abs() < 1e-12);
        let comb = [
            (0.0, 0.0),
            (5.0, 0.0),
            (5.0, 3.0),
            (4.0, 3.0),
            (4.0, 1.0),
            (3.0, 1.0),
            (3.0, 3.0),
            (2.0, 3.0),
            (2.0, 1.0),
            (1.0, 1.0),
            (1.0, 3.0),
            (0.0, 3.0),
        ];
        assert!((area(&comb, &Triangulation::Concave) - 11.0).abs() < 1e-12);
        let pentagon = [(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (1.0, 3.0), (-1.0, 1.0)];
        assert!((area(&pentagon, &Triangulation::Convex) - 7.0).abs() < 1e-12);
    }

    #[test]
    fn straight_corners_make_no_flat_triangle() {
        let square = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert!((area(&square, &Triangulation::Convex) - 4.0).abs() < 1e-12);
    }

    #[test]
    fn polygons_that_are_none_are_told() {
        let points = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, 3.0 * DVec3::X];
        let mut triangles = Vec::new();
        assert_eq!(
            triangulate(&points, &[0, 1, 2, 3], &mut triangles),
            Triangulation::Failed
        );
        assert_eq!(triangles.len(), 2);
        let star: Vec<DVec3> = (0..5_i32)
            .map(|i| DQuat::from_rotation_z(f64::from(i) * 2.513_274_122_871_834_5) * DVec3::X)
            .collect();
        assert_eq!(
            triangulate(&star, &[0, 1, 2, 3, 4], &mut triangles),
            Triangulation::Failed
        );
        let long: Vec<DVec3> = (0..5000_i32)
            .map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0))
            .chain([DVec3::new(2500.0, 1e6, 0.0)])
            .collect();
        let polygon: Vec<u32> = (0..5001).collect();
        assert_eq!(
            triangulate(&long, &polygon, &mut triangles),
            Triangulation::TooLong(4096)
        );
    }
}
