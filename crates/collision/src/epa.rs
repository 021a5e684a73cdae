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

use crate::gjk::{ClosestPoints, GAP_TOLERANCE, Plane, touched, witnesses};
use crate::rims::{self, Memory};
use crate::simplex::{NOISE, Simplex, cross_of, plane_of};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

mod polytope;
mod seed;
mod surface;
mod sweep;

use polytope::{Growth, Polytope};
use seed::Seed;
pub(crate) use surface::Surface;
use surface::{MOST_FACES, MOST_VERTICES};

/// A gap at which a repeated support point is rounding and not a dent in a recalled surface, times the largest coordinate.
const DENT: f64 = 1e-12;

/// How one run on buffers of a given size ended.
struct Expansion {
    plane: Plane,
    /// A vertex found no room: the plane is a bound, the best so far.
    full: bool,
    /// The polytope is another than at the start.
    grown: bool,
    /// A face was given up that lies lower than the plane.
    doubtful: bool,
}

/// The supporting plane of the difference nearest to the origin, which GJK found inside or on it, with the points it touches.
/// `surface` and `memory` become the start for a placement nearby. Allocates nothing.
// Kept out of the callers: its buffers would enlarge the stack frame of every query that stays apart.
#[inline(never)]
pub(crate) fn shallowest<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    simplex: &Simplex,
    surface: &mut Surface,
    memory: &mut Memory,
) -> ClosestPoints
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    surface.clear();
    let tetrahedron = match seed::complete(difference, simplex) {
        Seed::Solid(tetrahedron) => tetrahedron,
        Seed::Flat(normal) => return witnesses(difference, &flat(difference, simplex, normal)),
    };
    if !memory.is_empty()
        && let Some(answer) = sweep::sweep(difference, &tetrahedron, memory)
    {
        *memory = answer.memory;
        return answer.found;
    }
    *memory = Memory::default();
    // Nearly every query ends in the small buffers; clearing the large ones costs microseconds.
    let mut polytope = Polytope::<32, 64>::empty();
    polytope.start(&tetrahedron);
    let small = expand(difference, &mut polytope);
    if !small.full {
        polytope.remember(surface);
    }
    if !rims::meets(difference, &small.plane.simplex) {
        let plane = if small.full {
            larger::<_, _, 1024, 2048>(difference, &tetrahedron)
        } else {
            small.plane
        };
        return witnesses(difference, &plane);
    }
    // On rims no number of faces is enough; these tell where to start.
    let plane = if small.full || small.doubtful {
        larger::<_, _, 320, 640>(difference, &tetrahedron)
    } else {
        small.plane
    };
    match rims::settle(difference, &plane) {
        Some(answer) => {
            *memory = answer.memory;
            answer.found
        }
        None => touched(difference, &plane),
    }
}

/// Expands a tetrahedron with room for more vertices and faces.
#[inline(never)]
fn larger<A, B, const VERTICES: usize, const FACES: usize>(
    difference: &MinkowskiDifference<'_, A, B>,
    tetrahedron: &[DifferencePoint; 4],
) -> Plane
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut polytope = Polytope::<VERTICES, FACES>::empty();
    polytope.start(tetrahedron);
    let found = expand(difference, &mut polytope);
    if found.full || found.doubtful {
        shallowest_on_rims(difference, &polytope, found.plane)
    } else {
        found.plane
    }
}

/// Most combinations of rims, edges and corners, in any quarter of a side of a cube around the origin, that are compared.
const MOST_FEATURES: usize = 128;

/// Around an axis all directions are nearly equally deep and no number of faces tells which is the one. Of every
/// such combination among the faces left lower, the plane from which it settles lowest.
#[inline(never)]
fn shallowest_on_rims<A, B, const VERTICES: usize, const FACES: usize>(
    difference: &MinkowskiDifference<'_, A, B>,
    polytope: &Polytope<VERTICES, FACES>,
    plane: Plane,
) -> Plane
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    if !rims::meets(difference, &plane.simplex) {
        return plane;
    }
    // Of equally deep ones that with the better witnesses.
    let merit = |plane: &Plane| {
        let found = witnesses(difference, plane);
        found.separation - found.doubt()
    };
    let mut best = plane;
    let mut most = merit(&best);
    let mut seen = [0; MOST_FEATURES];
    let mut count = 0;
    for face in polytope.faces_below(-plane.separation) {
        let corners = polytope.corners(face);
        let (outward, _) = polytope.plane(face);
        let key = rims::key(difference, &corners, outward);
        if count == MOST_FEATURES || seen[..count].contains(&key) {
            continue;
        }
        seen[count] = key;
        count += 1;
        let reach = outward.dot(difference.support(outward, &corners[0]).point);
        let candidate = Plane {
            normal: -outward,
            separation: -reach,
            simplex: nearest_to(outward * reach, std::iter::once(corners)).1,
        };
        let own = merit(&candidate);
        if own > most {
            most = own;
            best = candidate;
        }
    }
    best
}

