//! STL, binary and text (3D Systems, "stereolithography interface specification", 1988).
//!
//! The library `stl_io` reads the triangles of binary files, once their kind and length are checked here: it
//! would take a binary file whose header starts with "solid " for text, and lets infinite coordinates and NaN
//! pass. Text files are read line by line here. `stl_io` 0.11 keeps their coordinates at `f32`, while ours
//! are worth `f64`; it stops at the first `endsolid`, so further solids vanish in silence; it wants "solid "
//! in lower case with a space behind it; and its errors have no line numbers. A test below shows each.
//! Stored normals are ignored: the winding decides.

use std::collections::HashMap;
use std::io::Cursor;

use glam::{DVec3, Vec3};

use super::text::{coordinate, other_encoding, shortened, text_lines};
use super::validate::{Draft, limited};
use super::{LoadError, Loaded, at_line};
use crate::triangle_mesh::MAX_COORDINATE;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// Corners merged where their coordinates are equal: STL stores each triangle's corners anew.
#[derive(Default)]
struct Builder {
    draft: Draft,
    index: HashMap<[u64; 3], u32>,
}

/// Reads an STL file in the file's unit; all solids as one mesh, equal corners merged.
///
/// # Errors
/// A truncated file, a malformed or infinite coordinate, with the line or byte; no triangles.
pub fn stl(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let mut builder = Builder::default();
    // The size decides first: many binary files start with "solid" as well.
    let stated = stated_triangles(bytes);
    let is_text = starts_with_word(bytes, b"solid") || starts_with_word(bytes, b"facet");
    let exact = stated.is_some_and(|n| {
        n.checked_mul(RECORD).and_then(|s| s.checked_add(HEADER)) == Some(bytes.len())
    });
    if !exact && let Some(error) = other_encoding(bytes) {
        return Err(error);
    }
    match stated {
        Some(count) if exact || !is_text || bytes.contains(&0) => {
            read_binary(bytes, count, &mut builder)?;
        }
        _ if is_text => read_text(bytes, &mut builder)?,
        _ => {
            return Err(LoadError::Binary {
                offset: bytes.len(),
                message: format!(
                    "{} bytes are neither a text STL (`solid …`) nor a binary one (84 bytes and more)",
                    bytes.len()
                ),
            });
        }
    }
    builder
        .draft
        .validated(|| "the STL file has no facets".to_owned())
}

fn starts_with_word(bytes: &[u8], word: &[u8]) -> bool {
    let bytes = bytes
        .strip_prefix(b"\xEF\xBB\xBF")
        .unwrap_or(bytes)
        .trim_ascii_start();
    bytes
        .get(..word.len())
        .is_some_and(|w| w.eq_ignore_ascii_case(word))
}

fn stated_triangles(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(HEADER - 4..HEADER)?.first_chunk()?;
    usize::try_from(u32::from_le_bytes(*count)).ok()
}

fn read_binary(bytes: &[u8], count: usize, builder: &mut Builder) -> Result<(), LoadError> {
    let body = &bytes[HEADER..];
    let available = body.len() / RECORD;
    if count > available {
        return Err(LoadError::Binary {
            offset: bytes.len(),
            message: format!(
                "the header promises {count} triangles, the file holds {available}: it is truncated or no STL"
            ),
        });
    }
    if body.len() > count * RECORD {
        builder.draft.report.note(
            "runs of bytes after the last triangle ignored",
            format!("byte {}", HEADER + count * RECORD),
        );
    }
    // The library decides by the first line of the header, which is free text: an empty one makes it binary.
    let mut checked = vec![b'\n'; HEADER - 4];
    checked.extend(&bytes[HEADER - 4..HEADER + count * RECORD]);
    let mut checked = Cursor::new(checked);
    let triangles = stl_io::create_stl_reader(&mut checked).map_err(|e| refused(&e))?;
    for (i, triangle) in triangles.enumerate() {
        let corners = triangle.map_err(|e| refused(&e))?.vertices.map(|v| v.0);
        let unfit = |x: &f32| x.is_nan() || f64::from(*x).abs() >= MAX_COORDINATE;
        if let Some(k) = corners.iter().flatten().position(unfit) {
            let value = corners[k / 3][k % 3];
            let fault = if value.is_finite() {
                "too large"
            } else {
                "not finite"
            };
            return Err(LoadError::Binary {
                // The coordinates come behind 12 bytes of normal.
                offset: HEADER + i * RECORD + 12 + 4 * k,
                message: format!("triangle {i} has coordinate {value:e}, which is {fault}"),
            });
        }
        builder.push(corners.map(|p| Vec3::from_array(p).as_dvec3()))?;
    }
    Ok(())
}

