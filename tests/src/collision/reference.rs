//! Files of the format "convex-pairs-1": shapes, placements and signed distances computed elsewhere.

use std::path::Path;

use anyhow::{Context, Result, ensure};
use glam::{DMat3, DQuat, DVec3};
use pliant_spatial::Pose;
use serde::Deserialize;

use super::shape::{Body, Shape, hull};

/// Name of the format, as the files say it.
pub const FORMAT: &str = "convex-pairs-1";

/// How far a matrix may be from a rotation, in any entry of its square `RᵀR`.
const ROTATION_SLACK: f64 = 1e-9;

/// A file's content, checked.
pub struct Reference {
    /// Shapes by number.
    pub shapes: Vec<Shape>,
    /// Cases in the file's order.
    pub cases: Vec<Case>,
}

/// Two shapes at placements, and the truth about them.
#[derive(Clone, Debug)]
pub struct Case {
    /// Number of the case in its file.
    pub id: u64,
    /// Family it belongs to.
    pub family: String,
    /// Numbers of the shapes A and B.
    pub shapes: [usize; 2],
    /// Placement of A in the world.
    pub world_from_a: Pose,
    /// Placement of B in A's frame.
    pub a_from_b: Pose,
    /// Signed distance [m].
    pub signed_distance: f64,
    /// World unit vector from A to B, where unique.
    pub normal: Option<DVec3>,
    /// Of the signed distance [m].
    pub tolerance: f64,
    /// Of the normal [rad].
    pub normal_tolerance: f64,
}

