//! STL files, odd and broken.

use std::fmt::Write as _;

use super::judge_all;
use crate::Verdict::{Refused, Touched};

#[test]
#[expect(clippy::too_many_lines, reason = "one table")]
fn stl_oddities() {
    let corners = [[0_u8, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let faces = [[0_usize, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mut text = String::new();
    let mut records = Vec::new();
    for face in faces {
        text += "facet normal nan 0 0\nouter loop\n";
        records.extend([0; 12]);
        for [x, y, z] in face.map(|v| corners[v]) {
            writeln!(text, "vertex {x} {y} {z}").unwrap();
            records.extend([x, y, z].iter().flat_map(|&x| f32::from(x).to_le_bytes()));
        }
        text += "endloop\nendfacet\n";
        records.extend([0; 2]);
    }
    let solid = |name: &str| format!("solid {name}\n{text}endsolid {name}\n");
    let binary = |header: &[u8], count: u32| {
        let mut bytes = header.to_vec();
        bytes.resize(80, 0);
        [&bytes[..], &count.to_le_bytes(), &records].concat()
    };
    let number = |value: f32| {
        let mut bytes = binary(b"x", 4);
        bytes[96..100].copy_from_slice(&value.to_le_bytes());
        bytes
    };
    let cases = vec![
        ("text", solid("a").into_bytes(), Touched(4)),
        (
            "upper_case",
            solid("a").to_uppercase().into_bytes(),
            Touched(4),
        ),
        (
            "two_solids",
            (solid("a") + &solid("b").replace("vertex 1", "vertex 3")).into_bytes(),
            Touched(8),
        ),
        ("no_solid", text.clone().into_bytes(), Touched(4)),
        (
            "no_endsolid",
            format!("solid a\n{text}").into_bytes(),
            Touched(4),
        ),
        (
            "cut_in_facet",
            solid("a")[..150].to_owned().into_bytes(),
            Refused(":12:1: expected `vertex x y z`"),
        ),
        (
            "text_nan",
            solid("a")
                .replacen("vertex 0", "vertex nan", 1)
                .into_bytes(),
            Refused(":4:1: coordinate `nan` is not finite"),
        ),
        (
            "text_1e300",
            solid("a")
                .replacen("vertex 0", "vertex 1e300", 1)
                .into_bytes(),
            Refused(":4:1: coordinate `1e300` is too large"),
        ),
        (
            "quads",
            solid("a")
                .replacen("endloop", "vertex 5 5 5\nendloop", 1)
                .into_bytes(),
            Refused("a facet with 4 vertices"),
        ),
        (
            "no_facets",
            b"solid a\nendsolid a\n".to_vec(),
            Refused("no facets"),
        ),
        ("empty", Vec::new(), Refused("neither a text STL")),
        (
            "utf16",
            solid("a")
                .encode_utf16()
                .flat_map(u16::to_le_bytes)
                .collect(),
            Refused("UTF-16"),
        ),
        ("binary", binary(b"x", 4), Touched(4)),
        ("binary_solid", binary(b"solid x", 4), Touched(4)),
        ("binary_utf16_mark", binary(b"\xFF\xFEx", 4), Touched(4)),
        (
            "count_4e9",
            binary(b"x", 4_000_000_000),
            Refused("promises 4000000000 triangles, the file holds 4"),
        ),
        (
            "count_max",
            binary(b"solid x", u32::MAX),
            Refused("promises 4294967295 triangles"),
        ),
        (
            "count_0",
            binary(b"x", 0),
            Refused("bytes after the last triangle ignored"),
        ),
        (
            "trailing",
            [binary(b"x", 4), vec![1; 77]].concat(),
            Touched(4),
        ),
        (
            "cut",
            binary(b"x", 4)[..200].to_vec(),
            Refused("promises 4 triangles, the file holds 2"),
        ),
        (
            "header_only",
            binary(b"x", 0)[..84].to_vec(),
            Refused("no facets"),
        ),
        (
            "nan",
            number(f32::NAN),
            Refused("byte 96: triangle 0 has coordinate NaN, which is not finite"),
        ),
        (
            "huge",
            number(3e38),
            Refused("byte 96: triangle 0 has coordinate 3e38, which is too large"),
        ),
    ];
    judge_all("stl", cases);
}
