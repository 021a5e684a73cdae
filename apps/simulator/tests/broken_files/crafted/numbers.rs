//! Numbers, indices and ranges of glTF files.

use std::fmt::Write as _;

use super::judge_all;
use crate::Verdict::{Flat, Refused, Touched};
use crate::documents::{TETRAHEDRON, binary, glb, with, with_nodes, with_sparse};

#[test]
#[expect(clippy::too_many_lines, reason = "one table")]
fn gltf_numbers_out_of_range() {
    let (v, i) = (r#""VEC3","count":4"#, r#""SCALAR","count":12"#);
    let stride = r#""buffer":0,"byteLength":48"#;
    let offset = r#""byteOffset":48"#;
    let huge = "18446744073709551615";
    let mesh = r#"{"mesh":0}"#;
    let restart = {
        let mut bytes = binary();
        bytes[70..72].copy_from_slice(&[0xFF, 0xFF]);
        glb(TETRAHEDRON, &bytes)
    };
    let cases = vec![
        ("sound", with(v, v), Touched(4)),
        (
            "positions_4e9",
            with(v, r#""VEC3","count":4000000000"#),
            Refused("accessors[0]: 4000000000 elements do not fit"),
        ),
        (
            "indices_4e9",
            with(i, r#""SCALAR","count":4000000000"#),
            Refused("accessors[1]: 4000000000 elements"),
        ),
        (
            "count_2_64",
            with(v, &format!(r#""VEC3","count":{huge}"#)),
            Refused("do not fit"),
        ),
        (
            "count_negative",
            with(v, r#""VEC3","count":-1"#),
            Refused("glTF JSON: invalid value"),
        ),
        (
            "count_fraction",
            with(v, r#""VEC3","count":1.5"#),
            Refused("glTF JSON: invalid type"),
        ),
        (
            "count_1e999",
            with(v, r#""VEC3","count":1e999"#),
            Refused("glTF JSON: number out of range"),
        ),
        (
            "view_offset",
            with(offset, &format!(r#""byteOffset":{huge}"#)),
            Refused("lie beyond the 72 of buffers[0]"),
        ),
        (
            "accessor_offset",
            with(v, &format!(r#""VEC3","byteOffset":{huge},"count":4"#)),
            Refused("do not fit"),
        ),
        (
            "accessor_offset_1",
            with(v, r#""VEC3","byteOffset":1,"count":4"#),
            Refused("do not fit"),
        ),
        (
            "view_length",
            with(stride, &format!(r#""buffer":0,"byteLength":{huge}"#)),
            Refused("bufferViews[0]: bytes 0 to"),
        ),
        (
            "stride_small",
            with(stride, r#""buffer":0,"byteLength":48,"byteStride":4"#),
            Refused("byteStride 4 is smaller than the 12"),
        ),
        (
            "stride_0",
            with(stride, r#""buffer":0,"byteLength":48,"byteStride":0"#),
            Refused("byteStride 0 is smaller"),
        ),
        (
            "stride_huge",
            with(
                stride,
                &format!(r#""buffer":0,"byteLength":48,"byteStride":{huge}"#),
            ),
            Refused("do not fit"),
        ),
        (
            "no_buffer",
            with(stride, r#""buffer":7,"byteLength":48"#),
            Refused("refers to buffers[7]"),
        ),
        (
            "buffer_short",
            with(r#"[{"byteLength":72}]"#, r#"[{"byteLength":4000000000}]"#),
            Refused("byteLength is 4000000000, but only 72"),
        ),
        (
            "scene_missing",
            with(r#""scene":0"#, r#""scene":3"#),
            Refused("scene: refers to number 3"),
        ),
        (
            "mesh_missing",
            with_nodes(r#"{"mesh":4294967295}"#),
            Refused("nodes[0].mesh: refers to number 4294967295"),
        ),
        (
            "mesh_2_32",
            with_nodes(r#"{"mesh":4294967296}"#),
            Refused("nodes[0].mesh: 4294967296 is out of range"),
        ),
        (
            "position_2_32",
            with(r#""POSITION":0"#, r#""POSITION":4294967296"#),
            Refused("attributes.POSITION: 4294967296 is out of range"),
        ),
        (
            "component_2_32",
            with("5126", "4294972422"),
            Refused("accessors[0].componentType: 4294972422 is out of range"),
        ),
        (
            "node_missing",
            with(r#""scenes":[{"nodes":[0]}]"#, r#""scenes":[{"nodes":[9]}]"#),
            Refused("scenes[0].nodes[0]: refers to number 9"),
        ),
        (
            "component",
            with("5126", "9999"),
            Refused("accessors[0]: componentType is not one"),
        ),
        (
            "type",
            with("VEC3", "VEC9"),
            Refused("accessors[0]: has the wrong type"),
        ),
        (
            "integers",
            with("5126", "5122"),
            Refused("KHR_mesh_quantization"),
        ),
        (
            "restart",
            restart,
            Refused("is 65535, the value that restarts primitives"),
        ),
        ("sparse", with_sparse(2, &[1, 3]), Flat(2)),
        (
            "sparse_beyond",
            with_sparse(2, &[1, 4]),
            Refused("accessors[0].sparse: index 1 is 4"),
        ),
        (
            "sparse_twice",
            with_sparse(2, &[1, 1]),
            Refused("sparse indices must increase"),
        ),
        (
            "sparse_unsorted",
            with_sparse(2, &[3, 1]),
            Refused("sparse indices must increase"),
        ),
        (
            "sparse_4e9",
            with_sparse(4_000_000_000, &[1, 3]),
            Refused("accessors[0].sparse: 4000000000 elements"),
        ),
        (
            "scale_1e999",
            with_nodes(r#"{"mesh":0,"scale":[1e999,1,1]}"#),
            Refused("number out of range"),
        ),
        (
            "scale_1e300",
            with_nodes(r#"{"mesh":0,"scale":[1e300,1,1]}"#),
            Refused("not finite"),
        ),
        (
            "translation",
            with_nodes(r#"{"mesh":0,"translation":[1e30,0,0]}"#),
            Refused("nodes[0]: its transforms take a vertex"),
        ),
        (
            "product",
            with_nodes(&nested(12, r#""scale":[1e30,1e30,1e30]"#)),
            Refused("overflows"),
        ),
        (
            "product_large",
            with_nodes(&nested(2, r#""scale":[1e8,1e8,1e8]"#)),
            Refused("nodes[2]: its transforms take"),
        ),
        (
            "vanishing",
            with_nodes(&nested(12, r#""scale":[1e-30,1e-30,1e-30]"#)),
            Refused("a singular transform"),
        ),
        (
            "singular",
            with_nodes(r#"{"mesh":0,"matrix":[1,2,3,0,2,4,6,0,0,0,1,0,0,0,0,1]}"#),
            Refused("a singular transform"),
        ),
        (
            "sheared",
            with_nodes(r#"{"mesh":0,"matrix":[1,0,0,0,5,1,0,0,0,0,1,0,0,0,0,1]}"#),
            Touched(4),
        ),
        (
            "mirrored",
            with_nodes(r#"{"mesh":0,"scale":[-1,1,1]}"#),
            Touched(4),
        ),
        ("mesh_0", with_nodes(mesh), Touched(4)),
    ];
    judge_all("glb", cases);
}

/// A chain of nodes with the mesh at its end.
pub(super) fn nested(count: usize, transform: &str) -> String {
    let mut nodes = String::new();
    for child in 1..=count {
        write!(nodes, r#"{{{transform},"children":[{child}]}},"#).unwrap();
    }
    nodes + r#"{"mesh":0}"#
}
