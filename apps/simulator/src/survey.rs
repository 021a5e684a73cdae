//! What a scene holds before it runs: sizes, the motion, and how near it comes to the objects.

use glam::DVec3;
use pliant_collision::{SimplexCache, closest_points};
use pliant_device::{Trajectory, WorkspaceMap};
use pliant_mesh::Aabb;
use pliant_scene::{BuiltScene, MethodName};
use pliant_sim::{RAMP_SECONDS, Tool, World};
use pliant_spatial::Pose;

/// Closest-point queries spent on a motion: about a second.
const MOST_QUERIES: usize = 500_000;

/// Moments at which a motion is looked at, unless queries run out first.
const MOST_MOMENTS: usize = 20_000;

/// Deeper at the start than this is a start inside an object [m]; less is a tool laid on its surface.
const START_DEPTH: f64 = 1e-6;

/// Speed that no hand reaches [m/s].
const HAND_SPEED: f64 = 2.0;

/// The object that a tool is closest to, or deepest in.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    object: usize,
    /// Negative in overlap [m].
    separation: f64,
}

/// The nearest object for a handle at `world_from_handle`; `None` without objects.
fn nearest(world: &World, world_from_handle: &Pose) -> Option<Nearest> {
    let mut nearest: Option<Nearest> = None;
    for (object, obstacle) in world.obstacles().iter().enumerate() {
        let object_from_handle = obstacle.world_from_object.inverse() * *world_from_handle;
        for segment in &world.tool().segments {
            let mut cache = SimplexCache::default();
            let closest = closest_points(&obstacle.shape, segment, &object_from_handle, &mut cache);
            if nearest.is_none_or(|best| closest.separation < best.separation) {
                nearest = Some(Nearest {
                    object,
                    separation: closest.separation,
                });
            }
        }
    }
    nearest
}

/// Where the hand is at `time` [s], in the world.
fn hand(built: &BuiltScene, time: f64) -> Pose {
    built.map.pose_to_world(&built.trajectory.sample(time).0)
}

/// What to know of a run that begins inside an object.
pub(crate) fn start(built: &BuiltScene) -> Option<String> {
    let Nearest { object, separation } = nearest(&built.world, &hand(built, 0.0))?;
    if separation > -START_DEPTH {
        return None;
    }
    let name = &built.world.object_names()[object];
    let ramp = match built.method {
        MethodName::Constrained => format!("; the force rises over {RAMP_SECONDS} s"),
        MethodName::Paper => String::new(),
    };
    Some(format!(
        "inside {name}, {} deep{ramp}",
        millimetres(-separation)
    ))
}

/// Why a run of `seconds` touched nothing.
pub(crate) fn missed(built: &BuiltScene, seconds: f64) -> String {
    match closest_approach(built, seconds) {
        None => "the scene has no objects".to_owned(),
        Some(Nearest { separation, object }) if separation > 0.0 => format!(
            "the tool's path stays {} from every object; the nearest is {}",
            millimetres(separation),
            built.world.object_names()[object]
        ),
        Some(_) => "the tool touches nothing".to_owned(),
    }
}

/// The nearest that the hand brings the tool to an object within `seconds`.
fn closest_approach(built: &BuiltScene, seconds: f64) -> Option<Nearest> {
    let world = &built.world;
    let pairs = world.obstacles().len() * world.tool().segments.len();
    let moments = times(seconds, built.rate_hz, MOST_QUERIES / pairs.max(1));
    moments
        .filter_map(|time| nearest(world, &hand(built, time)))
        .min_by(|a, b| a.separation.total_cmp(&b.separation))
}

/// Every tick of `seconds`, or as many moments as `most` and [`MOST_MOMENTS`] allow, evenly spread.
fn times(seconds: f64, rate_hz: u32, most: usize) -> impl Iterator<Item = f64> {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "positive, and a scene lasts a day at most"
    )]
    let ticks = (seconds * f64::from(rate_hz)).round().max(1.0) as usize;
    let moments = ticks.min(most.clamp(2, MOST_MOMENTS));
    (0..=moments).map(move |i| seconds * i as f64 / moments as f64)
}

