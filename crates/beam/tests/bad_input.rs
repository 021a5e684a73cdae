//! Faulty beams are refused with the name of the field at fault, and never with a panic, a hang or numbers that are none.

use glam::DVec3;
use pliant_beam::{
    AnchoredLoads, Beam, BeamError, BeamSpec, Corotational, Division, Load, Loading, MOST_ELEMENTS,
    Material, Profile, Rest, Section, Settings, Shape, Shear,
};

const LENGTH: f64 = 0.1;

fn circle(diameter: f64) -> Shape {
    Shape::Circle { diameter }
}

fn sound() -> BeamSpec {
    BeamSpec {
        length: LENGTH,
        profile: Profile::Uniform(circle(1e-3)),
        material: Material {
            density: 7900.0,
            strain_limit: 0.01,
            ..Material::isotropic(200e9, 0.3)
        },
        division: Division::Equal(4),
        rest: Rest::Straight,
        shear: Shear::Flexible,
    }
}

/// A change of one number, by the name of its field.
type Change = (&'static str, fn(&mut BeamSpec, f64));

fn refusal(spec: BeamSpec) -> BeamError {
    match Beam::new(spec) {
        Err(error) => error,
        // Not `expect_err`, which would print a beam of any size.
        Ok(_) => panic!("a fault was not found"),
    }
}

fn general(fault: usize, value: f64) -> Shape {
    let mut all = [1e-6, 1e-13, 1e-13, 1e-13, 1e-6, 1e-6, 1e-3, 1e-3];
    all[fault] = value;
    let [
        area,
        second_moment_y,
        second_moment_z,
        torsion_constant,
        shear_area_y,
        shear_area_z,
        reach_y,
        reach_z,
    ] = all;
    Shape::General {
        section: Section {
            area,
            second_moment_y,
            second_moment_z,
            torsion_constant,
            shear_area_y,
            shear_area_z,
        },
        reach_y,
        reach_z,
    }
}

fn assert_names(error: &BeamError, field: &str, value: f64) {
    let BeamError::Value {
        field: own,
        value: given,
        ..
    } = error
    else {
        panic!("{field} = {value}: {error}");
    };
    assert_eq!(own, field, "{error}");
    assert!(
        given.total_cmp(&value).is_eq() || (given.is_nan() && value.is_nan()),
        "{error}"
    );
    assert!(error.to_string().starts_with(field), "{error}");
}

/// Numbers that must be finite and above zero.
const POSITIVE: [Change; 15] = [
    ("length", |spec, v| spec.length = v),
    ("material.young_modulus", |spec, v| {
        spec.material.young_modulus = v;
    }),
    ("material.shear_modulus", |spec, v| {
        spec.material.shear_modulus = v;
    }),
    ("material.strain_limit", |spec, v| {
        spec.material.strain_limit = v;
    }),
    ("profile.diameter", |spec, v| {
        spec.profile = Profile::Uniform(circle(v));
    }),
    ("profile.diameter", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Square { diameter: v });
    }),
    ("profile.diameter", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Triangle { diameter: v });
    }),
    ("profile.outer", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Tube {
            outer: v,
            inner: 1e-3,
        });
    }),
    ("profile.inner", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Tube {
            outer: 1e-3,
            inner: v,
        });
    }),
    ("profile.width_y", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Rectangle {
            width_y: v,
            width_z: 1e-3,
        });
    }),
    ("profile.width_z", |spec, v| {
        spec.profile = Profile::Uniform(Shape::Rectangle {
            width_y: 1e-3,
            width_z: v,
        });
    }),
    ("profile.root.diameter", |spec, v| {
        spec.profile = Profile::Linear {
            root: circle(v),
            tip: circle(1e-3),
        };
    }),
    // A needle that ends in a point: its tip has no stiffness.
    ("profile.tip.diameter", |spec, v| {
        spec.profile = Profile::Linear {
            root: circle(1e-3),
            tip: circle(v),
        };
    }),
    ("profile[1].diameter", |spec, v| {
        spec.profile = Profile::Table(vec![(0.0, circle(1e-3)), (LENGTH, circle(v))]);
    }),
    ("division[2]", |spec, v| {
        spec.division = Division::Lengths(vec![0.02, 0.05, v, 0.03]);
    }),
];

/// Numbers that must be finite.
const FINITE: [Change; 8] = [
    ("material.density", |spec, v| spec.material.density = v),
    ("profile[1].station", |spec, v| {
        spec.profile = Profile::Table(vec![(0.0, circle(1e-3)), (v, circle(2e-3))]);
    }),
    ("rest (twist)", |spec, v| {
        spec.rest = Rest::Curved(DVec3::X * v);
    }),
    ("rest (about y)", |spec, v| {
        spec.rest = Rest::Curved(DVec3::new(1.0, v, 1.0));
    }),
    ("rest (about z)", |spec, v| {
        spec.rest = Rest::Curved(DVec3::new(1.0, 1.0, v));
    }),
    ("rest[0].station", |spec, v| {
        spec.rest = Rest::Table(vec![(v, DVec3::Y)]);
    }),
    ("rest[1].station", |spec, v| {
        spec.rest = Rest::Table(vec![(0.0, DVec3::Y), (v, DVec3::Z)]);
    }),
    ("rest[1] (about z)", |spec, v| {
        spec.rest = Rest::Table(vec![(0.0, DVec3::Y), (0.05, DVec3::new(1.0, 1.0, v))]);
    }),
];

