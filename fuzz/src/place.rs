//! Errors of scenes and trajectories name a place that exists.

use pliant_scene::{Place, SceneError};

/// Longest message a person still reads; what was found is shortened to fit.
const LONGEST_MESSAGE: usize = 4096;

/// Panics unless `error`, found in `text` read as `file`, says what is wrong and where, within the text. Errors at other
/// files and at overrides need a message only.
pub fn judge_place(error: &SceneError, file: &str, text: &[u8]) {
    let message = error.fault.to_string();
    assert!(!message.trim().is_empty(), "an empty message: {error:?}");
    assert!(
        message.len() <= LONGEST_MESSAGE + text.len(),
        "{} bytes of message",
        message.len()
    );
    let Place::File {
        file: named,
        line,
        column,
    } = &error.place
    else {
        return;
    };
    if named != file {
        return;
    }
    let text = String::from_utf8_lossy(text);
    let found = text.split('\n').nth(line.wrapping_sub(1));
    let Some(found) = found else {
        panic!("line {line} of {} lines: {error}", text.split('\n').count());
    };
    // One past the last character is where something is missing.
    let length = found.chars().count();
    assert!(
        (1..=length + 1).contains(column),
        "column {column} of {length}: {error}"
    );
}
