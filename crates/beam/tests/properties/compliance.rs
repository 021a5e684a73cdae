//! Compliance in closed form: symmetric, and what the stiffness method answers.

use glam::{DMat3, DVec3};
use pliant_beam::{ClosedForm, Load, Loading, Station, StationCompliance, StiffnessMethod};
use proptest::prelude::{prop, prop_assert, proptest};

use crate::beams::{cases, straight};

fn largest(matrix: &DMat3) -> f64 {
    matrix
        .to_cols_array()
        .iter()
        .fold(0.0, |most, value| most.max(value.abs()))
}

/// Both ways, with rotations by the length: W(a, b) = W(b, a)ᵀ.
fn asymmetry(forth: &StationCompliance, back: &StationCompliance, length: f64) -> f64 {
    let own = [
        forth.translation_force - back.translation_force.transpose(),
        (forth.translation_moment - back.rotation_force.transpose()) * length,
        (forth.rotation_force - back.translation_moment.transpose()) * length,
        (forth.rotation_moment - back.rotation_moment.transpose()) * length * length,
    ];
    own.iter().map(largest).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn compliance_is_symmetric(beam in straight(10), places in prop::array::uniform2(0.0..1.0_f64)) {
        let length = beam.length();
        let closed_form = ClosedForm::new(&beam).expect("straight");
        let [a, b] = places.map(|place| closed_form.station(place * length));
        let tip = closed_form.station(length);
        let scale = largest(&tip.compliance(&tip).translation_force);
        prop_assert!(asymmetry(&a.compliance(&b), &b.compliance(&a), length) <= 1e-14 * scale);
        let arms = [DVec3::new(0.0, 0.3, -0.1), DVec3::new(0.0, -0.2, 0.25)].map(|arm| arm * length);
        let forth = a.compliance(&b).between_points(arms[0], arms[1]);
        let back = b.compliance(&a).between_points(arms[1], arms[0]);
        prop_assert!(largest(&(forth - back.transpose())) <= 1e-13 * scale);
    }

    /// A unit of each force and moment at any place, and what every node does.
    #[test]
    fn compliance_is_what_the_stiffness_method_answers(beam in straight(10), place in 0.0..=1.0_f64) {
        let length = beam.length();
        let closed_form = ClosedForm::new(&beam).expect("straight");
        let there = closed_form.station(place * length);
        let tip = closed_form.station(length);
        let scale = largest(&tip.compliance(&tip).translation_force);
        let mut method = StiffnessMethod::new(beam.clone());
        let starts: Vec<f64> = beam.elements().iter().map(|element| element.start).collect();
        for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
            for (force, moment) in [(unit, DVec3::ZERO), (DVec3::ZERO, unit)] {
                let load = Load { s: there.s, force, moment };
                method.solve(&Loading { points: &[load], line: DVec3::ZERO });
                for (node, s) in starts.iter().copied().chain([length]).enumerate() {
                    let w = closed_form.station(s).compliance(&there);
                    let (moved, turned, weight) = if moment == DVec3::ZERO {
                        (w.translation_force.col(axis), w.rotation_force.col(axis), 1.0)
                    } else {
                        (w.translation_moment.col(axis), w.rotation_moment.col(axis), length)
                    };
                    let own = method.node(node);
                    prop_assert!((own.translation - moved).length() * weight <= 1e-9 * scale);
                    prop_assert!((own.rotation - turned).length() * weight * length <= 1e-9 * scale);
                }
            }
        }
    }

    /// A force on a point off the centre line is one on it with a moment, and the point goes where its section takes it.
    #[test]
    fn compliance_of_points_is_of_their_sections(
        beam in straight(6),
        places in prop::array::uniform2(0.0..1.0_f64),
        arms in prop::array::uniform4(-0.1..0.1_f64),
        force in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let length = beam.length();
        let closed_form = ClosedForm::new(&beam).expect("straight");
        let [here, there] = places.map(|place| closed_form.station(place * length));
        let (own, other) = (
            DVec3::new(0.0, arms[0], arms[1]) * length,
            DVec3::new(0.0, arms[2], arms[3]) * length,
        );
        let force = DVec3::from_array(force);
        let load = Load { s: there.s, force, moment: other.cross(force) };
        let section = closed_form.displacement(&here, &Loading { points: &[load], line: DVec3::ZERO });
        let truth = section.translation + section.rotation.cross(own);
        let point = here.compliance(&there).between_points(own, other) * force;
        let scale = largest(&tip_compliance(&closed_form, length).translation_force);
        prop_assert!((point - truth).length() <= 1e-13 * scale);
    }
}

fn tip_compliance(closed_form: &ClosedForm<'_>, length: f64) -> StationCompliance {
    let tip: Station = closed_form.station(length);
    tip.compliance(&tip)
}
