//! Surfaces: generated, or read from mesh files and brought to metres.

use pliant_mesh::generate;
use pliant_mesh::{ConvexMesh, ConvexityError, HullError, TriangleMesh};

use crate::error::{Fault, SceneError};
use crate::files::Files;
use crate::mesh_file::read_mesh;
use crate::scene::Scene;
use crate::schema::{MeshFile, ShapeDescription};

/// Faces beyond this are taken for a mistake: each is checked against its neighbours when the scene is loaded.
const MOST_FACES: u64 = 4_000_000;

/// The convex surface of an object; `path` is that of its shape in the scene.
pub(super) fn convex(
    scene: &Scene,
    shape: &ShapeDescription,
    path: &str,
    files: &dyn Files,
) -> Result<ConvexMesh, SceneError> {
    let fault = |message: String| scene.fault_at(path, Fault::Geometry(message));
    if let Some(faces) = face_count(shape)
        && faces > MOST_FACES
    {
        return Err(fault(format!(
            "{faces} faces are more than {MOST_FACES}; choose fewer sectors or bands"
        )));
    }
    let mesh = surface(scene, shape, path, files)?;
    let hull = match shape {
        ShapeDescription::Mesh(file) => file.convex_hull,
        ShapeDescription::Tube { convex_hull, .. } => *convex_hull,
        _ => false,
    };
    let convex = if hull {
        ConvexMesh::hull(mesh.positions())
    } else {
        ConvexMesh::from_triangles(&mesh)
    };
    let file = match shape {
        ShapeDescription::Mesh(file) => format!("`{}`: ", file.path),
        _ => String::new(),
    };
    convex.map_err(|error| fault(format!("{file}{}", in_metres(&error))))
}

/// What stands in the way, with the unit that the mesh itself does not know: scenes scale their meshes to metres.
pub(super) fn in_metres(error: &ConvexityError) -> String {
    match error {
        ConvexityError::Topology(_)
        | ConvexityError::Shells { .. }
        | ConvexityError::Winding { .. }
        | ConvexityError::Hull(HullError::TooFew { .. }) => error.to_string(),
        _ => format!("{error} (lengths in metres)"),
    }
}

fn face_count(shape: &ShapeDescription) -> Option<u64> {
    let (sectors, bands) = match shape {
        ShapeDescription::Capsule { sectors, bands, .. } => (sectors.get(), 2 * bands.get()),
        ShapeDescription::LatitudeLongitudeEllipsoid { sectors, bands, .. } => {
            (sectors.get(), bands.get())
        }
        _ => return None,
    };
    Some(2 * u64::from(sectors) * u64::from(bands))
}

/// The surface as it is described, convex or not.
fn surface(
    scene: &Scene,
    shape: &ShapeDescription,
    path: &str,
    files: &dyn Files,
) -> Result<TriangleMesh, SceneError> {
    let generated = match shape {
        ShapeDescription::Mesh(file) => return mesh_in_metres(scene, file, path, files),
        ShapeDescription::Cuboid { size } => generate::cuboid(0.5 * size.0),
        ShapeDescription::Plate {
            length,
            width,
            thickness,
        } => generate::plate(length.get(), width.get(), thickness.get()),
        ShapeDescription::Cylinder {
            radius,
            length,
            sectors,
        } => generate::cylinder(radius.get(), length.get(), sectors.get()),
        ShapeDescription::Cone {
            base_radius,
            tip_radius,
            length,
            sectors,
        } => {
            let radii = [base_radius.get(), tip_radius.get()];
            generate::cone(radii, length.get(), sectors.get())
        }
        ShapeDescription::Capsule {
            radius,
            length,
            sectors,
            bands,
        } => generate::capsule(radius.get(), length.get(), sectors.get(), bands.get()),
        ShapeDescription::LatitudeLongitudeEllipsoid {
            radii,
            sectors,
            bands,
        } => generate::latitude_longitude_ellipsoid(radii.0, sectors.get(), bands.get()),
        ShapeDescription::FibonacciEllipsoid { radii, points } => {
            generate::fibonacci_ellipsoid(radii.0, points.get())
        }
        ShapeDescription::Tube {
            outer_radius,
            inner_radius,
            length,
            sectors,
            ..
        } => {
            let (outer, inner) = (outer_radius.get(), inner_radius.get());
            generate::tube(outer, inner, length.get(), sectors.get())
        }
    };
    generated.map_err(|error| scene.fault_at(path, Fault::Geometry(error.to_string())))
}

/// A mesh file in metres, its doubled vertices joined.
pub(super) fn mesh_in_metres(
    scene: &Scene,
    file: &MeshFile,
    path: &str,
    files: &dyn Files,
) -> Result<TriangleMesh, SceneError> {
    let field = format!("{path}.path");
    let (mesh_path, bytes) = scene.read_file(&file.path, &field, files)?;
    let loaded =
        read_mesh(&mesh_path, &bytes, files).map_err(|error| scene.naming(&field, error))?;
    let scaled = loaded
        .mesh
        .scaled(file.unit.metres() * file.scale.get())
        .map_err(|error| {
            let message = format!("{}: {error}", mesh_path.display());
            scene.fault_at(path, Fault::Geometry(message))
        })?;
    Ok(scaled.welded(0.0).0)
}
