//! The tick's own arithmetic: spring, damper, ramp, bad input, refused worlds.

use glam::{DQuat, DVec3};
use pliant_contact::{PaperParameters, SKIN};
use pliant_mesh::{ConvexMesh, generate};
use pliant_sim::{
    Method, Object, State, TickInput, TickOutput, Tool, VirtualCoupling, World, WorldDescription,
    WorldError, tick,
};
use pliant_spatial::Pose;

const DT: f64 = 1e-3;

fn block(half: DVec3) -> ConvexMesh {
    let mesh = generate::cuboid(half).expect("positive sizes");
    ConvexMesh::from_triangles(&mesh).expect("a box is convex")
}

/// A rod of 100 × 6 × 6 mm about its middle over a table with its top at z = 0.
fn description() -> WorldDescription {
    WorldDescription {
        tool: Tool {
            segments: vec![block(DVec3::new(0.05, 0.003, 0.003))],
        },
        objects: vec![Object {
            name: "table".to_owned(),
            shape: block(DVec3::new(0.1, 0.1, 0.01)),
            world_from_object: Pose::from_translation(DVec3::new(0.0, 0.0, -0.01)),
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    }
}

fn damped(linear_damping: f64) -> World {
    let mut description = description();
    description.coupling.linear_damping = linear_damping;
    World::new(description).expect("valid")
}

/// The rod's underside at height `z` [m].
fn at(z: f64) -> Pose {
    Pose::from_translation(DVec3::Z * (z + 0.003))
}

fn step(world: &World, state: &mut State, pose: Pose) -> TickOutput {
    let input = TickInput {
        world_from_haptic: pose,
    };
    tick(world, state, &input, DT)
}

#[test]
fn force_energy_and_depth_are_those_of_the_spring() {
    let world = damped(0.0);
    let mut state = State::new(&world, at(1e-3));
    let output = step(&world, &mut state, at(-2e-3));
    let depth = 2e-3 + SKIN;
    assert!((output.penetration_of_haptic - depth).abs() < 1e-15);
    assert!((output.wrench.force - DVec3::Z * 1000.0 * depth).length() < 1e-12);
    assert!((output.coupling_energy - 0.5 * 1000.0 * depth * depth).abs() < 1e-15);
    assert_eq!(output.contacts, 1);
}

/// Free of contact, the offset left by a press decays by b/(k Δt + b) a tick (contact.14), and so does the force.
#[test]
fn a_damped_spring_relaxes_at_its_own_rate_after_release() {
    let (k, b) = (1000.0, 20.0);
    let world = damped(b);
    let mut state = State::new(&world, at(1e-3));
    for _ in 0..2000 {
        step(&world, &mut state, at(-5e-3));
    }
    let mut last = step(&world, &mut state, at(20e-3));
    assert!(last.contacts == 0 && last.penetration_of_haptic > 4e-3);
    for _ in 0..50 {
        let next = step(&world, &mut state, at(20e-3));
        let ratio = next.wrench.force.length() / last.wrench.force.length();
        assert!((ratio - b / (k * DT + b)).abs() < 1e-9, "{ratio}");
        last = next;
    }
}

#[test]
fn a_start_inside_ramps_the_force_over_half_a_second() {
    let world = damped(0.0);
    let mut state = State::new(&world, at(-4e-3));
    for index in 0..1000 {
        let output = step(&world, &mut state, at(-4e-3));
        let expected = 1000.0 * (4e-3 + SKIN) * (f64::from(index) * DT / 0.5).min(1.0);
        assert!(
            (output.wrench.force.z - expected).abs() < 1e-9,
            "tick {index}"
        );
    }
}

/// Poses no device should send: the last good one stands in, and what follows is untouched.
#[test]
fn poses_that_are_no_placements_are_ignored() {
    for method in [
        Method::Constrained,
        Method::Paper(PaperParameters::default()),
    ] {
        for damping in [0.0, 20.0] {
            let mut description = description();
            description.coupling.linear_damping = damping;
            description.method = method;
            let world = World::new(description).expect("valid");
            let bad = [
                Pose::from_translation(DVec3::NAN),
                Pose::from_translation(DVec3::X * f64::INFINITY),
                Pose::from_rotation(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0)),
                Pose::from_rotation(DQuat::from_xyzw(0.0, 0.0, 0.0, 0.5)),
                Pose::from_rotation(DQuat::from_xyzw(f64::NAN, 0.0, 0.0, 1.0)),
            ];
            for pose in bad {
                // As the very first pose ...
                let mut state = State::new(&world, pose);
                assert!(step(&world, &mut state, pose).wrench.is_finite());
                let first = step(&world, &mut state, at(2e-3));
                assert_eq!(first.wrench.force, DVec3::ZERO);
                // ... and in contact.
                let before = step(&world, &mut state, at(-2e-3));
                let during = step(&world, &mut state, pose);
                assert_eq!(during.world_from_haptic, before.world_from_haptic);
                assert!(
                    during.wrench.is_finite() && during.wrench.force.z > 1.5,
                    "{method:?} {damping} {pose:?}: {}",
                    during.wrench.force
                );
            }
        }
    }
}

#[test]
fn a_period_that_is_no_time_changes_nothing() {
    let world = damped(20.0);
    let mut state = State::new(&world, at(1e-3));
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let input = TickInput {
            world_from_haptic: at(-2e-3),
        };
        let output = tick(&world, &mut state, &input, dt);
        assert!(output.wrench.is_finite(), "{dt}");
    }
    let output = step(&world, &mut state, at(-2e-3));
    assert!((output.wrench.force.z - 2.0).abs() < 1e-3);
}