#[test]
fn every_field_is_named_when_it_is_no_number_or_infinite() {
    for (field, change) in POSITIVE.iter().chain(&FINITE) {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut spec = sound();
            change(&mut spec, value);
            // What is left of −∞ y is NaN in x.
            match refusal(spec) {
                BeamError::Value {
                    field: own, value, ..
                } if *field == "rest (twist)" => {
                    assert!(own.starts_with("rest (") && !value.is_finite(), "{own}");
                }
                error => assert_names(&error, field, value),
            }
        }
    }
}

#[test]
fn every_field_is_named_when_it_is_zero_or_negative() {
    for (field, change) in POSITIVE {
        for value in [0.0, -1e-3] {
            let mut spec = sound();
            change(&mut spec, value);
            assert_names(&refusal(spec), field, value);
        }
    }
    let mut spec = sound();
    spec.material.density = -1.0;
    assert_names(&refusal(spec), "material.density", -1.0);
}

#[test]
fn every_integral_of_a_general_section_is_named() {
    let names = [
        "area",
        "second_moment_y",
        "second_moment_z",
        "torsion_constant",
        "shear_area_y",
        "shear_area_z",
    ];
    let names = names.map(|name| format!("profile.section.{name}"));
    let reaches = ["profile.reach_y", "profile.reach_z"].map(str::to_owned);
    for (fault, field) in names.iter().chain(&reaches).enumerate() {
        for value in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
            let mut spec = sound();
            spec.profile = Profile::Uniform(general(fault, value));
            assert_names(&refusal(spec), field, value);
        }
    }
}

#[test]
fn poisson_ratios_beyond_what_matter_can_have_are_named() {
    // −1 makes the shear modulus infinite, less makes it negative.
    for ratio in [-1.0, -1.5, f64::NAN, f64::INFINITY] {
        let mut spec = sound();
        spec.material = Material {
            strain_limit: 0.01,
            ..Material::isotropic(200e9, ratio)
        };
        let shear_modulus = spec.material.shear_modulus;
        assert_names(&refusal(spec), "material.shear_modulus", shear_modulus);
    }
}

#[test]
fn tubes_without_a_wall_are_refused() {
    for inner in [1e-3, 2e-3] {
        let tube = Shape::Tube { outer: 1e-3, inner };
        let mut spec = sound();
        spec.profile = Profile::Uniform(tube);
        assert_names(&refusal(spec), "profile.inner", inner);
        let mut spec = sound();
        spec.profile = Profile::Table(vec![(0.0, tube)]);
        assert_names(&refusal(spec), "profile[0].inner", inner);
    }
}