/// [`shallowest`], started from the surface of a placement nearby. Every corner of it is still a point of the difference; if in
/// addition the origin lies below all its faces, then it lies inside, and no face of the difference is nearer than the
/// nearest of these: between any of them and the origin there are only convex combinations of points of the difference.
/// The surface need not be convex for that (collision.7). `None`: it does not enclose the origin any more.
#[inline(never)]
pub(crate) fn shallowest_from<A, B>(
    surface: &mut Surface,
    difference: &MinkowskiDifference<'_, A, B>,
) -> Option<Plane>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut placed = [DifferencePoint::NONE; MOST_VERTICES];
    for (vertex, &[a, b]) in placed.iter_mut().zip(surface.vertices()) {
        *vertex = difference.vertex(a, b);
    }
    let placed = &placed[..surface.vertices().len()];
    if let Some(plane) = unchanged(surface, difference, placed)? {
        return Some(plane);
    }
    regrown(surface, difference, placed)
}

/// Grows a recalled surface until its lowest face supports the difference.
#[inline(never)]
fn regrown<A, B>(
    surface: &mut Surface,
    difference: &MinkowskiDifference<'_, A, B>,
    placed: &[DifferencePoint],
) -> Option<Plane>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut polytope = Polytope::<32, 64>::empty();
    polytope.recall(surface, placed);
    let found = expand(difference, &mut polytope);
    if found.full || found.doubtful || (found.grown && !polytope.encloses_origin()) {
        return None;
    }
    if found.grown {
        polytope.remember(surface);
    }
    Some(found.plane)
}

/// Tries the lowest face of a recalled surface: `Some(None)` if the difference reaches beyond it, `None` if the surface does
/// not enclose the origin.
#[expect(
    clippy::option_option,
    reason = "the outer one is the answer to another question, and both are passed on"
)]
fn unchanged<A, B>(
    surface: &Surface,
    difference: &MinkowskiDifference<'_, A, B>,
    placed: &[DifferencePoint],
) -> Option<Option<Plane>>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let corners_of = |face: usize| {
        surface.faces()[face]
            .0
            .map(|corner| placed[usize::from(corner)])
    };
    let faces = 0..surface.faces().len();
    // Heights squared: of all faces but the lowest they are only compared.
    let mut heights_squared = [f64::INFINITY; MOST_FACES];
    let (mut lowest, mut least) = (0, f64::INFINITY);
    for face in faces.clone() {
        let (cross, base) = cross_of(corners_of(face).map(|vertex| vertex.point));
        let volume = cross.dot(base);
        let height_squared = volume * volume / cross.length_squared();
        if volume <= 0.0 || height_squared.is_nan() {
            return None;
        }
        heights_squared[face] = height_squared;
        if height_squared < least {
            (lowest, least) = (face, height_squared);
        }
    }
    let (outward, height) = plane_of(corners_of(lowest).map(|vertex| vertex.point))?;
    let scale = largest(placed);
    let reach = outward.dot(difference.support(outward, &corners_of(lowest)[0]).point);
    let tolerance = GAP_TOLERANCE * scale;
    if reach - height > tolerance {
        return Some(None);
    }
    let limit = reach + NOISE * scale + tolerance;
    let near = faces
        .filter(|&face| heights_squared[face] <= limit * limit)
        .map(corners_of);
    Some(Some(Plane {
        normal: -outward,
        separation: -reach,
        simplex: nearest_to(outward * reach, near).1,
    }))
}

/// Of some faces the feature nearest to `exit`, with the weights of its point there: where the way out meets the surface,
/// also when coplanar triangles or opposite sides are equally near. With its distance [m]; infinite and empty without faces
/// (collision.8).
fn nearest_to(exit: DVec3, faces: impl Iterator<Item = [DifferencePoint; 3]>) -> (f64, Simplex) {
    let mut best = (f64::INFINITY, Simplex::EMPTY);
    for corners in faces {
        let mut simplex = Simplex::triangle(corners.map(|vertex| DifferencePoint {
            point: vertex.point - exit,
            ..vertex
        }));
        if let Some(nearest) = simplex.reduce()
            && nearest.distance < best.0
        {
            best = (nearest.distance, simplex);
        }
    }
    best
}

/// Largest distance of a vertex from the origin [m].
fn largest(vertices: &[DifferencePoint]) -> f64 {
    vertices
        .iter()
        .fold(0.0, |largest: f64, vertex| {
            largest.max(vertex.point.length_squared())
        })
        .sqrt()
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

/// Grows the polytope at its lowest face until that supports the difference (collision.6).
fn expand<A, B, const VERTICES: usize, const FACES: usize>(
    difference: &MinkowskiDifference<'_, A, B>,
    polytope: &mut Polytope<VERTICES, FACES>,
) -> Expansion
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let scale = largest(polytope.vertices());
    let tolerance = GAP_TOLERANCE * scale;
    let mut bound = f64::INFINITY;
    let mut outward = DVec3::X;
    let (mut full, mut grown, mut doubtful) = (false, false, false);
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
            doubtful |= reach - height > DENT * scale;
            continue;
        }
        match grow(polytope, face, support, tolerance) {
            Growth::Grown => grown = true,
            Growth::Torn => {
                polytope.close(face);
                doubtful = true;
            }
            Growth::NoRoom => {
                full = true;
                break;
            }
        }
    }
    let plane = Plane {
        normal: -outward,
        separation: -bound,
        simplex: polytope.feature_at(
            outward * bound,
            bound + NOISE * scale + tolerance,
            DENT * scale,
        ),
    };
    Expansion {
        plane,
        full,
        grown,
        doubtful,
    }
}

/// Adds a vertex; where rounding tears the horizon among almost coplanar faces, once more with all of them kept in doubt
/// and once with all of them removed.
fn grow<const VERTICES: usize, const FACES: usize>(
    polytope: &mut Polytope<VERTICES, FACES>,
    face: usize,
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
