//! Time of one tick: both methods, one and ten segments, 800, 12,672 and 998,000 faces.

use std::path::Path;
use std::time::Instant;

use anyhow::Result;
use pliant_contact::PaperParameters;
use pliant_mesh::ConvexMesh;
use pliant_sim::{
    Method, Object, State, TickInput, VirtualCoupling, World, WorldDescription, tick,
};
use pliant_spatial::Pose;
use pliant_tests::bodies::{ToolKind, latitude_longitude};
use pliant_tests::campaign::PERIOD;
use pliant_tests::motion::{shaft_slide, tip_slide};
use serde::Serialize;

/// Faces of the object that the finest one is compared with.
const BASE_FACES: usize = 12_672;
/// A tick on the finest object may take so many times as long.
const SIZE_LIMIT: f64 = 1.5;
/// Ticks of one pass over a motion.
const TICKS: u32 = 4000;
/// A tick's time is its smallest over so many passes, which removes what the machine did meanwhile.
const PASSES: usize = 7;

/// One row of the table; times in nanoseconds.
#[derive(Serialize)]
struct Row {
    method: &'static str,
    motion: &'static str,
    faces: usize,
    segments: u32,
    contact_ticks: u32,
    p50_ns: u64,
    p99_ns: u64,
    p999_ns: u64,
    max_ns: u64,
}

/// Measures, prints and writes all rows.
pub(crate) fn run(json: &Path) -> Result<()> {
    println!(
        "{:>12} {:>12} {:>7} {:>9} {:>8} {:>9} {:>9} {:>9} {:>9}",
        "method",
        "motion",
        "faces",
        "segments",
        "contact",
        "p50 µs",
        "p99 µs",
        "p99.9 µs",
        "max µs"
    );
    let objects = [(20, 21), (96, 67), (1000, 500)]
        .map(|(sectors, bands)| latitude_longitude(sectors, bands));
    let mut rows = Vec::new();
    for (name, method) in [
        ("constrained", Method::Constrained),
        ("paper", Method::Paper(PaperParameters::default())),
    ] {
        for object in &objects {
            for segments in [1, 10] {
                let tip = world(object.clone(), ToolKind::Cone, segments, method);
                rows.push(row(name, "tip slide", &tip, tip_slide(2e-3)));
                let shaft = world(object.clone(), ToolKind::Rod, segments, method);
                rows.push(row(name, "shaft turning", &shaft, shaft_slide(2e-3, 1.5)));
            }
        }
    }
    compare_sizes(&rows);
    crate::write_json(json, &rows)
}

/// Each figure on the finest object beside the one on 12,672 faces: it may be [`SIZE_LIMIT`] times as much.
fn compare_sizes(rows: &[Row]) {
    let finest = rows.iter().map(|row| row.faces).max().unwrap_or(0);
    for row in rows.iter().filter(|row| row.faces == finest) {
        let same = |other: &&Row| {
            (other.method, other.motion, other.segments) == (row.method, row.motion, row.segments)
        };
        let Some(base) = rows
            .iter()
            .filter(same)
            .find(|other| other.faces == BASE_FACES)
        else {
            continue;
        };
        let ratio = |of: fn(&Row) -> u64| of(row) as f64 / of(base) as f64;
        let (p50, p99) = (ratio(|row| row.p50_ns), ratio(|row| row.p99_ns));
        let met = p50.max(p99) <= SIZE_LIMIT;
        println!(
            "{:>12} {:>13} {:>2} segments: {finest} faces cost {p50:.2} times {BASE_FACES} at p50, {p99:.2} at p99: {}",
            row.method,
            row.motion,
            row.segments,
            if met { "met" } else { "MISSED" }
        );
    }
}

fn world(shape: ConvexMesh, tool: ToolKind, segments: u32, method: Method) -> World {
    World::new(WorldDescription {
        tool: tool.tool(segments),
        objects: vec![Object {
            name: "ellipsoid".to_owned(),
            shape,
            world_from_object: Pose::IDENTITY,
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method,
    })
    .expect("benchmark worlds are valid")
}

fn row(
    method: &'static str,
    motion: &'static str,
    world: &World,
    path: impl Fn(f64) -> Pose,
) -> Row {
    let mut best = vec![u64::MAX; TICKS as usize];
    let mut contact_ticks = 0;
    for _ in 0..PASSES {
        let mut state = State::new(world, path(0.0));
        contact_ticks = 0;
        for (index, best) in (1..=TICKS).zip(&mut best) {
            let input = TickInput {
                world_from_haptic: path(f64::from(index) * PERIOD),
            };
            let start = Instant::now();
            let output = tick(world, &mut state, &input, PERIOD);
            let elapsed = start.elapsed().as_nanos();
            contact_ticks += u32::from(output.contacts > 0);
            *best = (*best).min(u64::try_from(elapsed).unwrap_or(u64::MAX));
        }
    }
    best.sort_unstable();
    let at = |per_mille: usize| best[(best.len() - 1) * per_mille / 1000];
    let row = Row {
        method,
        motion,
        faces: world.obstacles()[0].shape.topology().face_count(),
        segments: u32::try_from(world.tool().segments.len()).unwrap_or(u32::MAX),
        contact_ticks,
        p50_ns: at(500),
        p99_ns: at(990),
        p999_ns: at(999),
        max_ns: at(1000),
    };
    let micro = |ns: u64| ns as f64 / 1000.0;
    println!(
        "{method:>12} {motion:>12} {:>7} {:>9} {:>8} {:>9.2} {:>9.2} {:>9.2} {:>9.2}",
        row.faces,
        row.segments,
        row.contact_ticks,
        micro(row.p50_ns),
        micro(row.p99_ns),
        micro(row.p999_ns),
        micro(row.max_ns)
    );
    row
}
