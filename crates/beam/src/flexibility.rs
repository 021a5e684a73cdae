//! How an element gives way: integrals of its sections' flexibilities, exact for any taper.
//!
//! A straight member between two nodes is statically determinate, so its end rotations under end moments follow from
//! integrating the flexibility of its sections, whatever their course (Przemieniecki 1968, §5; the "flexibility method" of
//! tapered elements). Inverted, this is the stiffness exact at the nodes; a stepped row of uniform elements is not.

use crate::beam::{BeamSpec, Shear};
use crate::quadrature;

/// Integrals over an element of length L along ξ = 0…1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElementFlexibility {
    /// ∫ ds/EA [m/N].
    pub axial: f64,
    /// ∫ ds/GJ [rad/(N·m)].
    pub torsion: f64,
    /// ∫ ξᵏ `ds/EI_y`, k = 0, 1, 2 [rad/(N·m)].
    pub bending_y: [f64; 3],
    /// ∫ ξᵏ `ds/EI_z`, k = 0, 1, 2 [rad/(N·m)].
    pub bending_z: [f64; 3],
    /// ∫ `ds/GA_y`, the shear along y that goes with bending about z [m/N]; 0 where sections do not shear.
    pub shear_y: f64,
    /// ∫ `ds/GA_z` [m/N]; 0 where sections do not shear.
    pub shear_z: f64,
    /// ∫ A ds [m³].
    pub volume: f64,
    /// The section is the same all along.
    pub uniform: bool,
}

/// Stiffness of a straight element against its own deformations: stretch, twist, and the rotations of its ends from the chord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StraightStiffness {
    /// Force per stretch [N/m].
    pub axial: f64,
    /// Torque per twist [N·m/rad].
    pub torsion: f64,
    /// Moments about y at (node 1, node 2) per rotation: k₁₁, k₁₂, k₂₂ [N·m/rad].
    pub about_y: [f64; 3],
    /// The same about z.
    pub about_z: [f64; 3],
}

impl ElementFlexibility {
    /// Of the element between two arc positions [m], or of its first part up to ξ = `fraction`.
    pub(crate) fn new([start, end]: [f64; 2], fraction: f64, spec: &BeamSpec) -> Self {
        let mut total = Self {
            axial: 0.0,
            torsion: 0.0,
            bending_y: [0.0; 3],
            bending_z: [0.0; 3],
            shear_y: 0.0,
            shear_z: 0.0,
            volume: 0.0,
            uniform: true,
        };
        let first = spec.profile.at(start, spec.length);
        let material = &spec.material;
        let nu = material.poisson_ratio();
        let part = [start, start + fraction * (end - start)];
        quadrature::over_pieces(part, &spec.profile, spec.length, |s, weight| {
            let shape = spec.profile.at(s, spec.length);
            total.uniform &= shape == first;
            let section = shape.section(nu);
            let xi = (s - start) / (end - start);
            let of_y = weight / (material.young_modulus * section.second_moment_y);
            let of_z = weight / (material.young_modulus * section.second_moment_z);
            for (k, power) in [1.0, xi, xi * xi].into_iter().enumerate() {
                total.bending_y[k] += power * of_y;
                total.bending_z[k] += power * of_z;
            }
            total.axial += weight / (material.young_modulus * section.area);
            total.torsion += weight / (material.shear_modulus * section.torsion_constant);
            if spec.shear == Shear::Flexible {
                total.shear_y += weight / (material.shear_modulus * section.shear_area_y);
                total.shear_z += weight / (material.shear_modulus * section.shear_area_z);
            }
            total.volume += weight * section.area;
        });
        total
    }

    /// Of the first part of the element, up to ξ = `fraction`; the powers of ξ still count along the whole.
    pub(crate) fn part(&self, ends: [f64; 2], fraction: f64, spec: &BeamSpec) -> Self {
        if !self.uniform {
            return Self::new(ends, fraction, spec);
        }
        let powers = |whole: &[f64; 3]| {
            let square = fraction * fraction;
            [fraction, square / 2.0, square * fraction / 3.0].map(|share| whole[0] * share)
        };
        Self {
            axial: self.axial * fraction,
            torsion: self.torsion * fraction,
            bending_y: powers(&self.bending_y),
            bending_z: powers(&self.bending_z),
            shear_y: self.shear_y * fraction,
            shear_z: self.shear_z * fraction,
            volume: self.volume * fraction,
            uniform: true,
        }
    }

    /// The inverse, for an element with its nodes `length` [m] apart (beam.2).
    pub fn stiffness(&self, length: f64) -> StraightStiffness {
        StraightStiffness {
            axial: 1.0 / self.axial,
            torsion: 1.0 / self.torsion,
            about_y: ends(self.bending_y, self.shear_z / (length * length)),
            about_z: ends(self.bending_z, self.shear_y / (length * length)),
        }
    }
}

/// Moments at both ends per rotation from the chord: the inverse of the flexibility of a member on two supports.
fn ends([zeroth, first, second]: [f64; 3], shear: f64) -> [f64; 3] {
    let f11 = zeroth - 2.0 * first + second + shear;
    let f12 = second - first + shear;
    let f22 = second + shear;
    // f₁₁ f₂₂ − f₁₂² without the squares of the shear, in which a stubby element would lose all digits.
    let determinant = zeroth * (second + shear) - first * first;
    [f22 / determinant, -f12 / determinant, f11 / determinant]
}
