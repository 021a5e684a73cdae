//! Large deflection: co-rotational elements and Newton's method on a block-tridiagonal tangent.
//!
//! Each element sees small deformations in axes that go along with it (beam.20), so displacements and rotations of the beam may be
//! of any size. A solution starts from the last one; what is missing at the end is reported and carried on.

use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::{Pose, quaternion_from_rotation_vector, rotation_vector};

use crate::beam::{Beam, Element};
use crate::linear::BlockTridiagonal;
use crate::load::{Load, Loading};
use crate::material_point::MaterialPoint;

mod assembly;
mod element;
mod newton;
#[cfg(test)]
mod objectivity;

use element::LocalStiffness;
pub(crate) use element::{Frame, inverse_spin_map};
pub use newton::{Outcome, Settings, Stability};

/// A beam that bends far, with its present shape. Owns all that a solution needs: solving allocates nothing.
#[derive(Clone, Debug)]
pub struct Corotational {
    beam: Beam,
    stiffness: Vec<LocalStiffness>,
    state: State,
    /// The last state that held its loads.
    held: State,
    tangent: BlockTridiagonal,
    /// Residual, then step, of the free nodes.
    unknowns: Vec<[f64; 6]>,
}

/// Positions and rotations of the nodes.
#[derive(Clone, Debug, PartialEq)]
struct State {
    /// In the root's frame [m].
    positions: Vec<DVec3>,
    /// From rest.
    rotations: Vec<DQuat>,
}

impl State {
    fn copy_from(&mut self, other: &Self) {
        self.positions.copy_from_slice(&other.positions);
        self.rotations.copy_from_slice(&other.rotations);
    }
}

impl Corotational {
    /// At rest.
    pub fn new(beam: Beam) -> Self {
        let state = State {
            positions: beam.nodes().iter().map(|node| node.translation).collect(),
            rotations: vec![DQuat::IDENTITY; beam.nodes().len()],
        };
        let count = beam.elements().len();
        let of_element = |(index, element): (usize, &Element)| {
            let axes = DQuat::from_mat3(&element.rest);
            let turned =
                |node: usize| rotation_vector(axes.inverse() * beam.nodes()[node].rotation);
            LocalStiffness::new(element, [turned(index), turned(index + 1)])
        };
        let stiffness = beam.elements().iter().enumerate().map(of_element).collect();
        Self {
            beam,
            stiffness,
            held: state.clone(),
            state,
            tangent: BlockTridiagonal::new(count),
            unknowns: vec![[0.0; 6]; count],
        }
    }

    /// The beam.
    pub fn beam(&self) -> &Beam {
        &self.beam
    }

    /// Back to rest. Allocates nothing.
    pub fn reset(&mut self) {
        for (position, node) in self.state.positions.iter_mut().zip(self.beam.nodes()) {
            *position = node.translation;
        }
        self.state.rotations.fill(DQuat::IDENTITY);
        self.held.copy_from(&self.state);
    }

    /// Pose of a node's section in the root's frame.
    pub fn node(&self, index: usize) -> Pose {
        let rest = self.beam.nodes()[index].rotation;
        Pose::new(
            self.state.rotations[index] * rest,
            self.state.positions[index],
        )
    }

    /// Rotation of a node from rest, in the root's axes.
    pub fn rotation(&self, index: usize) -> DQuat {
        self.state.rotations[index]
    }

    /// Pose of the section that holds a material point, with its origin in the point, in the root's frame. Allocates nothing.
    pub fn pose(&self, point: &MaterialPoint) -> Pose {
        let first = self.state.positions[point.element];
        match self.frame(point.element) {
            Some(frame) => {
                let placed = point.placed(&frame);
                let section = point.section(&frame, &placed);
                Pose::new(
                    DQuat::from_mat3(&section).normalize(),
                    first + MaterialPoint::position(&frame, &placed),
                )
            }
            None => Pose::from_translation(first),
        }
    }

