//! Every file under `bad/` and `gltf/` of the data folder, with its verdict.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::Verdict::{self, Flat, Refused, Touched};
use crate::{check, judge};

/// File, verdict, why.
const TABLE: [(&str, Verdict, &str); 77] = [
    (
        "bad/gltf/assimp_BoxBadNormals.glb",
        Touched(12),
        "stored normals are not used",
    ),
    (
        "bad/gltf/assimp_IncorrectVertexArrays/Cube.gltf",
        Touched(46),
        "left-over indices are dropped and told, lines skipped",
    ),
    (
        "bad/gltf/assimp_MissingBin.gltf",
        Refused("buffers[0]: `BoxTextured0.bin`"),
        "its buffer is not there",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_00.gltf",
        Refused("points or lines skipped"),
        "points",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_01.gltf",
        Refused("points or lines skipped"),
        "lines",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_04.gltf",
        Flat(2),
        "a list of triangles in a plane",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_05.gltf",
        Flat(2),
        "a strip",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_06.gltf",
        Flat(2),
        "a fan",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_07.gltf",
        Refused("points or lines skipped"),
        "indexed points",
    ),
    (
        "bad/gltf/assimp_PrimitiveMode/Mesh_PrimitiveMode_11.gltf",
        Flat(2),
        "an indexed strip or fan",
    ),
    (
        "bad/gltf/assimp_SceneWithoutNodes.gltf",
        Refused("no triangles: the file has 0 mesh(es)"),
        "an empty scene",
    ),
    (
        "bad/gltf/assimp_texcoord_crash.gltf",
        Touched(10),
        "the fault is in texture coordinates",
    ),
    (
        "bad/gltf/draco/Box_Draco.glb",
        Refused("extension KHR_draco_mesh_compression"),
        "compressed",
    ),
    (
        "bad/gltf/meshopt/meshopt-no-fallback.gltf",
        Refused("EXT_meshopt_compression"),
        "compressed",
    ),
    (
        "bad/gltf/val_accessor_data/invalid_elements_float.gltf",
        Refused("accessors[0]: element 0 is [-inf, NaN, inf]"),
        "no mesh, and numbers that are none",
    ),
    (
        "bad/gltf/val_accessor_data/out_of_range_elements_float.gltf",
        Refused("no triangles: the file has 0 mesh(es)"),
        "no mesh; stated bounds are not relied upon",
    ),
    (
        "bad/gltf/val_accessor_data/out_of_range_elements_uint16.gltf",
        Refused("no triangles: the file has 0 mesh(es)"),
        "no mesh; stated bounds are not relied upon",
    ),
    (
        "bad/gltf/val_accessor_small_stride.gltf",
        Refused("byteStride 4 is smaller"),
        "elements would overlap",
    ),
    (
        "bad/gltf/val_accessor_unresolved_bufferviews.gltf",
        Refused("refers to bufferViews[0]"),
        "there is none",
    ),
    (
        "bad/gltf/val_asset_invalid_version.gltf",
        Refused("asset.version: `1.0.1-dev`"),
        "another version",
    ),
    (
        "bad/gltf/val_buffer_invalid_uri_data.gltf",
        Refused("buffers[0]: its data: URI is broken"),
        "no media type",
    ),
    (
        "bad/gltf/val_buffer_non_relative_uri.gltf",
        Refused("`http://example.com/buffer.bin` is not a relative path"),
        "nothing is fetched",
    ),
    (
        "bad/gltf/val_buffer_view_invalid_length.gltf",
        Refused("bufferViews[0]: bytes 0 to 5 lie beyond"),
        "beyond its buffer",
    ),
    (
        "bad/gltf/val_buffer_wrong_bytelength.glb",
        Refused("byteLength is 17, but only 16"),
        "a binary chunk cut short",
    ),
    (
        "bad/gltf/val_glb_chunk_too_big.glb",
        Refused("a length of 13 bytes"),
        "shorter than any GLB",
    ),
    (
        "bad/gltf/val_glb_empty_json_chunk.glb",
        Refused("the JSON chunk is empty"),
        "nothing to read",
    ),
    (
        "bad/gltf/val_glb_extra_data.glb",
        Refused("after the end of the GLB ignored"),
        "would load, but has no mesh",
    ),
    (
        "bad/gltf/val_glb_invalid_magic.glb",
        Refused("neither GLB"),
        "no GLB",
    ),
    (
        "bad/gltf/val_glb_json_and_two_buffers.glb",
        Refused("a second binary chunk"),
        "which one is meant?",
    ),
    (
        "bad/gltf/val_glb_misplaced_bin_chunk.glb",
        Refused("binary chunks behind others"),
        "would load, but has no mesh",
    ),
    (
        "bad/gltf/val_glb_only_bin_chunk.glb",
        Refused("the first chunk is not JSON"),
        "no JSON",
    ),
    (
        "bad/gltf/val_glb_truncated_chunk_data.glb",
        Refused("the file has 47: it is truncated"),
        "cut short",
    ),
    (
        "bad/gltf/val_glb_two_bin_chunks.glb",
        Refused("the first chunk is not JSON"),
        "no JSON",
    ),
    (
        "bad/gltf/val_glb_two_empty_json_chunks.glb",
        Refused("a second JSON chunk"),
        "which one is meant?",
    ),
    (
        "bad/gltf/val_glb_unaligned_chunk.glb",
        Refused("no multiple of 4"),
        "would load, but has no mesh",
    ),
    (
        "bad/gltf/val_glb_valid.glb",
        Refused("no triangles: the file has 0 mesh(es)"),
        "sound, but has no mesh",
    ),
    (
        "bad/gltf/val_glb_zero_chunk_header.glb",
        Refused("the first chunk is not JSON"),
        "no JSON",
    ),
    (
        "bad/gltf/val_json_bom.gltf",
        Refused("byte order mark ignored"),
        "would load, but has no mesh",
    ),
    (
        "bad/gltf/val_json_invalid_object.gltf",
        Refused("nor JSON text"),
        "an array, not an object",
    ),
    (
        "bad/gltf/val_mesh_accessor_unequal_count.gltf",
        Refused("accessors[0]: has no data"),
        "positions without data",
    ),
    (
        "bad/gltf/val_mesh_empty_object.gltf",
        Refused("missing field `primitives`"),
        "a mesh of nothing",
    ),
    (
        "bad/gltf/val_mesh_position_accessor_invalid_format.gltf",
        Refused("accessors[0]: has the wrong type"),
        "positions of the wrong type",
    ),
    (
        "bad/gltf/val_mesh_primitive_no_position.gltf",
        Refused("primitives without POSITION"),
        "no positions",
    ),
    (
        "bad/gltf/val_mesh_unresolved_positions.gltf",
        Refused("accessors[0]: does not exist"),
        "positions that are not there",
    ),
    (
        "bad/gltf/val_node_matrix_indecomposable.gltf",
        Refused("nodes[0]: the last row of matrix"),
        "a projection",
    ),
    (
        "bad/gltf/val_node_node_loop.gltf",
        Refused("loop of nodes"),
        "a node above itself",
    ),
    (
        "bad/gltf/val_node_node_parent_override.gltf",
        Refused("nodes with several parents"),
        "would load, but has no mesh",
    ),
    (
        "bad/gltf/val_node_unresolved_child_node.gltf",
        Refused("nodes[0].children[0]: refers to number 1"),
        "a child that is not there",
    ),
    (
        "bad/gltf/val_root_empty_object.gltf",
        Refused("missing field `asset`"),
        "no version",
    ),
    (
        "bad/obj/assimp_box_UTF16BE.obj",
        Refused("UTF-16 text (big-endian byte order mark): save the file as UTF-8"),
        "another encoding",
    ),
    (
        "bad/obj/assimp_box_without_lineending.obj",
        Touched(12),
        "the last line has no end",
    ),
    (
        "bad/obj/assimp_empty.obj",
        Refused("no triangles: the file has 0 vertices"),
        "empty",
    ),
    (
        "bad/obj/assimp_malformed2.obj",
        Touched(10),
        "one face has too few corners: dropped and told",
    ),
    (
        "bad/obj/assimp_number_formats.obj",
        Refused(":11:1: `3.1+e2` is not a number"),
        "no number",
    ),
    (
        "bad/obj/assimp_testmixed.obj",
        Touched(12),
        "lines and points among the faces are skipped and told",
    ),
    (
        "bad/obj/chai3d_face.obj",
        Touched(806),
        "wound in both senses: only its hull can be touched",
    ),
    (
        "bad/obj/draco_degenerate_mesh.obj",
        Flat(1),
        "one triangle without area",
    ),
    (
        "bad/obj/draco_inf_nan.obj",
        Refused(":1:1: coordinate `inf` is not finite"),
        "no numbers",
    ),
    (
        "bad/obj/draco_multiple_tetrahedrons.obj",
        Touched(20),
        "five shells",
    ),
    (
        "bad/obj/draco_test_lines.obj",
        Refused("line or point elements skipped"),
        "lines only",
    ),
    (
        "bad/obj/tinyobj_catmark_torus_creases0.obj",
        Touched(64),
        "unknown statements are skipped and told",
    ),
    (
        "bad/obj/tinyobj_invalid-face-definition.obj",
        Refused("faces with fewer than three corners"),
        "no face has three corners",
    ),
    (
        "bad/obj/tinyobj_invalid-relative-vertex-index.obj",
        Refused(":1:1: vertex index `-4`"),
        "before the first vertex",
    ),
    (
        "bad/obj/tinyobj_issue-295-triangulation-failure.obj",
        Touched(28),
        "corners on straight sides",
    ),
    (
        "bad/obj/tinyobj_missing_material_file.obj",
        Touched(36),
        "materials are not needed",
    ),
    (
        "bad/obj/tobj_invalid_index.obj",
        Refused(":12:1: vertex index 7, but the file has 6"),
        "behind the last vertex",
    ),
    ("bad/obj/trimesh_jacked.obj", Touched(12), "odd spacing"),
    (
        "bad/obj/trimesh_negative_indices.obj",
        Touched(12),
        "counted from the end",
    ),
    (
        "bad/obj/trimesh_notenoughindices.obj",
        Flat(1),
        "one face has too few corners, the other is flat",
    ),
    ("bad/obj/trimesh_polygonfaces.obj", Touched(3), "polygons"),
    (
        "gltf/Box/Box.glb",
        Touched(12),
        "a nested node with a rotation",
    ),
    ("gltf/Box/Box.gltf", Touched(12), "an external buffer"),
    (
        "gltf/BoxInterleaved.glb",
        Touched(12),
        "interleaved positions",
    ),
    (
        "gltf/CubeScaledInstances/cube_att.gltf",
        Touched(48),
        "one mesh below four parents",
    ),
    (
        "gltf/Lantern/Lantern.gltf",
        Touched(5394),
        "its textures are missing",
    ),
    (
        "gltf/SimpleSparseAccessor/SimpleSparseAccessor.gltf",
        Flat(12),
        "sparse positions in a plane",
    ),
    ("gltf/trimesh_nested.glb", Touched(36), "nested nodes"),
];

