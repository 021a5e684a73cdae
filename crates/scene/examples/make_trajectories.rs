//! Writes the hand motions of the shipped scenes: `make_trajectories SCENE.ron…` fills the CSV file each scene names.
//!
//! `cargo run --release -p pliant-scene --example make_trajectories -- scenes/*.ron`
//!
//! A motion starts as a few keyframes of the tool's tip (`make_trajectories/paths.rs`), joined by cubic splines. Then
//! a model hand follows them in the scene itself, at 1 kHz: the tip is pulled towards the path like a critically damped
//! mass, and it yields, that is it never aims deeper than [`YIELD`] past the visual tool. Every hundredth of a second
//! its pose is written. Nothing is random: the same program writes the same bytes.
#![allow(clippy::print_stderr, reason = "a command line tool reports")]

#[path = "make_trajectories/paths.rs"]
mod paths;

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::path::Path;
use std::process::ExitCode;

use glam::{DQuat, DVec3};
use pliant_device::{TimedPose, Trajectory};
use pliant_scene::{Disk, Files, MemoryFiles, Override, Scene};
use pliant_sim::{State, TickInput, World, tick};
use pliant_spatial::Pose;

use crate::paths::{Keyframe, path_of};

/// How far the hand aims past the visual tool [m]: 4 N at the default coupling.
const YIELD: f64 = 0.004;
/// Quickness of the hand [rad/s]: it settles in about 0.15 s.
const QUICKNESS: f64 = 40.0;
/// [Hz].
const TICKS_PER_SECOND: u32 = 1000;
/// Every how many ticks a row is written.
const TICKS_PER_ROW: u32 = 10;
/// The tip in the handle's frame, all shipped tools [m].
const TIP: DVec3 = DVec3::new(0.1, 0.0, 0.0);

fn main() -> ExitCode {
    let scenes: Vec<String> = std::env::args().skip(1).collect();
    if scenes.is_empty() {
        eprintln!("name the scenes whose motions to write: make_trajectories scenes/*.ron");
        return ExitCode::SUCCESS;
    }
    for scene in &scenes {
        if let Err(error) = make(Path::new(scene)) {
            eprintln!("{scene}: {error}");
            return ExitCode::FAILURE;
        }
    }
    ExitCode::SUCCESS
}

fn make(scene_path: &Path) -> Result<(), Box<dyn Error>> {
    let name = scene_path
        .file_stem()
        .and_then(|name| name.to_str())
        .ok_or("no file name")?;
    let path = path_of(name).ok_or("there is no path for this scene; add one to paths.rs")?;
    let scene = Scene::from_str(
        &std::fs::read_to_string(scene_path)?,
        &scene_path.display().to_string(),
    )?;
    let target = scene_path
        .parent()
        .unwrap_or(Path::new(""))
        .join(&scene.description().trajectory.path);
    let rows = follow(&world(scene)?, &path)?;
    std::fs::write(&target, csv(name, &rows))?;
    eprintln!("{}: {} rows", target.display(), rows.len());
    Ok(())
}

/// The scene's world; its own trajectory need not exist yet.
fn world(scene: Scene) -> Result<World, Box<dyn Error>> {
    struct Standing(MemoryFiles);
    impl Files for Standing {
        fn read(&self, path: &Path) -> std::io::Result<Vec<u8>> {
            self.0.read(path).or_else(|_| Disk.read(path))
        }
    }
    let name = "standing.csv";
    let path = Path::new(scene.file_name())
        .parent()
        .unwrap_or(Path::new(""))
        .join(name);
    let text = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,1,0,0,0,1\n1,0,0,1,0,0,0,1\n";
    let files = Standing(MemoryFiles([(path, text.into())].into()));
    let setting = Override::string(name.to_owned(), "trajectory.path", name);
    Ok(scene.with_overrides(&[setting])?.build(&files)?.world)
}

/// A curve through the keyframes: tip, direction and roll, each a cubic spline.
struct Path3 {
    tip: Trajectory,
    direction: Trajectory,
    roll: Trajectory,
}

impl Path3 {
    fn new(keyframes: &[Keyframe]) -> Result<Self, Box<dyn Error>> {
        let through = |value: fn(&Keyframe) -> DVec3| {
            let samples: Vec<TimedPose> = keyframes
                .iter()
                .map(|keyframe| TimedPose {
                    time: keyframe.time,
                    pose: Pose::from_translation(value(keyframe)),
                })
                .collect();
            Trajectory::new(&samples)
        };
        Ok(Self {
            tip: through(|keyframe| keyframe.tip)?,
            direction: through(|keyframe| keyframe.direction.normalize())?,
            roll: through(|keyframe| DVec3::X * keyframe.roll)?,
        })
    }

    /// `world_from_handle`. Continuous wherever the direction is, but for straight up: turned the shortest way from straight
    /// down, as most tools point. Every such rule breaks somewhere, and near there the tool would spin about its own axis.
    fn pose(&self, time: f64) -> Pose {
        let value = |curve: &Trajectory| curve.sample(time).0.translation;
        let direction = value(&self.direction).normalize();
        let rotation = DQuat::from_rotation_arc(DVec3::NEG_Z, direction)
            * DQuat::from_rotation_y(FRAC_PI_2)
            * DQuat::from_rotation_x(value(&self.roll).x.to_radians());
        Pose::new(rotation, value(&self.tip) - rotation * TIP)
    }
}

fn follow(world: &World, keyframes: &[Keyframe]) -> Result<Vec<TimedPose>, Box<dyn Error>> {
    let path = Path3::new(keyframes)?;
    let dt = 1.0 / f64::from(TICKS_PER_SECOND);
    let mut hand = path.pose(0.0);
    let mut tip = hand.transform_point(TIP);
    let mut velocity = DVec3::ZERO;
    let mut state = State::new(world, hand);
    let mut rows = Vec::new();
    let last = keyframes.last().map_or(0, Keyframe::millisecond);
    for number in 0..=last {
        let time = f64::from(number) * dt;
        let input = TickInput {
            world_from_haptic: hand,
        };
        let output = tick(world, &mut state, &input, dt);
        if number % TICKS_PER_ROW == 0 {
            rows.push(TimedPose { time, pose: hand });
        }
        // The tip lags, the orientation does not: a lagging handle would swing the tip about.
        let wanted = path.pose(time + dt);
        let visual = tip + (output.world_from_visual.translation - hand.translation);
        let aim = visual + (wanted.transform_point(TIP) - visual).clamp_length_max(YIELD);
        let pull = (aim - tip) * QUICKNESS - velocity * 2.0;
        velocity += pull * (QUICKNESS * dt);
        tip += velocity * dt;
        hand = Pose::new(wanted.rotation, tip - wanted.rotation * TIP);
    }
    Ok(rows)
}

fn csv(scene: &str, rows: &[TimedPose]) -> String {
    let mut text =
        format!("# Hand motion of the scene {scene}. Made by the example make_trajectories.\n");
    text.push_str("t_s,x_m,y_m,z_m,qx,qy,qz,qw\n");
    for row in rows {
        let (p, q) = (row.pose.translation, row.pose.rotation);
        let _ = writeln!(
            text,
            "{:.2},{:.7},{:.7},{:.7},{:.8},{:.8},{:.8},{:.8}",
            row.time, p.x, p.y, p.z, q.x, q.y, q.z, q.w
        );
    }
    text
}
