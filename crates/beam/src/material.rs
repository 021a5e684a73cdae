//! Linear elastic materials.

use crate::error::{BeamError, not_negative, positive};

/// An isotropic or transversely isotropic linear elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Young's modulus along the beam [Pa].
    pub young_modulus: f64,
    /// Shear modulus [Pa].
    pub shear_modulus: f64,
    /// Mass density [kg/m³].
    pub density: f64,
    /// Largest strain along the beam at which it still springs back; beyond, answers are reported as over the limit.
    pub strain_limit: f64,
}

impl Material {
    /// An isotropic material with Poisson's ratio ν: G = E/2(1 + ν). Any numbers are taken; [`crate::Beam::new`] judges them.
    pub fn isotropic(young_modulus: f64, poisson_ratio: f64) -> Self {
        Self {
            young_modulus,
            shear_modulus: young_modulus / (2.0 * (1.0 + poisson_ratio)),
            density: 0.0,
            strain_limit: f64::MAX,
        }
    }

    /// ν = E/2G − 1, for the shear coefficients of sections.
    pub fn poisson_ratio(&self) -> f64 {
        self.young_modulus / (2.0 * self.shear_modulus) - 1.0
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        positive("material.young_modulus", self.young_modulus)?;
        positive("material.shear_modulus", self.shear_modulus)?;
        not_negative("material.density", self.density)?;
        positive("material.strain_limit", self.strain_limit)
    }
}
