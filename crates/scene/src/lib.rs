//! Scene files: RON in, world and device choice out, errors with line and column.
//!
//! [`Scene::from_str`] reads the text, [`Scene::with_overrides`] lays settings over it, [`Scene::build`] reads the files
//! that the scene names and puts the world together. Numbers are checked where they are read (`quantity`), so that what
//! is left for later are faults of files and of geometry; those find their place by the outline of the text (`text`). The
//! reader's own errors are put into words of scene files (`explain`).
//! Files come through [`Files`]: nothing else here touches the disk.

mod assemble;
mod digits;
mod error;
mod explain;
mod files;
mod mesh_file;
mod quantity;
mod recognise;
mod scene;
mod schema;
mod text;
mod trajectory_file;

pub use assemble::BuiltScene;
pub use error::{Fault, Place, SceneError};
pub use files::{Disk, Files, MemoryFiles};
pub use mesh_file::{MESH_EXTENSIONS, read_mesh};
pub use quantity::{
    Coordinate, Count, Damping, Degrees, Direction, Duration, Factor, Length, Offset,
    RadiusOrPoint, Segments, Sizes, Stiffness, ThresholdDegrees, Vector,
};
pub use scene::Scene;
pub use schema::{
    Bands, CouplingDescription, DeviceName, MeshFile, MethodName, ObjectDescription,
    PaperDescription, PoseDescription, RotationDescription, SceneDescription, Sectors,
    ShapeDescription, ToolDescription, ToolShape, TrajectoryDescription, Unit,
    WorkspaceDescription,
};
pub use text::Override;
pub use trajectory_file::read_trajectory;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
