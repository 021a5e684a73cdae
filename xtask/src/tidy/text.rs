//! Rules about single lines and the length of a file.

use super::{File, by_line, is_handwritten, is_rust};
use crate::finding::Finding;

/// A file longer than this holds more than one thing.
const MAX_LINES: usize = 500;

/// Notes to oneself: they belong into the list of work, not into the source. In pieces, as this file is checked too.
const NOTES: [&str; 3] = [
    concat!("TO", "DO"),
    concat!("FIX", "ME"),
    concat!("X", "XX"),
];

/// Code that stands for code not written, left-over debugging, tests switched off.
const LEFT_OVERS: [&str; 4] = [
    concat!("todo", "!"),
    concat!("unimplemented", "!"),
    concat!("dbg", "!"),
    concat!("#[", "ignore"),
];

/// At most [`MAX_LINES`] lines a source file.
pub(super) fn length(file: File<'_>) -> Vec<Finding> {
    let lines = file.text.lines().count();
    if !is_rust(file.path) || lines <= MAX_LINES {
        return Vec::new();
    }
    vec![Finding::whole(
        file.path,
        format!("{lines} lines, at most {MAX_LINES}: split it by what it holds"),
    )]
}

/// Nothing half done.
pub(super) fn markers(file: File<'_>) -> Vec<Finding> {
    if !is_handwritten(file.path) {
        return Vec::new();
    }
    by_line(file, |line| {
        let left_over = LEFT_OVERS.iter().find(|marker| line.contains(*marker));
        let marker = left_over.or_else(|| NOTES.iter().find(|note| contains_word(line, note)))?;
        Some(format!("`{marker}`: finish it or leave it out"))
    })
}

/// No trailing white space, no carriage returns, one final newline; no tabs in Rust.
pub(super) fn white_space(file: File<'_>) -> Vec<Finding> {
    if !is_handwritten(file.path) || file.text.is_empty() {
        return Vec::new();
    }
    // `lines` would swallow a carriage return.
    let lines = file.text.split('\n').enumerate();
    let mut findings: Vec<Finding> = lines
        .filter_map(|(at, line)| {
            Some(Finding::at(
                file.path,
                at + 1,
                judge_white_space(file.path, line)?,
            ))
        })
        .collect();
    if !file.text.ends_with('\n') || file.text.ends_with("\n\n") {
        findings.push(Finding::whole(
            file.path,
            "must end with exactly one newline",
        ));
    }
    findings
}

fn judge_white_space(path: &str, line: &str) -> Option<&'static str> {
    if line.ends_with(char::is_whitespace) {
        return Some("trailing white space");
    }
    (is_rust(path) && line.contains('\t'))
        .then_some("tab; indent with spaces, write `\\t` in strings")
}

/// Each item has one path a reader can search for.
pub(super) fn no_glob_exports(file: File<'_>) -> Vec<Finding> {
    if !is_rust(file.path) {
        return Vec::new();
    }
    by_line(file, |line| {
        let line = line.trim();
        let exports = line.starts_with("pub") && line.contains(" use ") && line.ends_with("::*;");
        exports.then_some("glob re-export: name the items")
    })
}

fn contains_word(line: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(word).any(|(at, _)| {
        !line[..at].ends_with(is_part) && !line[at + word.len()..].starts_with(is_part)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rust(text: &str) -> File<'_> {
        File { path: "a.rs", text }
    }

    #[test]
    fn long_files_are_found() {
        let text = "x\n".repeat(MAX_LINES);
        assert!(length(rust(&text)).is_empty());
        let longer = format!("{text}x\n");
        assert!(length(rust(&longer))[0].message.starts_with("501 lines"));
        assert!(
            length(File {
                path: "a.md",
                text: &longer
            })
            .is_empty()
        );
    }

    #[test]
    fn each_marker_is_found() {
        for marker in NOTES.iter().chain(&LEFT_OVERS) {
            let text = format!("fn a() {{}}\n// {marker} later\n");
            let found = markers(rust(&text));
            assert_eq!(found.len(), 1, "{marker}");
            assert_eq!(found[0].line, 2);
            assert!(
                markers(File {
                    path: "a.obj",
                    text: &text
                })
                .is_empty()
            );
        }
    }

    #[test]
    fn words_that_hold_a_note_are_fine() {
        let text = format!("M{}N, {}S\n", NOTES[0], NOTES[0]);
        assert!(markers(rust(&text)).is_empty());
    }

    #[test]
    fn white_space_is_found() {
        let messages = |text| {
            white_space(rust(text))
                .iter()
                .map(Finding::to_string)
                .collect::<Vec<_>>()
        };
        assert_eq!(messages("a\n"), Vec::<String>::new());
        assert_eq!(messages("a \nb\n"), ["a.rs:1: trailing white space"]);
        assert_eq!(messages("a\r\n"), ["a.rs:1: trailing white space"]);
        assert_eq!(messages("a\n\tb\n").len(), 1);
        assert_eq!(messages("a"), ["a.rs: must end with exactly one newline"]);
        assert_eq!(messages("a\n\n").len(), 1);
        assert!(
            white_space(File {
                path: "a.md",
                text: "a\tb\n"
            })
            .is_empty()
        );
    }

    #[test]
    fn glob_exports_are_found() {
        assert_eq!(no_glob_exports(rust("pub use load::*;\n")).len(), 1);
        assert_eq!(no_glob_exports(rust("pub(crate) use load::*;\n")).len(), 1);
        assert!(no_glob_exports(rust("pub use load::{obj, stl};\nuse super::*;\n")).is_empty());
    }
}
