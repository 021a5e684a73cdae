//! Compliance of a straight beam in closed form: from integrals of its sections' flexibilities, without any matrix.
//!
//! A cantilever is statically determinate: the virtual-work integral of a load at a and a question at s is one over 0…min(s, a),
//! a polynomial in s and a whose coefficients are integrals tᵏ/EI up to there (beam.10). Exact for any taper, at any two
//! positions, and no digit is lost as elements become short.

use glam::{DMat3, DVec3};

use crate::beam::{Beam, Shear};
use crate::load::{Displacement, Loading};
use crate::quadrature;

/// Integrals of a beam's flexibility from the root to a section.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Integrals {
    /// ∫ tᵏ/EA, k = 0, 1.
    axial: [f64; 2],
    /// ∫ 1/GJ.
    torsion: f64,
    /// ∫ `tᵏ/EI_y`, k = 0…3.
    bending_y: [f64; 4],
    /// ∫ `tᵏ/EI_z`, k = 0…3.
    bending_z: [f64; 4],
    /// ∫ `tᵏ/GA_y`, k = 0, 1.
    shear_y: [f64; 2],
    /// ∫ `tᵏ/GA_z`, k = 0, 1.
    shear_z: [f64; 2],
}

/// A straight beam, ready to answer.
#[derive(Clone, Debug)]
pub struct ClosedForm<'b> {
    beam: &'b Beam,
    /// Up to each node.
    nodes: Vec<Integrals>,
}

/// An arc position with what is known of the beam up to there.
#[derive(Clone, Copy, Debug)]
pub struct Station {
    /// Arc position [m].
    pub s: f64,
    integrals: Integrals,
}

/// Displacement and rotation at one station per force and moment at another, rows by columns of 3 × 3 blocks, in the root's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationCompliance {
    /// Displacement per force [m/N].
    pub translation_force: DMat3,
    /// Displacement per moment [1/N].
    pub translation_moment: DMat3,
    /// Rotation per force [1/N].
    pub rotation_force: DMat3,
    /// Rotation per moment [1/(N·m)].
    pub rotation_moment: DMat3,
}

impl<'b> ClosedForm<'b> {
    /// `None` for a beam that is bent at rest: there the stiffness method serves.
    pub fn new(beam: &'b Beam) -> Option<Self> {
        if !beam.is_straight() {
            return None;
        }
        let mut nodes = vec![Integrals::default()];
        let mut total = Integrals::default();
        for element in beam.elements() {
            total.add(beam, [element.start, element.start + element.arc]);
            nodes.push(total);
        }
        Some(Self { beam, nodes })
    }

    /// The integrals up to an arc position [m]; positions beyond an end count as the end. Allocates nothing.
    pub fn station(&self, s: f64) -> Station {
        let s = s.clamp(0.0, self.beam.length());
        let (index, fraction) = self.beam.locate(s);
        let element = &self.beam.elements()[index];
        let mut integrals = self.nodes[index];
        if fraction >= 1.0 {
            integrals = self.nodes[index + 1];
        } else if element.flexibility.uniform {
            let whole = &self.nodes[index + 1];
            integrals.add_share(whole, element.start, element.arc, fraction);
        } else if fraction > 0.0 {
            integrals.add(self.beam, [element.start, s]);
        }
        Station { s, integrals }
    }

    /// What loads do at a station (beam.11). Allocates nothing.
    pub fn displacement(&self, at: &Station, loading: &Loading<'_>) -> Displacement {
        let mut sum = at.under_line(loading.line, self.beam.length());
        for load in loading.points {
            let compliance = at.compliance(&self.station(load.s));
            sum.translation += compliance.translation_force * load.force
                + compliance.translation_moment * load.moment;
            sum.rotation +=
                compliance.rotation_force * load.force + compliance.rotation_moment * load.moment;
        }
        sum
    }
}

impl Station {
    /// What a force and a moment at another station do here (beam.10). Transposed, what they would do there from here. Allocates
    /// nothing.
    pub fn compliance(&self, load: &Self) -> StationCompliance {
        let near = if self.s <= load.s {
            &self.integrals
        } else {
            &load.integrals
        };
        let (s, a) = (self.s, load.s);
        let bent = |i: &[f64; 4]| s * a * i[0] - (s + a) * i[1] + i[2];
        let (y, z) = (&near.bending_y, &near.bending_z);
        let mut compliance = StationCompliance {
            translation_force: DMat3::from_diagonal(DVec3::new(
                near.axial[0],
                bent(z) + near.shear_y[0],
                bent(y) + near.shear_z[0],
            )),
            translation_moment: DMat3::ZERO,
            rotation_force: DMat3::ZERO,
            rotation_moment: DMat3::from_diagonal(DVec3::new(near.torsion, y[0], z[0])),
        };
        // v per m_z, w per m_y, r_y per f_z, r_z per f_y; columns first.
        compliance.translation_moment.z_axis.y = s * z[0] - z[1];
        compliance.translation_moment.y_axis.z = -(s * y[0] - y[1]);
        compliance.rotation_force.y_axis.z = a * z[0] - z[1];
        compliance.rotation_force.z_axis.y = -(a * y[0] - y[1]);
        compliance
    }

