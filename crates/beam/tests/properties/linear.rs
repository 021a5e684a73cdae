//! The stiffness method: equilibrium, superposition, and answers that do not depend on the division.

use glam::DVec3;
use nalgebra::DVector;
use pliant_beam::{
    Beam, BeamSpec, Corotational, Displacement, Division, Load, Loading, Material, MaterialPoint,
    Profile, Rest, Shape, Shear, StiffnessMethod, consistent_loads,
};
use proptest::prelude::{prop, prop_assert, proptest};

use crate::beams::{any_beam, cases, loads, scaled, straight};
use crate::matrix::free;

/// Parts into which a line load is divided by hand.
const PARTS: u32 = 2000;

/// Parts of the integral along a twisted ruler.
const RULER_PARTS: u32 = 100_000;

/// All displacements, root included.
fn displacements(method: &mut StiffnessMethod, loading: &Loading<'_>) -> Vec<Displacement> {
    method.solve(loading);
    let count = method.beam().nodes().len();
    (0..count).map(|node| method.node(node)).collect()
}

/// Largest difference, displacements by the length.
fn apart(own: &[Displacement], other: &[Displacement], length: f64) -> f64 {
    own.iter().zip(other).fold(0.0, |most: f64, (own, other)| {
        most.max((own.translation - other.translation).length() / length)
            .max((own.rotation - other.rotation).length())
    })
}

fn size(of: &[Displacement], length: f64) -> f64 {
    apart(of, &vec![Displacement::default(); of.len()], length)
}

fn points(points: &[Load]) -> Loading<'_> {
    Loading {
        points,
        line: DVec3::ZERO,
    }
}

proptest! {
    #![proptest_config(cases(200))]

    /// What K says of the root holds all loads in balance, by their places at rest; the line load by those of many points.
    #[test]
    fn the_root_bears_all_loads(
        beam in any_beam(10),
        draws in loads(),
        line in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let loads = scaled(&beam, &draws, 1.0);
        let unit = crate::beams::unit_force(&beam);
        let length = beam.length();
        let loading = Loading {
            points: &loads,
            line: DVec3::from_array(line) * unit / length,
        };
        let mut method = StiffnessMethod::new(beam.clone());
        let solution = displacements(&mut method, &loading);
        let unknowns = DVector::from_iterator(6 * solution.len(), solution.iter().flat_map(|node| {
            let (u, r) = (node.translation, node.rotation);
            [u.x, u.y, u.z, r.x, r.y, r.z]
        }));
        let mut at_root = (free(&beam) * unknowns).rows(0, 6).clone_owned();
        consistent_loads(&beam, &loading, |node, load| {
            if node == 0 {
                at_root -= DVector::from_row_slice(&load);
            }
        });
        let far = Corotational::new(beam.clone());
        let place = |s: f64| far.pose(&MaterialPoint::new(&beam, s, DVec3::ZERO)).translation;
        let mut force: DVec3 = loads.iter().map(|load| load.force).sum();
        let mut moment: DVec3 = loads.iter().map(|load| load.moment + place(load.s).cross(load.force)).sum();
        for part in 0..PARTS {
            let share = loading.line * length / f64::from(PARTS);
            force += share;
            moment += place(length * (f64::from(part) + 0.5) / f64::from(PARTS)).cross(share);
        }
        let bears = |row: usize| DVec3::new(at_root[row], at_root[row + 1], at_root[row + 2]);
        prop_assert!((bears(0) + force).length() <= 1e-8 * unit, "{} {force}", bears(0));
        // As exact as the sum over the parts.
        prop_assert!((bears(3) + moment).length() <= 1e-5 * unit * length, "{} {moment}", bears(3));
    }

    #[test]
    fn loads_superpose(beam in any_beam(10), one in loads(), two in loads(), factor in -3.0..3.0_f64) {
        let (one, two) = (scaled(&beam, &one, 1.0), scaled(&beam, &two, 1.0));
        let scaled = two.iter().map(|load| Load {
            s: load.s,
            force: load.force * factor,
            moment: load.moment * factor,
        });
        let both: Vec<Load> = one.iter().copied().chain(scaled).collect();
        let length = beam.length();
        let mut method = StiffnessMethod::new(beam);
        let first = displacements(&mut method, &points(&one));
        let second = displacements(&mut method, &points(&two));
        let together = displacements(&mut method, &points(&both));
        let sum: Vec<_> = first.iter().zip(&second).map(|(first, second)| Displacement {
            translation: first.translation + second.translation * factor,
            rotation: first.rotation + second.rotation * factor,
        }).collect();
        let scale = size(&first, length) + size(&second, length);
        prop_assert!(apart(&sum, &together, length) <= 1e-10 * scale);
    }

    /// Elements are exact, so where nodes are changes nothing: one element and ten, for any taper, bend and twist.
    #[test]
    fn the_tip_does_not_depend_on_the_division(beam in any_beam(10), draws in loads()) {
        // Loads inside bent elements are spread by the straight element's shapes: exact only at nodes.
        let bent = !beam.is_straight();
        let loads: Vec<Load> = scaled(&beam, &draws, 1.0).into_iter().map(|load| Load {
            s: if bent { beam.length() } else { load.s },
            ..load
        }).collect();
        let length = beam.length();
        let undivided = Beam::new(BeamSpec {
            division: Division::Equal(1),
            ..beam.spec().clone()
        });
        let tip = |beam: Beam| {
            let mut method = StiffnessMethod::new(beam);
            let all = displacements(&mut method, &points(&loads));
            [*all.last().expect("a tip")]
        };
        let (whole, divided) = (tip(undivided.unwrap()), tip(beam));
        let difference = apart(&whole, &divided, length);
        prop_assert!(difference <= 1e-7 * size(&divided, length), "{difference:e}");
    }

    /// Section forces of the straight beam are what the part beyond needs: they vanish at the tip and jump by each load.
    #[test]
    fn section_forces_balance_each_part(
        beam in straight(4),
        draws in loads(),
        line in prop::array::uniform3(-1.0..1.0_f64),
        at in 0.0..1.0_f64,
    ) {
        let loads = scaled(&beam, &draws, 1.0);
        let (length, s) = (beam.length(), at * beam.length());
        let unit = crate::beams::unit_force(&beam);
        let line = DVec3::from_array(line) * unit / length;
        let loading = Loading { points: &loads, line };
        let (root, here) = (loading.section_forces(0.0, length), loading.section_forces(s, length));
        let mut force = root.force - line * s;
        let mut moment =
            root.moment - DVec3::X.cross(here.force) * s - DVec3::X.cross(line) * (0.5 * s * s);
        for load in loads.iter().filter(|load| load.s < s) {
            force -= load.force;
            moment -= load.moment + DVec3::X.cross(load.force) * load.s;
        }
        prop_assert!((force - here.force).length() <= 1e-13 * unit);
        prop_assert!((moment - here.moment).length() <= 1e-13 * unit * length);
    }
}

