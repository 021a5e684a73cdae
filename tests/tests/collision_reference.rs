//! Judges `closest_points` by the 333 reference pairs of `reference/collision-open.json`: touching, parallel, coincident,
//! needle-shaped, flat, 1e-6 m and 1e4 m wide, each with an exhaustively computed signed distance.

use std::collections::BTreeMap;

use glam::{DMat3, DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, Point, PointSet, Segment, SimplexCache, SupportMap, SupportPoint,
    closest_points,
};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;
use serde::Deserialize;

#[derive(Deserialize)]
struct Reference {
    shapes: Vec<ShapeSpec>,
    pairs: Vec<Pair>,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum ShapeSpec {
    Box {
        half: [f64; 3],
    },
    Capsule {
        radius: f64,
        half_length: f64,
    },
    Hull {
        vertices: Vec<[f64; 3]>,
        faces: Vec<[u32; 3]>,
    },
    Latlong {
        slices: u32,
        stacks: u32,
        radii: [f64; 3],
    },
}

#[derive(Deserialize)]
struct Pair {
    id: u32,
    family: String,
    a: usize,
    b: usize,
    ra: [f64; 9],
    ta: [f64; 3],
    rb: [f64; 9],
    tb: [f64; 3],
    signed_distance: f64,
    normal: Option<[f64; 3]>,
    tol: f64,
    normal_tol_rad: f64,
}

/// A reference shape, with the triangles that bound it where it has any.
struct Solid {
    core: Core,
    radius: f64,
    faces: Vec<[DVec3; 3]>,
}

enum Core {
    Cuboid(Cuboid),
    Segment(Segment),
    Mesh(Box<ConvexMesh>),
    Points(Vec<DVec3>),
}

impl SupportMap for Solid {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        match &self.core {
            Core::Cuboid(core) => core.support(direction, start),
            Core::Segment(core) => core.support(direction, start),
            Core::Mesh(core) => core.support(direction, start),
            Core::Points(points) => PointSet(points).support(direction, start),
        }
    }

    fn vertex(&self, index: u32) -> DVec3 {
        match &self.core {
            Core::Cuboid(core) => core.vertex(index),
            Core::Segment(core) => core.vertex(index),
            Core::Mesh(core) => core.vertex(index),
            Core::Points(points) => PointSet(points).vertex(index),
        }
    }

    fn radius(&self) -> f64 {
        self.radius
    }

    fn interior_point(&self) -> DVec3 {
        match &self.core {
            Core::Cuboid(core) => core.interior_point(),
            Core::Segment(core) => core.interior_point(),
            Core::Mesh(core) => core.interior_point(),
            Core::Points(points) => PointSet(points).interior_point(),
        }
    }
}