#[derive(Deserialize)]
struct File {
    format: String,
    shapes: Vec<ShapeSpec>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum ShapeSpec {
    Box {
        half: DVec3,
    },
    Capsule {
        radius: f64,
        half_length: f64,
    },
    Hull {
        vertices: Vec<DVec3>,
        #[serde(default)]
        faces: Vec<Vec<u32>>,
    },
    Latlong {
        slices: u32,
        stacks: u32,
        radii: DVec3,
    },
}

#[derive(Deserialize)]
struct Pair {
    id: u64,
    family: String,
    a: usize,
    b: usize,
    ra: [f64; 9],
    ta: DVec3,
    rb: [f64; 9],
    tb: DVec3,
    signed_distance: f64,
    normal: Option<DVec3>,
    tol: f64,
    normal_tol_rad: f64,
}

/// Reads and checks a file.
///
/// # Errors
/// When it cannot be read, is not of the format, or names or measures something impossible; says where.
pub fn read(path: &Path) -> Result<Reference> {
    let place = || path.display().to_string();
    let text = std::fs::read_to_string(path).with_context(place)?;
    parse(&text).with_context(place)
}

/// Checks the text of a file.
///
/// # Errors
/// As [`read`].
pub fn parse(text: &str) -> Result<Reference> {
    let file: File = serde_json::from_str(text)?;
    ensure!(
        file.format == FORMAT,
        "format is \"{}\", not \"{FORMAT}\"",
        file.format
    );
    let shapes: Result<Vec<Shape>> = (0..)
        .zip(&file.shapes)
        .map(|(number, spec): (usize, _)| shape(spec).with_context(|| format!("shapes[{number}]")))
        .collect();
    let shapes = shapes?;
    let cases: Result<Vec<Case>> = (0..)
        .zip(file.pairs)
        .map(|(number, pair): (usize, _)| {
            let id = pair.id;
            case(pair, shapes.len()).with_context(|| format!("pairs[{number}] (id {id})"))
        })
        .collect();
    Ok(Reference {
        cases: cases?,
        shapes,
    })
}

fn shape(spec: &ShapeSpec) -> Result<Shape> {
    match spec {
        ShapeSpec::Box { half } => {
            ensure!(
                half.is_finite() && half.min_element() >= 0.0,
                "half lengths {half} are not all finite and ≥ 0"
            );
            Ok(Shape::new(Body::Cuboid(*half), 0.0))
        }
        ShapeSpec::Capsule {
            radius,
            half_length,
        } => {
            let sizes = [*radius, *half_length];
            ensure!(
                sizes.iter().all(|size| size.is_finite() && *size >= 0.0),
                "radius {radius} and half length {half_length} are not both finite and ≥ 0"
            );
            let ends = [DVec3::NEG_Z * *half_length, DVec3::Z * *half_length];
            Ok(Shape::new(Body::Segment(ends), *radius))
        }
        ShapeSpec::Hull { vertices, faces } => checked_hull(vertices, faces),
        ShapeSpec::Latlong {
            slices,
            stacks,
            radii,
        } => {
            ensure!(
                (3..=4096).contains(slices) && (2..=4096).contains(stacks),
                "{slices} slices and {stacks} stacks, not 3 to 4096 and 2 to 4096"
            );
            ensure!(
                radii.is_finite() && radii.min_element() >= 0.0,
                "radii {radii} are not all finite and ≥ 0"
            );
            let (vertices, triangles) = latitude_longitude(*slices, *stacks, *radii);
            Ok(hull(vertices, triangles))
        }
    }
}

fn checked_hull(vertices: &[DVec3], faces: &[Vec<u32>]) -> Result<Shape> {
    ensure!(!vertices.is_empty(), "a hull without vertices");
    ensure!(
        vertices.iter().all(|vertex| vertex.is_finite()),
        "a vertex is not finite"
    );
    let mut triangles = Vec::new();
    for (number, face) in faces.iter().enumerate() {
        ensure!(
            face.len() >= 3,
            "faces[{number}] has {} corners",
            face.len()
        );
        let past = face
            .iter()
            .find(|&&corner| corner as usize >= vertices.len());
        if let Some(corner) = past {
            let count = vertices.len();
            anyhow::bail!("faces[{number}] names vertex {corner} of {count}");
        }
        triangles.extend((1..face.len() - 1).map(|i| [face[0], face[i], face[i + 1]]));
    }
    Ok(hull(vertices.to_vec(), triangles))
}

fn case(pair: Pair, shapes: usize) -> Result<Case> {
    for (name, shape) in [("a", pair.a), ("b", pair.b)] {
        ensure!(shape < shapes, "{name} names shape {shape} of {shapes}");
    }
    let ra = rotation(&pair.ra).context("ra")?;
    let rb = rotation(&pair.rb).context("rb")?;
    ensure!(
        pair.ta.is_finite() && pair.tb.is_finite(),
        "a translation is not finite"
    );
    let tolerances = [pair.tol, pair.normal_tol_rad];
    ensure!(
        pair.signed_distance.is_finite() && tolerances.iter().all(|t| t.is_finite() && *t >= 0.0),
        "the signed distance is not finite or a tolerance is not finite and ≥ 0"
    );
    if let Some(normal) = pair.normal {
        ensure!(
            (normal.length() - 1.0).abs() < 1e-9,
            "the normal {normal} is no unit vector"
        );
    }
    // The translations are subtracted before anything is rounded by a rotation.
    let inverse = ra.transpose();
    let a_from_b = Pose::new(
        DQuat::from_mat3(&(inverse * rb)).normalize(),
        inverse * (pair.tb - pair.ta),
    );
    Ok(Case {
        id: pair.id,
        family: pair.family,
        shapes: [pair.a, pair.b],
        world_from_a: Pose::new(DQuat::from_mat3(&ra).normalize(), pair.ta),
        a_from_b,
        signed_distance: pair.signed_distance,
        normal: pair.normal,
        tolerance: pair.tol,
        normal_tolerance: pair.normal_tol_rad,
    })
}

fn rotation(rows: &[f64; 9]) -> Result<DMat3> {
    let matrix = DMat3::from_cols_array(rows).transpose();
    let product = matrix.transpose() * matrix;
    let orthonormal = (product - DMat3::IDENTITY)
        .to_cols_array()
        .iter()
        .all(|entry| entry.abs() <= ROTATION_SLACK);
    ensure!(
        orthonormal && matrix.determinant() > 0.0,
        "the matrix is no rotation"
    );
    Ok(matrix)
}

/// Vertices and outward triangles of the ellipsoid that the format describes.
pub fn latitude_longitude(slices: u32, stacks: u32, radii: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut vertices = vec![DVec3::Z * radii.z];
    for ring in 1..stacks {
        let theta = std::f64::consts::PI * f64::from(ring) / f64::from(stacks);
        for slice in 0..slices {
            let phi = std::f64::consts::TAU * f64::from(slice) / f64::from(slices);
            let direction = DVec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            );
            vertices.push(direction * radii);
        }
    }
    vertices.push(DVec3::NEG_Z * radii.z);
    let at = |ring: u32, slice: u32| 1 + (ring - 1) * slices + slice % slices;
    let south = 1 + (stacks - 1) * slices;
    let mut faces = Vec::new();
    for slice in 0..slices {
        faces.push([0, at(1, slice), at(1, slice + 1)]);
        for ring in 1..stacks - 1 {
            let [p, q] = [at(ring, slice), at(ring, slice + 1)];
            let [r, s] = [at(ring + 1, slice), at(ring + 1, slice + 1)];
            faces.extend([[p, r, s], [p, s, q]]);
        }
        faces.push([south, at(stacks - 1, slice + 1), at(stacks - 1, slice)]);
    }
    (vertices, faces)
}
