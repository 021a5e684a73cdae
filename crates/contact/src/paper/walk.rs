//! Walking a contact point over the components of a convex mesh (paper §3, fig. 3).
//!
//! A component is a flat piece with a precomputed normal: a face; an edge as a thin flat rectangle across the edge's normal; a
//! vertex as a thin flat disc across its pseudonormal. Going over looks at precomputed neighbours only.

use glam::DVec3;
use pliant_mesh::{EdgeId, FaceId, Feature, HalfEdgeId, HalfEdgeMesh, VertexId};

/// A walk ends after so many components: 1 mm of hand motion in a tick crosses fewer even on a million faces. A cap that is hit
/// leaves a valid component and the walk goes on next tick.
const MAX_STEPS: u32 = 256;

/// Precomputed unit normal of a component, object frame.
pub(super) fn normal(mesh: &HalfEdgeMesh, feature: Feature) -> DVec3 {
    match feature {
        Feature::Face(face) => mesh.face_normal(face),
        Feature::Edge(edge) => mesh.edge_normal(edge),
        Feature::Vertex(vertex) => mesh.vertex_pseudonormal(vertex),
    }
}

/// Signed distance [m] of a point (object frame) from the plane of a component, positive outside.
///
/// Paper §3: "determining the distance between the current face and the contact point". (contact.23)
pub(super) fn signed_distance(mesh: &HalfEdgeMesh, feature: Feature, point: DVec3) -> f64 {
    let on_component = match feature {
        Feature::Face(face) => mesh.origin(mesh.half_edge_of_face(face)),
        Feature::Edge(edge) => mesh.edge_vertices(edge)[0],
        Feature::Vertex(vertex) => vertex,
    };
    (point - mesh.position(on_component)).dot(normal(mesh, feature))
}

/// The adjacent component onto which `point` (object frame) has left `feature`; none while the component holds it.
///
/// A face holds the points over its triangle: at most three point-to-edge tests. An edge holds them up to `edge_width / 2` to each
/// side between its ends, a vertex up to that distance around it. Leaving a face takes crossing the edge's line, leaving the edge
/// half the width: the rectangle is a hysteresis. (contact.22)
pub(super) fn adjacent(
    mesh: &HalfEdgeMesh,
    feature: Feature,
    point: DVec3,
    edge_width: f64,
) -> Option<Feature> {
    match feature {
        Feature::Face(face) => leave_face(mesh, face, point),
        Feature::Edge(edge) => leave_edge(mesh, edge, point, 0.5 * edge_width),
        Feature::Vertex(vertex) => leave_vertex(mesh, vertex, point, 0.5 * edge_width),
    }
}

/// The component under `point` (object frame), starting from `feature`; `visit(from, to)` sees every step.
///
/// Never steps straight back, so a point above both sides of an edge rests on the edge. (contact.22)
pub(super) fn walk(
    mesh: &HalfEdgeMesh,
    feature: Feature,
    point: DVec3,
    edge_width: f64,
    mut visit: impl FnMut(Feature, Feature),
) -> Feature {
    let mut current = feature;
    let mut previous = None;
    for _ in 0..MAX_STEPS {
        match adjacent(mesh, current, point, edge_width) {
            Some(next) if previous != Some(next) => {
                visit(current, next);
                previous = Some(current);
                current = next;
            }
            _ => break,
        }
    }
    current
}

/// The component of a new contact at `point` with normal `direction` (both object frame), found from a support vertex in that direction.
///
/// A fresh pair often lies on the border of several components (the corner of a box flat on a table). Of those that hold the point
/// within half an edge width the one with the normal nearest to `direction` is taken, so that flat contact is contact with a face.
pub(super) fn locate(
    mesh: &HalfEdgeMesh,
    support_vertex: VertexId,
    (point, direction): (DVec3, DVec3),
    edge_width: f64,
) -> Feature {
    let found = walk(
        mesh,
        Feature::Vertex(support_vertex),
        point,
        edge_width,
        |_, _| {},
    );
    let reach = 0.5 * edge_width;
    let mut best = BestNormal {
        mesh,
        direction,
        cosine: f64::NEG_INFINITY,
        feature: found,
    };
    let vertices = vertices_of(mesh, found);
    let near = vertices
        .iter()
        .flatten()
        .find(|v| mesh.position(**v).distance(point) <= reach);
    if let Some(&vertex) = near {
        for half_edge in mesh.outgoing(vertex) {
            best.offer(mesh.face(half_edge).map(Feature::Face));
        }
        for half_edge in mesh.outgoing(vertex) {
            best.offer(Some(Feature::Edge(mesh.edge(half_edge))));
        }
        best.offer(Some(Feature::Vertex(vertex)));
    } else if let Some(edge) = edge_within(mesh, found, point, reach) {
        for face in mesh.edge_faces(edge) {
            best.offer(face.map(Feature::Face));
        }
        best.offer(Some(Feature::Edge(edge)));
    }
    best.feature
}

/// Keeps the component whose normal agrees best with a direction; earlier offers win ties.
struct BestNormal<'m> {
    mesh: &'m HalfEdgeMesh,
    direction: DVec3,
    cosine: f64,
    feature: Feature,
}

