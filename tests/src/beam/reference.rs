//! Files of beam cases: loads, and displacements computed elsewhere. SI units.

use std::path::Path;

use anyhow::{Context, Result};
use glam::{DMat3, DVec3};
use pliant_beam::{Beam, BeamSpec, Division, Load, Material, Profile, Rest, Section, Shape, Shear};
use serde::Deserialize;

/// A file's cases by kind; kinds that it lacks are empty.
#[derive(Debug, Default, Deserialize)]
pub struct Reference {
    /// Small deflections of stepped beams under loads anywhere.
    #[serde(default)]
    pub linear_random: Vec<LinearCase>,
    /// Large deflections with closed or otherwise exact answers.
    #[serde(default)]
    pub nonlinear_tables: Vec<TableCase>,
    /// Large deflections in space of straight and curved, uniform and conical beams.
    #[serde(default)]
    pub nonlinear_random: Vec<SpaceCase>,
}

/// A large deflection known exactly.
#[derive(Clone, Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[expect(non_snake_case, reason = "names of the file's format")]
pub enum TableCase {
    /// A dead force across the tip of a straight inextensible beam; length and EI are 1.
    ElasticaTipDead {
        /// Force by EI/L².
        alpha: f64,
        /// Deflection of the tip across.
        w_over_L: f64,
        /// Shortening along.
        u_over_L: f64,
    },
    /// A force that stays square to the tip; length and EI are 1.
    FollowerTip {
        /// Force by EI/L².
        alpha: f64,
        /// Halfway.
        mid: DVec3,
        /// Of the tip.
        tip: DVec3,
    },
    /// A moment at the tip of a straight beam; length and EI are 1.
    RollupEndMoment {
        /// Angle of the tip by a full turn.
        fraction_of_2pi: f64,
        /// Of the tip.
        tip: DVec3,
    },
    /// An arc in the plane x–y under a force along z at its tip.
    ArcTipForce {
        /// Of the arc [m].
        radius: f64,
        /// Opening of the arc.
        degrees: f64,
        /// Young's modulus [Pa].
        E: f64,
        /// Shear modulus [Pa].
        G: f64,
        /// Of the rectangular section [m].
        width_z: f64,
        /// Of the rectangular section [m].
        height_y: f64,
        /// Torsion constant [m⁴].
        J: f64,
        /// Shear area by area.
        shear_factor: f64,
        /// [N].
        P: f64,
        /// Of the tip [m].
        tip: DVec3,
    },
    /// A helix under a dead force at its tip.
    HelixDeadTipForce {
        /// The beam.
        #[serde(flatten)]
        helix: Helix,
        /// In the root's axes [N].
        force: DVec3,
    },
    /// A helix under a force and a moment that turn with its tip.
    HelixFollowerTipWrench {
        /// The beam.
        #[serde(flatten)]
        helix: Helix,
        /// In the tip's axes [N].
        body_force: DVec3,
        /// In the tip's axes [N·m].
        body_moment: DVec3,
    },
}

/// A beam of constant curvature and twist, and where it goes.
#[derive(Clone, Debug, Deserialize)]
#[expect(non_snake_case, reason = "names of the file's format")]
pub struct Helix {
    /// Bending [rad/m].
    pub kappa: f64,
    /// Twist [rad/m].
    pub tau: f64,
    /// Torsional stiffness [N·m²].
    pub GJ: f64,
    /// Bending stiffness [N·m²].
    pub EI: f64,
    /// Length [m].
    pub L: f64,
    /// Halfway [m].
    pub mid: DVec3,
    /// Of the tip [m].
    pub tip: DVec3,
}

/// A round beam in space.
#[derive(Clone, Debug, Deserialize)]
#[expect(non_snake_case, reason = "names of the file's format")]
pub struct SpaceCase {
    /// Name of the case.
    pub id: String,
    /// Length [m].
    pub L: f64,
    /// Young's modulus [Pa].
    pub E: f64,
    /// Poisson's ratio.
    pub nu: f64,
    /// Diameter at the root [m].
    pub d_root: f64,
    /// Diameter at the tip [m].
    pub d_tip: f64,
    /// Timoshenko's theory.
    pub shear_flexible: bool,
    /// The centre line can stretch.
    pub extensible: bool,
    /// Axes of the root in the world, x first.
    pub root_frame_columns: [f64; 9],
    /// Twist, bending about y and z at rest [rad/m].
    pub initial_body_curvature: DVec3,
    /// In world axes.
    pub loads: Vec<ReferenceLoad>,
    /// Arc positions [m].
    pub stations_s: Vec<f64>,
    /// Where they are under load, from the root, in world axes [m].
    pub positions: Vec<DVec3>,
}

