//! Loaders on real files, on every broken file of the data folder, and on random damage.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::too_many_lines,
    reason = "tests stop at the first surprise, say what they skip, and list their cases in one table"
)]

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use pliant_mesh::load::{self, LoadError, Loaded};
use pliant_mesh::{TriangleMesh, generate, inspect};
use proptest::prelude::any;
use proptest::proptest;

/// The data folder, or a message about how many cases are skipped without it.
fn data(cases: usize) -> Option<PathBuf> {
    let folder = std::env::var_os("PLIANT_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("PLIANT_DATA is not set: {cases} cases skipped");
    }
    folder
}

fn load_file(path: &Path) -> Result<Loaded, LoadError> {
    load_bytes(path, &std::fs::read(path).unwrap())
}

/// Loads bytes as the kind that the name of `path` says, buffers from its folder.
fn load_bytes(path: &Path, bytes: &[u8]) -> Result<Loaded, LoadError> {
    let beside = path.parent().unwrap().to_owned();
    match path.extension().and_then(|e| e.to_str()) {
        Some("obj") => load::obj(bytes),
        Some("stl") => load::stl(bytes),
        _ => load::gltf(bytes, &mut |name| {
            std::fs::read(beside.join(name)).map_err(|e| e.to_string())
        }),
    }
}

fn no_buffers(_: &str) -> Result<Vec<u8>, String> {
    Err("there are none".to_owned())
}

fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(files_below(&path));
        } else if path
            .extension()
            .is_some_and(|e| e == "obj" || e == "gltf" || e == "glb")
        {
            files.push(path);
        }
    }
    files.sort();
    files
}

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
            "needs extension EXT_meshopt_compression",
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

/// A GLB from JSON text and a binary chunk.
fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
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

/// Positions and 16-bit indices of a mesh, and their buffer views and accessors with type `mode`.
fn document(mesh: &TriangleMesh, nodes: &str, buffer: &str) -> (String, Vec<u8>) {
    let mut binary = Vec::new();
    for p in mesh.positions() {
        binary.extend(p.as_vec3().to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    let split = binary.len();
    for &v in mesh.triangles().iter().flatten() {
        binary.extend(u16::try_from(v).unwrap().to_le_bytes());
    }
    let (total, count, corners) = (
        binary.len(),
        mesh.positions().len(),
        3 * mesh.triangles().len(),
    );
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{nodes},
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{count}}},
                     {{"bufferView":1,"componentType":5123,"type":"SCALAR","count":{corners}}}],
        "bufferViews":[{{"buffer":0,"byteLength":{split}}},{{"buffer":0,"byteOffset":{split},"byteLength":{}}}],
        "buffers":[{{"byteLength":{total}{buffer}}}]}}"#,
        total - split
    );
    (json, binary)
}

fn cube() -> TriangleMesh {
    generate::cuboid(DVec3::ONE).unwrap()
}

