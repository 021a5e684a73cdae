//! A tapered prism against triangle meshes, 0.5 % of its length deep: every triangle touched, beside the deepest contact by
//! `parry3d-f64`, which has no cheaper way to all of them.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::contact;
use parry3d_f64::shape::{ConvexPolyhedron, TriMesh};
use pliant_collision::{MeshCache, SupportMap, TriangleBvh};
use pliant_mesh::{ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::clock::{Clock, Times};
use super::duel::{Mode, parry_mesh, parry_pose, parry_vector};
use super::placements::STEPS;
use super::report::Row;
use crate::collision::families::rotation;
use crate::collision::kinds::unit;
use crate::collision::reference::latitude_longitude;

/// Length of the tool [m], against meshes of about 1 m.
const SIZE: f64 = 0.2;

/// Of the deepest triangle [m].
const DEPTH: f64 = 0.005 * SIZE;

/// Random placements of a row.
const PLACEMENTS: usize = 300;

/// Coherent sequences of a row.
const SEQUENCES: usize = 5;

/// What is asked for on the Xeon [ns]: medians, cold and coherent, and the 99th percentile of the cold ones.
struct Targets {
    cold: f64,
    coherent: f64,
    p99: Option<f64>,
}

struct Bench {
    mesh: TriangleMesh,
    bvh: TriangleBvh,
    tool: ConvexMesh,
    parry_mesh: TriMesh,
    parry_tool: ConvexPolyhedron,
}

/// Measures all rows; `each` sees them as they come.
pub fn run(each: &mut impl FnMut(&Row)) -> Vec<Row> {
    let fine = Targets {
        cold: 150e3,
        coherent: 20e3,
        p99: Some(1e6),
    };
    let coarse = Targets {
        cold: 10e3,
        coherent: 5e3,
        p99: None,
    };
    let mut rows = Vec::new();
    for (mesh, targets) in [(ellipsoid(), coarse), (bumpy(), fine)] {
        let bench = Bench::new(mesh);
        for mode in [Mode::Cold, Mode::Coherent] {
            let row = bench.row(mode, &targets);
            each(&row);
            rows.push(row);
        }
    }
    rows
}

impl Bench {
    fn new(mesh: TriangleMesh) -> Self {
        let tool = ConvexMesh::hull(&prism()).expect("a prism has volume");
        let vertices = mesh.positions().iter().copied().map(parry_vector).collect();
        Self {
            bvh: TriangleBvh::new(&mesh),
            parry_tool: parry_mesh(&tool),
            parry_mesh: TriMesh::new(vertices, mesh.triangles().to_vec()).expect("a valid mesh"),
            mesh,
            tool,
        }
    }

    fn row(&self, mode: Mode, targets: &Targets) -> Row {
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let clock = Clock::new();
        let (own, parry) = match mode {
            Mode::Cold => {
                let poses: Vec<Pose> = (0..PLACEMENTS)
                    .map(|_| self.over_any(&mut random))
                    .collect();
                (self.own_cold(&poses, &clock), self.parry(&poses, &clock))
            }
            Mode::Coherent => {
                let (mut own, mut parry) = (Vec::new(), Vec::new());
                for _ in 0..SEQUENCES {
                    let poses = self.slide(&mut random);
                    own.extend(self.own_coherent(&poses, &clock).into_iter().skip(1));
                    parry.extend(self.parry(&poses, &clock).into_iter().skip(1));
                }
                (own, parry)
            }
        };
        let target = match mode {
            Mode::Cold => targets.cold,
            Mode::Coherent => targets.coherent,
        };
        Row {
            bodies: format!("PrismMesh{}", self.mesh.triangles().len()),
            state: format!("Deep({})", DEPTH / SIZE),
            mode: format!("{mode:?}"),
            queries: own.len(),
            own: Times::of(own).expect("queries were timed"),
            parry: Times::of(parry),
            parry_listed: None,
            target: Some(target),
            p99_target: targets.p99.filter(|_| mode == Mode::Cold),
            target_today: None,
            met: None,
        }
    }

    /// With a cache that knows nothing, its buffers kept.
    fn own_cold(&self, poses: &[Pose], clock: &Clock) -> Vec<u64> {
        clock.times(poses.len(), MeshCache::default, |cache, i| {
            cache.clear();
            self.count(&poses[i], cache)
        })
    }

    fn own_coherent(&self, poses: &[Pose], clock: &Clock) -> Vec<u64> {
        clock.times(poses.len(), MeshCache::default, |cache, i| {
            self.count(&poses[i], cache)
        })
    }

    fn count(&self, pose: &Pose, cache: &mut MeshCache) -> usize {
        let found = self
            .bvh
            .every_contact(&self.mesh, &self.tool, pose, 0.0, cache);
        found.len()
    }

    fn parry(&self, poses: &[Pose], clock: &Clock) -> Vec<u64> {
        let poses: Vec<ParryPose> = poses.iter().map(parry_pose).collect();
        let (mesh, tool) = (&self.parry_mesh, &self.parry_tool);
        clock.times(
            poses.len(),
            || (),
            |(), i| contact(&ParryPose::IDENTITY, mesh, &poses[i], tool, 0.0),
        )
    }

    /// The tool's lowest point over the middle of a random face, [`DEPTH`] below its plane.
    fn over_any(&self, random: &mut ChaCha8Rng) -> Pose {
        let faces = self.mesh.triangles();
        let face = faces[random.random_range(0..faces.len())];
        let [p, q, r] = face.map(|corner| self.mesh.positions()[corner as usize]);
        let normal = (q - p).cross(r - p).normalize();
        let turn = rotation(random);
        let lowest = self.tool.support(-(turn.conjugate() * normal), 0).point;
        Pose::new(turn, (p + q + r) / 3.0 - normal * DEPTH - turn * lowest)
    }

    /// 0.1 % of the size sideways and 0.1° a step, then back to the same depth along the deepest triangle's normal.
    fn slide(&self, random: &mut ChaCha8Rng) -> Vec<Pose> {
        let mut placing = MeshCache::default();
        let mut pose = self.over_any(random);
        let axis = unit(random);
        let mut poses = Vec::with_capacity(STEPS);
        while poses.len() < STEPS {
            let found = self
                .bvh
                .deepest(&self.mesh, &self.tool, &pose, 1.0, &mut placing)
                .expect("within a metre");
            let normal = found.closest.normal;
            pose.translation -= normal * (found.closest.separation + DEPTH);
            poses.push(pose);
            let sideways = normal.cross(axis).normalize_or(DVec3::X);
            pose.translation += sideways * (1e-3 * SIZE);
            let turn = DQuat::from_axis_angle(axis, 0.1_f64.to_radians());
            pose.rotation = (turn * pose.rotation).normalize();
        }
        poses
    }
}

/// 8 vertices, tapered along x.
fn prism() -> Vec<DVec3> {
    let mut points = Vec::new();
    for (x, half) in [(-0.5, 0.02), (0.5, 0.008)] {
        for (y, z) in [(-1.0, -0.6), (1.0, -0.6), (-1.0, 0.6), (1.0, 0.6)] {
            points.push(DVec3::new(x * SIZE, y * half, z * half));
        }
    }
    points
}

/// 12,672 triangles.
fn ellipsoid() -> TriangleMesh {
    let (vertices, triangles) = latitude_longitude(64, 100, DVec3::new(0.5, 0.4, 0.3));
    TriangleMesh::new(vertices, triangles).expect("a valid mesh")
}

/// 998,000 triangles on a sphere whose radius swells and shrinks.
fn bumpy() -> TriangleMesh {
    let (vertices, triangles) = latitude_longitude(1000, 500, DVec3::ONE);
    let swollen = vertices.into_iter().map(|direction| {
        let longitude = direction.y.atan2(direction.x);
        let latitude = direction.z.clamp(-1.0, 1.0).acos();
        let fade = (latitude / PI * (1.0 - latitude / PI) * 4.0).clamp(0.0, 1.0);
        let swell = (9.0 * longitude).sin() * (7.0 * latitude).sin();
        let ripple = (41.0 * longitude).cos() * (37.0 * latitude).sin();
        direction * 0.5 * (1.0 + fade * (0.03 * swell + 0.004 * ripple))
    });
    TriangleMesh::new(swollen.collect(), triangles).expect("a valid mesh")
}
