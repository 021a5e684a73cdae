//! Random shapes of every kind, and what is done to them: stretched, flattened, moved far from their origin, doubled.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use pliant_collision::{Cone, Cylinder};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use rand::Rng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;

use super::core::Core;
use super::reference::latitude_longitude;
use super::shape::{Body, Shape};

/// A kind of shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// A point.
    Point,
    /// A point with a radius.
    Sphere,
    /// A segment.
    Segment,
    /// A segment with a radius.
    Capsule,
    /// A triangle.
    Triangle,
    /// A plane quadrilateral as points.
    Quad,
    /// A box.
    Cuboid,
    /// A box with a radius.
    RoundedCuboid,
    /// A tapered prism of 8 vertices.
    Prism,
    /// Hull of 8 points on a sphere.
    Hull8,
    /// Of 16.
    Hull16,
    /// Of 32.
    Hull32,
    /// Of 64.
    Hull64,
    /// 12 points on a sphere and 6 inside.
    PointSet,
    /// The latitude-longitude ellipsoid of 12,672 faces.
    Ellipsoid,
    /// A cylinder.
    Cylinder,
    /// A cone, pointed or truncated.
    Cone,
}

/// What is done to a shape of about unit size, in this order.
#[derive(Clone, Copy, Debug)]
pub struct Form {
    /// Factors along the axes; 0 flattens.
    pub stretch: DVec3,
    /// Factor of everything.
    pub scale: f64,
    /// Of the shape from its frame's origin [m], for shapes made of vertices.
    pub offset: DVec3,
    /// How often each vertex appears.
    pub copies: Copies,
}

/// How often each vertex appears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Copies {
    /// Once.
    One,
    /// Twice, shuffled; the body is a set of points then.
    Two,
}

impl Form {
    /// Nothing is done.
    pub const PLAIN: Self = Self {
        stretch: DVec3::ONE,
        scale: 1.0,
        offset: DVec3::ZERO,
        copies: Copies::One,
    };

    /// A factor along the axes only.
    pub fn stretched(stretch: DVec3) -> Self {
        Self {
            stretch,
            ..Self::PLAIN
        }
    }

    /// A factor of everything only.
    pub fn scaled(scale: f64) -> Self {
        Self {
            scale,
            ..Self::PLAIN
        }
    }

    fn is_flat(&self) -> bool {
        self.stretch.min_element() == 0.0
    }

    fn point(&self, point: DVec3) -> DVec3 {
        point * self.stretch * self.scale + self.offset
    }

    fn radius(&self, radius: f64) -> f64 {
        let narrowest = self.stretch.min_element();
        radius * self.scale * if narrowest > 0.0 { narrowest } else { 1.0 }
    }
}

impl Kind {
    /// All that cost the oracle microseconds; the ellipsoid costs milliseconds.
    pub const SMALL: [Self; 14] = [
        Self::Point,
        Self::Sphere,
        Self::Segment,
        Self::Capsule,
        Self::Triangle,
        Self::Quad,
        Self::Cuboid,
        Self::RoundedCuboid,
        Self::Prism,
        Self::Hull8,
        Self::Hull16,
        Self::Hull32,
        Self::Hull64,
        Self::PointSet,
    ];

    /// Whether it is no polytope.
    pub fn is_turned(self) -> bool {
        matches!(self, Self::Cylinder | Self::Cone)
    }

    /// A random shape of this kind.
    pub fn shape(self, form: &Form, random: &mut ChaCha8Rng) -> Arc<Shape> {
        let mut length = |low: f64, high: f64| random.random_range(low..high);
        let simple = |body, radius| Arc::new(Shape::new(body, form.radius(radius)));
        match self {
            Self::Ellipsoid => ellipsoid(),
            Self::Sphere => {
                let radius = length(0.1, 0.6);
                simple(Body::Point(form.offset), radius)
            }
            Self::Point => simple(Body::Point(form.offset), 0.0),
            Self::Cuboid | Self::RoundedCuboid if form.copies == Copies::One => {
                let half = DVec3::new(length(0.2, 0.6), length(0.2, 0.6), length(0.2, 0.6));
                let radius = if self == Self::Cuboid {
                    0.0
                } else {
                    length(0.02, 0.3)
                };
                simple(Body::Cuboid(half * form.stretch * form.scale), radius)
            }
            Self::Cylinder | Self::Cone => simple(self.turned(form, random), 0.0),
            Self::Segment | Self::Capsule => {
                let radius = if self == Self::Segment {
                    0.0
                } else {
                    length(0.05, 0.4)
                };
                let half = unit(random) * random.random_range(0.1..0.6);
                let ends = [-half, half].map(|end| form.point(end));
                simple(Body::Segment(ends), radius)
            }
            Self::Triangle => {
                let corners = std::array::from_fn(|_| form.point(unit(random) * 0.5));
                simple(Body::Triangle(corners), 0.0)
            }
            other => Arc::new(other.polytope(form, random)),
        }
    }

