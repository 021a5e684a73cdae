//! What a tool can touch, and how a touch is reported.

use glam::DVec3;
use pliant_mesh::{ConvexMesh, Feature};
use pliant_spatial::Pose;

/// A convex object that stands still.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// Surface in the object's own frame [m].
    pub shape: ConvexMesh,
    /// Placement in the world.
    pub world_from_object: Pose,
    /// Force shading: across edges whose dihedral angle [rad] is below this, the direction of the force follows interpolated
    /// normals. `None`: the force keeps the direction of the plain contact normals.
    pub shading_threshold: Option<f64>,
}

/// One place where the visual tool presses on an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Index of the obstacle.
    pub object: u32,
    /// Index of the tool segment: the Contact Element of this obstacle.
    pub segment: u32,
    /// Centre of the touching patch, world [m].
    pub point: DVec3,
    /// Unit, world, out of the obstacle.
    pub normal: DVec3,
    /// What is touched on the obstacle.
    pub feature: Feature,
    /// Share of this contact in the coupling's displacement [m]: times the coupling stiffness it is the contact force.
    pub share: f64,
}
