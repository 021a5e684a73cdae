//! Cutting polygons into triangles by ear clipping (G. H. Meisters, "Polygons have ears", American Mathematical
//! Monthly 82(6), 1975) in the polygon's mean plane (normal by M. E. Newell), decided by exact orientation
//! predicates (J. R. Shewchuk 1997), so that rounding neither hides an ear nor invents one.
//!
//! Only reflex corners can lie in an ear, and clipping one changes only its two neighbours (D. Eberly,
//! "Triangulation by ear clipping", 2002), so n corners of which r are reflex take O(n r) steps.
//!
//! Each triangle cut off winds the way of the polygon. Triangles whose signed areas add up to the winding number
//! of the outline, none of them negative, cover it exactly, so a polygon that is clipped to the end is cut right
//! also where it touches itself.

mod clipper;

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};

use clipper::Clipper;

/// Corners of the largest concave polygon: a second of work.
const MAX_CONCAVE: usize = 1 << 14;

/// Corners of a convex polygon up to which the best start of the fan is searched.
const MAX_SEARCHED: usize = 64;

/// Turns of less than this, relative to the square of the polygon's extent, count as straight on: well above
/// the rounding of coordinates turned into the polygon's plane.
const STRAIGHT: f64 = 1e-12;

/// How a polygon was cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

