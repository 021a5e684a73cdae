//! Pairing of half-edges, linking of borders, and the refusal of what is not a manifold.

use thiserror::Error;

use super::{HalfEdgeMesh, Links, Normals};
use crate::edge_table::EdgeTable;
use crate::{HalfEdgeId, TriangleMesh, VertexId};

/// Why triangles do not form a manifold. Vertex and triangle numbers count from 0.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum TopologyError {
    /// A triangle uses a vertex twice.
    #[error(
        "triangle {triangle} uses vertex {vertex} twice: weld the mesh, which drops such triangles"
    )]
    RepeatedCorner {
        /// The triangle.
        triangle: u32,
        /// The repeated vertex.
        vertex: u32,
    },
    /// More than two triangles meet at an edge.
    #[error(
        "{triangles} triangles meet at the edge between vertices {} and {}, the first is triangle {first}: \
         an edge of a solid has two; remove inner walls or duplicate triangles",
        .vertices[0], .vertices[1]
    )]
    CrowdedEdge {
        /// Ends of the edge.
        vertices: [u32; 2],
        /// How many triangles share it.
        triangles: usize,
        /// One of them.
        first: u32,
    },
    /// Two neighbours run through their edge in the same direction.
    #[error(
        "triangles {} and {} are wound in opposite senses: both run from vertex {} to {}; \
         make the winding consistent",
        .triangles[0], .triangles[1], .vertices[0], .vertices[1]
    )]
    InconsistentWinding {
        /// Ends of the shared edge in the common direction.
        vertices: [u32; 2],
        /// The two triangles.
        triangles: [u32; 2],
    },
    /// Several fans of triangles touch in one vertex only.
    #[error(
        "vertex {vertex} joins parts that share no edge: split the vertex so that each part has its own"
    )]
    PinchedVertex {
        /// The vertex.
        vertex: u32,
    },
    /// A vertex without triangle.
    #[error("vertex {vertex} belongs to no triangle: weld the mesh, which drops such vertices")]
    UnusedVertex {
        /// The vertex.
        vertex: u32,
    },
    /// A triangle without area whose neighbours have none either.
    #[error(
        "triangle {triangle} has no area and no neighbour with one, so it has no normal: remove it or weld \
         the mesh with a tolerance"
    )]
    NoNormal {
        /// The triangle.
        triangle: u32,
    },
}

impl HalfEdgeMesh {
    /// Builds connectivity and normals; the numbering of vertices and faces is that of `mesh`.
    ///
    /// # Errors
    /// When the triangles are not a consistently wound manifold (borders are allowed), when a vertex is not
    /// used, or when a normal cannot be found; each error names the element.
    pub fn new(mesh: &TriangleMesh) -> Result<Self, TopologyError> {
        let links = link(mesh)?;
        let normals = Normals::new(mesh.positions(), &links)?;
        Ok(Self {
            positions: mesh.positions().to_vec(),
            links,
            normals,
            bounds: mesh.bounds(),
        })
    }

    /// The triangles alone.
    pub fn to_triangle_mesh(&self) -> TriangleMesh {
        let triangles = self.links.origin[..3 * self.face_count()]
            .as_chunks::<3>()
            .0
            .to_vec();
        TriangleMesh::trusted(self.positions.clone(), triangles)
    }
}

fn link(mesh: &TriangleMesh) -> Result<Links, TopologyError> {
    for (triangle, &[a, b, c]) in (0..).zip(mesh.triangles()) {
        if a == b || b == c || c == a {
            let vertex = if b == c { b } else { a };
            return Err(TopologyError::RepeatedCorner { triangle, vertex });
        }
    }
    let faces = to_u32(mesh.triangles().len());
    let mut links = Links {
        faces,
        origin: mesh.triangles().as_flattened().to_vec(),
        twin: vec![u32::MAX; 3 * faces as usize],
        edge: vec![0; 3 * faces as usize],
        border_next: Vec::new(),
        half_of_edge: Vec::new(),
        half_of_vertex: vec![u32::MAX; mesh.positions().len()],
        loops: Vec::new(),
    };
    links.pair(mesh.triangles())?;
    links.add_borders()?;
    links.check_vertices()?;
    Ok(links)
}

impl Links {
    /// Twins and edges of the faces' half-edges. Edges are numbered by their first half-edge.
    fn pair(&mut self, triangles: &[[u32; 3]]) -> Result<(), TopologyError> {
        for (low, halves) in EdgeTable::new(triangles, self.half_of_vertex.len()).edges() {
            let (high, first) = halves[0];
            if let [_, (_, second)] = *halves {
                if self.origin[first as usize] == self.origin[second as usize] {
                    return Err(TopologyError::InconsistentWinding {
                        vertices: [self.origin[first as usize], self.head(first)],
                        triangles: [first / 3, second / 3],
                    });
                }
                self.twin[first as usize] = second;
                self.twin[second as usize] = first;
            } else if halves.len() > 2 {
                return Err(TopologyError::CrowdedEdge {
                    vertices: [low, high],
                    triangles: halves.len(),
                    first: first / 3,
                });
            }
        }
        for h in 0..3 * self.faces {
            let twin = self.twin[h as usize];
            if twin < h {
                self.edge[h as usize] = self.edge[twin as usize];
            } else {
                self.edge[h as usize] = to_u32(self.half_of_edge.len());
                self.half_of_edge.push(h);
            }
            let slot = &mut self.half_of_vertex[self.origin[h as usize] as usize];
            *slot = (*slot).min(h);
        }
        Ok(())
    }

