//! Which face, edge or vertex of an obstacle lies under a contact point.

use glam::DVec3;
use pliant_mesh::{EdgeId, FaceId, Feature, HalfEdgeMesh, VertexId};

use super::slab::{Support, TILT};

/// Faces a label may be carried over in one tick. It is a label: where the walk ends short, it goes on in the next tick.
const MAX_STEPS: u32 = 64;

/// The feature of the obstacle under `point` (object frame), of those that lie in the supporting plane with the unit normal `normal`.
///
/// `last` is the feature of the last tick: where to look first on a flat face of many triangles.
pub(crate) fn feature_under(
    mesh: &HalfEdgeMesh,
    support: &Support<'_>,
    (normal, point): (DVec3, DVec3),
    last: Option<Feature>,
) -> Feature {
    if support.is_flat_face {
        let start = match last {
            Some(Feature::Face(face)) if lies_in_plane(mesh, face, normal) => Some(face),
            _ => flattest_face(mesh, VertexId(support.vertices[0]), normal),
        };
        if let Some(start) = start {
            return Feature::Face(walk(mesh, start, normal, point));
        }
    }
    let touched = support.vertices;
    face_around(mesh, touched, normal, point)
        .or_else(|| nearest_face(mesh, touched, normal, point))
        .map(Feature::Face)
        .or_else(|| nearest_edge(mesh, touched, point).map(Feature::Edge))
        .unwrap_or(Feature::Vertex(VertexId(touched[0])))
}

/// The faces with all corners in `touched`, each once.
fn faces<'a>(mesh: &'a HalfEdgeMesh, touched: &'a [u32]) -> impl Iterator<Item = FaceId> + 'a {
    let is_touched = |v: VertexId| touched.contains(&v.0);
    touched.iter().flat_map(move |&vertex| {
        mesh.outgoing(VertexId(vertex))
            .filter_map(move |half_edge| {
                let face = mesh.face(half_edge)?;
                let is_first = mesh.half_edge_of_face(face) == half_edge;
                (is_first && mesh.face_vertices(face).into_iter().all(is_touched)).then_some(face)
            })
    })
}

/// The face with the point strictly inside, seen along the normal; there is at most one.
fn face_around(
    mesh: &HalfEdgeMesh,
    touched: &[u32],
    normal: DVec3,
    point: DVec3,
) -> Option<FaceId> {
    faces(mesh, touched).find(|&face| {
        let [a, b, c] = mesh.face_corners(face);
        let is_left = |from: DVec3, to: DVec3| normal.cross(to - from).dot(point - from) > 0.0;
        is_left(a, b) && is_left(b, c) && is_left(c, a)
    })
}

/// The face whose nearest side the point is least beyond.
fn nearest_face(
    mesh: &HalfEdgeMesh,
    touched: &[u32],
    normal: DVec3,
    point: DVec3,
) -> Option<FaceId> {
    let mut best: Option<(f64, FaceId)> = None;
    for face in faces(mesh, touched) {
        let (_, depth) = nearest_side(mesh.face_corners(face), normal, point);
        if best.is_none_or(|(most, _)| depth > most) {
            best = Some((depth, face));
        }
    }
    best.map(|(_, face)| face)
}

/// The nearest edge with both ends in `touched`.
fn nearest_edge(mesh: &HalfEdgeMesh, touched: &[u32], point: DVec3) -> Option<EdgeId> {
    let mut best: Option<(f64, EdgeId)> = None;
    for &vertex in touched {
        for half_edge in mesh.outgoing(VertexId(vertex)) {
            let edge = mesh.edge(half_edge);
            let ends = mesh.edge_vertices(edge);
            if !ends.iter().all(|v| touched.contains(&v.0)) {
                continue;
            }
            let distance = segment_distance(ends.map(|v| mesh.position(v)), point);
            if best.is_none_or(|(least, _)| distance < least) {
                best = Some((distance, edge));
            }
        }
    }
    best.map(|(_, edge)| edge)
}

/// The face around `vertex` whose normal is nearest to `normal`.
fn flattest_face(mesh: &HalfEdgeMesh, vertex: VertexId, normal: DVec3) -> Option<FaceId> {
    mesh.outgoing(vertex)
        .filter_map(|half_edge| mesh.face(half_edge))
        .filter(|&face| lies_in_plane(mesh, face, normal))
        .max_by(|&a, &b| {
            let cosine = |face| mesh.face_normal(face).dot(normal);
            cosine(a).total_cmp(&cosine(b))
        })
}

/// A face tilted by less than what makes a flat face leave the slab, twice to allow for the rounding of small triangles.
fn lies_in_plane(mesh: &HalfEdgeMesh, face: FaceId, normal: DVec3) -> bool {
    let face_normal = mesh.face_normal(face);
    face_normal.dot(normal) > 0.0 && face_normal.cross(normal).length() < 2.0 * TILT
}

/// Over the sides the point is farthest beyond, within the plane.
fn walk(mesh: &HalfEdgeMesh, start: FaceId, normal: DVec3, point: DVec3) -> FaceId {
    let mut face = start;
    for _ in 0..MAX_STEPS {
        let (side, depth) = nearest_side(mesh.face_corners(face), normal, point);
        if depth >= 0.0 {
            break;
        }
        let across = mesh.twin(mesh.face_half_edges(face)[side]);
        match mesh.face(across) {
            Some(next) if lies_in_plane(mesh, next, normal) => face = next,
            _ => break,
        }
    }
    face
}

fn segment_distance([a, b]: [DVec3; 2], point: DVec3) -> f64 {
    let along = b - a;
    let t = ((point - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    (point - a - along * t).length()
}

/// The side of a triangle a point is farthest beyond or nearest to, seen along `normal`, and the distance inside [m]; negative outside.
fn nearest_side(corners: [DVec3; 3], normal: DVec3, point: DVec3) -> (usize, f64) {
    let mut nearest = (0, f64::INFINITY);
    for side in 0..3 {
        let (a, b) = (corners[side], corners[(side + 1) % 3]);
        let inward = normal.cross(b - a).normalize_or_zero();
        let depth = inward.dot(point - a);
        if depth < nearest.1 {
            nearest = (side, depth);
        }
    }
    nearest
}