/// Appends the triangles of `polygon` (at least three corners) to `triangles`, with its winding (mesh.13). Corners at
/// the place of the one before, and those where the outline turns back on itself, get no triangle.
pub(super) fn triangulate(
    positions: &[DVec3],
    polygon: &[u32],
    triangles: &mut Vec<[u32; 3]>,
) -> Triangulation {
    let Some(flat) = projected(positions, polygon) else {
        fan(polygon, triangles);
        return Triangulation::Failed;
    };
    let outline = without_spikes(&flat);
    if outline.len() < 3 || !winds_once(&flat, &outline) {
        fan(polygon, triangles);
        return Triangulation::Failed;
    }
    if let Some(fan) = convex_fan(&flat, &outline) {
        triangles.extend(fan.iter().map(|t| t.map(|i| polygon[i as usize])));
        return Triangulation::Convex;
    }
    if outline.len() > MAX_CONCAVE {
        return Triangulation::TooLong(MAX_CONCAVE);
    }
    let mut clipper = Clipper::new(&flat, &outline);
    while let Some(ear) = clipper.next_ear() {
        triangles.push(clipper.corners(ear).map(|i| polygon[i as usize]));
        clipper.clip(ear);
    }
    let rest: Vec<u32> = clipper
        .ring()
        .iter()
        .map(|&i| polygon[i as usize])
        .collect();
    let turn = clipper.turn(clipper.first);
    if rest.len() > 3 || turn < 0.0 {
        fan(&rest, triangles);
        return Triangulation::Failed;
    }
    if turn > 0.0 {
        fan(&rest, triangles);
    }
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

/// The corners without those at the place of their neighbour and without the tips of spikes, to which the
/// outline goes and returns on the same line.
fn without_spikes(flat: &[DVec2]) -> Vec<u32> {
    let mut kept: Vec<u32> = Vec::with_capacity(flat.len());
    for corner in (0..).take(flat.len()) {
        kept.push(corner);
        while shortened(flat, &mut kept) {}
    }
    // Around the seam between the last corner and the first.
    let mut first = 0;
    while kept.len() - first >= 3 {
        let n = kept.len();
        let [a, b, c, d] =
            [kept[n - 2], kept[n - 1], kept[first], kept[first + 1]].map(|i| flat[i as usize]);
        if b == c || turns_back(a, b, c) {
            kept.pop();
        } else if turns_back(b, c, d) {
            first += 1;
        } else {
            break;
        }
    }
    kept.drain(..first);
    kept
}

/// Drops the last corner, or the last but one, if it is idle.
fn shortened(flat: &[DVec2], kept: &mut Vec<u32>) -> bool {
    let at = |i: u32| flat[i as usize];
    match kept[..] {
        [.., a, b, c] if turns_back(at(a), at(b), at(c)) => {
            kept.remove(kept.len() - 2);
            true
        }
        [.., b, c] if at(b) == at(c) => {
            kept.pop();
            true
        }
        _ => false,
    }
}

fn turns_back(a: DVec2, b: DVec2, c: DVec2) -> bool {
    orient(a, b, c) == 0.0 && (b - a).dot(c - b) < 0.0
}

/// The outline of a simple polygon turns once to the left in all; a pentagram twice, a figure of eight never.
fn winds_once(flat: &[DVec2], outline: &[u32]) -> bool {
    let n = outline.len();
    let at = |i: usize| flat[outline[i % n] as usize];
    let total: f64 = (0..n)
        .map(|i| {
            let (d, e) = (at(i + 1) - at(i), at(i + 2) - at(i + 1));
            d.perp_dot(e).atan2(d.dot(e))
        })
        .sum();
    (total - std::f64::consts::TAU).abs() < 1.0
}

/// The fan of a convex outline, from a corner that makes no triangle without area; none when the outline is concave,
/// or when no such corner is found.
fn convex_fan(flat: &[DVec2], outline: &[u32]) -> Option<Vec<[u32; 3]>> {
    let n = outline.len();
    let at = |i: usize| flat[outline[i % n] as usize];
    let extent = flat.iter().fold(0.0, |e: f64, p| e.max(p.length_squared()));
    let straight = STRAIGHT * extent;
    let twice_area = |i: usize, j: usize, k: usize| (at(j) - at(i)).perp_dot(at(k) - at(i));
    if (0..n).any(|i| twice_area(i, i + 1, i + 2) < -straight) {
        return None;
    }
    let smallest = |start: usize| {
        (1..n - 1)
            .map(|i| twice_area(start, start + i, start + i + 1))
            .fold(f64::INFINITY, f64::min)
    };
    // Beyond what can be clipped any fan will do.
    let start = if n > MAX_CONCAVE || smallest(0) > straight {
        0
    } else if n <= MAX_SEARCHED {
        (0..n).max_by(|&i, &j| smallest(i).total_cmp(&smallest(j)).then(j.cmp(&i)))?
    } else {
        return None;
    };
    // A triangle has one way only; a thin one is left to whoever looks at the mesh.
    if (4..=MAX_SEARCHED).contains(&n) && smallest(start) <= straight {
        return None;
    }
    let corner = |i: usize| outline[(start + i) % n];
    Some(
        (1..n - 1)
            .map(|i| [corner(0), corner(i), corner(i + 1)])
            .collect(),
    )
}

fn fan(polygon: &[u32], triangles: &mut Vec<[u32; 3]>) {
    triangles.extend((1..polygon.len() - 1).map(|i| [polygon[0], polygon[i], polygon[i + 1]]));
}

/// Positive for a left turn; the sign is exact.
fn orient(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let at = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(at(a), at(b), at(c))
}

#[cfg(test)]
mod tests {
    use super::{MAX_CONCAVE, Triangulation, triangulate};
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
        let n = i32::try_from(MAX_CONCAVE).unwrap();
        let long: Vec<DVec3> = (0..n)
            .map(|i| DVec3::new(f64::from(i), f64::from(i % 2), 0.0))
            .chain([DVec3::new(2500.0, 1e6, 0.0)])
            .collect();
        let polygon: Vec<u32> = (0..).take(long.len()).collect();
        assert_eq!(
            triangulate(&long, &polygon, &mut triangles),
            Triangulation::TooLong(MAX_CONCAVE)
        );
    }

    /// Area and number of the triangles of a polygon in the plane, none of them turned over.
    fn cut(points: &[[f64; 2]]) -> (Triangulation, f64, usize) {
        let positions: Vec<DVec3> = points.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
        let polygon: Vec<u32> = (0..).take(points.len()).collect();
        let mut triangles = Vec::new();
        let how = triangulate(&positions, &polygon, &mut triangles);
        let twice = triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            (b - a).cross(c - a).z
        });
        let twice: Vec<f64> = twice.collect();
        assert!(twice.iter().all(|&a| a >= 0.0), "{points:?}: {twice:?}");
        (how, 0.5 * twice.iter().sum::<f64>(), triangles.len())
    }

    #[test]
    fn repeated_corners_and_spikes_get_no_triangle() {
        let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
        for at in 0..4 {
            let mut doubled = square.to_vec();
            doubled.insert(at, square[at]);
            assert_eq!(cut(&doubled), (Triangulation::Convex, 4.0, 2), "{at}");
            // Out from the middle of a side and back again.
            let (from, to) = (square[at], square[(at + 1) % 4]);
            let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
            let tip = [3.0 * middle[0] - 2.0, 3.0 * middle[1] - 2.0];
            let mut spiked = square.to_vec();
            drop(spiked.splice((at + 1)..=at, [middle, tip, middle]));
            for turn in 0..spiked.len() {
                spiked.rotate_left(1);
                let (_, area, _) = cut(&spiked);
                assert!((area - 4.0).abs() < 1e-15, "{at} {turn}: {area}");
            }
        }
    }

    #[test]
    fn outlines_that_touch_themselves_are_cut_right() {
        // A square with a square hole, joined by a bridge that is run through twice.
        let bridged = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 4.0],
            [0.0, 4.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
        ];
        // Two triangles that touch in a corner, and a notch whose tip touches the opposite side.
        let bow = [
            [0.0, 0.0],
            [1.0, 1.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [1.0, 1.0],
            [0.0, 2.0],
        ];
        let notch = [
            [0.0, 0.0],
            [2.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [2.0, 0.0],
            [0.0, 3.0],
        ];
        for (outline, area) in [(&bridged[..], 12.0), (&bow, 2.0), (&notch, 6.0)] {
            let mut outline = outline.to_vec();
            for _ in 0..outline.len() {
                outline.rotate_left(1);
                let (how, found, _) = cut(&outline);
                assert_eq!(how, Triangulation::Concave, "{outline:?}");
                assert!((found - area).abs() < 1e-14, "{outline:?}: {found}");
            }
        }
    }

    #[test]
    fn straight_corners_on_every_side_make_no_flat_triangle() {
        let n = 100_u32;
        let ring: Vec<[f64; 2]> = (0..n)
            .map(|i| {
                let (along, rest) = (f64::from(i % 25), f64::from(25 - i % 25));
                match i / 25 {
                    0 => [along, 0.0],
                    1 => [25.0, along],
                    2 => [rest, 25.0],
                    _ => [0.0, rest],
                }
            })
            .collect();
        let (_, area, count) = cut(&ring);
        assert_eq!((area.to_bits(), count), (625.0_f64.to_bits(), 98));
    }

    /// Stars with random radii, seen from their middle once around: simple whatever the radii.
    #[test]
    fn random_stars_and_a_large_one_keep_their_area() {
        let mut state = 7_u64;
        let mut draw = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            f64::from(u32::try_from(state >> 33).unwrap()) / f64::from(u32::MAX >> 1)
        };
        let sizes = (0..300).map(|i| 4 + i % 60).chain([10_000]);
        for n in sizes {
            let star: Vec<[f64; 2]> = (0..n)
                .map(|i| {
                    let (sin, cos) =
                        (f64::from(i) / f64::from(n) * std::f64::consts::TAU).sin_cos();
                    // Rounded to a coarse grid now and then, for collinear and coincident corners.
                    let radius = 0.2 + draw();
                    let place = [radius * cos, radius * sin];
                    if n % 2 == 0 && n < 100 {
                        place.map(|x| (x * 64.0).round() / 64.0)
                    } else {
                        place
                    }
                })
                .collect();
            let exact: f64 = (0..star.len())
                .map(|i| {
                    let ([a, b], [c, d]) = (star[i], star[(i + 1) % star.len()]);
                    0.5 * (a * d - b * c)
                })
                .sum();
            let (how, area, _) = cut(&star);
            assert_ne!(how, Triangulation::Failed, "{star:?}");
            assert!((area - exact).abs() < 1e-12, "{n}: {area} {exact}");
        }
    }
}
