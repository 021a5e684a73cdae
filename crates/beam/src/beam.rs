//! A beam as the methods of this crate see it: nodes along its rest shape and elements with their flexibilities.
//!
//! Frame: the root section's. The root is at the origin and clamped; x runs along the centre line there, y and z are the
//! section's axes. A tool's handle adds its own pose on top.

use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::{Pose, quaternion_from_rotation_vector};

use crate::element::stiffness_12;
use crate::error::{BeamError, demand, finite, positive};
use crate::flexibility::ElementFlexibility;
use crate::material::Material;
use crate::natural::NaturalStiffness;
use crate::profile::{MOST_ROWS, Profile};
use crate::section::Shape;

/// Most elements: beyond, the stiffness method loses its digits as (length/element)⁴ (docs/theory/beam.md).
pub const MOST_ELEMENTS: usize = 400;

/// How far the y axes of an element's ends must agree across its chord, 1 if they are one and 0 if half a turn lies between: near 0
/// nothing is halfway.
const LEAST_AGREEMENT: f64 = 0.05;

/// What a beam is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamSpec {
    /// Length along the centre line [m].
    pub length: f64,
    /// Sections along it.
    pub profile: Profile,
    /// What it is made of.
    pub material: Material,
    /// Where nodes are.
    pub division: Division,
    /// Its shape without load.
    pub rest: Rest,
    /// Whether sections shear.
    pub shear: Shear,
}

/// Nodes along a beam.
#[derive(Clone, Debug, PartialEq)]
pub enum Division {
    /// So many elements of one length.
    Equal(usize),
    /// Lengths of the elements from the root on [m]; they add up to the beam's.
    Lengths(Vec<f64>),
}

/// Shape without load: how the section frame turns along the centre line.
#[derive(Clone, Debug, PartialEq)]
pub enum Rest {
    /// Along x.
    Straight,
    /// The same curvature everywhere, in the section's frame: twist about x, bending about y and z [rad/m].
    Curved(DVec3),
    /// Curvature from each station s [m] on, in the section's frame [rad/m]; straight before the first.
    Table(Vec<(f64, DVec3)>),
}

/// Theory of bending.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shear {
    /// Sections stay square to the centre line (Euler–Bernoulli).
    #[default]
    Rigid,
    /// Sections shear with their shear areas (Timoshenko).
    Flexible,
}

/// An element between two nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Element {
    /// Arc position of its first node [m].
    pub start: f64,
    /// Length along the centre line [m].
    pub arc: f64,
    /// Distance of its nodes at rest [m].
    pub chord: f64,
    /// At rest: x along the chord, y and z halfway between those of its ends.
    pub rest: DMat3,
    /// How it gives way, taken as straight.
    pub flexibility: ElementFlexibility,
    /// What it answers to its own deformations.
    pub stiffness: NaturalStiffness,
}

/// A beam without faults, divided into elements.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    spec: BeamSpec,
    elements: Vec<Element>,
    /// Of the nodes at rest, in the root's frame.
    nodes: Vec<Pose>,
}

impl Beam {
    /// Checks a beam and works out its elements.
    ///
    /// # Errors
    /// [`BeamError`], with the name of the field at fault.
    pub fn new(spec: BeamSpec) -> Result<Self, BeamError> {
        positive("length", spec.length)?;
        spec.material.check()?;
        spec.profile.check()?;
        spec.rest.check()?;
        let stations = spec.division.stations(spec.length)?;
        let nodes = rest_nodes(&spec.rest, &stations);
        let mut elements = Vec::with_capacity(stations.len() - 1);
        for (ends, poses) in stations.windows(2).zip(nodes.windows(2)) {
            let element = Element::between([ends[0], ends[1]], [&poses[0], &poses[1]], &spec)?;
            element.check(elements.len())?;
            elements.push(element);
        }
        Ok(Self {
            spec,
            elements,
            nodes,
        })
    }

    /// What it was made from.
    pub fn spec(&self) -> &BeamSpec {
        &self.spec
    }

    /// Length along the centre line [m].
    pub fn length(&self) -> f64 {
        self.spec.length
    }

    /// From root to tip.
    pub fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Poses of the nodes at rest, in the root's frame; one more than elements.
    pub fn nodes(&self) -> &[Pose] {
        &self.nodes
    }

    /// Section at an arc position [m].
    pub fn shape_at(&self, s: f64) -> Shape {
        self.spec.profile.at(s, self.spec.length)
    }

