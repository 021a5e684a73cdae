//! A shape twice: as the collision crate takes it, and as the oracle sees it.

use glam::DVec3;
use pliant_collision::{
    Cone, Cuboid, Cylinder, Point, PointSet, Rounded, Segment, SupportMap, Triangle,
};
use pliant_mesh::{ConvexMesh, TriangleMesh};

use super::core::Core;
use super::round::{Turned, height_of};

/// A core in the crate's own type, so that judges run the code that users run.
#[derive(Clone, Debug)]
pub enum Body {
    /// A point.
    Point(DVec3),
    /// A segment.
    Segment([DVec3; 2]),
    /// A triangle.
    Triangle([DVec3; 3]),
    /// A box by its half lengths [m].
    Cuboid(DVec3),
    /// A cylinder.
    Cylinder(Cylinder),
    /// A cone.
    Cone(Cone),
    /// Points in any order.
    Points(Vec<DVec3>),
    /// A mesh to climb on.
    Mesh(Box<ConvexMesh>),
}

/// A body with a rounding radius, and its polytope.
#[derive(Clone, Debug)]
pub struct Shape {
    /// For the crate.
    pub body: Body,
    /// Around it [m].
    pub radius: f64,
    /// For the oracle; of a cylinder or cone only a polytope inside it, to place it by.
    pub core: Core,
}

impl Shape {
    /// A body whose core is worked out from its points.
    ///
    /// # Panics
    /// When the body has no points.
    pub fn new(body: Body, radius: f64) -> Self {
        let core = match &body {
            Body::Mesh(mesh) => Core::from_mesh(mesh),
            other => Core::of_points(&other.points()),
        };
        Self { body, radius, core }
    }

    /// Hands the shape to `f` as the crate takes it.
    pub fn with<R>(&self, f: impl FnOnce(&dyn SupportMap) -> R) -> R {
        let radius = self.radius;
        if radius == 0.0 {
            return match &self.body {
                Body::Point(p) => f(&Point(*p)),
                Body::Segment([a, b]) => f(&Segment { a: *a, b: *b }),
                Body::Triangle(corners) => f(&Triangle(*corners)),
                Body::Cuboid(half) => f(&Cuboid { half: *half }),
                Body::Cylinder(cylinder) => f(cylinder),
                Body::Cone(cone) => f(cone),
                Body::Points(points) => f(&PointSet(points)),
                Body::Mesh(mesh) => f(mesh.as_ref()),
            };
        }
        match &self.body {
            Body::Point(p) => f(&rounded(Point(*p), radius)),
            Body::Segment([a, b]) => f(&rounded(Segment { a: *a, b: *b }, radius)),
            Body::Triangle(corners) => f(&rounded(Triangle(*corners), radius)),
            Body::Cuboid(half) => f(&rounded(Cuboid { half: *half }, radius)),
            Body::Cylinder(cylinder) => f(&rounded(*cylinder, radius)),
            Body::Cone(cone) => f(&rounded(*cone, radius)),
            Body::Points(points) => f(&rounded(PointSet(points), radius)),
            Body::Mesh(mesh) => f(&rounded(mesh.as_ref(), radius)),
        }
    }

    /// Height of the rounded shape over `origin` along a unit direction [m].
    pub fn height(&self, origin: DVec3, direction: DVec3) -> f64 {
        let core = match self.body.turned() {
            Some(body) => body.height(direction) - origin.dot(direction),
            None => height_of(&self.core, origin, direction),
        };
        core + self.radius
    }

    /// Diameter of the box around it, roughly [m]: what tolerances are relative to.
    pub fn size(&self) -> f64 {
        let points = &self.core.vertices;
        let low = points.iter().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let high = points.iter().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        (high - low).max_element() + 2.0 * self.radius
    }
}

impl Body {
    /// The body as a solid of revolution, if it is one.
    pub fn turned(&self) -> Option<Turned> {
        match self {
            Self::Cylinder(cylinder) => Some(Turned::from(*cylinder)),
            Self::Cone(cone) => Some(Turned::from(*cone)),
            _ => None,
        }
    }

    /// Its vertices, or some of them.
    pub fn points(&self) -> Vec<DVec3> {
        match self {
            Self::Point(p) => vec![*p],
            Self::Segment(ends) => ends.to_vec(),
            Self::Triangle(corners) => corners.to_vec(),
            Self::Cuboid(half) => (0..8)
                .map(|corner: u32| {
                    let sign = |bit: u32| if corner & bit == 0 { -1.0 } else { 1.0 };
                    *half * DVec3::new(sign(1), sign(2), sign(4))
                })
                .collect(),
            Self::Cylinder(cylinder) => Turned::from(*cylinder).points(),
            Self::Cone(cone) => Turned::from(*cone).points(),
            Self::Points(points) => points.clone(),
            Self::Mesh(mesh) => mesh.positions().to_vec(),
        }
    }
}

/// A hull given by vertices and triangles: a mesh to climb on where it is one, else its bare points, which any vertices are.
pub fn hull(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> Shape {
    let core = if triangles.is_empty() {
        Core::of_points(&vertices)
    } else {
        Core::from_triangles(&vertices, &triangles)
    };
    let mesh = TriangleMesh::new(vertices.clone(), triangles)
        .ok()
        .and_then(|mesh| ConvexMesh::from_triangles(&mesh).ok());
    let body = match mesh {
        Some(mesh) => Body::Mesh(Box::new(mesh)),
        None => Body::Points(vertices),
    };
    Shape {
        body,
        radius: 0.0,
        core,
    }
}

fn rounded<S>(core: S, radius: f64) -> Rounded<S> {
    Rounded { core, radius }
}
