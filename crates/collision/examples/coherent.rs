//! A tool slides over and through a convex object of 12,672 faces, and the median time of a query is printed:
//! `cargo run --release -p pliant-collision --example coherent`.
#![expect(clippy::print_stdout, reason = "an example prints what it found")]

use std::error::Error;
use std::time::Instant;

use glam::{DQuat, DVec3};
use pliant_collision::{
    Cuboid, Point, Rounded, Segment, SimplexCache, SupportMap, closest_points, distance,
};
use pliant_mesh::ConvexMesh;
use pliant_mesh::generate::latitude_longitude_ellipsoid;
use pliant_spatial::Pose;

const STEPS: u32 = 20_000;

fn main() -> Result<(), Box<dyn Error>> {
    let radii = DVec3::new(0.05, 0.04, 0.03);
    let object = ConvexMesh::from_triangles(&latitude_longitude_ellipsoid(radii, 96, 67)?)?;
    let rod = Cuboid {
        half: DVec3::new(0.05, 0.004, 0.002),
    };
    let core = Segment {
        a: DVec3::X * -0.05,
        b: DVec3::X * 0.05,
    };
    let capsule = Rounded {
        core,
        radius: 0.002,
    };
    let sphere = Rounded {
        core: Point(DVec3::ZERO),
        radius: 0.002,
    };
    println!("median time of one coherent query against 12,672 faces [ns]");
    println!("gap [m]      box  capsule   sphere      box cold");
    for gap in [1e-2, 1e-7, -1e-5, -1e-3, -5e-3] {
        println!(
            "{gap:>7.0e} {:>8} {:>8} {:>8} {:>13}",
            median_time(&object, &rod, gap, Start::Warm),
            median_time(&object, &capsule, gap, Start::Warm),
            median_time(&object, &sphere, gap, Start::Warm),
            median_time(&object, &rod, gap, Start::Cold),
        );
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq)]
enum Start {
    Warm,
    Cold,
}

/// Slides `tool` around `object`, 0.1 mm and 0.1° a step, always put back to the same gap.
fn median_time<B: SupportMap>(object: &ConvexMesh, tool: &B, gap: f64, start: Start) -> u128 {
    let mut placing = SimplexCache::default();
    let mut cache = SimplexCache::default();
    let mut times = Vec::new();
    for step in 0..STEPS {
        let angle = 1.7e-3 * f64::from(step);
        let rotation = DQuat::from_scaled_axis(DVec3::new(0.3 * angle, angle, 0.2));
        let outward = DVec3::new(angle.cos(), angle.sin(), (0.31 * angle).sin()).normalize();
        let far = Pose::new(rotation, outward * 0.2);
        let Some(apart) = distance(object, tool, &far, &mut placing) else {
            continue;
        };
        let shift = apart.normal * (apart.separation - gap);
        let pose = Pose::new(rotation, far.translation - shift);
        if start == Start::Cold {
            cache = SimplexCache::default();
        }
        let before = Instant::now();
        let found = closest_points(object, tool, &pose, &mut cache);
        times.push(before.elapsed().as_nanos());
        assert!((found.separation - gap).abs() < 1e-9 || gap < 0.0);
    }
    times.sort_unstable();
    times[times.len() / 2]
}
