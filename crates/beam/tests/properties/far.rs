//! Co-rotational elements: equilibrium of the deflected shape, turned beams, and the limit of small loads.

use glam::{DQuat, DVec3};
use pliant_beam::{
    AnchoredLoads, Beam, BeamSpec, Corotational, Load, Loading, MaterialPoint, Outcome, Profile,
    Rest, Settings, Shape, StiffnessMethod,
};
use proptest::prelude::{TestCaseError, prop_assert, prop_assume, proptest};

use crate::beams::{Draw, any_beam, cases, loads, scaled, unit_force};

const TIGHT: Settings = Settings {
    tolerance: 1e-11,
    most_iterations: 60,
};

fn anchored(beam: &Beam, dead: &[Load], followers: &[Load]) -> AnchoredLoads {
    let loading = Loading {
        points: dead,
        line: DVec3::ZERO,
    };
    AnchoredLoads::new(beam, &loading, followers)
}

fn solved(beam: &Beam, dead: &[Load], followers: &[Load]) -> (Corotational, Outcome) {
    let loads = anchored(beam, dead, followers);
    let mut far = Corotational::new(beam.clone());
    let outcome = far.solve(&loads, &TIGHT);
    (far, outcome)
}

/// Force and moment about the root of loads on a deflected beam; followers turn with their sections.
fn total(far: &Corotational, dead: &[Load], followers: &[Load]) -> [DVec3; 2] {
    let mut sum = [DVec3::ZERO; 2];
    for (load, follows) in dead
        .iter()
        .map(|load| (load, false))
        .chain(followers.iter().map(|load| (load, true)))
    {
        let pose = far.pose(&MaterialPoint::new(far.beam(), load.s, DVec3::ZERO));
        let turn = if follows {
            pose.rotation
        } else {
            DQuat::IDENTITY
        };
        let force = turn * load.force;
        sum[0] += force;
        sum[1] += turn * load.moment + pose.translation.cross(force);
    }
    sum
}

/// The same, round and stout enough for the stretch of its elements not to swallow digits.
fn stout(beam: &Beam) -> BeamSpec {
    let diameter = |share: f64| Shape::Circle {
        diameter: share * beam.length(),
    };
    BeamSpec {
        profile: Profile::Linear {
            root: diameter(0.2),
            tip: diameter(0.15),
        },
        ..beam.spec().clone()
    }
}

/// Largest distance of nodes, by the length, and angle between sections of a beam rolled with its loads and the beam as it was, rolled
/// after.
fn rolled_apart(spec: &BeamSpec, draws: &[Draw], roll: DQuat) -> Result<(f64, f64), TestCaseError> {
    let rest = match &spec.rest {
        Rest::Straight => Rest::Straight,
        Rest::Curved(curvature) => Rest::Curved(roll * *curvature),
        Rest::Table(rows) => Rest::Table(rows.iter().map(|(s, k)| (*s, roll * *k)).collect()),
    };
    let rolled = Beam::new(BeamSpec {
        rest,
        ..spec.clone()
    });
    let (beam, rolled) = (
        Beam::new(spec.clone()).expect("sound"),
        rolled.expect("sound"),
    );
    let loads = scaled(&beam, draws, 0.5);
    let turned: Vec<Load> = loads
        .iter()
        .map(|load| Load {
            s: load.s,
            force: roll * load.force,
            moment: roll * load.moment,
        })
        .collect();
    let (far, outcome) = solved(&beam, &loads, &[]);
    prop_assume!(outcome.converged);
    let (rolled, outcome) = solved(&rolled, &turned, &[]);
    prop_assume!(outcome.converged);
    let mut most = (0.0_f64, 0.0_f64);
    for node in 0..beam.nodes().len() {
        let moved = roll * far.node(node).translation - rolled.node(node).translation;
        let turn = (roll * far.rotation(node)) * (rolled.rotation(node) * roll).inverse();
        most.0 = most.0.max(moved.length() / beam.length());
        most.1 = most.1.max(2.0 * turn.xyz().length());
    }
    Ok(most)
}

proptest! {
    #![proptest_config(cases(150))]

    /// Dead and follower loads, at nodes and between them, on beams bent by them far: the clamp bears them where they now are.
    #[test]
    fn the_root_bears_all_loads_where_they_have_gone(
        beam in any_beam(10),
        dead in loads(),
        followers in loads(),
        size in 0.1..0.7_f64,
    ) {
        let (dead, followers) = (scaled(&beam, &dead, size), scaled(&beam, &followers, size));
        let unit = unit_force(&beam);
        for (dead, followers) in [(&dead[..], &[][..]), (&[], &followers[..]), (&dead, &followers)] {
            let (far, outcome) = solved(&beam, dead, followers);
            prop_assume!(outcome.converged);
            let [force, moment] = total(&far, dead, followers);
            let root = far.root_reaction(&anchored(&beam, dead, followers));
            prop_assert!((root.force + force).length() <= 1e-7 * unit, "{} {force}", root.force);
            prop_assert!(
                (root.moment + moment).length() <= 1e-7 * unit * beam.length(),
                "{} {moment}", root.moment
            );
        }
    }

    /// The same beam rolled about its root, half round: every section here is as it was, so its curvature and loads roll with it.
    #[test]
    fn a_beam_rolled_half_round_answers_rolled(beam in any_beam(10), draws in loads()) {
        let (apart, turned) = rolled_apart(&stout(&beam), &draws, DQuat::from_rotation_x(std::f64::consts::PI))?;
        prop_assert!(apart <= 1e-12 && turned <= 1e-12, "{apart:e} {turned:e}");
    }

    /// Rolled by any angle, a round beam answers the same: an element's axes must not tell one section axis from another.
    #[test]
    fn a_round_beam_rolled_answers_rolled(beam in any_beam(10), draws in loads(), angle in -3.0..3.0_f64) {
        let (apart, turned) = rolled_apart(&stout(&beam), &draws, DQuat::from_rotation_x(angle))?;
        prop_assert!(apart <= 1e-11 && turned <= 1e-11, "{apart:e} {turned:e}");
    }

    /// As loads vanish, the answer becomes the linear one, and what is left falls as their square.
    #[test]
    fn small_loads_are_answered_linearly(beam in any_beam(10), draws in loads()) {
        let length = beam.length();
        let apart = |size: f64| {
            let loads = scaled(&beam, &draws, size);
            let mut linear = StiffnessMethod::new(beam.clone());
            linear.solve(&Loading { points: &loads, line: DVec3::ZERO });
            let (far, outcome) = solved(&beam, &loads, &[]);
            assert!(outcome.converged);
            (0..beam.nodes().len()).map(|node| {
                let moved = far.node(node).translation - beam.nodes()[node].translation;
                (moved - linear.node(node).translation).length() / length
            }).fold(0.0, f64::max)
        };
        let (large, small) = (apart(2e-2), apart(1e-2));
        prop_assert!(small <= 1e-3, "{small:e}");
        prop_assert!(small <= 0.27 * large + 1e-11, "{small:e} of {large:e}");
    }
}
