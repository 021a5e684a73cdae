//! Invariants of rigid contact on planned motions: force steps, side kept, torque, segments, slots, start inside, damping.

use std::path::Path;

use glam::{DQuat, DVec3};
use pliant_mesh::HalfEdgeMesh;
use pliant_scene::{Disk, Scene};
use pliant_sim::{
    Method, State, TickInput, TickOutput, VirtualCoupling, World, WorldDescription, tick,
    visual_penetration,
};
use pliant_spatial::{Pose, rotation_vector};
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind, handle_with_tip, world};
use pliant_tests::campaign::PERIOD;
use pliant_tests::hand::RandomHand;
use pliant_tests::motion::{play, press, shaft_slide, tip_slide};

const K: f64 = 1000.0;

fn constrained(setting: Setting, kind: ToolKind, segments: u32) -> World {
    world(setting, kind.tool(segments), Method::Constrained)
}

/// Largest sine of a dihedral angle of a closed mesh.
fn largest_dihedral_sine(mesh: &HalfEdgeMesh) -> f64 {
    (0..mesh.edge_count())
        .map(|edge| {
            let edge = pliant_mesh::EdgeId(u32::try_from(edge).expect("u32"));
            let [a, b] = mesh.edge_faces(edge).map(|f| f.expect("closed"));
            mesh.face_normal(a).cross(mesh.face_normal(b)).length()
        })
        .fold(0.0, f64::max)
}

/// Farthest any point of the tool moved between two haptic poses [m].
fn tool_motion(a: &Pose, b: &Pose) -> f64 {
    (b.translation - a.translation).length()
        + rotation_vector(b.rotation * a.rotation.conjugate()).length() * TOOL_LENGTH
}

