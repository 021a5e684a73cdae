//! Loads on a beam.

use glam::DVec3;

/// A force and a moment on the centre line, in the root's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Load {
    /// Arc position [m].
    pub s: f64,
    /// [N].
    pub force: DVec3,
    /// [N·m].
    pub moment: DVec3,
}

/// All that acts on a beam besides its clamp.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Loading<'l> {
    /// At single points, in any order.
    pub points: &'l [Load],
    /// The same on every metre, as of weight [N/m].
    pub line: DVec3,
}

/// How a section has moved, by small-displacement theory, in the root's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Displacement {
    /// Of the centre line [m].
    pub translation: DVec3,
    /// Of the section [rad].
    pub rotation: DVec3,
}

/// Force and moment that the part towards the tip exerts through a section on the part towards the root, about the centre line's
/// point there, in the root's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SectionForces {
    /// [N].
    pub force: DVec3,
    /// [N·m].
    pub moment: DVec3,
}

impl Loading<'_> {
    /// Section forces of the undeformed straight beam of a `length` [m], just on the root's side of a load at `s`: equilibrium
    /// of what lies beyond.
    pub fn section_forces(&self, s: f64, length: f64) -> SectionForces {
        let rest = length - s;
        let mut forces = SectionForces {
            force: self.line * rest,
            moment: DVec3::X.cross(self.line) * (0.5 * rest * rest),
        };
        for load in self.points.iter().filter(|load| load.s >= s) {
            forces.force += load.force;
            forces.moment += load.moment + DVec3::X.cross(load.force) * (load.s - s);
        }
        forces
    }
}
