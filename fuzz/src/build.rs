//! Scenes built from files in memory.

use std::io;
use std::path::Path;

use pliant_scene::{Files, Scene, ShapeDescription, ToolShape};

use crate::place::judge_place;

/// Faces above which a scene is read and not built: a run is to take milliseconds.
const MOST_FACES: u64 = 5000;

const TETRAHEDRON: &str =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
const MOTION: &str = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,0.1,0,0,0,1\n1,0,0,0.02,0,0,0,1\n";

/// One mesh, one motion, and nothing under any other kind of name.
struct TwoFiles;

impl Files for TwoFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("obj") => Ok(TETRAHEDRON.into()),
            Some("csv") => Ok(MOTION.into()),
            _ => Err(io::Error::new(
                io::ErrorKind::NotFound,
                "there is no such file",
            )),
        }
    }
}

/// Builds a scene read from `text` as `file`, unless that takes long; panics unless an error names a place.
pub fn build_in_memory(scene: &Scene, file: &str, text: &[u8]) {
    if faces(scene) > MOST_FACES {
        return;
    }
    match scene.build(&TwoFiles) {
        Ok(built) => {
            assert!(built.seconds > 0.0 && built.seconds.is_finite());
            let (pose, _) = built.trajectory.sample(built.trajectory.start());
            assert!(pose.is_placement(), "{pose:?}");
        }
        Err(error) => judge_place(&error, file, text),
    }
}

/// Faces of all generated surfaces, roughly.
fn faces(scene: &Scene) -> u64 {
    let description = scene.description();
    let grid = |sectors: u32, bands: u32| 4 * u64::from(sectors) * u64::from(bands);
    let objects = description
        .objects
        .iter()
        .map(|object| match &object.shape {
            ShapeDescription::Cylinder { sectors, .. }
            | ShapeDescription::Cone { sectors, .. }
            | ShapeDescription::Tube { sectors, .. } => grid(sectors.get(), 1),
            ShapeDescription::Capsule { sectors, bands, .. }
            | ShapeDescription::LatitudeLongitudeEllipsoid { sectors, bands, .. } => {
                grid(sectors.get(), bands.get())
            }
            ShapeDescription::FibonacciEllipsoid { points, .. } => u64::from(points.get()),
            _ => 12,
        });
    let tool = match &description.tool.shape {
        ToolShape::Pin { sectors, .. } | ToolShape::Cone { sectors, .. } => grid(sectors.get(), 1),
        ToolShape::Capsule { sectors, bands, .. } => grid(sectors.get(), bands.get()),
        ToolShape::Rod { .. } | ToolShape::Mesh { .. } => 12,
    };
    objects.sum::<u64>() + tool * u64::from(description.tool.segments.get())
}
