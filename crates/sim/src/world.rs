//! What stays the same from tick to tick.

use pliant_contact::{Obstacle, PaperParameters};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;
use thiserror::Error;

/// A rigid tool: convex segments in the handle frame (origin at the clamp, +x along the tool to its tip) [m].
#[derive(Clone, Debug)]
pub struct Tool {
    /// At least one.
    pub segments: Vec<ConvexMesh>,
}

/// A convex object that stands still.
#[derive(Clone, Debug)]
pub struct Object {
    /// Name in the scene, for messages.
    pub name: String,
    /// Surface in the object's own frame [m].
    pub shape: ConvexMesh,
    /// Placement in the world.
    pub world_from_object: Pose,
    /// Force shading across edges flatter than this dihedral angle [rad]; `None`: none.
    pub shading_threshold: Option<f64>,
}

/// Spring-damper between the haptic tool and the visual tool. Only the spring part is rendered: damping leaves the steady force as it is,
/// and after release the visual tool lags and the force decays over b/k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VirtualCoupling {
    /// [N/m], positive.
    pub linear_stiffness: f64,
    /// [N·m/rad]; infinite: the visual tool's orientation follows the haptic tool's.
    pub angular_stiffness: f64,
    /// Acts on the motion of the visual tool relative to the haptic tool [N·s/m], not negative.
    pub linear_damping: f64,
    /// Without effect while orientation follows [N·m·s/rad], not negative.
    pub angular_damping: f64,
}

impl Default for VirtualCoupling {
    /// 1000 N/m, undamped, orientation follows.
    fn default() -> Self {
        Self {
            linear_stiffness: 1000.0,
            angular_stiffness: f64::INFINITY,
            linear_damping: 0.0,
            angular_damping: 0.0,
        }
    }
}

/// How contact is found and held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Certified separating planes, solved together.
    Constrained,
    /// The tracking of Laycock & Day (2003).
    Paper(PaperParameters),
}

/// Ingredients of a [`World`].
#[derive(Clone, Debug)]
pub struct WorldDescription {
    /// The tool in the hand.
    pub tool: Tool,
    /// Everything it can touch.
    pub objects: Vec<Object>,
    /// Between hand and tool.
    pub coupling: VirtualCoupling,
    /// Contact method.
    pub method: Method,
}

/// Why a description is no world.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum WorldError {
    /// The tool has no segment.
    #[error("the tool has no segments; give it at least one convex segment")]
    NoSegments,
    /// A coupling constant is out of range.
    #[error("coupling {name} is {value:?}; {expected}")]
    Coupling {
        /// Name of the constant.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
    /// A placement is not finite or its rotation is not a unit quaternion.
    #[error("object {object:?} has an invalid pose; give finite numbers and a unit quaternion")]
    Pose {
        /// Name of the object.
        object: String,
    },
    /// A shading threshold is out of range.
    #[error(
        "object {object:?} has a shading threshold of {value:?} rad; expected more than 0 and at most π"
    )]
    Shading {
        /// Name of the object.
        object: String,
        /// What was given [rad].
        value: f64,
    },
    /// A parameter of the paper's method is out of range.
    #[error("paper method: {name} is {value:?}; {expected}")]
    Paper {
        /// Name of the parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        expected: &'static str,
    },
}

/// Tool, objects, coupling and method, checked.
#[derive(Clone, Debug)]
pub struct World {
    tool: Tool,
    names: Vec<String>,
    obstacles: Vec<Obstacle>,
    coupling: VirtualCoupling,
    method: Method,
}

impl World {
    /// Checks a description.
    ///
    /// # Errors
    /// [`WorldError`] names the first value that is out of range.
    pub fn new(description: WorldDescription) -> Result<Self, WorldError> {
        let WorldDescription {
            tool,
            objects,
            coupling,
            method,
        } = description;
        if tool.segments.is_empty() {
            return Err(WorldError::NoSegments);
        }
        check_coupling(&coupling)?;
        check_method(&method)?;
        let mut names = Vec::with_capacity(objects.len());
        let mut obstacles = Vec::with_capacity(objects.len());
        for object in objects {
            check_object(&object)?;
            names.push(object.name);
            obstacles.push(Obstacle {
                shape: object.shape,
                world_from_object: object.world_from_object,
                shading_threshold: object.shading_threshold,
            });
        }
        Ok(Self {
            tool,
            names,
            obstacles,
            coupling,
            method,
        })
    }

    /// The tool in the hand.
    pub fn tool(&self) -> &Tool {
        &self.tool
    }

    /// Everything it can touch, in the order of the description.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// Names of the obstacles, in the same order.
    pub fn object_names(&self) -> &[String] {
        &self.names
    }

    /// Spring-damper between the two tools.
    pub fn coupling(&self) -> &VirtualCoupling {
        &self.coupling
    }

    /// Contact method.
    pub fn method(&self) -> &Method {
        &self.method
    }
}

fn check_coupling(coupling: &VirtualCoupling) -> Result<(), WorldError> {
    let error = |name, value, expected| {
        Err(WorldError::Coupling {
            name,
            value,
            expected,
        })
    };
    let k = coupling.linear_stiffness;
    if !(k.is_finite() && k > 0.0) {
        return error("linear_stiffness", k, "expected a positive number of N/m");
    }
    if coupling.angular_stiffness != f64::INFINITY {
        return error(
            "angular_stiffness",
            coupling.angular_stiffness,
            "expected infinity: the orientation of a rigid tool follows the hand",
        );
    }
    for (name, b) in [
        ("linear_damping", coupling.linear_damping),
        ("angular_damping", coupling.angular_damping),
    ] {
        if !(b.is_finite() && b >= 0.0) {
            return error(name, b, "expected zero or a positive number");
        }
    }
    Ok(())
}

fn check_method(method: &Method) -> Result<(), WorldError> {
    let Method::Paper(parameters) = method else {
        return Ok(());
    };
    if !(parameters.edge_width.is_finite() && parameters.edge_width >= 0.0) {
        return Err(WorldError::Paper {
            name: "edge_width",
            value: parameters.edge_width,
            expected: "expected zero or a positive number of metres",
        });
    }
    if parameters.detection_interval == 0 {
        return Err(WorldError::Paper {
            name: "detection_interval",
            value: 0.0,
            expected: "expected 1 (every tick) or more",
        });
    }
    Ok(())
}

fn check_object(object: &Object) -> Result<(), WorldError> {
    let pose = &object.world_from_object;
    if !pose.is_finite() || (pose.rotation.length() - 1.0).abs() > 1e-9 {
        return Err(WorldError::Pose {
            object: object.name.clone(),
        });
    }
    match object.shading_threshold {
        Some(value) if !(value > 0.0 && value <= std::f64::consts::PI) => {
            Err(WorldError::Shading {
                object: object.name.clone(),
                value,
            })
        }
        _ => Ok(()),
    }
}
