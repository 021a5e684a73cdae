//! Judges of a solved tick.
//!
//! [`gap_along`] and [`height_above`] read nothing but vertices. [`fresh_planes`] asks the project's own closest-point query, which the solver also
//! asks, but from scratch and with the uncut tool; [`cone_residual`] judges its planes by enumeration. The judge that shares no code with
//! the solver is [`ParryJudge`](crate::parry::ParryJudge).

use glam::DVec3;
use pliant_collision::{SimplexCache, closest_points};
use pliant_contact::{Obstacle, SKIN};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

/// Largest n·p over the vertices of an object in the world [m].
fn top(obstacle: &Obstacle, normal: DVec3) -> f64 {
    obstacle
        .shape
        .positions()
        .iter()
        .map(|p| normal.dot(obstacle.world_from_object.transform_point(*p)))
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Gap between an object and a segment of the tool at `visual` along the unit world normal `normal`, object to tool [m]: over all vertices of
/// both, in the world.
pub fn gap_along(obstacle: &Obstacle, segment: &ConvexMesh, visual: &Pose, normal: DVec3) -> f64 {
    let bottom = segment
        .positions()
        .iter()
        .map(|p| normal.dot(visual.transform_point(*p)))
        .fold(f64::INFINITY, f64::min);
    bottom - top(obstacle, normal)
}

/// Height of a world point over an object's supporting plane of unit world normal `normal` [m].
pub fn height_above(obstacle: &Obstacle, normal: DVec3, point: DVec3) -> f64 {
    normal.dot(point) - top(obstacle, normal)
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
    use super::{FreshPlane, cone_residual, gap_along, height_above};
    use glam::{DQuat, DVec3};
    use pliant_contact::Obstacle;
    use pliant_mesh::{ConvexMesh, generate};
    use pliant_spatial::Pose;

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

    #[test]
    fn gaps_and_heights_are_those_of_displaced_cubes() {
        let cube = ConvexMesh::from_triangles(&generate::cuboid(DVec3::splat(0.5)).expect("size"))
            .expect("convex");
        let turn = DQuat::from_rotation_z(0.7);
        let obstacle = Obstacle {
            shape: cube.clone(),
            world_from_object: Pose::new(turn, DVec3::new(3.0, -2.0, 1.0)),
            shading_threshold: None,
        };
        let normal = turn * DVec3::X;
        let centre = obstacle.world_from_object.translation;
        for gap in [1e-7, -0.25] {
            let visual = Pose::new(turn, centre + normal * (1.0 + gap));
            assert!((gap_along(&obstacle, &cube, &visual, normal) - gap).abs() < 1e-15);
        }
        let point = centre + normal * 0.75 + turn * DVec3::Y;
        assert!((height_above(&obstacle, normal, point) - 0.25).abs() < 1e-15);
    }
}
