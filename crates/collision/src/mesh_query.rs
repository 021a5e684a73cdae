//! A convex shape against a triangle mesh: contacts as local minima of the separation, contacts of every triangle, the
//! deepest or nearest triangle, and casts.
//!
//! Triangle and shape are two convex sets; their signed separation is the one of [`closest_points`](crate::closest_points).
//! What makes repeated queries fast is [`MeshCache`]; what makes them equal to fresh ones is that everything cached is a
//! certified lower bound (see [`front`]).

use glam::DVec3;
use pliant_mesh::TriangleMesh;
use pliant_spatial::Pose;

use crate::bvh::TriangleBvh;
use crate::{ClosestPoints, SupportMap};

mod cast;
mod faces;
mod front;
mod minima;
mod placed;
mod segment;

pub use cast::MeshCastHit;

use front::{Front, Scene, Visitor};
use minima::{Minima, touched};
use placed::{LocalBox, Placed, Starts};

/// Separations closer than this times the shape's size are equal: far above rounding, far below any length that matters.
const LEVEL: f64 = 1e-11;

/// A step longer than this times the mesh's half size, and than the shape, is a jump to another place.
const FAR: f64 = 1e-2;

/// What a shape touches of a triangle: its corners that lie furthest along the normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MeshFeature {
    /// One corner: index of the vertex, the lowest where several share the position.
    Vertex(u32),
    /// An edge: indices of its vertices in ascending order, lowest as above.
    Edge([u32; 2]),
    /// All three corners.
    Face,
}

/// A triangle within reach of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshContact {
    /// Number of the triangle.
    pub triangle: u32,
    /// What is touched of it.
    pub feature: MeshFeature,
    /// Closest or deepest points, the triangle as A and the shape as B, in the mesh's frame.
    pub closest: ClosestPoints,
}

/// What queries of one shape against one mesh remember from one placement to the next.
///
/// Answers do not depend on it, only their cost. Buffers grow to what the queries need and are then reused: a query like an
/// earlier one allocates nothing. Keep one per shape and mesh. A cache used with another state of the tree starts afresh,
/// and with a shape that differs in its extents along the axes and diagonals of its frame; a shape that was *deformed* must
/// be announced by [`MeshCache::deformed`] or [`MeshCache::clear`], as a dent between those cannot be noticed.
#[derive(Debug, Default)]
pub struct MeshCache {
    front: Front,
    minima: Minima,
    starts: Starts,
    /// Triangles within the margin, in ascending order.
    hits: Vec<MeshContact>,
    selected: Vec<MeshContact>,
    last: Option<Last>,
    /// The last answer of [`TriangleBvh::deepest`].
    deepest: Option<u32>,
    /// Announced since the last query [m].
    deformation: f64,
}

/// State of the scene at the last query.
#[derive(Clone, Copy, Debug)]
struct Last {
    revision: u64,
    pose: Pose,
    bounds: LocalBox,
    shape: Likeness,
}

/// What tells a shape from another one in the same box.
#[derive(Clone, Copy, Debug)]
struct Likeness {
    faces: u32,
    radius: f64,
    /// Heights along the diagonals of the frame [m].
    heights: [f64; 8],
}

impl Likeness {
    fn of<S: SupportMap + ?Sized>(shape: &S) -> Self {
        let along = |corner: usize| {
            let sign = |bit: usize| if corner & bit == 0 { 1.0 } else { -1.0 };
            let direction = DVec3::new(sign(1), sign(2), sign(4));
            shape.support(direction, u32::MAX).point.dot(direction)
        };
        Self {
            faces: shape.core_face_count(),
            radius: shape.radius(),
            heights: std::array::from_fn(along),
        }
    }

    /// Whether it may be the same shape, deformed by at most `deformation` [m].
    fn is_like(&self, other: &Self, deformation: f64) -> bool {
        let heights = self.heights.iter().zip(&other.heights);
        self.faces == other.faces
            && (self.radius - other.radius).abs() <= deformation
            // The diagonals are √3 long.
            && heights.fold(0.0, |most: f64, (own, other)| most.max((own - other).abs()))
                <= 2.0 * deformation
    }
}

impl MeshCache {
    /// Forgets everything but the size of the buffers.
    pub fn clear(&mut self) {
        self.front.clear();
        self.last = None;
        self.deepest = None;
        self.deformation = 0.0;
    }

    /// Announces that points of the shape have moved by up to `distance` [m] within its frame since the last query.
    pub fn deformed(&mut self, distance: f64) {
        self.deformation += distance.abs();
    }

    /// Brings the front to the present placement, or throws it away.
    fn follow<S: SupportMap + ?Sized>(&mut self, bvh: &TriangleBvh, placed: &Placed<'_, S>) {
        let bounds = placed.local;
        let shape = Likeness::of(placed.shape);
        let motion = self.last.and_then(|last| {
            let change = (bounds.min - last.bounds.min)
                .abs()
                .max((bounds.max - last.bounds.max).abs())
                .max_element();
            let deformation = self.deformation + placed.slack;
            let known = last.revision == bvh.revision
                && change <= deformation
                && last.shape.is_like(&shape, deformation);
            let motion = placed.motion_since(&last.pose) + self.deformation;
            // Beyond the sizes of both nothing the front knows is of use.
            let far = bounds.reach().max(FAR / bvh.tree.frame.per_metre);
            // Rounding of the sums of motions stays below the slack.
            let exact = self.front.travelled() + motion <= placed.slack * 4e15;
            (known && exact && motion <= far).then_some(motion)
        });
        if let Some(motion) = motion {
            self.front.advance(motion);
        } else {
            self.front.clear();
            self.deepest = None;
        }
        self.deformation = 0.0;
        self.last = Some(Last {
            revision: bvh.revision,
            pose: *placed.mesh_from_shape,
            bounds,
            shape,
        });
    }
}

