//! Loaders on real files, on every broken file of the data folder, and on random damage.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::too_many_lines,
    reason = "tests stop at the first surprise, say what they skip, and list their cases in one table"
)]

mod damage;
mod documents;
mod files;

use std::io::Write;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_mesh::load::{self, LoadError, Loaded};
use pliant_mesh::{TriangleMesh, generate};

/// The data folder, or a message about how many cases are skipped without it, written past the test harness, which swallows what a passing
/// test prints.
fn data(cases: usize) -> Option<PathBuf> {
    let folder = std::env::var_os("PLIANT_DATA").map(PathBuf::from);
    if folder.is_none() {
        writeln!(
            std::io::stderr(),
            "skipped {cases} cases: PLIANT_DATA is not set"
        )
        .expect("standard error is open");
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
