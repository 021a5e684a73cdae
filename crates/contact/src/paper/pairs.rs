//! Collision queries of the tool's segments against the objects, with what each (object, segment) pair remembers.
//!
//! Most pairs are decided without a closest-point query: by the bounds, or by the plane that separated them last.

use glam::DVec3;
use pliant_collision::{ClosestPoints, SimplexCache, SupportMap, closest_points, overlap};
use pliant_mesh::{ConvexMesh, VertexId};
use pliant_spatial::Pose;

use crate::Obstacle;
use crate::touching::touching_points;

/// Overlap over the radius of the object up to which the plane next to the last one tells the way out. The visual tool sinks in by what the
/// surface rises in a hand's step, a tenth of this; whichever plane is found, leaving along it by its depth ends the overlap.
const SHALLOW: f64 = 1e-3;

/// Objects and tool of a tick.
#[derive(Clone, Copy)]
pub(super) struct Scene<'s> {
    pub(super) obstacles: &'s [Obstacle],
    pub(super) segments: &'s [ConvexMesh],
}

impl Scene<'_> {
    /// All pairs, segment by segment within each object.
    pub(super) fn pairs(self) -> impl Iterator<Item = PairId> + use<> {
        let segments = index(self.segments.len());
        (0..index(self.obstacles.len()))
            .flat_map(move |object| (0..segments).map(move |segment| PairId { object, segment }))
    }
}

/// An (object, segment) pair by indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PairId {
    pub(super) object: u32,
    pub(super) segment: u32,
}

impl PairId {
    /// Both parts exist.
    pub(super) fn is_in(self, scene: Scene<'_>) -> bool {
        (self.object as usize) < scene.obstacles.len()
            && (self.segment as usize) < scene.segments.len()
    }
}

/// Nearest points of a pair in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) pair: PairId,
    /// On the object [m].
    pub(super) on_object: DVec3,
    /// On the tool [m].
    pub(super) on_tool: DVec3,
    /// Unit, out of the object.
    pub(super) normal: DVec3,
    /// Signed gap [m].
    pub(super) separation: f64,
}

/// Warm starts of one pair.
#[derive(Clone, Debug, Default)]
struct Memory {
    cache: SimplexCache,
    /// Normal of the last query, object frame; zero before the first.
    normal: DVec3,
    /// Gap [m] along that normal at the pose asked for last.
    gap: f64,
    object_vertex: u32,
    segment_vertex: u32,
}

/// What all pairs of one tool pose remember.
#[derive(Clone, Debug)]
pub(super) struct Pairs {
    objects: usize,
    segments: usize,
    memory: Vec<Memory>,
}

impl Pairs {
    pub(super) fn new(objects: usize, segments: usize) -> Self {
        Self {
            objects,
            segments,
            memory: vec![Memory::default(); objects * segments],
        }
    }

    /// What of `obstacles` and `segments` has a memory.
    pub(super) fn known<'s>(
        &self,
        obstacles: &'s [Obstacle],
        segments: &'s [ConvexMesh],
    ) -> Scene<'s> {
        Scene {
            obstacles: &obstacles[..self.objects.min(obstacles.len())],
            segments: &segments[..self.segments.min(segments.len())],
        }
    }

    /// Nearest points of a pair if its separation is below `limit` [m]; none where a cheap certificate says it is not.
    pub(super) fn nearest_below(
        &mut self,
        scene: Scene<'_>,
        pair: PairId,
        world_from_handle: &Pose,
        limit: f64,
    ) -> Option<Nearest> {
        let obstacle = &scene.obstacles[pair.object as usize];
        let segment = &scene.segments[pair.segment as usize];
        let memory = &mut self.memory[pair.object as usize * self.segments + pair.segment as usize];
        let object_from_handle = obstacle.world_from_object.inverse() * *world_from_handle;
        if memory.certifies(obstacle, segment, &object_from_handle, limit) {
            return None;
        }
        let closest = memory.query(obstacle, segment, &object_from_handle);
        let nearest = to_world(pair, obstacle, &closest);
        (nearest.separation < limit).then_some(nearest)
    }

    /// Any segment of the tool overlaps (or touches) an object; `first` is asked first.
    pub(super) fn any_overlap(
        &mut self,
        scene: Scene<'_>,
        first: PairId,
        world_from_handle: &Pose,
    ) -> bool {
        let obstacle = &scene.obstacles[first.object as usize];
        let object_from_handle = obstacle.world_from_object.inverse() * *world_from_handle;
        let row = first.object as usize * self.segments;
        let mut overlaps = |segment: u32| {
            let memory = &mut self.memory[row + segment as usize];
            let shape = &scene.segments[segment as usize];
            !memory.certifies(obstacle, shape, &object_from_handle, 0.0)
                && overlap(
                    &obstacle.shape,
                    shape,
                    &object_from_handle,
                    &mut memory.cache,
                )
        };
        let segments = index(scene.segments.len());
        overlaps(first.segment)
            || (0..segments).any(|segment| segment != first.segment && overlaps(segment))
    }

    /// A vertex of the object that the plane of the last query touches.
    pub(super) fn support_vertex(&self, pair: PairId, obstacle: &Obstacle) -> VertexId {
        let memory = &self.memory[pair.object as usize * self.segments + pair.segment as usize];
        let support = obstacle.shape.support(memory.normal, memory.object_vertex);
        VertexId(support.index)
    }
}

impl Memory {
    /// The pair's separation is at least `limit` [m]: by bounds, or by the kept normal and two support calls.
    fn certifies(
        &mut self,
        obstacle: &Obstacle,
        segment: &ConvexMesh,
        object_from_handle: &Pose,
        limit: f64,
    ) -> bool {
        let center = object_from_handle.transform_point(segment.centroid());
        let bounds = obstacle.shape.topology().bounds();
        let reach = segment.radius() + limit.max(0.0);
        if !bounds.inflated(reach).contains(center) {
            return true;
        }
        if self.normal == DVec3::ZERO {
            return false;
        }
        let object = obstacle.shape.support(self.normal, self.object_vertex);
        let towards_object = object_from_handle.inverse_transform_vector(-self.normal);
        let tool = segment.support(towards_object, self.segment_vertex);
        self.object_vertex = object.index;
        self.segment_vertex = tool.index;
        self.gap = (object_from_handle.transform_point(tool.point) - object.point).dot(self.normal);
        self.gap > limit
    }

    /// Nearest points, after [`Memory::certifies`] at the same pose: near the kept planes where the bodies are in shallow contact, else
    /// wherever they are.
    fn query(
        &mut self,
        obstacle: &Obstacle,
        segment: &ConvexMesh,
        object_from_handle: &Pose,
    ) -> ClosestPoints {
        let shape = &obstacle.shape;
        let is_shallow = self.normal != DVec3::ZERO && self.gap > -SHALLOW * shape.radius();
        let kept = (self.normal, self.gap);
        let near = is_shallow
            .then(|| touching_points(shape, segment, object_from_handle, kept, &mut self.cache));
        let closest = near
            .flatten()
            .unwrap_or_else(|| closest_points(shape, segment, object_from_handle, &mut self.cache));
        self.normal = closest.normal;
        closest
    }
}

fn to_world(pair: PairId, obstacle: &Obstacle, closest: &ClosestPoints) -> Nearest {
    let world_from_object = &obstacle.world_from_object;
    Nearest {
        pair,
        on_object: world_from_object.transform_point(closest.witness_a),
        on_tool: world_from_object.transform_point(closest.witness_b),
        normal: world_from_object.transform_vector(closest.normal),
        separation: closest.separation,
    }
}

fn index(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}
