//! Fields removed, renamed and doubled, numbers exchanged for others and for words.

use pliant_scene::{MemoryFiles, Scene};

use crate::scan::{Field, fields, numbers};
use crate::{FILE, FULL, place, position, refusal, scenes};

/// Fields that a scene cannot do without, where their parent is there.
const REQUIRED: [&str; 24] = [
    "tool",
    "tool.shape",
    "objects",
    "objects.name",
    "objects.shape",
    "trajectory",
    "trajectory.path",
    "pose.rotation.axis",
    "pose.rotation.angle_deg",
    "shape.size",
    "shape.length",
    "shape.width",
    "shape.height",
    "shape.thickness",
    "shape.radius",
    "shape.base_radius",
    "shape.radii",
    "shape.points",
    "shape.outer_radius",
    "shape.inner_radius",
    "shape.path",
    "shape.unit",
    "globe.sectors",
    "globe.bands",
];

fn is_required(field: &Field, text: &str) -> bool {
    // Two of the fields have defaults in one shape and none in another.
    let before = &text[..field.key.start];
    let of_globe = before
        .rfind("_ellipsoid(")
        .is_some_and(|at| !before[at..].contains("))"));
    let of_tool = field.path == "tool.shape.tip_radius";
    let name = field.path.rsplit('.').next().unwrap();
    of_tool
        || of_globe && REQUIRED.contains(&format!("globe.{name}").as_str())
        || REQUIRED.iter().any(|required| {
            field.path == *required
                || required.contains('.') && field.path.ends_with(&format!(".{required}"))
        })
}

#[test]
fn a_field_left_out_is_named_in_its_parent_or_has_a_default() {
    let mut required = 0;
    for (name, text) in scenes() {
        let all = fields(&text);
        for field in &all {
            let damaged = format!("{}{}", &text[..field.whole.start], &text[field.whole.end..]);
            let what = format!("{name} without {}", field.path);
            if !is_required(field, &text) {
                Scene::from_str(&damaged, FILE).unwrap_or_else(|error| panic!("{what}: {error}"));
                continue;
            }
            required += 1;
            let (error, found) = refusal(&damaged, &what);
            let key = &text[field.key.clone()];
            let start = format!("field `{key}` is missing in `");
            let message = error.fault.to_string();
            assert!(
                message.starts_with(&start) && message.ends_with("`; add it"),
                "{what}: {message}"
            );
            // Within the parent, whose brackets are the first and last lines.
            let parent = field.path.rsplit_once('.').map(|(parent, _)| parent);
            let around = all.iter().rev().find(|other| {
                Some(other.path.as_str()) == parent && other.value.contains(&field.key.start)
            });
            let whole = 0..text.len();
            let span = around.map_or(&whole, |around| &around.value);
            let (first, last) = (position(&text, span.start).0, position(&text, span.end).0);
            assert!((first..=last).contains(&found.0), "{what}: {error}");
        }
    }
    assert!(required > 80, "{required}");
}

#[test]
fn a_field_renamed_is_refused_where_it_stands() {
    for (name, text) in scenes() {
        for field in fields(&text) {
            let (key, rest) = (&text[field.key.clone()], &text[field.key.end..]);
            for unknown in [format!("{key}x"), format!("x_{key}"), key.to_uppercase()] {
                let damaged = format!("{}{unknown}{rest}", &text[..field.key.start]);
                let (error, found) = refusal(&damaged, &name);
                assert_eq!(found, position(&text, field.key.start), "{error}");
                let message = error.fault.to_string();
                let start = format!("unknown field `{unknown}` in `");
                assert!(message.starts_with(&start), "{error}");
                assert!(
                    message.split_once("; expected ").unwrap().1.contains(key),
                    "{error}"
                );
            }
        }
    }
}

#[test]
fn a_field_given_twice_is_refused_at_the_second() {
    for (name, text) in scenes() {
        for field in fields(&text) {
            let again = &text[field.key.start..field.value.end];
            let damaged = format!(
                "{}{again},\n {}",
                &text[..field.key.start],
                &text[field.key.start..]
            );
            let (error, found) = refusal(&damaged, &name);
            let second = field.key.start + again.len() + 3;
            assert_eq!(found, position(&damaged, second), "{error}");
            let key = &text[field.key.clone()];
            let start = format!("field `{key}` is given twice in `");
            assert!(error.fault.to_string().starts_with(&start), "{error}");
        }
    }
}

