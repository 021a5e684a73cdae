//! Scenes cut short, and brackets that do not pair.

use pliant_scene::Scene;

use crate::scan::{brackets, closing, punctuation};
use crate::{FILE, place, position, refusal, scenes};

#[test]
fn a_scene_cut_short_at_any_byte_is_refused_on_its_last_line() {
    for (name, text) in scenes() {
        let end = text.trim_end().len();
        for cut in 0..text.len() {
            let bytes = &text.as_bytes()[..cut];
            let what = format!("{name} cut at byte {cut}");
            match Scene::from_bytes(bytes, FILE) {
                Ok(_) => assert!(cut >= end, "{what} was accepted"),
                Err(error) => {
                    assert!(cut < end, "{what}: only blanks are missing: {error}");
                    let left = String::from_utf8_lossy(bytes);
                    let (line, column) = place(&error, &left);
                    let last = position(&left, left.len());
                    assert_eq!(line, last.0, "{what}: {error}");
                    assert!(column <= last.1, "{what}: {error}");
                }
            }
        }
    }
}

#[test]
fn a_scene_that_ends_between_two_words_says_that_it_ends_too_early() {
    for (name, text) in scenes() {
        for at in punctuation(&text) {
            let left = &text[..=at];
            if left.trim_end() == text.trim_end() {
                continue;
            }
            let (error, found) = refusal(left, &name);
            assert_eq!(found, position(left, left.len()), "{error}");
            let message = error.fault.to_string();
            assert!(message.starts_with("the text ends too early; "), "{error}");
        }
    }
}

#[test]
fn a_bracket_left_out_or_doubled_is_refused_behind_what_it_opens() {
    for (name, text) in scenes() {
        for at in brackets(&text) {
            let bracket = &text[at..=at];
            let line = position(&text, at).0;
            for instead in ["", "((", "[[", "))", "]]"] {
                let doubled = instead.starts_with(bracket);
                if !instead.is_empty() && !doubled {
                    continue;
                }
                let damaged = format!("{}{instead}{}", &text[..at], &text[at + 1..]);
                let what = format!("{name}: `{bracket}` at line {line} as `{instead}`");
                let (error, (found, _)) = refusal(&damaged, &what);
                assert!(found >= line, "{what}: {error}");
                // What is wrong with a bracket shows before the thing it opens is over, or in the next thing.
                let over = if "([".contains(bracket) {
                    position(&text, closing(&text, at)).0
                } else {
                    line
                };
                assert!(found <= over + 2, "{what}: {error}");
            }
        }
    }
}

#[test]
fn a_bracket_of_the_other_kind_is_refused() {
    for (name, text) in scenes() {
        for at in brackets(&text) {
            let instead = match &text[at..=at] {
                "(" => "[",
                "[" => "(",
                ")" => "]",
                _ => ")",
            };
            let damaged = format!("{}{instead}{}", &text[..at], &text[at + 1..]);
            let line = position(&text, at).0;
            let what = format!("{name}: `{instead}` at line {line}");
            let (error, (found, _)) = refusal(&damaged, &what);
            // What does not begin with `(` is told at its first line.
            assert_eq!(found, line, "{what}: {error}");
        }
    }
}