fn refused(error: &std::io::Error) -> LoadError {
    LoadError::Library {
        library: "stl_io",
        message: error.to_string(),
    }
}

fn read_text(bytes: &[u8], builder: &mut Builder) -> Result<(), LoadError> {
    let mut corners: Vec<DVec3> = Vec::new();
    let mut open_since = None;
    let mut ended = true;
    let mut last = 0;
    for (line, text) in text_lines(bytes)? {
        last = line;
        let lower = text.to_ascii_lowercase();
        let mut tokens = lower.split_whitespace();
        match tokens.next() {
            Some("facet") if open_since.is_none() => {
                open_since = Some(line);
                corners.clear();
            }
            Some("vertex") if open_since.is_some() => {
                let mut p = DVec3::ZERO;
                for axis in 0..3 {
                    let token = tokens
                        .next()
                        .ok_or_else(|| at_line(line, "expected `vertex x y z`"))?;
                    p[axis] = coordinate(token, line)?;
                }
                corners.push(p);
            }
            Some("endfacet") if open_since.is_some() => {
                let [a, b, c] = corners[..] else {
                    return Err(at_line(
                        line,
                        format!("a facet with {} vertices: expected three", corners.len()),
                    ));
                };
                builder.push([a, b, c])?;
                open_since = None;
            }
            None | Some("outer" | "endloop") => {}
            Some("solid") if open_since.is_none() => ended = false,
            Some("endsolid") if open_since.is_none() => ended = true,
            Some(word) => {
                return Err(at_line(
                    line,
                    format!("unexpected `{}` in a text STL", shortened(word)),
                ));
            }
        }
    }
    if let Some(line) = open_since {
        let message = format!("the file ends within the facet of line {line}: it is truncated");
        return Err(at_line(last, message));
    }
    if !ended {
        let report = &mut builder.draft.report;
        let what = "solids without `endsolid`: the file may be cut short";
        report.note(what, format!("line {last}"));
    }
    Ok(())
}

