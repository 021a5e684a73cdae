//! The torque about the handle against closed forms.

use glam::DVec3;
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind, handle_with_tip};
use pliant_tests::motion::play;

use crate::{K, constrained};

/// Weight of the regularisation that divides a push among planes.
const RHO: f64 = 1e-2;

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

/// A rod along the floor, its end against the wall, pressed into both and standing over the edge that ends them at y = 0.1.
///
/// The push has one component along each normal, so both forces are known; so are both patches: rod ∩ floor and rod ∩ wall.
#[test]
fn two_planes_put_their_forces_at_their_patches() {
    let (into_floor, into_wall) = (3e-3, 4e-3);
    let (half, side) = (3e-3, 0.1);
    // The rod's middle plane and how far it lies inside the side: 1 mm leaves a patch of 4 mm, whose middle is 1 mm off the axis.
    for (y, patch_y) in [(0.02, 0.02), (0.099, 0.5 * (0.099 - half + side))] {
        for segments in [1, 10] {
            let corner = constrained(Setting::Corner, ToolKind::Rod, segments);
            // From 1 mm off both.
            let hand = |t: f64| {
                let part = (t / 0.05).min(1.0);
                let depth = |full: f64| full * part - 1e-3 * (1.0 - part);
                let tip = DVec3::new(-0.05 - depth(into_wall), y, half - depth(into_floor));
                handle_with_tip(tip, -DVec3::X)
            };
            let outputs = play(&corner, hand, 100);
            let last = outputs.last().expect("100 ticks");
            let handle = last.world_from_haptic.translation;
            let (floor, wall) = (DVec3::Z * (K * into_floor), DVec3::X * (K * into_wall));
            let floor_patch = DVec3::new(-0.05 + 0.5 * TOOL_LENGTH, patch_y, 0.0);
            let wall_patch = DVec3::new(-0.05, patch_y, half);
            // The skin, 1e-7 m, adds 1e-4 N.
            let force = last.wrench.force;
            assert!((force - floor - wall).length() < 2e-4, "{force}");
            assert_eq!(last.contacts, 2);
            let lever = |patch: DVec3, force: DVec3| (patch - handle).cross(force);
            let expected = lever(floor_patch, floor) + lever(wall_patch, wall);
            let torque = last.wrench.torque;
            // Shares are 1/(1 + ρ) of the forces; the rest acts at the shares' centre, on the line between the patches.
            let between = wall_patch - floor_patch;
            let allowed = RHO * (between.cross(floor).length() + between.cross(wall).length());
            let error = (torque - expected).length();
            assert!(
                error <= allowed,
                "{segments} segments at y = {y}: {torque} N·m, {expected} expected, {error:e} off"
            );
            // The tolerance tells places apart: all force at one patch, or each in the rod's middle plane, is further off.
            let off_axis = DVec3::Y * (y - patch_y);
            let misplaced = off_axis.cross(floor + wall);
            let one_patch = [between.cross(floor), between.cross(wall)];
            for wrong in one_patch.iter().chain((patch_y < y).then_some(&misplaced)) {
                assert!(wrong.length() > 2.0 * allowed, "{wrong}, {allowed}");
            }
            // And exactly, with the part that is moved; a skin's force at the handle's lever is 1e-5 N·m.
            let (f, w) = (floor.length(), wall.length());
            let centre = (floor_patch * f + wall_patch * w) / (f + w);
            let shared = (expected + RHO * lever(centre, floor + wall)) / (1.0 + RHO);
            let error = (torque - shared).length();
            assert!(
                error <= 2e-5,
                "{torque} N·m, {shared} expected, {error:e} off"
            );
        }
    }
}
