//! Bytes that have no place in a text, nesting and lengths beyond reason, and other systems' line ends.

use std::fmt::Write as _;

use pliant_scene::Scene;

use crate::{FILE, FULL, place, position, refusal, scenes};

#[test]
fn a_byte_that_is_no_text_is_refused_where_it_stands() {
    for (name, text) in scenes() {
        for at in (0..text.len()).filter(|&at| text.is_char_boundary(at)) {
            for (byte, part) in [
                (0xff, "not UTF-8"),
                (0xc3, "not UTF-8"),
                (0x00, "control character (byte 0)"),
                (0x1b, "control character (byte 27)"),
            ] {
                let mut bytes = text.clone().into_bytes();
                bytes.insert(at, byte);
                let what = format!("{name}: byte {byte} at {at}");
                let error = Scene::from_bytes(&bytes, FILE).expect_err(&what);
                let message = error.fault.to_string();
                if message.contains("looks like") {
                    // In front of everything it is not a scene at all.
                    assert!(
                        text[..at].trim().is_empty() || !text[..at].contains('('),
                        "{what}: {error}"
                    );
                    continue;
                }
                assert!(message.contains(part), "{what}: {error}");
                let readable = String::from_utf8_lossy(&bytes);
                assert_eq!(
                    place(&error, &readable),
                    position(&text, at),
                    "{what}: {error}"
                );
            }
        }
    }
}

#[test]
fn line_ends_and_marks_of_other_systems_change_nothing() {
    for (name, text) in scenes() {
        let windows = text.replace('\n', "\r\n");
        let marked = format!("\u{feff}{windows}");
        let expected = Scene::from_str(&text, FILE).unwrap();
        for other in [&windows, &marked] {
            let scene = Scene::from_bytes(other.as_bytes(), FILE).unwrap();
            assert_eq!(scene.description(), expected.description(), "{name}");
        }
        // And faults keep their places.
        let (_, found) = refusal(&text.replacen("name:", "nmae:", 1), &name);
        let (_, found_there) = refusal(&windows.replacen("name:", "nmae:", 1), &name);
        let error = Scene::from_str(&marked.replacen("name:", "nmae:", 1), FILE).unwrap_err();
        assert_eq!(found, found_there, "{name}");
        assert_eq!(found, place(&error, &windows), "{name}");
        // A mark in the middle is no blank.
        let (error, _) = refusal(&text.replacen("tool:", "\u{feff}tool:", 1), &name);
        assert!(error.to_string().contains("expected"), "{error}");
    }
}

#[test]
fn nesting_beyond_reason_is_refused() {
    for bracket in [
        "(",
        "[",
        "{",
        "Some(",
        "(a:",
        "a(b:[",
        "((",
        "/*",
        "#![enable(",
        "-",
        "r\"",
    ] {
        let deep = bracket.repeat(100_000);
        for text in [
            deep.clone(),
            format!("({deep}"),
            format!("(tool: {deep}"),
            format!("(colour: {deep}"),
            format!("(objects: [{deep}"),
            FULL.replacen("(1, 2, -0.025)", &deep, 1),
            FULL.replacen("\"plate\"", &deep, 1),
            FULL.replacen("paper,", &deep, 1),
        ] {
            let (error, _) = refusal(&text, bracket);
            assert!(error.to_string().len() < 2000, "{error}");
        }
    }
    let closed = format!(
        "(description: {}{})",
        "[".repeat(100_000),
        "]".repeat(100_000)
    );
    refusal(&closed, "closed brackets");
    let comment = format!("{}{}{FULL}", "/*".repeat(100_000), "*/".repeat(100_000));
    Scene::from_str(&comment, FILE).unwrap();
}

#[test]
fn a_hundred_megabytes_of_blanks_are_read() {
    let blank = " ".repeat(100_000_000);
    let error = Scene::from_bytes(blank.as_bytes(), FILE).unwrap_err();
    assert!(
        error
            .to_string()
            .starts_with("f/s.ron:1:1: the file is empty"),
        "{error}"
    );
    let text = FULL.replacen("(\n", &format!("(\n{blank}"), 1);
    drop(blank);
    let scene = Scene::from_str(&text, FILE).unwrap();
    assert_eq!(scene.description().objects.len(), 9);
}

#[test]
fn messages_quote_the_beginning_of_what_is_long() {
    let long = "x".repeat(1_000_000);
    for (old, new) in [
        ("plate(", format!("{long}(")),
        ("width:", format!("{long}:")),
        ("1000,", format!("{long},")),
        ("1000,", format!("\"{long}\",")),
        ("1000,", format!("{}{long},", "1".repeat(100_000))),
        ("1000,", format!("{},", "1".repeat(100_000))),
        ("paper,", format!("{long},")),
        ("mm,", format!("{long},")),
        ("(1, 2, -0.025)", format!("\"{long}\"")),
        ("(axis:", format!("{long}(axis:")),
        ("(\n", format!("({long}\n")),
        ("(\n", format!("{long}(\n")),
        ("name:", format!("{long} name:")),
        ("\"plate\"", format!("\"{long}")),
        ("#", format!("#![enable({long})]\n")),
    ] {
        let text = if old == "#" {
            format!("{new}{FULL}")
        } else {
            FULL.replacen(old, &new, 1)
        };
        let (error, _) = refusal(&text, old);
        assert!(
            error.to_string().len() < 2000,
            "{old}: {} bytes",
            error.to_string().len()
        );
    }
    // Of two equal names, and of files that are not there.
    let named = FULL
        .replace("\"plate\"", &format!("\"{long}\""))
        .replace("\"tube\"", &format!("\"{long}\""));
    assert!(refusal(&named, "names").0.to_string().len() < 2000);
    let scene = Scene::from_str(
        &FULL.replacen("m.csv", &long, 1).replacen("a.obj", &long, 1),
        FILE,
    )
    .unwrap();
    let error = scene
        .build(&pliant_scene::MemoryFiles::default())
        .unwrap_err();
    assert!(error.to_string().len() < 2000);
}

#[test]
fn a_hundred_thousand_objects_are_read_and_told_apart() {
    let mut objects = String::new();
    for number in 0..100_000 {
        writeln!(
            objects,
            "(name: \"o{number}\", shape: cuboid(size: (1, 1, 1))),"
        )
        .unwrap();
    }
    let text = FULL.replacen("objects: [", &format!("objects: [\n{objects}"), 1);
    Scene::from_str(&text, FILE).unwrap();
    let (error, _) = refusal(&text.replacen("\"tube\"", "\"o99999\"", 1), "a name again");
    assert!(
        error
            .to_string()
            .contains("another object is named \"o99999\" too, at f/s.ron:100018:8"),
        "{error}"
    );
}
