//! Tools: cut along x into segments, each convex.

use glam::{DQuat, DVec3};
use pliant_mesh::generate::{self, GenerateError};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;

use super::shape::{FaceBudget, in_metres, mesh_in_metres, of_generated};
use super::slices::Slices;
use crate::digits::number;
use crate::error::{Fault, SceneError};
use crate::files::Files;
use crate::scene::Scene;
use crate::schema::ToolShape;

/// The segments of the scene's tool, from the clamp to the tip, in the handle's frame.
pub(super) fn segments(
    scene: &Scene,
    files: &dyn Files,
    budget: &mut FaceBudget,
) -> Result<Vec<ConvexMesh>, SceneError> {
    let tool = &scene.description().tool;
    let named = match &tool.shape {
        ToolShape::Mesh { file, .. } => format!("`{}`: ", file.path),
        _ => String::new(),
    };
    let fault = |message: String| {
        scene.fault_at("tool.shape", Fault::Geometry(format!("{named}{message}")))
    };
    let count = tool.segments.get();
    budget
        .take(generated_faces(&tool.shape, count))
        .map_err(fault)?;
    let convex = |mesh: &TriangleMesh| {
        let words = match &tool.shape {
            ToolShape::Mesh { .. } => in_metres,
            _ => of_generated,
        };
        ConvexMesh::from_triangles(mesh).map_err(|error| fault(words(&error)))
    };
    if let Some((section, length)) = section(&tool.shape) {
        return (0..count)
            .map(|index| {
                let mesh = prism_segment(&section, length, (index, count));
                convex(&mesh.map_err(|error| fault(error.to_string()))?)
            })
            .collect();
    }
    let (whole, hull) = match &tool.shape {
        ToolShape::Mesh { file, axis } => {
            let mesh = mesh_in_metres(scene, file, "tool.shape.file", files)?;
            budget.take(mesh.triangles().len() as u64).map_err(fault)?;
            (along_x(&mesh, axis.unit()), file.convex_hull)
        }
        generated => {
            let mesh = capsule(generated).map_err(&fault)?;
            (along_x(&mesh, DVec3::X), false)
        }
    };
    if count == 1 && !hull {
        return Ok(vec![convex(&whole)?]);
    }
    let length = whole.bounds().max.x;
    let ends = (1..=count).map(|index| border(length, index, count));
    Slices::new(&whole, ends.collect())
        .enumerate()
        .map(|(index, points)| {
            ConvexMesh::hull(&points).map_err(|error| {
                let advice = "use fewer segments";
                let error = in_metres(&error);
                fault(format!("segment {index} of {count}: {error}; {advice}"))
            })
        })
        .collect()
}

/// Most faces that a generated tool has; 0 for files, which are counted once they are read.
fn generated_faces(shape: &ToolShape, count: u32) -> u64 {
    let faces = match shape {
        ToolShape::Rod { .. } => 12,
        ToolShape::Pin { sectors, .. } | ToolShape::Cone { sectors, .. } => {
            4 * u64::from(sectors.get())
        }
        // Of the whole; the borders of its segments add less than as many again.
        ToolShape::Capsule { sectors, bands, .. } => {
            return 4 * u64::from(sectors.get()) * u64::from(bands.get());
        }
        ToolShape::Mesh { .. } => 0,
    };
    faces * u64::from(count)
}

/// Where segment `index` of `count` begins [m].
fn border(length: f64, index: u32, count: u32) -> f64 {
    // The last border is the length itself, not a rounded quotient: the slice there must hold the tip.
    if index == count {
        length
    } else {
        length * f64::from(index) / f64::from(count)
    }
}

/// `mesh` turned so that `axis` runs along x, its lowest end at x = 0.
fn along_x(mesh: &TriangleMesh, axis: DVec3) -> TriangleMesh {
    let turned = mesh.transformed(&Pose::from_rotation(DQuat::from_rotation_arc(
        axis,
        DVec3::X,
    )));
    let start = turned.bounds().min.x;
    turned.transformed(&Pose::from_translation(DVec3::NEG_X * start))
}

/// Section of a straight tool.
enum Section {
    /// Full width along y and height along z [m].
    Rectangle(f64, f64),
    /// Radii at the clamp and at the tip [m], sides of the polygon.
    Round([f64; 2], u32),
}

/// Section and length [m] of a tool whose section is known at every border.
fn section(shape: &ToolShape) -> Option<(Section, f64)> {
    match shape {
        ToolShape::Rod {
            length,
            width,
            height,
        } => Some((Section::Rectangle(width.get(), height.get()), length.get())),
        ToolShape::Pin {
            length,
            radius,
            sectors,
        } => Some((
            Section::Round([radius.get(); 2], sectors.get()),
            length.get(),
        )),
        ToolShape::Cone {
            length,
            base_radius,
            tip_radius,
            sectors,
        } => {
            let radii = [base_radius.get(), tip_radius.get()];
            Some((Section::Round(radii, sectors.get()), length.get()))
        }
        ToolShape::Capsule { .. } | ToolShape::Mesh { .. } => None,
    }
}

/// Segment `index` of `count` of a straight tool.
fn prism_segment(
    section: &Section,
    length: f64,
    (index, count): (u32, u32),
) -> Result<TriangleMesh, GenerateError> {
    let mesh = match *section {
        Section::Rectangle(width, height) => {
            generate::cuboid(0.5 * DVec3::new(1.0, width, height))?
        }
        Section::Round([base, tip], sectors) => {
            let radius = |border: u32| {
                let part = f64::from(border) / f64::from(count);
                base * (1.0 - part) + tip * part
            };
            generate::cone([radius(index), radius(index + 1)], 1.0, sectors)?
        }
    };
    let (start, end) = (
        border(length, index, count),
        border(length, index + 1, count),
    );
    let middle = mesh.bounds().center().x;
    let positions = mesh.positions().iter().map(|p| {
        // Both ends of neighbouring segments are the same numbers, so that no gap opens between them.
        DVec3::new(if p.x < middle { start } else { end }, p.y, p.z)
    });
    Ok(TriangleMesh::new(
        positions.collect(),
        mesh.triangles().to_vec(),
    )?)
}

/// A capsule along x; other shapes have no cap to make.
fn capsule(shape: &ToolShape) -> Result<TriangleMesh, String> {
    let ToolShape::Capsule {
        length,
        radius,
        sectors,
        bands,
    } = shape
    else {
        return Err(format!("{shape:?} is no capsule"));
    };
    let (length, radius) = (length.get(), radius.get());
    let caps = 2.0 * radius;
    if length <= caps {
        return Err(format!(
            "a capsule {} m long has no room for half spheres of radius {} m; make it longer than {} m",
            number(length),
            number(radius),
            number(caps)
        ));
    }
    generate::capsule(radius, length - caps, sectors.get(), bands.get())
        .map_err(|error| error.to_string())
}
