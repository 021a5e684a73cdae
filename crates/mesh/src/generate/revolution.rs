//! Solids of revolution about x: rings of vertices joined by bands and closed by poles.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;

use super::{GenerateError, check_count, check_length};
use crate::TriangleMesh;

/// Cylinder of `radius` and `length` [m] along x from the origin, with `sectors` sides, inscribed.
///
/// # Errors
/// A length that is not positive and finite; fewer than 3 or more than 4096 sectors.
pub fn cylinder(radius: f64, length: f64, sectors: u32) -> Result<TriangleMesh, GenerateError> {
    cone([radius, radius], length, sectors)
}

/// Cone frustum along x with a radius at x = 0 and one at x = `length` [m]. One radius may be 0 (a tip).
///
/// # Errors
/// A negative radius or both 0; a length that is not positive and finite; fewer than 3 or more than 4096
/// sectors.
pub fn cone(radii: [f64; 2], length: f64, sectors: u32) -> Result<TriangleMesh, GenerateError> {
    check_length("length", length)?;
    check_count("sectors", sectors, 3)?;
    check_length("larger radius", radii[0].max(radii[1]))?;
    let mut rings = Vec::new();
    for (radius, x) in [(radii[0], 0.0), (radii[1], length)] {
        if radius != 0.0 {
            check_length("radius", radius)?;
            rings.push((x, radius));
        }
    }
    swept(0.0, &rings, length, sectors)
}

/// Capsule: a cylinder of `length` between the centres of two half balls of `radius` [m], along x; the
/// centres are at x = 0 and x = `length`. Each half ball has `bands` rings of `sectors` vertices.
///
/// # Errors
/// A length that is not positive and finite; fewer than 3 sectors or 1 band, or more than 4096 of either.
pub fn capsule(
    radius: f64,
    length: f64,
    sectors: u32,
    bands: u32,
) -> Result<TriangleMesh, GenerateError> {
    check_length("radius", radius)?;
    check_length("length", length)?;
    check_count("sectors", sectors, 3)?;
    check_count("bands", bands, 1)?;
    let angle = |i: u32| FRAC_PI_2 * f64::from(i) / f64::from(bands);
    let first = (1..=bands).map(|i| (-radius * angle(i).cos(), radius * angle(i).sin()));
    let last = (1..=bands)
        .rev()
        .map(|i| (length + radius * angle(i).cos(), radius * angle(i).sin()));
    let mut rings: Vec<(f64, f64)> = first.chain(last).collect();
    // The equators lie exactly at the centres, not at a rounded cosine of 90°.
    rings[bands as usize - 1] = (0.0, radius);
    rings[bands as usize] = (length, radius);
    swept(-radius, &rings, length + radius, sectors)
}

/// Straight tube along x from the origin: `outer` and `inner` radius and `length` [m]; Euler number 0.
///
/// # Errors
/// A length that is not positive and finite, `inner` not below `outer`, fewer than 3 or more than 4096
/// sectors.
pub fn tube(
    outer: f64,
    inner: f64,
    length: f64,
    sectors: u32,
) -> Result<TriangleMesh, GenerateError> {
    check_length("outer radius", outer)?;
    check_length("inner radius", inner)?;
    check_length("length", length)?;
    check_count("sectors", sectors, 3)?;
    if inner >= outer {
        return Err(GenerateError::Hollow { inner, outer });
    }
    // Rings in the order of a walk around the wall's section: out along the outside, back along the inside.
    let rings = [(0.0, outer), (length, outer), (length, inner), (0.0, inner)];
    let mut triangles = Vec::new();
    for i in 0..4 {
        triangles.extend(band(i * sectors, (i + 1) % 4 * sectors, sectors));
    }
    Ok(TriangleMesh::new(ring_points(&rings, sectors), triangles)?)
}

/// Rings (x, radius) in order of x between two poles on the axis.
fn swept(
    first: f64,
    rings: &[(f64, f64)],
    last: f64,
    sectors: u32,
) -> Result<TriangleMesh, GenerateError> {
    let mut positions = ring_points(rings, sectors);
    let poles = u32::try_from(positions.len()).expect("sectors and bands are limited");
    positions.extend([DVec3::X * first, DVec3::X * last]);
    let mut triangles = Vec::new();
    for start in (0..poles).step_by(sectors as usize) {
        if start + sectors < poles {
            triangles.extend(band(start, start + sectors, sectors));
        }
    }
    for i in 0..sectors {
        let j = (i + 1) % sectors;
        let end = poles - sectors;
        triangles.extend([[poles, j, i], [poles + 1, end + i, end + j]]);
    }
    Ok(TriangleMesh::new(positions, triangles)?)
}

fn ring_points(rings: &[(f64, f64)], sectors: u32) -> Vec<DVec3> {
    let on_ring = |&(x, radius): &(f64, f64)| {
        (0..sectors).map(move |i| {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(sectors)).sin_cos();
            DVec3::new(x, radius * cosine, radius * sine)
        })
    };
    rings.iter().flat_map(on_ring).collect()
}

/// Two triangles per sector between rings that start at `a` and `b`; outward when `b` is further along x.
fn band(a: u32, b: u32, sectors: u32) -> impl Iterator<Item = [u32; 3]> {
    (0..sectors).flat_map(move |i| {
        let j = (i + 1) % sectors;
        [[a + i, a + j, b + j], [a + i, b + j, b + i]]
    })
}
