//! GJK, EPA, ray and shape casts and a triangle BVH in f64.
//!
//! Convex shapes are [`SupportMap`]s: [`Point`], [`Segment`], [`Triangle`], [`Cuboid`], [`Cylinder`], [`Cone`],
//! [`PointSet`], [`pliant_mesh::ConvexMesh`], and any of them [`Rounded`]. A query takes two shapes, the placement of B in A's frame and
//! a [`SimplexCache`] that belongs to the pair; it answers in A's frame and allocates nothing.
//!
//! ```
//! use glam::DVec3;
//! use pliant_collision::{Cuboid, Rounded, SimplexCache, cast_shape, closest_points};
//! use pliant_spatial::Pose;
//!
//! let table = Cuboid { half: DVec3::new(0.5, 0.5, 0.02) };
//! let rod = Rounded::capsule(DVec3::ZERO, DVec3::X * 0.1, 0.002);
//! let mut cache = SimplexCache::default();
//! for tick in 0..10 {
//!     // Sinking by 0.1 mm a tick: it touches at the fifth.
//!     let height = 0.0225 - 1e-4 * f64::from(tick);
//!     let table_from_rod = Pose::from_translation(DVec3::new(0.1, 0.1, height));
//!     let found = closest_points(&table, &rod, &table_from_rod, &mut cache);
//!     assert!((found.separation - (height - 0.022)).abs() < 1e-15);
//!     assert!((found.normal - DVec3::Z).length() < 1e-12);
//! }
//!
//! let above = Pose::from_translation(DVec3::new(0.1, 0.1, 0.122));
//! let down = DVec3::NEG_Z * 0.2;
//! let hit = cast_shape(&table, &rod, &above, down, &mut SimplexCache::default()).unwrap();
//! assert!((hit.fraction - 0.5).abs() < 1e-12);
//! ```
//!
//! - **Which point.** Where a whole edge or face is nearest or deepest, the witness points are one pair of the many that are
//!   `separation · normal` apart: with segments and capsules side by side at an end of what they share, with boxes face to face
//!   in its middle, with other shapes wherever the search met it, which may depend on the cache. A contact that needs the whole
//!   patch takes the supporting planes along `normal` and clips; there are no manifolds here.
//! - **Caches.** A [`SimplexCache`] is a start and never an answer: keep one per ordered pair of shapes, in A and B's order. Every
//!   query of the pair may use it, but [`cast_shape`] leaves it where the motion ended; give casts their own, or a copy, where
//!   the next query is near the start again. It holds no references and is `Copy`; threads take copies.
//! - **Meshes that are nearly convex.** A [`pliant_mesh::ConvexMesh`] is climbed from neighbour to neighbour. One that is convex
//!   only to the tolerance it was accepted with is answered to that tolerance, relative to its size; hulls to rounding.
//! - **Tolerances** are relative to the sizes of the shapes, so micrometres and kilometres behave alike.

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
