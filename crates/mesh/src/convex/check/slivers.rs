//! Faces too thin to have a plane (mesh.16): a strip of them as fine as it likes could hide any groove.
//!
//! Whatever its own plane, a thin face lies close below the hull if all its corners lie close below one plane that supports
//! all vertices. Beside a thick face across its longest edge that plane is known. For others one is searched: from the
//! face's normal, the plane found last and the direction away from the middle, by relaxation (S. Agmon, "The relaxation method for linear
//! inequalities", Canadian Journal of Mathematics 6, 1954). Planes that were found are tried on neighbours first.

use glam::DVec3;

use super::planes::Tree;
use crate::{FaceId, HalfEdgeMesh, VertexId};

/// How deep a thin face may lie, in tolerances: one for the edge that it shares with a thick face, one for its altitude.
const DEPTH: f64 = 2.0;

/// Share of the allowed depth to which the height of a supporting plane is known: finer, and all vertices of a flat side
/// would be looked at.
const SLACK: f64 = 1e-3;

/// Planes tried before a new one is searched.
const RECENT: usize = 8;

/// Steps of the relaxation from one start. Two or three do at edges, flat sides and round ones.
const STEPS: usize = 32;

/// Sine of the angle between two rises below which they count as one.
const PARALLEL: f64 = 1e-6;

/// A thin face that is not near the hull.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sunken {
    pub(super) face: FaceId,
    /// Its deepest corner.
    pub(super) vertex: VertexId,
    /// Least depth found below a plane that supports all vertices [m].
    pub(super) depth: f64,
    /// What is allowed [m].
    pub(super) allowed: f64,
}

/// A direction and a height that no vertex exceeds along it.
#[derive(Clone, Copy)]
struct Support {
    direction: DVec3,
    height: f64,
}

/// The first thin face found deeper below the hull than twice the `tolerance` [m], where no vertex is more than once the
/// tolerance above a thick face (mesh.16).
pub(super) fn sunken(
    topology: &HalfEdgeMesh,
    tree: &Tree,
    thick: &[bool],
    (tolerance, centroid): (f64, DVec3),
) -> Option<Sunken> {
    let search = Search {
        topology,
        tree,
        allowed: DEPTH * tolerance,
        centroid,
    };
    let mut open: Vec<bool> = super::faces_of(topology)
        .map(|f| !thick[f.index()] && !is_beside_thick(topology, thick, f))
        .collect();
    let mut known: Vec<Support> = Vec::new();
    let mut stack = Vec::new();
    for seed in super::faces_of(topology) {
        stack.push(seed);
        // Neighbours one after the other, so that one plane serves many.
        while let Some(face) = stack.pop() {
            if !std::mem::take(&mut open[face.index()]) {
                continue;
            }
            let corners = topology.face_corners(face);
            let mut recent = known.iter().rev().take(RECENT);
            if !recent.any(|support| search.deepest(support, corners).1 <= search.allowed) {
                match search.near(face, known.last()) {
                    Ok(support) => known.push(support),
                    Err(found) => return Some(found),
                }
            }
            let sides = topology.face_half_edges(face);
            let beyond = sides.map(|side| topology.face(topology.twin(side)));
            stack.extend(beyond.into_iter().flatten().filter(|f| open[f.index()]));
        }
    }
    None
}

/// Whether the longest edge of a thin face is one of a thick face: every point of the thin face is closer to it than its
/// altitude.
fn is_beside_thick(topology: &HalfEdgeMesh, thick: &[bool], face: FaceId) -> bool {
    let sides = topology.face_half_edges(face).map(|side| {
        let twin = topology.twin(side);
        let ends = [side, twin].map(|h| topology.position(topology.origin(h)));
        (ends[0].distance_squared(ends[1]), topology.face(twin))
    });
    let longest = sides.iter().max_by(|p, q| p.0.total_cmp(&q.0));
    longest.is_some_and(|(_, beyond)| beyond.is_some_and(|f| thick[f.index()]))
}

struct Search<'a> {
    topology: &'a HalfEdgeMesh,
    tree: &'a Tree,
    /// [m]
    allowed: f64,
    centroid: DVec3,
}

impl Search<'_> {
    /// The corner deepest below a supporting plane, and how deep [m].
    fn deepest(&self, support: &Support, corners: [DVec3; 3]) -> (usize, f64) {
        let mut worst = (0, f64::NEG_INFINITY);
        for (corner, p) in corners.into_iter().enumerate() {
            let depth = support.height - support.direction.dot(p - self.centroid);
            if depth > worst.1 {
                worst = (corner, depth);
            }
        }
        worst
    }

    /// A supporting plane that a face lies close below, searched also from the one found `last`, or how far the face is from all that were tried.
    fn near(&self, face: FaceId, last: Option<&Support>) -> Result<Support, Sunken> {
        let corners = self.topology.face_corners(face);
        let vertices = self.topology.face_vertices(face);
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let mut best = Sunken {
            face,
            vertex: vertices[0],
            depth: f64::INFINITY,
            allowed: self.allowed,
        };
        let starts = [
            self.topology.face_normal(face),
            last.map_or(DVec3::ZERO, |support| support.direction),
            middle - self.centroid,
        ];
        for start in starts {
            let (mut direction, mut before) = (start, DVec3::ZERO);
            for _ in 0..STEPS {
                direction = direction.normalize_or_zero();
                if direction == DVec3::ZERO {
                    break;
                }
                let slack = SLACK * self.allowed;
                let (top, height) = self.tree.farthest(direction, slack);
                let support = Support {
                    direction,
                    height: height + slack - direction.dot(self.centroid),
                };
                let (corner, depth) = self.deepest(&support, corners);
                if depth <= self.allowed {
                    return Ok(support);
                }
                if depth < best.depth {
                    (best.vertex, best.depth) = (vertices[corner], depth);
                }
                let rise = self.topology.positions()[top as usize] - corners[corner];
                direction = turned(direction, rise, before);
                before = rise;
            }
        }
        Err(best)
    }
}

/// A direction turned until `rise` is level along it, from the deepest corner to the farthest vertex. If the rise of the step
/// before would be up again both become level: on a long face the two ends would take turns for ever.
fn turned(direction: DVec3, rise: DVec3, before: DVec3) -> DVec3 {
    let along = direction.dot(rise) / rise.length_squared();
    if !along.is_finite() {
        return DVec3::ZERO;
    }
    let level = direction - along * rise;
    let both = before.cross(rise);
    if level.dot(before) <= 0.0 || both.length() <= PARALLEL * before.length() * rise.length() {
        level
    } else {
        both * both.dot(direction).signum()
    }
}

#[cfg(test)]
mod tests;
