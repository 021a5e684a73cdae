//! Surfaces: generated, or read from mesh files and brought to metres.

use pliant_mesh::generate;
use pliant_mesh::{ConvexMesh, ConvexityError, HullError, TriangleMesh};

use crate::error::{Fault, SceneError};
use crate::files::Files;
use crate::mesh_file::read_mesh;
use crate::scene::Scene;
use crate::schema::{MeshFile, ShapeDescription};

/// Faces of a whole scene beyond this are taken for a mistake: each is checked against its neighbours when the scene is
/// loaded, and takes some 300 bytes.
const MOST_FACES: u64 = 4_000_000;

/// Faces that the surfaces of a scene may still have: a short text can name many large ones.
pub(super) struct FaceBudget {
    left: u64,
}

impl FaceBudget {
    pub(super) const FULL: Self = Self { left: MOST_FACES };

    /// Takes the faces of one surface, or says that they are too many.
    pub(super) fn take(&mut self, faces: u64) -> Result<(), String> {
        if let Some(left) = self.left.checked_sub(faces) {
            self.left = left;
            return Ok(());
        }
        let limit = if self.left == MOST_FACES {
            MOST_FACES.to_string()
        } else {
            format!(
                "the {} that are left of {MOST_FACES} for a whole scene",
                self.left
            )
        };
        Err(format!(
            "{faces} faces are more than {limit}; choose fewer sectors, bands or points, or a coarser mesh"
        ))
    }
}

/// The convex surface of an object; `path` is that of its shape in the scene.
pub(super) fn convex(
    scene: &Scene,
    shape: &ShapeDescription,
    path: &str,
    (files, budget): (&dyn Files, &mut FaceBudget),
) -> Result<ConvexMesh, SceneError> {
    let fault = |message: String| scene.fault_at(path, Fault::Geometry(message));
    budget.take(generated_faces(shape)).map_err(fault)?;
    let mesh = surface(scene, shape, path, files)?;
    if let ShapeDescription::Mesh(_) = shape {
        budget.take(mesh.triangles().len() as u64).map_err(fault)?;
    }
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
    let words = match shape {
        ShapeDescription::Mesh(_) | ShapeDescription::Tube { .. } => in_metres,
        _ => of_generated,
    };
    convex.map_err(|error| fault(format!("{file}{}", words(&error))))
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

/// As [`in_metres`] for a generated shape, convex by construction: only its proportions can stand in the way, and there is
/// no hull to take.
pub(super) fn of_generated(error: &ConvexityError) -> String {
    match error {
        ConvexityError::Flat { .. } => in_metres(error),
        _ => "the shape is so thin for its size that its sides have no area and no direction in double precision; choose \
              measures within a factor of 1e9 of each other"
            .to_owned(),
    }
}

/// Most faces that a generated shape has; 0 for files, which are counted once they are read.
fn generated_faces(shape: &ShapeDescription) -> u64 {
    let (around, along) = match shape {
        ShapeDescription::Cuboid { .. } | ShapeDescription::Plate { .. } => (6, 1),
        ShapeDescription::Cylinder { sectors, .. } | ShapeDescription::Cone { sectors, .. } => {
            (sectors.get(), 2)
        }
        ShapeDescription::Tube { sectors, .. } => (sectors.get(), 4),
        ShapeDescription::Capsule { sectors, bands, .. } => (sectors.get(), 2 * bands.get()),
        ShapeDescription::LatitudeLongitudeEllipsoid { sectors, bands, .. } => {
            (sectors.get(), bands.get())
        }
        ShapeDescription::FibonacciEllipsoid { points, .. } => (points.get(), 1),
        ShapeDescription::Mesh(_) => (0, 0),
    };
    2 * u64::from(around) * u64::from(along)
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
