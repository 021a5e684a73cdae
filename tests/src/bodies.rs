//! The objects and tools of the rigid-contact campaigns: sizes in metres, tools along +x from the handle.

use glam::{DQuat, DVec3};
use pliant_mesh::{ConvexMesh, generate};
use pliant_sim::{Method, Object, Tool, VirtualCoupling, World, WorldDescription};
use pliant_spatial::Pose;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Length of every tool [m].
pub const TOOL_LENGTH: f64 = 0.1;

/// A world one campaign runs in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// 100 × 100 × 50 mm box.
    Box,
    /// 100 × 100 × 1 mm plate.
    Plate,
    /// Hull of 30 random points on a sphere of 50 mm.
    Hull,
    /// Latitude-longitude ellipsoid 60/50/40 mm, 96 × 67: 12,672 faces, coplanar pairs everywhere.
    LatitudeLongitude,
    /// Hull of 6,338 spiral points on the same ellipsoid: 12,672 faces, strictly convex.
    Fibonacci,
    /// Floor and wall.
    Corner,
    /// Two blocks 8 mm apart.
    Slot,
}

impl Setting {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Box,
        Self::Plate,
        Self::Hull,
        Self::LatitudeLongitude,
        Self::Fibonacci,
        Self::Corner,
        Self::Slot,
    ];

    /// One convex object only.
    pub fn is_single(self) -> bool {
        !matches!(self, Self::Corner | Self::Slot)
    }

    /// The objects, centred about the origin, top faces towards +z.
    ///
    /// # Panics
    /// When a generator refuses one of the sizes written here.
    pub fn objects(self) -> Vec<Object> {
        let block = |name: &str, half: DVec3, centre: DVec3| {
            object(
                name,
                convex(&generate::cuboid(half).expect("positive size")),
                centre,
            )
        };
        match self {
            Self::Box => vec![block("box", DVec3::new(0.05, 0.05, 0.025), DVec3::ZERO)],
            Self::Plate => vec![block("plate", DVec3::new(0.05, 0.05, 0.0005), DVec3::ZERO)],
            Self::Hull => vec![object("hull", random_hull(), DVec3::ZERO)],
            Self::LatitudeLongitude => {
                vec![object("ellipsoid", latitude_longitude(96, 67), DVec3::ZERO)]
            }
            Self::Fibonacci => {
                let mesh = generate::fibonacci_ellipsoid(RADII, 6338).expect("positive size");
                vec![object("ellipsoid", convex(&mesh), DVec3::ZERO)]
            }
            Self::Corner => vec![
                block(
                    "floor",
                    DVec3::new(0.1, 0.1, 0.01),
                    DVec3::new(0.0, 0.0, -0.01),
                ),
                block(
                    "wall",
                    DVec3::new(0.01, 0.1, 0.05),
                    DVec3::new(-0.06, 0.0, 0.05),
                ),
            ],
            Self::Slot => {
                let half = DVec3::new(0.05, 0.03, 0.03);
                let centre = DVec3::new(0.0, 0.034, 0.0);
                vec![block("left", half, -centre), block("right", half, centre)]
            }
        }
    }
}

const RADII: DVec3 = DVec3::new(0.06, 0.05, 0.04);

/// The latitude-longitude ellipsoid with `sectors` × `bands`.
///
/// # Panics
/// When the generator refuses the counts.
pub fn latitude_longitude(sectors: u32, bands: u32) -> ConvexMesh {
    convex(&generate::latitude_longitude_ellipsoid(RADII, sectors, bands).expect("enough sectors"))
}

fn convex(mesh: &pliant_mesh::TriangleMesh) -> ConvexMesh {
    ConvexMesh::from_triangles(mesh).expect("generators of convex bodies give convex meshes")
}

fn object(name: &str, shape: ConvexMesh, centre: DVec3) -> Object {
    Object {
        name: name.to_owned(),
        shape,
        world_from_object: Pose::from_translation(centre),
        shading_threshold: None,
    }
}

fn random_hull() -> ConvexMesh {
    let mut random = ChaCha8Rng::seed_from_u64(30);
    let mut points = Vec::with_capacity(30);
    while points.len() < 30 {
        let p = DVec3::from_array(std::array::from_fn(|_| random.random_range(-1.0..1.0)));
        if (0.1..1.0).contains(&p.length()) {
            points.push(p.normalize() * 0.05);
        }
    }
    ConvexMesh::hull(&points).expect("random points on a sphere span a hull")
}

/// A tool of the campaigns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ToolKind {
    /// Rod of 6 × 6 mm.
    Rod,
    /// Rod of 2 × 2 mm.
    ThinRod,
    /// Pin of 0.4 × 0.4 mm.
    Pin,
    /// 16-gon cone, radius 4 mm at the handle, 1 mm at the tip.
    Cone,
}

impl ToolKind {
    /// The tool cut into `segments` equal lengths.
    ///
    /// # Panics
    /// When `segments` is 0.
    pub fn tool(self, segments: u32) -> Tool {
        assert!(segments > 0, "a tool has at least one segment");
        let length = TOOL_LENGTH / f64::from(segments);
        let segments = (0..segments)
            .map(|i| {
                let start = f64::from(i) * length;
                let outline = |x: f64| {
                    self.section(x / TOOL_LENGTH)
                        .map(move |(y, z)| DVec3::new(x, y, z))
                };
                let points: Vec<DVec3> = outline(start).chain(outline(start + length)).collect();
                ConvexMesh::hull(&points).expect("a prism has volume")
            })
            .collect();
        Tool { segments }
    }

    /// Outline of the section at `part` of the length [m].
    fn section(self, part: f64) -> impl Iterator<Item = (f64, f64)> {
        let (corners, radius, phase) = match self {
            Self::Rod => (4, 3e-3 * 2f64.sqrt(), 0.5),
            Self::ThinRod => (4, 1e-3 * 2f64.sqrt(), 0.5),
            Self::Pin => (4, 0.2e-3 * 2f64.sqrt(), 0.5),
            Self::Cone => (16, 4e-3 - 3e-3 * part, 0.0),
        };
        (0..corners).map(move |i| {
            let angle = std::f64::consts::TAU * (f64::from(i) + phase) / f64::from(corners);
            (radius * angle.cos(), radius * angle.sin())
        })
    }
}

/// A world of one setting and one tool, k = 1000 N/m, orientation follows.
///
/// # Panics
/// When the description is refused.
pub fn world(setting: Setting, tool: Tool, method: Method) -> World {
    World::new(WorldDescription {
        tool,
        objects: setting.objects(),
        coupling: VirtualCoupling::default(),
        method,
    })
    .expect("campaign worlds are valid")
}

/// Handle pose that puts the tool's tip at `tip` with its axis along `axis`.
pub fn handle_with_tip(tip: DVec3, axis: DVec3) -> Pose {
    let axis = axis.normalize();
    Pose::new(
        DQuat::from_rotation_arc(DVec3::X, axis),
        tip - axis * TOOL_LENGTH,
    )
}
