//! The container, versions, extensions and buffers of glTF files.

use super::judge_all;
use crate::Verdict::{Refused, Touched};
use crate::documents::{TETRAHEDRON, binary, glb, with};

#[test]
#[expect(clippy::too_many_lines, reason = "one table")]
fn gltf_containers_and_versions() {
    let sound = with("5126", "5126");
    let changed = |at: usize, bytes: &[u8]| {
        let mut glb = sound.clone();
        glb[at..at + bytes.len()].copy_from_slice(bytes);
        glb
    };
    let text = u32::from_le_bytes(sound[12..16].try_into().unwrap()) as usize;
    let max = [0xFF; 4];
    let asset = r#""asset":{"version":"2.0"}"#;
    let other = |to: &str| with(asset, to);
    let required = |names: &str| {
        with(
            r#""scene":0"#,
            &format!(r#""extensionsRequired":[{names}],"scene":0"#),
        )
    };
    let mut padded = TETRAHEDRON.as_bytes().to_vec();
    padded.extend([0; 9]);
    let padded = String::from_utf8(padded).unwrap();
    // A texture without source, which the specification allows, and with it more that no triangle needs.
    let textures =
        r#""textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}],"materials":7,"scene":0"#;
    let draco = with(
        r#""scene":0"#,
        r#""extensionsRequired":["KHR_draco_mesh_compression"],"nodes":3,"scene":0"#,
    );
    let cases = vec![
        (
            "length_0",
            b"glTF\x02\0\0\0\0\0\0\0".to_vec(),
            Refused("a length of 0 bytes"),
        ),
        (
            "only_magic",
            b"glTF".to_vec(),
            Refused("ends within a header"),
        ),
        ("empty", Vec::new(), Refused("neither GLB")),
        (
            "length_max",
            changed(8, &max),
            Refused("states 4294967295 bytes"),
        ),
        (
            "chunk_max",
            changed(12, &max),
            Refused("a chunk of 4294967295 bytes"),
        ),
        (
            "chunk_of_binary_max",
            changed(20 + text, &max),
            Refused("a chunk of 4294967295 bytes"),
        ),
        ("version_1", changed(4, &[1]), Refused("GLB version 1")),
        (
            "cut",
            sound[..sound.len() - 30].to_vec(),
            Refused("it is truncated"),
        ),
        (
            "no_binary",
            glb(TETRAHEDRON, &[]),
            Refused("byteLength is 72, but only 0"),
        ),
        ("zero_padding", glb(&padded, &binary()), Touched(4)),
        (
            "asset_1",
            other(r#""asset":{"version":"1.0"}"#),
            Refused("asset.version: `1.0`"),
        ),
        (
            "asset_3",
            other(r#""asset":{"version":"3.0"}"#),
            Refused("asset.version: `3.0`"),
        ),
        (
            "asset_2_1",
            other(r#""asset":{"version":"2.1"}"#),
            Touched(4),
        ),
        (
            "asset_min",
            other(r#""asset":{"version":"2.1","minVersion":"2.1"}"#),
            Refused("asset.minVersion: `2.1`"),
        ),
        (
            "asset_text",
            other(r#""asset":{"version":2}"#),
            Refused("glTF JSON: invalid type"),
        ),
        (
            "no_asset",
            other(r#""generator":"x""#),
            Refused("missing field `asset`"),
        ),
        (
            "meshopt",
            required(r#""EXT_meshopt_compression""#),
            Refused("extension EXT_meshopt_compression, which"),
        ),
        (
            "quantized",
            required(r#""KHR_mesh_quantization""#),
            Refused("extension KHR_mesh_quantization, which"),
        ),
        (
            "unknown",
            required(r#""KHR_texture_transform","VENDOR_x","VENDOR_y""#),
            Refused("extensions VENDOR_x, VENDOR_y"),
        ),
        ("harmless", required(r#""KHR_materials_unlit""#), Touched(4)),
        (
            "draco_and_worse",
            draco,
            Refused("extension KHR_draco_mesh_compression"),
        ),
        ("textures", with(r#""scene":0"#, textures), Touched(4)),
        (
            "extras",
            with(
                r#"{"mesh":0}"#,
                r#"{"mesh":0,"extras":[1,{"a":null}],"name":"n"}"#,
            ),
            Touched(4),
        ),
        (
            "scene_empty",
            with(r#""scenes":[{"nodes":[0]}]"#, r#""scenes":[{}]"#),
            Refused("no triangles"),
        ),
        (
            "no_scenes",
            with(r#""scene":0,"scenes":[{"nodes":[0]}],"#, ""),
            Touched(4),
        ),
        ("strip", with(r#""indices":1"#, r#""mode":5"#), Touched(2)),
        (
            "lines",
            with(r#""indices":1"#, r#""mode":1"#),
            Refused("points or lines skipped"),
        ),
        (
            "mode_7",
            with(r#""indices":1"#, r#""mode":7"#),
            Refused("mode is none of 0 to 6"),
        ),
    ];
    judge_all("glb", cases);

    let uri = |uri: &str| {
        TETRAHEDRON.replace(
            r#""byteLength":72"#,
            &format!(r#""uri":"{uri}","byteLength":72"#),
        )
    };
    let utf16 = TETRAHEDRON
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    let cases = vec![
        (
            "endless",
            uri("../../../../../../../../dev/zero").into_bytes(),
            Refused(ENDLESS),
        ),
        (
            "escaped",
            uri("%2e%2E/../../../../../../dev/zero").into_bytes(),
            Refused(ENDLESS),
        ),
        (
            "absolute",
            uri("/dev/zero").into_bytes(),
            Refused("is not a relative path"),
        ),
        (
            "short_data",
            uri("data:a/b;base64,AAAA").into_bytes(),
            Refused("byteLength is 72, but only 3"),
        ),
        ("utf16", utf16, Refused("UTF-16 text (little-endian)")),
        (
            "no_uri",
            TETRAHEDRON.as_bytes().to_vec(),
            Refused("buffers[0]: has no data"),
        ),
    ];
    judge_all("gltf", cases);
}

/// What a device without end is told, or the path that leads nowhere where there is none.
const ENDLESS: &str = if cfg!(unix) {
    "not a file"
} else {
    "buffers[0]: "
};
