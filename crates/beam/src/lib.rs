//! Flexible tools as beams: small deflections by the stiffness method, by the paper's solvers and in closed form.
//!
//! All in the root section's frame: origin at the clamp, x along the centre line there. SI units.

mod beam;
mod catalogue;
mod closed_form;
mod corotational;
mod element;
mod error;
mod flexibility;
mod force_method;
mod interpolation;
mod linear;
mod load;
mod material;
mod material_point;
mod natural;
mod profile;
mod quadrature;
mod section;

pub use beam::{Beam, BeamSpec, Division, Element, MOST_ELEMENTS, Rest, Shear};
pub use catalogue::{Blank, Course, Figure, Origin, ToolEntry, ToolMaterial, catalogue, tool};
pub use closed_form::{ClosedForm, Station, StationCompliance};
pub use corotational::{AnchoredLoads, Corotational, Outcome, Settings, Stability};
pub use element::{Matrix10, Matrix12, rotated, stiffness_10, stiffness_12};
pub use error::BeamError;
pub use flexibility::{ElementFlexibility, StraightStiffness};
pub use force_method::ForceMethod;
pub use interpolation::{Bend, Deformation, Interpolation};
pub use linear::{
    BandedLu, BlockTridiagonal, Definiteness, DenseLu, StiffnessMethod, Unknowns, assemble,
    consistent_loads,
};
pub use load::{Displacement, Load, Loading, SectionForces};
pub use material::Material;
pub use material_point::MaterialPoint;
pub use natural::NaturalStiffness;
pub use profile::Profile;
pub use section::{Section, Shape};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
