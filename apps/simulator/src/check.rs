//! `pliant check`: what is in a file, or where it is wrong.

use std::fmt::Write as _;
use std::path::Path;

use pliant_device::WorkspaceMap;
use pliant_mesh::{ConvexMesh, MeshReport, TriangleMesh, Winding, inspect};
use pliant_scene::{Disk, MESH_EXTENSIONS, Scene, Unit, read_mesh, read_trajectory};

use crate::cli::CheckArguments;
use crate::failure::Failure;
use crate::output;
use crate::survey;

/// How often a motion is looked at for its speed [Hz].
const SAMPLING_HZ: u32 = 1000;

/// Checks every file, also after one that is wrong.
pub(crate) fn check(arguments: &CheckArguments) -> Result<(), Failure> {
    let mut wrong = false;
    for path in &arguments.files {
        match report(path, arguments.unit) {
            Ok(text) => output::print(&text)?,
            Err(Failure::Input(message)) => {
                output::note(&message);
                wrong = true;
            }
            Err(other) => return Err(other),
        }
    }
    if wrong {
        Err(Failure::Reported)
    } else {
        Ok(())
    }
}

fn report(path: &Path, unit: Option<Unit>) -> Result<String, Failure> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| Failure::Input(format!("{name}: {error}")))?;
    let extension = path.extension().and_then(|extension| extension.to_str());
    match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("ron") => scene(&name, &bytes),
        Some("csv") => trajectory(&name, &bytes),
        Some(mesh_extension) if MESH_EXTENSIONS.contains(&mesh_extension) => {
            mesh(path, &bytes, unit)
        }
        _ => Err(Failure::Input(format!(
            "{name}: the extension names nothing that can be checked; expected .ron, .csv or .{}",
            MESH_EXTENSIONS.join(", .")
        ))),
    }
}

/// A text in the making: a heading and indented lines.
struct Lines(String);

impl Lines {
    fn add(&mut self, name: &str, value: impl std::fmt::Display) {
        let _ = writeln!(self.0, "  {name:<12}{value}");
    }
}

fn scene(name: &str, bytes: &[u8]) -> Result<String, Failure> {
    let scene = Scene::from_bytes(bytes, name)?;
    let built = scene.build(&Disk)?;
    let mut lines = Lines(format!("{name}: scene\n"));
    if !scene.description().description.is_empty() {
        lines.add("shows", &scene.description().description);
    }
    for (name, value) in survey::scene(&built) {
        lines.add(name, value);
    }
    Ok(lines.0)
}

fn trajectory(name: &str, bytes: &[u8]) -> Result<String, Failure> {
    let trajectory = read_trajectory(bytes, name)?;
    let mut lines = Lines(format!("{name}: trajectory\n"));
    let merged = trajectory.merged();
    lines.add("duration", format!("{} s", trajectory.duration()));
    lines.add("samples", trajectory.knots().len());
    for (name, value) in survey::motion(&trajectory, &WorkspaceMap::IDENTITY, SAMPLING_HZ) {
        lines.add(name, value);
    }
    for (count, what) in [
        (merged.duplicates, "the same time as another"),
        (merged.near_duplicates, "almost the same time as another"),
    ] {
        if count > 0 {
            lines.add("note", format!("samples at {what}, averaged: {count}"));
        }
    }
    Ok(lines.0)
}

fn mesh(path: &Path, bytes: &[u8], unit: Option<Unit>) -> Result<String, Failure> {
    let loaded = read_mesh(path, bytes, &Disk)?;
    // In millimetres where the unit is known, so that every length below is in the same unit.
    let (factor, length, volume) = match unit {
        Some(unit) => (unit.metres() * 1e3, "mm", "mm³"),
        None => (1.0, "file units (give --unit for mm)", "cubic file units"),
    };
    let scaled = loaded
        .mesh
        .scaled(factor)
        .map_err(|error| Failure::Input(format!("{}: {error}", path.display())))?;
    let found = inspect(&scaled);
    let mut lines = Lines(format!("{}: mesh\n", path.display()));
    lines.add("vertices", found.vertices);
    lines.add("faces", found.faces);
    lines.add("shells", found.shells);
    surface(&mut lines, &found, &scaled, unit);
    let [x, y, z] = found.size.to_array().map(round);
    lines.add("size", format!("{x} x {y} x {z} {length}"));
    lines.add("volume", format!("{} {volume}", round(found.signed_volume)));
    if found.degenerate_triangles > 0 {
        lines.add("flat faces", found.degenerate_triangles);
    }
    let joined = loaded.mesh.positions().len().saturating_sub(found.vertices);
    if joined > 0 {
        lines.add(
            "note",
            format!("{joined} vertices of the file are at the place of another or in no face"),
        );
    }
    for note in &loaded.report.notes {
        lines.add("note", note);
    }
    Ok(lines.0)
}

/// Closed, convex, and which way it faces.
fn surface(lines: &mut Lines, found: &MeshReport, mesh: &TriangleMesh, unit: Option<Unit>) {
    match found.boundary_loops {
        Some(loops) if loops > 0 => lines.add("closed", format!("no: {loops} open border(s)")),
        _ => lines.add("closed", if found.closed { "yes" } else { "no" }),
    }
    if let Err(reason) = &found.manifold {
        lines.add("manifold", format!("no: {reason}"));
    }
    match (&found.convex, unit) {
        (Ok(()), _) => lines.add("convex", "yes"),
        // The advice to take the hull instead would fail as well.
        (Err(_), _) if ConvexMesh::hull(mesh.positions()).is_err() => lines.add(
            "convex",
            "no: the mesh encloses no volume and cannot be touched",
        ),
        (Err(reason), Some(_)) => lines.add("convex", format!("no: {reason} (lengths in mm)")),
        (Err(_), None) => {
            lines.add(
                "convex",
                "no: scenes touch its hull with `convex_hull: true`; --unit tells the place",
            );
        }
    }
    lines.add(
        "winding",
        match found.winding {
            Winding::Outward => "outward",
            Winding::Inward => "inward: the mesh is inside out",
            Winding::Inconsistent => "inconsistent between neighbours",
            Winding::Open => "of an open surface",
        },
    );
}

/// Six significant digits: what a file of single-precision numbers holds.
fn round(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
