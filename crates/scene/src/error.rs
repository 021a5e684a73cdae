//! What can be wrong with a scene, and where.

use std::borrow::Cow;
use std::fmt;

use thiserror::Error;

/// Where a fault stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// In a file.
    File {
        /// The file as the user named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
    },
    /// In a file as a whole, or in one that has no lines.
    Whole {
        /// The file as the user named it.
        file: String,
    },
    /// In an override, quoted as the user gave it (`--set rate_hz=0`).
    Argument(String),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File { file, line, column } => write!(f, "{file}:{line}:{column}"),
            Self::Whole { file } => f.write_str(file),
            Self::Argument(argument) => f.write_str(argument),
        }
    }
}

/// A fault of a scene, of a file it names or of an override: `place: what is wrong; what to do`.
#[derive(Debug, Error)]
#[error("{place}: {fault}{}", naming(named.as_deref()))]
pub struct SceneError {
    /// Where.
    pub place: Place,
    /// What, and what to do.
    #[source]
    pub fault: Fault,
    /// For a fault inside a mesh or trajectory file: where the scene names that file.
    pub named: Option<Box<Place>>,
}

fn naming(named: Option<&Place>) -> String {
    match named {
        None => String::new(),
        Some(place @ (Place::File { .. } | Place::Whole { .. })) => format!(" (named at {place})"),
        Some(place @ Place::Argument(_)) => format!(" (named by {place})"),
    }
}

impl SceneError {
    /// At a place.
    pub(crate) fn new(place: Place, fault: Fault) -> Self {
        Self {
            place,
            fault,
            named: None,
        }
    }
}

/// Kinds of faults; each text says what was expected or what to do.
#[derive(Debug, Error)]
pub enum Fault {
    /// The text is not RON, or a field is unknown, missing, doubled or of the wrong type.
    #[error("{0}")]
    Syntax(String),
    /// A value is of the right type and out of its range.
    #[error("{0}")]
    Value(String),
    /// An override names a field or list item that is not there.
    #[error("{0}")]
    Override(String),
    /// A file could not be read.
    #[error("cannot read `{path}`: {reason}; paths are relative to the folder of the scene file")]
    File {
        /// The path that was tried.
        path: String,
        /// The system's reason.
        reason: String,
    },
    /// A mesh file is damaged, or a shape cannot be collided with.
    #[error("{0}")]
    Geometry(String),
    /// A trajectory cannot be followed.
    #[error("{0}")]
    Trajectory(String),
    /// The parts are sound and do not fit together.
    #[error("{0}")]
    World(String),
}

/// `text` as messages quote it: its beginning, where it is long.
pub(crate) fn shortened(text: &str) -> Cow<'_, str> {
    /// Characters that are quoted whole: paths and names are seldom longer.
    const LONGEST: usize = 200;
    match text.char_indices().nth(LONGEST) {
        None => Cow::Borrowed(text),
        Some((end, _)) => Cow::Owned(format!("{}…", &text[..end])),
    }
}

/// Line and column, both from 1, the column in characters, of byte `offset` of `text`.
pub(crate) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |at| at + 1);
    let line = before.bytes().filter(|&byte| byte == b'\n').count() + 1;
    (line, before[line_start..].chars().count() + 1)
}

/// Byte offset of a line and column as [`line_and_column`] counts them; the end of the text where it is shorter.
pub(crate) fn offset_of(text: &str, line: usize, column: usize) -> usize {
    let mut start = 0;
    for _ in 1..line {
        match text[start..].find('\n') {
            Some(length) => start += length + 1,
            None => return text.len(),
        }
    }
    let mut characters = text[start..].char_indices();
    characters
        .nth(column.saturating_sub(1))
        .map_or(text.len(), |(at, _)| start + at)
}

#[cfg(test)]
mod tests {
    use super::{line_and_column, offset_of};

    #[test]
    fn offsets_and_columns_are_inverse() {
        let text = "a\nµm = \"x\"\n\n  z";
        for (offset, _) in text.char_indices() {
            let (line, column) = line_and_column(text, offset);
            assert_eq!(offset_of(text, line, column), offset);
        }
        let unit = text.find('=').unwrap();
        assert_eq!(line_and_column(text, unit), (2, 4));
        assert_eq!(offset_of(text, 99, 1), text.len());
        assert_eq!(offset_of(text, 4, 99), text.len());
    }
}
