//! Wavefront OBJ (Alias|Wavefront, "Object files", appendix B1): the polygonal part.
//!
//! Of the two libraries' worth of features only `v` and `f` carry shape, so they are read here line by line
//! and everything about materials, texture coordinates and normals is passed over. Known readers accept
//! infinite coordinates, drop short faces in silence, fan concave polygons and refuse a whole file for an
//! empty `usemtl`; this one reports with the line number instead.

use glam::DVec3;

use super::ear_clip::{Triangulation, triangulate};
use super::{
    LoadError, LoadReport, Loaded, MAX_LOADED, at_line, coordinate, shortened, text_lines,
};
use crate::TriangleMesh;
use crate::triangle_mesh::compacted;

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

#[derive(Default)]
struct Reader {
    positions: Vec<DVec3>,
    /// Corner indices of all faces one after the other.
    corners: Vec<i64>,
    /// Line and end in `corners` of each face with at least three corners.
    faces: Vec<(usize, usize)>,
    report: LoadReport,
}

/// Reads an OBJ file: all objects and groups as one mesh, polygons cut into triangles, positions in the
/// file's unit and in full `f64` precision.
///
/// # Errors
/// Text that is not UTF-8-like, a malformed or infinite coordinate, a bad index, all with the line number;
/// no face with three corners.
pub fn obj(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let mut reader = Reader::default();
    for (line, text) in text_lines(bytes)? {
        let mut tokens = text.split_whitespace().take_while(|t| !t.starts_with('#'));
        match tokens.next() {
            None => {}
            Some("v") => reader.vertex(tokens, line)?,
            Some("f" | "fo") => reader.face(tokens, line)?,
            Some("l" | "p") => reader
                .report
                .note("line or point elements skipped", format!("line {line}")),
            Some(word) if PASSED_OVER.contains(&word) => {}
            Some(word) => {
                let what = format!("`{}` statements skipped", shortened(word));
                // Garbage must not make a note per line.
                let what = if reader.report.notes.len() < 20 {
                    &what
                } else {
                    "more unknown statements skipped"
                };
                reader.report.note(what, format!("line {line}"));
            }
        }
    }
    reader.finish()
}

impl Reader {
    fn vertex<'a>(
        &mut self,
        mut tokens: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<(), LoadError> {
        let mut xyz = [0.0; 3];
        for (value, name) in xyz.iter_mut().zip(["x", "y", "z"]) {
            let token = tokens.next().ok_or_else(|| {
                at_line(line, format!("vertex without {name}: expected `v x y z`"))
            })?;
            *value = coordinate(token, line)?;
        }
        self.positions.push(DVec3::from_array(xyz));
        if self.positions.len() > MAX_LOADED {
            let (what, limit) = ("vertices", MAX_LOADED);
            return Err(LoadError::TooLarge { what, limit });
        }
        Ok(())
    }

