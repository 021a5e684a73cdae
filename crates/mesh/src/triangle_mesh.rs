//! Indexed triangles with checked indices and finite positions: what loaders and generators produce.
//!
//! Nothing is assumed about topology here; [`crate::HalfEdgeMesh`] and [`crate::ConvexMesh`] demand more.
//! Volume is the sum of signed tetrahedra to one point (divergence theorem), taken about the middle of the
//! bounds so that a mesh far from the origin loses no digits.

mod coincident;
mod weld;

use glam::DVec3;
use pliant_spatial::Pose;
use thiserror::Error;

use crate::Aabb;
use crate::digits::point;
pub use weld::WeldReport;
pub(crate) use weld::{compacted, without_unused};

/// Altitude of a triangle over its longest edge, relative to the diagonal of the bounds, up to which the
/// triangle counts as degenerate. Coordinates carry 1e-16 of their size, so below 1e-12 the plane of a
/// triangle is known to no better than 1e-4 rad and its normal is of no use.
pub const DEGENERATE_ALTITUDE: f64 = 1e-12;

/// Half-edge indices (three per triangle, up to three more on borders) must fit in `u32`.
const MAX_ELEMENTS: usize = (u32::MAX / 6) as usize;

/// Coordinates are smaller than this [m]: products of five of them stay finite in `f64`, and areas of boxes in the
/// `f32` of search trees. Nothing that a hand touches comes near it in any unit.
pub(crate) const MAX_COORDINATE: f64 = 1e15;

/// Why points and indices are not a mesh.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MeshError {
    /// No triangle at all.
    #[error("the mesh has no triangles: it needs at least one")]
    Empty,
    /// NaN, infinite or so large that volumes overflow.
    #[error("vertex {vertex} is at {}: coordinates must be finite and below 1e15", point(*.position))]
    BadPosition {
        /// Index of the vertex.
        vertex: usize,
        /// Where it is [m].
        position: DVec3,
    },
    /// A corner that does not exist.
    #[error(
        "triangle {triangle} uses vertex {vertex}, but the mesh has {vertices} vertices (0 to {last}): correct the index",
        last = .vertices.saturating_sub(1)
    )]
    IndexOutOfRange {
        /// Index of the triangle.
        triangle: usize,
        /// The index it uses.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// More elements than indices can count.
    #[error("{count} {what} are too many: at most {MAX_ELEMENTS}; split or simplify the mesh")]
    TooLarge {
        /// "vertices" or "triangles".
        what: &'static str,
        /// How many there are.
        count: usize,
    },
}

/// Triangles over shared vertices. Positions in metres, right-handed, counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    bounds: Aabb,
}

impl TriangleMesh {
    /// Checks positions [m] and indices.
    ///
    /// # Errors
    /// No triangles, a non-finite or huge coordinate, an index out of range, too many elements.
    pub fn new(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        if triangles.is_empty() {
            return Err(MeshError::Empty);
        }
        for (what, count) in [
            ("vertices", positions.len()),
            ("triangles", triangles.len()),
        ] {
            if count > MAX_ELEMENTS {
                return Err(MeshError::TooLarge { what, count });
            }
        }
        let bad = |p: &DVec3| p.is_nan() || p.abs().max_element() >= MAX_COORDINATE;
        if let Some(vertex) = positions.iter().position(bad) {
            let position = positions[vertex];
            return Err(MeshError::BadPosition { vertex, position });
        }
        let vertices = positions.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(MeshError::IndexOutOfRange {
                    triangle,
                    vertex,
                    vertices,
                });
            }
        }
        Ok(Self::trusted(positions, triangles))
    }

    /// For callers in this crate whose construction guarantees what [`TriangleMesh::new`] checks.
    pub(crate) fn trusted(positions: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Self {
        let bounds = triangles
            .iter()
            .flatten()
            .fold(Aabb::EMPTY, |b, &v| b.including(positions[v as usize]));
        Self {
            positions,
            triangles,
            bounds,
        }
    }

    /// Vertex positions [m].
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Three vertex indices per triangle, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Corner positions of one triangle [m].
    ///
    /// # Panics
    /// When the mesh has no such triangle.
    pub fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.triangles[triangle as usize].map(|v| self.positions[v as usize])
    }

    /// Smallest box around the triangles [m]; vertices that no triangle uses do not count.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// Enclosed volume [m³] (mesh.1); negative when the triangles face inwards; without meaning for an open mesh.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.bounds.center();
        let six_fold: f64 = self
            .corner_iter()
            .map(|[a, b, c]| (a - origin).dot((b - origin).cross(c - origin)))
            .sum();
        six_fold / 6.0
    }

    /// Sum of the triangles' areas [m²].
    pub fn surface_area(&self) -> f64 {
        self.corner_iter()
            .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
            .sum()
    }

    /// Number of pieces that share no vertex.
    pub fn shells(&self) -> usize {
        let mut parent: Vec<u32> = (0..).take(self.positions.len()).collect();
        let mut used = vec![false; self.positions.len()];
        for &[a, b, c] in &self.triangles {
            for v in [a, b, c] {
                used[v as usize] = true;
            }
            for v in [b, c] {
                let (x, y) = (root_of(&mut parent, a), root_of(&mut parent, v));
                parent[x.max(y) as usize] = x.min(y);
            }
        }
        (0..)
            .zip(&used)
            .filter(|&(v, &used)| used && root_of(&mut parent, v) == v)
            .count()
    }

    /// Triangles with a repeated corner, or thinner than [`DEGENERATE_ALTITUDE`] of the mesh (mesh.2).
    pub fn degenerate_triangles(&self) -> Vec<u32> {
        let limit = DEGENERATE_ALTITUDE * self.bounds.diagonal();
        (0..)
            .zip(&self.triangles)
            .filter(|&(i, &[a, b, c])| {
                a == b || b == c || c == a || altitude(self.corners(i)) <= limit
            })
            .map(|(i, _)| i)
            .collect()
    }

    /// Every position moved by `a_from_b`.
    #[must_use]
    pub fn transformed(&self, a_from_b: &Pose) -> Self {
        let moved = self.positions.iter().map(|&p| a_from_b.transform_point(p));
        Self::trusted(moved.collect(), self.triangles.clone())
    }

    /// Every position times `factor` (new unit per old unit); a negative factor mirrors, so the winding is
    /// turned to stay outward.
    ///
    /// # Errors
    /// When a coordinate is no longer finite or below 1e15 m.
    pub fn scaled(&self, factor: f64) -> Result<Self, MeshError> {
        let positions = self.positions.iter().map(|&p| p * factor).collect();
        let scaled = Self::new(positions, self.triangles.clone())?;
        Ok(if factor < 0.0 {
            scaled.reversed()
        } else {
            scaled
        })
    }

    /// Every triangle turned inside out.
    #[must_use]
    pub fn reversed(&self) -> Self {
        let turned = self.triangles.iter().map(|&[a, b, c]| [a, c, b]);
        Self {
            positions: self.positions.clone(),
            triangles: turned.collect(),
            bounds: self.bounds,
        }
    }

    fn corner_iter(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.triangles
            .iter()
            .map(|t| t.map(|v| self.positions[v as usize]))
    }
}

