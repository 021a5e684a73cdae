//! One co-rotational element: forces and full tangent.
//!
//! Element-independent co-rotational formulation of Nour-Omid & Rankin (1991) with an element frame near that of Battini & Pacoste
//! (2002): x along the chord, the others as near as they can be to the section axes of both ends. Departing from them, y and z
//! count alike, the variation of the frame's roll is kept in the tangent, so that Newton converges quadratically and the assembled
//! tangent is symmetric at equilibrium, and a chord shortens as its arc bends.
//!
//! Everything is written in the element's axes for nine increments: the difference d of the end positions, and the spins of both
//! ends. Forces on the first node are minus those on the second.

use glam::{DMat3, DVec3};

use crate::beam::Element;
use crate::closed_form::cross_matrix;
use crate::natural::NaturalStiffness;

/// Placement of an element and its deformation (beam.20).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    /// Element axes in the root's frame.
    pub(crate) axes: DMat3,
    /// Distance of the nodes [m].
    pub(crate) length: f64,
    /// Stretch of the chord [m].
    pub(crate) stretch: f64,
    /// Rotation vectors of both ends from the element's axes, in them [rad].
    pub(crate) rotations: [DVec3; 2],
    /// Section axes of both ends, in the element's axes.
    sections: [DMat3; 2],
}

/// How the element's axes turn per increment, in these axes: by `d_z` over the length about −y, by `d_y` over it about z, and about x
/// by what follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roll {
    /// Along x of the mean section axes y and z: per `d_y` by +z, per `d_z` by −y, over the length.
    pub(crate) lean: DVec3,
    /// Per spin of either end.
    pub(crate) per_spin: [DVec3; 2],
}

/// Forces and tangent of an element, in the root's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Response {
    /// Force on the second node [N], moments on both [N·m].
    pub(crate) forces: [DVec3; 3],
    /// Rows force on the second node, moment 1, moment 2; columns difference of positions, spin 1, spin 2.
    pub(crate) tangent: [[DMat3; 3]; 3],
}

impl Frame {
    /// From the nodes' positions and the section axes of both ends, which are those of the element where it is undeformed. `None`:
    /// the ends coincide, or a section stands at right angles to the chord.
    pub(crate) fn new(ends: [DVec3; 2], sections: &[DMat3; 2], rest_length: f64) -> Option<Self> {
        let chord = ends[1] - ends[0];
        let length = chord.length();
        let x = chord / length;
        // The y axis nearest to those of both ends, z axes counted as well: a round section must not tell one from the other.
        let mean = sections[0].y_axis
            + sections[1].y_axis
            + (sections[0].z_axis + sections[1].z_axis).cross(x);
        let z = x.cross(mean);
        let across = z.length();
        // A mean axis almost along the chord has turned by a right angle: no element bends like that.
        if !(length > 0.0 && across > 1e-3) {
            return None;
        }
        let z = z / across;
        let axes = DMat3::from_cols(x, z.cross(x), z);
        let to_element = axes.transpose();
        let local = sections.map(|section| to_element * section);
        Some(Self {
            axes,
            length,
            stretch: length - rest_length,
            rotations: [rotation_vector(&local[0])?, rotation_vector(&local[1])?],
            sections: local,
        })
    }

    /// How the axes turn.
    pub(crate) fn roll(&self) -> Roll {
        let [first, second] = &self.sections;
        let inverse = 1.0 / self.alignment();
        let share = |of: &DMat3| {
            DVec3::new(of.y_axis.y + of.z_axis.z, -of.y_axis.x, -of.z_axis.x) * inverse
        };
        let per_spin = [share(first), share(second)];
        Roll {
            lean: -(per_spin[0] + per_spin[1]).with_x(0.0),
            per_spin,
        }
    }

    /// How well the section axes of both ends go along with the element's: 4 when they do.
    fn alignment(&self) -> f64 {
        let [first, second] = &self.sections;
        first.y_axis.y + first.z_axis.z + second.y_axis.y + second.z_axis.z
    }

