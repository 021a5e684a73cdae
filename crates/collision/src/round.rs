//! Cylinders and cones as support mappings.
//!
//! A core is a polytope with numbered vertices. A rim is therefore a polygon of 2³¹ corners on the circle, each found from
//! its number alone: the four sides of a square around the circle are cut into 2²⁹ equal steps and their ends drawn to the
//! centre. Neighbours are at most 2⁻²⁸ rad apart, so the polygon misses the circle by at most r · 2⁻⁵⁹ = 1.7e-18 r, less than
//! the rounding of r. Nothing but divisions and square roots is used: the same vertices to the bit on every machine.

use glam::DVec3;

use crate::rims::Rim;
use crate::support::{SupportMap, SupportPoint};

/// Corners of a rim on one of the four sides.
const STEPS: u32 = 1 << 29;

/// Bit of an index that tells the rim: set on the top.
const TOP: u32 = 1 << 31;

/// Steps from the middle of a side to its end, where the slope of the direction is one.
const HALF_SIDE: f64 = 268_435_456.0;

/// A cylinder centred on its frame's origin, its axis along z. Radius zero makes a segment, half length zero a disc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Half the distance between the two discs [m], ≥ 0.
    pub half_length: f64,
    /// Of the discs [m], ≥ 0.
    pub radius: f64,
}

/// A cone, truncated or not, its axis along z, the origin halfway between base and top. A top radius of zero makes the
/// apex; any of the three may be zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Half the distance between base and top [m], ≥ 0.
    pub half_length: f64,
    /// Of the disc at z = −`half_length` [m], ≥ 0.
    pub base_radius: f64,
    /// Of the disc at z = `half_length` [m], ≥ 0; may be the larger one.
    pub top_radius: f64,
}

impl Cylinder {
    fn as_cone(&self) -> Cone {
        Cone {
            half_length: self.half_length,
            base_radius: self.radius,
            top_radius: self.radius,
        }
    }
}

impl Cone {
    /// Radius and height of the disc that a vertex is on [m].
    fn disc(&self, index: u32) -> (f64, f64) {
        if index & TOP == 0 {
            (self.base_radius, -self.half_length)
        } else {
            (self.top_radius, self.half_length)
        }
    }
}

impl SupportMap for Cylinder {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.as_cone().support(direction, start)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.as_cone().vertex(index)
    }

    fn interior_point(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        self.as_cone().rim(index)
    }
}

impl SupportMap for Cone {
    /// Of a disc that lies square to the direction, the corner on +x; level rims count as the top.
    fn support(&self, direction: DVec3, _start: u32) -> SupportPoint {
        // Scaled before squaring, or a tiny direction would lose its length.
        let scale = direction.x.abs().max(direction.y.abs());
        let radial = if scale > 0.0 {
            scale * (direction.truncate() / scale).length()
        } else {
            0.0
        };
        let rise = 2.0 * self.half_length * direction.z;
        let top = rise + (self.top_radius - self.base_radius) * radial >= 0.0;
        let (rim, radius) = if top {
            (TOP, self.top_radius)
        } else {
            (0, self.base_radius)
        };
        // One number for an apex, else equal points would pass for different vertices.
        let corner = if radius > 0.0 {
            corner_towards(direction.x, direction.y)
        } else {
            STEPS / 2
        };
        let index = rim | corner;
        SupportPoint {
            index,
            point: self.vertex(index),
        }
    }

    /// Every index is a vertex: the highest bit tells the rim, the others the corner.
    fn vertex(&self, index: u32) -> DVec3 {
        let (radius, z) = self.disc(index);
        let [x, y] = on_unit_circle(index & !TOP);
        DVec3::new(radius * x, radius * y, z)
    }

