//! The catalogue against its table of stiffness: 1/k = ∫ (L − s)²/EI ds, worked out apart from this crate, to the digits printed.
#![expect(clippy::float_cmp, reason = "numbers handed through are the same")]

use glam::DVec3;
use pliant_beam::{
    AnchoredLoads, Beam, BeamError, ClosedForm, Corotational, Load, Loading, Origin, Settings,
    catalogue, tool,
};

/// A number with one unit of its last digit.
type Printed = (f64, f64);

/// Name, EI at the root [N mm²], tip stiffness [N/mm], force for a tenth of the length [N].
const TABLE: [(&str, Printed, Printed, Printed); 16] = [
    (
        "k-file-15-steel",
        (203.0, 1.0),
        (0.0250, 1e-4),
        (0.063, 1e-3),
    ),
    (
        "k-file-25-steel",
        (440.0, 1.0),
        (0.0632, 1e-4),
        (0.16, 1e-2),
    ),
    (
        "k-file-25-niti",
        (110.0, 1.0),
        (0.0158, 1e-4),
        (0.040, 1e-3),
    ),
    (
        "rotary-file-20-04-niti",
        (519.0, 1.0),
        (0.0542, 1e-4),
        (0.14, 1e-2),
    ),
    (
        "rotary-file-25-06-niti",
        (1088.0, 1.0),
        (0.104, 1e-3),
        (0.26, 1e-2),
    ),
    ("explorer-tine", (20_400.0, 100.0), (1.91, 1e-2), (3.8, 0.1)),
    (
        "needle-18g",
        (20_200.0, 100.0),
        (0.0831, 1e-4),
        (0.75, 1e-2),
    ),
    ("needle-22g", (2260.0, 10.0), (0.0093, 1e-4), (0.084, 1e-3)),
    ("needle-25g", (626.0, 1.0), (0.0294, 1e-4), (0.12, 1e-2)),
    ("needle-27g", (259.0, 1.0), (0.0498, 1e-4), (0.12, 1e-2)),
    (
        "biopsy-needle-18g",
        (24_900.0, 100.0),
        (0.0221, 1e-4),
        (0.33, 1e-2),
    ),
    (
        "guidewire-amplatz",
        (291.0, 1.0),
        (0.0070, 1e-4),
        (0.035, 1e-3),
    ),
    (
        "guidewire-lunderquist",
        (4860.0, 10.0),
        (0.117, 1e-3),
        (0.58, 1e-2),
    ),
    (
        "toothbrush-bristle",
        (0.236, 1e-3),
        (5.3e-4, 1e-5),
        (6e-4, 1e-4),
    ),
    (
        "paint-brush-bristle",
        (0.0746, 1e-4),
        (3.5e-6, 1e-7),
        (1e-5, 1e-5),
    ),
    ("steel-rod", (157_000.0, 1000.0), (0.47, 1e-2), (4.7, 0.1)),
];

/// Name, force at the tip [N], deflection by the length [%] on the exact curve, one unit of its last digit.
const FAR_BENT: [(&str, f64, Printed); 12] = [
    ("k-file-15-steel", 0.3, (36.0, 1.0)),
    ("k-file-15-steel", 1.0, (62.0, 1.0)),
    ("k-file-25-steel", 3.0, (69.0, 1.0)),
    ("k-file-25-niti", 1.0, (73.0, 1.0)),
    ("rotary-file-20-04-niti", 1.0, (43.0, 1.0)),
    ("rotary-file-25-06-niti", 3.0, (51.0, 1.0)),
    ("explorer-tine", 3.0, (7.7, 0.1)),
    ("needle-18g", 1.0, (13.1, 0.1)),
    ("needle-22g", 1.0, (65.0, 1.0)),
    ("biopsy-needle-18g", 3.0, (58.0, 1.0)),
    ("guidewire-amplatz", 1.0, (79.0, 1.0)),
    ("guidewire-lunderquist", 3.0, (42.0, 1.0)),
];

fn beam(name: &str) -> Beam {
    Beam::new(tool(name).expect("a tool")).expect("no fault")
}

fn tip_stiffness(beam: &Beam) -> f64 {
    let closed_form = ClosedForm::new(beam).expect("straight");
    let tip = closed_form.station(beam.length());
    1.0 / tip.compliance(&tip).translation_force.z_axis.z
}