/// Mesh files below a folder, sorted.
fn mesh_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let extension = path.extension().and_then(|e| e.to_str());
        if path.is_dir() {
            files.extend(mesh_files(&path));
        } else if extension.is_some_and(|e| ["obj", "stl", "gltf", "glb"].contains(&e)) {
            files.push(path);
        }
    }
    files.sort();
    files
}

#[test]
fn every_file_of_the_data_folder_has_its_verdict() {
    let Some(data) = std::env::var_os("PLIANT_DATA").map(PathBuf::from) else {
        writeln!(
            std::io::stderr(),
            "skipped {} cases: PLIANT_DATA is not set",
            TABLE.len()
        )
        .unwrap();
        return;
    };
    let work = tempfile::tempdir().unwrap();
    let mut files = mesh_files(&data.join("bad"));
    files.extend(mesh_files(&data.join("gltf")));
    let mut judged = 0;
    for path in &files {
        let name = path.strip_prefix(&data).unwrap().display().to_string();
        let Some((_, verdict, _)) = TABLE.iter().find(|row| row.0 == name) else {
            // A file that came later: anything but a crash will do, until somebody says what is right.
            let outcome = check(path, work.path());
            assert!(
                matches!(outcome.code, Some(0 | 1)),
                "{name}: {}",
                outcome.err
            );
            continue;
        };
        judged += 1;
        judge(&name, path, work.path(), *verdict);
    }
    assert_eq!(judged, TABLE.len(), "files of the table are missing");
}
