//! Indices of mesh elements as distinct types, and the element a contact touches.

macro_rules! element_id {
    ($(#[$doc:meta] $name:ident),+ $(,)?) => {$(
        #[$doc]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u32);

        impl $name {
            /// Position in the arrays of the mesh.
            pub const fn index(self) -> usize {
                self.0 as usize
            }
        }
    )+};
}

element_id! {
    /// A vertex of a [`HalfEdgeMesh`](crate::HalfEdgeMesh).
    VertexId,
    /// A directed half of an edge of a [`HalfEdgeMesh`](crate::HalfEdgeMesh).
    HalfEdgeId,
    /// An undirected edge of a [`HalfEdgeMesh`](crate::HalfEdgeMesh).
    EdgeId,
    /// A triangle of a [`HalfEdgeMesh`](crate::HalfEdgeMesh).
    FaceId,
}

/// What is touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A corner.
    Vertex(VertexId),
    /// An edge between two corners.
    Edge(EdgeId),
    /// The inside of a triangle.
    Face(FaceId),
}
