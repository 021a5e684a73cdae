//! The judge that shares no code with the solver: overlap and distance by `parry3d-f64`, an independent collision library.

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use pliant_mesh::ConvexMesh;
use pliant_sim::World;
use pliant_spatial::Pose;

/// The shapes of a world as `parry3d-f64` sees them.
pub struct ParryJudge {
    objects: Vec<(ParryPose, ConvexPolyhedron)>,
    segments: Vec<ConvexPolyhedron>,
    whole: ConvexPolyhedron,
}

fn parry_vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn parry_pose(pose: &Pose) -> ParryPose {
    let q = pose.rotation;
    ParryPose::from_parts(
        parry_vector(pose.translation),
        Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

fn parry_mesh(mesh: &ConvexMesh) -> ConvexPolyhedron {
    let points: Vec<Vector> = mesh.positions().iter().copied().map(parry_vector).collect();
    ConvexPolyhedron::from_convex_hull(&points).expect("a convex mesh has a hull")
}

impl ParryJudge {
    /// Copies the world's shapes; `whole_tool` is all its segments as one convex body.
    ///
    /// # Panics
    /// When `parry3d-f64` refuses the hull of a convex mesh.
    pub fn new(world: &World, whole_tool: &ConvexMesh) -> Self {
        Self {
            objects: world
                .obstacles()
                .iter()
                .map(|o| (parry_pose(&o.world_from_object), parry_mesh(&o.shape)))
                .collect(),
            segments: world.tool().segments.iter().map(parry_mesh).collect(),
            whole: parry_mesh(whole_tool),
        }
    }

    /// Object and segment overlap when the tool is displaced by `shift` [m].
    ///
    /// # Panics
    /// When `parry3d-f64` does not support the pair, which it does for convex polyhedra.
    pub fn overlaps(&self, object: usize, segment: usize, visual: &Pose, shift: DVec3) -> bool {
        let moved = Pose::new(visual.rotation, visual.translation + shift);
        let (pose, shape) = &self.objects[object];
        query::intersection_test(pose, shape, &parry_pose(&moved), &self.segments[segment])
            .expect("convex polyhedra are supported")
            .intersecting
    }

    /// Distance of the whole tool from the nearest object [m], 0 in overlap, infinite without objects.
    ///
    /// # Panics
    /// When `parry3d-f64` does not support the pair, which it does for convex polyhedra.
    pub fn nearest(&self, visual: &Pose) -> f64 {
        let tool = parry_pose(visual);
        self.objects
            .iter()
            .map(|(pose, shape)| {
                query::distance(pose, shape, &tool, &self.whole)
                    .expect("convex polyhedra are supported")
                    .distance
            })
            .fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::ParryJudge;
    use glam::{DQuat, DVec3};
    use pliant_mesh::{ConvexMesh, generate};
    use pliant_sim::{Method, Object, Tool, VirtualCoupling, World, WorldDescription};
    use pliant_spatial::Pose;

    /// Half extents of the object, all different: a rotation the wrong way round is seen.
    const HALF: DVec3 = DVec3::new(0.05, 0.2, 0.01);
    /// Half edge of the tool, a cube about its handle.
    const CUBE: f64 = 0.02;

    /// Of the tool about x [rad].
    const TURN: f64 = 0.5;

    fn cuboid(half: DVec3) -> ConvexMesh {
        ConvexMesh::from_triangles(&generate::cuboid(half).expect("positive size")).expect("convex")
    }

    fn placed() -> Pose {
        let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
        Pose::new(
            DQuat::from_axis_angle(axis, 0.8),
            DVec3::new(0.3, -0.2, 0.5),
        )
    }

    fn judge() -> ParryJudge {
        let tool = cuboid(DVec3::splat(CUBE));
        let world = World::new(WorldDescription {
            tool: Tool {
                segments: vec![tool.clone()],
            },
            objects: vec![Object {
                name: "turned".to_owned(),
                shape: cuboid(HALF),
                world_from_object: placed(),
                shading_threshold: None,
            }],
            coupling: VirtualCoupling::default(),
            method: Method::Constrained,
        })
        .expect("valid");
        ParryJudge::new(&world, &tool)
    }

    /// The tool in the object's axes, turned about x, at `offset` from the contact of the +x faces, towards the end of the long side.
    fn tool_at(offset: DVec3) -> Pose {
        let touching = DVec3::new(HALF.x + CUBE, 0.19, 0.0);
        placed() * Pose::new(DQuat::from_rotation_x(TURN), touching + offset)
    }

    #[test]
    fn overlap_is_seen_from_a_micrometre_on() {
        let judge = judge();
        for (gap, overlaps) in [(-0.02, true), (-1e-6, true), (1e-6, false), (0.02, false)] {
            let seen = judge.overlaps(0, 0, &tool_at(DVec3::X * gap), DVec3::ZERO);
            assert_eq!(seen, overlaps, "{gap} m apart");
            let outwards = placed().transform_vector(DVec3::X * gap);
            let shifted = judge.overlaps(0, 0, &tool_at(DVec3::ZERO), outwards);
            assert_eq!(shifted, overlaps, "shifted by {gap} m");
        }
    }

    #[test]
    fn distances_are_those_of_the_construction() {
        let judge = judge();
        for gap in [1e-7, 1e-6, 0.01] {
            let nearest = judge.nearest(&tool_at(DVec3::X * gap));
            assert!((nearest - gap).abs() < 1e-12, "{nearest} m, {gap} m apart");
        }
        assert!(judge.nearest(&tool_at(DVec3::X * -1e-3)) < 1e-12);
        // Past the end of the long side, the tool's edge leads, over the middle of its end face: its reach along y is CUBE (sin + cos).
        let reach = CUBE * (TURN.sin() + TURN.cos());
        let offset = DVec3::new(0.03, 0.01 + reach + 0.04, 0.0);
        let nearest = judge.nearest(&tool_at(offset));
        assert!((nearest - 0.05).abs() < 1e-12, "{nearest} m, 0.05 m apart");
    }
}
