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

use std::fmt;

use thiserror::Error;

use crate::{MeshError, TriangleMesh};
pub use gltf::gltf;
pub use obj::obj;
pub use stl::stl;

/// Most vertices or triangles a loader makes: instances of instances must not fill the memory.
const MAX_LOADED: usize = 1 << 24;

/// A mesh and what was skipped or repaired on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// All triangles of the file, in the file's unit.
    pub mesh: TriangleMesh,
    /// What differs from the file.
    pub report: LoadReport,
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
        if let Some(note) = self.notes.iter_mut().find(|n| n.what == what) {
            note.count += 1;
        } else {
            self.notes.push(LoadNote {
                what: what.to_owned(),
                count: 1,
                first: first.to_string(),
            });
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
    #[error("the file needs extension {name}, which is not supported: export it without")]
    Extension {
        /// Name of the glTF extension.
        name: String,
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

/// Parses a finite coordinate.
fn coordinate(token: &str, line: usize) -> Result<f64, LoadError> {
    let value: f64 = token
        .parse()
        .map_err(|_| at_line(line, format!("`{}` is not a number", shortened(token))))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(at_line(
            line,
            format!("coordinate `{}` is not finite", shortened(token)),
        ))
    }
}

/// At most 40 characters of a token, for messages.
fn shortened(token: &str) -> String {
    token.chars().take(40).collect()
}

/// Text lines with their numbers from 1, by `\n`, or by `\r` in files that have no `\n`; bytes that are not
/// UTF-8 (names and comments in other encodings) are replaced. A line that ends in a backslash goes on in
/// the next.
///
/// # Errors
/// UTF-16 and UTF-32 text, and bytes that are not text.
fn text_lines(bytes: &[u8]) -> Result<impl Iterator<Item = (usize, String)>, LoadError> {
    let found = match bytes {
        [0xFE, 0xFF, ..] => Some("UTF-16 text (big-endian byte order mark)"),
        [0xFF, 0xFE, ..] => Some("UTF-16 or UTF-32 text (little-endian byte order mark)"),
        [0, 0, 0xFE, 0xFF, ..] => Some("UTF-32 text (big-endian byte order mark)"),
        _ if bytes.contains(&0) => Some("binary data (a zero byte), not text"),
        _ => None,
    };
    if let Some(found) = found {
        let remedy = "save the file as UTF-8 text";
        return Err(LoadError::Encoding { found, remedy });
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let separator = if bytes.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut rest = bytes.split(move |&b| b == separator).zip(1_usize..);
    Ok(std::iter::from_fn(move || {
        let (first, number) = rest.next()?;
        let mut text = String::from_utf8_lossy(first).trim().to_owned();
        while text.ends_with('\\') {
            text.pop();
            let Some((more, _)) = rest.next() else { break };
            text.push(' ');
            text.push_str(String::from_utf8_lossy(more).trim());
        }
        Some((number, text))
    }))
}
