//! Solids by formula, closed by construction and wound outward. Lengths in metres.
//!
//! Solids of revolution have their axis along x, like a tool along its handle frame, and stretch from x = 0
//! to x = length; cuboids and ellipsoids are centred on the origin.

mod ellipsoid;
mod revolution;

use glam::DVec3;
use thiserror::Error;

use crate::digits::number;
use crate::{HullError, MeshError, TriangleMesh};
pub use ellipsoid::{fibonacci_ellipsoid, latitude_longitude_ellipsoid};
pub use revolution::{capsule, cone, cylinder, tube};

/// Why a shape cannot be generated.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GenerateError {
    /// A length that is not positive and finite.
    #[error("{name} is {}: it must be positive and finite", number(*.value))]
    Length {
        /// Which parameter.
        name: &'static str,
        /// Its value [m].
        value: f64,
    },
    /// Too few or too many divisions.
    #[error("{name} is {value}: it must be between {min} and {max}")]
    Count {
        /// Which parameter.
        name: &'static str,
        /// Its value.
        value: u32,
        /// Smallest allowed.
        min: u32,
        /// Largest allowed.
        max: u32,
    },
    /// A tube whose hole is as wide as the tube.
    #[error(
        "the inner radius {} must be smaller than the outer radius {}",
        number(*.inner), number(*.outer)
    )]
    Hollow {
        /// Radius of the hole [m].
        inner: f64,
        /// Outer radius [m].
        outer: f64,
    },
    /// Coordinates overflow or elements are too many.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The points of a hull lie in a plane.
    #[error(transparent)]
    Hull(#[from] HullError),
}

/// Box with half edge lengths `half` [m], centred on the origin: 8 vertices, 12 triangles.
///
/// # Errors
/// A length that is not positive and finite.
pub fn cuboid(half: DVec3) -> Result<TriangleMesh, GenerateError> {
    for (name, value) in [
        ("half length x", half.x),
        ("half length y", half.y),
        ("half length z", half.z),
    ] {
        check_length(name, value)?;
    }
    // Bit k of the index is the sign along axis k.
    let corner = |i: u32| half * DVec3::new(sign(i & 1), sign(i & 2), sign(i & 4));
    let quads = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    Ok(TriangleMesh::new(
        (0..8).map(corner).collect(),
        triangles.collect(),
    )?)
}

/// Plate of `width` along x, `depth` along y and `thickness` along z [m], its upper face in the plane z = 0.
///
/// # Errors
/// A length that is not positive and finite.
pub fn plate(width: f64, depth: f64, thickness: f64) -> Result<TriangleMesh, GenerateError> {
    check_length("width", width)?;
    check_length("depth", depth)?;
    check_length("thickness", thickness)?;
    let centred = cuboid(0.5 * DVec3::new(width, depth, thickness))?;
    let lowered = centred
        .positions()
        .iter()
        .map(|&p| p - 0.5 * thickness * DVec3::Z);
    Ok(TriangleMesh::new(
        lowered.collect(),
        centred.triangles().to_vec(),
    )?)
}

fn sign(bit: u32) -> f64 {
    if bit == 0 { -1.0 } else { 1.0 }
}

fn check_length(name: &'static str, value: f64) -> Result<(), GenerateError> {
    if value > 0.0 && value.is_finite() {
        Ok(())
    } else {
        Err(GenerateError::Length { name, value })
    }
}

fn check_count(name: &'static str, value: u32, min: u32) -> Result<(), GenerateError> {
    // 2^12: 33 million triangles in two directions, far beyond use, far below overflow.
    let max = 1 << 12;
    if (min..=max).contains(&value) {
        Ok(())
    } else {
        Err(GenerateError::Count {
            name,
            value,
            min,
            max,
        })
    }
}
