//! Force shading: the direction of the force follows interpolated normals, the visual tool does not move (contact.10).
//!
//! After Morgenbesser & Srinivasan (1996), with angle-weighted vertex normals interpolated over the touched feature; magnitudes are kept.

use glam::DVec3;
use pliant_mesh::{Feature, HalfEdgeMesh, VertexId};

use crate::Obstacle;

/// Which vertices of an obstacle count as smooth: all their edges are flatter than the threshold.
#[derive(Clone, Debug)]
pub(crate) struct Shading {
    threshold: f64,
    smooth: Vec<bool>,
}

impl Shading {
    /// `None` for an obstacle that asks for no shading.
    pub(crate) fn new(obstacle: &Obstacle) -> Option<Self> {
        let threshold = obstacle.shading_threshold?;
        let mesh = obstacle.shape.topology();
        let smooth = (0..mesh.vertex_count())
            .map(|vertex| {
                let vertex = VertexId(u32::try_from(vertex).expect("vertex ids are u32"));
                mesh.outgoing(vertex)
                    .all(|half_edge| match mesh.edge_faces(mesh.edge(half_edge)) {
                        [Some(a), Some(b)] => {
                            mesh.face_normal(a).angle_between(mesh.face_normal(b)) < threshold
                        }
                        _ => false,
                    })
            })
            .collect();
        Some(Self { threshold, smooth })
    }

    /// Interpolated unit normal at `point` on `feature` (all in the obstacle's frame); `plain` where the surface is not smooth.
    pub(crate) fn normal(
        &self,
        mesh: &HalfEdgeMesh,
        feature: Feature,
        point: DVec3,
        plain: DVec3,
    ) -> DVec3 {
        let at = |vertex: VertexId| {
            if self.smooth[vertex.index()] {
                mesh.vertex_pseudonormal(vertex)
            } else {
                plain
            }
        };
        let blended = match feature {
            Feature::Vertex(vertex) => at(vertex),
            Feature::Edge(edge) => {
                let [a, b] = mesh.edge_vertices(edge);
                let (start, along) = (mesh.position(a), mesh.position(b) - mesh.position(a));
                let t = ((point - start).dot(along) / along.length_squared()).clamp(0.0, 1.0);
                at(a).lerp(at(b), t)
            }
            Feature::Face(face) => {
                let corners = mesh.face_vertices(face);
                let weights = barycentric(corners.map(|v| mesh.position(v)), point);
                corners
                    .iter()
                    .zip(weights)
                    .fold(DVec3::ZERO, |sum, (&v, w)| sum + at(v) * w)
            }
        };
        let normal = blended.normalize_or(plain);
        if normal.angle_between(plain) < self.threshold {
            normal
        } else {
            plain
        }
    }
}

/// Barycentric coordinates of the projection of `point` on a triangle, clamped to it.
fn barycentric([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let square = normal.length_squared();
    let v = ((point - a).cross(c - a).dot(normal) / square).max(0.0);
    let w = ((b - a).cross(point - a).dot(normal) / square).max(0.0);
    let u = (1.0 - v - w).max(0.0);
    let sum = u + v + w;
    [u / sum, v / sum, w / sum]
}