/// A ruler twisted by a right angle along its length: its tip's compliance is an integral over sections that turn. Where the twist left
/// the chord exactly as long as the arc, elements were taken as not twisted at all.
#[test]
fn a_twisted_ruler_bends_by_its_turning_sections() {
    let (length, young_modulus) = (1.0, 1e9);
    let shape = Shape::Rectangle {
        width_y: 0.04,
        width_z: 0.01,
    };
    let section = shape.section(0.3);
    let twist = std::f64::consts::FRAC_PI_2;
    // w of the tip per force along z: ∫ (L − s)² (cos² θ/EI_y + sin² θ/EI_z) ds, θ = twist s.
    let step = length / f64::from(RULER_PARTS);
    let truth: f64 = (0..RULER_PARTS)
        .map(|part| {
            let s = (f64::from(part) + 0.5) * step;
            let (sine, cosine) = (twist * s).sin_cos();
            let bending =
                cosine * cosine / section.second_moment_y + sine * sine / section.second_moment_z;
            (length - s).powi(2) * bending * step / young_modulus
        })
        .sum();
    for elements in [1, 2, 3, 7, 16] {
        let beam = Beam::new(BeamSpec {
            length,
            profile: Profile::Uniform(shape),
            material: Material::isotropic(young_modulus, 0.3),
            division: Division::Equal(elements),
            rest: Rest::Curved(DVec3::X * twist),
            shear: Shear::Rigid,
        });
        let tip = Load {
            s: length,
            force: DVec3::Z,
            moment: DVec3::ZERO,
        };
        let mut method = StiffnessMethod::new(beam.unwrap());
        let all = displacements(&mut method, &points(&[tip]));
        let own = all[elements].translation.z;
        assert!(
            (own / truth - 1.0).abs() < 1e-8,
            "{elements}: {own:e} for {truth:e}"
        );
    }
}

/// An element much shorter than it is thick: k₁₁ = (z/3 + S)/(z²/12 + S z) with z = L/EI, S = 1/(GA L). Written with squares of S it had
/// lost half its digits at a thousandth of the thickness.
#[test]
fn stubby_elements_keep_their_digits() {
    for length in [1e-3, 1e-5, 1e-7] {
        let beam = Beam::new(BeamSpec {
            length,
            profile: Profile::Uniform(Shape::Circle { diameter: 1e-2 }),
            material: Material::isotropic(1e9, 0.3),
            division: Division::Equal(1),
            rest: Rest::Straight,
            shear: Shear::Flexible,
        });
        let beam = beam.unwrap();
        let section = beam.shape_at(0.0).section(0.3);
        let bending = length / (1e9 * section.second_moment_y);
        let shear = 2.6 / (1e9 * section.shear_area_z * length);
        let truth = (bending / 3.0 + shear) / (bending * bending / 12.0 + shear * bending);
        let own = beam.elements()[0].flexibility.stiffness(length).about_y[0];
        assert!(
            (own / truth - 1.0).abs() < 1e-12,
            "{length}: {own:e} for {truth:e}"
        );
    }
}
