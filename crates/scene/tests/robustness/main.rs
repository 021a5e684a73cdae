//! Whatever is wrong with a scene or a motion, the reader says what, at a line and column that exist and are near.
//!
//! Every shipped scene and one with every field there is, damaged in every place: cut short, fields removed, renamed and
//! doubled, numbers and brackets exchanged. What must happen is told from the text alone, by a scanner of its own.
#![allow(clippy::unwrap_used, reason = "a failed step fails the test")]

mod bytes;
mod cuts;
mod fields;
mod scan;
mod trajectories;

use std::path::Path;

use pliant_scene::{Place, Scene, SceneError};

/// The name under which texts are read.
const FILE: &str = "f/s.ron";

/// Every field of the schema and every kind of shape.
const FULL: &str = include_str!("full.ron");

/// All texts to damage, with their names.
fn scenes() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut scenes: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ron"))
        .map(|path| {
            (
                path.display().to_string(),
                std::fs::read_to_string(path).unwrap(),
            )
        })
        .collect();
    scenes.sort();
    assert_eq!(scenes.len(), 6, "the shipped scenes");
    scenes.push(("full.ron".to_owned(), FULL.to_owned()));
    scenes
}

/// Line and column of byte `at`, from 1, columns in characters.
fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text[..at];
    let line = before.split('\n').count();
    let column = before.rsplit('\n').next().unwrap().chars().count() + 1;
    (line, column)
}

/// Line and column of an error, which must lie in `text`; its message must say something and name the place.
fn place(error: &SceneError, text: &str) -> (usize, usize) {
    let Place::File { file, line, column } = &error.place else {
        panic!("{error}: no place in a file");
    };
    assert_eq!(file, FILE);
    let message = error.to_string();
    let rest = message.strip_prefix(&format!("{FILE}:{line}:{column}: "));
    assert!(rest.is_some_and(|rest| rest.len() > 10), "{message}");
    // Names of the reader's own library and types would tell a user nothing.
    for foreign in [
        "RON syntax",
        "serde",
        "Option",
        "f64",
        "struct",
        "identifier",
        "r#",
    ] {
        assert!(!message.contains(foreign), "{message}");
    }
    let lines: Vec<&str> = text.split('\n').collect();
    let found = lines.get(line - 1);
    let found = found.unwrap_or_else(|| panic!("{message}: there are {} lines", lines.len()));
    assert!(
        (1..=found.chars().count() + 1).contains(column),
        "{message}: that line is `{found}`"
    );
    (*line, *column)
}

/// The error of a damaged text, with its place.
fn refusal(text: &str, what: &str) -> (SceneError, (usize, usize)) {
    match Scene::from_str(text, FILE) {
        Ok(_) => panic!("{what} was accepted:\n{text}"),
        Err(error) => {
            let place = place(&error, text);
            (error, place)
        }
    }
}