    /// Forces and, in all nine increments, the tangent.
    pub(crate) fn response(&self, stiffness: &LocalStiffness) -> Response {
        let local = self.local(stiffness);
        let roll = self.roll();
        let forces = self.forces(&local, &roll);
        let [dd, d1, d2, m11, m12, m22] = self.tangent(&local, &roll, &forces);
        let axes = self.axes;
        let back = axes.transpose();
        let (d1, d2, m12) = (axes * d1 * back, axes * d2 * back, axes * m12 * back);
        Response {
            forces: [axes * forces[0], axes * forces[1], axes * forces[2]],
            // Off the diagonal the tangent of an energy is symmetric.
            tangent: [
                [axes * dd * back, d1, d2],
                [d1.transpose(), axes * m11 * back, m12],
                [d2.transpose(), m12.transpose(), axes * m22 * back],
            ],
        }
    }

    /// Forces in the element's axes.
    fn forces(&self, local: &Local, roll: &Roll) -> [DVec3; 3] {
        let moment = local.moments[0] + local.moments[1];
        let force = DVec3::new(
            local.axial,
            -(moment.z + roll.lean.z * moment.x) / self.length,
            (moment.y + roll.lean.y * moment.x) / self.length,
        );
        let [first, second] = [0, 1].map(|end| local.moments[end] - roll.per_spin[end] * moment.x);
        [force, first, second]
    }

    /// What the element answers to its own deformation.
    fn local(&self, stiffness: &LocalStiffness) -> Local {
        let [t1, t2] = self.rotations;
        let natural = &stiffness.natural;
        let bow = stiffness.bow(self.rotations);
        let stretch = self.stretch - bow.length;
        let [c1, c2] = natural.coupling;
        let [k11, k12, k22] = natural.rotations;
        let axial = natural.axial * stretch + c1.dot(t1) + c2.dot(t2);
        let conjugate = [
            k11 * t1 + k12 * t2 + c1 * stretch - bow.gradient[0] * axial,
            k12.transpose() * t1 + k22 * t2 + c2 * stretch - bow.gradient[1] * axial,
        ];
        let spins = self.rotations.map(inverse_spin_map);
        let moments = [0, 1].map(|end| spins[end].transpose() * conjugate[end]);
        let coupling = [0, 1].map(|end| natural.coupling[end] - bow.gradient[end] * natural.axial);
        let weigh = |own: DMat3, (row, column): (usize, usize)| {
            let block = own
                - outer(coupling[row], bow.gradient[column])
                - outer(bow.gradient[row], natural.coupling[column])
                - bow.hessian[row + column] * axial;
            spins[row].transpose() * block * spins[column]
        };
        let geometric =
            [0, 1].map(|end| moment_tangent(self.rotations[end], conjugate[end]) * spins[end]);
        let off = weigh(k12, (0, 1));
        Local {
            axial,
            axial_stiffness: natural.axial,
            coupling: [0, 1].map(|end| spins[end].transpose() * coupling[end]),
            moments,
            per_spin: [
                [weigh(k11, (0, 0)) + geometric[0], off],
                [off.transpose(), weigh(k22, (1, 1)) + geometric[1]],
            ],
        }
    }
}

/// Stiffness of an element and its shape at rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LocalStiffness {
    pub(crate) natural: NaturalStiffness,
    /// Length along the centre line [m].
    arc: f64,
    /// Rotation vectors of both ends from the chord at rest [rad]: of an element bent at rest not 0.
    rest: [DVec3; 2],
    /// Of the bow's length there.
    rest_gradient: [DVec3; 2],
}

/// How much longer the chord is than at rest because the ends have turned (mostly shorter), with its derivatives by the rotations.
struct Bow {
    length: f64,
    gradient: [DVec3; 2],
    /// By (1, 1), (1, 2), (2, 2).
    hessian: [DMat3; 3],
}

impl LocalStiffness {
    /// Of an element whose ends are turned from its axes by `rest` without load.
    pub(crate) fn new(element: &Element, rest: [DVec3; 2]) -> Self {
        let mut own = Self {
            natural: element.stiffness,
            arc: element.arc,
            rest,
            rest_gradient: [DVec3::ZERO; 2],
        };
        own.rest_gradient = own.bow([DVec3::ZERO; 2]).gradient;
        own
    }

