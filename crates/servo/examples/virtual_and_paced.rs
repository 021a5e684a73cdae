//! Presses a box onto a block, in virtual time and on the machine's clock, and compares the two.
#![allow(clippy::print_stdout, reason = "the comparison is the result")]

use std::error::Error;
use std::f64::consts::PI;
use std::time::{Duration, Instant};

use glam::DVec3;
use pliant_device::{ScriptedDevice, TimedPose, Trajectory, WorkspaceMap};
use pliant_mesh::{ConvexMesh, generate};
use pliant_servo::{MonotonicClock, Rate, Servo, ServoParts, run_paced, run_virtual};
use pliant_sim::{Method, Object, Tool, VirtualCoupling, World, WorldDescription};
use pliant_spatial::Pose;

const TICKS: u64 = 1000;

fn main() -> Result<(), Box<dyn Error>> {
    let mut forces = Vec::with_capacity(2 * usize::try_from(TICKS)?);
    let started = Instant::now();
    run_virtual(&mut servo()?, TICKS, |sample| {
        forces.push(sample.device_wrench.force);
    })?;
    println!("virtual time: {TICKS} ticks in {:?}", started.elapsed());
    let clock = MonotonicClock::new();
    let report = run_paced(&mut servo()?, &clock, TICKS, |sample| {
        forces.push(sample.device_wrench.force);
    })?;
    println!(
        "paced: {} ticks, {} late, worst {:?} behind its deadline",
        report.ticks, report.late_ticks, report.max_lateness
    );
    let (in_virtual_time, paced) = forces.split_at(forces.len() / 2);
    let largest = paced.iter().map(|force| force.length()).fold(0.0, f64::max);
    println!(
        "largest force {largest:.3} N; equal forces: {}",
        in_virtual_time == paced
    );
    println!("tick of a resting tool: {:?}", time_of_one_tick()?);
    Ok(())
}

/// Down into a block by 2 mm and up again while sliding by 30 mm, in one second.
fn servo() -> Result<Servo, Box<dyn Error>> {
    let cuboid = |half| -> Result<ConvexMesh, Box<dyn Error>> {
        Ok(ConvexMesh::from_triangles(&generate::cuboid(half)?)?)
    };
    let world = World::new(WorldDescription {
        tool: Tool {
            segments: vec![cuboid(DVec3::splat(0.005))?],
        },
        objects: vec![Object {
            name: "block".into(),
            shape: cuboid(DVec3::splat(0.05))?,
            world_from_object: Pose::from_translation(DVec3::Z * -0.05),
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })?;
    let samples: Vec<_> = (0..=20)
        .map(|i| {
            let time = f64::from(i) / 20.0;
            let height = 0.003 + 0.017 * (PI * time).cos().powi(2);
            TimedPose {
                time,
                pose: Pose::from_translation(DVec3::new(0.03 * time, 0.0, height)),
            }
        })
        .collect();
    Ok(Servo::new(ServoParts {
        world,
        device: Box::new(ScriptedDevice::new("press", Trajectory::new(&samples)?)),
        map: WorkspaceMap::IDENTITY,
        rate: Rate::DEFAULT,
    })?)
}

/// The tick alone, without the device: what a benchmark measures.
fn time_of_one_tick() -> Result<Duration, Box<dyn Error>> {
    let mut servo = servo()?;
    run_virtual(&mut servo, TICKS, |_| ())?;
    let mut elapsed = Duration::ZERO;
    servo.step_with(|world, state, input, dt| {
        let started = Instant::now();
        let output = pliant_sim::tick(world, state, input, dt);
        elapsed = started.elapsed();
        output
    })?;
    Ok(elapsed)
}
