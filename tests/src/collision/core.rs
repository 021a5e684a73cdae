//! A polytope as the oracle sees it: vertices, covering triangles, unit normals and edges.

use glam::DVec3;
use pliant_mesh::{ConvexMesh, EdgeId, FaceId};

use super::exact::{Difference, cross};

/// Up to this many vertices all pairs count as edges and all triples as faces.
pub const EXHAUSTIVE_LIMIT: usize = 10;

/// A convex polytope of any dimension from a point to a solid.
#[derive(Clone, Debug)]
pub struct Core {
    /// Every vertex [m]; inner points allowed.
    pub vertices: Vec<DVec3>,
    /// Triangles that cover the surface, more inside at will.
    pub triangles: Vec<Face>,
    /// Straight pieces that hold every edge, more inside at will.
    pub edges: Vec<Edge>,
}

/// A triangle with its unit normal, outward if the triangle is a face of a solid.
#[derive(Clone, Copy, Debug)]
pub struct Face {
    /// Numbers of the vertices.
    pub corners: [u32; 3],
    /// Unit normal.
    pub normal: DVec3,
    /// Lowest and highest vertex of the core along the normal, relative to its first vertex [m].
    pub heights: [f64; 2],
    /// Whether the opposite of the normal may be outward too.
    pub two_sided: bool,
}

/// An edge with what is needed to tell which directions it supports.
#[derive(Clone, Copy, Debug)]
pub struct Edge {
    /// Numbers of the vertices; both the same in a core that is a point.
    pub ends: [u32; 2],
    /// The third vertices of the faces on both sides; ends of the edge itself where there are none.
    pub sides: [u32; 2],
}

impl Core {
    /// A mesh's own vertices, edges and faces.
    pub fn from_mesh(mesh: &ConvexMesh) -> Self {
        let topology = mesh.topology();
        let vertices = topology.positions().to_vec();
        let third = |face: Option<FaceId>, ends: [u32; 2]| {
            let corners = face.map(|face| topology.face_vertices(face));
            let other = corners
                .and_then(|corners| corners.into_iter().find(|corner| !ends.contains(&corner.0)));
            other.map_or(ends[0], |corner| corner.0)
        };
        let edges = (0..)
            .take(topology.edge_count())
            .map(|edge| {
                let ends = topology.edge_vertices(EdgeId(edge)).map(|vertex| vertex.0);
                let sides = topology.edge_faces(EdgeId(edge));
                Edge {
                    ends,
                    sides: sides.map(|face| third(face, ends)),
                }
            })
            .collect();
        let corners = (0..)
            .take(topology.face_count())
            .map(|face| topology.face_vertices(FaceId(face)).map(|vertex| vertex.0));
        let triangles = faces(&vertices, corners, false);
        Self {
            vertices,
            triangles,
            edges,
        }
    }

    /// All pairs as edges and all triples as faces: right for any few points, flat, doubled or inner ones included.
    ///
    /// # Panics
    /// Without points.
    pub fn exhaustive(points: &[DVec3]) -> Self {
        let mut vertices: Vec<DVec3> = Vec::new();
        for &point in points {
            if !vertices.contains(&point) {
                vertices.push(point);
            }
        }
        let count = u32::try_from(vertices.len()).expect("few points");
        assert!(count > 0, "a core has a point");
        let mut edges: Vec<Edge> = pairs(count)
            .map(|ends| Edge { ends, sides: ends })
            .collect();
        if edges.is_empty() {
            edges.push(Edge {
                ends: [0; 2],
                sides: [0; 2],
            });
        }
        let triples = pairs(count).flat_map(|[i, j]| (j + 1..count).map(move |k| [i, j, k]));
        let triangles = faces(&vertices, triples, true);
        Self {
            vertices,
            triangles,
            edges,
        }
    }

    /// Triangles as a file gives them: outward ones of a solid, or both sides of something flat. Every edge counts as one
    /// that supports any direction.
    pub fn from_triangles(vertices: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let origin = vertices[0];
        let volume_and_extent = triangles
            .iter()
            .fold((0.0, 0.0), |sum: (f64, f64), corners| {
                let [p, q, r] = corners.map(|corner| vertices[corner as usize] - origin);
                let furthest = p.length().max(q.length()).max(r.length());
                (sum.0 + p.dot(q.cross(r)) / 6.0, sum.1.max(furthest))
            });
        let flat = volume_and_extent.0.abs() <= 1e-14 * volume_and_extent.1.powi(3);
        let edges = triangles
            .iter()
            .flat_map(|&[p, q, r]| [[p, q], [q, r], [r, p]])
            .map(|ends| Edge { ends, sides: ends })
            .collect();
        Self {
            vertices: vertices.to_vec(),
            triangles: faces(vertices, triangles.iter().copied(), flat),
            edges,
        }
    }

