//! Every fault of a scene is told with its line and column.
#![allow(clippy::too_many_lines, reason = "tables of cases")]

use pliant_scene::Scene;

const GOOD: &str = r#"(
    description: "x",
    tool: (
        shape: rod(length: 0.1, width: 0.006, height: 0.006),
        segments: 1,
    ),
    objects: [
        (
            name: "box",
            shape: cuboid(size: (0.1, 0.1, 0.05)),
            pose: (position: (0, 0, -0.025), rotation: (axis: (0, 0, 1), angle_deg: 90)),
            shading_threshold_deg: 10,
        ),
        (name: "m", shape: mesh(path: "a.obj", unit: mm)),
    ],
    trajectory: (path: "a.csv"),
)"#;

/// Message of the scene with the first `old` replaced.
fn message(old: &str, new: &str) -> String {
    let text = GOOD.replacen(old, new, 1);
    assert_ne!(text, GOOD, "{old}");
    match Scene::from_str(&text, "s.ron") {
        Ok(_) => panic!("{new} was accepted"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn a_good_scene_is_read_as_written() {
    let scene = Scene::from_str(GOOD, "s.ron").unwrap();
    let object = &scene.description().objects[0];
    let world_from_object = object.pose.pose();
    let turned = world_from_object.transform_point(glam::DVec3::X);
    assert!((turned - glam::DVec3::new(0.0, 1.0, -0.025)).length() < 1e-15);
    assert!((object.shading_threshold_deg.unwrap().get() - 10.0).abs() < 1e-15);
    assert_eq!(scene.description().rate_hz.get(), 1000);
    assert!(
        scene
            .description()
            .coupling
            .angular_stiffness
            .get()
            .is_infinite()
    );
}

#[test]
fn numbers_out_of_range_are_refused_where_they_stand() {
    for (old, new, start) in [
        (
            "0.006,",
            "-0.006,",
            "s.ron:4:40: -0.006 is out of range; expected a length",
        ),
        ("0.006,", "0,", "s.ron:4:40: 0 is out of range"),
        ("0.006,", "inf,", "s.ron:4:40: inf is out of range"),
        ("0.006,", "NaN,", "s.ron:4:40: NaN is out of range"),
        (
            "segments: 1",
            "segments: 0",
            "s.ron:5:19: 0 is out of range; expected a whole number from 1 to 100",
        ),
        (
            "segments: 1",
            "segments: 101",
            "s.ron:5:19: 101 is out of range; expected a whole number from 1 to 100; each segment is tested",
        ),
        (
            "segments: 1",
            "segments: 1.5",
            "s.ron:5:19: 1.5 is out of range",
        ),
        (
            "segments: 1",
            "segments: -1",
            "s.ron:5:19: -1 is out of range",
        ),
        (
            "(0.1, 0.1, 0.05)",
            "(0.1, 0, 0.05)",
            "s.ron:10:39: 0 is out of range",
        ),
        (
            "(0, 0, -0.025)",
            "(0, NaN, 0)",
            "s.ron:11:34: NaN is out of range; expected a coordinate from -1000000 to 1000000 m",
        ),
        (
            "(0, 0, 1)",
            "(0, 0, 0)",
            "s.ron:11:63: (0, 0, 0) is no direction",
        ),
        ("deg: 10", "deg: 190", "s.ron:12:36: 190 is out of range"),
        (
            "description",
            "rate_hz: 20000, description",
            "s.ron:2:14: 20000 is out of range; expected a whole number from 500 to 10000",
        ),
        (
            "description",
            "seconds: 0, description",
            "s.ron:2:14: 0 is out of range; expected a duration",
        ),
        (
            "cuboid(size: (0.1, 0.1, 0.05))",
            "cylinder(radius: 1, length: 1, sectors: 10001)",
            "s.ron:10:60: 10001 is out of range",
        ),
    ] {
        let message = message(old, new);
        assert!(message.starts_with(start), "{new}: {message}");
    }
}

#[test]
fn wrong_types_and_names_are_refused_where_they_stand() {
    for (old, new, start) in [
        ("0.006,", "\"x\",", "s.ron:4:40: expected a number"),
        (
            "segments",
            "segmets",
            "s.ron:5:9: unknown field `segmets` in `tool`; expected one of shape, segments",
        ),
        (
            "    tool",
            "    tol",
            "s.ron:3:5: unknown field `tol` in `Scene`; expected one of description, rate_hz",
        ),
        (
            "cuboid",
            "cubiod",
            "s.ron:10:20: unknown shape `cubiod`; expected one of cuboid, plate",
        ),
        (
            "unit: mm",
            "unit: km",
            "s.ron:14:54: unknown unit `km`; expected one of m, mm, cm, inch",
        ),
        (
            ", unit: mm",
            "",
            "s.ron:14:28: field `unit` is missing in `mesh`; add it",
        ),
        (
            "    trajectory: (path: \"a.csv\"),\n",
            "",
            "s.ron:16:1: field `trajectory` is missing in `Scene`",
        ),
        (
            "pose:",
            "shape:",
            "s.ron:11:13: field `shape` is given twice in `object`",
        ),
        (
            "\"m\"",
            "3",
            "s.ron:14:16: expected a text in double quotes",
        ),
        (
            "(0.1, 0.1, 0.05)",
            "(0.1, 0.1)",
            "s.ron:10:33: expected three numbers (x, y, z), not 2 of them",
        ),
        (
            "(path: \"a.csv\")",
            "\"a.csv\"",
            "s.ron:16:17: expected the fields of `trajectory`",
        ),
        (
            "objects: [",
            "objects: (",
            "s.ron:7:14: expected a list in square brackets",
        ),
        ("\"x\",", "\"x\"", "s.ron:3:5: expected a comma"),
        ("\"a.csv\"),\n)", "\"a.csv\"),\n", "s.ron:17:1: "),
    ] {
        let message = message(old, new);
        assert!(message.starts_with(start), "{new}: {message}");
    }
}

#[test]
fn texts_that_are_no_scene_are_refused_with_a_place() {
    for text in ["", "(", "[]", "Scene", "42", "(tool: )", "\u{0}"] {
        let message = Scene::from_str(text, "s.ron").unwrap_err().to_string();
        assert!(message.starts_with("s.ron:1:"), "{text:?}: {message}");
    }
    let deep = "[".repeat(100_000);
    assert!(Scene::from_str(&deep, "s.ron").is_err());
    let error = Scene::from_bytes(b"(\n a\xff", "s.ron").unwrap_err();
    assert!(
        error.to_string().starts_with("s.ron:2:3: not UTF-8"),
        "{error}"
    );
}

#[test]
fn other_kinds_of_files_are_named() {
    for (bytes, kind) in [
        (&b"t_s,x_m,y_m\n0,1,2\n"[..], "a trajectory"),
        (b"# cube\nv 0 0 0\nv 1 0 0\n", "a mesh"),
        (b"glTF\x02\0\0\0\xff", "a mesh"),
        (b"\x89PNG\r\n\x1a\n\0", "binary data"),
    ] {
        let message = Scene::from_bytes(bytes, "s.ron").unwrap_err().to_string();
        let expected = format!(
            "s.ron:1:1: this looks like {kind}, not a scene; a scene is a RON text beginning with `(`"
        );
        assert_eq!(message, expected);
    }
    let marked = format!("\u{feff}{GOOD}");
    Scene::from_bytes(marked.as_bytes(), "s.ron").unwrap();
}

#[test]
fn wrong_forms_of_rotation_spell_out_the_right_one() {
    for rotation in [
        "(0, 0, 0, 1)",
        "(0.5, 0.5, 0.5, 0.5)",
        "(x: 0, y: 0, z: 0, w: 1)",
        "[0, 0, 0, 1]",
        "quat(0, 0, 0, 1)",
        "90",
        "(\"x\", 90)",
    ] {
        let message = message("(axis: (0, 0, 1), angle_deg: 90)", rotation);
        assert!(message.starts_with("s.ron:11:"), "{rotation}: {message}");
        assert!(
            message.ends_with("rotation: (axis: (x, y, z), angle_deg: a)")
                || message.ends_with("expected one of axis, angle_deg"),
            "{rotation}: {message}"
        );
        assert!(!message.contains("r#"), "{message}");
    }
    let message = message(
        "(position: (0, 0, -0.025), rotation: (axis: (0, 0, 1), angle_deg: 90))",
        "(0, 0, 0)",
    );
    assert!(message.contains("pose: (position: (x, y, z)"), "{message}");
}

#[test]
fn words_in_place_of_numbers_say_what_number_is_expected() {
    for (old, new, start) in [
        (
            "0.006,",
            "2cm,",
            "s.ron:4:40: expected a number, not `2cm`: a length above 0 and up to 1000 m",
        ),
        (
            "0.006,",
            "\"2 cm\",",
            "s.ron:4:40: expected a number, not `\"2 cm\"`: a length above 0",
        ),
        (
            "0.006,",
            "nan,",
            "s.ron:4:40: NaN is out of range; expected a length above 0 and up to 1000 m",
        ),
        (
            "(0, 0, -0.025)",
            "(0, 0, -25mm)",
            "s.ron:11:37: expected a number, not `-25mm`: a coordinate from",
        ),
        (
            "segments: 1",
            "segments: ten",
            "s.ron:5:19: expected a number, not `ten`: a whole number from 1 to 100",
        ),
    ] {
        let message = message(old, new);
        assert!(message.starts_with(start), "{new}: {message}");
    }
}

#[test]
fn single_values_in_place_of_three_numbers_are_refused_where_they_stand() {
    for word in ["nan", "inf", "5cm", "5", "\"5\"", "true"] {
        let message = message("(0.1, 0.1, 0.05)", word);
        let expected = format!("s.ron:10:33: expected three numbers (x, y, z), not `{word}`");
        assert_eq!(message, expected);
    }
}

#[test]
fn numbers_in_messages_are_short() {
    for (number, shown) in [
        ("1e300", "1e300"),
        ("1234567.890123", "1.2346e6"),
        ("1000.0000001", "1000.0000001"),
        ("-0.025611749338328015", "-0.025612"),
    ] {
        let message = message("0.006,", &format!("{number},"));
        let start = format!("s.ron:4:40: {shown} is out of range");
        assert!(message.starts_with(&start), "{message}");
    }
}

#[test]
fn names_of_objects_are_there_and_differ() {
    for name in ["\"\"", "\"  \""] {
        let message = message("\"box\"", name);
        assert!(
            message.starts_with("s.ron:9:19: the name is empty"),
            "{message}"
        );
    }
    let start = "s.ron:14:16: another object is named \"box\" too, at s.ron:9:19; ";
    let message = message("\"m\"", "\"box\"");
    assert!(message.starts_with(start), "{message}");
}

proptest::proptest! {
    /// No damage to a scene makes the reader panic, and each error has a place.
    #[test]
    fn damaged_scenes_are_refused_or_read(at in 0..GOOD.len(), with in "[(){}\\[\\],:\"/*a0.-]{0,3}", drop in 0..4_usize) {
        let end = (at + drop).min(GOOD.len());
        let text = format!("{}{with}{}", &GOOD[..at], &GOOD[end..]);
        if let Err(error) = Scene::from_str(&text, "s.ron") {
            let message = error.to_string();
            proptest::prop_assert!(message.starts_with("s.ron:"), "{}", message);
        }
    }
}
