//! Sections against integrals over their shapes, taken here strip by strip, and against published coefficients.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use pliant_beam::{Section, Shape};

/// Strips across a shape.
const STRIPS: u32 = 4000;

fn rectangle(width_y: f64, width_z: f64) -> Shape {
    Shape::Rectangle { width_y, width_z }
}

fn assert_near(what: &str, own: f64, truth: f64, tolerance: f64) {
    assert!(
        (own - truth).abs() <= tolerance * truth.abs(),
        "{what}: {own:e} for {truth:e}"
    );
}

/// Integrates `f(y, z)` over what lies between y = `from` and `to` and |z| < `half(y)`. Strips crowd at the ends, where circles are
/// steep; across each, Gauss's formula with five points.
fn over(from: f64, to: f64, half: impl Fn(f64) -> f64, f: impl Fn(f64, f64) -> f64) -> f64 {
    const POINTS: [(f64, f64); 5] = [
        (-0.906_179_845_938_664, 0.236_926_885_056_189_1),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let (middle, reach) = (0.5 * (from + to), 0.5 * (to - from));
    let step = PI / f64::from(STRIPS);
    let strip = |index: u32| {
        let angle = (f64::from(index) + 0.5) * step - FRAC_PI_2;
        let (y, width) = (middle + reach * angle.sin(), reach * angle.cos() * step);
        let half = half(y);
        let sum: f64 = POINTS
            .iter()
            .map(|(at, weight)| weight * f(y, half * at))
            .sum();
        sum * half * width
    };
    (0..STRIPS).map(strip).sum()
}

fn half_circle(diameter: f64) -> impl Fn(f64) -> f64 {
    move |y| (0.25 * diameter * diameter - y * y).max(0.0).sqrt()
}

/// Integrates over a shape; of a triangle the corner on +y is at half the circle's diameter, the side across at a quarter.
fn integral(shape: &Shape, f: impl Fn(f64, f64) -> f64) -> f64 {
    match *shape {
        Shape::Circle { diameter } => {
            over(-0.5 * diameter, 0.5 * diameter, half_circle(diameter), f)
        }
        Shape::Tube { outer, inner } => {
            over(-0.5 * outer, 0.5 * outer, half_circle(outer), &f)
                - over(-0.5 * inner, 0.5 * inner, half_circle(inner), &f)
        }
        Shape::Rectangle { width_y, width_z } => {
            over(-0.5 * width_y, 0.5 * width_y, |_| 0.5 * width_z, f)
        }
        Shape::Square { diameter } => {
            let half = 0.5 * diameter / 2.0_f64.sqrt();
            over(-half, half, |_| half, f)
        }
        Shape::Triangle { diameter } => {
            let half = |y: f64| (0.5 * diameter - y) / 3.0_f64.sqrt();
            over(-0.25 * diameter, 0.5 * diameter, half, f)
        }
        Shape::General { .. } => panic!("has no shape"),
    }
}

fn shapes() -> [Shape; 7] {
    [
        Shape::Circle { diameter: 1.3 },
        Shape::Tube {
            outer: 1.27,
            inner: 0.838,
        },
        Shape::Tube {
            outer: 1.0,
            inner: 0.99,
        },
        rectangle(0.7, 1.9),
        rectangle(3.0, 0.4),
        Shape::Square { diameter: 1.1 },
        Shape::Triangle { diameter: 0.9 },
    ]
}

#[test]
fn areas_and_second_moments_are_integrals_over_the_shape() {
    for shape in shapes() {
        let section = shape.section(0.3);
        let name = format!("{shape:?}");
        // A thin tube is the small difference of two circles.
        let tolerance = if matches!(shape, Shape::Tube { .. }) {
            1e-9
        } else {
            1e-6
        };
        assert_near(&name, section.area, integral(&shape, |_, _| 1.0), tolerance);
        assert_near(
            &name,
            section.second_moment_y,
            integral(&shape, |_, z| z * z),
            tolerance,
        );
        assert_near(
            &name,
            section.second_moment_z,
            integral(&shape, |y, _| y * y),
            tolerance,
        );
        // Axes are central and principal.
        let scale = section.area * section.area.sqrt();
        assert!(integral(&shape, |y, _| y).abs() < 1e-6 * scale, "{name}");
        assert!(
            integral(&shape, |y, z| y * z).abs() < 1e-6 * scale,
            "{name}"
        );
    }
}

#[test]
fn files_have_the_second_moments_of_their_nominal_circle() {
    let square = Shape::Square { diameter: 1.0 }.section(0.3);
    assert_near("d⁴/48", square.second_moment_y, 1.0 / 48.0, 1e-14);
    let triangle = Shape::Triangle { diameter: 1.0 }.section(0.3);
    assert_near(
        "0.01015 d⁴",
        triangle.second_moment_z,
        3.0_f64.sqrt() * 9.0 / 1536.0,
        1e-14,
    );
    assert_near(
        "both axes",
        triangle.second_moment_y,
        triangle.second_moment_z,
        1e-14,
    );
}

/// J = 2 ∫ φ dA of Prandtl's stress function, ∇²φ = −2, 0 at the border: known in closed form for the circle, (a² − r²)/2, and for the
/// equilateral triangle, where φ is twice the product of the distances from the sides by the height.
#[test]
fn torsion_constants_are_integrals_of_the_stress_function() {
    for shape in &shapes()[..3] {
        let polar = integral(shape, |y, z| y * y + z * z);
        assert_near(
            "polar moment",
            shape.section(0.3).torsion_constant,
            polar,
            1e-9,
        );
    }
    let disc = Shape::Circle { diameter: 2.0 };
    let by_function = 2.0 * integral(&disc, |y, z| 0.5 * (1.0 - y * y - z * z));
    assert_near(
        "disc",
        disc.section(0.0).torsion_constant,
        by_function,
        1e-9,
    );
    let triangle = Shape::Triangle { diameter: 0.9 };
    let height = 0.75 * 0.9;
    let sides = [0.0, 1.0, 2.0].map(|third| DVec2::from_angle(PI + third * 2.0 * PI / 3.0));
    let function = |y: f64, z: f64| {
        let distances = sides.map(|outward| height / 3.0 - outward.dot(DVec2::new(y, z)));
        2.0 * distances.iter().product::<f64>() / height
    };
    let by_function = 2.0 * integral(&triangle, function);
    assert_near(
        "triangle",
        triangle.section(0.3).torsion_constant,
        by_function,
        1e-6,
    );
}

/// Timoshenko & Goodier (1970, art. 109, table of k₁): J = k₁ long short³.
#[test]
fn torsion_of_rectangles_has_the_published_coefficients() {
    for (ratio, published, unit) in [
        (1.0, 0.1406, 1e-4),
        (1.2, 0.166, 1e-3),
        (1.5, 0.196, 1e-3),
        (2.0, 0.229, 1e-3),
        (2.5, 0.249, 1e-3),
        (3.0, 0.263, 1e-3),
        (4.0, 0.281, 1e-3),
        (5.0, 0.291, 1e-3),
        (10.0, 0.312, 1e-3),
        (1e6, 0.333, 1e-3),
    ] {
        for shape in [rectangle(ratio * 0.3, 0.3), rectangle(0.3, ratio * 0.3)] {
            let coefficient = shape.section(0.3).torsion_constant / (ratio * 0.3_f64.powi(4));
            assert!(
                (coefficient - published).abs() <= 0.5 * unit + 1e-6,
                "{ratio}: {coefficient}"
            );
        }
    }
}

#[test]
fn torsion_of_rectangles_is_the_whole_series() {
    for ratio in [1.0, 1.01, 1.7, 3.0, 20.0_f64] {
        let series: f64 = (0..4000)
            .map(|index| 2.0 * f64::from(index) + 1.0)
            .map(|n| (0.5 * n * PI * ratio).tanh() / n.powi(5))
            .sum();
        let truth = ratio / 3.0 * (1.0 - 192.0 / PI.powi(5) / ratio * series);
        let own = rectangle(1.0, ratio).section(0.3).torsion_constant;
        assert_near("rectangle", own, truth, 1e-13);
    }
    let file = Shape::Square {
        diameter: 2.0_f64.sqrt(),
    };
    assert_near(
        "square",
        file.section(0.3).torsion_constant,
        0.140_577_014_955,
        1e-11,
    );
}

/// Cowper (1966): circle 6(1 + ν)/(7 + 6ν), thin tube 2(1 + ν)/(4 + 3ν), rectangle 10(1 + ν)/(12 + 11ν) at ν = 0.
#[test]
fn shear_coefficients_are_cowpers() {
    let coefficient = |shape: Shape, nu: f64| {
        let section = shape.section(nu);
        assert_near(
            "both ways",
            section.shear_area_y,
            section.shear_area_z,
            1e-15,
        );
        section.shear_area_y / section.area
    };
    let circle = Shape::Circle { diameter: 0.7 };
    for (nu, published) in [(0.0, 0.857), (0.1, 0.868), (0.3, 0.886), (0.5, 0.900)] {
        assert!((coefficient(circle, nu) - published).abs() < 5.1e-4, "{nu}");
    }
    let thin = Shape::Tube {
        outer: 1.0,
        inner: 1.0 - 1e-7,
    };
    for nu in [0.0_f64, 0.3, 0.5] {
        let truth = 2.0 * (1.0 + nu) / (4.0 + 3.0 * nu);
        assert_near("thin tube", coefficient(thin, nu), truth, 1e-6);
    }
    let narrow = Shape::Tube {
        outer: 1.0,
        inner: 1e-9,
    };
    assert_near(
        "tube without a hole",
        coefficient(narrow, 0.3),
        coefficient(circle, 0.3),
        1e-12,
    );
    // m = 1/2: (1 + m²)² = 25/16, m² = 4/16.
    let tube = Shape::Tube {
        outer: 1.0,
        inner: 0.5,
    };
    let truth = 6.0 * 1.3 * 25.0 / (8.8 * 25.0 + 23.6 * 4.0);
    assert_near("tube", coefficient(tube, 0.3), truth, 1e-14);
    assert_near(
        "rectangle",
        coefficient(rectangle(1.0, 2.0), 0.3),
        10.0 / 12.0,
        1e-15,
    );
}

#[test]
fn the_largest_strain_is_that_of_some_fibre_and_of_none_larger() {
    let border = |shape: &Shape| -> Vec<DVec2> {
        let corners = |corners: &[DVec2]| {
            let next = corners.iter().cycle().skip(1);
            let side = |(a, b): (&DVec2, &DVec2)| [0.0, 0.3, 0.7].map(|t| a.lerp(*b, t));
            corners.iter().zip(next).flat_map(side).collect()
        };
        let round = |diameter: f64, count: u32| -> Vec<DVec2> {
            let turn = |index: u32| f64::from(index) * 2.0 * PI / f64::from(count);
            (0..count)
                .map(|index| DVec2::from_angle(turn(index)) * 0.5 * diameter)
                .collect()
        };
        let cuboid = |y: f64, z: f64| {
            let signs = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
            corners(&signs.map(|(a, b)| DVec2::new(0.5 * a * y, 0.5 * b * z)))
        };
        match *shape {
            Shape::Circle { diameter } => round(diameter, 3600),
            Shape::Tube { outer, .. } => round(outer, 3600),
            Shape::Rectangle { width_y, width_z } => cuboid(width_y, width_z),
            Shape::Square { diameter } => {
                cuboid(diameter / 2.0_f64.sqrt(), diameter / 2.0_f64.sqrt())
            }
            Shape::Triangle { diameter } => corners(&round(diameter, 3)),
            Shape::General {
                reach_y, reach_z, ..
            } => cuboid(2.0 * reach_y, 2.0 * reach_z),
        }
    };
    let integrals = Section {
        area: 1.0,
        second_moment_y: 1.0,
        second_moment_z: 1.0,
        torsion_constant: 1.0,
        shear_area_y: 1.0,
        shear_area_z: 1.0,
    };
    let general = Shape::General {
        section: integrals,
        reach_y: 0.4,
        reach_z: 0.9,
    };
    for shape in shapes().iter().chain([&general]) {
        for [axial, y, z] in [
            [0.0, 1.0, 0.0],
            [0.0, 0.0, -1.0],
            [0.3, 0.7, 0.2],
            [-0.2, -0.4, 1.0],
            [-0.1, 0.0, 0.9],
            [0.5, 0.0, 0.0],
        ] {
            let strain = |fibre: DVec2| (axial + fibre.y * y - fibre.x * z).abs();
            let truth = border(shape).into_iter().map(strain).fold(0.0, f64::max);
            let own = shape.largest_strain(axial, DVec2::new(y, z));
            assert!(
                own >= truth - 1e-12 && own <= truth + 1e-6,
                "{shape:?} {axial} {y} {z}: {own} for {truth}"
            );
        }
    }
}