/// Height of a triangle over its longest edge [m].
pub(crate) fn altitude([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    if longest > 0.0 {
        (b - a).cross(c - a).length() / longest
    } else {
        0.0
    }
}

/// Root of a union-find tree whose roots are the smallest index of their set; halves the path on the way.
pub(crate) fn root_of(parent: &mut [u32], mut element: u32) -> u32 {
    while parent[element as usize] != element {
        let grand = parent[parent[element as usize] as usize];
        parent[element as usize] = grand;
        element = grand;
    }
    element
}

#[cfg(test)]
mod tests {
    use super::{MeshError, TriangleMesh};
    use glam::{DQuat, DVec3};
    use pliant_spatial::Pose;

    fn tetrahedron() -> TriangleMesh {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        TriangleMesh::new(positions, triangles).unwrap()
    }

    #[test]
    fn refuses_what_is_no_mesh() {
        assert_eq!(TriangleMesh::new(vec![], vec![]), Err(MeshError::Empty));
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e16] {
            let positions = vec![DVec3::ZERO, DVec3::new(0.0, bad, 0.0), DVec3::X];
            let error = TriangleMesh::new(positions, vec![[0, 1, 2]]).unwrap_err();
            assert!(
                matches!(error, MeshError::BadPosition { vertex: 1, .. }),
                "{error}"
            );
        }
        let error =
            TriangleMesh::new(vec![DVec3::ZERO; 3], vec![[0, 1, 2], [0, 3, 1]]).unwrap_err();
        let expected = MeshError::IndexOutOfRange {
            triangle: 1,
            vertex: 3,
            vertices: 3,
        };
        assert_eq!(error, expected);
    }

    #[test]
    fn measures_of_a_tetrahedron() {
        let mesh = tetrahedron();
        assert!((mesh.signed_volume() - 1.0 / 6.0).abs() < 1e-16);
        assert!((mesh.surface_area() - (1.5 + 0.75_f64.sqrt())).abs() < 1e-15);
        assert!((mesh.reversed().signed_volume() + 1.0 / 6.0).abs() < 1e-16);
        assert!((mesh.scaled(-2.0).unwrap().signed_volume() - 8.0 / 6.0).abs() < 1e-15);
        let far = Pose::new(DQuat::from_rotation_x(0.7), DVec3::splat(1e6));
        assert!((mesh.transformed(&far).signed_volume() - 1.0 / 6.0).abs() < 1e-9);
        assert_eq!(mesh.shells(), 1);
        assert!(mesh.scaled(1e80).is_err());
    }

    #[test]
    fn counts_shells_and_degenerate_triangles() {
        let mut positions = tetrahedron().positions().to_vec();
        positions.extend([
            DVec3::ONE,
            DVec3::ONE + DVec3::X,
            DVec3::ONE * 2.0,
            DVec3::splat(-9.0),
        ]);
        let mut triangles = tetrahedron().triangles().to_vec();
        triangles.extend([[4, 5, 6], [4, 4, 5]]);
        let mesh = TriangleMesh::new(positions, triangles).unwrap();
        assert_eq!(mesh.shells(), 2);
        assert_eq!(mesh.degenerate_triangles(), vec![5]);
        assert_eq!(mesh.bounds().min, DVec3::ZERO, "vertex 7 is not used");
    }
}