fn refuse(change: impl FnOnce(&mut WorldDescription)) -> WorldError {
    let mut description = description();
    change(&mut description);
    World::new(description).expect_err("out of range")
}

#[test]
fn couplings_out_of_range_are_refused_by_name() {
    type Change = fn(&mut VirtualCoupling);
    let cases: [(&str, Change); 5] = [
        ("linear_stiffness", |c| c.linear_stiffness = 0.0),
        ("linear_stiffness", |c| c.linear_stiffness = f64::NAN),
        ("angular_stiffness", |c| c.angular_stiffness = 2.0),
        ("linear_damping", |c| c.linear_damping = -1.0),
        ("angular_damping", |c| c.angular_damping = f64::INFINITY),
    ];
    for (expected, change) in cases {
        let error = refuse(|d| change(&mut d.coupling));
        assert!(
            matches!(error, WorldError::Coupling { name, .. } if name == expected),
            "{error}"
        );
    }
}

#[test]
fn tools_objects_and_methods_out_of_range_are_refused() {
    assert_eq!(refuse(|d| d.tool.segments.clear()), WorldError::NoSegments);
    for (edge_width, detection_interval, expected) in
        [(-1e-4, 1, "edge_width"), (1e-4, 0, "detection_interval")]
    {
        let parameters = PaperParameters {
            edge_width,
            detection_interval,
        };
        let error = refuse(|d| d.method = Method::Paper(parameters));
        assert!(
            matches!(error, WorldError::Paper { name, .. } if name == expected),
            "{error}"
        );
    }
    let error = refuse(|d| d.objects[0].shading_threshold = Some(0.0));
    assert!(matches!(error, WorldError::Shading { .. }), "{error}");
    let error = refuse(|d| d.objects[0].world_from_object.rotation = DQuat::IDENTITY * 2.0);
    assert!(error.to_string().contains("\"table\""), "{error}");
}

#[test]
fn refused_numbers_are_printed_with_exponents() {
    for (refused, written) in [(1e-300, "is 1e-300;"), (1e300, "is 1e300;")] {
        let error = refuse(|d| d.coupling.angular_stiffness = refused).to_string();
        assert!(error.contains(written) && error.len() < 160, "{error}");
        let error = refuse(|d| d.coupling.linear_damping = -refused).to_string();
        assert!(error.contains(&written.replace("is ", "is -")), "{error}");
    }
    let error = refuse(|d| d.objects[0].shading_threshold = Some(1e300)).to_string();
    assert!(error.contains("of 1e300 rad"), "{error}");
    let parameters = PaperParameters {
        edge_width: -1e-300,
        detection_interval: 1,
    };
    let error = refuse(|d| d.method = Method::Paper(parameters)).to_string();
    assert!(error.contains("is -1e-300;"), "{error}");
}
