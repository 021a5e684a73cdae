//! The rows of the benchmark: which shapes, how deep, what is asked of them.

use glam::DVec3;
use parry3d_f64::shape::{Capsule, ConvexPolyhedron, Cuboid as ParryCuboid};
use pliant_collision::{Cuboid, Rounded, Segment};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::duel::{Duel, Mode, Sample, parry_mesh, parry_vector};
use super::placements::State;
use crate::collision::kinds::{prism, unit};
use crate::collision::reference::latitude_longitude;

/// Pairs of shapes in a row.
const PAIRS: usize = 10;

/// Random placements of each pair: 300 a row.
const PLACEMENTS: usize = 30;

/// Sequences of each pair: 990 steps a row.
const SEQUENCES: usize = 1;

/// Half axes of the ellipsoids [m].
const RADII: DVec3 = DVec3::new(0.6, 0.5, 0.4);

/// Shapes of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bodies {
    /// Two boxes.
    Boxes,
    /// A capsule and a hull of 32 points.
    CapsuleHull32,
    /// Two hulls of 64 points.
    Hulls64,
    /// A tapered prism and an ellipsoid of 12,672 faces.
    PrismEllipsoid,
    /// A capsule and that ellipsoid.
    CapsuleEllipsoid,
    /// A tapered prism and an ellipsoid of 998,000 faces.
    PrismMillion,
    /// A capsule and that ellipsoid.
    CapsuleMillion,
}

/// Ellipsoids, made once, for both libraries; the large one for this project's only.
pub struct Ellipsoids {
    small: ConvexMesh,
    small_for_parry: ConvexPolyhedron,
    large: ConvexMesh,
}

impl Ellipsoids {
    /// Makes them: the larger takes seconds.
    pub fn new() -> Self {
        let small = ellipsoid(64, 100);
        Self {
            small_for_parry: parry_mesh(&small),
            small,
            large: ellipsoid(1000, 500),
        }
    }
}

impl Default for Ellipsoids {
    fn default() -> Self {
        Self::new()
    }
}

/// An ellipsoid by latitude and longitude.
///
/// # Panics
/// When it is not convex, which it is.
pub fn ellipsoid(slices: u32, stacks: u32) -> ConvexMesh {
    let (vertices, triangles) = latitude_longitude(slices, stacks, RADII);
    let mesh = TriangleMesh::new(vertices, triangles).expect("valid");
    ConvexMesh::from_triangles(&mesh).expect("an ellipsoid is convex")
}

impl Bodies {
    /// Times of both libraries on these bodies.
    pub fn run(self, state: State, mode: Mode, ellipsoids: &Ellipsoids) -> Sample {
        let mut random = ChaCha8Rng::seed_from_u64(self as u64);
        let count = match mode {
            Mode::Cold => PLACEMENTS,
            Mode::Coherent => SEQUENCES,
        };
        let mut sample = Sample::default();
        for _ in 0..PAIRS {
            let part = self.pair(&mut random, ellipsoids, (state, mode, count));
            sample.own.extend(part.own);
            sample.parry.extend(part.parry);
        }
        sample
    }

    fn pair(
        self,
        random: &mut ChaCha8Rng,
        ellipsoids: &Ellipsoids,
        (state, mode, count): (State, Mode, usize),
    ) -> Sample {
        let large = &ellipsoids.large;
        let small = (&ellipsoids.small, &ellipsoids.small_for_parry);
        match self {
            Self::Boxes => {
                let [a, b] = [(); 2].map(|()| cuboid(random));
                let (p, q) = (parry_cuboid(&a), parry_cuboid(&b));
                duel((&a, &b), Some((&p, &q))).run(state, mode, count, random)
            }
            Self::CapsuleHull32 => {
                let (a, b) = (capsule(random), hull(32, random));
                let (p, q) = (parry_capsule(&a), parry_mesh(&b));
                duel((&a, &b), Some((&p, &q))).run(state, mode, count, random)
            }
            Self::Hulls64 => {
                let [a, b] = [(); 2].map(|()| hull(64, random));
                let (p, q) = (parry_mesh(&a), parry_mesh(&b));
                duel((&a, &b), Some((&p, &q))).run(state, mode, count, random)
            }
            Self::PrismEllipsoid => {
                let a = tapered(random);
                let p = parry_mesh(&a);
                duel((&a, small.0), Some((&p, small.1))).run(state, mode, count, random)
            }
            Self::CapsuleEllipsoid => {
                let a = capsule(random);
                let p = parry_capsule(&a);
                duel((&a, small.0), Some((&p, small.1))).run(state, mode, count, random)
            }
            Self::PrismMillion => {
                let a = tapered(random);
                alone((&a, large)).run(state, mode, count, random)
            }
            Self::CapsuleMillion => {
                let a = capsule(random);
                alone((&a, large)).run(state, mode, count, random)
            }
        }
    }
}

fn duel<'s, A, B, P, Q>(
    own: (&'s A, &'s B),
    parry: Option<(&'s P, &'s Q)>,
) -> Duel<'s, A, B, P, Q> {
    Duel { own, parry }
}

/// The other library scans all vertices of a hull: on a million faces it would take minutes to say so.
fn alone<'s, A, B>(own: (&'s A, &'s B)) -> Duel<'s, A, B, ParryCuboid, ParryCuboid> {
    Duel { own, parry: None }
}

fn cuboid(random: &mut ChaCha8Rng) -> Cuboid {
    Cuboid {
        half: DVec3::from_array(std::array::from_fn(|_| random.random_range(0.2..0.6))),
    }
}

fn capsule(random: &mut ChaCha8Rng) -> Rounded<Segment> {
    let half = DVec3::Z * random.random_range(0.2..0.5);
    Rounded {
        core: Segment { a: -half, b: half },
        radius: random.random_range(0.1..0.3),
    }
}

fn hull(count: usize, random: &mut ChaCha8Rng) -> ConvexMesh {
    let points: Vec<DVec3> = (0..count).map(|_| unit(random) * 0.5).collect();
    ConvexMesh::hull(&points).expect("points on a sphere span a hull")
}

fn tapered(random: &mut ChaCha8Rng) -> ConvexMesh {
    ConvexMesh::hull(&prism(random.random_range(0.4..0.9))).expect("a prism has volume")
}

fn parry_cuboid(cuboid: &Cuboid) -> ParryCuboid {
    ParryCuboid::new(parry_vector(cuboid.half))
}

fn parry_capsule(capsule: &Rounded<Segment>) -> Capsule {
    let Segment { a, b } = capsule.core;
    Capsule::new(parry_vector(a), parry_vector(b), capsule.radius)
}