    /// An arc's chord is shorter than the arc: of a circle by the sine of half its angle, of the S-shaped rest of a cubic by a tenth of
    /// the square of its rotation (beam.22). Without it a rolled-up beam becomes a polygon as long as the beam.
    fn bow(&self, rotations: [DVec3; 2]) -> Bow {
        let bent = |rotations: [DVec3; 2]| {
            let [first, second] = rotations.map(|rotation| rotation.with_x(0.0));
            ((second - first) * 0.5, (second + first) * 0.5)
        };
        let (half, lean) = bent(self.rest);
        let at_rest = chord_share(half) - 0.1 * lean.length_squared();
        let total = [0, 1].map(|end| self.rest[end] + rotations[end]);
        let (half, lean) = bent(total);
        let (first, second) = chord_share_derivatives(half);
        let across = DVec3::new(0.0, 1.0, 1.0);
        let by_half = half * first;
        let by_lean = lean * -0.2;
        let of_half = DMat3::from_diagonal(across * first) + outer(half, half) * second;
        let of_lean = DMat3::from_diagonal(across * -0.2);
        let scale = 0.5 * self.arc;
        let same = (of_half + of_lean) * (0.5 * scale);
        // What is linear in the rotations is part of the natural stiffness.
        let gradient = [
            (by_lean - by_half) * scale - self.rest_gradient[0],
            (by_lean + by_half) * scale - self.rest_gradient[1],
        ];
        let linear =
            self.rest_gradient[0].dot(rotations[0]) + self.rest_gradient[1].dot(rotations[1]);
        let longer = chord_share(half) - 0.1 * lean.length_squared() - at_rest;
        Bow {
            length: self.arc * longer - linear,
            gradient,
            hessian: [same, (of_lean - of_half) * (0.5 * scale), same],
        }
    }
}

/// sin(a)/a.
fn chord_share(half: DVec3) -> f64 {
    let square = half.length_squared();
    if square < 1e-6 {
        1.0 - square / 6.0 * (1.0 - square / 20.0)
    } else {
        let angle = square.sqrt();
        angle.sin() / angle
    }
}

/// Of sin(a)/a by the vector a: the gradient is the first times a, its derivative the first on the diagonal and the second times a aᵀ.
fn chord_share_derivatives(half: DVec3) -> (f64, f64) {
    let square = half.length_squared();
    if square < 1e-2 {
        let first = -1.0 / 3.0 + square / 30.0 * (1.0 - square / 28.0 * (1.0 - square / 54.0));
        let second = 1.0 / 15.0 - square / 210.0 * (1.0 - square / 36.0);
        (first, second)
    } else {
        let angle = square.sqrt();
        let share = angle.sin() / angle;
        let first = (angle.cos() - share) / square;
        (first, -(share + 3.0 * first) / square)
    }
}

fn outer(left: DVec3, right: DVec3) -> DMat3 {
    DMat3::from_cols(left * right.x, left * right.y, left * right.z)
}

/// Answer of an element to its deformation, in its axes.
struct Local {
    axial: f64,
    axial_stiffness: f64,
    /// Of the axial force per spin of each end relative to the element's axes, and of their moments per stretch.
    coupling: [DVec3; 2],
    /// Moments at both ends, conjugate to spins.
    moments: [DVec3; 2],
    /// Of moment i per spin of end j relative to the element's axes.
    per_spin: [[DMat3; 2]; 2],
}

/// Coefficients of a scalar: of the spins of both ends relative to the element's axes, or of the increments.
#[derive(Clone, Copy)]
struct Ends(DVec3, DVec3);

