//! The nearest pair of features of two polytopes that are apart.

use glam::DVec3;

use super::{Placed, Scene, highest, lowest};
use crate::collision::core::{Edge, distance_to_segment, height_over};
use crate::collision::exact::cross;

pub(super) struct Nearest {
    pub(super) distance: f64,
    /// From A to B, of any length.
    pub(super) direction: DVec3,
}

impl Nearest {
    fn offer(&mut self, distance: f64, direction: DVec3) {
        if distance < self.distance {
            *self = Self {
                distance,
                direction,
            };
        }
    }
}

/// Which vertices are near the other core.
struct Near<A, B> {
    a: A,
    b: B,
}

impl Scene<'_> {
    /// Nearest pair of vertex and face, edge and edge, or vertex and edge, sought between the supporting planes across
    /// `normal` widened by the distance known so far: nothing nearer lies outside.
    pub(super) fn nearest_features(&self, normal: DVec3) -> Nearest {
        let mut nearest = Nearest {
            distance: f64::INFINITY,
            direction: DVec3::ZERO,
        };
        self.try_vertices_on_edges(&mut nearest);
        let top = highest(&self.vertices_a, normal);
        let bottom = lowest(&self.vertices_b, normal);
        let reach = nearest.distance * (1.0 + 1e-9) + 1e-12 * self.span();
        let heights = |vertices: &[DVec3]| -> Vec<f64> {
            vertices.iter().map(|vertex| vertex.dot(normal)).collect()
        };
        let [heights_a, heights_b] = [heights(&self.vertices_a), heights(&self.vertices_b)];
        let near_a = |index: u32| heights_a[index as usize] >= bottom - reach;
        let near_b = |index: u32| heights_b[index as usize] <= top + reach;
        let near = Near {
            a: near_a,
            b: near_b,
        };
        self.try_vertices_on_faces(&near, &mut nearest);
        let near_edges = |edge: &&Edge| edge.ends.iter().any(|&end| (near.b)(end));
        let edges_b: Vec<Placed> = self
            .b
            .edges
            .iter()
            .filter(near_edges)
            .map(|edge| Placed::new(edge, &self.vertices_b))
            .collect();
        for edge in self
            .a
            .edges
            .iter()
            .filter(|e| e.ends.iter().any(|&end| (near.a)(end)))
        {
            let on_a = Placed::new(edge, &self.vertices_a);
            for on_b in &edges_b {
                on_a.try_crossing(on_b, &mut nearest);
            }
        }
        nearest
    }

    fn try_vertices_on_faces(
        &self,
        near: &Near<impl Fn(u32) -> bool, impl Fn(u32) -> bool>,
        nearest: &mut Nearest,
    ) {
        let faces_a = self
            .a
            .triangles
            .iter()
            .filter(|f| f.corners.iter().any(|&c| (near.a)(c)));
        for face in faces_a {
            let corners = face.corners.map(|c| self.vertices_a[c as usize]);
            for &vertex in &self.vertices_b {
                if let Some(height) = height_over(vertex, &corners, face.normal) {
                    nearest.offer(height.abs(), face.normal * height.signum());
                }
            }
        }
        let faces_b = self
            .b
            .triangles
            .iter()
            .filter(|f| f.corners.iter().any(|&c| (near.b)(c)));
        for face in faces_b {
            let corners = face.corners.map(|c| self.vertices_b[c as usize]);
            let normal = self.rotation * face.normal;
            for &vertex in &self.vertices_a {
                if let Some(height) = height_over(vertex, &corners, normal) {
                    nearest.offer(height.abs(), normal * -height.signum());
                }
            }
        }
    }

    fn try_vertices_on_edges(&self, nearest: &mut Nearest) {
        let foot = |point: DVec3, p: DVec3, q: DVec3| {
            let edge = q - p;
            let length_squared = edge.length_squared();
            if length_squared == 0.0 {
                return point - p;
            }
            let along = (point - p).dot(edge) / length_squared;
            if along <= 0.0 {
                return point - p;
            }
            if along >= 1.0 {
                return point - q;
            }
            let rejection = (point - p) - edge * along;
            rejection - edge * (rejection.dot(edge) / length_squared)
        };
        for edge in &self.a.edges {
            let [p, q] = edge.ends.map(|end| self.vertices_a[end as usize]);
            for &vertex in &self.vertices_b {
                let direction = foot(vertex, p, q);
                if direction.length() < nearest.distance {
                    nearest.offer(distance_to_segment(vertex, p, q), direction);
                }
            }
        }
        for edge in &self.b.edges {
            let [p, q] = edge.ends.map(|end| self.vertices_b[end as usize]);
            for &vertex in &self.vertices_a {
                let direction = foot(vertex, p, q);
                if direction.length() < nearest.distance {
                    nearest.offer(distance_to_segment(vertex, p, q), -direction);
                }
            }
        }
    }
}

impl Placed {
    /// Offers the distance across the common perpendicular, if its feet lie in both edges.
    fn try_crossing(&self, other: &Self, nearest: &mut Nearest) {
        let normal = cross(&self.along, &other.along);
        let length_squared = normal.length_squared();
        if length_squared == 0.0 {
            return;
        }
        let between = other.start - self.start;
        let height = between.dot(normal) / length_squared.sqrt();
        if height.abs() >= nearest.distance {
            return;
        }
        let on_self = between.cross(other.along.rounded()).dot(normal) / length_squared;
        let on_other = between.cross(self.along.rounded()).dot(normal) / length_squared;
        if (0.0..=1.0).contains(&on_self) && (0.0..=1.0).contains(&on_other) {
            nearest.offer(height.abs(), normal * height.signum());
        }
    }
}
