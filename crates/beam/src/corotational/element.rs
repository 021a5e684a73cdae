//! One co-rotational element: forces and full tangent (beam.20 to beam.23).
//!
//! Element-independent co-rotational formulation of Nour-Omid & Rankin (1991) with the element frame of Battini & Pacoste
//! (2002): x along the chord, y between the section axes of both ends. Departing from them, the variation of that frame's roll is
//! kept in the tangent, so Newton converges quadratically and the assembled tangent is symmetric at equilibrium.
//!
//! Everything is written in the element's axes for nine increments: the difference d of the end positions, and the spins of both
//! ends. Forces on the first node are minus those on the second.

use glam::{DMat3, DVec3};

use crate::beam::Element;
use crate::closed_form::cross_matrix;
use crate::natural::NaturalStiffness;

/// Placement of an element and its deformation.
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
    /// Section y axes of both ends, in the element's axes.
    y_axes: [DVec3; 2],
}

/// How the element's axes turn per increment, in these axes: the spin is `roll` about x, d_z about −y and d_y about z, by length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Roll {
    /// e = q_x/q_y of the mean section axis q: per d_z, −e/length.
    pub(crate) lean: f64,
    /// Per spin of either end.
    pub(crate) per_spin: [DVec3; 2],
}

/// A row of coefficients of the nine increments.
pub(crate) type Row = [f64; 9];

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
        let mean = sections[0].y_axis + sections[1].y_axis;
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
            y_axes: [local[0].y_axis, local[1].y_axis],
        })
    }

    /// How the axes turn.
    pub(crate) fn roll(&self) -> Roll {
        let [q1, q2] = self.y_axes;
        let half = 0.5 / (0.5 * (q1.y + q2.y));
        Roll {
            lean: (q1.x + q2.x) * half,
            per_spin: [q1, q2].map(|q| DVec3::new(q.y, -q.x, 0.0) * half),
        }
    }

    /// Forces and, in all nine increments, the tangent.
    pub(crate) fn response(&self, stiffness: &LocalStiffness) -> Response {
        let local = self.local(stiffness);
        let roll = self.roll();
        let rows = Rows {
            frame: self,
            roll: &roll,
        };
        let forces = self.forces(&local, &roll);
        let spin = rows.spin();
        let tangent = rows.tangent(&local, &forces, &spin);
        let turned = |block: DMat3| self.axes * block * self.axes.transpose();
        Response {
            forces: forces.map(|force| self.axes * force),
            tangent: tangent.map(|row| row.map(turned)),
        }
    }

    /// Forces in the element's axes.
    fn forces(&self, local: &Local, roll: &Roll) -> [DVec3; 3] {
        let moment = local.moments[0] + local.moments[1];
        let force = DVec3::new(
            local.axial,
            -moment.z / self.length,
            (moment.y + roll.lean * moment.x) / self.length,
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

struct Rows<'f> {
    frame: &'f Frame,
    roll: &'f Roll,
}

impl Rows<'_> {
    /// The spin of the element's axes.
    fn spin(&self) -> [Row; 3] {
        let inverse = 1.0 / self.frame.length;
        let [p1, p2] = self.roll.per_spin;
        let mut rows = [[0.0; 9]; 3];
        rows[0][2] = -self.roll.lean * inverse;
        rows[0][3..6].copy_from_slice(&p1.to_array());
        rows[0][6..9].copy_from_slice(&p2.to_array());
        rows[1][2] = -inverse;
        rows[2][1] = inverse;
        rows
    }

    /// Coefficients of the increments from those of the spins of both ends relative to the element's axes.
    fn relative(&self, [c1, c2]: [DVec3; 2]) -> Row {
        let sum = c1 + c2;
        let inverse = 1.0 / self.frame.length;
        let [p1, p2] = self.roll.per_spin;
        let (first, second) = (c1 - p1 * sum.x, c2 - p2 * sum.x);
        [
            0.0,
            -sum.z * inverse,
            (self.roll.lean * sum.x + sum.y) * inverse,
            first.x,
            first.y,
            first.z,
            second.x,
            second.y,
            second.z,
        ]
    }

    /// Variations of q_x/m and q_y/m of the section axes q of both ends, and of the mean axis, m its y: what the roll depends on.
    fn axis_variations(&self) -> ([[Row; 2]; 2], Row) {
        let [q1, q2] = self.frame.y_axes;
        let mean = 0.5 * (q1 + q2);
        let inverse = 1.0 / mean.y;
        // δq = φ × q.
        let per_x = |q: DVec3| DVec3::new(0.0, q.z, -q.y);
        let per_y = |q: DVec3| DVec3::new(-q.z, 0.0, q.x);
        let mean_y = [per_y(q1) * 0.5, per_y(q2) * 0.5];
        let quotient = |own: [DVec3; 2], value: f64| {
            let ratio = value * inverse;
            self.relative([0, 1].map(|end| (own[end] - mean_y[end] * ratio) * inverse))
        };
        let zero = DVec3::ZERO;
        let ends = [
            [
                quotient([per_x(q1), zero], q1.x),
                quotient([per_y(q1), zero], q1.y),
            ],
            [
                quotient([zero, per_x(q2)], q2.x),
                quotient([zero, per_y(q2)], q2.y),
            ],
        ];
        let lean = quotient([per_x(q1) * 0.5, per_x(q2) * 0.5], mean.x);
        (ends, lean)
    }

    fn tangent(&self, local: &Local, forces: &[DVec3; 3], spin: &[Row; 3]) -> [[DMat3; 3]; 3] {
        let length = self.frame.length;
        let inverse = 1.0 / length;
        let moment = local.moments[0] + local.moments[1];
        let moments = [0, 1].map(|end| {
            let [to_first, to_second] = &local.per_spin[end];
            [0, 1, 2].map(|axis| {
                let mut row = self.relative([to_first.row(axis), to_second.row(axis)]);
                row[0] = local.coupling[end][axis];
                row
            })
        });
        let total = [0, 1, 2].map(|axis| sum(&moments[0][axis], &moments[1][axis], 1.0));
        let (axes, lean) = self.axis_variations();
        let mut rows = [[0.0; 9]; 9];
        rows[0] = self.relative(local.coupling);
        rows[0][0] = local.axial_stiffness;
        rows[1] = scaled(&total[2], -inverse);
        rows[1][0] += moment.z * inverse * inverse;
        rows[2] = sum(&total[1], &total[0], self.roll.lean);
        rows[2] = scaled(&sum(&rows[2], &lean, moment.x), inverse);
        rows[2][0] -= forces[0].z * inverse;
        for end in 0..2 {
            let share = self.roll.per_spin[end];
            for axis in 0..3 {
                rows[3 + 3 * end + axis] = sum(&moments[end][axis], &total[0], -share[axis]);
            }
            // share = ½ (q_y, −q_x, 0)/m.
            let (x, y) = (3 + 3 * end, 4 + 3 * end);
            rows[x] = sum(&rows[x], &axes[end][1], -0.5 * moment.x);
            rows[y] = sum(&rows[y], &axes[end][0], 0.5 * moment.x);
        }
        for (block, force) in forces.iter().enumerate() {
            let [x, y, z] = spin;
            let turned = [
                sum(&scaled(y, force.z), z, -force.y),
                sum(&scaled(z, force.x), x, -force.z),
                sum(&scaled(x, force.y), y, -force.x),
            ];
            for (axis, turned) in turned.iter().enumerate() {
                let row = &mut rows[3 * block + axis];
                *row = sum(row, turned, 1.0);
            }
        }
        [0, 1, 2].map(|row| {
            [0, 1, 2].map(|column| {
                DMat3::from_cols_array_2d(
                    &[0, 1, 2].map(|j| [0, 1, 2].map(|i| rows[3 * row + i][3 * column + j])),
                )
            })
        })
    }
}

fn sum(left: &Row, right: &Row, factor: f64) -> Row {
    std::array::from_fn(|index| left[index] + factor * right[index])
}

fn scaled(row: &Row, factor: f64) -> Row {
    row.map(|value| value * factor)
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

/// What takes a spin to the change of the rotation vector, T⁻¹(θ) = I − S/2 + c S².
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
