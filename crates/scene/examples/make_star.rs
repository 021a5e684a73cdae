//! Writes `star.obj`, the mesh of the scene `any_mesh`: a five-pointed star, 30 mm thick, in millimetres.
//!
//! `cargo run -p pliant-scene --example make_star -- scenes/meshes/star.obj`; without a file name it prints the mesh.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command line tool reports"
)]

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::process::ExitCode;

/// Corners of the outline, points and notches in turn.
const CORNERS: u32 = 10;
/// Distance of points and notches from the axis [mm].
const RADII: [f64; 2] = [42.0, 19.0];
/// Along the axis [mm].
const THICKNESS: f64 = 30.0;

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        print!("{}", star());
        return ExitCode::SUCCESS;
    };
    match std::fs::write(&path, star()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{path}: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Vertices 1 and 2 are the centres of the faces, then the lower and the upper outline.
fn star() -> String {
    let half = 0.5 * THICKNESS;
    let mut text =
        "# A five-pointed star, millimetres, axis z. Made by the example make_star.\n".to_owned();
    let _ = writeln!(text, "v 0 0 {}\nv 0 0 {half}", -half);
    for z in [-half, half] {
        for corner in 0..CORNERS {
            let radius = RADII[corner as usize % 2];
            let (sine, cosine) = (PI * f64::from(corner) / 5.0).sin_cos();
            let _ = writeln!(text, "v {:.6} {:.6} {z}", radius * cosine, radius * sine);
        }
    }
    for corner in 0..CORNERS {
        let next = (corner + 1) % CORNERS;
        let (a, b) = (3 + corner, 3 + next);
        let (c, d) = (a + CORNERS, b + CORNERS);
        let _ = writeln!(text, "f 1 {b} {a}\nf 2 {c} {d}\nf {a} {b} {d} {c}");
    }
    text
}
