//! EPA: the shallowest way out of an overlap.
//!
//! Van den Bergen (2001, "Proximity Queries and Penetration Depth Computation on 3D Game Objects"): a polytope inside the
//! Minkowski difference grows at the face nearest to the origin until that face supports the difference itself. What
//! departs from the paper, because each is where implementations fail on touching, parallel and identical shapes:
//!
//! - Any simplex of one to four points is accepted. It is completed to a tetrahedron by support points that are verified
//!   to be independent, and heights of faces are signed, so the origin need not start inside: a face it lies beyond is the
//!   lowest, hence the next to grow, until the origin is inside or a supporting plane shows that it is outside.
//! - All faces visible from a new vertex go (flood to the horizon), not only the nearest one.
//! - Every support call yields a certified upper bound of the depth, whatever the polytope looks like. The search ends when
//!   the lowest open face is not below the best bound; a face whose support point is already a vertex is closed for good.
//!   When buffers or topology give out, the best bound stands.
//! - A flat difference (coplanar plates, crossing segments) has depth zero along its normal.

use glam::DVec3;

use crate::gjk::{GAP_TOLERANCE, Plane};
use crate::simplex::{NOISE, Simplex};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

mod polytope;
mod seed;

use polytope::{Growth, Polytope};
use seed::Seed;

/// How one run on buffers of a given size ended.
enum Outcome {
    /// The bound is tight, or as tight as rounding lets it be.
    Found(Plane),
    /// The buffers were too small; the best so far.
    Full(Plane),
}

/// The supporting plane of the difference nearest to the origin, which GJK found inside or on it. Allocates nothing.
pub(crate) fn shallowest<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    simplex: &Simplex,
) -> Plane
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let tetrahedron = match seed::complete(difference, simplex) {
        Seed::Solid(tetrahedron) => tetrahedron,
        Seed::Flat(normal) => return flat(difference, simplex, normal),
    };
    // Nearly every query ends in the small buffers; clearing the large ones costs microseconds.
    match expand::<A, B, 64, 128>(difference, &tetrahedron) {
        Outcome::Found(plane) => plane,
        Outcome::Full(_) => match expand::<A, B, 1024, 2048>(difference, &tetrahedron) {
            Outcome::Found(plane) | Outcome::Full(plane) => plane,
        },
    }
}

/// Depth of a difference without volume: nothing, along its normal.
fn flat<A, B>(difference: &MinkowskiDifference<'_, A, B>, simplex: &Simplex, normal: DVec3) -> Plane
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut simplex = *simplex;
    let tetrahedron = simplex;
    if simplex.reduce().is_none() {
        // Four coplanar points around the origin: any face of them that holds it.
        simplex = nearest_of_faces(&tetrahedron);
    }
    let furthest = difference.support(-normal, &simplex.vertices()[0]);
    Plane {
        normal,
        separation: normal.dot(furthest.point),
        simplex,
    }
}

fn nearest_of_faces(tetrahedron: &Simplex) -> Simplex {
    let mut best = (f64::INFINITY, *tetrahedron);
    for omitted in 0..tetrahedron.vertices().len() {
        let mut face = Simplex::EMPTY;
        for (index, vertex) in tetrahedron.vertices().iter().enumerate() {
            if index != omitted {
                face.push(*vertex);
            }
        }
        if let Some(nearest) = face.reduce()
            && nearest.distance < best.0
        {
            best = (nearest.distance, face);
        }
    }
    best.1
}

fn expand<A, B, const VERTICES: usize, const FACES: usize>(
    difference: &MinkowskiDifference<'_, A, B>,
    tetrahedron: &[DifferencePoint; 4],
) -> Outcome
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut polytope = Polytope::<VERTICES, FACES>::new(tetrahedron);
    let scale = tetrahedron.iter().fold(0.0, |largest: f64, vertex| {
        largest.max(vertex.point.length())
    });
    let tolerance = GAP_TOLERANCE * scale;
    let mut bound = f64::INFINITY;
    let mut outward = DVec3::X;
    let mut full = false;
    while let Some(face) = polytope.lowest_open_face() {
        let (normal, height) = polytope.plane(face);
        if height >= bound - tolerance {
            break;
        }
        let support = difference.support(normal, &polytope.corner(face));
        let reach = normal.dot(support.point);
        if reach < bound {
            bound = reach;
            outward = normal;
        }
        if reach - height <= tolerance {
            break;
        }
        if polytope.contains_vertex(&support) {
            polytope.close(face);
            continue;
        }
        match grow(&mut polytope, face, support, tolerance) {
            Growth::Grown => {}
            Growth::Torn => polytope.close(face),
            Growth::NoRoom => {
                full = true;
                break;
            }
        }
    }
    let plane = Plane {
        normal: -outward,
        separation: -bound,
        simplex: polytope.feature_at(outward * bound, bound + NOISE * scale + tolerance),
    };
    if full {
        Outcome::Full(plane)
    } else {
        Outcome::Found(plane)
    }
}

/// Adds a vertex; where rounding tears the horizon among almost coplanar faces, once more with all of them kept in doubt
/// and once with all of them removed.
fn grow<const VERTICES: usize, const FACES: usize>(
    polytope: &mut Polytope<VERTICES, FACES>,
    face: u16,
    vertex: DifferencePoint,
    tolerance: f64,
) -> Growth {
    for factor in [1.0, 64.0, 0.0] {
        match polytope.grow(face, vertex, factor * tolerance) {
            Growth::Torn => {}
            growth => return growth,
        }
    }
    Growth::Torn
}