    /// What a load on every metre up to `length` does here.
    fn under_line(&self, line: DVec3, length: f64) -> Displacement {
        let (s, l) = (self.s, length);
        let i = &self.integrals;
        let bent = |k: &[f64; 4]| {
            0.5 * (s * l * l * k[0] - l * (l + 2.0 * s) * k[1] + (s + 2.0 * l) * k[2] - k[3])
        };
        let turned = |k: &[f64; 4]| 0.5 * (l * l * k[0] - 2.0 * l * k[1] + k[2]);
        let sheared = |k: &[f64; 2]| l * k[0] - k[1];
        Displacement {
            translation: line
                * DVec3::new(
                    sheared(&i.axial),
                    bent(&i.bending_z) + sheared(&i.shear_y),
                    bent(&i.bending_y) + sheared(&i.shear_z),
                ),
            rotation: DVec3::new(
                0.0,
                -line.z * turned(&i.bending_y),
                line.y * turned(&i.bending_z),
            ),
        }
    }
}

impl StationCompliance {
    /// Displacement of a material point at `here` off the centre line per force on one at `there`, both in the section's y–z plane at
    /// rest [m]: the offsets turn with the sections (beam.12).
    pub fn between_points(&self, here: DVec3, there: DVec3) -> DMat3 {
        let (lever_here, lever_there) = (cross_matrix(here), cross_matrix(there));
        self.translation_force + self.translation_moment * lever_there
            - lever_here * (self.rotation_force + self.rotation_moment * lever_there)
    }
}

/// The matrix of v ↦ r × v.
pub(crate) fn cross_matrix(r: DVec3) -> DMat3 {
    DMat3::from_cols(
        DVec3::new(0.0, r.z, -r.y),
        DVec3::new(-r.z, 0.0, r.x),
        DVec3::new(r.y, -r.x, 0.0),
    )
}

impl Integrals {
    /// Adds what lies between two arc positions, by quadrature.
    fn add(&mut self, beam: &Beam, ends: [f64; 2]) {
        let spec = beam.spec();
        let material = &spec.material;
        let nu = material.poisson_ratio();
        quadrature::over_pieces(ends, &spec.profile, spec.length, |s, weight| {
            let section = spec.profile.at(s, spec.length).section(nu);
            let per_stretch = weight / (material.young_modulus * section.area);
            let per_y = weight / (material.young_modulus * section.second_moment_y);
            let per_z = weight / (material.young_modulus * section.second_moment_z);
            let powers = [1.0, s, s * s, s * s * s];
            for (k, power) in powers.into_iter().enumerate() {
                self.bending_y[k] += power * per_y;
                self.bending_z[k] += power * per_z;
            }
            self.axial[0] += per_stretch;
            self.axial[1] += per_stretch * s;
            self.torsion += weight / (material.shear_modulus * section.torsion_constant);
            if spec.shear == Shear::Flexible {
                let along_y = weight / (material.shear_modulus * section.shear_area_y);
                let along_z = weight / (material.shear_modulus * section.shear_area_z);
                self.shear_y[0] += along_y;
                self.shear_y[1] += along_y * s;
                self.shear_z[0] += along_z;
                self.shear_z[1] += along_z * s;
            }
        });
    }

    /// Adds a first part of an element of one section, `whole` being up to its end: ∫ tᵏ over that part is known.
    fn add_share(&mut self, whole: &Self, start: f64, arc: f64, fraction: f64) {
        let end = start + fraction * arc;
        let part = [0, 1, 2, 3].map(|k| {
            let power = |t: f64| t.powi(k + 1) / f64::from(k + 1);
            power(end) - power(start)
        });
        let rate = |whole: f64, own: f64| (whole - own) / arc;
        let of_y = rate(whole.bending_y[0], self.bending_y[0]);
        let of_z = rate(whole.bending_z[0], self.bending_z[0]);
        for (k, part) in part.into_iter().enumerate() {
            self.bending_y[k] += of_y * part;
            self.bending_z[k] += of_z * part;
        }
        self.torsion += rate(whole.torsion, self.torsion) * part[0];
        for (own, whole) in [
            (&mut self.axial, &whole.axial),
            (&mut self.shear_y, &whole.shear_y),
            (&mut self.shear_z, &whole.shear_z),
        ] {
            let per_length = rate(whole[0], own[0]);
            own[0] += per_length * part[0];
            own[1] += per_length * part[1];
        }
    }
}
