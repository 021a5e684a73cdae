//! GJK, EPA, ray and shape casts and a triangle BVH in f64.
//!
//! Convex shapes are [`SupportMap`]s: [`Point`], [`Segment`], [`Triangle`], [`Cuboid`], [`Cylinder`], [`Cone`],
//! [`PointSet`], [`pliant_mesh::ConvexMesh`], and any of them [`Rounded`]. A query takes two shapes, the placement of B in A's frame and
//! a [`SimplexCache`] that belongs to the pair; it answers in A's frame and allocates nothing.
//!
//! All tolerances are relative to the sizes of the shapes, so micrometres and kilometres behave alike.

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod boxes;
mod bvh;
mod cast;
mod climb;
mod epa;
mod gjk;
mod mesh_query;
mod rims;
mod round;
mod segments;
mod shapes;
mod simplex;
mod support;

pub use bvh::{ObjectBvh, SurfacePoint, TriangleBvh};
pub use cast::{CastHit, RayHit, cast_ray, cast_shape};
pub use gjk::{ClosestPoints, SimplexCache, closest_points, distance, overlap};
pub use mesh_query::{MeshCache, MeshCastHit, MeshContact, MeshFeature};
pub use rims::Rim;
pub use round::{Cone, Cylinder};
pub use shapes::{Cuboid, Point, PointSet, Rounded, Segment, Triangle};
pub use support::{SupportMap, SupportPoint};
