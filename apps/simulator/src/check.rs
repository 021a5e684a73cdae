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
    if merged.duplicates + merged.near_duplicates > 0 {
        lines.add(
            "repairs",
            format!(
                "{} samples with the time of another and {} almost so were merged",
                merged.duplicates, merged.near_duplicates
            ),
        );
    }
    Ok(lines.0)
}

fn mesh(path: &Path, bytes: &[u8], unit: Option<Unit>) -> Result<String, Failure> {
    let loaded = read_mesh(path, bytes, &Disk)?;
    // In metres where the unit is known: the reasons below state lengths in metres.
    let in_metres = match unit {
        Some(unit) => loaded.mesh.scaled(unit.metres()),
        None => loaded.mesh.scaled(1.0),
    };
    let in_metres =
        in_metres.map_err(|error| Failure::Input(format!("{}:1:1: {error}", path.display())))?;
    let found = inspect(&in_metres);
    let mut lines = Lines(format!("{}: mesh\n", path.display()));
    lines.add("vertices", found.vertices);
    lines.add("faces", found.faces);
    lines.add("shells", found.shells);
    surface(&mut lines, &found, &in_metres, unit);
    let (factor, length, volume) = match unit {
        Some(_) => (1e3, "mm", "mm³"),
        None => (1.0, "file units (give --unit for mm)", "cubic file units"),
    };
    let size = found.size * factor;
    lines.add(
        "size",
        format!(
            "{} x {} x {} {length}",
            round(size.x),
            round(size.y),
            round(size.z)
        ),
    );
    lines.add(
        "volume",
        format!("{} {volume}", round(found.signed_volume * factor.powi(3))),
    );
    if found.degenerate_triangles > 0 {
        lines.add("flat faces", found.degenerate_triangles);
    }
    let joined = loaded.mesh.positions().len().saturating_sub(found.vertices);
    if joined > 0 {
        lines.add(
            "repairs",
            format!("{joined} vertices at the place of another joined, or unused"),
        );
    }
    for note in &loaded.report.notes {
        lines.add("repairs", note);
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
        (Err(reason), Some(_)) => lines.add("convex", format!("no: {reason} (lengths in metres)")),
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