    /// The element that an arc position [m] is in, and how far along it, 0 to 1. Positions beyond an end count as the end.
    pub fn locate(&self, s: f64) -> (usize, f64) {
        let after = self
            .elements
            .partition_point(|element| element.start + element.arc < s);
        let index = after.min(self.elements.len() - 1);
        let element = &self.elements[index];
        (index, ((s - element.start) / element.arc).clamp(0.0, 1.0))
    }

    /// Pose at rest of the section at arc position `s` [m] of element `index`, in the root's frame.
    pub(crate) fn rest_from(&self, index: usize, s: f64) -> Pose {
        self.nodes[index] * self.spec.rest.between(self.elements[index].start, s)
    }

    /// Whether it is straight at rest.
    pub fn is_straight(&self) -> bool {
        self.spec.rest == Rest::Straight
    }

    /// Mass [kg].
    pub fn mass(&self) -> f64 {
        let volume: f64 = self
            .elements
            .iter()
            .map(|element| element.flexibility.volume)
            .sum();
        volume * self.spec.material.density
    }
}

impl BeamSpec {
    /// Parts of the arc between two positions [m] within which section and curvature are smooth: between the stations of their tables.
    pub(crate) fn pieces(&self, [start, end]: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let mut from = start;
        std::iter::from_fn(move || {
            let next = |station: Option<f64>| station.unwrap_or(end).min(end);
            let to =
                next(self.profile.station_after(from)).min(next(self.rest.station_after(from)));
            let piece = [from, to];
            from = to;
            (piece[0] < piece[1]).then_some(piece)
        })
    }
}

impl Division {
    /// Arc positions of the nodes, the first 0 and the last the length.
    fn stations(&self, length: f64) -> Result<Vec<f64>, BeamError> {
        let count = match self {
            Self::Equal(count) => *count,
            Self::Lengths(lengths) => lengths.len(),
        };
        if count == 0 || count > MOST_ELEMENTS {
            return Err(BeamError::Count {
                field: "division",
                value: count,
                least: 1,
                most: MOST_ELEMENTS,
            });
        }
        let Self::Lengths(lengths) = self else {
            let at = |index: usize| length * index as f64 / count as f64;
            return Ok((0..=count).map(at).collect());
        };
        let mut stations = vec![0.0];
        let mut end = 0.0;
        for (index, part) in lengths.iter().enumerate() {
            positive(format!("division[{index}]"), *part)?;
            end += part;
            stations.push(end);
        }
        let fits = (end - length).abs() <= 1e-9 * length;
        demand("division (sum)", end, fits, "the beam's length")?;
        // What rounding left over is shared by all: taken off the last part, it could turn it round.
        let scale = length / end;
        for station in &mut stations {
            *station *= scale;
        }
        stations[count] = length;
        for (index, ends) in stations.windows(2).enumerate() {
            demand(
                format!("division[{index}]"),
                lengths[index],
                ends[1] > ends[0],
                "long enough to tell the ends of the element apart",
            )?;
        }
        Ok(stations)
    }
}

impl Rest {
    fn check(&self) -> Result<(), BeamError> {
        let check = |field: &str, curvature: &DVec3| {
            ["twist", "about y", "about z"]
                .iter()
                .zip(curvature.to_array())
                .try_for_each(|(part, value)| finite(format!("{field} ({part})"), value))
        };
        match self {
            Self::Straight => Ok(()),
            Self::Curved(curvature) => check("rest", curvature),
            Self::Table(rows) => {
                if rows.len() > MOST_ROWS {
                    return Err(BeamError::Count {
                        field: "rest",
                        value: rows.len(),
                        least: 0,
                        most: MOST_ROWS,
                    });
                }
                let mut last = f64::NEG_INFINITY;
                for (index, (station, curvature)) in rows.iter().enumerate() {
                    let field = format!("rest[{index}]");
                    let ascends = *station >= last;
                    demand(
                        format!("{field}.station"),
                        *station,
                        ascends,
                        "finite and not before the row above",
                    )?;
                    check(&field, curvature)?;
                    last = *station;
                }
                Ok(())
            }
        }
    }

    /// The first station beyond an arc position [m].
    fn station_after(&self, s: f64) -> Option<f64> {
        let Self::Table(rows) = self else {
            return None;
        };
        let next = rows.partition_point(|(station, _)| *station <= s);
        rows.get(next).map(|(station, _)| *station)
    }