impl Frame {
    /// Blocks of the tangent: (d, d), (d, 1), (d, 2), (1, 1), (1, 2), (2, 2) for the force on the second node and the moments on both
    /// by the difference d of the end positions and the spins (beam.23).
    #[expect(
        clippy::too_many_lines,
        reason = "one kernel: its blocks share most of what they are made of"
    )]
    fn tangent(&self, local: &Local, roll: &Roll, forces: &[DVec3; 3]) -> [DMat3; 6] {
        let inverse = 1.0 / self.length;
        let [p1, p2] = roll.per_spin;
        let twist = local.moments[0].x + local.moments[1].x;
        let [[a11, a12], [a21, a22]] = local.per_spin;
        // Of the moments by d and by both spins.
        let (whole_1, whole_2) = (a11 + a12, a21 + a22);
        let by_d = |whole: &DMat3, coupling: DVec3| {
            DMat3::from_cols(
                coupling,
                (whole.x_axis * roll.lean.z + whole.z_axis) * -inverse,
                (whole.x_axis * roll.lean.y + whole.y_axis) * inverse,
            )
        };
        let sum_d = by_d(&(whole_1 + whole_2), local.coupling[0] + local.coupling[1]);
        let b11 = a11 - outer(whole_1.x_axis, p1);
        let b12 = a12 - outer(whole_1.x_axis, p2);
        let b21 = a21 - outer(whole_2.x_axis, p1);
        let b22 = a22 - outer(whole_2.x_axis, p2);
        let (sum_1, sum_2) = (b11 + b21, b12 + b22);
        let [lean_y, lean_z] = self.lean_variations();
        let net = local.coupling[0] + local.coupling[1];
        let force = forces[0];
        let around = DVec3::X.cross(force);
        let per_spin = |sum: &DMat3, coupling: DVec3, lean: [DVec3; 2], share: DVec3| {
            let y = sum.row(2) + sum.row(0) * roll.lean.z + lean[1] * twist;
            let z = sum.row(1) + sum.row(0) * roll.lean.y + lean[0] * twist;
            rows(coupling - share * net.x, y * -inverse, z * inverse) + outer(around, share)
        };
        let [by_y, by_z] = [lean_y, lean_z].map(|lean| Self::relative(roll, lean));
        let of_net = self.by_difference(roll, net);
        let [of_y, of_z] =
            [lean_y, lean_z].map(|lean| self.by_difference(roll, lean.0 + lean.1) * twist);
        let y = (sum_d.row(2) + sum_d.row(0) * roll.lean.z + of_z) * -inverse
            - DVec3::X * (force.y * inverse);
        let z = (sum_d.row(1) + sum_d.row(0) * roll.lean.y + of_y) * inverse
            - DVec3::X * (force.z * inverse);
        let turned = DMat3::from_cols(
            DVec3::ZERO,
            DVec3::new(roll.lean.z, 0.0, 1.0).cross(force) * inverse,
            DVec3::new(-roll.lean.y, -1.0, 0.0).cross(force) * inverse,
        );
        let dd = rows(of_net + DVec3::X * local.axial_stiffness, y, z) + turned;
        let d1 = per_spin(&sum_1, local.coupling[0], [by_y.0, by_z.0], p1);
        let d2 = per_spin(&sum_2, local.coupling[1], [by_y.1, by_z.1], p2);
        let of_shares = [self.share_variations(0), self.share_variations(1)];
        let shares = |end: usize, other: usize| {
            let pick = |axis: usize| {
                let of = Self::relative(roll, of_shares[end][axis]);
                if other == 0 { of.0 } else { of.1 }
            };
            rows(pick(0), pick(1), pick(2)) * -twist
        };
        let finish = |own: DMat3, sum: &DMat3, (end, other): (usize, usize)| {
            let (share, by) = (roll.per_spin[end], roll.per_spin[other]);
            own - outer(share, sum.row(0))
                + shares(end, other)
                + outer(DVec3::X.cross(forces[1 + end]), by)
        };
        [
            dd,
            d1,
            d2,
            finish(b11, &sum_1, (0, 0)),
            finish(b12, &sum_2, (0, 1)),
            finish(b22, &sum_2, (1, 1)),
        ]
    }

    /// By both spins, from coefficients of the spins relative to the element's axes.
    #[inline]
    fn relative(roll: &Roll, Ends(c1, c2): Ends) -> Ends {
        let along = c1.x + c2.x;
        Ends(c1 - roll.per_spin[0] * along, c2 - roll.per_spin[1] * along)
    }

    /// By the difference of the end positions, from the sum of those coefficients.
    #[inline]
    fn by_difference(&self, roll: &Roll, sum: DVec3) -> DVec3 {
        DVec3::new(
            0.0,
            -(roll.lean.z * sum.x + sum.z),
            roll.lean.y * sum.x + sum.y,
        ) / self.length
    }

    /// Variations of what the roll takes from the spin of an end.
    #[inline]
    fn share_variations(&self, end: usize) -> [Ends; 3] {
        let own = &self.sections[end];
        let (y, z) = (own.y_axis, own.z_axis);
        let place = |own: DVec3| {
            if end == 0 {
                Ends(own, DVec3::ZERO)
            } else {
                Ends(DVec3::ZERO, own)
            }
        };
        [
            self.quotient(place(per_alignment(own)), y.y + z.z),
            self.quotient(place(-per_x(y)), -y.x),
            self.quotient(place(-per_x(z)), -z.x),
        ]
    }

    /// Variations of the lean of the mean axes y and z.
    #[inline]
    fn lean_variations(&self) -> [Ends; 2] {
        let [first, second] = &self.sections;
        let of =
            |one: DVec3, two: DVec3| self.quotient(Ends(per_x(one), per_x(two)), one.x + two.x);
        [
            of(first.y_axis, second.y_axis),
            of(first.z_axis, second.z_axis),
        ]
    }

    /// Variation of a value over the alignment from that of the value.
    #[inline]
    fn quotient(&self, of_value: Ends, value: f64) -> Ends {
        let inverse = 1.0 / self.alignment();
        let ratio = value * inverse;
        let [first, second] = &self.sections;
        Ends(
            (of_value.0 - per_alignment(first) * ratio) * inverse,
            (of_value.1 - per_alignment(second) * ratio) * inverse,
        )
    }
}