/// Collects every triangle within a margin.
struct Collect<'h> {
    margin: f64,
    hits: &'h mut Vec<MeshContact>,
}

/// Keeps the least separated triangle.
struct Least {
    limit: f64,
    best: Option<(u32, ClosestPoints)>,
}

impl Visitor for Collect<'_> {
    fn limit(&self) -> f64 {
        self.margin
    }

    fn visit(&mut self, triangle: u32, closest: &ClosestPoints) {
        if closest.separation <= self.margin {
            self.hits.push(MeshContact {
                triangle,
                feature: MeshFeature::Face,
                closest: *closest,
            });
        }
    }
}

impl Visitor for Least {
    fn limit(&self) -> f64 {
        self.limit
    }

    fn visit(&mut self, triangle: u32, closest: &ClosestPoints) {
        if closest.separation <= self.limit {
            self.limit = closest.separation;
            self.best = Some((triangle, *closest));
        }
    }
}

impl TriangleBvh {
    /// The local minima of the separation between `shape` and the mesh that are at most `margin` [m], by ascending triangle.
    ///
    /// *Definition.* Let s(T) be the signed separation of the shape from triangle T, n(T) its normal, and F(T) the corners of
    /// T furthest along n(T): one, two or all three. T is a local minimum if no triangle that has all of F(T) among
    /// its corners has a smaller separation. Two local minima belong to one plateau if they touch a common vertex
    /// (in F of both) at the same separation and normal, and so on from one to the next; of a plateau the triangle with the
    /// lowest number is reported. Separations within 1e-11 of the shape's size count as equal. So a vertex or edge that is
    /// touched appears once, the least separated triangle is always among the answers (or its plateau is), and a triangle
    /// touched in its inside always counts. Vertices at exactly the same position are one.
    ///
    /// The shape is at `mesh_from_shape`; answers are in the mesh's frame. A NaN margin or placement finds nothing.
    /// Allocates only while the buffers of `cache` grow.
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn contacts<'c, S: SupportMap + ?Sized>(
        &self,
        mesh: &TriangleMesh,
        shape: &S,
        mesh_from_shape: &Pose,
        margin: f64,
        cache: &'c mut MeshCache,
    ) -> &'c [MeshContact] {
        self.every_contact(mesh, shape, mesh_from_shape, margin, cache);
        let size = cache.last.map_or(0.0, |last| last.bounds.reach());
        let MeshCache {
            minima,
            hits,
            selected,
            ..
        } = cache;
        minima.select((self, mesh), hits, LEVEL * size, selected);
        &cache.selected
    }

    /// Every triangle whose separation from `shape` is at most `margin` [m], by ascending number; otherwise as
    /// [`TriangleBvh::contacts`].
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn every_contact<'c, S: SupportMap + ?Sized>(
        &self,
        mesh: &TriangleMesh,
        shape: &S,
        mesh_from_shape: &Pose,
        margin: f64,
        cache: &'c mut MeshCache,
    ) -> &'c [MeshContact] {
        cache.hits.clear();
        if margin.is_nan() || !mesh_from_shape.is_finite() {
            cache.clear();
            return &cache.hits;
        }
        let placed = Placed::new(shape, mesh_from_shape, &self.tree.frame, &mut cache.starts);
        cache.follow(self, &placed);
        let scene = Scene {
            bvh: self,
            mesh,
            placed: &placed,
        };
        let hits = &mut cache.hits;
        cache.front.refine(&scene, &mut Collect { margin, hits });
        cache.hits.sort_unstable_by_key(|hit| hit.triangle);
        for hit in &mut cache.hits {
            hit.feature = touched(self, mesh, hit.triangle, hit.closest.normal);
        }
        &cache.hits
    }

    /// The triangle with the least separation from `shape`, if that is at most `max_separation` [m]: the nearest one apart,
    /// the deepest in contact; one of them where several are equal. Starts from the last answer. Otherwise as
    /// [`TriangleBvh::contacts`].
    ///
    /// # Panics
    /// When `mesh` has fewer triangles than the one the tree was built on.
    pub fn deepest<S: SupportMap + ?Sized>(
        &self,
        mesh: &TriangleMesh,
        shape: &S,
        mesh_from_shape: &Pose,
        max_separation: f64,
        cache: &mut MeshCache,
    ) -> Option<MeshContact> {
        if max_separation.is_nan() || !mesh_from_shape.is_finite() {
            cache.clear();
            return None;
        }
        let placed = Placed::new(shape, mesh_from_shape, &self.tree.frame, &mut cache.starts);
        cache.follow(self, &placed);
        let mut least = Least {
            limit: max_separation,
            best: None,
        };
        let scene = Scene {
            bvh: self,
            mesh,
            placed: &placed,
        };
        if let Some(triangle) = cache.deepest {
            let corners = mesh.corners(triangle);
            let closest = placed.closest_points(&corners, &mut crate::SimplexCache::default());
            least.visit(triangle, &closest);
        }
        cache.front.refine(&scene, &mut least);
        let (triangle, closest) = least.best?;
        cache.deepest = Some(triangle);
        Some(MeshContact {
            triangle,
            feature: touched(self, mesh, triangle, closest.normal),
            closest,
        })
    }
}
