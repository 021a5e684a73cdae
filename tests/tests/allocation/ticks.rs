//! A tick allocates nothing: a counting allocator watches the ticks of both methods, device and servo included.

use pliant_contact::PaperParameters;
use pliant_device::{ScriptedDevice, TimedPose, Trajectory, WorkspaceMap};
use pliant_servo::{Rate, Servo, ServoParts};
use pliant_sim::{Method, State, TickInput, VirtualCoupling, World, WorldDescription, tick};
use pliant_tests::bodies::{Setting, ToolKind, handle_with_tip, world};
use pliant_tests::hand::RandomHand;

use crate::allocations;

/// A hand's path over the object, 5 s.
fn trajectory() -> Trajectory {
    let mut hand = RandomHand::new(5, glam::DVec3::splat(0.045));
    let samples: Vec<TimedPose> = (0..5000)
        .map(|index| TimedPose {
            time: f64::from(index) * 1e-3,
            pose: hand.advance(glam::DVec3::ZERO, 1e-3),
        })
        .collect();
    Trajectory::new(&samples).expect("a smooth path")
}

/// Allocations during 5000 ticks along the path, and ticks with contact. The same path for every world.
fn allocations_of_ticks(world: World, path: Trajectory) -> (u64, u32) {
    let mut servo = Servo::new(ServoParts {
        world,
        device: Box::new(ScriptedDevice::new("path", path)),
        map: WorkspaceMap::IDENTITY,
        rate: Rate::DEFAULT,
    })
    .expect("valid");
    let before = allocations();
    let mut contact_ticks = 0;
    for _ in 0..5000 {
        let sample = servo.step().expect("a scripted device does not fail");
        contact_ticks += u32::from(sample.output.contacts > 0);
    }
    (allocations() - before, contact_ticks)
}

#[test]
fn no_tick_of_either_method_allocates() {
    let paper = Method::Paper(PaperParameters::default());
    for setting in [
        Setting::Box,
        Setting::LatitudeLongitude,
        Setting::Corner,
        Setting::Slot,
    ] {
        for kind in [ToolKind::Rod, ToolKind::Cone] {
            for segments in [1, 10] {
                for method in [Method::Constrained, paper] {
                    let world = world(setting, kind.tool(segments), method);
                    let (count, contact_ticks) = allocations_of_ticks(world, trajectory());
                    let case = format!("{setting:?}, {kind:?} of {segments}, {method:?}");
                    assert!(contact_ticks > 500, "{case}: {contact_ticks} contact ticks");
                    assert_eq!(count, 0, "{case}");
                }
            }
        }
    }
}

#[test]
fn no_tick_with_shading_and_damping_allocates() {
    for (shading_threshold, linear_damping) in [(Some(0.2), 0.0), (None, 20.0), (Some(0.2), 20.0)] {
        for segments in [1, 10] {
            let mut objects = Setting::LatitudeLongitude.objects();
            objects[0].shading_threshold = shading_threshold;
            let world = World::new(WorldDescription {
                tool: ToolKind::Cone.tool(segments),
                objects,
                coupling: VirtualCoupling {
                    linear_damping,
                    ..VirtualCoupling::default()
                },
                method: Method::Constrained,
            })
            .expect("valid");
            let (count, contact_ticks) = allocations_of_ticks(world, trajectory());
            let case = format!("{shading_threshold:?} rad, {linear_damping} N·s/m, {segments}");
            assert!(contact_ticks > 500, "{case}: {contact_ticks} contact ticks");
            assert_eq!(count, 0, "{case}");
        }
    }
}

/// The first ticks out of an object, and out of two at once.
#[test]
fn no_tick_after_a_start_inside_allocates() {
    for setting in [Setting::Box, Setting::Corner, Setting::Slot] {
        for segments in [1, 10] {
            let world = world(setting, ToolKind::Rod.tool(segments), Method::Constrained);
            // Across the slot, deep in the box, along the floor and into the wall.
            let pose = match setting {
                Setting::Slot => handle_with_tip(glam::DVec3::Y * 0.05, glam::DVec3::Y),
                Setting::Corner => handle_with_tip(glam::DVec3::X * -0.052, -glam::DVec3::X),
                _ => handle_with_tip(glam::DVec3::X * 0.05, glam::DVec3::X),
            };
            let mut state = State::new(&world, pose);
            let tracker = state.constrained().expect("the method");
            assert!(tracker.started_inside(), "{setting:?}");
            let input = TickInput {
                world_from_haptic: pose,
            };
            let before = allocations();
            for _ in 0..1000 {
                tick(&world, &mut state, &input, 1e-3);
            }
            let count = allocations() - before;
            assert_eq!(count, 0, "{setting:?}, {segments} segments");
        }
    }
}

#[test]
fn the_counter_counts() {
    let before = allocations();
    std::hint::black_box(Box::new(1));
    assert!(allocations() > before);
}
