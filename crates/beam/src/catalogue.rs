//! Real tools by name, each number with where it comes from.
//!
//! Dental files, probes, needles, guidewires and bristles as cantilevers held at their handle. A figure is `Read` where a public
//! source states it, `Named` where the tool's own designation does, and `Assumed` otherwise: makers publish few of them, and a tool
//! at hand is best measured. All are linear elastic; steel yields and nickel-titanium turns superelastic at a few tenths of a
//! newton on most of them, which `strain_limit` tells.

use crate::beam::{BeamSpec, Division, Rest, Shear};
use crate::error::BeamError;
use crate::material::Material;
use crate::profile::Profile;
use crate::section::Shape;

mod materials;
mod nearest;
mod tools;

/// A number with where it comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// In the unit of the field that it is in.
    pub value: f64,
    /// Where it comes from.
    pub origin: Origin,
}

/// Where a number comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Read in this public source.
    Read(&'static str),
    /// Stated by the tool's own designation.
    Named(&'static str),
    /// Chosen, for this reason: sources differ or none was found.
    Assumed(&'static str),
}

/// A tool of the catalogue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolEntry {
    /// What [`tool`] is asked for.
    pub name: &'static str,
    /// One line.
    pub description: &'static str,
    /// Free length from the handle to the tip [m].
    pub length: Figure,
    /// Sections along it.
    pub course: Course,
    /// What it is made of.
    pub material: ToolMaterial,
    /// Elements of one length: 10, and 20 for tools that a newton bends far.
    pub elements: usize,
}

/// How the section of a tool runs from handle to tip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// A full circle all along.
    Rod {
        /// [m].
        diameter: Figure,
    },
    /// A round tube all along.
    Tube {
        /// Outer diameter [m].
        outer: Figure,
        /// Inner diameter [m].
        inner: Figure,
    },
    /// A full circle, its diameter linear.
    Cone {
        /// Diameter at the handle [m].
        root: Figure,
        /// Diameter at the tip [m].
        tip: Figure,
    },
    /// A root-canal file: a fluted part that widens from the tip on, then a shank as wide as its end.
    File {
        /// Section of the blank.
        blank: Blank,
        /// Diameter of the circle around the section at the tip [m].
        tip: Figure,
        /// Gain of that diameter per length from the tip.
        taper: Figure,
        /// Length of the fluted part [m].
        fluted: Figure,
    },
}

/// Section of a file, its corners on the nominal circle; no source states the sections of makers' files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blank {
    /// As K-files are ground from.
    Square,
    /// As of many rotary files.
    Triangle,
}

/// A material whose numbers say where they come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToolMaterial {
    /// Young's modulus [Pa].
    pub young_modulus: Figure,
    /// Poisson's ratio.
    pub poisson_ratio: Figure,
    /// Mass density [kg/m³].
    pub density: Figure,
    /// Strain at which it yields or leaves its first elastic course; `f64::MAX` where nothing is known of it.
    pub strain_limit: Figure,
}

/// All tools there are.
pub fn catalogue() -> &'static [ToolEntry] {
    tools::TOOLS
}

/// The beam of a tool by its name, straight and without shear of its sections.
///
/// # Errors
/// [`BeamError::UnknownTool`] with the names most like it.
pub fn tool(name: &str) -> Result<BeamSpec, BeamError> {
    catalogue()
        .iter()
        .find(|entry| entry.name == name)
        .map(ToolEntry::spec)
        .ok_or_else(|| nearest::unknown(name, catalogue()))
}

impl ToolEntry {
    /// Its beam, straight and without shear of its sections.
    pub fn spec(&self) -> BeamSpec {
        BeamSpec {
            length: self.length.value,
            profile: self.course.profile(self.length.value),
            material: self.material.material(),
            division: Division::Equal(self.elements),
            rest: Rest::Straight,
            shear: Shear::Rigid,
        }
    }

    /// Every number with its name and unit, for listing them.
    pub fn figures(&self) -> Vec<(&'static str, &'static str, Figure)> {
        let mut figures = vec![("length", "m", self.length)];
        match self.course {
            Course::Rod { diameter } => figures.push(("diameter", "m", diameter)),
            Course::Tube { outer, inner } => {
                figures.extend([
                    ("outer diameter", "m", outer),
                    ("inner diameter", "m", inner),
                ]);
            }
            Course::Cone { root, tip } => {
                figures.extend([("root diameter", "m", root), ("tip diameter", "m", tip)]);
            }
            Course::File {
                tip, taper, fluted, ..
            } => figures.extend([
                ("tip diameter", "m", tip),
                ("taper", "m/m", taper),
                ("fluted length", "m", fluted),
            ]),
        }
        let material = &self.material;
        figures.extend([
            ("young_modulus", "Pa", material.young_modulus),
            ("poisson_ratio", "1", material.poisson_ratio),
            ("density", "kg/m³", material.density),
            ("strain_limit", "1", material.strain_limit),
        ]);
        figures
    }
}

impl Course {
    fn profile(&self, length: f64) -> Profile {
        match *self {
            Self::Rod { diameter } => Profile::Uniform(Shape::Circle {
                diameter: diameter.value,
            }),
            Self::Tube { outer, inner } => Profile::Uniform(Shape::Tube {
                outer: outer.value,
                inner: inner.value,
            }),
            Self::Cone { root, tip } => Profile::Linear {
                root: Shape::Circle {
                    diameter: root.value,
                },
                tip: Shape::Circle {
                    diameter: tip.value,
                },
            },
            Self::File {
                blank,
                tip,
                taper,
                fluted,
            } => {
                let shape = |diameter: f64| match blank {
                    Blank::Square => Shape::Square { diameter },
                    Blank::Triangle => Shape::Triangle { diameter },
                };
                let shank = tip.value + taper.value * fluted.value;
                Profile::Table(vec![
                    (length - fluted.value, shape(shank)),
                    (length, shape(tip.value)),
                ])
            }
        }
    }
}

impl ToolMaterial {
    fn material(&self) -> Material {
        Material {
            density: self.density.value,
            strain_limit: self.strain_limit.value,
            ..Material::isotropic(self.young_modulus.value, self.poisson_ratio.value)
        }
    }
}

/// A number that a public source states.
const fn read(value: f64, source: &'static str) -> Figure {
    Figure {
        value,
        origin: Origin::Read(source),
    }
}

/// A number that the tool's designation states.
const fn named(value: f64, designation: &'static str) -> Figure {
    Figure {
        value,
        origin: Origin::Named(designation),
    }
}

/// A number chosen for a reason.
const fn assumed(value: f64, reason: &'static str) -> Figure {
    Figure {
        value,
        origin: Origin::Assumed(reason),
    }
}
