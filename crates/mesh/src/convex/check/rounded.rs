//! A mesh brought to the same extent in three directions: in a needle or a plate as it stands, volume, centroid and solid
//! angles are small differences of large products, lost in rounding from 10⁻⁷ as thick as long on.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

use crate::TriangleMesh;

/// The positions of a mesh under the affine map `p ↦ map · (p − center)`, which keeps its orientation.
pub(super) struct Rounded<'a> {
    mesh: &'a TriangleMesh,
    center: DVec3,
    map: DMat3,
    positions: Vec<DVec3>,
}

impl<'a> Rounded<'a> {
    pub(super) fn new(mesh: &'a TriangleMesh) -> Self {
        let center = mesh.bounds().center();
        let map = rounding(mesh.positions(), center);
        let positions = mesh.positions().iter().map(|&p| map * (p - center));
        Self {
            mesh,
            center,
            map,
            positions: positions.collect(),
        }
    }

    /// Volume of the mesh itself, positive when it is wound outward [m³], and its centroid [m].
    pub(super) fn volume_and_centroid(&self) -> (f64, DVec3) {
        let (mut six_fold, mut moment) = (0.0, DVec3::ZERO);
        for [a, b, c] in self.corners() {
            let part = a.dot(b.cross(c));
            six_fold += part;
            moment += part * (a + b + c);
        }
        let inverse = self.map.inverse();
        let centroid = self.center + inverse * (moment / (4.0 * six_fold));
        (six_fold / 6.0 * inverse.determinant(), centroid)
    }

    /// How many times the surface winds around a point inside the bounds: the solid angles of all triangles over 4π
    /// (mesh.11) (A. van Oosterom and J. Strackee, "The solid angle of a plane triangle", IEEE TBME 30(2), 1983, eq. 8).
    /// A linear map leaves the number as it is.
    pub(super) fn turns(&self, around: DVec3) -> f64 {
        let eye = self.map * (around - self.center);
        let angles = self.corners().map(|corners| {
            let [a, b, c] = corners.map(|p| p - eye);
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * a.dot(b.cross(c)).atan2(below)
        });
        angles.sum::<f64>() / (4.0 * PI)
    }

    fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let triangles = self.mesh.triangles().iter();
        triangles.map(|t| t.map(|v| self.positions[v as usize]))
    }
}

/// The linear map that brings a needle or a plate around `center` to the same extent in three directions.
fn rounding(positions: &[DVec3], center: DVec3) -> DMat3 {
    let farthest = |measure: &dyn Fn(DVec3) -> DVec3| {
        let longer = |best: DVec3, &p: &DVec3| {
            let one = measure(p - center);
            if one.length_squared() > best.length_squared() {
                one
            } else {
                best
            }
        };
        positions.iter().fold(DVec3::ZERO, longer)
    };
    let long = farthest(&|p| p);
    let along = long.normalize_or(DVec3::X);
    let wide = farthest(&|p| p - p.dot(along) * along);
    let wide = wide - wide.dot(along) * along;
    let across = wide.normalize_or(along.any_orthonormal_vector());
    let third = along.cross(across);
    let thick = positions
        .iter()
        .map(|p| third.dot(p - center).abs())
        .fold(f64::MIN_POSITIVE, f64::max);
    let extents = DVec3::new(long.length(), wide.length(), thick).max(DVec3::splat(1e-150));
    DMat3::from_diagonal(extents.recip()) * DMat3::from_cols(along, across, third).transpose()
}
