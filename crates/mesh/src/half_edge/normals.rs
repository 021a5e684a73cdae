//! Face normals, edge normals and angle-weighted vertex pseudonormals (Bærentzen and Aanæs 2005, eq. 6).

use glam::DVec3;

use super::{Links, TopologyError};
use crate::triangle_mesh::{DEGENERATE_ALTITUDE, altitude};
use crate::{Aabb, HalfEdgeId, VertexId};

/// Unit normals of all elements.
#[derive(Clone, Debug)]
pub(super) struct Normals {
    pub(super) face: Vec<DVec3>,
    pub(super) edge: Vec<DVec3>,
    pub(super) vertex: Vec<DVec3>,
}

impl Normals {
    pub(super) fn new(positions: &[DVec3], links: &Links) -> Result<Self, TopologyError> {
        let face = face_normals(positions, links)?;
        let edge = links
            .half_of_edge
            .iter()
            .map(|&half| edge_normal(&face, links, half))
            .collect();
        let vertex = (0..)
            .take(positions.len())
            .map(|v| vertex_normal(positions, &face, links, VertexId(v)))
            .collect();
        Ok(Self { face, edge, vertex })
    }
}

fn face_normals(positions: &[DVec3], links: &Links) -> Result<Vec<DVec3>, TopologyError> {
    let flat = DEGENERATE_ALTITUDE * Aabb::from_points(positions).diagonal();
    let triangles = links.origin[..3 * links.faces as usize].as_chunks::<3>().0;
    let mut normals: Vec<DVec3> = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|v| positions[v as usize]);
            if altitude([a, b, c]) > flat {
                (b - a).cross(c - a).normalize_or_zero()
            } else {
                DVec3::ZERO
            }
        })
        .collect();
    let missing: Vec<u32> = (0..links.faces)
        .filter(|&f| normals[f as usize] == DVec3::ZERO)
        .collect();
    fill_missing(&mut normals, links, missing)?;
    Ok(normals)
}

/// Gives triangles without area the mean normal of their neighbours, spreading inwards round by round.
fn fill_missing(
    normals: &mut [DVec3],
    links: &Links,
    mut missing: Vec<u32>,
) -> Result<(), TopologyError> {
    while !missing.is_empty() {
        let found: Vec<(u32, DVec3)> = missing
            .iter()
            .map(|&f| (f, neighbour_mean(normals, links, f)))
            .filter(|&(_, n)| n != DVec3::ZERO)
            .collect();
        if found.is_empty() {
            return Err(TopologyError::NoNormal {
                triangle: missing[0],
            });
        }
        for (f, normal) in found {
            normals[f as usize] = normal;
        }
        missing.retain(|&f| normals[f as usize] == DVec3::ZERO);
    }
    Ok(())
}

fn neighbour_mean(normals: &[DVec3], links: &Links, face: u32) -> DVec3 {
    let around = (0..3)
        .filter_map(|k| links.face(HalfEdgeId(links.twin[(3 * face + k) as usize])))
        .map(|f| normals[f.index()]);
    let sum: DVec3 = around.clone().sum();
    // Two neighbours folded onto each other cancel: the first that has a normal decides.
    unit_or(sum, || {
        around
            .clone()
            .find(|&n| n != DVec3::ZERO)
            .unwrap_or(DVec3::ZERO)
    })
}

/// Sum of the unit normals left and right (mesh.7).
fn edge_normal(face: &[DVec3], links: &Links, half: u32) -> DVec3 {
    let left = face[(half / 3) as usize];
    let right = links
        .face(HalfEdgeId(links.twin[half as usize]))
        .map_or(DVec3::ZERO, |f| face[f.index()]);
    unit_or(left + right, || left)
}

/// Sum of the unit normals around, weighted by corner angle (mesh.7).
fn vertex_normal(positions: &[DVec3], face: &[DVec3], links: &Links, vertex: VertexId) -> DVec3 {
    let p = positions[vertex.index()];
    let mut sum = DVec3::ZERO;
    let mut any = DVec3::ZERO;
    for half in links.outgoing(vertex) {
        let Some(f) = links.face(half) else { continue };
        let second = links.next(half);
        let third = links.next(second);
        let to = |h: HalfEdgeId| positions[links.origin[h.index()] as usize] - p;
        let (u, v) = (to(second), to(third));
        // atan2 keeps full accuracy for the thin corners where acos of a dot product loses half the digits.
        sum += face[f.index()] * u.cross(v).length().atan2(u.dot(v));
        any = face[f.index()];
    }
    unit_or(sum, || any)
}

/// `vector` at unit length, or the fallback where the sum has cancelled and only rounding is left.
fn unit_or(vector: DVec3, fallback: impl Fn() -> DVec3) -> DVec3 {
    let length = vector.length();
    if length > 1e-12 {
        vector / length
    } else {
        fallback()
    }
}
