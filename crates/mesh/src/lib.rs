//! Validated triangle, half-edge and convex meshes with loaders and generators.
//!
//! [`TriangleMesh`] promises finite positions and valid indices, [`HalfEdgeMesh`] a consistently wound
//! manifold with normals, [`ConvexMesh`] a closed convex solid. Each is built from the one before and names
//! the element that stands in the way. Nothing here reads files, knows units or scenes: loaders take bytes,
//! and lengths are metres once the caller has scaled them.

mod aabb;
mod convex;
mod digits;
mod edge_table;
pub mod generate;
mod half_edge;
mod hull;
mod id;
pub mod load;
mod report;
mod triangle_mesh;

pub use aabb::Aabb;
pub use convex::{CONVEXITY_TOLERANCE, ConvexMesh, ConvexityError};
pub use half_edge::{HalfEdgeMesh, TopologyError};
pub use hull::{HullError, SKIN, convex_hull};
pub use id::{EdgeId, FaceId, Feature, HalfEdgeId, VertexId};
pub use report::{MeshReport, Soundness, Winding, inspect};
pub use triangle_mesh::{DEGENERATE_ALTITUDE, MeshError, TriangleMesh, WeldReport};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
