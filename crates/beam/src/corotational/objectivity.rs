//! Tests of one element: forces and tangent turn with the element, and the tangent is the derivative of the forces.

use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::{quaternion_from_rotation_vector, rotation_vector};

use super::element::{Frame, LocalStiffness, Response};
use crate::beam::{Beam, BeamSpec, Division, Rest, Shear};
use crate::material::Material;
use crate::profile::Profile;
use crate::section::Shape;

/// Both ends of an element: positions and section axes.
#[derive(Clone, Copy)]
struct Ends {
    positions: [DVec3; 2],
    sections: [DMat3; 2],
}

/// A tapered element of which nothing is symmetric, straight or bent at rest.
struct Sample {
    beam: Beam,
    stiffness: LocalStiffness,
}

impl Sample {
    fn new(rest: Rest) -> Self {
        let rectangle = |width_y, width_z| Shape::Rectangle { width_y, width_z };
        let beam = Beam::new(BeamSpec {
            length: 0.3,
            profile: Profile::Linear {
                root: rectangle(0.03, 0.02),
                tip: rectangle(0.02, 0.025),
            },
            material: Material::isotropic(1e6, 0.3),
            division: Division::Equal(1),
            rest,
            shear: Shear::Flexible,
        })
        .unwrap();
        let element = &beam.elements()[0];
        let axes = DQuat::from_mat3(&element.rest);
        let turned = |node: usize| rotation_vector(axes.inverse() * beam.nodes()[node].rotation);
        let stiffness = LocalStiffness::new(element, [turned(0), turned(1)]);
        Self { beam, stiffness }
    }

    fn all() -> [Self; 3] {
        [
            Self::new(Rest::Straight),
            Self::new(Rest::Curved(DVec3::new(0.0, 0.9, -1.4))),
            Self::new(Rest::Curved(DVec3::new(1.1, -0.7, 0.8))),
        ]
    }

    fn at_rest(&self) -> Ends {
        let nodes = self.beam.nodes();
        Ends {
            positions: [nodes[0].translation, nodes[1].translation],
            sections: [self.beam.elements()[0].rest; 2],
        }
    }

    /// Stretched, bent and twisted, by more the larger `size` is.
    fn deformed(&self, size: f64) -> Ends {
        let mut ends = self.at_rest();
        ends.positions[1] += DVec3::new(0.002, -0.03, 0.02) * size;
        ends.turn(0, DVec3::new(0.1, -0.2, 0.15) * size);
        ends.turn(1, DVec3::new(-0.15, 0.1, 0.25) * size);
        ends
    }

    fn response(&self, ends: &Ends) -> Response {
        let rest_length = self.beam.elements()[0].chord;
        Frame::new(ends.positions, &ends.sections, rest_length)
            .unwrap()
            .response(&self.stiffness)
    }
}

impl Ends {
    fn turn(&mut self, end: usize, spin: DVec3) {
        let turn = DMat3::from_quat(quaternion_from_rotation_vector(spin));
        self.sections[end] = turn * self.sections[end];
    }

    /// Turned about the origin and moved, as a whole.
    fn moved(&self, turn: DQuat, by: DVec3) -> Self {
        Self {
            positions: self.positions.map(|position| turn * position + by),
            sections: self
                .sections
                .map(|section| DMat3::from_quat(turn) * section),
        }
    }
}

fn turns() -> [DQuat; 5] {
    [
        DQuat::from_rotation_x(3.1),
        DQuat::from_rotation_y(-2.0),
        DQuat::from_rotation_z(1.5),
        DQuat::from_axis_angle(DVec3::new(0.6, 0.0, -0.8), 3.0),
        DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -2.0) / 3.0, 0.7),
    ]
}

fn apart(own: DMat3, other: DMat3) -> f64 {
    let difference = (own - other).to_cols_array();
    difference
        .iter()
        .fold(0.0, |most, value| most.max(value.abs()))
}

#[test]
fn forces_and_tangent_turn_with_the_element() {
    let by = DVec3::new(0.2, -0.5, 0.3);
    for sample in Sample::all() {
        let ends = sample.deformed(1.0);
        let own = sample.response(&ends);
        for turn in turns() {
            let axes = DMat3::from_quat(turn);
            let moved = sample.response(&ends.moved(turn, by));
            for (force, other) in own.forces.iter().zip(&moved.forces) {
                let scale = own.forces[0].length();
                assert!(
                    (turn * *force - *other).length() <= 1e-12 * scale,
                    "{force}"
                );
            }
            let scale = apart(own.tangent[0][0], DMat3::ZERO);
            for (block, other) in own
                .tangent
                .iter()
                .flatten()
                .zip(moved.tangent.iter().flatten())
            {
                let turned = axes * *block * axes.transpose();
                assert!(apart(turned, *other) <= 1e-12 * scale);
            }
        }
    }
}

#[test]
fn moving_an_element_as_a_whole_needs_no_force() {
    for sample in Sample::all() {
        for turn in turns() {
            let moved = sample.at_rest().moved(turn, DVec3::new(-0.1, 0.4, 0.2));
            let response = sample.response(&moved);
            // What a stretch by its own length would need.
            let scale = sample.stiffness.natural.axial * sample.beam.length();
            for force in response.forces {
                assert!(force.length() <= 1e-14 * scale, "{force}");
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative_of_the_forces() {
    const STEP: f64 = 1e-5;
    for sample in Sample::all() {
        for (size, tolerance) in [(1.0, 2e-6), (0.1, 1e-7), (0.0, 1e-7)] {
            let ends = sample.deformed(size);
            let tangent = sample.response(&ends).tangent;
            for column in 0..3 {
                let blocks = tangent.map(|row| row[column]);
                let scale = blocks.map(|block| apart(block, DMat3::ZERO));
                for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
                    let stepped = |step: f64| {
                        let mut ends = ends;
                        match column {
                            0 => ends.positions[1] += unit * step,
                            end => ends.turn(end - 1, unit * step),
                        }
                        sample.response(&ends).forces
                    };
                    let (forth, back) = (stepped(STEP), stepped(-STEP));
                    for row in 0..3 {
                        let slope = (forth[row] - back[row]) / (2.0 * STEP);
                        let own = blocks[row].col(axis);
                        assert!(
                            (slope - own).length() <= tolerance * scale[row],
                            "{size} ({row}, {column}, {axis}): {own}, not {slope}"
                        );
                    }
                }
            }
        }
    }
}