/// Of `q_x` of an axis q by its spin φ, δq = φ × q.
#[inline]
fn per_x(q: DVec3) -> DVec3 {
    DVec3::new(0.0, q.z, -q.y)
}

/// Of `y_y` + `z_z` of a section's axes by its spin φ.
#[inline]
fn per_alignment(section: &DMat3) -> DVec3 {
    let (y, z) = (section.y_axis, section.z_axis);
    DVec3::new(z.y - y.z, -z.x, y.x)
}

#[inline]
fn rows(x: DVec3, y: DVec3, z: DVec3) -> DMat3 {
    DMat3::from_cols(x, y, z).transpose()
}

/// Rotation vector of a rotation matrix by less than three quarters of a half turn; `None` beyond.
fn rotation_vector(matrix: &DMat3) -> Option<DVec3> {
    let vector = DVec3::new(
        matrix.y_axis.z - matrix.z_axis.y,
        matrix.z_axis.x - matrix.x_axis.z,
        matrix.x_axis.y - matrix.y_axis.x,
    ) * 0.5;
    let sine = vector.length();
    let cosine = 0.5 * (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z - 1.0);
    if cosine.is_nan() || cosine < -0.7 {
        return None;
    }
    if sine < 1e-4 && cosine > 0.0 {
        // angle/sin(angle) = 1 + sin²/6 + …
        return Some(vector * (1.0 + sine * sine / 6.0));
    }
    Some(vector * (sine.atan2(cosine) / sine))
}

/// What takes a spin to the change of the rotation vector, T⁻¹(θ) = I − S/2 + c S² (beam.21).
pub(crate) fn inverse_spin_map(rotation: DVec3) -> DMat3 {
    let square = rotation.length_squared();
    let c = if square < 1e-2 {
        1.0 / 12.0 + square / 720.0 * (1.0 + square / 42.0)
    } else {
        let half = 0.5 * square.sqrt();
        (1.0 - half / half.tan()) / square
    };
    let s = cross_matrix(rotation);
    DMat3::IDENTITY - s * 0.5 + s * s * c
}

/// Change of T⁻ᵀ(θ) m per change of θ, m kept.
fn moment_tangent(rotation: DVec3, moment: DVec3) -> DMat3 {
    let square = rotation.length_squared();
    let eta = 1.0 / 12.0 + square / 720.0 * (1.0 + square / 42.0);
    let mu = 1.0 / 360.0 + square / 7560.0;
    let twice = rotation.cross(rotation.cross(moment));
    (outer(rotation, moment) - outer(moment, rotation) * 2.0
        + DMat3::from_diagonal(DVec3::splat(rotation.dot(moment))))
        * eta
        + outer(twice, rotation) * mu
        - cross_matrix(moment) * 0.5
}
