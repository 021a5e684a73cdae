//! Signed distance of two polytopes by enumeration.
//!
//! g(n), the gap between the supporting planes across a unit direction n, never exceeds the signed distance, and reaches it
//! for some n. In overlap that n is the normal of a face of the Minkowski difference: of a face of either body or of an
//! edge of one and an edge of the other that support it at once (Gottschalk 1996). Apart, the distance is that of the nearest
//! vertex-face or edge-edge pair, and g across it proves it.

use glam::{DMat3, DVec3};
use pliant_spatial::Pose;

use super::core::{Core, Edge};
use super::exact::{Difference, cross};

mod nearest;

/// Slack of the test whether an edge supports a direction, relative to the core's size: superfluous directions cost time only.
const SUPPORT_SLACK: f64 = 1e-9;

/// What the oracle knows of a pair of cores.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    /// Signed distance of the cores [m].
    pub separation: f64,
    /// The best direction found, from A to B, in A's frame.
    pub normal: DVec3,
    /// Distance of the nearest points found minus the gap of the planes [m]: how far the truth may be off. 0 in overlap, where
    /// completeness of the enumeration stands for it.
    pub doubt: f64,
}

/// Two cores at a placement, in A's axes about a point of A.
pub struct Scene<'c> {
    a: &'c Core,
    b: &'c Core,
    origin_in_a: DVec3,
    origin_in_b: DVec3,
    rotation: DMat3,
    /// Of B's origin point.
    offset: DVec3,
    vertices_a: Vec<DVec3>,
    vertices_b: Vec<DVec3>,
    slack: [f64; 2],
}

impl<'c> Scene<'c> {
    /// Places B.
    pub fn new(a: &'c Core, b: &'c Core, a_from_b: &Pose) -> Self {
        let rotation = DMat3::from_quat(a_from_b.rotation);
        let (origin_in_a, origin_in_b) = (a.vertices[0], b.vertices[0]);
        let offset = rotation * origin_in_b + (a_from_b.translation - origin_in_a);
        let on_b = |&vertex: &DVec3| rotation * (vertex - origin_in_b) + offset;
        Self {
            a,
            b,
            origin_in_a,
            origin_in_b,
            rotation,
            offset,
            vertices_a: a.vertices.iter().map(|&v| v - origin_in_a).collect(),
            vertices_b: b.vertices.iter().map(on_b).collect(),
            slack: [a, b].map(|core| SUPPORT_SLACK * core.extent()),
        }
    }

    /// Gap between the supporting planes across a unit direction in A's frame, from A to B [m].
    pub fn gap(&self, normal: DVec3) -> f64 {
        lowest(&self.vertices_b, normal) - highest(&self.vertices_a, normal)
    }

    /// Largest coordinate of the difference [m]: what rounding is relative to.
    pub fn span(&self) -> f64 {
        self.offset.length() + self.a.extent() + self.b.extent()
    }

    /// Distance of a point in A's frame from the core of A, and of a point in B's frame from that of B [m].
    pub fn distances(&self, point_in_a: DVec3, point_in_b: DVec3) -> [f64; 2] {
        [
            self.a.distance_to(point_in_a),
            self.b.distance_to(point_in_b),
        ]
    }

    /// A point in A's frame as one in B's.
    pub fn in_b(&self, point_in_a: DVec3) -> DVec3 {
        let relative = (point_in_a - self.origin_in_a) - self.offset;
        self.rotation.transpose() * relative + self.origin_in_b
    }

    /// The signed distance of the cores.
    pub fn truth(&self) -> Truth {
        let mut best = Best {
            gap: f64::NEG_INFINITY,
            normal: DVec3::X,
        };
        self.try_faces(&mut best);
        self.try_edges(&mut best);
        // Well inside: no pair of features is near the truth. On the edge of it, flat cores may lie beside each other.
        if !best.gap.is_finite() {
            let across = self.any_direction_across();
            best.offer(self.gap(across), across);
        } else if best.gap < -1e-10 * self.span() {
            return Truth {
                separation: best.gap,
                normal: best.normal,
                doubt: 0.0,
            };
        }
        let nearest = self.nearest_features(best.normal);
        if let Some(direction) = nearest.direction.try_normalize() {
            best.offer(self.gap(direction), direction);
        }
        let apart = best.gap > 0.0 && best.gap > nearest.distance - 1e-9 * self.span();
        Truth {
            separation: if apart { nearest.distance } else { best.gap },
            normal: best.normal,
            doubt: if apart {
                nearest.distance - best.gap
            } else {
                0.0
            },
        }
    }

