//! Starts inside objects.

use glam::DVec3;
use pliant_contact::SKIN;
use pliant_sim::{State, TickInput, tick, visual_penetration};
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind, handle_with_tip};
use pliant_tests::campaign::PERIOD;

use crate::constrained;

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

/// A rod standing through the box in ten segments: the upper ones have their shortest way out upwards, the lower ones downwards. Segment by
/// segment these exits exclude each other and the tool stays inside for ever; one exit for all leads out, here over 75 mm. The uncut rod
/// leaves sideways, over 53 mm.
#[test]
fn a_rod_through_the_box_leaves_along_one_normal() {
    for (segments, farthest) in [(1, 0.053), (10, 0.075)] {
        let world = constrained(Setting::Box, ToolKind::Rod, segments);
        let pose = handle_with_tip(DVec3::Z * (0.05 - TOOL_LENGTH), -DVec3::Z);
        let mut state = State::new(&world, pose);
        assert!(state.constrained().expect("method").started_inside());
        let input = TickInput {
            world_from_haptic: pose,
        };
        let output = tick(&world, &mut state, &input, PERIOD);
        assert!(visual_penetration(&world, &state) <= 1e-9);
        assert!(output.contacts > 0 && !output.held);
        let way = output.world_from_visual.translation - pose.translation;
        let (along, length) = (way.abs().max_element(), way.length());
        assert!(
            length - along < 1e-12,
            "{way} is along no normal of the box"
        );
        // 53 mm, half the box and half the rod sideways, is the least there is.
        assert!(
            (0.053..=farthest + 2.0 * SKIN).contains(&along),
            "{segments} segments: {way} m out"
        );
    }
}
