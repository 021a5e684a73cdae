//! Wavefront OBJ (Alias|Wavefront, "Object files", appendix B1): the polygonal part.
//!
//! Positions and indices are those that the library `tobj` reads, at `f64`; polygons are cut here. A pass
//! over the lines comes first, for what `tobj` 4.0 does in silence or without a line number:
//!
//! - it takes infinite coordinates and NaN, divides by a fourth number of `v`, and refuses a fifth;
//! - it makes points and lines of faces with one or two corners, and says nothing about `fo` and curves;
//! - it refuses the whole file for an empty `usemtl`, a comment behind a face, a continued line or a name
//!   that is not UTF-8, and takes a file with lines ended by `\r` for one line;
//! - bad numbers and indices are errors that do not say where.

mod scan;

use std::io::Read;

use glam::DVec3;

use super::ear_clip::{Triangulation, triangulate};
use super::validate::Draft;
use super::{LoadError, LoadReport, Loaded, at_line};
use scan::{Scanned, scan};

/// Most squares of corner numbers of concave faces in all: ear clipping of so many takes about ten seconds.
const MAX_WORK: usize = 1 << 32;

/// Reads an OBJ file: all objects and groups as one mesh, polygons cut into triangles, positions in the
/// file's unit and in full `f64` precision.
///
/// # Errors
/// Text that is not UTF-8-like, a malformed or infinite coordinate, a bad index, all with the line number;
/// no face with three corners.
pub fn obj(bytes: &[u8]) -> Result<Loaded, LoadError> {
    let mut scanned = scan(bytes)?;
    let parsed = parsed(&scanned)?;
    scanned.text = String::new();
    let positions = parsed.positions.as_chunks().0;
    let positions: Vec<DVec3> = positions.iter().map(|&p| DVec3::from_array(p)).collect();
    // No arities are given when there are triangles only.
    let mut arities = parsed.face_arities.iter().map(|&n| n as usize).skip(1);
    let mut rest = &parsed.indices[scanned.vertices..];
    let mut triangles = Vec::with_capacity(scanned.face_lines.len());
    let mut work = 0;
    for &line in &scanned.face_lines {
        let (polygon, behind) = rest.split_at(arities.next().unwrap_or(3));
        rest = behind;
        if let &[a, b, c] = polygon {
            triangles.push([a, b, c]);
        } else {
            let cut = triangulate(&positions, polygon, &mut triangles);
            told(cut, line, polygon.len(), &mut scanned.report)?;
            if cut == Triangulation::Concave {
                work += polygon.len() * polygon.len();
            }
            if work > MAX_WORK {
                let message =
                    "too many concave faces with too many corners: cut them into smaller ones";
                return Err(at_line(line, message));
            }
        }
    }
    let vertices = scanned.vertices;
    let draft = Draft {
        positions,
        triangles,
        report: scanned.report,
    };
    draft.validated(|| format!("the file has {vertices} vertices and no faces"))
}

/// Lets `tobj` read the cleaned text. It hands over only positions that a face uses, in the order of use:
/// a first face with all vertices in a row keeps the file's numbering.
fn parsed(scanned: &Scanned) -> Result<tobj::Mesh, LoadError> {
    let mut all = String::from("f");
    for index in 1..=scanned.vertices {
        all.push(' ');
        all.push_str(&index.to_string());
    }
    all.push('\n');
    let mut text = all.as_bytes().chain(scanned.text.as_bytes());
    let no_materials = |_: &std::path::Path| Err(tobj::LoadError::OpenFileFailed);
    tobj::load_obj_buf(&mut text, &tobj::LoadOptions::default(), no_materials)
        .and_then(|(models, _)| {
            let model = models.into_iter().next();
            model.ok_or(tobj::LoadError::GenericFailure)
        })
        .map(|model| model.mesh)
        .map_err(|error| LoadError::Library {
            library: "tobj",
            message: error.to_string(),
        })
}

