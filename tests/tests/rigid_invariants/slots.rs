//! Two objects that leave the tool no way out: a slot narrower than the turned tool.

use std::path::Path;

use glam::{DQuat, DVec3};
use pliant_scene::{Disk, Scene};
use pliant_sim::{State, TickInput, TickOutput, tick, visual_penetration};
use pliant_spatial::rotation_vector;
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind, handle_with_tip};
use pliant_tests::campaign::PERIOD;
use pliant_tests::motion::play;

use crate::{K, constrained};

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

/// The haptic orientation is out of reach by far: the turn is halved until it fits, and what fits is taken.
#[test]
fn a_turn_far_past_fit_within_one_tick_is_taken_in_part() {
    for segments in [1, 10] {
        let slot = constrained(Setting::Slot, ToolKind::Rod, segments);
        // 2 mm towards the right wall, of which 1 mm is free: 1 N.
        let at = |angle: f64| {
            let axis = DQuat::from_rotation_z(angle) * DVec3::X;
            handle_with_tip(DVec3::Y * 2e-3 + axis * (0.5 * TOOL_LENGTH), axis)
        };
        let mut state = State::new(&slot, handle_with_tip(DVec3::X * 0.05, DVec3::X));
        let mut advance = |angle: f64| {
            let input = TickInput {
                world_from_haptic: at(angle),
            };
            let output = tick(&slot, &mut state, &input, PERIOD);
            assert!(visual_penetration(&slot, &state) <= 1e-9);
            output
        };
        let before = advance(0.0);
        assert!(before.contacts > 0 && !before.held);
        let after = advance(0.5);
        assert!(after.held && after.contacts > 0, "{after:?}");
        let turned = rotation_vector(after.world_from_visual.rotation);
        // Half the turn, a quarter ... a 32nd: the largest of them below the 0.02 rad that fit.
        assert!(
            (turned - DVec3::Z * (0.5 / 32.0)).length() < 1e-9,
            "turned by {turned} rad"
        );
        // The handle lies 0.05 m from the middle about which the hand turned.
        let force = after.wrench.force.length();
        assert!(force <= 1.0 + K * 0.05 * 0.5, "{force} N");
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
        double_and_held > 30,
        "{double_and_held} ticks held by both walls"
    );
}
