//! Random beams and loads.

use glam::DVec3;
use pliant_beam::{Beam, BeamSpec, Division, Load, Material, Profile, Rest, Section, Shape, Shear};
use proptest::prelude::{Just, ProptestConfig, Strategy, prop, prop_oneof};
use proptest::test_runner::RngSeed;

/// So many cases, the same every time.
pub(crate) fn cases(count: u32) -> ProptestConfig {
    ProptestConfig {
        cases: count,
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(20_042),
        ..ProptestConfig::default()
    }
}

/// Any shape of a kind, about `size` [m] across.
fn shape(kind: u32, size: f64, [a, b]: [f64; 2]) -> Shape {
    match kind {
        0 => Shape::Circle { diameter: size * a },
        1 => Shape::Tube {
            outer: size * a,
            inner: size * a * (0.2 + 0.6 * b / 2.0),
        },
        2 => Shape::Rectangle {
            width_y: size * a,
            width_z: size * b,
        },
        3 => Shape::Square { diameter: size * a },
        4 => Shape::Triangle { diameter: size * a },
        _ => {
            let area = a * b * size * size;
            Shape::General {
                section: Section {
                    area,
                    second_moment_y: area * size * size * 0.1 * a,
                    second_moment_z: area * size * size * 0.1 * b,
                    torsion_constant: area * size * size * 0.15,
                    shear_area_y: 0.8 * area,
                    shear_area_z: 0.7 * area,
                },
                reach_y: size,
                reach_z: size,
            }
        }
    }
}

/// Sections of one kind that vary along a beam of a length, in one of three ways.
fn profile(length: f64) -> impl Strategy<Value = Profile> {
    let measures = || prop::array::uniform2(0.6..1.4_f64);
    (
        0..3,
        0..6_u32,
        0.01..0.05_f64,
        prop::array::uniform4(measures()),
        0.1..0.9_f64,
    )
        .prop_map(move |(way, kind, slenderness, m, knee)| {
            let shapes = m.map(|measures| shape(kind, slenderness * length, measures));
            match way {
                0 => Profile::Uniform(shapes[0]),
                1 => Profile::Linear {
                    root: shapes[0],
                    tip: shapes[1],
                },
                // A taper, a step, and another taper.
                _ => Profile::Table(vec![
                    (0.0, shapes[0]),
                    (knee * length, shapes[1]),
                    (knee * length, shapes[2]),
                    (length, shapes[3]),
                ]),
            }
        })
}

fn division(length: f64, most: usize) -> impl Strategy<Value = Division> {
    let parts = prop::collection::vec(0.5..1.5_f64, 1..=most);
    prop_oneof![
        (1..=most).prop_map(Division::Equal),
        parts.prop_map(move |parts| {
            let sum: f64 = parts.iter().sum();
            Division::Lengths(parts.iter().map(|part| part * length / sum).collect())
        }),
    ]
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-size..size).prop_map(DVec3::from_array)
}

/// Bent at rest: by up to a radian about each axis along the whole.
pub(crate) fn bent(length: f64) -> impl Strategy<Value = Rest> {
    prop_oneof![
        vector(1.0 / length).prop_map(Rest::Curved),
        (vector(1.0 / length), vector(1.0 / length), 0.1..0.9_f64).prop_map(
            move |(first, second, at)| {
                Rest::Table(vec![(0.05 * length, first), (at * length, second)])
            }
        ),
    ]
}

fn beam(
    most: usize,
    rest: impl Fn(f64) -> prop::strategy::BoxedStrategy<Rest>,
) -> impl Strategy<Value = Beam> {
    (-2.0..0.5_f64, rest(1.0)).prop_flat_map(move |(power, _)| {
        let length = 10.0_f64.powf(power);
        let material =
            (9.0..11.5_f64, 0.0..0.45_f64).prop_map(|(power, nu)| (10.0_f64.powf(power), nu));
        let shear = prop_oneof![Just(Shear::Rigid), Just(Shear::Flexible)];
        (
            profile(length),
            division(length, most),
            rest(length),
            material,
            shear,
        )
            .prop_map(
                move |(profile, division, rest, (young_modulus, nu), shear)| {
                    Beam::new(BeamSpec {
                        length,
                        profile,
                        material: Material::isotropic(young_modulus, nu),
                        division,
                        rest,
                        shear,
                    })
                    .expect("no fault")
                },
            )
    })
}

/// A straight beam of up to so many elements.
pub(crate) fn straight(most: usize) -> impl Strategy<Value = Beam> {
    beam(most, |_| Just(Rest::Straight).boxed())
}

/// A beam, straight or bent, of up to so many elements.
pub(crate) fn any_beam(most: usize) -> impl Strategy<Value = Beam> {
    beam(most, |length| {
        prop_oneof![Just(Rest::Straight), bent(length), bent(length)].boxed()
    })
}

/// Places along a beam (0 to 1) with forces and moments in units of [`unit_force`] and that by the length.
pub(crate) type Draw = (f64, DVec3, DVec3);

/// Up to four loads.
pub(crate) fn loads() -> impl Strategy<Value = Vec<Draw>> {
    let place = prop_oneof![0.0..1.0_f64, Just(1.0)];
    prop::collection::vec((place, vector(1.0), vector(0.3)), 1..=4)
}

/// EI/L² of the softest section: a force of this size at the tip bends a beam far [N].
pub(crate) fn unit_force(beam: &Beam) -> f64 {
    let material = beam.spec().material;
    let softest = (0..=20)
        .map(|index| beam.shape_at(beam.length() * f64::from(index) / 20.0))
        .map(|shape| {
            let section = shape.section(material.poisson_ratio());
            section.second_moment_y.min(section.second_moment_z)
        })
        .fold(f64::INFINITY, f64::min);
    material.young_modulus * softest / beam.length().powi(2)
}

/// Loads of a beam, `size` times as large as [`unit_force`].
pub(crate) fn scaled(beam: &Beam, draws: &[Draw], size: f64) -> Vec<Load> {
    let unit = size * unit_force(beam);
    draws
        .iter()
        .map(|(place, force, moment)| Load {
            s: place * beam.length(),
            force: *force * unit,
            moment: *moment * unit * beam.length(),
        })
        .collect()
}