/// Lines of a report, name and value, on a scene.
pub(crate) fn scene(built: &BuiltScene) -> Vec<(&'static str, String)> {
    let world = &built.world;
    let mut lines = vec![("tool", tool(world.tool()))];
    for (name, obstacle) in world.object_names().iter().zip(world.obstacles()) {
        let topology = obstacle.shape.topology();
        let (vertices, faces) = (topology.vertex_count(), topology.face_count());
        let size = box_in_mm(obstacle.shape.bounds().size());
        lines.push((
            "object",
            format!("{name}: {size}, {vertices} vertices, {faces} faces"),
        ));
    }
    lines.push(("method", built.method.name().to_owned()));
    let duration = built.trajectory.duration();
    lines.push((
        "run",
        format!(
            "{} s at {} Hz, motion of {duration} s",
            built.seconds, built.rate_hz
        ),
    ));
    lines.extend(motion(&built.trajectory, &built.map, built.rate_hz));
    let scale = built.map.force_scale();
    lines.push(("force scale", format!("{scale} device N per world N")));
    lines.extend(start(built).map(|start| ("start", start)));
    match closest_approach(built, built.seconds) {
        Some(nearest) if nearest.separation <= 0.0 => {}
        _ => lines.push(("no contact", missed(built, built.seconds))),
    }
    lines
}

/// Lines on a motion: where it goes and how fast.
pub(crate) fn motion(
    trajectory: &Trajectory,
    map: &WorkspaceMap,
    rate_hz: u32,
) -> Vec<(&'static str, String)> {
    let (mut bounds, mut linear, mut angular) = (Aabb::EMPTY, 0.0_f64, 0.0_f64);
    let duration = trajectory.duration();
    for time in times(duration, rate_hz, MOST_MOMENTS) {
        let (pose, twist) = trajectory.sample(trajectory.start() + time);
        let twist = map.twist_to_world(&twist);
        bounds = bounds.including(map.pose_to_world(&pose).translation);
        linear = linear.max(twist.linear.length());
        angular = angular.max(twist.angular.length());
    }
    let corner = |point: DVec3| {
        let [x, y, z] = (point * 1e3).to_array().map(short);
        format!("({x}, {y}, {z})")
    };
    let mut lines = vec![
        (
            "motion",
            format!(
                "of the handle from {} to {} mm",
                corner(bounds.min),
                corner(bounds.max)
            ),
        ),
        (
            "top speed",
            format!("{} m/s, {} rad/s", short(linear), short(angular)),
        ),
    ];
    if linear > HAND_SPEED {
        lines.push((
            "note",
            format!(
                "{} m/s is faster than a hand: is the file in metres?",
                short(linear)
            ),
        ));
    }
    lines
}

fn tool(tool: &Tool) -> String {
    let bounds = tool.segments.iter().fold(Aabb::EMPTY, |bounds, segment| {
        bounds.union(&segment.bounds())
    });
    let segments = tool.segments.len();
    let plural = if segments == 1 { "" } else { "s" };
    format!(
        "{} long, {segments} segment{plural}",
        millimetres(bounds.size().x)
    )
}

fn box_in_mm(size: DVec3) -> String {
    let [x, y, z] = (size * 1e3).to_array().map(short);
    format!("{x} x {y} x {z} mm")
}

fn millimetres(length: f64) -> String {
    format!("{} mm", short(length * 1e3))
}

/// Three significant digits, and whole numbers in full.
fn short(value: f64) -> f64 {
    if value.abs() >= 100.0 {
        value.round()
    } else if value.abs() < 1e-6 {
        0.0
    } else {
        format!("{value:.2e}").parse().unwrap_or(value)
    }
}

#[cfg(test)]
mod tests {
    use super::{short, times};

    #[test]
    fn figures_have_three_digits() {
        assert_eq!(
            [49.0, 1234.4, 0.012_345, 99.96, 1e-9].map(|v| short(v).to_string()),
            ["49", "1234", "0.0123", "100", "0"]
        );
    }

    #[test]
    fn moments_reach_from_start_to_end() {
        let all: Vec<f64> = times(2.0, 1000, 10_000).collect();
        assert_eq!((all.len(), all[0], all[2000]), (2001, 0.0, 2.0));
        assert_eq!(times(1e4, 1000, 50).count(), 51);
    }
}
