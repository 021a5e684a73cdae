//! glTF files made here: a tetrahedron, and what becomes of it when parts of its text are changed.

/// The text of a binary glTF file with four positions and four triangles.
pub(crate) const TETRAHEDRON: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4},
{"bufferView":1,"componentType":5123,"type":"SCALAR","count":12}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"buffers":[{"byteLength":72}]}"#;

/// The bytes behind it: `f32` positions, then `u16` indices.
pub(crate) fn binary() -> Vec<u8> {
    let positions = [[0_u8, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]];
    let triangles = [[0_u16, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let floats = positions.as_flattened().iter().map(|&x| f32::from(x));
    let mut bytes: Vec<u8> = floats.flat_map(f32::to_le_bytes).collect();
    bytes.extend(
        triangles
            .as_flattened()
            .iter()
            .flat_map(|v| v.to_le_bytes()),
    );
    bytes
}

/// A GLB from text and bytes.
pub(crate) fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut bytes = b"glTF\x02\0\0\0\0\0\0\0".to_vec();
    for (kind, content, pad) in [(b"JSON", json.as_bytes(), b' '), (b"BIN\0", binary, 0)] {
        let size = content.len().next_multiple_of(4);
        bytes.extend(u32::try_from(size).unwrap().to_le_bytes());
        bytes.extend(kind);
        bytes.extend(content);
        bytes.resize(bytes.len() + size - content.len(), pad);
    }
    let length = u32::try_from(bytes.len()).unwrap();
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes
}

/// The tetrahedron with one part of its text replaced.
pub(crate) fn with(from: &str, to: &str) -> Vec<u8> {
    assert!(TETRAHEDRON.contains(from), "{from}");
    glb(&TETRAHEDRON.replacen(from, to, 1), &binary())
}

/// The tetrahedron with other nodes; the scene begins at node 0.
pub(crate) fn with_nodes(nodes: &str) -> Vec<u8> {
    with(r#""nodes":[{"mesh":0}]"#, &format!(r#""nodes":[{nodes}]"#))
}

/// The tetrahedron with `"sparse"` positions: targets as bytes, values from the first positions of the file.
pub(crate) fn with_sparse(count: u64, targets: &[u8]) -> Vec<u8> {
    let mut bytes = binary();
    bytes.extend(targets);
    let view = format!(
        r#"{{"buffer":0,"byteOffset":72,"byteLength":{}}}"#,
        targets.len()
    );
    let json = TETRAHEDRON
        .replace(
            r#""VEC3","count":4"#,
            &format!(
                r#""VEC3","count":4,"sparse":{{"count":{count},"indices":{{"bufferView":2,"componentType":5121}},"values":{{"bufferView":0}}}}"#
            ),
        )
        .replace(r#""byteLength":24}]"#, &format!(r#""byteLength":24}},{view}]"#))
        .replace(r#""byteLength":72"#, &format!(r#""byteLength":{}"#, bytes.len()));
    glb(&json, &bytes)
}
