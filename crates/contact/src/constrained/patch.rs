//! The touching patch of two convex bodies: support polygon of the tool ∩ support polygon of the obstacle (contact.9).
//!
//! Closest-point detection returns an arbitrary pair of points of two parallel faces; a torque taken from it jumps by
//! 0.05–0.17 N·m while nothing moves. The centroid of the patch does not.

use glam::DVec2;

/// Scratch polygons in the contact plane; capacity is set once, so that a tick allocates nothing.
#[derive(Clone, Debug)]
pub(crate) struct PatchPlane {
    pub(crate) obstacle: Vec<DVec2>,
    pub(crate) tool: Vec<DVec2>,
    hull: Vec<DVec2>,
    clipped: Vec<DVec2>,
}

impl PatchPlane {
    /// For support polygons of up to the given numbers of points.
    pub(crate) fn new(obstacle_points: usize, tool_points: usize) -> Self {
        // Clipping a convex polygon by a line adds at most one corner; hulls need twice their input while they are built.
        let most = 2 * (obstacle_points + tool_points) + 4;
        Self {
            obstacle: Vec::with_capacity(most),
            tool: Vec::with_capacity(most),
            hull: Vec::with_capacity(most),
            clipped: Vec::with_capacity(most),
        }
    }

    /// Centre of the overlap of both point sets' hulls; `None` when they do not meet.
    pub(crate) fn centroid(&mut self) -> Option<DVec2> {
        convex_hull(&mut self.obstacle, &mut self.hull);
        convex_hull(&mut self.tool, &mut self.hull);
        let (clip, subject) = if self.obstacle.len() >= 3 {
            (&self.obstacle, &mut self.tool)
        } else {
            (&self.tool, &mut self.obstacle)
        };
        match (clip.len(), subject.len()) {
            (0, _) | (_, 0) => return None,
            (_, 1) => return Some(subject[0]),
            (1, _) => return Some(clip[0]),
            (2, _) => return Some(segment_overlap(clip, subject)),
            _ => {}
        }
        for (index, &start) in clip.iter().enumerate() {
            let end = clip[(index + 1) % clip.len()];
            clip_by_line(subject, &mut self.clipped, start, end - start);
        }
        centre(subject)
    }
}

/// Andrew's monotone chain (1979): `points` becomes its hull, counter-clockwise, without collinear points.
fn convex_hull(points: &mut Vec<DVec2>, hull: &mut Vec<DVec2>) {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return;
    }
    hull.clear();
    let add = |hull: &mut Vec<DVec2>, floor: usize, p: DVec2| {
        while hull.len() >= floor + 2 {
            let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
            if (b - a).perp_dot(p - b) > 1e-12 * (b - a).length() {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    };
    for &p in points.iter() {
        add(hull, 0, p);
    }
    let lower = hull.len() - 1;
    for &p in points.iter().rev().skip(1) {
        add(hull, lower, p);
    }
    hull.pop();
    std::mem::swap(points, hull);
}

/// Keeps the part of a convex polygon left of a line (Sutherland & Hodgman 1974).
fn clip_by_line(polygon: &mut Vec<DVec2>, out: &mut Vec<DVec2>, start: DVec2, along: DVec2) {
    out.clear();
    let side = |p: DVec2| along.perp_dot(p - start);
    // A point on the line belongs to the polygon: touching along an edge must leave the edge.
    let tolerance = -1e-9 * along.length();
    for (index, &a) in polygon.iter().enumerate() {
        let b = polygon[(index + 1) % polygon.len()];
        let (side_a, side_b) = (side(a), side(b));
        if side_a >= tolerance {
            out.push(a);
        }
        if (side_a >= tolerance) != (side_b >= tolerance) {
            out.push(a + (b - a) * (side_a / (side_a - side_b)).clamp(0.0, 1.0));
        }
    }
    std::mem::swap(polygon, out);
}

/// Middle of the common part of two segments, or their crossing.
fn segment_overlap(a: &[DVec2], b: &[DVec2]) -> DVec2 {
    let (p, r) = (a[0], a[1] - a[0]);
    let (q, s) = (b[0], b[1] - b[0]);
    let cross = r.perp_dot(s);
    if cross.abs() > 1e-9 * r.length() * s.length() {
        return p + r * ((q - p).perp_dot(s) / cross).clamp(0.0, 1.0);
    }
    let square = r.length_squared();
    let (t0, t1) = ((b[0] - p).dot(r) / square, (b[1] - p).dot(r) / square);
    let low = t0.min(t1).clamp(0.0, 1.0);
    let high = t0.max(t1).clamp(0.0, 1.0);
    p + r * (0.5 * (low + high))
}

/// Area centroid, or the middle of the two farthest corners of a polygon without area.
fn centre(polygon: &[DVec2]) -> Option<DVec2> {
    let &first = polygon.first()?;
    let mut area = 0.0;
    let mut moment = DVec2::ZERO;
    let mut reach: f64 = 0.0;
    for (&a, &b) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (a, b) = (a - first, b - first);
        let double = a.perp_dot(b);
        area += double;
        moment += (a + b) * double;
        reach = reach.max(a.length());
    }
    if area > 1e-9 * reach * reach && area > 0.0 {
        return Some(first + moment / (3.0 * area));
    }
    let far = |from: DVec2| {
        polygon.iter().copied().fold(from, |best, p| {
            if (p - from).length_squared() > (best - from).length_squared() {
                p
            } else {
                best
            }
        })
    };
    let end = far(first);
    Some(0.5 * (end + far(end)))
}

