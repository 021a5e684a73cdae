//! Stiffness of an element against its own deformations, straight or bent at rest.
//!
//! What an element feels is the stretch of its chord and the rotations of both ends from it. A member bent at rest is statically
//! determinate like a straight one, only its levers and the axes of its sections change along it: the integral of its flexibility
//! over the true centre line is exact at the nodes (beam.9).

use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::Pose;

use crate::beam::{BeamSpec, Element, Shear};
use crate::flexibility::ElementFlexibility;
use crate::linear::inverse;
use crate::quadrature;

/// Forces conjugate to stretch and end rotations, per stretch and end rotations, in the element's axes. Turning both ends alike about
/// the chord is no deformation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalStiffness {
    /// Axial force per stretch [N/m].
    pub axial: f64,
    /// Moments at both ends per stretch, and axial force per their rotations [N]; 0 for a straight element.
    pub coupling: [DVec3; 2],
    /// Moments per rotations of the ends (1, 1), (1, 2), (2, 2) [N·m/rad].
    pub rotations: [DMat3; 3],
}

/// A square matrix over stretch, twist, rotations about y and about z of node 1, and of node 2.
type Matrix6 = [[f64; 6]; 6];

impl NaturalStiffness {
    /// Of a straight element of a length [m].
    pub(crate) fn straight(flexibility: &ElementFlexibility, length: f64) -> Self {
        let straight = flexibility.stiffness(length);
        let (y, z) = (straight.about_y, straight.about_z);
        let diagonal =
            |twist: f64, of: usize| DMat3::from_diagonal(DVec3::new(twist, y[of], z[of]));
        Self {
            axial: straight.axial,
            coupling: [DVec3::ZERO; 2],
            rotations: [
                diagonal(straight.torsion, 0),
                diagonal(-straight.torsion, 1),
                diagonal(straight.torsion, 2),
            ],
        }
    }

    /// Of an element bent at rest; `first` are the axes of its first section in its own.
    pub(crate) fn bent(element: &Element, spec: &BeamSpec, first: DQuat) -> Self {
        // A flexibility is positive definite and has an inverse; were rounding to say otherwise, the straight element is near.
        inverse(flexibility(element, spec, first)).map_or_else(
            || Self::straight(&element.flexibility, element.chord),
            |stiffness| Self::from_matrix(&stiffness),
        )
    }

    fn from_matrix(k: &Matrix6) -> Self {
        // Twist is the rotation of the second end about x less that of the first.
        let place = [
            [(1, -1.0), (2, 1.0), (3, 1.0)],
            [(1, 1.0), (4, 1.0), (5, 1.0)],
        ];
        let block = |row: usize, column: usize| {
            DMat3::from_cols_array_2d(
                &place[column].map(|(j, of_j)| place[row].map(|(i, of_i)| k[i][j] * of_i * of_j)),
            )
        };
        Self {
            axial: k[0][0],
            coupling: place.map(|end| DVec3::from_array(end.map(|(i, sign)| k[0][i] * sign))),
            rotations: [block(0, 0), block(0, 1), block(1, 1)],
        }
    }
}

/// Deformations per axial force, torque, and moments of the ends: the integral of the sections' flexibilities over the rest shape.
fn flexibility(element: &Element, spec: &BeamSpec, first: DQuat) -> Matrix6 {
    let material = &spec.material;
    let nu = material.poisson_ratio();
    let length = element.chord;
    let mut total = [[0.0; 6]; 6];
    let ends = [element.start, element.start + element.arc];
    let mut add = |s: f64, weight: f64| {
        let section = spec.profile.at(s, spec.length).section(nu);
        let pose = Pose::new(first, DVec3::ZERO) * spec.rest.between(element.start, s);
        let to_section = DMat3::from_quat(pose.rotation).transpose();
        let lever = DVec3::X * length - pose.translation;
        let per_force = if spec.shear == Shear::Flexible {
            DVec3::new(
                1.0 / (material.young_modulus * section.area),
                1.0 / (material.shear_modulus * section.shear_area_y),
                1.0 / (material.shear_modulus * section.shear_area_z),
            )
        } else {
            DVec3::X / (material.young_modulus * section.area)
        };
        let per_moment = DVec3::new(
            1.0 / (material.shear_modulus * section.torsion_constant),
            1.0 / (material.young_modulus * section.second_moment_y),
            1.0 / (material.young_modulus * section.second_moment_z),
        );
        let at_section = unit_end_forces(length).map(|[force, moment]| {
            [
                to_section * force,
                to_section * (moment + lever.cross(force)),
            ]
        });
        for (row, [force, moment]) in total.iter_mut().zip(at_section) {
            for (entry, [other_force, other_moment]) in row.iter_mut().zip(at_section) {
                let strain = (force * per_force).dot(other_force);
                *entry += weight * (strain + (moment * per_moment).dot(other_moment));
            }
        }
    };
    for piece in spec.pieces(ends) {
        quadrature::over_pieces(piece, &spec.profile, spec.length, &mut add);
    }
    total
}

/// Force and moment on the second node that go with a unit of each: axial force, torque, moments on node 1 about y and z, on node 2.
fn unit_end_forces(length: f64) -> [[DVec3; 2]; 6] {
    let shear_of_y = DVec3::Z / length;
    let shear_of_z = DVec3::NEG_Y / length;
    [
        [DVec3::X, DVec3::ZERO],
        [DVec3::ZERO, DVec3::X],
        [shear_of_y, DVec3::ZERO],
        [shear_of_z, DVec3::ZERO],
        [shear_of_y, DVec3::Y],
        [shear_of_z, DVec3::Z],
    ]
}