fn latitude_longitude(slices: u32, stacks: u32, radii: DVec3) -> (Vec<DVec3>, Vec<[u32; 3]>) {
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

/// A hull as a mesh to climb on, or as bare points where it is flat, which no convex mesh is, or on request.
fn hull(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>, form: Form) -> Solid {
    let corners = faces
        .iter()
        .map(|face| face.map(|index| vertices[index as usize]))
        .collect();
    let mesh = TriangleMesh::new(vertices.clone(), faces)
        .ok()
        .and_then(|mesh| ConvexMesh::from_triangles(&mesh).ok());
    let core = match (mesh, form) {
        (Some(mesh), Form::Meshes) => Core::Mesh(Box::new(mesh)),
        _ => Core::Points(vertices),
    };
    Solid {
        core,
        radius: 0.0,
        faces: corners,
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Form {
    Meshes,
    Points,
}

fn solid(spec: &ShapeSpec, form: Form) -> Solid {
    match spec {
        ShapeSpec::Box { half } => Solid {
            core: Core::Cuboid(Cuboid {
                half: DVec3::from(*half),
            }),
            radius: 0.0,
            faces: Vec::new(),
        },
        ShapeSpec::Capsule {
            radius,
            half_length,
        } => Solid {
            core: Core::Segment(Segment {
                a: DVec3::NEG_Z * *half_length,
                b: DVec3::Z * *half_length,
            }),
            radius: *radius,
            faces: Vec::new(),
        },
        ShapeSpec::Hull { vertices, faces } => {
            let vertices = vertices.iter().copied().map(DVec3::from).collect();
            hull(vertices, faces.clone(), form)
        }
        ShapeSpec::Latlong {
            slices,
            stacks,
            radii,
        } => {
            let (vertices, faces) = latitude_longitude(*slices, *stacks, DVec3::from(*radii));
            hull(vertices, faces, form)
        }
    }
}

fn pose(rotation_rows: &[f64; 9], translation: [f64; 3]) -> Pose {
    let rotation = DMat3::from_cols_array(rotation_rows).transpose();
    Pose::new(
        DQuat::from_mat3(&rotation).normalize(),
        DVec3::from(translation),
    )
}

/// How far a point of the shape's frame lies outside it [m]: by the planes of its triangles, and for what they leave open
/// (the rim of a flat shape, boxes, capsules) by the distance query on a single point.
fn outside_by(shape: &Solid, point: DVec3) -> f64 {
    let mut outside: f64 = 0.0;
    for [p, q, r] in &shape.faces {
        let normal = (q - p).cross(r - p).normalize_or_zero();
        outside = outside.max(normal.dot(point - p));
    }
    let found = closest_points(
        shape,
        &Point(DVec3::ZERO),
        &Pose::from_translation(point),
        &mut SimplexCache::default(),
    );
    outside.max(found.separation)
}

/// Every way in which an answer misses the reference.
fn faults(
    pair: &Pair,
    a: &Solid,
    b: &Solid,
    world_from_a: &Pose,
    found: &ClosestPoints,
) -> Vec<String> {
    let mut faults = Vec::new();
    let a_from_b = world_from_a.inverse() * pose(&pair.rb, pair.tb);
    let error = (found.separation - pair.signed_distance).abs();
    if error.is_nan() || error > pair.tol {
        faults.push(format!("separation {} off by {error:e}", found.separation));
    }
    if (found.normal.length() - 1.0).abs() > 1e-12 {
        faults.push(format!("normal of length {}", found.normal.length()));
    }
    if let Some(normal) = pair.normal {
        let normal = DVec3::from(normal);
        let own = world_from_a.transform_vector(found.normal);
        let angle = own.cross(normal).length().atan2(own.dot(normal));
        if angle.is_nan() || angle > pair.normal_tol_rad {
            faults.push(format!("normal {own} off by {angle:e} rad"));
        }
    }
    let span = (found.witness_b - found.witness_a).length();
    if ((span - found.separation.abs()).abs() > pair.tol) || span.is_nan() {
        faults.push(format!(
            "witnesses {span:e} apart, not {:e}",
            found.separation
        ));
    }
    let out_a = outside_by(a, found.witness_a);
    let out_b = outside_by(b, a_from_b.inverse_transform_point(found.witness_b));
    if out_a.max(out_b) > pair.tol {
        faults.push(format!("witnesses outside by {out_a:e}, {out_b:e}"));
    }
    faults
}

fn judge(form: Form) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/reference/collision-open.json");
    let text = std::fs::read_to_string(path).expect("the reference file is part of the project");
    let reference: Reference = serde_json::from_str(&text).expect("the format is known");
    assert_eq!(reference.pairs.len(), 333);
    let solids: Vec<Solid> = reference
        .shapes
        .iter()
        .map(|spec| solid(spec, form))
        .collect();
    let meshes = solids
        .iter()
        .filter(|solid| matches!(solid.core, Core::Mesh(_)));
    assert_eq!(meshes.count() > 10, form == Form::Meshes);
    let mut failures: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for pair in &reference.pairs {
        let (a, b) = (&solids[pair.a], &solids[pair.b]);
        let world_from_a = pose(&pair.ra, pair.ta);
        let a_from_b = world_from_a.inverse() * pose(&pair.rb, pair.tb);
        let mut cache = SimplexCache::default();
        for start in ["cold", "warm"] {
            let found = closest_points(a, b, &a_from_b, &mut cache);
            for fault in faults(pair, a, b, &world_from_a, &found) {
                let line = format!("pair {} {start}: {fault}", pair.id);
                failures.entry(&pair.family).or_default().push(line);
            }
        }
    }
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn all_reference_pairs_pass_on_convex_meshes() {
    judge(Form::Meshes);
}

#[test]
fn all_reference_pairs_pass_on_bare_points() {
    judge(Form::Points);
}