/// A straight cantilever of stepped sections anywhere in space.
#[derive(Debug, Deserialize)]
pub struct LinearCase {
    /// Name of the case.
    pub id: String,
    /// Along the beam.
    pub axis: DVec3,
    /// The section's z is at right angles to this and to the axis.
    pub up: DVec3,
    /// Lengths of the elements [m].
    pub lens: Vec<f64>,
    /// Timoshenko's theory.
    pub shear: bool,
    /// Nothing twists the beam.
    pub no_torque: bool,
    /// Of each element.
    pub sections: Vec<ReferenceSection>,
    /// On the centre line, in world axes.
    pub loads: Vec<ReferenceLoad>,
    /// On every metre, in world axes [N/m].
    pub line_load: DVec3,
    /// Displacement and rotation of the nodes in world axes.
    pub nodes_disp: Vec<[f64; 6]>,
    /// Arc positions [m] of the stations.
    pub stations_s: Vec<f64>,
    /// Displacement and rotation there.
    pub stations_disp: Vec<[f64; 6]>,
    /// Force and moment of the clamp on the beam, in world axes.
    pub root_reaction: [f64; 6],
}

/// Integrals of a section and its material.
#[derive(Debug, Deserialize)]
#[expect(non_snake_case, reason = "names of the file's format")]
pub struct ReferenceSection {
    /// Young's modulus [Pa].
    pub E: f64,
    /// Shear modulus [Pa].
    pub G: f64,
    /// Area [m²].
    pub A: f64,
    /// Second moment about y [m⁴].
    pub Iy: f64,
    /// Second moment about z [m⁴].
    pub Iz: f64,
    /// Torsion constant [m⁴].
    pub J: f64,
    /// Shear area along y [m²].
    #[serde(default)]
    pub ky: Option<f64>,
    /// Shear area along z [m²].
    #[serde(default)]
    pub kz: Option<f64>,
}

/// A dead load.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct ReferenceLoad {
    /// Arc position [m].
    pub s: f64,
    /// [N].
    pub force: DVec3,
    /// [N·m].
    pub moment: DVec3,
}

/// Reads a file.
///
/// # Errors
/// When it cannot be read or is not of the format, with line and column.
pub fn read(path: &Path) -> Result<Reference> {
    let text =
        std::fs::read_to_string(path).with_context(|| format!("reading {}", path.display()))?;
    serde_json::from_str(&text)
        .with_context(|| format!("{} is no file of beam cases", path.display()))
}

impl LinearCase {
    /// The beam in its root's frame.
    ///
    /// # Errors
    /// When the case's numbers make no beam.
    pub fn beam(&self) -> Result<Beam> {
        let mut rows = Vec::new();
        let mut end = 0.0;
        for (length, section) in self.lens.iter().zip(&self.sections) {
            let shape = section.shape();
            rows.push((end, shape));
            end += length;
            rows.push((end, shape));
        }
        let first = self.sections.first().context("no sections")?;
        let beam = Beam::new(BeamSpec {
            length: end,
            profile: Profile::Table(rows),
            material: Material {
                young_modulus: first.E,
                shear_modulus: first.G,
                density: 0.0,
                strain_limit: f64::MAX,
            },
            division: Division::Lengths(self.lens.clone()),
            rest: Rest::Straight,
            shear: if self.shear {
                Shear::Flexible
            } else {
                Shear::Rigid
            },
        });
        beam.with_context(|| self.id.clone())
    }

    /// Axes of the root's frame in the world.
    pub fn world_from_root(&self) -> DMat3 {
        let x = self.axis.normalize();
        let z = x.cross(self.up).normalize();
        DMat3::from_cols(x, z.cross(x), z)
    }

    /// The loads in the root's frame.
    pub fn loads(&self) -> Vec<Load> {
        let root_from_world = self.world_from_root().transpose();
        let turned = |load: &ReferenceLoad| Load {
            s: load.s,
            force: root_from_world * load.force,
            moment: root_from_world * load.moment,
        };
        self.loads.iter().map(turned).collect()
    }
}

impl ReferenceSection {
    fn shape(&self) -> Shape {
        Shape::General {
            section: Section {
                area: self.A,
                second_moment_y: self.Iy,
                second_moment_z: self.Iz,
                torsion_constant: self.J,
                shear_area_y: self.ky.unwrap_or(self.A),
                shear_area_z: self.kz.unwrap_or(self.A),
            },
            reach_y: 1.0,
            reach_z: 1.0,
        }
    }
}