    /// Force and moment that the clamp exerts on the beam, about the root, by the forces of the first element less what loads on it
    /// give to the root. Allocates nothing.
    pub fn root_reaction(&self, loads: &AnchoredLoads) -> Load {
        let Some(frame) = self.frame(0) else {
            return Load::default();
        };
        let [force, moment, _] = frame.response(&self.stiffness[0]).forces;
        let mut reaction = Load {
            s: 0.0,
            force: -force,
            moment,
        };
        for (follows, list) in [(false, &loads.dead), (true, &loads.followers)] {
            for (point, load) in list.iter().filter(|(point, _)| point.element == 0) {
                let placed = point.placed(&frame);
                let turn = if follows {
                    point.section(&frame, &placed)
                } else {
                    DMat3::IDENTITY
                };
                let local = load.map(|part| frame.axes.transpose() * (turn * part));
                let shares = point.nodal_loads(&frame, &placed, local);
                reaction.force -= frame.axes * shares[0];
                reaction.moment -= frame.axes * shares[1];
            }
        }
        reaction
    }

    fn frame(&self, index: usize) -> Option<Frame> {
        let element = &self.beam.elements()[index];
        let section = |node: usize| DMat3::from_quat(self.state.rotations[node]) * element.rest;
        Frame::new(
            [index, index + 1].map(|node| self.state.positions[node]),
            &[section(index), section(index + 1)],
            element.chord,
        )
    }

    /// Turns the free nodes by `share` of the step in `unknowns` and moves them so that chords keep their lengths.
    fn turn_without_stretch(&mut self, share: f64) {
        let turn = |step: &[f64; 6]| DVec3::from_slice(&step[3..]) * share;
        let mut before = DVec3::ZERO;
        let mut old = self.state.positions[0];
        for (node, step) in self.unknowns.iter().enumerate() {
            let own = turn(step);
            let chord = self.state.positions[node + 1] - old;
            old = self.state.positions[node + 1];
            let mean = quaternion_from_rotation_vector((before + own) * 0.5);
            self.state.positions[node + 1] = self.state.positions[node] + mean * chord;
            let rotation = &mut self.state.rotations[node + 1];
            *rotation = (quaternion_from_rotation_vector(own) * *rotation).normalize();
            before = own;
        }
    }

    /// Turns and moves the free nodes by the step in `unknowns`, `share` of it.
    fn advance(&mut self, share: f64) {
        for (node, step) in self.unknowns.iter().enumerate() {
            let moved = DVec3::from_slice(&step[..3]) * share;
            let turned = DVec3::from_slice(&step[3..]) * share;
            self.state.positions[node + 1] += moved;
            let rotation = &mut self.state.rotations[node + 1];
            *rotation = (quaternion_from_rotation_vector(turned) * *rotation).normalize();
        }
    }
}

/// Loads with the points that they act on, found once.
#[derive(Clone, Debug, Default)]
pub struct AnchoredLoads {
    dead: Vec<(MaterialPoint, [DVec3; 2])>,
    followers: Vec<(MaterialPoint, [DVec3; 2])>,
}

impl AnchoredLoads {
    /// Finds where the loads of a beam act. A line load becomes ten point loads an element, more where
    /// the section's or the curvature's table has stations inside.
    pub fn new(beam: &Beam, loading: &Loading<'_>, followers: &[Load]) -> Self {
        let anchor = |load: &Load| {
            let point = MaterialPoint::new(beam, load.s, DVec3::ZERO);
            (point, [load.force, load.moment])
        };
        let mut dead: Vec<_> = loading.points.iter().map(anchor).collect();
        if loading.line != DVec3::ZERO {
            for element in beam.elements() {
                let ends = [element.start, element.start + element.arc];
                for piece in beam.spec().pieces(ends) {
                    crate::quadrature::over_piece(piece, |s, weight| {
                        dead.push(anchor(&Load {
                            s,
                            force: loading.line * weight,
                            moment: DVec3::ZERO,
                        }));
                    });
                }
            }
        }
        Self {
            dead,
            followers: followers.iter().map(anchor).collect(),
        }
    }

    /// The largest force, or moment by a length [m], of all loads together [N].
    fn size(&self, length: f64) -> f64 {
        let all = self.dead.iter().chain(&self.followers);
        all.map(|(_, [force, moment])| force.length() + moment.length() / length)
            .sum()
    }
}
