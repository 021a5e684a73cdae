//! Ellipsoids: by latitude and longitude, and as the hull of a Fibonacci spiral.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::{GenerateError, check_count, check_length};
use crate::{TriangleMesh, convex_hull};

/// Ellipsoid with half-axes `radii` [m] and poles on z: `sectors` meridians, `bands` from pole to pole, that
/// is sectors·(bands − 1) + 2 vertices on the surface and 2·sectors·(bands − 1) triangles. 96 sectors and 67
/// bands give 12,672 triangles. The quadrilaterals between parallels are plane up to rounding.
///
/// # Errors
/// A radius that is not positive and finite; fewer than 3 sectors or 2 bands, or more than 4096 of either.
pub fn latitude_longitude_ellipsoid(
    radii: DVec3,
    sectors: u32,
    bands: u32,
) -> Result<TriangleMesh, GenerateError> {
    check_radii(radii)?;
    check_count("sectors", sectors, 3)?;
    check_count("bands", bands, 2)?;
    let mut positions = vec![radii * DVec3::Z];
    for ring in 1..bands {
        let (radius, z) = (PI * f64::from(ring) / f64::from(bands)).sin_cos();
        positions.extend((0..sectors).map(|i| {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(sectors)).sin_cos();
            radii * DVec3::new(radius * cosine, radius * sine, z)
        }));
    }
    positions.push(radii * DVec3::NEG_Z);
    let south = sectors * (bands - 1) + 1;
    let mut triangles = Vec::new();
    for i in 0..sectors {
        let j = (i + 1) % sectors;
        triangles.push([0, 1 + i, 1 + j]);
        for ring in 0..bands - 2 {
            let (upper, lower) = (1 + ring * sectors, 1 + (ring + 1) * sectors);
            triangles.extend([
                [upper + i, lower + i, lower + j],
                [upper + i, lower + j, upper + j],
            ]);
        }
        let last = south - sectors;
        triangles.push([last + i, south, last + j]);
    }
    Ok(TriangleMesh::new(positions, triangles)?)
}

/// Hull of `points` points on an ellipsoid with half-axes `radii` [m], spread evenly along a spiral that
/// turns by the golden angle per point: strictly convex, 2·points − 4 triangles.
///
/// # Errors
/// A radius that is not positive and finite; fewer than 4 or more than 10⁶ points; half-axes so different
/// that the points lie in a plane.
pub fn fibonacci_ellipsoid(radii: DVec3, points: u32) -> Result<TriangleMesh, GenerateError> {
    check_radii(radii)?;
    let (min, max) = (4, 1_000_000);
    if !(min..=max).contains(&points) {
        let name = "points";
        return Err(GenerateError::Count {
            name,
            value: points,
            min,
            max,
        });
    }
    let golden_angle = PI * (3.0 - 5.0_f64.sqrt());
    let on_spiral = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(points);
        let (sine, cosine) = (golden_angle * f64::from(i)).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        radii * DVec3::new(radius * cosine, radius * sine, z)
    };
    let cloud: Vec<DVec3> = (0..points).map(on_spiral).collect();
    Ok(convex_hull(&cloud)?)
}

fn check_radii(radii: DVec3) -> Result<(), GenerateError> {
    check_length("half-axis x", radii.x)?;
    check_length("half-axis y", radii.y)?;
    check_length("half-axis z", radii.z)
}
