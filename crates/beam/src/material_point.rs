//! Points fixed to sections: where they are on a deflected beam, and what a force on them does to the nodes.
//!
//! One map serves for drawing, collision, loads and contact: its transposed derivative here is exact, so a force does on the nodes
//! the work it does on the point (beam.24).

use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::{Pose, quaternion_from_rotation_vector};

use crate::beam::Beam;
use crate::closed_form::cross_matrix;
use crate::corotational::{Frame, inverse_spin_map};
use crate::interpolation::{Deformation, Interpolation};

/// A point of a section, at rest known.
#[derive(Clone, Copy, Debug)]
pub struct MaterialPoint {
    /// Element that it is in.
    pub(crate) element: usize,
    pub(crate) interpolation: Interpolation,
    /// Section at rest in the element's axes, from its first node.
    rest: Pose,
    /// From the centre line, in the section's axes [m].
    offset: DVec3,
}

/// A material point on a deflected element, in the element's axes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placed {
    /// Centre line from the first node.
    line: DVec3,
    /// From the centre line to the point.
    arm: DVec3,
    /// Rotation vector of the section from the element's axes.
    rotation: DVec3,
}

/// Forces and moments on both nodes: (force 1, moment 1, force 2, moment 2).
pub(crate) type NodalLoad = [DVec3; 4];

impl MaterialPoint {
    /// The point at an arc position [m] and an offset from the centre line in the section's axes [m].
    pub fn new(beam: &Beam, s: f64, offset: DVec3) -> Self {
        let (index, fraction) = beam.locate(s);
        let element = &beam.elements()[index];
        let place = element.start + fraction * element.arc;
        let section = beam.rest_from(index, place);
        let axes = DQuat::from_mat3(&element.rest);
        let node = &beam.nodes()[index];
        let root_from_element = Pose::new(axes, node.translation);
        Self {
            element: index,
            interpolation: Interpolation::at(beam, index, fraction),
            rest: root_from_element.inverse() * section,
            offset,
        }
    }

    /// Whether it lies on the centre line at a node, and at which.
    pub(crate) fn at_node(&self) -> Option<usize> {
        if self.offset != DVec3::ZERO {
            return None;
        }
        if self.interpolation.fraction >= 1.0 {
            Some(self.element + 1)
        } else if self.interpolation.fraction <= 0.0 {
            Some(self.element)
        } else {
            None
        }
    }

    pub(crate) fn placed(&self, frame: &Frame) -> Placed {
        let (mut displacement, rotation) = self.interpolation.apply(&Deformation {
            stretch: frame.stretch,
            rotations: frame.rotations,
        });
        displacement.x = self.interpolation.stretch * frame.stretch;
        let turned = quaternion_from_rotation_vector(rotation) * self.rest.rotation;
        Placed {
            line: self.rest.translation + displacement,
            arm: turned * self.offset,
            rotation,
        }
    }

    /// Axes of the section in the root's frame.
    pub(crate) fn section(&self, frame: &Frame, placed: &Placed) -> DMat3 {
        let local = quaternion_from_rotation_vector(placed.rotation) * self.rest.rotation;
        frame.axes * DMat3::from_quat(local)
    }

    /// Position from the first node, in the root's frame.
    pub(crate) fn position(frame: &Frame, placed: &Placed) -> DVec3 {
        frame.axes * (placed.line + placed.arm)
    }

    /// What a force and a moment on the point, in the element's axes, are at the nodes, in the element's axes (beam.24).
    pub(crate) fn nodal_loads(
        &self,
        frame: &Frame,
        placed: &Placed,
        [force, moment]: [DVec3; 2],
    ) -> NodalLoad {
        let weights = &self.interpolation;
        let on_section = moment + placed.arm.cross(force);
        let on_rotation = spin_map(placed.rotation).transpose() * on_section;
        let ends = [0, 1].map(|end| {
            let twist = [1.0 - weights.twist, weights.twist][end];
            let [y, z] = [&weights.about_y, &weights.about_z];
            let per_rotation = DVec3::new(
                twist * on_rotation.x,
                y.rotation[end] * on_rotation.y - y.deflection[end] * force.z,
                z.rotation[end] * on_rotation.z + z.deflection[end] * force.y,
            );
            inverse_spin_map(frame.rotations[end]).transpose() * per_rotation
        });
        let on_axes = placed.line.cross(force) + on_section - ends[0] - ends[1];
        let roll = frame.roll();
        let second = DVec3::new(
            force.x * weights.stretch,
            (on_axes.z + roll.lean.z * on_axes.x) / frame.length,
            -(on_axes.y + roll.lean.y * on_axes.x) / frame.length,
        );
        [
            force - second,
            ends[0] + roll.per_spin[0] * on_axes.x,
            second,
            ends[1] + roll.per_spin[1] * on_axes.x,
        ]
    }
}

/// What takes a change of the rotation vector to a spin: I + a S + b S².
fn spin_map(rotation: DVec3) -> DMat3 {
    let square = rotation.length_squared();
    let (a, b) = if square < 1e-4 {
        (0.5 - square / 24.0, 1.0 / 6.0 - square / 120.0)
    } else {
        let angle = square.sqrt();
        (
            (1.0 - angle.cos()) / square,
            (angle - angle.sin()) / (square * angle),
        )
    };
    let s = cross_matrix(rotation);
    DMat3::IDENTITY + s * a + s * s * b
}