    /// A plane convex polygon given in order around it.
    ///
    /// # Panics
    /// With more than 2³² corners.
    pub fn polygon(outline: &[DVec3]) -> Self {
        let count = u32::try_from(outline.len()).expect("few points");
        let fan = (1..count - 1).map(|i| [0, i, i + 1]);
        let outer = (0..count).map(|i| {
            let opposite = (i + count / 2 + 1) % count;
            Edge {
                ends: [i, (i + 1) % count],
                sides: [opposite; 2],
            }
        });
        // Else a point over the seam of two triangles could be over neither, by rounding.
        let seams = (2..count - 1).map(|i| Edge {
            ends: [0, i],
            sides: [0, i],
        });
        let edges = outer.chain(seams).collect();
        Self {
            vertices: outline.to_vec(),
            triangles: faces(outline, fan, true),
            edges,
        }
    }

    /// The hull of many points in general position; the exhaustive core of few, or of many that span no volume.
    ///
    /// # Panics
    /// Without points.
    pub fn of_points(points: &[DVec3]) -> Self {
        if points.len() <= EXHAUSTIVE_LIMIT {
            return Self::exhaustive(points);
        }
        let Ok(hull) = ConvexMesh::hull(points) else {
            return Self::exhaustive(points);
        };
        let mut core = Self::from_mesh(&hull);
        // Supports look at every point: what the hull left out as a skin still counts.
        for &point in points {
            if !core.vertices.contains(&point) {
                core.vertices.push(point);
            }
        }
        let corners: Vec<[u32; 3]> = core.triangles.iter().map(|face| face.corners).collect();
        core.triangles = faces(&core.vertices, corners.into_iter(), false);
        core
    }

    /// Largest distance between a vertex and the first one, times two at most the diameter [m].
    pub fn extent(&self) -> f64 {
        let origin = self.vertices[0];
        let furthest = |largest: f64, vertex: &DVec3| largest.max(vertex.distance(origin));
        self.vertices.iter().fold(0.0, furthest)
    }

    /// How far a point [m] is from the core's solid: 0 inside.
    pub fn distance_to(&self, point: DVec3) -> f64 {
        let one_sided = self.triangles.iter().filter(|face| !face.two_sided);
        let mut planes = one_sided.map(|face| {
            let corner = self.vertices[face.corners[0] as usize];
            face.normal.dot(point - corner)
        });
        if let Some(first) = planes.next()
            && planes.fold(first, f64::max) <= 0.0
        {
            return 0.0;
        }
        let edges = self.edges.iter().map(|edge| {
            let [p, q] = edge.ends.map(|end| self.vertices[end as usize]);
            distance_to_segment(point, p, q)
        });
        let faces = self.triangles.iter().filter_map(|face| {
            let corners = face.corners.map(|corner| self.vertices[corner as usize]);
            height_over(point, &corners, face.normal).map(f64::abs)
        });
        edges.chain(faces).fold(f64::INFINITY, f64::min)
    }
}

/// Height of a point over a triangle [m], if its foot lies in it.
pub fn height_over(point: DVec3, corners: &[DVec3; 3], normal: DVec3) -> Option<f64> {
    let turn = |i: usize, j: usize| {
        (corners[j] - corners[i])
            .cross(point - corners[i])
            .dot(normal)
    };
    let (p, q, r) = (turn(0, 1), turn(1, 2), turn(2, 0));
    let inside = p >= 0.0 && q >= 0.0 && r >= 0.0;
    inside.then(|| normal.dot(point - corners[0]))
}

/// Distance of a point from a segment, possibly of no length [m].
pub fn distance_to_segment(point: DVec3, p: DVec3, q: DVec3) -> f64 {
    let edge = q - p;
    let along = (point - p).dot(edge);
    let length_squared = edge.length_squared();
    if along <= 0.0 || length_squared == 0.0 {
        return point.distance(p);
    }
    if along >= length_squared {
        return point.distance(q);
    }
    (point - p).cross(edge).length() / length_squared.sqrt()
}

fn pairs(count: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..count).flat_map(move |i| (i + 1..count).map(move |j| [i, j]))
}

/// Triangles with their normals; those without area have none and are left to their edges.
fn faces(
    vertices: &[DVec3],
    corners: impl Iterator<Item = [u32; 3]>,
    two_sided: bool,
) -> Vec<Face> {
    corners
        .filter_map(|corners| {
            let [p, q, r] = corners.map(|corner| vertices[corner as usize]);
            let normal = cross(&Difference::new(p, q), &Difference::new(p, r)).try_normalize()?;
            let heights = vertices.iter().map(|&v| (v - vertices[0]).dot(normal));
            let ends = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height| {
                [height.min(low), height.max(high)]
            });
            Some(Face {
                corners,
                normal,
                heights: ends,
                two_sided,
            })
        })
        .collect()
}
