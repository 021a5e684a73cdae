//! Half-edge connectivity of a manifold triangle mesh, with every normal precomputed.
//!
//! Face `f` owns half-edges 3f, 3f+1, 3f+2 in order, so `next` and `face` are arithmetic; borders add
//! half-edges without a face, linked into loops. Vertex pseudonormals are the sum of the incident face
//! normals weighted by the corner angle, edge pseudonormals the sum of the two face normals, both scaled to
//! unit length: with these the sign of `(p − closest) · normal` tells inside from outside for every closest
//! feature (J. A. Bærentzen and H. Aanæs, "Signed distance computation using the angle weighted
//! pseudonormal", IEEE TVCG 11(3), 2005, theorem 1).

mod build;
mod normals;

use glam::DVec3;

use crate::{Aabb, EdgeId, FaceId, HalfEdgeId, VertexId};
pub use build::TopologyError;
use normals::Normals;

/// A manifold, consistently wound triangle mesh, with or without borders. Every vertex belongs to a triangle.
///
/// Positions in metres; all normals have unit length and point to the side from which the triangles are
/// counter-clockwise.
#[derive(Clone, Debug)]
pub struct HalfEdgeMesh {
    positions: Vec<DVec3>,
    links: Links,
    normals: Normals,
    bounds: Aabb,
}

/// Connectivity; half-edges from `3 * faces` on are borders.
#[derive(Clone, Debug)]
pub(crate) struct Links {
    /// Number of faces.
    faces: u32,
    /// Per half-edge: the vertex it leaves.
    origin: Vec<u32>,
    /// Per half-edge: the other half of the edge.
    twin: Vec<u32>,
    /// Per half-edge: its edge.
    edge: Vec<u32>,
    /// Per border half-edge: the following one of its loop.
    border_next: Vec<u32>,
    /// Per edge: one half; never a border.
    half_of_edge: Vec<u32>,
    /// Per vertex: one outgoing half-edge; the border one where there is one.
    half_of_vertex: Vec<u32>,
    /// One half-edge of each border loop.
    loops: Vec<HalfEdgeId>,
}

