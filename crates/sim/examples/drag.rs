//! The force on a hand that drags a rod over a box and off its edge.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use std::error::Error;

use glam::DVec3;
use pliant_mesh::{ConvexMesh, generate};
use pliant_sim::{
    Method, Object, State, TickInput, Tool, VirtualCoupling, World, WorldDescription, tick,
};
use pliant_spatial::Pose;

fn main() -> Result<(), Box<dyn Error>> {
    let block = |half| -> Result<ConvexMesh, Box<dyn Error>> {
        Ok(ConvexMesh::from_triangles(&generate::cuboid(half)?)?)
    };
    let world = World::new(WorldDescription {
        tool: Tool {
            segments: vec![block(DVec3::new(0.05, 0.003, 0.003))?],
        },
        objects: vec![Object {
            name: "box".to_owned(),
            shape: block(DVec3::new(0.05, 0.05, 0.025))?,
            world_from_object: Pose::IDENTITY,
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })?;
    // The rod's middle starts over the box and leaves it sideways at 0.1 m/s, its underside 2 mm below the top.
    let hand = |t: f64| Pose::from_translation(DVec3::new(0.0, 0.1 * t, 0.030 - 0.02 * t.min(0.2)));
    let mut state = State::new(&world, hand(0.0));
    println!("time [s], force [N], torque [N·m]");
    for index in 1..=700_u32 {
        let time = f64::from(index) * 1e-3;
        let input = TickInput {
            world_from_haptic: hand(time),
        };
        let output = tick(&world, &mut state, &input, 1e-3);
        if index % 50 == 0 {
            println!(
                "{time:5.2} {:.3} {:.4}",
                output.wrench.force, output.wrench.torque
            );
        }
    }
    Ok(())
}
