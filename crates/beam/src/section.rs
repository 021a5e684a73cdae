//! Cross-sections: what a beam's stiffness needs of them, from the shapes tools have.
//!
//! Axes: x along the beam, y and z across. Bending *about* y bends in the x–z plane and uses ∫ z² dA.

use std::f64::consts::{PI, SQRT_2};

use glam::DVec2;

use crate::error::{BeamError, positive};

/// Integrals over a cross-section, about its centroid and principal axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// A [m²].
    pub area: f64,
    /// Second moment of area about y, ∫ z² dA [m⁴].
    pub second_moment_y: f64,
    /// Second moment of area about z, ∫ y² dA [m⁴].
    pub second_moment_z: f64,
    /// Saint-Venant's torsion constant J [m⁴].
    pub torsion_constant: f64,
    /// Area that carries shear along y, κA [m²].
    pub shear_area_y: f64,
    /// Area that carries shear along z, κA [m²].
    pub shear_area_z: f64,
}

/// A shape of section with its measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A full circle.
    Circle {
        /// [m].
        diameter: f64,
    },
    /// A circle with a round hole.
    Tube {
        /// Outer diameter [m].
        outer: f64,
        /// Inner diameter [m].
        inner: f64,
    },
    /// A rectangle with its sides along y and z.
    Rectangle {
        /// Along y [m].
        width_y: f64,
        /// Along z [m].
        width_z: f64,
    },
    /// A square blank with its corners on a circle, as of K-files.
    Square {
        /// Of the circle through the corners [m].
        diameter: f64,
    },
    /// An equilateral triangle with its corners on a circle, as of many rotary files; one corner on +y.
    Triangle {
        /// Of the circle through the corners [m].
        diameter: f64,
    },
    /// Any other section, by its integrals.
    General {
        /// The integrals.
        section: Section,
        /// Largest |y| of a fibre [m].
        reach_y: f64,
        /// Largest |z| of a fibre [m].
        reach_z: f64,
    },
}

/// Shear coefficient of a rectangle with ν = 0, taken for polygons (Cowper 1966, table 1).
const POLYGON_SHEAR: f64 = 5.0 / 6.0;

/// Σ 1/n⁵ over odd n: 31 ζ(5)/32.
const ODD_FIFTH_POWERS: f64 = 1.004_523_762_795_139_5;

impl Shape {
    /// The integrals. Shear areas are those of Cowper (1966, "The Shear Coefficient in Timoshenko's Beam Theory") for the
    /// circle and the tube, 5/6 of the area for polygons; torsion is exact for all (rectangle: Timoshenko & Goodier 1970, art. 109).
    pub fn section(&self, poisson_ratio: f64) -> Section {
        match *self {
            Self::Circle { diameter } => round(diameter, 0.0, poisson_ratio),
            Self::Tube { outer, inner } => round(outer, inner, poisson_ratio),
            Self::Rectangle { width_y, width_z } => rectangle(width_y, width_z),
            Self::Square { diameter } => rectangle(diameter / SQRT_2, diameter / SQRT_2),
            Self::Triangle { diameter } => {
                let side = diameter * 3.0_f64.sqrt() / 2.0;
                let area = 3.0_f64.sqrt() / 4.0 * side.powi(2);
                let second_moment = 3.0_f64.sqrt() / 96.0 * side.powi(4);
                Section {
                    area,
                    second_moment_y: second_moment,
                    second_moment_z: second_moment,
                    torsion_constant: 3.0_f64.sqrt() / 80.0 * side.powi(4),
                    shear_area_y: POLYGON_SHEAR * area,
                    shear_area_z: POLYGON_SHEAR * area,
                }
            }
            Self::General { section, .. } => section,
        }
    }

    /// Largest strain of any fibre, of magnitude, when the centre line is strained by `axial` and the section bends with
    /// `curvature` = (`κ_y`, `κ_z`) [1/m]: a fibre at (y, z) is strained by `axial` + z `κ_y` − y `κ_z`. Torsion is not part of it.
    pub fn largest_strain(&self, axial: f64, curvature: DVec2) -> f64 {
        let round = |diameter: f64| axial.abs() + 0.5 * diameter * curvature.length();
        let corners = |y: f64, z: f64| axial.abs() + z * curvature.x.abs() + y * curvature.y.abs();
        match *self {
            Self::Circle { diameter } => round(diameter),
            Self::Tube { outer, .. } => round(outer),
            Self::Rectangle { width_y, width_z } => corners(0.5 * width_y, 0.5 * width_z),
            Self::Square { diameter } => corners(diameter / SQRT_2 / 2.0, diameter / SQRT_2 / 2.0),
            Self::Triangle { diameter } => [0.0, 2.0, 4.0]
                .map(|third: f64| {
                    let corner = DVec2::from_angle(third * PI / 3.0) * (0.5 * diameter);
                    (axial + corner.y * curvature.x - corner.x * curvature.y).abs()
                })
                .into_iter()
                .fold(0.0, f64::max),
            Self::General {
                reach_y, reach_z, ..
            } => corners(reach_y, reach_z),
        }
    }