    fn interior_point(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn rim(&self, index: u32) -> Option<Rim> {
        let (radius, z) = self.disc(index);
        Some(Rim {
            centre: DVec3::new(0.0, 0.0, z),
            axis: DVec3::Z,
            radius,
        })
    }
}

/// Number of the corner nearest to a direction; of the one on +x where there is no direction.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a slope in [−1, 1] gives a step in [0, 2²⁹]"
)]
fn corner_towards(x: f64, y: f64) -> u32 {
    let (side, across, along) = if x.abs() >= y.abs() {
        if x >= 0.0 { (0, y, x) } else { (2, -y, -x) }
    } else if y > 0.0 {
        (1, -x, y)
    } else {
        (3, x, -y)
    };
    let slope = if along > 0.0 { across / along } else { 0.0 };
    let step = ((1.0 + slope) * HALF_SIDE).round() as u32;
    // The end of a side is the start of the next.
    (side * STEPS + step) & !TOP
}

fn on_unit_circle(corner: u32) -> [f64; 2] {
    let slope = f64::from(corner % STEPS) / HALF_SIDE - 1.0;
    let along = 1.0 / (1.0 + slope * slope).sqrt();
    let across = slope * along;
    match corner / STEPS {
        0 => [along, across],
        1 => [-across, along],
        2 => [-along, -across],
        _ => [across, -along],
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::DVec3;

    use super::{Cone, Cylinder, STEPS, TOP, corner_towards, on_unit_circle};
    use crate::support::SupportMap;

    #[test]
    fn corners_lie_on_the_circle_and_have_one_number_each() {
        for corner in (0..TOP)
            .step_by(104_729)
            .chain([0, 1, STEPS - 1, STEPS, TOP - 1])
        {
            let [x, y] = on_unit_circle(corner);
            assert!((x.hypot(y) - 1.0).abs() <= 2.0 * f64::EPSILON);
            assert_eq!(corner_towards(3.0 * x, 3.0 * y), corner);
            let [next_x, next_y] = on_unit_circle((corner + 1) % TOP);
            let step = (next_x - x).hypot(next_y - y);
            assert!((1.8e-9..=3.73e-9).contains(&step), "{corner}: {step}");
        }
    }

    #[test]
    fn supports_reach_as_far_as_the_circle_and_agree_with_vertices() {
        let cone = Cone {
            half_length: 0.7,
            base_radius: 0.4,
            top_radius: 0.1,
        };
        for i in 0..20_000_u32 {
            let angle = TAU * f64::from(i) / 997.0;
            let rise = (f64::from(i % 199) - 99.0) / 30.0;
            let direction = DVec3::new(angle.cos(), angle.sin(), rise);
            for length in [1e-200, 1.0, 1e150] {
                let found = cone.support(direction * length, i.wrapping_mul(2_654_435_761));
                assert_eq!(found.point, cone.vertex(found.index));
                let expected = (0.1 + 0.7 * rise).max(0.4 - 0.7 * rise);
                assert!((found.point.dot(direction) - expected).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn degenerate_and_axial_directions_choose_one_vertex() {
        let cylinder = Cylinder {
            half_length: 0.5,
            radius: 0.2,
        };
        assert_eq!(
            cylinder.support(DVec3::Z, 0).point,
            DVec3::new(0.2, 0.0, 0.5)
        );
        assert_eq!(
            cylinder.support(DVec3::NEG_Z, 9).point,
            DVec3::new(0.2, 0.0, -0.5)
        );
        let pointed = Cone {
            half_length: 0.5,
            base_radius: 0.2,
            top_radius: 0.0,
        };
        let apex = pointed.support(DVec3::new(0.1, -0.3, 2.0), 0);
        assert_eq!(apex, pointed.support(DVec3::new(-0.5, 0.2, 2.0), u32::MAX));
        assert_eq!(apex.point, DVec3::Z * 0.5);
        let disc = Cylinder {
            half_length: 0.0,
            radius: 1.0,
        };
        assert_eq!(
            disc.support(DVec3::new(0.0, -2.0, -1.0), 0),
            disc.support(DVec3::new(0.0, -2.0, 1.0), 0)
        );
    }
}
