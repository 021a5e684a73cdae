//! Where the visual tool is: the same for one segment and ten, on its side of a plate, the same twice.

use glam::DVec3;
use pliant_sim::{State, TickInput, tick};
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind};
use pliant_tests::campaign::PERIOD;
use pliant_tests::hand::RandomHand;
use pliant_tests::motion::{play, press};

use crate::constrained;

/// Farthest the visual tool of one segment is from that of ten under the same random hand of 6000 ticks [m].
fn apart(setting: Setting, kind: ToolKind, seed: u64) -> f64 {
    let (one, ten) = (
        constrained(setting, kind, 1),
        constrained(setting, kind, 10),
    );
    let mut hand = RandomHand::new(seed, DVec3::splat(0.045));
    let mut states = (State::new(&one, hand.pose()), State::new(&ten, hand.pose()));
    let mut force = DVec3::ZERO;
    let mut contact_ticks = 0;
    let mut apart: f64 = 0.0;
    for _ in 0..6000 {
        let input = TickInput {
            world_from_haptic: hand.advance(force, PERIOD),
        };
        let a = tick(&one, &mut states.0, &input, PERIOD);
        let b = tick(&ten, &mut states.1, &input, PERIOD);
        force = a.wrench.force;
        contact_ticks += u32::from(a.contacts > 0);
        apart = apart.max(
            a.world_from_visual
                .translation
                .distance(b.world_from_visual.translation),
        );
    }
    assert!(contact_ticks > 1500, "{setting:?} {contact_ticks}");
    apart
}

#[test]
fn one_segment_feels_like_ten() {
    for setting in [
        Setting::Box,
        Setting::Hull,
        Setting::LatitudeLongitude,
        Setting::Fibonacci,
    ] {
        for kind in [ToolKind::Rod, ToolKind::Cone] {
            for seed in 0..2 {
                let apart = apart(setting, kind, seed);
                assert!(
                    apart <= 1e-9,
                    "{setting:?} {kind:?} seed {seed}: {apart:e} m apart"
                );
            }
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