    /// A cylinder, or a cone of which half have an apex.
    fn turned(self, form: &Form, random: &mut ChaCha8Rng) -> Body {
        let mut length = |low: f64, high: f64| random.random_range(low..high);
        let radius = length(0.1, 0.5) * form.stretch.x * form.scale;
        let half_length = length(0.1, 0.6) * form.stretch.z * form.scale;
        if self == Self::Cylinder {
            return Body::Cylinder(Cylinder {
                half_length,
                radius,
            });
        }
        Body::Cone(Cone {
            half_length,
            base_radius: radius,
            top_radius: radius * length(-1.0, 1.0).max(0.0),
        })
    }

    fn polytope(self, form: &Form, random: &mut ChaCha8Rng) -> Shape {
        let mut points = self.points(form, random);
        let radius = match self {
            Self::RoundedCuboid => form.radius(random.random_range(0.02..0.3)),
            _ => 0.0,
        };
        // In order around the outline: what a flat core is made of.
        let flat = (form.is_flat() && self.is_hull()) || self == Self::Quad;
        let core = flat.then(|| Core::polygon(&points));
        if form.copies == Copies::Two {
            points.extend(points.clone());
            points.shuffle(random);
        }
        let mesh = (self.is_hull() && !flat && form.copies == Copies::One)
            .then(|| hull_at(&points, form.offset))
            .flatten();
        let body = mesh.map_or(Body::Points(points), |mesh| Body::Mesh(Box::new(mesh)));
        match core {
            Some(core) => Shape { body, radius, core },
            None => Shape::new(body, radius),
        }
    }

    fn is_hull(self) -> bool {
        matches!(
            self,
            Self::Prism | Self::Hull8 | Self::Hull16 | Self::Hull32 | Self::Hull64
        )
    }

    fn points(self, form: &Form, random: &mut ChaCha8Rng) -> Vec<DVec3> {
        let count = match self {
            Self::Hull16 => 16,
            Self::Hull32 => 32,
            Self::Hull64 => 64,
            _ => 8,
        };
        let points: Vec<DVec3> = match self {
            Self::Quad => outline(4, random),
            _ if form.is_flat() && self.is_hull() => outline(count, random),
            Self::Cuboid | Self::RoundedCuboid => Body::Cuboid(DVec3::new(0.5, 0.3, 0.4)).points(),
            Self::Prism => prism(random.random_range(0.4..0.9)),
            Self::PointSet => (0..18)
                .map(|i| unit(random) * if i % 3 == 1 { 0.2 } else { 0.5 })
                .collect(),
            _ => (0..count).map(|_| unit(random) * 0.5).collect(),
        };
        points.into_iter().map(|p| form.point(p)).collect()
    }
}

/// The hull of points made about the origin and moved: what a user's far vertices are.
fn hull_at(points: &[DVec3], offset: DVec3) -> Option<ConvexMesh> {
    let centred: Vec<DVec3> = points.iter().map(|&p| p - offset).collect();
    let hull = ConvexMesh::hull(&centred).ok()?;
    if offset == DVec3::ZERO {
        return Some(hull);
    }
    let mesh = hull.topology().to_triangle_mesh();
    let moved = mesh.positions().iter().map(|&p| p + offset).collect();
    let mesh = TriangleMesh::new(moved, mesh.triangles().to_vec()).ok()?;
    ConvexMesh::from_triangles(&mesh).ok()
}

/// 8 vertices: a square of 0.5 that tapers to a rectangle of 0.3 × 0.2 at the other end, along z.
pub fn prism(length: f64) -> Vec<DVec3> {
    let end = |half: [f64; 2], z: f64| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| DVec3::new(x * half[0], y * half[1], z))
    };
    let ends = [
        end([0.25, 0.25], -0.5 * length),
        end([0.15, 0.1], 0.5 * length),
    ];
    ends.concat()
}

/// A convex polygon in the plane z = 0, in order.
fn outline(count: usize, random: &mut ChaCha8Rng) -> Vec<DVec3> {
    let part = std::f64::consts::TAU / count as f64;
    (0..count)
        .map(|i| {
            let (sine, cosine) = (part * (i as f64 + random.random_range(0.0..0.8))).sin_cos();
            DVec3::new(0.5 * cosine, 0.4 * sine, 0.0)
        })
        .collect()
}

/// The ellipsoid of 64 slices and 100 stacks, made once.
///
/// # Panics
/// When it is not convex, which it is.
pub fn ellipsoid() -> Arc<Shape> {
    static SHAPE: OnceLock<Arc<Shape>> = OnceLock::new();
    let make = || {
        let (vertices, triangles) = latitude_longitude(64, 100, DVec3::new(0.6, 0.5, 0.4));
        let mesh = TriangleMesh::new(vertices, triangles).expect("valid");
        let mesh = ConvexMesh::from_triangles(&mesh).expect("an ellipsoid is convex");
        Arc::new(Shape::new(Body::Mesh(Box::new(mesh)), 0.0))
    };
    SHAPE.get_or_init(make).clone()
}

/// A direction, all equally likely.
pub fn unit(random: &mut ChaCha8Rng) -> DVec3 {
    loop {
        let p = DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
        if (0.01..1.0).contains(&p.length_squared()) {
            return p.normalize();
        }
    }
}
