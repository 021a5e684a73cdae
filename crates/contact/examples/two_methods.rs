//! Both methods on one motion: a rod pushed 5 mm through a plate of 1 mm. The separating planes keep the rod on its side; the paper's method
//! lets go once the haptic tool has left the plate on the other side.
#![allow(clippy::print_stdout, reason = "an example prints its result")]

use glam::DVec3;
use pliant_contact::{ConstrainedTracker, Obstacle, PaperParameters, PaperTracker};
use pliant_mesh::{ConvexMesh, generate};
use pliant_spatial::Pose;

fn block(half: DVec3) -> ConvexMesh {
    let mesh = generate::cuboid(half).expect("positive sizes");
    ConvexMesh::from_triangles(&mesh).expect("a box is convex")
}

fn main() {
    let plate = [Obstacle {
        shape: block(DVec3::new(0.05, 0.05, 0.0005)),
        world_from_object: Pose::IDENTITY,
        shading_threshold: None,
    }];
    let tool = [block(DVec3::new(0.05, 0.001, 0.001))];
    let haptic = |tick: u32| {
        // Touching at 1.5 mm, then 0.05 mm a tick (0.05 m/s).
        let depth = 0.05e-3 * f64::from(tick) - 1e-3;
        Pose::from_translation(DVec3::Z * (1.5e-3 - depth))
    };
    let mut constrained = ConstrainedTracker::new(&plate, &tool, haptic(0));
    let mut paper = PaperTracker::new(&plate, &tool, &PaperParameters::default(), haptic(0));
    println!("depth of the hand [mm], height of the visual tool [mm]: constrained, paper");
    for tick in 1..=120 {
        let pose = haptic(tick);
        let a = constrained.advance(&plate, &tool, &pose, pose.translation);
        let b = paper.advance(&plate, &tool, &pose);
        if tick % 20 == 0 {
            println!(
                "{:6.2} {:8.4} {:8.4}",
                (1.5e-3 - pose.translation.z) * 1e3,
                a.world_from_visual.translation.z * 1e3,
                b.world_from_visual.translation.z * 1e3
            );
        }
    }
}
