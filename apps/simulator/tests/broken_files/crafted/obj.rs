//! OBJ files, odd and broken.

use std::fmt::Write as _;

use super::judge_all;
use crate::Verdict::{Refused, Touched};

#[test]
#[expect(clippy::too_many_lines, reason = "one table")]
fn obj_oddities() {
    let cube = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    let faces = "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    let sound = format!("{cube}{faces}");
    let changed = |from: &str, to: &str| sound.replacen(from, to, 1).into_bytes();
    let units =
        |order: fn(u16) -> [u8; 2]| sound.encode_utf16().flat_map(order).collect::<Vec<u8>>();
    let long_face = |n: u32, radius: fn(u32) -> f64| {
        let mut text = String::from("v 0 0 1\n");
        let mut face = String::from("f");
        for i in 0..n {
            let (sin, cos) = (f64::from(i) / f64::from(n) * std::f64::consts::TAU).sin_cos();
            writeln!(text, "v {} {} 0", radius(i) * cos, radius(i) * sin).unwrap();
            write!(face, " {}", i + 2).unwrap();
        }
        format!("{text}{face}\nf 1 2 3\n").into_bytes()
    };
    let groups = |n: usize| format!("{cube}{}{faces}", "g\no\nusemtl\n".repeat(n)).into_bytes();
    let words = (0..200_000).fold(String::new(), |text, i| text + "w" + &i.to_string() + "\n");
    let cases = vec![
        ("sound", sound.clone().into_bytes(), Touched(12)),
        (
            "index_2_32",
            changed("f 4 3 2 1", "f 4294967297 3 2 1"),
            Refused(":9:1: vertex index 4294967297, but the file has 8"),
        ),
        (
            "index_2_64",
            changed("f 4 3 2 1", "f 18446744073709551617 3 2 1"),
            Refused(":9:1: "),
        ),
        (
            "index_minus_2_32",
            changed("f 4 3 2 1", "f -4294967295 3 2 1"),
            Refused(":9:1: vertex index `-4294967295`"),
        ),
        (
            "index_0",
            changed("f 4 3 2 1", "f 0 3 2 1"),
            Refused(":9:1: vertex index 0"),
        ),
        (
            "index_letter",
            changed("f 4 3 2 1", "f a 3 2 1"),
            Refused(":9:1: `a` is not a corner"),
        ),
        (
            "relative",
            changed("f 4 3 2 1", "f -5 -6/1 -7//1 -8/1/1"),
            Touched(12),
        ),
        ("groups_1e6", groups(1_000_000), Touched(12)),
        (
            "vertex_1e300",
            changed("v 1 1 1", "v 1 1e300 1"),
            Refused(":7:1: coordinate `1e300` is too large"),
        ),
        (
            "vertex_1e999",
            changed("v 1 1 1", "v 1 1e999 1"),
            Refused(":7:1: coordinate `1e999` is not finite"),
        ),
        (
            "vertex_1e39",
            changed("v 1 1 1", "v 1 -1e39 1"),
            Refused(":7:1: coordinate `-1e39` is too large"),
        ),
        (
            "vertex_nan",
            changed("v 1 1 1", "v 1 NaN 1"),
            Refused(":7:1: coordinate `NaN` is not finite"),
        ),
        (
            "vertex_short",
            changed("v 1 1 1", "v 1 1"),
            Refused(":7:1: vertex without z"),
        ),
        (
            "colours",
            changed("v 1 1 1", "v 1 1 1 0.5 0.5 0.5"),
            Touched(12),
        ),
        ("weight", changed("v 1 1 1", "v 1 1 1 0.5"), Touched(12)),
        ("face_2", changed("f 4 3 2 1", "f 4 3"), Touched(10)),
        (
            "faces_2",
            format!("{cube}f 1 2\nf 3\nf\n").into_bytes(),
            Refused("3 faces with fewer than three corners"),
        ),
        (
            "crlf",
            sound.replace('\n', "\r\n").into_bytes(),
            Touched(12),
        ),
        ("cr", sound.replace('\n', "\r").into_bytes(), Touched(12)),
        ("mixed_ends", changed("\nv", "\rv"), Touched(12)),
        (
            "tabs",
            sound.replace(' ', "\t \t").into_bytes(),
            Touched(12),
        ),
        (
            "continued",
            changed("f 4 3 2 1", "f 4 \\\n3 2\\\r\n1"),
            Touched(12),
        ),
        (
            "comment_path",
            changed("v 1 1 1", "# C:\\models\\\nv 1 1 1"),
            Touched(12),
        ),
        (
            "bom",
            [b"\xEF\xBB\xBF", sound.as_bytes()].concat(),
            Touched(12),
        ),
        (
            "utf16_le",
            units(u16::to_le_bytes),
            Refused("UTF-16 text (little-endian)"),
        ),
        (
            "utf16_be",
            units(u16::to_be_bytes),
            Refused("UTF-16 text (big-endian)"),
        ),
        (
            "zero_byte",
            changed("v 1 1 1", "v 1 1\0 1"),
            Refused("a zero byte"),
        ),
        (
            "latin1",
            [b"o Z\xE4hne\n", sound.as_bytes()].concat(),
            Touched(12),
        ),
        (
            "vertices_last",
            format!("{faces}{cube}").into_bytes(),
            Touched(12),
        ),
        (
            "no_end",
            sound.trim_end().to_owned().into_bytes(),
            Touched(12),
        ),
        (
            "inward",
            sound
                .lines()
                .map(|l| mirrored(l) + "\n")
                .collect::<String>()
                .into_bytes(),
            Touched(12),
        ),
        (
            "garbage_words",
            words.into_bytes(),
            Refused("more unknown statements skipped"),
        ),
        (
            "one_line",
            "v ".repeat(2_000_000).into_bytes(),
            Refused(":1:1: `v` is not a number"),
        ),
        (
            "concave_10000",
            long_face(10_000, |i| 1.0 + 0.5 * f64::from(i % 2)),
            Touched(9999),
        ),
        (
            "concave_20000",
            long_face(20_000, |i| 1.0 + 0.5 * f64::from(i % 2)),
            Refused("a concave face with 20000 corners"),
        ),
        ("convex_30000", long_face(30_000, |_| 1.0), Touched(29_999)),
    ];
    judge_all("obj", cases);
}

/// A line of an OBJ file seen in a mirror.
fn mirrored(line: &str) -> String {
    line.replacen("v 1", "v -1", 1)
}
