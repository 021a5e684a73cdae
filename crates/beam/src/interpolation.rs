//! What a section inside an element does when the element's ends move: exact for any taper when no load acts in between.
//!
//! A member without load between its nodes bears a moment linear from end to end; integrating its flexibility gives deflection and
//! rotation anywhere. In a uniform element these are Hermite's cubics, with shear those of Timoshenko's element (beam.7). The
//! transposed map takes a load inside to the nodes: the consistent load, which makes nodal displacements exact.

use glam::DVec3;

use crate::beam::{Beam, Element};

/// Weights of an element's deformations at one place in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interpolation {
    /// Place along the chord, 0 to 1.
    pub fraction: f64,
    /// Share of the element's stretch reached there.
    pub stretch: f64,
    /// Share of the element's twist reached there.
    pub twist: f64,
    /// Bending about y.
    pub about_y: Bend,
    /// Bending about z.
    pub about_z: Bend,
}

/// Weights of the rotations of both ends from the chord.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Deflection from the chord, for a rotation about z along y, for one about y along −z [m/rad].
    pub deflection: [f64; 2],
    /// Rotation from the chord.
    pub rotation: [f64; 2],
}

/// How an element deforms, in its own axes, by small rotations: what remains when the chord's motion is taken away.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deformation {
    /// Stretch of the chord [m].
    pub stretch: f64,
    /// Rotations of both ends from the chord [rad].
    pub rotations: [DVec3; 2],
}

impl Interpolation {
    /// At a fraction, 0 to 1, of element `index`. Allocates nothing.
    pub fn at(beam: &Beam, index: usize, fraction: f64) -> Self {
        let element = &beam.elements()[index];
        let ends = [element.start, element.start + element.arc];
        let whole = &element.flexibility;
        let part = whole.part(ends, fraction, beam.spec());
        let stiffness = whole.stiffness(element.chord);
        let bend = |stiffness, integrals, shear| {
            Bend::of(stiffness, integrals, shear, (fraction, element.chord))
        };
        Self {
            fraction,
            stretch: part.axial / whole.axial,
            twist: part.torsion / whole.torsion,
            about_y: bend(stiffness.about_y, part.bending_y, part.shear_z),
            about_z: bend(stiffness.about_z, part.bending_z, part.shear_y),
        }
    }

    /// Displacement from the place on the chord [m] and rotation from the chord, in the element's axes.
    pub fn apply(&self, deformation: &Deformation) -> (DVec3, DVec3) {
        let [first, second] = deformation.rotations;
        let weigh = |weights: [f64; 2], one: f64, two: f64| weights[0] * one + weights[1] * two;
        let displacement = DVec3::new(
            (self.stretch - self.fraction) * deformation.stretch,
            weigh(self.about_z.deflection, first.z, second.z),
            -weigh(self.about_y.deflection, first.y, second.y),
        );
        let rotation = DVec3::new(
            first.x + self.twist * (second.x - first.x),
            weigh(self.about_y.rotation, first.y, second.y),
            weigh(self.about_z.rotation, first.z, second.z),
        );
        (displacement, rotation)
    }

    /// Share of an end's rotation, about each axis, that a section here makes.
    pub(crate) fn rotation_share(&self, end: usize) -> DVec3 {
        let twist = [1.0 - self.twist, self.twist][end];
        DVec3::new(
            twist,
            self.about_y.rotation[end],
            self.about_z.rotation[end],
        )
    }

    /// Nodal forces and moments that do the same work as a force and a moment here, all in the element's axes: (force 1, moment 1,
    /// force 2, moment 2).
    pub fn to_nodes(&self, element: &Element, force: DVec3, moment: DVec3) -> [DVec3; 4] {
        let length = element.chord;
        let about_z = [0, 1].map(|end| {
            force.y * self.about_z.deflection[end] + moment.z * self.about_z.rotation[end]
        });
        let about_y = [0, 1].map(|end| {
            moment.y * self.about_y.rotation[end] - force.z * self.about_y.deflection[end]
        });
        let to_second = DVec3::new(
            force.x * self.stretch,
            force.y * self.fraction + (moment.z - about_z[0] - about_z[1]) / length,
            force.z * self.fraction - (moment.y - about_y[0] - about_y[1]) / length,
        );
        let twist = moment.x * self.twist;
        [
            force - to_second,
            DVec3::new(moment.x - twist, about_y[0], about_z[0]),
            to_second,
            DVec3::new(twist, about_y[1], about_z[1]),
        ]
    }
}

impl Bend {
    /// From the stiffness of the ends, integrals ∫ ξᵏ ds/EI and ∫ ds/GA up to ξ, and (ξ, length).
    fn of(
        [k11, k12, k22]: [f64; 3],
        [p0, p1, p2]: [f64; 3],
        shear: f64,
        (fraction, length): (f64, f64),
    ) -> Self {
        // Per unit rotation of one end: that rotation at node 1, and the end moments.
        let per_end = |at_first: f64, m1: f64, m2: f64| {
            let turned = m2 * p1 - m1 * (p0 - p1);
            let levered = m2 * p2 - m1 * (p1 - p2);
            let deflection = length * (at_first * fraction + fraction * turned - levered)
                - (m1 + m2) / length * shear;
            (deflection, at_first + turned)
        };
        let (first, second) = (per_end(1.0, k11, k12), per_end(0.0, k12, k22));
        Self {
            deflection: [first.0, second.0],
            rotation: [first.1, second.1],
        }
    }
}
