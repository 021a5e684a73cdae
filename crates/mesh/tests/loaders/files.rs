//! Real and broken files of the data folder.

use pliant_mesh::inspect;

use crate::{data, files_below, load_file};

#[test]
fn models_have_the_known_numbers() {
    let Some(folder) = data(11) else { return };
    // Name, vertices, faces, shells, Euler number, convex.
    let table = [
        ("derived_molar_access_mm_8k", 4087, 8178, 1, -2, false),
        ("derived_molar_access_mm_55k", 27461, 54926, 1, -2, false),
        ("chai3d_molar_with_pulp", 4384, 8768, 2, 0, false),
        ("generated_convex_ellipsoid_12672", 6338, 12672, 1, 2, true),
        ("spot", 2930, 5856, 1, 2, false),
        ("trimesh_round_tube", 560, 1120, 1, 0, false),
        ("trimesh_featuretype", 1722, 3476, 1, -16, false),
        ("trimesh_angle_block", 352, 704, 1, 0, false),
        ("trimesh_unit_sphere", 642, 1280, 1, 2, true),
        ("plus_stylus_example", 410, 816, 1, 2, false),
        ("plus_needle_20cm", 80, 152, 2, 4, false),
    ];
    for (name, vertices, faces, shells, euler, convex) in table {
        let loaded = load_file(&folder.join(format!("meshes/{name}.obj")))
            .unwrap_or_else(|e| panic!("{name}: {e}"));
        let report = inspect(&loaded.mesh);
        let found = (
            report.vertices,
            report.faces,
            report.shells,
            report.euler_number,
            report.convex.is_ok(),
        );
        assert_eq!(found, (vertices, faces, shells, euler, convex), "{name}");
        assert!(
            report.closed && report.manifold.is_ok(),
            "{name}: {:?}",
            report.manifold
        );
    }
    let spot = load_file(&folder.join("meshes/spot.obj")).unwrap().mesh;
    let judge = tobj::load_obj_buf(
        &mut std::fs::read(folder.join("meshes/spot.obj"))
            .unwrap()
            .as_slice(),
        &tobj::LoadOptions {
            triangulate: true,
            ..tobj::LoadOptions::default()
        },
        |_| Err(tobj::LoadError::GenericFailure),
    );
    let (models, _) = judge.unwrap();
    let judged: usize = models.iter().map(|m| m.mesh.indices.len() / 3).sum();
    assert_eq!(spot.triangles().len(), judged);
}

#[test]
fn gltf_models_have_the_known_numbers() {
    let Some(folder) = data(7) else { return };
    let load = |name: &str| {
        load_file(&folder.join("gltf").join(name))
            .unwrap_or_else(|e| panic!("{name}: {e}"))
            .mesh
    };
    for name in ["Box/Box.gltf", "Box/Box.glb", "BoxInterleaved.glb"] {
        let report = inspect(&load(name));
        assert_eq!((report.vertices, report.faces), (8, 12), "{name}");
        assert!(
            report.convex.is_ok() && (report.signed_volume - 1.0).abs() < 1e-6,
            "{name}"
        );
    }
    // Unit cubes scaled by 1, 4, 2 and 3: one node below four parents.
    let cubes = load("CubeScaledInstances/cube_att.gltf");
    assert_eq!(cubes.triangles().len(), 4 * 12);
    assert!(
        (cubes.signed_volume() - 100.0).abs() < 1e-5,
        "{}",
        cubes.signed_volume()
    );
    assert_eq!(
        load("SimpleSparseAccessor/SimpleSparseAccessor.gltf")
            .triangles()
            .len(),
        12
    );
    let lantern = load("Lantern/Lantern.gltf");
    assert_eq!(lantern.triangles().len(), 5394);
    assert!(load("trimesh_nested.glb").signed_volume() > 0.0);
}

#[test]
fn broken_files_give_a_mesh_or_a_clear_error() {
    let Some(folder) = data(76) else { return };
    let files = files_below(&folder.join("bad"));
    assert!(files.len() >= 70, "{}", files.len());
    let mut outcomes = Vec::new();
    for path in &files {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        match load_file(path) {
            Ok(loaded) => {
                inspect(&loaded.mesh);
                outcomes.push((
                    name,
                    format!(
                        "{} triangles, {:?}",
                        loaded.mesh.triangles().len(),
                        loaded.report.notes
                    ),
                ));
            }
            Err(error) => outcomes.push((name, error.to_string())),
        }
    }
    for (name, outcome) in &outcomes {
        println!("{name}: {outcome}");
    }
    let expected = [
        (
            "draco_inf_nan.obj",
            "line 1: coordinate `inf` is not finite",
        ),
        (
            "assimp_number_formats.obj",
            "line 11: `3.1+e2` is not a number",
        ),
        (
            "tobj_invalid_index.obj",
            "line 12: vertex index 7, but the file has 6",
        ),
        (
            "tinyobj_invalid-relative-vertex-index.obj",
            "line 1: vertex index `-4`",
        ),
        ("assimp_box_UTF16BE.obj", "UTF-16"),
        ("assimp_empty.obj", "no triangles"),
        (
            "tinyobj_invalid-face-definition.obj",
            "fewer than three corners",
        ),
        (
            "trimesh_notenoughindices.obj",
            "1 triangles, [LoadNote { what: \"faces with fewer",
        ),
        ("trimesh_polygonfaces.obj", "3 triangles"),
        ("assimp_box_without_lineending.obj", "12 triangles, []"),
        (
            "Box_Draco.glb",
            "needs extension KHR_draco_mesh_compression",
        ),
        (
            "meshopt-no-fallback.gltf",
            "needs extensions KHR_mesh_quantization, EXT_meshopt_compression",
        ),
        ("val_node_node_loop.gltf", "loop"),
        ("val_node_node_parent_override.gltf", "several parents"),
        ("val_asset_invalid_version.gltf", "asset.version"),
        ("val_mesh_unresolved_positions.gltf", "accessors["),
        ("val_glb_invalid_magic.glb", "neither GLB"),
        ("val_glb_truncated_chunk_data.glb", "truncated"),
        ("val_glb_chunk_too_big.glb", "byte "),
    ];
    for (file, text) in expected {
        let (_, outcome) = outcomes.iter().find(|(name, _)| name == file).expect(file);
        assert!(outcome.contains(text), "{file}: {outcome}");
    }
}
