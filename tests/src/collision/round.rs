//! Cylinders and cones as the judge sees them: closed forms of height and distance, and a coarse polytope to place them by.

use glam::{DVec2, DVec3};
use pliant_collision::{Cone, Cylinder};

use super::core::{Core, distance_to_segment};

/// Corners of a rim in [`Turned::points`]; a multiple of four, so that the box around them is that of the body.
const CORNERS: u32 = 12;

/// A cylinder or cone about the z axis, its middle at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turned {
    /// Half its length [m].
    pub half_length: f64,
    /// At −z and at +z [m].
    pub radii: [f64; 2],
}

impl From<Cylinder> for Turned {
    fn from(cylinder: Cylinder) -> Self {
        Self {
            half_length: cylinder.half_length,
            radii: [cylinder.radius; 2],
        }
    }
}

impl From<Cone> for Turned {
    fn from(cone: Cone) -> Self {
        Self {
            half_length: cone.half_length,
            radii: [cone.base_radius, cone.top_radius],
        }
    }
}

impl Turned {
    /// Of the supporting plane along a direction, times its length [m].
    pub fn height(&self, direction: DVec3) -> f64 {
        let radial = direction.truncate().length();
        let [base, top] = self.radii;
        let rise = self.half_length * direction.z;
        (top * radial + rise).max(base * radial - rise)
    }

    /// How far a point [m] is from the solid: 0 inside.
    pub fn distance_to(&self, point: DVec3) -> f64 {
        let [base, top] = self.radii;
        let radial = point.truncate().length();
        let share = (point.z / self.half_length).clamp(-1.0, 1.0);
        let own_radius = base + (top - base) * 0.5 * (1.0 + share);
        if point.z.abs() <= self.half_length && radial <= own_radius {
            return 0.0;
        }
        // In the half plane of the point: the outline of the body there, from the axis around to the axis.
        let h = self.half_length;
        let outline =
            [(0.0, -h), (base, -h), (top, h), (0.0, h)].map(|(x, z)| DVec3::new(x, 0.0, z));
        let point = DVec3::new(radial, 0.0, point.z);
        let pieces = outline.windows(2);
        let distances = pieces.map(|ends| distance_to_segment(point, ends[0], ends[1]));
        distances.fold(f64::INFINITY, f64::min)
    }

    /// Corners on both rims, one for an apex.
    pub fn points(&self) -> Vec<DVec3> {
        let mut points = Vec::new();
        for (radius, z) in self.radii.into_iter().zip([-1.0, 1.0]) {
            for corner in 0..CORNERS {
                let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
                let flat = DVec2::from_angle(angle) * radius;
                let point = flat.extend(z * self.half_length);
                if !points.contains(&point) {
                    points.push(point);
                }
            }
        }
        points
    }

    /// Directions in which such a body is often nearest: along the axis and across its side.
    pub fn directions(&self) -> Vec<DVec3> {
        let [base, top] = self.radii;
        let side = DVec2::new(2.0 * self.half_length, base - top).normalize_or_zero();
        let around = (0..CORNERS).map(|corner| {
            let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
            (DVec2::from_angle(angle) * side.x).extend(side.y)
        });
        around.chain([DVec3::Z, DVec3::NEG_Z]).collect()
    }
}

/// Height of a polytope over `origin` along a direction [m].
pub fn height_of(core: &Core, origin: DVec3, direction: DVec3) -> f64 {
    let heights = core.vertices.iter().map(|&v| (v - origin).dot(direction));
    heights.fold(f64::NEG_INFINITY, f64::max)
}
