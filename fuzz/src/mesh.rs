//! What becomes of a mesh once it is loaded: everything an application does with it at once.

use glam::DVec3;
use pliant_mesh::load::{LoadError, Loaded};
use pliant_mesh::{ConvexMesh, FaceId, TriangleMesh, inspect};

/// Meshes above this are judged by their numbers alone, to keep the runs a second high.
const MOST_VERTICES: usize = 2000;

/// Least height of a triangle, relative to the size of the mesh, at which its normal is good to nine digits.
const NARROWEST: f64 = 1e-6;

/// Panics unless the mesh is sound: finite, in range, no vertex unused, and every later step gives a mesh or a reason.
pub fn judge_mesh(loaded: Result<Loaded, LoadError>) {
    let mesh = match loaded {
        Ok(loaded) => loaded.mesh,
        Err(error) => {
            let message = error.to_string();
            assert!(!message.trim().is_empty(), "an empty message: {error:?}");
            assert!(message.len() < 4096, "{} bytes of message", message.len());
            return;
        }
    };
    assert!(!mesh.triangles().is_empty(), "a mesh without triangles");
    let count = mesh.positions().len();
    let mut used = vec![false; count];
    for vertex in mesh.triangles().iter().flatten() {
        used[*vertex as usize] = true;
    }
    assert!(used.iter().all(|&used| used), "an unused vertex was kept");
    assert!(mesh.positions().iter().all(|p| p.is_finite()), "not finite");
    if count <= MOST_VERTICES {
        judge_steps(&mesh);
    }
}

fn judge_steps(mesh: &TriangleMesh) {
    let report = inspect(mesh);
    assert!(report.faces <= mesh.triangles().len());
    let (welded, _) = mesh.welded(0.0);
    for factor in [1e-3, 0.0254, 1e3] {
        let _ = mesh.scaled(factor);
    }
    if let Ok(convex) = ConvexMesh::from_triangles(&welded) {
        judge_convex(&convex);
    }
    judge_hull(welded.positions());
}

/// Panics unless the hull of `points` is refused with a reason or is sound and holds all of them.
pub fn judge_hull(points: &[DVec3]) -> Option<ConvexMesh> {
    match ConvexMesh::hull(points) {
        Ok(hull) => {
            judge_convex(&hull);
            judge_outside(&hull, points);
            Some(hull)
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            None
        }
    }
}

fn judge_convex(convex: &ConvexMesh) {
    let topology = convex.topology();
    assert!(topology.is_closed(), "a convex mesh with a border");
    assert_eq!(topology.euler_number(), 2, "a convex mesh is a sphere");
    assert!(convex.centroid().is_finite(), "the centroid is not finite");
    assert!(convex.radius() > 0.0 && convex.radius().is_finite());
}

/// Points outside the hull. Needles of faces are left out: their normals are those of rounding.
fn judge_outside(hull: &ConvexMesh, points: &[DVec3]) {
    let size = hull.bounds().diagonal();
    let topology = hull.topology();
    for face in (0..).map(FaceId).take(topology.face_count()) {
        let [a, b, c] = topology.face_corners(face);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let altitude = ((b - a) / size).cross((c - a) / size).length() / (longest / size);
        let normal = topology.face_normal(face);
        if altitude < NARROWEST {
            continue;
        }
        for point in points {
            let height = normal.dot(*point - a);
            assert!(
                height <= 1e-9 * size,
                "{point} is {height} outside a hull of {size}"
            );
        }
    }
}
