//! From a scene description to a world, its motion and its device: reads the files that the scene names.

mod shape;
mod slices;
mod tool;

use std::path::{Path, PathBuf};

use pliant_contact::PaperParameters;
use pliant_device::{ScriptedDevice, Trajectory, WorkspaceMap};
use pliant_sim::{Method, Object, Tool, VirtualCoupling, World, WorldDescription, WorldError};

use self::shape::FaceBudget;
use crate::error::{Fault, SceneError, shortened};
use crate::files::Files;
use crate::scene::Scene;
use crate::schema::{MethodName, ObjectDescription};
use crate::trajectory_file::{in_words, read_trajectory};

/// A scene that is ready to run.
#[derive(Clone, Debug)]
pub struct BuiltScene {
    /// What is touched, and with what.
    pub world: World,
    /// `device_from_handle` over time, scaled, placed and at its speed.
    pub trajectory: Trajectory,
    /// Where the device lies in the world.
    pub map: WorkspaceMap,
    /// Servo ticks a second [Hz].
    pub rate_hz: u32,
    /// How long a run lasts [s].
    pub seconds: f64,
    /// How contact is resolved.
    pub method: MethodName,
}

impl BuiltScene {
    /// A fresh device that plays the trajectory from its start.
    pub fn device(&self) -> ScriptedDevice {
        ScriptedDevice::new("scripted", self.trajectory.clone())
    }
}

impl Scene {
    /// Reads the files that the scene names, relative to its folder, and puts the world together.
    ///
    /// # Errors
    /// With line and column, when a file is missing or damaged, a shape is not convex, or parts do not fit.
    pub fn build(&self, files: &dyn Files) -> Result<BuiltScene, SceneError> {
        let description = self.description();
        let mut budget = FaceBudget::FULL;
        let tool = Tool {
            segments: tool::segments(self, files, &mut budget)?,
        };
        let mut objects = Vec::with_capacity(description.objects.len());
        for (index, object) in description.objects.iter().enumerate() {
            objects.push(self.object(index, object, (files, &mut budget))?);
        }
        let coupling = &description.coupling;
        let world = World::new(WorldDescription {
            tool,
            objects,
            coupling: VirtualCoupling {
                linear_stiffness: coupling.linear_stiffness.get(),
                angular_stiffness: coupling.angular_stiffness.get(),
                linear_damping: coupling.linear_damping.get(),
                angular_damping: coupling.angular_damping.get(),
            },
            method: self.method(),
        })
        .map_err(|error| self.world_fault(&error))?;
        let trajectory = self.trajectory(files)?;
        let seconds = match description.seconds {
            Some(seconds) => seconds.get(),
            None if trajectory.duration() > 0.0 => trajectory.duration(),
            None => {
                let message = "the trajectory lasts 0 s; give the scene a number of `seconds`";
                return Err(self.fault_at("trajectory.path", Fault::Trajectory(message.to_owned())));
            }
        };
        Ok(BuiltScene {
            world,
            trajectory,
            map: self.map()?,
            rate_hz: description.rate_hz.get(),
            seconds,
            method: description.method,
        })
    }

    fn method(&self) -> Method {
        let description = self.description();
        match description.method {
            MethodName::Constrained => Method::Constrained,
            MethodName::Paper => Method::Paper(PaperParameters {
                edge_width: description.paper.edge_width.get(),
                detection_interval: description.paper.detection_interval.get(),
            }),
        }
    }

    fn object(
        &self,
        index: usize,
        object: &ObjectDescription,
        sources: (&dyn Files, &mut FaceBudget),
    ) -> Result<Object, SceneError> {
        let path = format!("objects[{index}].shape");
        Ok(Object {
            name: object.name.clone(),
            shape: shape::convex(self, &object.shape, &path, sources)?,
            world_from_object: object.pose.pose(),
            shading_threshold: object
                .shading_threshold_deg
                .map(|threshold| threshold.get().to_radians()),
        })
    }

    fn map(&self) -> Result<WorkspaceMap, SceneError> {
        let workspace = &self.description().workspace;
        WorkspaceMap::new(
            workspace.pose.pose(),
            workspace.position_scale.get(),
            workspace.force_scale.get(),
        )
        .map_err(|error| self.fault_at("workspace", Fault::World(error.to_string())))
    }

    fn trajectory(&self, files: &dyn Files) -> Result<Trajectory, SceneError> {
        let placement = &self.description().trajectory;
        let (path, bytes) = self.read_file(&placement.path, "trajectory.path", files)?;
        let recorded = read_trajectory(&bytes, &path.display().to_string())
            .map_err(|error| self.naming("trajectory.path", error))?;
        recorded
            .mapped(&placement.pose.pose(), placement.scale.get())
            .and_then(|mapped| mapped.retimed(placement.speed.get()))
            .map_err(|error| self.fault_at("trajectory", Fault::Trajectory(in_words(&error))))
    }

    /// The bytes of a file that the field at `field` names, and its path.
    fn read_file(
        &self,
        name: &str,
        field: &str,
        files: &dyn Files,
    ) -> Result<(PathBuf, Vec<u8>), SceneError> {
        let folder = Path::new(self.file_name()).parent();
        let path = folder.unwrap_or(Path::new("")).join(name);
        match files.read(&path) {
            Ok(bytes) => Ok((path, bytes)),
            Err(error) => Err(self.fault_at(
                field,
                Fault::File {
                    path: shortened(&path.display().to_string()).into_owned(),
                    reason: error.to_string(),
                },
            )),
        }
    }

    /// The field that a fault of the assembled world is about.
    fn world_fault(&self, error: &WorldError) -> SceneError {
        let objects = &self.description().objects;
        let of_object = |name: &str, field: &str| {
            let index = objects.iter().position(|object| object.name == name);
            format!("objects[{}].{field}", index.unwrap_or(0))
        };
        let path = match error {
            WorldError::Coupling { name, .. } => format!("coupling.{name}"),
            WorldError::Paper { name, .. } => format!("paper.{name}"),
            WorldError::Pose { object } => of_object(object, "pose"),
            WorldError::Shading { object, .. } => of_object(object, "shading_threshold_deg"),
            WorldError::NoSegments => "tool".to_owned(),
        };
        self.fault_at(&path, Fault::World(error.to_string()))
    }
}
