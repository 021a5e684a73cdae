//! A tapered prism touches triangle meshes of 12,672 and 998,000 triangles, 0.5 % of its length deep; the median and the
//! 99th percentile of the query times are printed: `cargo run --release -p pliant-collision --example mesh_contacts`.
#![expect(clippy::print_stdout, reason = "an example prints what it found")]

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::time::Instant;

use glam::{DQuat, DVec3};
use pliant_collision::{MeshCache, PointSet, Rounded, Segment, SupportMap, TriangleBvh};
use pliant_mesh::generate::latitude_longitude_ellipsoid;
use pliant_mesh::{ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;

/// Length of the tool [m].
const SIZE: f64 = 0.2;
const DEPTH: f64 = 0.005 * SIZE;
const POSES: u32 = 1000;
const SEQUENCES: u32 = 20;
const STEPS: u32 = 100;
/// Each query is timed in so many passes, of which the quickest counts: what else runs on the machine is not the topic.
const PASSES: usize = 3;

#[derive(Clone, Copy)]
enum Query {
    Minima,
    Every,
    Deepest,
}

fn main() -> Result<(), Box<dyn Error>> {
    let points = prism();
    let hull = ConvexMesh::hull(&points)?;
    let core = Segment {
        a: DVec3::X * (-0.5 * SIZE),
        b: DVec3::X * (0.5 * SIZE),
    };
    let capsule = Rounded {
        core,
        radius: 0.012,
    };
    let small = latitude_longitude_ellipsoid(DVec3::new(0.5, 0.4, 0.3), 96, 67)?;
    let large = bumpy(1000, 500)?;
    println!("median / p99 [us] of one query, 0.5 % deep; contacts: median / most");
    println!("query              cold             coherent         contacts");
    for mesh in [&small, &large] {
        let before = Instant::now();
        let bvh = TriangleBvh::new(mesh);
        let build = before.elapsed().as_secs_f64() * 1e3;
        println!(
            "{} triangles, tree built in {build:.0} ms",
            mesh.triangles().len()
        );
        let rows: [(&str, &dyn SupportMap, Query); 5] = [
            ("hull, minima", &hull, Query::Minima),
            ("hull, every", &hull, Query::Every),
            ("hull, deepest", &hull, Query::Deepest),
            ("points, minima", &PointSet(&points), Query::Minima),
            ("capsule, minima", &capsule, Query::Minima),
        ];
        for (name, tool, query) in rows {
            let bench = Bench {
                mesh,
                bvh: &bvh,
                tool,
                query,
            };
            let (cold, counts) = bench.cold();
            let coherent = bench.coherent();
            println!("{name:<16} {cold:>16} {coherent:>16}  {counts}");
        }
    }
    Ok(())
}

/// Eight vertices, tapered along x.
fn prism() -> Vec<DVec3> {
    let mut points = Vec::new();
    for (x, half) in [(-0.5, 0.02), (0.5, 0.008)] {
        for (y, z) in [(-1.0, -0.6), (1.0, -0.6), (-1.0, 0.6), (1.0, 0.6)] {
            points.push(DVec3::new(x * SIZE, y * half, z * half));
        }
    }
    points
}

/// A sphere by latitude and longitude whose radius swells and shrinks: 2·sectors·(bands − 1) triangles.
fn bumpy(sectors: u32, bands: u32) -> Result<TriangleMesh, Box<dyn Error>> {
    let plain = latitude_longitude_ellipsoid(DVec3::ONE, sectors, bands)?;
    let positions = plain.positions().iter().map(|&direction| {
        let longitude = direction.y.atan2(direction.x);
        let latitude = direction.z.clamp(-1.0, 1.0).acos();
        let swell = (9.0 * longitude).sin() * (7.0 * latitude).sin() * latitude.sin();
        let ripple = (41.0 * longitude).cos() * (37.0 * latitude).sin() * latitude.sin();
        direction * 0.5 * (1.0 + 0.03 * swell + 0.004 * ripple)
    });
    Ok(TriangleMesh::new(
        positions.collect(),
        plain.triangles().to_vec(),
    )?)
}

struct Bench<'m> {
    mesh: &'m TriangleMesh,
    bvh: &'m TriangleBvh,
    tool: &'m dyn SupportMap,
    query: Query,
}

