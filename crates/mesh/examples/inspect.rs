//! Prints what is known about a generated ellipsoid: `cargo run -p pliant-mesh --example inspect`.

#![expect(clippy::print_stdout, reason = "an example shows its result")]

use glam::DVec3;
use pliant_mesh::{ConvexMesh, generate, inspect};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mesh = generate::latitude_longitude_ellipsoid(DVec3::new(0.05, 0.04, 0.03), 96, 67)?;
    let report = inspect(&mesh);
    println!(
        "{} vertices, {} faces, {} shell(s)",
        report.vertices, report.faces, report.shells
    );
    println!(
        "closed: {}, winding: {:?}, convex: {}",
        report.closed,
        report.winding,
        report.convex.is_ok()
    );
    println!(
        "size {} mm, volume {:.3} ml",
        1e3 * report.size,
        1e6 * report.signed_volume
    );

    let convex = ConvexMesh::from_triangles(&mesh)?;
    println!("vertex 0 has {} neighbours", convex.neighbours(0).len());
    Ok(())
}