#[test]
fn too_many_and_too_few_are_counted_before_anything_is_made() {
    for division in [
        Division::Equal(0),
        Division::Equal(MOST_ELEMENTS + 1),
        Division::Equal(1_000_000),
        Division::Equal(usize::MAX),
        Division::Lengths(Vec::new()),
        Division::Lengths(vec![1e-7; 1_000_000]),
    ] {
        let mut spec = sound();
        spec.division = division;
        let error = refusal(spec);
        let BeamError::Count { field, most, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!((*field, *most), ("division", MOST_ELEMENTS));
    }
    for rows in [0, 1_000_000] {
        let mut spec = sound();
        spec.profile = Profile::Table(vec![(0.0, circle(1e-3)); rows]);
        let error = refusal(spec);
        assert!(
            matches!(
                error,
                BeamError::Count {
                    field: "profile",
                    ..
                }
            ),
            "{error}"
        );
    }
}

/// Every element looks through all rows: without a limit a million of them took minutes.
#[test]
fn a_rest_shape_of_a_million_rows_is_refused() {
    let mut spec = sound();
    spec.rest = Rest::Table(vec![(0.0, DVec3::Y); 1_000_000]);
    let error = refusal(spec);
    assert!(
        matches!(error, BeamError::Count { field: "rest", .. }),
        "{error}"
    );
}

#[test]
fn tables_must_ascend() {
    let mut spec = sound();
    spec.profile = Profile::Table(vec![
        (0.0, circle(1e-3)),
        (0.05, circle(1e-3)),
        (0.04, circle(1e-3)),
    ]);
    assert_names(&refusal(spec), "profile[2].station", 0.04);
    let mut spec = sound();
    spec.rest = Rest::Table(vec![(0.05, DVec3::Y), (0.04, DVec3::Z)]);
    assert_names(&refusal(spec), "rest[1].station", 0.04);
}

#[test]
fn kinds_of_section_change_by_steps_only() {
    let tube = Shape::Tube {
        outer: 1e-3,
        inner: 0.5e-3,
    };
    let mut spec = sound();
    spec.profile = Profile::Linear {
        root: circle(1e-3),
        tip: tube,
    };
    let error = refusal(spec);
    assert!(
        matches!(&error, BeamError::Mixed { field, .. } if field == "profile.tip"),
        "{error}"
    );
    let mut spec = sound();
    spec.profile = Profile::Table(vec![(0.0, circle(1e-3)), (0.05, tube)]);
    let error = refusal(spec);
    assert!(
        matches!(&error, BeamError::Mixed { field, .. } if field == "profile[1]"),
        "{error}"
    );
    let mut spec = sound();
    spec.profile = Profile::Table(vec![
        (0.0, circle(1e-3)),
        (0.05, circle(1e-3)),
        (0.05, tube),
    ]);
    assert!(Beam::new(spec).is_ok());
}

#[test]
fn parts_must_add_up_to_the_length() {
    let mut spec = sound();
    spec.division = Division::Lengths(vec![0.05, 0.04]);
    assert_names(&refusal(spec), "division (sum)", 0.05 + 0.04);
}

/// Parts that add up but for rounding: the last one shorter than what the sum is off by became an element of negative length.
#[test]
fn no_element_runs_backwards() {
    let mut spec = sound();
    spec.division = Division::Lengths(vec![LENGTH * (1.0 + 5e-10), LENGTH * 1e-12]);
    spec.shear = Shear::Rigid;
    let beam = Beam::new(spec).unwrap();
    assert!(beam.elements().iter().all(|element| element.arc > 0.0));
}

#[test]
fn an_element_that_goes_round_is_refused() {
    for turn in [5.0, std::f64::consts::TAU, 1e3, 1e300, f64::MAX] {
        let mut spec = sound();
        spec.rest = Rest::Curved(DVec3::Z * (turn * 4.0 / LENGTH));
        let error = refusal(spec);
        assert!(
            matches!(&error, BeamError::Value { field, .. } if field.starts_with("division (") || field.starts_with("rest (")),
            "{error}"
        );
    }
}

/// Sections half a turn apart have no direction halfway between: the axes of such an element were no numbers.
#[test]
fn an_element_twisted_by_half_a_turn_is_refused() {
    let mut spec = sound();
    spec.rest = Rest::Curved(DVec3::X * (std::f64::consts::PI * 4.0 / LENGTH));
    let error = refusal(spec);
    assert!(
        matches!(&error, BeamError::Value { field, .. } if field.contains("twist")),
        "{error}"
    );
}

/// Fourth powers of such diameters are no numbers, or none but zero.
#[test]
fn sections_beyond_the_range_of_numbers_are_refused() {
    for diameter in [1e-100, 1e-300, 1e100, 1e300] {
        let mut spec = sound();
        spec.profile = Profile::Uniform(circle(diameter));
        let error = refusal(spec);
        assert!(
            matches!(&error, BeamError::Value { field, .. } if field.contains("stiffness")),
            "{error}"
        );
    }
}

#[test]
fn a_load_that_is_no_number_is_reported_and_leaves_the_beam_at_rest() {
    let fault = |value: f64| {
        [
            Load {
                s: LENGTH,
                force: DVec3::Y * value,
                moment: DVec3::ZERO,
            },
            Load {
                s: 0.6 * LENGTH,
                force: DVec3::ZERO,
                moment: DVec3::Z * value,
            },
            Load {
                s: value,
                force: DVec3::Y,
                moment: DVec3::ZERO,
            },
        ]
    };
    for load in [fault(f64::NAN), fault(f64::INFINITY)]
        .into_iter()
        .flatten()
    {
        // A position beyond the end counts as the end.
        if load.s == f64::INFINITY {
            continue;
        }
        for follower in [&[][..], &[load]] {
            let beam = Beam::new(sound()).unwrap();
            let points = [load];
            let dead = if follower.is_empty() {
                &points[..]
            } else {
                &[]
            };
            let loading = Loading {
                points: dead,
                line: DVec3::ZERO,
            };
            let loads = AnchoredLoads::new(&beam, &loading, follower);
            let mut far = Corotational::new(beam);
            for outcome in [
                far.iterate(&loads, &Settings::default()),
                far.solve(&loads, &Settings::default()),
            ] {
                assert!(
                    !outcome.converged && outcome.held < 1.0,
                    "{load:?}: {outcome:?}"
                );
            }
            assert!(
                (far.node(4).translation - DVec3::X * LENGTH).length() < 1e-12,
                "{load:?}"
            );
        }
    }
}