    /// Name of the kind, for messages.
    pub(crate) fn kind(&self) -> &'static str {
        match self {
            Self::Circle { .. } => "a circle",
            Self::Tube { .. } => "a tube",
            Self::Rectangle { .. } => "a rectangle",
            Self::Square { .. } => "a square",
            Self::Triangle { .. } => "a triangle",
            Self::General { .. } => "a general section",
        }
    }

    /// The measures with their names: what is checked, and interpolated between shapes of one kind.
    fn measures(&self) -> ([f64; 8], &'static [&'static str]) {
        let mut all = [0.0; 8];
        let (values, names): (&[f64], &'static [&'static str]) = match self {
            Self::Circle { diameter } | Self::Square { diameter } | Self::Triangle { diameter } => {
                (&[*diameter], &["diameter"])
            }
            Self::Tube { outer, inner } => (&[*outer, *inner], &["outer", "inner"]),
            Self::Rectangle { width_y, width_z } => {
                (&[*width_y, *width_z], &["width_y", "width_z"])
            }
            Self::General {
                section,
                reach_y,
                reach_z,
            } => (
                &[
                    section.area,
                    section.second_moment_y,
                    section.second_moment_z,
                    section.torsion_constant,
                    section.shear_area_y,
                    section.shear_area_z,
                    *reach_y,
                    *reach_z,
                ],
                &[
                    "section.area",
                    "section.second_moment_y",
                    "section.second_moment_z",
                    "section.torsion_constant",
                    "section.shear_area_y",
                    "section.shear_area_z",
                    "reach_y",
                    "reach_z",
                ],
            ),
        };
        all[..values.len()].copy_from_slice(values);
        (all, names)
    }

    /// The same kind with other measures.
    fn with_measures(&self, m: &[f64; 8]) -> Self {
        match self {
            Self::Circle { .. } => Self::Circle { diameter: m[0] },
            Self::Square { .. } => Self::Square { diameter: m[0] },
            Self::Triangle { .. } => Self::Triangle { diameter: m[0] },
            Self::Tube { .. } => Self::Tube {
                outer: m[0],
                inner: m[1],
            },
            Self::Rectangle { .. } => Self::Rectangle {
                width_y: m[0],
                width_z: m[1],
            },
            Self::General { .. } => Self::General {
                section: Section {
                    area: m[0],
                    second_moment_y: m[1],
                    second_moment_z: m[2],
                    torsion_constant: m[3],
                    shear_area_y: m[4],
                    shear_area_z: m[5],
                },
                reach_y: m[6],
                reach_z: m[7],
            },
        }
    }

    /// Between this shape (0) and another of its kind (1).
    pub(crate) fn between(&self, other: &Self, fraction: f64) -> Self {
        let (from, _) = self.measures();
        let (to, _) = other.measures();
        let mut mixed = [0.0; 8];
        for (mixed, (from, to)) in mixed.iter_mut().zip(from.iter().zip(to)) {
            *mixed = from + (to - from) * fraction;
        }
        self.with_measures(&mixed)
    }

    /// An error that names the measure unless all are finite and above zero, and a tube has a wall.
    pub(crate) fn check(&self, field: &str) -> Result<(), BeamError> {
        let (values, names) = self.measures();
        for (value, name) in values.iter().zip(names) {
            positive(format!("{field}.{name}"), *value)?;
        }
        if let Self::Tube { outer, inner } = self
            && inner >= outer
        {
            return Err(BeamError::Value {
                field: format!("{field}.inner"),
                value: *inner,
                demand: "less than the outer diameter",
            });
        }
        Ok(())
    }
}

fn round(outer: f64, inner: f64, nu: f64) -> Section {
    let area = PI / 4.0 * (outer - inner) * (outer + inner);
    let second_moment = area / 16.0 * (outer.powi(2) + inner.powi(2));
    let ratio = inner / outer;
    let both = (1.0 + ratio.powi(2)).powi(2);
    let coefficient =
        6.0 * (1.0 + nu) * both / ((7.0 + 6.0 * nu) * both + (20.0 + 12.0 * nu) * ratio.powi(2));
    Section {
        area,
        second_moment_y: second_moment,
        second_moment_z: second_moment,
        torsion_constant: 2.0 * second_moment,
        shear_area_y: coefficient * area,
        shear_area_z: coefficient * area,
    }
}

fn rectangle(y: f64, z: f64) -> Section {
    let area = y * z;
    let (long, short) = (y.max(z), y.min(z));
    // The series Σ tanh(nπ long/2 short)/n⁵ over odd n as its limit, less what the first terms fall short.
    let mut series = ODD_FIFTH_POWERS;
    for n in [1.0, 3.0, 5.0, 7.0, 9.0, 11.0_f64] {
        let rest = 2.0 / ((n * PI * long / short).exp() + 1.0);
        series -= rest / n.powi(5);
    }
    Section {
        area,
        second_moment_y: area * z.powi(2) / 12.0,
        second_moment_z: area * y.powi(2) / 12.0,
        torsion_constant: long * short.powi(3) / 3.0
            * (1.0 - 192.0 / PI.powi(5) * (short / long) * series),
        shear_area_y: POLYGON_SHEAR * area,
        shear_area_z: POLYGON_SHEAR * area,
    }
}
