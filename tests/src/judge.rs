//! Judges that share no code with the solver they judge.

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::ConvexPolyhedron;
use pliant_collision::{SimplexCache, closest_points};
use pliant_contact::{Obstacle, SKIN};
use pliant_mesh::ConvexMesh;
use pliant_sim::World;
use pliant_spatial::Pose;

/// Overlap tests by `parry3d-f64`, an independent collision library.
pub struct ParryJudge {
    objects: Vec<(ParryPose, ConvexPolyhedron)>,
    segments: Vec<ConvexPolyhedron>,
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
    /// Copies the world's shapes.
    ///
    /// # Panics
    /// When `parry3d-f64` refuses the hull of a convex mesh.
    pub fn new(world: &World) -> Self {
        Self {
            objects: world
                .obstacles()
                .iter()
                .map(|o| (parry_pose(&o.world_from_object), parry_mesh(&o.shape)))
                .collect(),
            segments: world.tool().segments.iter().map(parry_mesh).collect(),
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
}

/// A plane from a fresh query: unit normal out of the object, gap of the whole tool [m].
#[derive(Clone, Copy, Debug)]
pub struct FreshPlane {
    /// World, object to tool.
    pub normal: DVec3,
    /// Distance of tool and object [m].
    pub separation: f64,
}

/// Closest-point queries from scratch between `whole_tool` (all segments as one convex body) and every object.
pub fn fresh_planes(
    obstacles: &[Obstacle],
    whole_tool: &ConvexMesh,
    visual: &Pose,
) -> Vec<FreshPlane> {
    obstacles
        .iter()
        .map(|obstacle| {
            let object_from_visual = obstacle.world_from_object.inverse() * *visual;
            let mut cache = SimplexCache::default();
            let closest =
                closest_points(&obstacle.shape, whole_tool, &object_from_visual, &mut cache);
            FreshPlane {
                normal: obstacle.world_from_object.transform_vector(closest.normal),
                separation: closest.separation,
            }
        })
        .collect()
}

/// How far the visual tool could still move towards the haptic tool [m]: distance of `push` = visual − haptic from the cone of the
/// normals of touching planes. By enumeration of all sets of up to three normals.
pub fn cone_residual(planes: &[FreshPlane], push: DVec3) -> f64 {
    let normals: Vec<DVec3> = planes
        .iter()
        .filter(|plane| plane.separation <= 2.0 * SKIN)
        .map(|plane| plane.normal)
        .collect();
    let mut best = push.length();
    for (i, &a) in normals.iter().enumerate() {
        best = best.min((push - a * a.dot(push).max(0.0)).length());
        for (j, &b) in normals.iter().enumerate().skip(i + 1) {
            let axis = a.cross(b);
            if axis.length_squared() > 1e-14 {
                best = best.min(residual_of_two(a, b, axis.normalize(), push));
            }
            for &c in &normals[j + 1..] {
                let matrix = glam::DMat3::from_cols(a, b, c);
                if matrix.determinant().abs() > 1e-9
                    && (matrix.inverse() * push).min_element() >= 0.0
                {
                    best = 0.0;
                }
            }
        }
    }
    best
}

fn residual_of_two(a: DVec3, b: DVec3, axis: DVec3, push: DVec3) -> f64 {
    let out_of_plane = axis.dot(push);
    let inside = push - axis * out_of_plane;
    let det = a.cross(b).dot(axis);
    let (s, t) = (
        inside.cross(b).dot(axis) / det,
        a.cross(inside).dot(axis) / det,
    );
    if s >= 0.0 && t >= 0.0 {
        out_of_plane.abs()
    } else {
        f64::INFINITY
    }
}

#[cfg(test)]
mod tests {
    use super::{FreshPlane, cone_residual};
    use glam::DVec3;

    fn touching(normal: DVec3) -> FreshPlane {
        FreshPlane {
            normal,
            separation: 1e-7,
        }
    }

    #[test]
    fn the_residual_is_the_distance_from_the_cone() {
        let planes = [touching(DVec3::Z), touching(DVec3::X)];
        let far = FreshPlane {
            normal: DVec3::Z,
            separation: 1e-3,
        };
        for (planes, push, expected) in [
            (&planes[..0], DVec3::Y, 1.0),
            (&planes[..1], DVec3::Z * 2.0, 0.0),
            (&planes[..1], -DVec3::Z, 1.0),
            (&planes[..], DVec3::new(1.0, 0.5, 2.0), 0.5),
            (&[far], DVec3::Z, 1.0),
        ] {
            let residual = cone_residual(planes, push);
            assert!((residual - expected).abs() < 1e-15, "{push}: {residual}");
        }
    }
}