#[test]
fn transforms_instances_and_mirrors() {
    // A parent that mirrors and scales by 2, with the mesh once at the parent and once below, shifted.
    let nodes = r#"[{"mesh":0,"scale":[-2,2,2],"children":[1]},{"mesh":0,"translation":[5,0,0],"rotation":[0,0,0.6,0.8]}]"#;
    let (json, binary) = document(&cube(), nodes, "");
    let mesh = load::gltf(&glb(&json, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!((mesh.triangles().len(), mesh.shells()), (24, 2));
    assert!(
        (mesh.signed_volume() - 2.0 * 64.0).abs() < 1e-4,
        "outward again: {}",
        mesh.signed_volume()
    );
    assert!(mesh.bounds().min.x < -11.9 && (mesh.bounds().max.x - 2.0).abs() < 1e-9);

    let matrix = r#"[{"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 7,8,9,1]}]"#;
    let (json, binary) = document(&cube(), matrix, "");
    let mesh = load::gltf(&glb(&json, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!(mesh.bounds().center(), DVec3::new(7.0, 8.0, 9.0));
}

/// The same triangles in the same order; vertices may be numbered otherwise.
fn same_triangles(a: &TriangleMesh, b: &TriangleMesh) -> bool {
    a.triangles().len() == b.triangles().len()
        && (0..)
            .take(a.triangles().len())
            .all(|i| a.corners(i) == b.corners(i))
}

#[test]
fn buffers_by_data_uri_and_by_resolver() {
    let (_, binary) = document(&cube(), "[]", "");
    let uri = format!(
        r#","uri":"data:application/octet-stream;base64,{}""#,
        STANDARD.encode(&binary)
    );
    let (json, _) = document(&cube(), r#"[{"mesh":0}]"#, &uri);
    let inline = load::gltf(json.as_bytes(), &mut no_buffers).unwrap().mesh;
    assert!(same_triangles(&inline, &cube()));
    let (json, _) = document(&cube(), r#"[{"mesh":0}]"#, r#","uri":"my%20cube.bin""#);
    let mut asked = Vec::new();
    let loaded = load::gltf(json.as_bytes(), &mut |name| {
        asked.push(name.to_owned());
        Ok(binary.clone())
    });
    assert!(same_triangles(&loaded.unwrap().mesh, &cube()));
    assert_eq!(asked, ["my cube.bin"], "asked once");
    let error = load::gltf(json.as_bytes(), &mut no_buffers).unwrap_err();
    assert_eq!(
        error.to_string(),
        "buffers[0]: `my%20cube.bin`: there are none"
    );
}

#[test]
fn hostile_documents_get_an_error() {
    let (good, binary) = document(&cube(), r#"[{"mesh":0}]"#, "");
    assert!(load::gltf(&glb(&good, &binary), &mut no_buffers).is_ok());
    let cases = [
        (r#""count":8"#, r#""count":9"#, "do not fit"),
        (
            r#""count":8"#,
            r#""count":18446744073709551615"#,
            "more than",
        ),
        (
            r#""count":8"#,
            r#""count":7"#,
            "index 7, but there are 7 positions",
        ),
        (r#""count":36"#, r#""count":400000000"#, "more than"),
        (
            r#""byteOffset":96"#,
            r#""byteOffset":18446744073709551615"#,
            "beyond",
        ),
        (
            r#""bufferView":1"#,
            r#""bufferView":2"#,
            "refers to bufferViews[2]",
        ),
        (
            r#""buffer":0,"byteLength":96"#,
            r#""buffer":3,"byteLength":96"#,
            "refers to buffers[3]",
        ),
        (
            r#""POSITION":0"#,
            r#""POSITION":7"#,
            "accessors[7]: does not exist",
        ),
        (r#""indices":1"#, r#""indices":0"#, "wrong type"),
        (r#""indices":1"#, r#""indices":1,"mode":9"#, "mode is none"),
        ("5123", "5122", "wrong type"),
        ("5126", "5125", "wrong type"),
        (r#""mesh":0"#, r#""mesh":1"#, "refers to number 1"),
        (r#""mesh":0"#, r#""mesh":0,"children":[0]"#, "loop"),
        (r#""nodes":[0]"#, r#""nodes":[4]"#, "refers to number 4"),
        (r#""scene":0"#, r#""scene":1"#, "refers to number 1"),
        (r#""mesh":0"#, r#""mesh":0,"scale":[0,1,1]"#, "no triangles"),
        (
            r#""mesh":0"#,
            r#""mesh":0,"rotation":[0,0,0,0]"#,
            "quaternion",
        ),
        (r#""mesh":0"#, r#""mesh":0,"translation":[1e39,0,0]"#, ""),
        (r#""version":"2.0""#, r#""version":"1.0""#, "asset.version"),
        (
            r#""scene":0"#,
            r#""extensionsRequired":["VENDOR_new"],"scene":0"#,
            "needs extension VENDOR_new",
        ),
        (
            r#""byteLength":96"#,
            r#""byteLength":96,"byteStride":4"#,
            "byteStride 4 is smaller",
        ),
        (r#""scene":0"#, r#""scene":0,"scenes""#, "glTF JSON, line"),
    ];
    for (from, to, expected) in cases {
        assert!(good.contains(from), "{from}");
        let error = load::gltf(&glb(&good.replacen(from, to, 1), &binary), &mut no_buffers)
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{to}: {error}");
    }
    // Forty levels of two children that are the same node would be a million million instances.
    let chain: Vec<String> = (1..=40)
        .map(|i| format!(r#"{{"children":[{i},{i}]}}"#))
        .collect();
    let explosive = good.replacen(
        r#"[{"mesh":0}]"#,
        &format!(r#"[{},{{"mesh":0}}]"#, chain.join(",")),
        1,
    );
    let error = load::gltf(&glb(&explosive, &binary), &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("instances of nodes"), "{error}");
    let mut infinite = binary.clone();
    infinite[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = load::gltf(&glb(&good, &infinite), &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("accessors[0]: element 0"), "{error}");
    // The header that makes a trusting reader reserve 4 GiB.
    let error = load::gltf(b"glTF\x02\0\0\0\0\0\0\0", &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("a length of 0 bytes"), "{error}");
    let deep = format!("{}{}", "{\"a\":".repeat(100_000), "}".repeat(100_000));
    assert!(load::gltf(deep.as_bytes(), &mut no_buffers).is_err());
}

#[test]
fn strips_fans_and_other_modes() {
    let square = TriangleMesh::new(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y],
        vec![[0, 1, 2]],
    )
    .unwrap();
    let (list, binary) = document(&square, r#"[{"mesh":0}]"#, "");
    let strip = list.replace(r#","indices":1"#, r#","mode":5"#);
    let mesh = load::gltf(&glb(&strip, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!(mesh.triangles().len(), 2);
    assert!((0..2).all(|i| {
        let [a, b, c] = mesh.corners(i);
        (b - a).cross(c - a).z > 0.9
    }));
    let fan = list.replace(r#","indices":1"#, r#","mode":6"#);
    assert_eq!(
        load::gltf(&glb(&fan, &binary), &mut no_buffers)
            .unwrap()
            .mesh
            .triangles()
            .len(),
        2
    );
    for mode in 0..4 {
        let other = list.replace(r#","indices":1"#, &format!(r#","mode":{mode}"#));
        let error = load::gltf(&glb(&other, &binary), &mut no_buffers)
            .unwrap_err()
            .to_string();
        assert!(error.contains("points or lines skipped"), "{error}");
    }
}

/// Overwrites, cuts and inserts as `choices` say, over and over with each third of them.
fn damaged(bytes: &[u8], choices: &[(u32, u8, u8)]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for &(place, kind, value) in choices {
        if bytes.is_empty() {
            break;
        }
        let at = place as usize % bytes.len();
        match kind % 8 {
            0 => bytes.truncate(at),
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, value),
            // Digits, so that numbers in text change without breaking it.
            3 | 4 => bytes[at] = b'0' + value % 10,
            5 => bytes[at] ^= 1 << (value % 8),
            6 => bytes[at] = b"-+.eE/,\"{}[] \n\\#"[usize::from(value) % 16],
            _ => bytes[at] = value,
        }
    }
    bytes
}

/// Loading must end with a mesh that can be inspected or an error that says something.
fn survive(path: &Path, bytes: &[u8]) {
    match load_bytes(path, bytes) {
        Ok(loaded) => assert!(!loaded.mesh.triangles().is_empty()),
        Err(error) => assert!(error.to_string().len() > 10),
    }
}

proptest! {
    #[test]
    fn damaged_small_files_never_panic(choices in proptest::collection::vec(any::<(u32, u8, u8)>(), 1..6)) {
        let ball = generate::latitude_longitude_ellipsoid(DVec3::ONE, 5, 4).unwrap();
        let (json, binary) = document(&ball, r#"[{"mesh":0,"scale":[1,2,3],"children":[1]},{"mesh":0}]"#, "");
        survive(Path::new("x/a.glb"), &damaged(&glb(&json, &binary), &choices));
        let uri = format!(r#","uri":"data:;base64,{}""#, STANDARD.encode(&binary));
        let (json, _) = document(&ball, r#"[{"mesh":0}]"#, &uri);
        survive(Path::new("x/a.gltf"), &damaged(json.as_bytes(), &choices));
        let obj = "v 0 0 0\nv 1.5 0 0\nv 1 1e0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3 -1\nf 1//2 3 4\nl 1 2\n";
        survive(Path::new("x/a.obj"), &damaged(obj.as_bytes(), &choices));
        let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
        survive(Path::new("x/a.stl"), &damaged(text.as_bytes(), &choices));
        let mut stl = vec![0; 80];
        stl.extend(2_u32.to_le_bytes());
        stl.extend([1.0_f32; 12].iter().flat_map(|x| x.to_le_bytes()).chain([0, 0]));
        stl.extend([2.0_f32; 12].iter().flat_map(|x| x.to_le_bytes()).chain([0, 0]));
        survive(Path::new("x/a.stl"), &damaged(&stl, &choices));
    }
}

#[test]
fn damaged_real_files_never_panic() {
    let Some(folder) = data(2000) else { return };
    let mut files = files_below(&folder.join("gltf"));
    files.extend(files_below(&folder.join("bad")));
    files.retain(|f| f.metadata().unwrap().len() < 60_000);
    // A fixed sequence (multiplier by P. L'Ecuyer 1999), so that a failure can be repeated.
    let mut state = 1_u64;
    let mut draw = || {
        state = state
            .wrapping_mul(2_862_933_555_777_941_757)
            .wrapping_add(3_037_000_493);
        u32::try_from(state >> 32).unwrap()
    };
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        for _ in 0..25 {
            let count = 1 + draw() % 6;
            let choices: Vec<(u32, u8, u8)> = (0..count)
                .map(|_| (draw(), draw().to_le_bytes()[3], draw().to_le_bytes()[3]))
                .collect();
            survive(file, &damaged(&bytes, &choices));
        }
    }
}