    /// A half-edge without face for each open edge, linked into loops.
    fn add_borders(&mut self) -> Result<(), TopologyError> {
        let inner = 3 * self.faces;
        let mut leaving: Vec<u32> = vec![u32::MAX; self.half_of_vertex.len()];
        for h in 0..inner {
            if self.twin[h as usize] != u32::MAX {
                continue;
            }
            let border = to_u32(self.origin.len());
            let vertex = self.head(h);
            if leaving[vertex as usize] != u32::MAX {
                return Err(TopologyError::PinchedVertex { vertex });
            }
            leaving[vertex as usize] = border;
            self.half_of_vertex[vertex as usize] = border;
            self.twin[h as usize] = border;
            self.origin.push(vertex);
            self.twin.push(h);
            self.edge.push(self.edge[h as usize]);
        }
        // A border ends where its twin, a half-edge of a face, begins; the number of borders that enter and
        // leave a vertex is the same, so the one to follow exists.
        self.border_next = self.twin[inner as usize..]
            .iter()
            .map(|&twin| leaving[self.origin[twin as usize] as usize])
            .collect();
        let mut seen = vec![false; self.border_next.len()];
        for start in inner..inner + to_u32(seen.len()) {
            if seen[(start - inner) as usize] {
                continue;
            }
            self.loops.push(HalfEdgeId(start));
            let mut h = start;
            while !seen[(h - inner) as usize] {
                seen[(h - inner) as usize] = true;
                h = self.border_next[(h - inner) as usize];
            }
        }
        Ok(())
    }

    /// The half-edges around each vertex form one ring (mesh.4).
    fn check_vertices(&self) -> Result<(), TopologyError> {
        let mut degree = vec![0_usize; self.half_of_vertex.len()];
        for &v in &self.origin {
            degree[v as usize] += 1;
        }
        for (vertex, &degree) in (0..).zip(&degree) {
            if degree == 0 {
                return Err(TopologyError::UnusedVertex { vertex });
            }
            if self.outgoing(VertexId(vertex)).count() != degree {
                return Err(TopologyError::PinchedVertex { vertex });
            }
        }
        Ok(())
    }

    /// The vertex at which a face's half-edge ends.
    fn head(&self, half: u32) -> u32 {
        self.origin[self.next(HalfEdgeId(half)).index()]
    }
}

fn to_u32(count: usize) -> u32 {
    u32::try_from(count).expect("a TriangleMesh is small enough for 32-bit half-edges")
}

#[cfg(test)]
mod tests {
    use super::TopologyError;
    use crate::{HalfEdgeMesh, TriangleMesh, VertexId};
    use glam::DVec3;

    fn mesh(vertices: u32, triangles: &[[u32; 3]]) -> Result<HalfEdgeMesh, TopologyError> {
        let positions = (0..vertices)
            .map(|i| {
                let t = f64::from(i);
                DVec3::new(t.sin(), t.cos(), t * t)
            })
            .collect();
        HalfEdgeMesh::new(&TriangleMesh::new(positions, triangles.to_vec()).unwrap())
    }

    #[test]
    fn refuses_non_manifolds_by_name() {
        let cases: [(u32, &[[u32; 3]], TopologyError); 5] = [
            (
                3,
                &[[0, 1, 1]],
                TopologyError::RepeatedCorner {
                    triangle: 0,
                    vertex: 1,
                },
            ),
            (
                5,
                &[[0, 1, 2], [1, 0, 3], [0, 1, 4]],
                TopologyError::CrowdedEdge {
                    vertices: [0, 1],
                    triangles: 3,
                    first: 0,
                },
            ),
            (
                4,
                &[[0, 1, 2], [0, 1, 3]],
                TopologyError::InconsistentWinding {
                    vertices: [0, 1],
                    triangles: [0, 1],
                },
            ),
            (
                5,
                &[[0, 1, 2], [0, 3, 4]],
                TopologyError::PinchedVertex { vertex: 0 },
            ),
            (4, &[[0, 1, 2]], TopologyError::UnusedVertex { vertex: 3 }),
        ];
        for (vertices, triangles, expected) in cases {
            assert_eq!(mesh(vertices, triangles).unwrap_err(), expected);
        }
    }

    #[test]
    fn two_closed_shells_that_share_a_vertex_are_pinched() {
        let t = |a: u32, b, c, d| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        let triangles = [t(0, 1, 2, 3), t(0, 4, 5, 6)].concat();
        assert_eq!(
            mesh(7, &triangles).unwrap_err(),
            TopologyError::PinchedVertex { vertex: 0 }
        );
    }

    #[test]
    fn a_strip_has_one_border_loop_around_it() {
        let mesh = mesh(4, &[[0, 1, 2], [2, 1, 3]]).unwrap();
        assert!(!mesh.is_closed());
        assert_eq!(
            (
                mesh.edge_count(),
                mesh.half_edge_count(),
                mesh.euler_number()
            ),
            (5, 10, 1)
        );
        let [start] = mesh.boundary_loops() else {
            panic!("one loop")
        };
        let mut ring = vec![mesh.origin(*start)];
        let mut h = mesh.next(*start);
        while h != *start {
            assert_eq!(mesh.face(h), None);
            ring.push(mesh.origin(h));
            h = mesh.next(h);
        }
        ring.sort();
        assert_eq!(ring, [0, 1, 2, 3].map(VertexId));
        assert_eq!(mesh.outgoing(VertexId(1)).count(), 3);
        assert_eq!(mesh.outgoing(VertexId(0)).count(), 2);
    }
}