impl BestNormal<'_> {
    fn offer(&mut self, feature: Option<Feature>) {
        let Some(feature) = feature else { return };
        let cosine = normal(self.mesh, feature).dot(self.direction);
        // Coplanar triangles share their normal with the diagonal between them up to rounding.
        if cosine > self.cosine + 1e-12 {
            self.cosine = cosine;
            self.feature = feature;
        }
    }
}

fn vertices_of(mesh: &HalfEdgeMesh, feature: Feature) -> [Option<VertexId>; 3] {
    match feature {
        Feature::Face(face) => mesh.face_vertices(face).map(Some),
        Feature::Edge(edge) => {
            let [a, b] = mesh.edge_vertices(edge);
            [Some(a), Some(b), None]
        }
        Feature::Vertex(vertex) => [Some(vertex), None, None],
    }
}

/// The edge of a face nearest to a point of it and within `reach` [m], or the edge itself.
fn edge_within(mesh: &HalfEdgeMesh, feature: Feature, point: DVec3, reach: f64) -> Option<EdgeId> {
    match feature {
        Feature::Face(face) => {
            let (half_edge, inside) = nearest_border(mesh, face, point);
            (inside.abs() <= reach).then(|| mesh.edge(half_edge))
        }
        Feature::Edge(edge) => Some(edge),
        Feature::Vertex(_) => None,
    }
}

/// The half-edge a point is furthest beyond (or nearest to, from inside) and its distance [m] inside that line.
fn nearest_border(mesh: &HalfEdgeMesh, face: FaceId, point: DVec3) -> (HalfEdgeId, f64) {
    let face_normal = mesh.face_normal(face);
    let mut best = (mesh.half_edge_of_face(face), f64::INFINITY);
    for half_edge in mesh.face_half_edges(face) {
        let inward = face_normal.cross(direction(mesh, half_edge));
        let inside = (point - mesh.position(mesh.origin(half_edge))).dot(inward);
        if inside < best.1 {
            best = (half_edge, inside);
        }
    }
    best
}

fn leave_face(mesh: &HalfEdgeMesh, face: FaceId, point: DVec3) -> Option<Feature> {
    let (half_edge, inside) = nearest_border(mesh, face, point);
    (inside < 0.0).then(|| Feature::Edge(mesh.edge(half_edge)))
}

fn leave_edge(mesh: &HalfEdgeMesh, edge: EdgeId, point: DVec3, reach: f64) -> Option<Feature> {
    let half_edge = mesh.half_edge_of_edge(edge);
    let [start, end] = mesh.edge_vertices(edge);
    let along = direction(mesh, half_edge);
    let offset = point - mesh.position(start);
    // Across the rectangle, positive towards the face on the left of `half_edge`.
    let across = offset.dot(mesh.edge_normal(edge).cross(along));
    let beyond_side = across.abs() - reach;
    let position = offset.dot(along);
    let beyond_end = (-position).max(position - mesh.position(start).distance(mesh.position(end)));
    if beyond_end > 0.0 && beyond_end >= beyond_side {
        let vertex = if position < 0.0 { start } else { end };
        return Some(Feature::Vertex(vertex));
    }
    if beyond_side <= 0.0 {
        return None;
    }
    let side = if across > 0.0 {
        half_edge
    } else {
        mesh.twin(half_edge)
    };
    mesh.face(side).map(Feature::Face)
}

fn leave_vertex(
    mesh: &HalfEdgeMesh,
    vertex: VertexId,
    point: DVec3,
    reach: f64,
) -> Option<Feature> {
    let offset = point - mesh.position(vertex);
    let pseudonormal = mesh.vertex_pseudonormal(vertex);
    if (offset - offset.dot(pseudonormal) * pseudonormal).length() <= reach {
        return None;
    }
    let mut nearest_edge = None;
    let mut least_distance = f64::INFINITY;
    for half_edge in mesh.outgoing(vertex) {
        let Some(face) = mesh.face(half_edge) else {
            continue;
        };
        let along = direction(mesh, half_edge);
        let before = mesh.next(mesh.next(half_edge));
        let face_normal = mesh.face_normal(face);
        let inside_leaving = offset.dot(face_normal.cross(along));
        let inside_arriving = offset.dot(face_normal.cross(direction(mesh, before)));
        if inside_leaving >= 0.0 && inside_arriving >= 0.0 {
            return Some(Feature::Face(face));
        }
        let position = offset.dot(along);
        let distance = (offset - position * along).length();
        if position > 0.0 && distance < least_distance {
            least_distance = distance;
            nearest_edge = Some(Feature::Edge(mesh.edge(half_edge)));
        }
    }
    nearest_edge
}

/// Unit vector from the origin of a half-edge to its end; zero for an edge without length.
fn direction(mesh: &HalfEdgeMesh, half_edge: HalfEdgeId) -> DVec3 {
    let from = mesh.position(mesh.origin(half_edge));
    let to = mesh.position(mesh.origin(mesh.next(half_edge)));
    (to - from).normalize_or_zero()
}