    /// For points and sticks in one line that share a point: level along any direction across the line.
    fn any_direction_across(&self) -> DVec3 {
        let placed = |vertices: &[DVec3], edge: &Edge| Placed::new(edge, vertices).along.rounded();
        let a = self
            .a
            .edges
            .iter()
            .map(|edge| placed(&self.vertices_a, edge));
        let b = self
            .b
            .edges
            .iter()
            .map(|edge| placed(&self.vertices_b, edge));
        a.chain(b)
            .find_map(DVec3::try_normalize)
            .map_or(DVec3::X, |along| along.any_orthonormal_vector())
    }

    fn try_faces(&self, best: &mut Best) {
        for face in &self.a.triangles {
            let normal = face.normal;
            best.offer(lowest(&self.vertices_b, normal) - face.heights[1], normal);
            if face.two_sided {
                best.offer(lowest(&self.vertices_b, -normal) + face.heights[0], -normal);
            }
        }
        for face in &self.b.triangles {
            let normal = self.rotation * -face.normal;
            let level = normal.dot(self.offset);
            // No direction is worth a look that B's plane over A's first vertex, the origin, already rules out.
            if level - face.heights[1] > best.gap {
                let top = highest(&self.vertices_a, normal);
                best.offer(level - face.heights[1] - top, normal);
            }
            if face.two_sided && face.heights[0] - level > best.gap {
                let top = highest(&self.vertices_a, -normal);
                best.offer(face.heights[0] - level - top, -normal);
            }
        }
    }

    fn try_edges(&self, best: &mut Best) {
        let edges_b: Vec<Placed> = self
            .b
            .edges
            .iter()
            .map(|edge| Placed::new(edge, &self.vertices_b))
            .collect();
        for edge_a in &self.a.edges {
            let on_a = Placed::new(edge_a, &self.vertices_a);
            for on_b in &edges_b {
                let normal = cross(&on_a.along, &on_b.along);
                // At least the length of the normal: a little more slack than asked for, and no root.
                let most = on_a.length * on_b.length;
                let slack = self.slack.map(|slack| slack * most);
                for normal in [normal, -normal] {
                    if !on_a.supports(normal, slack[0]) || !on_b.supports(-normal, slack[1]) {
                        continue;
                    }
                    // The gap across a direction is at most the height of these two edges over each other.
                    let length = normal.length();
                    let height = normal.dot(on_b.start - on_a.start);
                    if length > 0.0 && height > best.gap * length {
                        let normal = normal / length;
                        best.offer(self.gap(normal), normal);
                    }
                }
            }
        }
    }
}

struct Best {
    gap: f64,
    normal: DVec3,
}

impl Best {
    fn offer(&mut self, gap: f64, normal: DVec3) {
        if gap > self.gap {
            *self = Self { gap, normal };
        }
    }
}

/// An edge in A's frame.
struct Placed {
    start: DVec3,
    along: Difference,
    length: f64,
    sides: [DVec3; 2],
}

impl Placed {
    fn new(edge: &Edge, vertices: &[DVec3]) -> Self {
        let [start, end] = edge.ends.map(|end| vertices[end as usize]);
        let along = Difference::new(start, end);
        Self {
            start,
            along,
            length: along.length_squared().sqrt(),
            sides: edge.sides.map(|side| vertices[side as usize]),
        }
    }

    /// Whether neither face beside the edge rises along the direction, which is perpendicular to the edge.
    fn supports(&self, direction: DVec3, slack: f64) -> bool {
        let rises = |side: DVec3| direction.dot(side - self.start) > slack;
        !rises(self.sides[0]) && !rises(self.sides[1])
    }
}

fn highest(vertices: &[DVec3], direction: DVec3) -> f64 {
    vertices.iter().fold(f64::NEG_INFINITY, |best, vertex| {
        best.max(vertex.dot(direction))
    })
}

fn lowest(vertices: &[DVec3], direction: DVec3) -> f64 {
    -highest(vertices, -direction)
}
