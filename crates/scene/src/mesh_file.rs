//! Mesh files, told apart by their extension: OBJ, STL, glTF and GLB.

use std::path::Path;

use pliant_mesh::load::{self, LoadError, Loaded};

use crate::error::{Fault, Place, SceneError};
use crate::files::Files;

/// Extensions of mesh files, in lower case.
pub const MESH_EXTENSIONS: [&str; 4] = ["obj", "stl", "gltf", "glb"];

/// Reads a mesh in the unit of its file; `files` gives the buffers that a glTF file names.
///
/// # Errors
/// At the line at fault where the reader knows one, else at the whole file; unknown extensions are refused.
pub fn read_mesh(path: &Path, bytes: &[u8], files: &dyn Files) -> Result<Loaded, SceneError> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    let loaded = match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("obj") => load::obj(bytes),
        Some("stl") => load::stl(bytes),
        Some("gltf" | "glb") => {
            let folder = path.parent().unwrap_or(Path::new(""));
            let mut buffer = |name: &str| {
                let read = files.read(&folder.join(name));
                read.map_err(|error| error.to_string())
            };
            load::gltf(bytes, &mut buffer)
        }
        _ => {
            let message = format!(
                "the file's extension names no mesh format; expected .{}",
                MESH_EXTENSIONS.join(", .")
            );
            return Err(SceneError::new(whole(path), Fault::Geometry(message)));
        }
    };
    loaded.map_err(|error| {
        let (place, message) = match error {
            LoadError::Line { line, message } => (at(path, line, 1), message),
            LoadError::Json {
                line,
                column,
                message,
            } => (at(path, line, column), format!("glTF JSON: {message}")),
            other => (whole(path), other.to_string()),
        };
        SceneError::new(place, Fault::Geometry(message))
    })
}

fn at(path: &Path, line: usize, column: usize) -> Place {
    Place::File {
        file: path.display().to_string(),
        line,
        column,
    }
}

fn whole(path: &Path) -> Place {
    Place::Whole {
        file: path.display().to_string(),
    }
}