/// Reports how a polygon was cut.
fn told(
    cut: Triangulation,
    line: usize,
    corners: usize,
    report: &mut LoadReport,
) -> Result<(), LoadError> {
    let what = match cut {
        Triangulation::Convex => return Ok(()),
        Triangulation::Concave => "concave polygons cut by ear clipping",
        Triangulation::Failed => "self-intersecting or collapsed polygons fanned",
        Triangulation::TooLong(limit) => {
            let message = format!("a concave face with {corners} corners: at most {limit}");
            return Err(at_line(line, message));
        }
    };
    report.note(what, format!("line {line}"));
    Ok(())
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

    /// What the module says of `tobj`, so that the pass over the lines goes when it is no longer true.
    #[test]
    fn the_scan_covers_what_the_library_does_not() {
        let raw = |text: &str| {
            let options = tobj::LoadOptions::default();
            let loaded = tobj::load_obj_buf(&mut text.as_bytes(), &options, |_| {
                Err(tobj::LoadError::OpenFileFailed)
            });
            loaded.map(|(models, _)| models[0].mesh.clone())
        };
        let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        assert_eq!(raw(triangle).unwrap().indices, [0, 1, 2]);
        // Taken as it is: not finite, divided, two corners, one line.
        let infinite = raw(&triangle.replace("1 0 0", "inf nan 0")).unwrap();
        assert!(infinite.positions[3].is_infinite() && infinite.positions[4].is_nan());
        let weighted = triangle.replace("1 0 0", "1 0 0 2");
        assert_eq!(
            raw(&weighted).unwrap().positions[3].to_bits(),
            0.5_f64.to_bits()
        );
        let short = raw(&format!("{triangle}f 1 2\n")).unwrap();
        assert_eq!(short.face_arities, [3, 2]);
        assert!(raw(&triangle.replace('\n', "\r")).is_err());
        // Refused, though the shape is clear.
        for harmless in [
            &weighted,
            &triangle.replace("1 0 0", "1 0 0 0.5 0.5"),
            &triangle.replace("f 1 2 3", "usemtl\nf 1 2 3 # face"),
            &triangle.replace("f 1 2 3", "f 1 2 \\\n 3"),
            &triangle.replace('\n', "\r"),
        ] {
            let mesh = obj(harmless.as_bytes()).unwrap().mesh;
            assert!((mesh.surface_area() - 0.5).abs() < 1e-15, "{harmless}");
            assert!(
                harmless == &weighted || raw(harmless).is_err(),
                "{harmless}"
            );
        }
    }

    #[test]
    fn vertices_keep_their_order_and_every_bit() {
        let loaded =
            obj(b"v 3 0.1 1e-300\nv 7 7 7\nv 0 2.2250738585072014e-308 0\nv 0 0 1\nf 4 3 1")
                .unwrap();
        let positions = loaded.mesh.positions();
        assert_eq!(
            positions[0].to_array().map(f64::to_bits),
            [3.0, 0.1, 1e-300].map(f64::to_bits)
        );
        assert_eq!(positions[1].y.to_bits(), f64::MIN_POSITIVE.to_bits());
        assert_eq!(loaded.mesh.triangles(), [[2, 1, 0]]);
    }

    #[test]
    fn arities_of_mixed_faces_are_kept_apart() {
        let loaded = obj(
            format!("v 5 5 5\n{SQUARE}v 2 0.5 0\nf 2 3 4 5\nf 3 6 4\nf 2 3 6 4 5\n").as_bytes(),
        )
        .unwrap();
        assert_eq!(loaded.mesh.triangles().len(), 2 + 1 + 3);
        assert!((loaded.mesh.surface_area() - (1.0 + 0.5 + 1.5)).abs() < 1e-15);
        // Triangles only, and three vertices: the library leaves the arities out.
        let three = obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1").unwrap();
        assert_eq!(three.mesh.triangles(), [[0, 1, 2], [2, 1, 0]]);
        // Fewer vertices than corners.
        assert_eq!(
            obj(b"v 0 0 0\nv 1 0 0\nf 1 2 1").unwrap().mesh.triangles(),
            [[0, 1, 0]]
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
