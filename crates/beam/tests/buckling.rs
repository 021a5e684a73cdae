//! A beam pushed end-on: straight below Euler's load, on the elastica's branch above it.

use std::f64::consts::PI;

use glam::DVec3;
use pliant_beam::{
    AnchoredLoads, Beam, BeamSpec, Corotational, Division, Load, Loading, Material, Outcome,
    Profile, Rest, Settings, Shape, Shear, Stability,
};

const LENGTH: f64 = 0.1;
const DIAMETER: f64 = 1e-3;
const YOUNG: f64 = 200e9;

fn wire(elements: usize) -> Beam {
    Beam::new(BeamSpec {
        length: LENGTH,
        profile: Profile::Uniform(Shape::Circle { diameter: DIAMETER }),
        material: Material::isotropic(YOUNG, 0.3),
        division: Division::Equal(elements),
        rest: Rest::Straight,
        shear: Shear::Rigid,
    })
    .expect("a wire")
}

/// π²EI/4L².
fn critical() -> f64 {
    PI.powi(2) * YOUNG * PI * DIAMETER.powi(4) / 64.0 / (4.0 * LENGTH.powi(2))
}

fn push(method: &mut Corotational, force: f64) -> Outcome {
    let points = [Load {
        s: LENGTH,
        force: DVec3::NEG_X * force,
        moment: DVec3::ZERO,
    }];
    let loading = Loading {
        points: &points,
        line: DVec3::ZERO,
    };
    let loads = AnchoredLoads::new(method.beam(), &loading, &[]);
    method.solve(&loads, &Settings::default())
}

fn tip(method: &Corotational) -> DVec3 {
    method.node(method.beam().elements().len()).translation
}

/// Complete elliptic integrals K and E of modulus k, by the arithmetic-geometric mean.
fn elliptic(k: f64) -> (f64, f64) {
    let (mut a, mut b, mut c, mut power) = (1.0_f64, (1.0 - k * k).sqrt(), k, 0.5);
    let mut sum = 1.0 - power * c * c;
    for _ in 0..12 {
        c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        power *= 2.0;
        sum -= power * c * c;
    }
    let first = PI / (2.0 * a);
    (first, first * sum)
}

/// Tip (along, across) by the length of the elastica at a load by the critical one (Timoshenko & Gere 1961, §2.7).
fn elastica(ratio: f64) -> (f64, f64) {
    let (mut low, mut high) = (0.0, 0.999_999);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (2.0 * elliptic(middle).0 / PI).powi(2) < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    let (first, second) = elliptic(low);
    (2.0 * second / first - 1.0, 2.0 * low / first)
}

#[test]
fn the_critical_load_is_eulers() {
    let (mut low, mut high) = (0.9, 1.1);
    for _ in 0..14 {
        let middle = 0.5 * (low + high);
        let mut method = Corotational::new(wire(20));
        let outcome = push(&mut method, middle * critical());
        assert!(outcome.converged);
        if outcome.stability == Stability::Stable {
            assert!(tip(&method).with_x(0.0).length() < 1e-12 * LENGTH);
            low = middle;
        } else {
            high = middle;
        }
    }
    // The wire is shorter by P/EA, which the load carries over L²: 4e-5.
    assert!((low - 1.0).abs() < 1e-3, "{low} of Euler's load");
}

#[test]
fn above_it_the_tip_follows_the_elastica() {
    for ratio in [1.02, 1.1, 1.3, 1.6, 2.0, 2.5, 3.0] {
        let mut method = Corotational::new(wire(20));
        let outcome = push(&mut method, ratio * critical());
        assert!(outcome.converged, "{ratio}: {outcome:?}");
        assert_eq!(
            outcome.stability,
            Stability::Buckled,
            "{ratio}: {outcome:?}"
        );
        let (along, across) = elastica(ratio);
        let place = tip(&method) / LENGTH;
        assert!((place.x - along).abs() < 0.02, "{ratio}: {place}, {along}");
        let own = place.with_x(0.0).length();
        assert!(
            (own / across - 1.0).abs() < 0.02,
            "{ratio}: {own}, {across}"
        );
    }
}

#[test]
fn loading_and_unloading_follow_one_branch_without_jumps() {
    let mut method = Corotational::new(wire(20));
    let mut last: Option<DVec3> = None;
    let path = (0..=400).map(|step| 1.001 + 0.005 * f64::from(step));
    for ratio in path.clone().chain(path.rev()) {
        let outcome = push(&mut method, ratio * critical());
        assert!(outcome.converged, "{ratio}: {outcome:?}");
        assert_ne!(outcome.stability, Stability::Unstable);
        let place = tip(&method);
        if let Some(last) = last {
            // The branch rises with the root of the load: between steps by at most that of its first.
            assert!((place - last).length() < 0.13 * LENGTH, "{ratio}");
        }
        last = Some(place);
    }
}

#[test]
fn a_load_within_reach_of_straight_comes_back_straight() {
    let mut method = Corotational::new(wire(20));
    assert_eq!(
        push(&mut method, 1.5 * critical()).stability,
        Stability::Buckled
    );
    let outcome = push(&mut method, 0.8 * critical());
    assert!(outcome.converged && outcome.stability == Stability::Stable);
    assert!(tip(&method).with_x(0.0).length() < 1e-9 * LENGTH);
}