impl HalfEdgeMesh {
    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.positions.len()
    }

    /// Number of undirected edges.
    pub fn edge_count(&self) -> usize {
        self.links.half_of_edge.len()
    }

    /// Number of triangles.
    pub fn face_count(&self) -> usize {
        self.links.faces as usize
    }

    /// Number of half-edges, two per edge, borders included.
    pub fn half_edge_count(&self) -> usize {
        self.links.origin.len()
    }

    /// V − E + F: two per closed shell without handles (mesh.6).
    pub fn euler_number(&self) -> i64 {
        let [v, e, f] =
            [self.vertex_count(), self.edge_count(), self.face_count()].map(usize::cast_signed);
        (v - e + f) as i64
    }

    /// No edge lacks a triangle on either side.
    pub fn is_closed(&self) -> bool {
        self.links.loops.is_empty()
    }

    /// One half-edge (without face) of each open border; follow [`HalfEdgeMesh::next`] around it.
    pub fn boundary_loops(&self) -> &[HalfEdgeId] {
        &self.links.loops
    }

    /// The half-edge that follows around the face, or around the border loop.
    pub fn next(&self, half_edge: HalfEdgeId) -> HalfEdgeId {
        self.links.next(half_edge)
    }

    /// The other half of the same edge, pointing the other way.
    pub fn twin(&self, half_edge: HalfEdgeId) -> HalfEdgeId {
        HalfEdgeId(self.links.twin[half_edge.index()])
    }

    /// The vertex a half-edge leaves.
    pub fn origin(&self, half_edge: HalfEdgeId) -> VertexId {
        VertexId(self.links.origin[half_edge.index()])
    }

    /// The face on the left of a half-edge; none on a border.
    pub fn face(&self, half_edge: HalfEdgeId) -> Option<FaceId> {
        self.links.face(half_edge)
    }

    /// The edge a half-edge belongs to.
    pub fn edge(&self, half_edge: HalfEdgeId) -> EdgeId {
        EdgeId(self.links.edge[half_edge.index()])
    }

    /// The first half-edge of a face: it leaves the first of [`HalfEdgeMesh::face_vertices`].
    pub fn half_edge_of_face(&self, face: FaceId) -> HalfEdgeId {
        HalfEdgeId(3 * face.0)
    }

    /// A half of an edge that has a face.
    pub fn half_edge_of_edge(&self, edge: EdgeId) -> HalfEdgeId {
        HalfEdgeId(self.links.half_of_edge[edge.index()])
    }

    /// A half-edge that leaves a vertex; the border one where the vertex lies on a border.
    pub fn half_edge_of_vertex(&self, vertex: VertexId) -> HalfEdgeId {
        HalfEdgeId(self.links.half_of_vertex[vertex.index()])
    }

    /// Position of a vertex [m].
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// All vertex positions [m].
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Smallest box around the mesh [m].
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// The three corners of a face, counter-clockwise seen from outside.
    pub fn face_vertices(&self, face: FaceId) -> [VertexId; 3] {
        self.face_half_edges(face).map(|h| self.origin(h))
    }

    /// Corner positions of a face [m].
    pub fn face_corners(&self, face: FaceId) -> [DVec3; 3] {
        self.face_vertices(face).map(|v| self.position(v))
    }

    /// The three half-edges of a face in order.
    pub fn face_half_edges(&self, face: FaceId) -> [HalfEdgeId; 3] {
        [0, 1, 2].map(|k| HalfEdgeId(3 * face.0 + k))
    }

    /// The two ends of an edge, in the direction of [`HalfEdgeMesh::half_edge_of_edge`].
    pub fn edge_vertices(&self, edge: EdgeId) -> [VertexId; 2] {
        let half = self.half_edge_of_edge(edge);
        [self.origin(half), self.origin(self.twin(half))]
    }

    /// The faces left and right of [`HalfEdgeMesh::half_edge_of_edge`].
    pub fn edge_faces(&self, edge: EdgeId) -> [Option<FaceId>; 2] {
        let half = self.half_edge_of_edge(edge);
        [self.face(half), self.face(self.twin(half))]
    }

    /// Half-edges that leave a vertex, each once, clockwise seen from outside. Allocates nothing.
    pub fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        self.links.outgoing(vertex)
    }

    /// Unit normal of a face. A triangle without area has the mean normal of its neighbours.
    pub fn face_normal(&self, face: FaceId) -> DVec3 {
        self.normals.face[face.index()]
    }

    /// Unit pseudonormal of an edge: mean of its faces' normals.
    pub fn edge_normal(&self, edge: EdgeId) -> DVec3 {
        self.normals.edge[edge.index()]
    }

    /// Unit pseudonormal of a vertex: mean of its faces' normals weighted by the corner angle.
    pub fn vertex_pseudonormal(&self, vertex: VertexId) -> DVec3 {
        self.normals.vertex[vertex.index()]
    }
}

impl Links {
    fn next(&self, half_edge: HalfEdgeId) -> HalfEdgeId {
        let h = half_edge.0;
        HalfEdgeId(if h >= 3 * self.faces {
            self.border_next[(h - 3 * self.faces) as usize]
        } else if h % 3 == 2 {
            h - 2
        } else {
            h + 1
        })
    }

    fn face(&self, half_edge: HalfEdgeId) -> Option<FaceId> {
        let face = half_edge.0 / 3;
        (face < self.faces).then_some(FaceId(face))
    }

    fn outgoing(&self, vertex: VertexId) -> impl Iterator<Item = HalfEdgeId> {
        let first = HalfEdgeId(self.half_of_vertex[vertex.index()]);
        let mut current = Some(first);
        std::iter::from_fn(move || {
            let half = current?;
            let following = self.next(HalfEdgeId(self.twin[half.index()]));
            current = (following != first).then_some(following);
            Some(half)
        })
    }
}