    /// Corners as zero-based indices; those counted from the end are resolved here, ranges at the end of the
    /// file because a face may come before its vertices.
    fn face<'a>(
        &mut self,
        tokens: impl Iterator<Item = &'a str>,
        line: usize,
    ) -> Result<(), LoadError> {
        let start = self.corners.len();
        for token in tokens {
            let index = self.corner(token, line)?;
            if self.corners[start..].last() == Some(&index) {
                self.report
                    .note("repeated corners of faces merged", format!("line {line}"));
            } else {
                self.corners.push(index);
            }
        }
        if self.corners.len() - start > 3
            && self.corners[start] == self.corners[self.corners.len() - 1]
        {
            self.corners.pop();
            self.report
                .note("repeated corners of faces merged", format!("line {line}"));
        }
        if self.corners.len() - start < 3 {
            // The indices of a dropped face still show whether the file is sound.
            self.corners.truncate(start);
            self.report.note(
                "faces with fewer than three corners dropped",
                format!("line {line}"),
            );
        } else {
            self.faces.push((line, self.corners.len()));
        }
        Ok(())
    }

    /// The position index of `7`, `7/1`, `7//2`, `7/1/2`, `-1` ….
    fn corner(&self, token: &str, line: usize) -> Result<i64, LoadError> {
        let mut position = None;
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
            position.get_or_insert(index);
        }
        let count = i64::try_from(self.positions.len()).unwrap_or(i64::MAX);
        match position {
            Some(index) if index > 0 => Ok(index - 1),
            Some(index) if index < 0 && -count <= index => Ok(count + index),
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

    fn nothing(&self) -> LoadError {
        let vertices = self.positions.len();
        let notes: Vec<String> = self.report.notes.iter().map(ToString::to_string).collect();
        let found = if notes.is_empty() {
            format!("the file has {vertices} vertices and no faces")
        } else {
            format!("the file has {vertices} vertices; {}", notes.join("; "))
        };
        LoadError::NoTriangles { found }
    }

    fn finish(mut self) -> Result<Loaded, LoadError> {
        if self.faces.is_empty() {
            return Err(self.nothing());
        }
        let mut triangles = Vec::new();
        let mut start = 0;
        for &(line, end) in &self.faces {
            let mut polygon = Vec::with_capacity(end - start);
            for &index in &self.corners[start..end] {
                let vertex = u32::try_from(index)
                    .ok()
                    .filter(|&v| (v as usize) < self.positions.len());
                polygon.push(vertex.ok_or_else(|| {
                    at_line(
                        line,
                        format!(
                            "vertex index {}, but the file has {} vertices",
                            index + 1,
                            self.positions.len()
                        ),
                    )
                })?);
            }
            start = end;
            if polygon.len() > 3 {
                let place = format!("line {line}");
                match triangulate(&self.positions, &polygon, &mut triangles) {
                    Triangulation::Convex => {}
                    Triangulation::Concave => self
                        .report
                        .note("concave polygons cut by ear clipping", place),
                    Triangulation::Failed => self
                        .report
                        .note("self-intersecting or collapsed polygons fanned", place),
                    Triangulation::TooLong(limit) => {
                        return Err(at_line(
                            line,
                            format!(
                                "a concave face with {} corners: at most {limit}",
                                polygon.len()
                            ),
                        ));
                    }
                }
            } else {
                triangles.push([polygon[0], polygon[1], polygon[2]]);
            }
            if triangles.len() > MAX_LOADED {
                let (what, limit) = ("triangles", MAX_LOADED);
                return Err(LoadError::TooLarge { what, limit });
            }
        }
        let checked = TriangleMesh::new(self.positions, triangles)?;
        Ok(Loaded {
            mesh: compacted(checked.positions(), checked.triangles()),
            report: self.report,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::obj;
    use crate::load::LoadError;

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    fn error_of(text: &str) -> String {
        obj(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn reads_all_forms_of_corners() {
        for faces in [
            "f 1 2 3\nf 1 3 4",
            "f 1/9 2/8 3/7 4/6",
            "f 1//1 2//1 3//1 4//1",
            "f -4/1/1 -3/1/1 -2/1/1 -1/1/1",
            "f 1// 2// 3// \\\n 4//",
        ] {
            let loaded =
                obj(format!("\u{feff}mtllib\nusemtl\n{SQUARE}{faces}").as_bytes()).unwrap();
            assert_eq!(loaded.mesh.triangles().len(), 2, "{faces}");
            assert!((loaded.mesh.surface_area() - 1.0).abs() < 1e-15);
            assert!(loaded.report.notes.is_empty(), "{:?}", loaded.report);
        }
    }

    #[test]
    fn a_face_may_precede_its_vertices_and_unused_ones_go() {
        let loaded = obj(b"f 1 2 3\rv 0 0 0\rv 1 0 0\rv 0 1 0\rv 9 9 9").unwrap();
        assert_eq!(loaded.mesh.positions().len(), 3);
    }

    #[test]
    fn errors_name_the_line() {
        assert_eq!(
            error_of("v 0 0 nan\nf 1 1 1"),
            "line 1: coordinate `nan` is not finite"
        );
        assert_eq!(
            error_of("\nv 0 -inf 0"),
            "line 2: coordinate `-inf` is not finite"
        );
        assert_eq!(
            error_of("v 1e400 0 0"),
            "line 1: coordinate `1e400` is not finite"
        );
        assert_eq!(error_of("v 0 0 3.1+e2"), "line 1: `3.1+e2` is not a number");
        assert_eq!(
            error_of("v 0 0"),
            "line 1: vertex without z: expected `v x y z`"
        );
        assert_eq!(
            error_of(&format!("{SQUARE}f 1 2 5")),
            "line 5: vertex index 5, but the file has 4 vertices"
        );
        assert_eq!(
            error_of(&format!("{SQUARE}f 1 2 -5")),
            "line 5: vertex index `-5`, but only 4 vertices come before it"
        );
        assert_eq!(
            error_of(&format!("{SQUARE}f 0 1 2")),
            "line 5: vertex index 0: indices start at 1"
        );
        assert!(error_of(&format!("{SQUARE}f 1 2 x")).starts_with("line 5: `x` is not a corner"));
        assert!(error_of(&format!("{SQUARE}f 1 2 99999999999999999999")).starts_with("line 5"));
        assert!(error_of(&format!("{SQUARE}f 1 2 -9223372036854775808")).starts_with("line 5"));
    }

    #[test]
    fn short_faces_lines_and_curves_are_reported() {
        let loaded =
            obj(format!("{SQUARE}f\nf 1 2\nl 1 2\nf 1 2 2 3\ncurv 0 1\nf 1 2 1").as_bytes())
                .unwrap();
        assert_eq!(
            loaded.mesh.triangles().len(),
            2,
            "f 1 2 1 stays, to be dropped by welding"
        );
        let notes: Vec<String> = loaded
            .report
            .notes
            .iter()
            .map(ToString::to_string)
            .collect();
        assert_eq!(
            notes,
            [
                "2 faces with fewer than three corners dropped (first: line 5)",
                "1 line or point elements skipped (first: line 7)",
                "1 repeated corners of faces merged (first: line 8)",
                "1 `curv` statements skipped (first: line 9)",
            ]
        );
        let error = obj(format!("{SQUARE}f 1 2").as_bytes()).unwrap_err();
        assert!(
            error.to_string().contains("4 vertices; 1 faces with fewer"),
            "{error}"
        );
    }

    #[test]
    fn other_encodings_are_named() {
        let utf16: Vec<u8> = std::iter::once(0xFEFF_u16)
            .chain("v 0 0 0".encode_utf16())
            .flat_map(u16::to_be_bytes)
            .collect();
        let error = obj(&utf16).unwrap_err();
        assert!(error.to_string().contains("UTF-16") && error.to_string().contains("UTF-8"));
        assert!(matches!(obj(b"v 0\0"), Err(LoadError::Encoding { .. })));
        assert!(matches!(obj(b""), Err(LoadError::NoTriangles { .. })));
        // Latin-1 in a comment or a name is no fault.
        assert!(obj(b"# Z\xE4hne\no Z\xE4hne\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3").is_ok());
    }
}
