//! Meshes from the bytes of OBJ, glTF/GLB and STL files.
//!
//! The libraries `tobj`, `gltf` and `stl_io` parse. They trust their input more than a loader may, so each
//! reader here checks lengths, numbers, indices and ranges and names the line, chunk or element at fault; no
//! input makes it panic, recurse deeply or allocate out of proportion to the file's size (instances excepted,
//! which are limited). All objects, groups and scene nodes of a file become one mesh, in
//! the file's unit. Vertices stay as the file has them, used ones only: weld to close seams.

mod ear_clip;
mod gltf;
mod obj;
mod stl;
mod text;
mod validate;

use std::fmt;

use thiserror::Error;

use crate::{MeshError, Soundness, TriangleMesh};
pub use gltf::gltf;
pub use obj::obj;
pub use stl::stl;

/// Most vertices or triangles a loader makes: instances of instances must not fill the memory, and all that is
/// made of a mesh of this size (welded copy, half-edges, normals) fits in a gigabyte.
const MAX_LOADED: usize = 1 << 22;

/// A mesh and what was skipped or repaired on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// All triangles of the file, in the file's unit.
    pub mesh: TriangleMesh,
    /// What differs from the file.
    pub report: LoadReport,
    /// What the triangles are like.
    pub soundness: Soundness,
}

/// What a loader skipped or repaired, one note per kind in order of appearance.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadReport {
    /// The notes; empty when everything in the file is in the mesh.
    pub notes: Vec<LoadNote>,
}

/// One kind of repair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadNote {
    /// What was done, for instance "faces with fewer than three corners dropped".
    pub what: String,
    /// How often.
    pub count: usize,
    /// Where first, for instance "line 12".
    pub first: String,
}

impl fmt::Display for LoadNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} (first: {})", self.count, self.what, self.first)
    }
}

impl LoadReport {
    fn note(&mut self, what: &str, first: impl fmt::Display) {
        self.note_many(what, 1, first);
    }

    fn note_many(&mut self, what: &str, count: usize, first: impl fmt::Display) {
        if let Some(note) = self.notes.iter_mut().find(|n| n.what == what) {
            note.count += count;
        } else {
            self.notes.push(LoadNote {
                what: what.to_owned(),
                count,
                first: first.to_string(),
            });
        }
    }

    /// The error of a file in which nothing was found but `counts`, with all that was left out.
    fn nothing_found(&self, counts: String) -> LoadError {
        let notes = self.notes.iter().map(ToString::to_string);
        let found: Vec<String> = std::iter::once(counts).chain(notes).collect();
        LoadError::NoTriangles {
            found: found.join("; "),
        }
    }
}

/// Why bytes are not a mesh.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum LoadError {
    /// Not text of the expected kind.
    #[error("{found}: {remedy}")]
    Encoding {
        /// What the bytes look like.
        found: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A line of a text file.
    #[error("line {line}: {message}")]
    Line {
        /// Line number from 1.
        line: usize,
        /// What is wrong, what was expected.
        message: String,
    },
    /// The container of a binary file.
    #[error("byte {offset}: {message}")]
    Binary {
        /// Offset from the start of the file.
        offset: usize,
        /// What is wrong, what was expected.
        message: String,
    },
    /// The JSON text of a glTF file cannot be read.
    #[error("glTF JSON, line {line} column {column}: {message}")]
    Json {
        /// Line in the JSON text, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// What is wrong.
        message: String,
    },
    /// An element of a glTF file.
    #[error("{element}: {message}")]
    Element {
        /// Its path, for instance `accessors[3]`.
        element: String,
        /// What is wrong, what was expected.
        message: String,
    },
    /// The file needs an extension that is not supported.
    #[error("the file needs {names}, which cannot be read here: {remedy}")]
    Extension {
        /// Names of the glTF extensions, for instance "extension `KHR_draco_mesh_compression`".
        names: String,
        /// What to do.
        remedy: &'static str,
    },
    /// The parsing library refuses what the checks here let pass.
    #[error("{library} cannot read the file: {message}; export it anew")]
    Library {
        /// Name of the library.
        library: &'static str,
        /// What it says.
        message: String,
    },
    /// Nothing to load.
    #[error("no triangles: {found}")]
    NoTriangles {
        /// What the file has instead.
        found: String,
    },
    /// More than a loader makes.
    #[error("more than {limit} {what}: split or simplify the model")]
    TooLarge {
        /// What there is too much of, for instance "triangles".
        what: &'static str,
        /// Largest number.
        limit: usize,
    },
    /// The triangles are no mesh.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

fn at_line(line: usize, message: impl Into<String>) -> LoadError {
    LoadError::Line {
        line,
        message: message.into(),
    }
}
