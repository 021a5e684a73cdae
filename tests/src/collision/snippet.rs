//! A failing pair as Rust that makes it again, to the bit.

use std::fmt::Write;

use glam::DVec3;
use pliant_spatial::Pose;

use super::families::Pair;
use super::shape::{Body, Shape};

/// Largest mesh that is written out.
const VERTEX_LIMIT: usize = 200;

/// Shapes `a`, `b` and the placements of B in A's frame, the last of which failed.
pub fn snippet(pair: &Pair, poses: &[Pose]) -> String {
    let mut text = String::from(
        "let f = f64::from_bits;\nlet v = |x: u64, y: u64, z: u64| DVec3::new(f(x), f(y), f(z));\n",
    );
    for (name, shape) in ["a", "b"].into_iter().zip(&pair.shapes) {
        let _ = writeln!(text, "let {name} = {};", rounded(shape));
    }
    text.push_str("let poses = [\n");
    for pose in poses {
        let q = pose.rotation;
        let _ = writeln!(
            text,
            "    Pose::new(DQuat::from_xyzw({}, {}, {}, {}), {}),",
            number(q.x),
            number(q.y),
            number(q.z),
            number(q.w),
            vector(pose.translation)
        );
    }
    text.push_str("];");
    text
}

fn rounded(shape: &Shape) -> String {
    let core = body(&shape.body);
    if shape.radius == 0.0 {
        return core;
    }
    let radius = number(shape.radius);
    format!("Rounded {{ core: {core}, radius: {radius} }}")
}

fn body(body: &Body) -> String {
    match body {
        Body::Point(p) => format!("Point({})", vector(*p)),
        Body::Segment([a, b]) => format!("Segment {{ a: {}, b: {} }}", vector(*a), vector(*b)),
        Body::Triangle(corners) => format!("Triangle({})", vectors(corners)),
        Body::Cuboid(half) => format!("Cuboid {{ half: {} }}", vector(*half)),
        Body::Cylinder(cylinder) => format!(
            "Cylinder {{ half_length: {}, radius: {} }}",
            number(cylinder.half_length),
            number(cylinder.radius)
        ),
        Body::Cone(cone) => format!(
            "Cone {{ half_length: {}, base_radius: {}, top_radius: {} }}",
            number(cone.half_length),
            number(cone.base_radius),
            number(cone.top_radius)
        ),
        Body::Points(points) => format!("PointSet(&{})", vectors(points)),
        Body::Mesh(mesh) if mesh.positions().len() > VERTEX_LIMIT => {
            "(the ellipsoid of the campaign)".to_owned()
        }
        Body::Mesh(mesh) => {
            let triangles = mesh.topology().to_triangle_mesh().triangles().to_vec();
            format!(
                "ConvexMesh::from_triangles(&TriangleMesh::new(vec!{}, vec!{triangles:?}).unwrap()).unwrap()",
                vectors(mesh.positions())
            )
        }
    }
}

fn vectors(points: &[DVec3]) -> String {
    let points: Vec<String> = points.iter().map(|&point| vector(point)).collect();
    format!("[{}]", points.join(", "))
}

fn vector(v: DVec3) -> String {
    let [x, y, z] = v.to_array().map(f64::to_bits);
    format!("v({x:#x}, {y:#x}, {z:#x})")
}

fn number(x: f64) -> String {
    format!("f({:#x})", x.to_bits())
}