    /// Pose of the section at arc `to` relative to the one at `from`, within which the curvature may step.
    pub(crate) fn between(&self, from: f64, to: f64) -> Pose {
        match self {
            Self::Straight => Pose::new(DQuat::IDENTITY, DVec3::X * (to - from)),
            Self::Curved(curvature) => helix(*curvature, to - from),
            Self::Table(rows) => {
                let mut pose = Pose::IDENTITY;
                let (mut at, mut curvature) = (from, DVec3::ZERO);
                for (station, next) in rows {
                    if *station > at && *station < to {
                        pose = pose * helix(curvature, station - at);
                        at = *station;
                    }
                    if *station <= at {
                        curvature = *next;
                    }
                }
                pose * helix(curvature, to - at)
            }
        }
    }
}

/// Pose at the end of an arc of constant curvature in its own frame: a helix about the curvature's axis.
fn helix(curvature: DVec3, arc: f64) -> Pose {
    let turn = curvature * arc;
    let angle = turn.length();
    let rotation = quaternion_from_rotation_vector(turn);
    // ∫ exp(tS) dt = I + (1 − cos θ)/θ² S + (θ − sin θ)/θ³ S², by series near 0.
    let (first, second) = if angle < 1e-2 {
        let square = angle * angle;
        (
            0.5 - square / 24.0 * (1.0 - square / 30.0),
            1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0),
        )
    } else {
        (
            2.0 * (0.5 * angle).sin().powi(2) / angle.powi(2),
            (angle - angle.sin()) / angle.powi(3),
        )
    };
    let across = turn.cross(DVec3::X);
    let chord = DVec3::X + across * first + turn.cross(across) * second;
    Pose::new(rotation, chord * arc)
}

fn rest_nodes(rest: &Rest, stations: &[f64]) -> Vec<Pose> {
    let mut pose = Pose::IDENTITY;
    let mut nodes = vec![pose];
    for ends in stations.windows(2) {
        pose = pose * rest.between(ends[0], ends[1]);
        pose.rotation = pose.rotation.normalize();
        nodes.push(pose);
    }
    nodes
}

impl Element {
    fn between(ends: [f64; 2], poses: [&Pose; 2], spec: &BeamSpec) -> Result<Self, BeamError> {
        let along = poses[1].translation - poses[0].translation;
        let chord = along.length();
        let arc = ends[1] - ends[0];
        // A chord much shorter than its arc goes round more than half a circle.
        demand(
            "division (an element's chord / arc)",
            chord / arc,
            chord >= 0.5 * arc,
            "at least 0.5: divide the curved part more finely",
        )?;
        let x = along / chord;
        let both = |axis: DVec3| poses[0].rotation * axis + poses[1].rotation * axis;
        let y = both(DVec3::Y) + both(DVec3::Z).cross(x);
        let z = x.cross(y);
        demand(
            "division (twist of an element: how far its ends agree on y)",
            0.5 * z.length(),
            0.5 * z.length() > LEAST_AGREEMENT,
            "more than 0.05: divide the twisted part more finely",
        )?;
        let z = z.normalize();
        let rest = DMat3::from_cols(x, z.cross(x), z);
        let flexibility = ElementFlexibility::new(ends, 1.0, spec);
        let mut element = Self {
            start: ends[0],
            arc,
            // Of a straight beam they are one length.
            chord: if spec.rest == Rest::Straight {
                arc
            } else {
                chord
            },
            rest,
            stiffness: NaturalStiffness::straight(&flexibility, arc),
            flexibility,
        };
        if spec.rest != Rest::Straight {
            let first = DQuat::from_mat3(&rest).inverse() * poses[0].rotation;
            element.stiffness = NaturalStiffness::bent(&element, spec, first);
        }
        Ok(element)
    }
    /// An error unless its stiffness is within the range of numbers.
    fn check(&self, index: usize) -> Result<(), BeamError> {
        let stiffness = stiffness_12(self);
        for (row, values) in stiffness.iter().enumerate() {
            for (column, value) in values.iter().enumerate() {
                if !value.is_finite() || (row == column && *value <= 0.0) {
                    return Err(BeamError::Value {
                        field: format!("profile (stiffness of element {index})"),
                        value: *value,
                        demand: "finite and above 0: lengths, sections or moduli are out of range",
                    });
                }
            }
        }
        Ok(())
    }
}
