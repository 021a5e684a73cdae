//! The pass over the lines of an OBJ file before `tobj` reads it: it finds faults, leaves out what is no
//! polygon, notes both with the line, and writes a text of `v` and `f` records only.

use super::super::text::{coordinate, shortened, text_lines};
use super::super::validate::limited;
use super::super::{LoadError, LoadReport, at_line};

/// Keywords that say nothing about the shape of polygons.
const PASSED_OVER: [&str; 14] = [
    "vt",
    "vn",
    "vp",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "shadow_obj",
    "lod",
];

/// What `tobj` is to read, and what it cannot tell.
#[derive(Default)]
pub(super) struct Scanned {
    /// Records `v x y z`, spelt as in the file, and `f a b c …`: indices from 1, in range, at least three.
    pub(super) text: String,
    /// Number of `v` records.
    pub(super) vertices: usize,
    /// Line of each `f` record.
    pub(super) face_lines: Vec<usize>,
    /// What was left out.
    pub(super) report: LoadReport,
}

#[derive(Default)]
struct Scanner {
    scanned: Scanned,
    /// Corners of the present face.
    corners: Vec<i64>,
    /// Line and index of corners that name vertices not seen yet: a face may come before its vertices.
    forward: Vec<(usize, i64)>,
    /// Triangles that the faces will make.
    triangles: usize,
}

/// Checks and cleans an OBJ file.
///
/// # Errors
/// As [`obj`](super::obj).
pub(super) fn scan(bytes: &[u8]) -> Result<Scanned, LoadError> {
    let mut scanner = Scanner::default();
    for (line, text) in text_lines(bytes)? {
        let text = text.split('#').next().unwrap_or_default();
        let mut tokens = text.split_whitespace();
        match tokens.next() {
            None => {}
            Some("v") => scanner.vertex(tokens, line)?,
            Some("f" | "fo") => scanner.face(tokens, line)?,
            Some("l" | "p") => scanner.note("line or point elements skipped", line),
            Some(word) if PASSED_OVER.contains(&word) => {}
            // Garbage must not make a note per line.
            Some(_) if scanner.scanned.report.notes.len() >= 20 => {
                scanner.note("more unknown statements skipped", line);
            }
            Some(word) => scanner.note(&format!("`{}` statements skipped", shortened(word)), line),
        }
    }
    scanner.finish()
}

impl Scanner {
    fn note(&mut self, what: &str, line: usize) {
        self.scanned.report.note(what, format!("line {line}"));
    }

    /// Keeps the three coordinates. What follows says nothing about polygons: a colour, or the weight of a control
    /// point, by which some programs nevertheless divide.
    fn vertex<'a>(
        &mut self,
        mut tokens: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<(), LoadError> {
        let text = &mut self.scanned.text;
        text.push('v');
        for name in ["x", "y", "z"] {
            let token = tokens.next().ok_or_else(|| {
                at_line(line, format!("vertex without {name}: expected `v x y z`"))
            })?;
            coordinate(token, line)?;
            text.push(' ');
            text.push_str(token);
        }
        text.push('\n');
        if let (Some(weight), None) = (tokens.next(), tokens.next())
            && weight.parse() != Ok(1.0)
        {
            self.note("fourth coordinates other than 1 ignored", line);
        }
        self.scanned.vertices += 1;
        limited("vertices", self.scanned.vertices).map_err(|error| at_line(line, error.to_string()))
    }

    fn face<'a>(
        &mut self,
        tokens: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<(), LoadError> {
        const MERGED: &str = "repeated corners of faces merged";
        self.corners.clear();
        let forward = self.forward.len();
        for token in tokens {
            let index = self.corner(token, line)?;
            if self.corners.last() == Some(&index) {
                self.note(MERGED, line);
            } else {
                self.corners.push(index);
            }
        }
        if self.corners.len() > 3 && self.corners.first() == self.corners.last() {
            self.corners.pop();
            self.note(MERGED, line);
        }
        if self.corners.len() < 3 {
            self.forward.truncate(forward);
            self.note("faces with fewer than three corners dropped", line);
            return Ok(());
        }
        self.scanned.text.push('f');
        for index in &self.corners {
            self.scanned.text.push(' ');
            self.scanned.text.push_str(&index.to_string());
        }
        self.scanned.text.push('\n');
        self.scanned.face_lines.push(line);
        self.triangles += self.corners.len() - 2;
        limited("triangles", self.triangles).map_err(|error| at_line(line, error.to_string()))
    }

    /// The vertex, counted from 1, of `7`, `7/1`, `7//2`, `7/1/2`, `-1` ….
    fn corner(&mut self, token: &str, line: usize) -> Result<i64, LoadError> {
        let mut vertex = None;
        for (k, part) in token.split('/').enumerate() {
            if k > 0 && part.is_empty() {
                continue;
            }
            let index: i64 = part.parse().map_err(|_| {
                at_line(
                    line,
                    format!(
                        "`{}` is not a corner: expected `v`, `v/vt`, `v//vn` or `v/vt/vn`",
                        shortened(token)
                    ),
                )
            })?;
            vertex.get_or_insert(index);
        }
        let count = signed(self.scanned.vertices);
        match vertex {
            Some(index) if index > 0 => {
                if index > count {
                    self.forward.push((line, index));
                }
                Ok(index)
            }
            Some(index) if index < 0 && -count <= index => Ok(count + index + 1),
            Some(0) => Err(at_line(line, "vertex index 0: indices start at 1")),
            _ => Err(at_line(
                line,
                format!(
                    "vertex index `{}`, but only {count} vertices come before it",
                    shortened(token)
                ),
            )),
        }
    }

    fn finish(self) -> Result<Scanned, LoadError> {
        let Scanned {
            vertices, report, ..
        } = &self.scanned;
        if self.scanned.face_lines.is_empty() {
            return Err(report.nothing_found(format!("the file has {vertices} vertices")));
        }
        let count = signed(*vertices);
        match self.forward.iter().find(|(_, index)| *index > count) {
            Some((line, index)) => Err(at_line(
                *line,
                format!("vertex index {index}, but the file has {count} vertices"),
            )),
            None => Ok(self.scanned),
        }
    }
}

fn signed(count: usize) -> i64 {
    i64::try_from(count).expect("at most 2^24 vertices")
}