/// Largest |ΔF| beyond k·(tool motion) + k·d·sin θ between consecutive contact ticks [N], the bound of a smooth convex object.
fn excess_force_step(outputs: &[TickOutput], sine: f64) -> f64 {
    outputs
        .windows(2)
        .filter(|pair| pair.iter().all(|o| o.contacts > 0))
        .map(|pair| {
            let step = (pair[1].wrench.force - pair[0].wrench.force).length();
            let depth = pair[0]
                .penetration_of_haptic
                .max(pair[1].penetration_of_haptic);
            let motion = tool_motion(&pair[0].world_from_haptic, &pair[1].world_from_haptic);
            step - K * motion - K * depth * sine
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

fn contact_share(outputs: &[TickOutput]) -> f64 {
    outputs.iter().filter(|o| o.contacts > 0).count() as f64 / outputs.len() as f64
}

#[test]
fn force_steps_on_smooth_objects_are_hand_motion_and_one_dihedral() {
    for setting in [Setting::LatitudeLongitude, Setting::Fibonacci] {
        for segments in [1, 10] {
            let cone = constrained(setting, ToolKind::Cone, segments);
            let rod = constrained(setting, ToolKind::Rod, segments);
            let sine = largest_dihedral_sine(cone.obstacles()[0].shape.topology());
            for depth in [1e-3, 5e-3] {
                let runs = [
                    ("slide", play(&cone, tip_slide(depth), 4000)),
                    ("flat", play(&rod, shaft_slide(depth, 0.0), 4000)),
                    ("rotating", play(&rod, shaft_slide(depth, 1.5), 4000)),
                ];
                for (name, outputs) in runs {
                    assert!(contact_share(&outputs) > 0.9, "{setting:?} {name}");
                    let excess = excess_force_step(&outputs, sine);
                    assert!(
                        excess <= 1e-6,
                        "{setting:?} {name} {depth}: {excess} N over"
                    );
                }
            }
        }
    }
}

#[test]
fn a_shaded_pointed_tool_steps_by_less_than_a_twentieth_newton() {
    let mut objects = Setting::LatitudeLongitude.objects();
    objects[0].shading_threshold = Some(0.2);
    let shaded = World::new(WorldDescription {
        tool: ToolKind::Cone.tool(1),
        objects,
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })
    .expect("valid");
    let plain = constrained(Setting::LatitudeLongitude, ToolKind::Cone, 1);
    // Slow enough that hand motion alone is 0.016 N a tick.
    let slow = |t: f64| tip_slide(5e-3)(0.2 + 0.25 * t);
    let largest = |outputs: &[TickOutput]| {
        outputs
            .windows(2)
            .skip(5)
            .map(|w| (w[1].wrench.force - w[0].wrench.force).length())
            .fold(0.0, f64::max)
    };
    let shaded_outputs = play(&shaded, slow, 8000);
    let plain_outputs = play(&plain, slow, 8000);
    let (with, without) = (largest(&shaded_outputs), largest(&plain_outputs));
    assert!(with <= 0.05, "shaded step {with} N");
    assert!(
        without > 3.0 * with,
        "unshaded {without} N, shaded {with} N"
    );
    for (s, p) in shaded_outputs.iter().zip(&plain_outputs) {
        assert_eq!(
            s.world_from_visual, p.world_from_visual,
            "shading must not move the tool"
        );
        assert!((s.wrench.force.length() - p.wrench.force.length()).abs() < 1e-12);
    }
}

#[test]
fn one_segment_feels_like_ten() {
    for setting in [
        Setting::Box,
        Setting::Hull,
        Setting::LatitudeLongitude,
        Setting::Fibonacci,
    ] {
        for seed in 0..2 {
            let (one, ten) = (
                constrained(setting, ToolKind::Rod, 1),
                constrained(setting, ToolKind::Rod, 10),
            );
            let mut hand = RandomHand::new(seed, DVec3::splat(0.045));
            let mut states = (State::new(&one, hand.pose()), State::new(&ten, hand.pose()));
            let mut force = DVec3::ZERO;
            let mut contact_ticks = 0;
            for index in 0..6000 {
                let input = TickInput {
                    world_from_haptic: hand.advance(force, PERIOD),
                };
                let a = tick(&one, &mut states.0, &input, PERIOD);
                let b = tick(&ten, &mut states.1, &input, PERIOD);
                force = a.wrench.force;
                contact_ticks += u32::from(a.contacts > 0);
                let apart =
                    (a.world_from_visual.translation - b.world_from_visual.translation).length();
                assert!(
                    apart <= 1e-9,
                    "{setting:?} seed {seed} tick {index}: {apart:e} m apart"
                );
            }
            assert!(contact_ticks > 1500, "{setting:?} {contact_ticks}");
        }
    }
}

#[test]
fn a_plate_of_one_millimetre_holds_five_newtons_at_five_millimetres() {
    let side = DVec3::X;
    let down = -DVec3::Z;
    for (kind, half) in [
        (ToolKind::ThinRod, 1e-3),
        (ToolKind::Pin, 0.2e-3),
        (ToolKind::Rod, 3e-3),
    ] {
        for segments in [1, 10] {
            let plate = constrained(Setting::Plate, kind, segments);
            for (axis, reach) in [(side, half), (down, 0.5 * TOOL_LENGTH)] {
                for speed in [0.05, 1.0] {
                    for phase in 0..10 {
                        // The lower side of the tool starts 2 mm above the plate's top, plus a part of one tick's motion.
                        let gap = 2e-3 + f64::from(phase) / 10.0 * speed * PERIOD;
                        let from = DVec3::Z * (0.5e-3 + reach + gap);
                        let outputs = play(&plate, press(axis, from, speed, gap + 5e-3), 300);
                        let last = outputs.last().expect("300 ticks");
                        let force = last.wrench.force;
                        assert!(
                            (force - DVec3::Z * 5.0).length() < 1e-3,
                            "{kind:?} {segments} {axis} {speed} m/s phase {phase}: {force}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_tool_turned_past_fit_in_a_slot_is_held_without_entering() {
    for segments in [1, 10] {
        let slot = constrained(Setting::Slot, ToolKind::Rod, segments);
        let middle = DVec3::ZERO;
        // 1.5 rad/s about the middle moves the handle by 0.075 mm a tick: 0.075 N.
        let turn = |t: f64| {
            let axis = DQuat::from_rotation_z((1.5 * t).min(0.6)) * DVec3::X;
            handle_with_tip(middle + axis * (0.5 * TOOL_LENGTH), axis)
        };
        let mut state = State::new(&slot, turn(0.0));
        let mut held = 0;
        let mut last: Option<TickOutput> = None;
        for index in 1..=800 {
            let input = TickInput {
                world_from_haptic: turn(f64::from(index) * PERIOD),
            };
            let output = tick(&slot, &mut state, &input, PERIOD);
            held += u32::from(output.held);
            assert!(visual_penetration(&slot, &state) <= 1e-9);
            if let Some(before) = last {
                let step = (output.wrench.force - before.wrench.force).length();
                assert!(step <= 0.1, "tick {index}: force step {step} N");
            }
            last = Some(output);
        }
        // A 6 mm rod of 100 mm fits an 8 mm slot up to about 0.02 rad; the rest of the motion is past fit.
        assert!(held > 700, "{held} held ticks");
        let angle = rotation_vector(state.world_from_visual().rotation).length();
        assert!((0.015..0.025).contains(&angle), "held at {angle} rad");
    }
}

/// Jammed in a slot and pressed against one wall, both walls' planes hold: the other wall must not cancel the spring's force.
#[test]
fn a_jammed_tool_keeps_its_force() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/slot.ron");
    let text = std::fs::read_to_string(&path).expect("the scene is shipped");
    let scene = Scene::from_str(&text, &path.display().to_string()).expect("valid");
    let built = scene.build(&Disk).expect("valid");
    let hand = |t: f64| built.trajectory.sample(t).0;
    let mut double_and_held = 0;
    for output in play(&built.world, hand, 7000) {
        double_and_held += u32::from(output.held && output.contacts == 2);
        let offset = output.world_from_visual.translation - output.world_from_haptic.translation;
        assert!((output.wrench.force - K * offset).length() < 1e-9);
    }
    assert!(
        double_and_held > 50,
        "{double_and_held} ticks held by both walls"
    );
}

#[test]
fn torque_is_steady_while_a_flat_tool_slides_on_a_face() {
    for segments in [1, 10] {
        let world = constrained(Setting::Box, ToolKind::Rod, segments);
        // 1 mm deep: 1 N. The rod stays over the face of 100 mm.
        let slide = |t: f64| {
            let middle = DVec3::new(
                0.02 * (3.0 * t).sin(),
                0.03 * (2.0 * t).sin(),
                0.028 + 1e-3 * (1.0 - t / 0.05).max(-1.0),
            );
            handle_with_tip(middle + DVec3::X * (0.3 * TOOL_LENGTH), DVec3::X)
        };
        let outputs = play(&world, slide, 3000);
        let mut largest: f64 = 0.0;
        for pair in outputs[100..].windows(2) {
            let off = pair[1].wrench.force - DVec3::Z;
            assert!(off.length() < 2e-4, "{off}");
            largest = largest.max((pair[1].wrench.torque - pair[0].wrench.torque).length());
        }
        assert!(
            largest <= 1e-3,
            "{segments} segments: torque step {largest} N·m"
        );
        // Lever of the patch centre: the overlap of rod and face along x, seen from the handle.
        let last = outputs.last().expect("ticks");
        let handle = last.world_from_haptic.translation;
        let centre = 0.5 * (handle.x.max(-0.05) + (handle.x + TOOL_LENGTH).min(0.05));
        let expected = -(centre - handle.x) * last.wrench.force.z;
        assert!(
            (last.wrench.torque.y - expected).abs() < 1e-6,
            "{}",
            last.wrench.torque
        );
    }
}

#[test]
fn one_plane_moves_the_tool_by_the_tangential_part_of_the_hand() {
    let world = constrained(Setting::Box, ToolKind::Rod, 1);
    let slide = |t: f64| {
        let middle = DVec3::new(0.1 * t, -0.05 * t, 0.025 + 3e-3 - 0.2 * t * t);
        handle_with_tip(middle, DVec3::X)
    };
    for pair in play(&world, slide, 150)[1..].windows(2) {
        let normal = DVec3::Z;
        let m = pair[1].world_from_haptic.translation - pair[0].world_from_haptic.translation;
        let c = m - m.dot(normal) * normal;
        let moved = pair[1].world_from_visual.translation - pair[0].world_from_visual.translation;
        assert!((moved - c).length() < 1e-15, "{moved} against {c}");
    }
}

#[test]
fn a_tool_started_in_overlap_leaves_at_once_and_its_force_rises_from_zero() {
    for setting in [Setting::Box, Setting::Corner, Setting::LatitudeLongitude] {
        for segments in [1, 10] {
            let world = constrained(setting, ToolKind::Rod, segments);
            let objects = setting.objects();
            let top = objects[0].world_from_object.translation.z + objects[0].shape.bounds().max.z;
            // 2 mm deep along the whole shaft, the tip also 2 mm in the corner's wall.
            let tip = DVec3::new(-0.052, 0.0, top + 3e-3 - 2e-3);
            let pose = handle_with_tip(tip, -DVec3::X);
            let mut state = State::new(&world, pose);
            let input = TickInput {
                world_from_haptic: pose,
            };
            let mut last = 0.0;
            for index in 0..1000 {
                let output = tick(&world, &mut state, &input, PERIOD);
                assert!(
                    visual_penetration(&world, &state) <= 1e-9,
                    "{setting:?} tick {index}"
                );
                let force = output.wrench.force.length();
                assert!(
                    force - last <= 0.02,
                    "{setting:?} tick {index}: {last} to {force} N"
                );
                last = force;
            }
            assert!(last > 1.9, "{setting:?}: the force arrives, {last} N");
        }
    }
}

#[test]
fn the_normal_force_of_a_damped_coupling_never_pulls() {
    for setting in [Setting::Box, Setting::LatitudeLongitude, Setting::Corner] {
        let world = World::new(WorldDescription {
            tool: ToolKind::Rod.tool(1),
            objects: setting.objects(),
            coupling: VirtualCoupling {
                linear_damping: 20.0,
                ..VirtualCoupling::default()
            },
            method: Method::Constrained,
        })
        .expect("valid");
        let mut hand = RandomHand::new(3, DVec3::splat(0.045));
        let mut state = State::new(&world, hand.pose());
        let mut force = DVec3::ZERO;
        let mut contact_ticks = 0;
        for index in 0..10_000 {
            let input = TickInput {
                world_from_haptic: hand.advance(force, PERIOD),
            };
            let output = tick(&world, &mut state, &input, PERIOD);
            force = output.wrench.force;
            if let (Some(contact), 1) = (output.contact, output.contacts) {
                contact_ticks += 1;
                let normal_force = force.dot(contact.normal);
                assert!(
                    normal_force >= -1e-12,
                    "{setting:?} tick {index}: {normal_force} N"
                );
            }
            assert!(
                visual_penetration(&world, &state) <= 1e-9,
                "{setting:?} tick {index}"
            );
        }
        assert!(contact_ticks > 2000, "{setting:?}: {contact_ticks}");
    }
}

#[test]
fn the_same_hand_gives_the_same_bytes() {
    let bytes = || {
        let world = constrained(Setting::Corner, ToolKind::Cone, 10);
        let mut hand = RandomHand::new(11, DVec3::splat(0.05));
        let mut state = State::new(&world, hand.pose());
        let mut force = DVec3::ZERO;
        let mut bytes = Vec::new();
        for _ in 0..3000 {
            let input = TickInput {
                world_from_haptic: hand.advance(force, PERIOD),
            };
            let output = tick(&world, &mut state, &input, PERIOD);
            force = output.wrench.force;
            for v in [
                force,
                output.wrench.torque,
                output.world_from_visual.translation,
            ] {
                bytes.extend(v.to_array().iter().flat_map(|x| x.to_le_bytes()));
            }
        }
        bytes
    };
    assert_eq!(bytes(), bytes());
}
