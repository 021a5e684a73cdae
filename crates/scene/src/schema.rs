//! What a scene file may say: SI units, unknown fields refused, defaults written here and nowhere else.

mod shape;
mod tool;

use glam::DQuat;
use pliant_spatial::Pose;
use serde::{Deserialize, Serialize};

pub use self::shape::{Bands, MeshFile, Sectors, ShapeDescription, Unit};
pub use self::tool::{ToolDescription, ToolShape};
use crate::quantity::{
    Count, Damping, Degrees, Direction, Duration, Factor, Length, Stiffness, ThresholdDegrees,
    Vector,
};

/// A whole scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "Scene")]
pub struct SceneDescription {
    /// What the scene shows, for people.
    #[serde(default)]
    pub description: String,
    /// Servo ticks a second [Hz]; 1000.
    #[serde(default = "default_rate")]
    pub rate_hz: Count<500, 10_000>,
    /// How long a run lasts [s]; the trajectory's duration.
    #[serde(default)]
    pub seconds: Option<Duration>,
    /// How contact is resolved; `constrained`.
    #[serde(default)]
    pub method: MethodName,
    /// Parameters of the method `paper`.
    #[serde(default)]
    pub paper: PaperDescription,
    /// Spring-damper between the haptic and the visual tool.
    #[serde(default)]
    pub coupling: CouplingDescription,
    /// What the hand holds.
    pub tool: ToolDescription,
    /// What can be touched.
    pub objects: Vec<ObjectDescription>,
    /// Where the hand's motion comes from; `scripted`.
    #[serde(default)]
    pub device: DeviceName,
    /// Where the device's workspace lies in the world.
    #[serde(default)]
    pub workspace: WorkspaceDescription,
    /// The recorded motion of the handle.
    pub trajectory: TrajectoryDescription,
}

/// Contact methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename = "method", rename_all = "snake_case")]
pub enum MethodName {
    /// Certified separating planes, all solved together.
    #[default]
    Constrained,
    /// The published method, kept faithful for comparison.
    Paper,
}

impl MethodName {
    /// As scene files and the command line write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Constrained => "constrained",
            Self::Paper => "paper",
        }
    }
}

/// Parameters of the published method.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "paper")]
pub struct PaperDescription {
    /// Width of the strip that stands for an edge [m]; 1e-4.
    pub edge_width: Length,
    /// Collision is detected every so many ticks, 1 or 2; 1.
    pub detection_interval: Count<1, 2>,
}

/// The virtual coupling. Only its spring is rendered: damping does not change the steady force in contact; after release
/// the force decays over b/k.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "coupling")]
pub struct CouplingDescription {
    /// [N/m]; 1000.
    pub linear_stiffness: Factor,
    /// [N·m/rad]; `inf`: the visual tool's orientation follows the hand.
    pub angular_stiffness: Stiffness,
    /// [N·s/m]; 0.
    pub linear_damping: Damping,
    /// [N·m·s/rad]; 0.
    pub angular_damping: Damping,
}

/// One object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "object")]
pub struct ObjectDescription {
    /// Names the object in results; not empty, and no other object has it.
    pub name: String,
    /// Its surface, in its own frame.
    pub shape: ShapeDescription,
    /// Placement in the world; at the origin.
    #[serde(default)]
    pub pose: PoseDescription,
    /// Edges flatter than this feel smooth [degrees]; absent: every edge is felt.
    #[serde(default)]
    pub shading_threshold_deg: Option<ThresholdDegrees>,
}

/// Sources of motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename = "device", rename_all = "snake_case")]
pub enum DeviceName {
    /// The trajectory, open loop: forces do not move the hand.
    #[default]
    Scripted,
}

/// The map from the device's workspace to the world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "workspace")]
pub struct WorkspaceDescription {
    /// The device's frame in the world.
    pub pose: PoseDescription,
    /// World metres per device metre; 1.
    pub position_scale: Factor,
    /// Device newtons per world newton; 1.
    pub force_scale: Factor,
}

/// A recorded motion and where to put it.
///
/// The samples are joined by a C² cubic spline in position and by slerp in orientation. The spline swings past sparse
/// samples: record at 20 Hz or more, or repeat the pose where the hand rests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "trajectory")]
pub struct TrajectoryDescription {
    /// CSV file, relative to the scene file.
    pub path: String,
    /// Recorded positions are multiplied by this, about the recording's origin; 1.
    #[serde(default)]
    pub scale: Factor,
    /// The recording's frame in that of the device, after scaling.
    #[serde(default)]
    pub pose: PoseDescription,
    /// Played this many times as fast; 1.
    #[serde(default)]
    pub speed: Factor,
}

/// A placement: turned about its own origin, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "pose")]
pub struct PoseDescription {
    /// Where the origin goes [m].
    pub position: Vector,
    /// How it is turned; not at all.
    pub rotation: RotationDescription,
}

/// A rotation about an axis, right-handed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename = "rotation")]
pub struct RotationDescription {
    /// Axis, of any length but zero.
    pub axis: Direction,
    /// Angle [degrees].
    pub angle_deg: Degrees,
}

impl PoseDescription {
    /// `outer_from_inner`.
    pub fn pose(&self) -> Pose {
        let RotationDescription { axis, angle_deg } = self.rotation;
        Pose::new(
            DQuat::from_axis_angle(axis.unit(), angle_deg.get().to_radians()),
            self.position.0,
        )
    }
}

fn default_rate() -> Count<500, 10_000> {
    Count::new(1000)
}

impl Default for PaperDescription {
    fn default() -> Self {
        Self {
            edge_width: Length::EDGE_WIDTH,
            detection_interval: Count::new(1),
        }
    }
}

impl Default for CouplingDescription {
    fn default() -> Self {
        Self {
            linear_stiffness: Factor::LINEAR_STIFFNESS,
            angular_stiffness: Stiffness::RIGID,
            linear_damping: Damping::default(),
            angular_damping: Damping::default(),
        }
    }
}
