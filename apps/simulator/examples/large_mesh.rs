//! How long a model of 998,000 triangles takes from its bytes to being ready for queries:
//! `cargo run --release -p pliant --example large_mesh`.

#![expect(clippy::print_stdout, reason = "an example shows its result")]

use std::time::Instant;

use glam::DVec3;
use pliant_collision::TriangleBvh;
use pliant_mesh::{ConvexMesh, HalfEdgeMesh, TriangleMesh, generate, inspect, load};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ball = generate::latitude_longitude_ellipsoid(DVec3::new(0.05, 0.04, 0.03), 998, 501)?;
    let bytes = glb(&ball)?;
    drop(ball);
    println!("{} bytes of GLB", bytes.len());

    let start = Instant::now();
    let loaded = load::gltf(&bytes, &mut |_| Err("no buffers".to_owned()))?;
    let read = start.elapsed();
    let tree = TriangleBvh::new(&loaded.mesh);
    let ready = start.elapsed();
    println!("{} triangles", loaded.mesh.triangles().len());
    println!("read and validated  {:7.0} ms", 1e3 * read.as_secs_f64());
    println!(
        "search tree         {:7.0} ms",
        1e3 * ready.saturating_sub(read).as_secs_f64()
    );
    println!("together            {:7.0} ms", 1e3 * ready.as_secs_f64());
    drop(tree);

    let start = Instant::now();
    let half_edges = HalfEdgeMesh::new(&loaded.mesh)?;
    println!(
        "half-edges          {:7.0} ms",
        1e3 * start.elapsed().as_secs_f64()
    );
    let start = Instant::now();
    let convex = ConvexMesh::new(half_edges, pliant_mesh::CONVEXITY_TOLERANCE)?;
    println!(
        "proof of convexity  {:7.0} ms",
        1e3 * start.elapsed().as_secs_f64()
    );
    drop(convex);
    let start = Instant::now();
    let report = inspect(&loaded.mesh);
    println!(
        "all facts           {:7.0} ms",
        1e3 * start.elapsed().as_secs_f64()
    );
    println!("{} shell(s), {:?}", report.shells, report.winding);
    Ok(())
}

/// The mesh as a binary glTF file: `f32` positions, then `u32` indices.
fn glb(mesh: &TriangleMesh) -> Result<Vec<u8>, std::num::TryFromIntError> {
    let mut binary = Vec::new();
    for p in mesh.positions() {
        binary.extend(p.as_vec3().to_array().iter().flat_map(|x| x.to_le_bytes()));
    }
    let split = binary.len();
    binary.extend(
        mesh.triangles()
            .as_flattened()
            .iter()
            .flat_map(|v| v.to_le_bytes()),
    );
    let (vertices, corners) = (mesh.positions().len(), 3 * mesh.triangles().len());
    let (total, indices) = (binary.len(), binary.len() - split);
    let mut json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":{vertices}}},
{{"bufferView":1,"componentType":5125,"type":"SCALAR","count":{corners}}}],
"bufferViews":[{{"buffer":0,"byteLength":{split}}},{{"buffer":0,"byteOffset":{split},"byteLength":{indices}}}],
"buffers":[{{"byteLength":{total}}}]}}"#
    );
    while !json.len().is_multiple_of(4) {
        json.push(' ');
    }
    let length = u32::try_from(12 + 8 + json.len() + 8 + total)?;
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend(length.to_le_bytes());
    for (kind, content) in [(b"JSON", json.as_bytes()), (b"BIN\0", &binary)] {
        bytes.extend(u32::try_from(content.len())?.to_le_bytes());
        bytes.extend(kind);
        bytes.extend(content);
    }
    Ok(bytes)
}