/// Whether a field takes a number, by its name alone.
fn takes(path: &str, value: f64) -> bool {
    let length = value > 0.0 && value <= 1000.0;
    let name = path.rsplit('.').next().unwrap();
    match name {
        "size" | "length" | "width" | "height" | "thickness" | "radius" | "radii"
        | "outer_radius" | "inner_radius" | "edge_width" => length,
        "base_radius" if path.starts_with("tool") => length,
        "base_radius" | "tip_radius" => length || value == 0.0,
        "position" => value.abs() <= 1e6,
        "angle_deg" | "axis" => value.is_finite(),
        "linear_stiffness" | "scale" | "speed" | "position_scale" | "force_scale" => {
            value > 0.0 && value.is_finite()
        }
        "angular_stiffness" => value > 0.0,
        "linear_damping" | "angular_damping" => value >= 0.0 && value.is_finite(),
        "seconds" => value > 0.0 && value <= 86_400.0,
        "shading_threshold_deg" => value > 0.0 && value <= 180.0,
        // Counts: none of the numbers tried here is one.
        "rate_hz" | "detection_interval" | "segments" | "sectors" | "bands" | "points" => false,
        _ => panic!("{path}: what it takes is not told here"),
    }
}

#[test]
fn a_number_out_of_range_is_refused_where_it_stands() {
    for (name, text) in scenes() {
        for number in numbers(&text) {
            for instead in [
                "NaN",
                "inf",
                "-inf",
                "-1",
                "0",
                "1e300",
                "1e999",
                "-0.5e-320",
            ] {
                let damaged = format!(
                    "{}{instead}{}",
                    &text[..number.span.start],
                    &text[number.span.end..]
                );
                let what = format!("{name}: {instead} for {}", number.path);
                if takes(&number.path, instead.parse().unwrap()) {
                    let read = Scene::from_str(&damaged, FILE);
                    read.unwrap_or_else(|error| panic!("{what}: {error}"));
                    continue;
                }
                let (error, found) = refusal(&damaged, &what);
                assert_eq!(found, position(&text, number.span.start), "{what}: {error}");
                let message = error.fault.to_string();
                assert!(
                    message.contains(" is out of range; expected "),
                    "{what}: {error}"
                );
            }
        }
    }
}

#[test]
fn a_word_in_place_of_a_number_is_refused_where_it_stands() {
    for (name, text) in scenes() {
        for number in numbers(&text) {
            for word in [
                "\"1\"",
                "\"\"",
                "ten",
                "true",
                "'1'",
                "2cm",
                "()",
                "[]",
                "(1)",
                "Some(\"1\")",
            ] {
                let damaged = format!(
                    "{}{word}{}",
                    &text[..number.span.start],
                    &text[number.span.end..]
                );
                let what = format!("{name}: {word} for {}", number.path);
                let (error, found) = refusal(&damaged, &what);
                // In `Some("1")` the text inside is at fault.
                let (line, column) = position(&text, number.span.start);
                let inside = column..column + word.len();
                assert!(
                    found.0 == line && inside.contains(&found.1),
                    "{what}: {error}"
                );
                assert!(
                    error.fault.to_string().starts_with("expected a number"),
                    "{what}: {error}"
                );
            }
        }
    }
}

#[test]
fn a_value_of_another_kind_is_refused_where_it_stands() {
    for (name, text) in scenes() {
        for field in fields(&text) {
            let value = &text[field.value.clone()];
            for instead in [
                "-", "\"a\"", "a", "1", "()", "[]", "(1)", "[1]", "(a: 1)", "a(b: 1)", "None",
                "{}", "",
            ] {
                let damaged = format!(
                    "{}{instead}{}",
                    &text[..field.value.start],
                    &text[field.value.end..]
                );
                let what = format!("{name}: `{instead}` for {} (`{value}`)", field.path);
                let Err(error) = Scene::from_str(&damaged, FILE) else {
                    continue;
                };
                let found = place(&error, &damaged);
                let start = position(&damaged, field.value.start);
                // A value left out shows at the next mark.
                let end = position(&damaged, field.value.start + instead.len() + 1);
                assert!((start..=end).contains(&found), "{what}: {error}");
            }
        }
    }
}

#[test]
fn faults_of_building_are_told_at_the_object_at_fault() {
    let cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let motion = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,0.1,0,0,0,1\n1,0,0,0.02,0,0,0,1\n";
    let files = [("f/a.obj", cube), ("f/m.csv", motion)];
    let files = files.map(|(path, text)| (path.into(), text.into()));
    let files = MemoryFiles(files.into());
    Scene::from_str(FULL, FILE).unwrap().build(&files).unwrap();
    for number in numbers(FULL) {
        for instead in ["0", "1e-300", "1e-8", "-1", "1000", "1e300", "inf"] {
            let damaged = format!(
                "{}{instead}{}",
                &FULL[..number.span.start],
                &FULL[number.span.end..]
            );
            let Ok(scene) = Scene::from_str(&damaged, FILE) else {
                continue;
            };
            let Err(error) = scene.build(&files) else {
                continue;
            };
            let (line, _) = place(&error, &damaged);
            let expected = position(&damaged, number.span.start).0;
            assert_eq!(line, expected, "{} = {instead}: {error}", number.path);
        }
    }
}