/// Numbers at the edge of rounding may differ by a little more than half a unit.
fn assert_printed(what: &str, value: f64, (printed, unit): Printed) {
    assert!(
        (value - printed).abs() <= 0.5 * unit + 2e-4 * printed,
        "{what}: {value:e}, printed {printed:e}"
    );
}

#[test]
fn tips_are_as_stiff_as_the_table_says() {
    assert_eq!(catalogue().len(), TABLE.len());
    for (name, root, stiffness, force) in TABLE {
        let beam = beam(name);
        let material = beam.spec().material;
        let section = beam.shape_at(0.0).section(material.poisson_ratio());
        let k = tip_stiffness(&beam);
        assert_printed(
            name,
            material.young_modulus * section.second_moment_y * 1e6,
            root,
        );
        assert_printed(name, k * 1e-3, stiffness);
        let tenth = k * 0.1 * beam.length();
        if name == "paint-brush-bristle" {
            // One digit, cut: 1.4e-5.
            assert_printed(name, tenth, (1.4e-5, 1e-6));
        } else {
            assert_printed(name, tenth, force);
        }
    }
}

#[test]
fn tools_bend_as_far_as_the_table_says() {
    for (name, force, printed) in FAR_BENT {
        let beam = beam(name);
        let load = Load {
            s: beam.length(),
            force: DVec3::Y * force,
            moment: DVec3::ZERO,
        };
        let loading = Loading {
            points: &[load],
            line: DVec3::ZERO,
        };
        let loads = AnchoredLoads::new(&beam, &loading, &[]);
        let (length, last) = (beam.length(), beam.elements().len());
        let mut bent = Corotational::new(beam);
        let outcome = bent.solve(&loads, &Settings::default());
        assert!(outcome.converged, "{name}: {outcome:?}");
        let deflection = 100.0 * bent.node(last).translation.y / length;
        assert_printed(name, deflection, printed);
    }
}

#[test]
fn every_number_says_where_it_comes_from() {
    for entry in catalogue() {
        assert!(!entry.description.contains('\n') && entry.description.len() <= 80);
        for (field, unit, figure) in entry.figures() {
            let (Origin::Read(text) | Origin::Named(text) | Origin::Assumed(text)) = figure.origin;
            assert!(
                !text.is_empty() && !unit.is_empty(),
                "{}: {field}",
                entry.name
            );
        }
        let spec = entry.spec();
        assert_eq!(spec, tool(entry.name).unwrap());
        // What is listed is what is built.
        let listed = |name: &str| {
            let figures = entry.figures();
            figures
                .iter()
                .find(|(field, ..)| *field == name)
                .unwrap()
                .2
                .value
        };
        assert_eq!(listed("length"), spec.length);
        assert_eq!(listed("young_modulus"), spec.material.young_modulus);
        assert_eq!(listed("density"), spec.material.density);
        assert_eq!(listed("strain_limit"), spec.material.strain_limit);
    }
}

#[test]
fn names_are_told_apart_and_of_one_form() {
    let mut names: Vec<_> = catalogue().iter().map(|entry| entry.name).collect();
    let plain = |name: &&str| {
        name.chars()
            .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-')
    };
    assert!(names.iter().all(plain));
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), catalogue().len());
}

#[test]
fn an_unknown_tool_is_answered_with_the_names_most_like_it() {
    for (asked, meant) in [
        ("needle 22G", "needle-22g"),
        ("K-File-15", "k-file-15-steel"),
        ("lunderquist", "guidewire-lunderquist"),
        ("explorer", "explorer-tine"),
        ("tooth-brush-bristle", "toothbrush-bristle"),
    ] {
        let error = tool(asked).unwrap_err();
        let BeamError::UnknownTool {
            name,
            nearest,
            names,
        } = &error
        else {
            panic!("{error}");
        };
        assert_eq!(name, asked);
        assert!(nearest.starts_with(meant), "{asked}: {nearest}");
        assert_eq!(names.split(", ").count(), catalogue().len());
        assert!(error.to_string().contains(meant));
    }
    // Any text is answered, and not all of it is repeated.
    for asked in ["", "\u{0}\u{1F980}", &"x".repeat(1_000_000)] {
        assert!(tool(asked).unwrap_err().to_string().len() < 1000);
    }
}
