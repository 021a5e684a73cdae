//! The force: its steps, its shading, its tangential part, its damping.

use glam::DVec3;
use pliant_mesh::HalfEdgeMesh;
use pliant_sim::{
    Method, State, TickInput, TickOutput, VirtualCoupling, World, WorldDescription, tick,
    visual_penetration,
};
use pliant_spatial::{Pose, rotation_vector};
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind, handle_with_tip};
use pliant_tests::campaign::PERIOD;
use pliant_tests::hand::RandomHand;
use pliant_tests::motion::{play, shaft_slide, tip_slide};

use crate::{K, constrained, contact_share};

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

/// The constrained world of a setting whose objects are shaded across edges below 0.2 rad.
fn shaded(setting: Setting, kind: ToolKind) -> World {
    let mut objects = setting.objects();
    for object in &mut objects {
        object.shading_threshold = Some(0.2);
    }
    World::new(WorldDescription {
        tool: kind.tool(1),
        objects,
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })
    .expect("valid")
}

#[test]
fn a_shaded_pointed_tool_steps_by_less_than_a_twentieth_newton() {
    let shaded = shaded(Setting::LatitudeLongitude, ToolKind::Cone);
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

/// Every vertex of a box has edges of 90°: normals of none are interpolated, whatever the hand does.
#[test]
fn shading_leaves_the_force_of_a_box_alone() {
    for kind in [ToolKind::Rod, ToolKind::Cone] {
        let plain = constrained(Setting::Box, kind, 1);
        let shaded = shaded(Setting::Box, kind);
        let mut hand = RandomHand::new(13, DVec3::new(0.055, 0.055, 0.03));
        let mut states = (
            State::new(&plain, hand.pose()),
            State::new(&shaded, hand.pose()),
        );
        let mut force = DVec3::ZERO;
        let mut contact_ticks = 0;
        for index in 0..6000 {
            let input = TickInput {
                world_from_haptic: hand.advance(force, PERIOD),
            };
            let p = tick(&plain, &mut states.0, &input, PERIOD);
            let s = tick(&shaded, &mut states.1, &input, PERIOD);
            force = p.wrench.force;
            contact_ticks += u32::from(p.contacts > 0);
            assert_eq!(p.world_from_visual, s.world_from_visual, "tick {index}");
            // Taking apart and putting together length and direction rounds.
            let apart = (p.wrench.force - s.wrench.force).length();
            assert!(
                apart <= 1e-15 * force.length(),
                "{kind:?} tick {index}: {apart:e} N"
            );
        }
        assert!(contact_ticks > 2000, "{kind:?}: {contact_ticks}");
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
