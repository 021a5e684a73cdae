//! Beams of whatever numbers come: a typed error, or a beam all of whose numbers are some.

use glam::DVec3;
use pliant_beam::{
    Beam, BeamSpec, Division, Material, Profile, Rest, Section, Shape, Shear, stiffness_12,
};
use proptest::prelude::{ProptestConfig, Strategy, any, prop, prop_assert, prop_oneof, proptest};
use proptest::test_runner::RngSeed;

fn number() -> impl Strategy<Value = f64> {
    let power = |exponent: f64| 10.0_f64.powf(exponent);
    prop_oneof![
        20 => (-8.0..8.0_f64).prop_map(power),
        2 => (-320.0..308.0_f64).prop_map(power),
        1 => any::<f64>(),
        1 => -1e3..1e3_f64,
    ]
}

fn any_shape() -> impl Strategy<Value = Shape> {
    (0..6, prop::array::uniform8(number())).prop_map(|(kind, m)| match kind {
        0 => Shape::Circle { diameter: m[0] },
        1 => Shape::Tube {
            outer: m[0],
            inner: m[1],
        },
        2 => Shape::Rectangle {
            width_y: m[0],
            width_z: m[1],
        },
        3 => Shape::Square { diameter: m[0] },
        4 => Shape::Triangle { diameter: m[0] },
        _ => Shape::General {
            section: Section {
                area: m[0],
                second_moment_y: m[1],
                second_moment_z: m[2],
                torsion_constant: m[3],
                shear_area_y: m[4],
                shear_area_z: m[5],
            },
            reach_y: m[6],
            reach_z: m[7],
        },
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, rng_seed: RngSeed::Fixed(20_041), ..ProptestConfig::default() })]

    /// Whatever numbers come: a typed error, or a beam all of whose stiffnesses are numbers.
    #[test]
    fn no_numbers_make_a_beam_without_numbers(
        length in number(),
        shapes in (any_shape(), any_shape()),
        stations in (number(), number()),
        material in (number(), number()),
        curvature in prop::array::uniform3(number()),
        kind in 0..12,
    ) {
        let profile = match kind % 3 {
            0 => Profile::Uniform(shapes.0),
            1 => Profile::Linear { root: shapes.0, tip: shapes.1 },
            _ => Profile::Table(vec![(stations.0, shapes.0), (stations.1, shapes.1)]),
        };
        let rest = match kind / 3 {
            0 => Rest::Straight,
            1 | 2 => Rest::Curved(DVec3::from_array(curvature)),
            _ => Rest::Table(vec![(stations.0, DVec3::from_array(curvature))]),
        };
        let spec = BeamSpec {
            length,
            profile,
            material: Material {
                young_modulus: material.0,
                shear_modulus: material.1,
                density: 0.0,
                strain_limit: 1.0,
            },
            division: Division::Equal(4),
            rest,
            shear: Shear::Flexible,
        };
        if let Ok(beam) = Beam::new(spec.clone()) {
            for element in beam.elements() {
                let all = stiffness_12(element);
                prop_assert!(all.iter().flatten().all(|value| value.is_finite()), "{spec:?}");
                prop_assert!(element.rest.is_finite() && element.arc > 0.0, "{spec:?}");
            }
        }
    }
}