#[cfg(test)]
mod tests {
    use super::PatchPlane;
    use glam::DVec2;

    fn centroid(obstacle: &[[f64; 2]], tool: &[[f64; 2]]) -> Option<DVec2> {
        let mut plane = PatchPlane::new(16, 16);
        plane
            .obstacle
            .extend(obstacle.iter().copied().map(DVec2::from));
        plane.tool.extend(tool.iter().copied().map(DVec2::from));
        plane.centroid()
    }

    const SQUARE: [[f64; 2]; 5] = [[0., 0.], [2., 0.], [2., 2.], [0., 2.], [1., 2.]];

    #[test]
    fn two_overlapping_squares_share_their_common_quarter() {
        let shifted = SQUARE.map(|[x, y]| [x + 1.0, y + 1.0]);
        let c = centroid(&SQUARE, &shifted).expect("overlap");
        assert!((c - DVec2::new(1.5, 1.5)).length() < 1e-12);
    }

    #[test]
    fn an_edge_across_a_face_is_cut_to_the_face() {
        let c = centroid(&SQUARE, &[[-3.0, 1.0], [1.0, 1.0]]).expect("overlap");
        assert!((c - DVec2::new(0.5, 1.0)).length() < 1e-12);
        let swapped = centroid(&[[-3.0, 1.0], [1.0, 1.0]], &SQUARE).expect("overlap");
        assert!((swapped - c).length() < 1e-12);
    }

    #[test]
    fn crossing_edges_meet_in_a_point_and_parallel_ones_in_a_middle() {
        let c = centroid(&[[0., 0.], [2., 2.]], &[[0., 2.], [2., 0.]]).expect("cross");
        assert!((c - DVec2::ONE).length() < 1e-12);
        let c = centroid(&[[0., 0.], [2., 0.]], &[[1., 0.], [5., 0.]]).expect("overlap");
        assert!((c - DVec2::new(1.5, 0.0)).length() < 1e-12);
    }

    #[test]
    fn a_vertex_is_its_own_patch_and_distant_polygons_have_none() {
        assert_eq!(centroid(&SQUARE, &[[0.3, 0.4]]), Some(DVec2::new(0.3, 0.4)));
        let far = SQUARE.map(|[x, y]| [x + 10.0, y]);
        assert_eq!(centroid(&SQUARE, &far), None);
    }
}