impl Bench<'_> {
    fn ask(&self, pose: &Pose, cache: &mut MeshCache) -> usize {
        let (mesh, tool) = (self.mesh, self.tool);
        match self.query {
            Query::Minima => self.bvh.contacts(mesh, tool, pose, 0.0, cache).len(),
            Query::Every => self.bvh.every_contact(mesh, tool, pose, 0.0, cache).len(),
            Query::Deepest => {
                let found = self.bvh.deepest(mesh, tool, pose, 1.0, cache);
                usize::from(found.is_some())
            }
        }
    }

    /// Random faces and rotations, an empty cache each time.
    fn cold(&self) -> (String, String) {
        let mut random = Random(1);
        let poses: Vec<Pose> = (0..POSES)
            .map(|_| {
                let face = random.below(self.mesh.triangles().len());
                self.over(face, random.rotation())
            })
            .collect();
        let mut counts = Vec::new();
        let mut cache = MeshCache::default();
        let times = quickest(|times| {
            counts.clear();
            for pose in &poses {
                cache.clear();
                let before = Instant::now();
                let count = self.ask(pose, &mut cache);
                times.push(before.elapsed().as_secs_f64() * 1e6);
                counts.push(count);
            }
        });
        counts.sort_unstable();
        let counts = format!(
            "{} / {}",
            counts[counts.len() / 2],
            counts[counts.len() - 1]
        );
        (summary(times), counts)
    }

    fn coherent(&self) -> String {
        let mut random = Random(2);
        let mut cache = MeshCache::default();
        let mut times = Vec::new();
        for _ in 0..SEQUENCES {
            let poses = self.slide(&mut random);
            times.extend(quickest(|times| {
                cache.clear();
                for (step, pose) in poses.iter().enumerate() {
                    let before = Instant::now();
                    self.ask(pose, &mut cache);
                    if step > 0 {
                        times.push(before.elapsed().as_secs_f64() * 1e6);
                    }
                }
            }));
        }
        summary(times)
    }

    /// From a random face 0.1 % of the size sideways and 0.1° a step, then back to the same depth of the deepest triangle
    /// along its normal.
    fn slide(&self, random: &mut Random) -> Vec<Pose> {
        let mut placing = MeshCache::default();
        let mut pose = self.over(random.below(self.mesh.triangles().len()), random.rotation());
        let axis = random.direction();
        let mut poses = Vec::new();
        for _ in 0..STEPS {
            let found = self
                .bvh
                .deepest(self.mesh, self.tool, &pose, 1.0, &mut placing);
            let Some(found) = found else { break };
            let normal = found.closest.normal;
            pose.translation -= normal * (found.closest.separation + DEPTH);
            poses.push(pose);
            let sideways = normal.cross(axis).normalize_or(DVec3::X);
            pose.translation += sideways * (0.001 * SIZE);
            let turn = DQuat::from_axis_angle(axis, 0.1_f64.to_radians());
            pose.rotation = (turn * pose.rotation).normalize();
        }
        poses
    }

    /// The tool's lowest point over the middle of a face, `DEPTH` below its plane.
    fn over(&self, face: usize, rotation: DQuat) -> Pose {
        let [p, q, r] = self.mesh.triangles()[face].map(|v| self.mesh.positions()[v as usize]);
        let normal = (q - p).cross(r - p).normalize();
        let lowest = self.tool.support(-(rotation.conjugate() * normal), 0).point;
        let depth = DEPTH - self.tool.radius();
        Pose::new(
            rotation,
            (p + q + r) / 3.0 - normal * depth - rotation * lowest,
        )
    }
}

/// Entry by entry the least of the times that `pass` notes each time.
fn quickest(mut pass: impl FnMut(&mut Vec<f64>)) -> Vec<f64> {
    let mut best = Vec::new();
    for _ in 0..PASSES {
        let mut times = Vec::new();
        pass(&mut times);
        if best.is_empty() {
            best = times;
        } else {
            for (least, time) in best.iter_mut().zip(times) {
                *least = time.min(*least);
            }
        }
    }
    best
}

fn summary(mut times: Vec<f64>) -> String {
    times.sort_by(f64::total_cmp);
    let p99 = times[times.len() * 99 / 100];
    format!("{:.1} / {p99:.1}", times[times.len() / 2])
}

/// A multiplicative congruential generator (Knuth's MMIX), so that the example needs nothing else.
struct Random(u64);

impl Random {
    #[expect(clippy::cast_precision_loss, reason = "53 bits are kept")]
    fn unit(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a product below the count"
    )]
    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sine, cosine) = (TAU * self.unit()).sin_cos();
        let radius = (1.0 - z * z).sqrt();
        DVec3::new(radius * cosine, radius * sine, z)
    }

    fn rotation(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), PI * self.unit())
    }
}