impl Builder {
    fn push(&mut self, corners: [DVec3; 3]) -> Result<(), LoadError> {
        limited("triangles", self.draft.triangles.len() + 1)?;
        let triangle = corners.map(|p| {
            let next = u32::try_from(self.draft.positions.len())
                .expect("three per triangle of at most 2^22");
            // Adding zero makes -0 equal to 0.
            let key = (p + DVec3::ZERO).to_array().map(f64::to_bits);
            let index = *self.index.entry(key).or_insert(next);
            if index == next {
                self.draft.positions.push(p);
            }
            index
        });
        self.draft.triangles.push(triangle);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::stl;
    use crate::{TriangleMesh, generate};
    use glam::DVec3;
    use std::fmt::Write;
    use std::io::Cursor;

    fn ball() -> TriangleMesh {
        generate::latitude_longitude_ellipsoid(DVec3::new(1.0, 0.8, 0.6), 12, 8).unwrap()
    }

    /// Written by an independent library.
    fn binary(mesh: &TriangleMesh) -> Vec<u8> {
        let triangles: Vec<stl_io::Triangle> = (0..)
            .take(mesh.triangles().len())
            .map(|i| stl_io::Triangle {
                normal: stl_io::Normal::new([0.0; 3]),
                vertices: mesh
                    .corners(i)
                    .map(|p| stl_io::Vertex::new(p.as_vec3().to_array())),
            })
            .collect();
        let mut bytes = Vec::new();
        stl_io::write_stl(&mut bytes, triangles.iter()).unwrap();
        bytes
    }

    fn text(mesh: &TriangleMesh) -> String {
        let mut out = String::from("SOLID\n");
        for i in (0..).take(mesh.triangles().len()) {
            out += "facet normal 0 0 0\n outer loop\n";
            for p in mesh.corners(i) {
                writeln!(out, "  vertex {:e} {:e} {:e}\r", p.x, p.y, p.z).unwrap();
            }
            out += " endloop\nendfacet\n";
        }
        out + "endsolid\n"
    }

    #[test]
    fn reads_what_another_library_writes() {
        let mut bytes = binary(&ball());
        let judge = stl_io::read_stl(&mut Cursor::new(&bytes)).unwrap();
        for header in [&b"\0\0\0\0\0\0"[..], b"solid "] {
            bytes[..header.len()].copy_from_slice(header);
            let mesh = stl(&bytes).unwrap().mesh;
            assert_eq!(
                mesh.positions().len(),
                ball().positions().len(),
                "corners are merged"
            );
            assert_eq!(mesh.triangles().len(), judge.faces.len());
            for (ours, theirs) in mesh.triangles().iter().zip(&judge.faces) {
                for (&v, &w) in ours.iter().zip(&theirs.vertices) {
                    let w: [f32; 3] = judge.vertices[w].into();
                    assert_eq!(
                        mesh.positions()[v as usize].as_vec3(),
                        glam::Vec3::from_array(w)
                    );
                }
            }
        }
    }

    #[test]
    fn text_keeps_full_precision() {
        let mesh = stl(text(&ball()).as_bytes()).unwrap().mesh;
        assert_eq!(
            mesh.signed_volume().to_bits(),
            ball().signed_volume().to_bits()
        );
    }

    /// What the module says of `stl_io`, so that the own reading goes when it is no longer true.
    #[test]
    fn the_library_falls_short_on_text_and_on_headers() {
        let judge = |bytes: &[u8]| stl_io::read_stl(&mut Cursor::new(bytes));
        let plain = text(&ball()).replace("SOLID", "solid ball");
        let theirs = judge(plain.as_bytes()).unwrap();
        assert_eq!(theirs.faces.len(), ball().triangles().len());
        let x = ball().corners(0)[1].x;
        assert!(
            theirs
                .vertices
                .iter()
                .all(|v| f64::from(v.0[0]).to_bits() != x.to_bits())
        );
        let two = plain.replace("endsolid", "endsolid ball\nsolid other\n")
            + &plain["solid ball\n".len()..];
        assert_eq!(
            judge(two.as_bytes()).unwrap().faces.len(),
            ball().triangles().len()
        );
        assert_eq!(
            stl(two.as_bytes()).unwrap().mesh.triangles().len(),
            2 * ball().triangles().len()
        );
        for header in ["SOLID", "solid"] {
            let other = plain.replacen("solid ball", header, 1);
            assert!(
                judge(other.as_bytes()).is_err() && stl(other.as_bytes()).is_ok(),
                "{header}"
            );
        }
        let vortex = plain.replacen("  vertex", "  vortex", 1);
        let (theirs, ours) = (judge(vortex.as_bytes()), stl(vortex.as_bytes()));
        assert!(!theirs.unwrap_err().to_string().contains("line"));
        assert!(ours.unwrap_err().to_string().contains("line 4"));
        // Bytes that are UTF-8 up to a line feed behind "solid ": text to the library.
        let mut misleading = binary(&ball());
        misleading[..8].copy_from_slice(b"solid a\n");
        assert!(judge(&misleading).is_err() && stl(&misleading).is_ok());
        let mut infinite = binary(&ball());
        infinite[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(judge(&infinite).is_ok() && stl(&infinite).is_err());
    }

    #[test]
    fn faults_are_named() {
        let good = text(&ball());
        let line = |bad: &str| stl(bad.as_bytes()).unwrap_err().to_string();
        assert!(line(&good[..good.len() / 2]).contains("line"));
        assert!(
            line(&good.replacen("vertex", "vertex nan", 1))
                .contains("line 4: coordinate `nan` is not finite")
        );
        assert!(
            line(&good.replacen("  vertex", "  vortex", 1)).contains("line 4: unexpected `vortex`")
        );
        assert_eq!(
            line("solid a\nendsolid a"),
            "no triangles: the STL file has no facets"
        );
        assert!(line("").contains("neither"));

        let bytes = binary(&ball());
        let error = stl(&bytes[..bytes.len() - 1]).unwrap_err().to_string();
        assert!(
            error.contains("promises 168 triangles, the file holds 167"),
            "{error}"
        );
        let mut huge = bytes.clone();
        huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
        assert!(stl(&huge).is_err());
        let mut infinite = bytes.clone();
        infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(
            stl(&infinite)
                .unwrap_err()
                .to_string()
                .contains("byte 96: triangle 0")
        );
        let mut longer = bytes;
        longer.extend([1, 2, 3]);
        assert_eq!(stl(&longer).unwrap().report.notes.len(), 1);
    }
}
