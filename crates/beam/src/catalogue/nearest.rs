//! What an unknown name may have meant.

use super::ToolEntry;
use crate::error::BeamError;

/// How many names are suggested.
const SUGGESTIONS: usize = 3;

/// Characters of the name asked for that are looked at and repeated.
const LOOKED_AT: usize = 60;

/// The error with the names most like the one asked for first.
pub(super) fn unknown(name: &str, tools: &[ToolEntry]) -> BeamError {
    let asked: Vec<char> = name.chars().take(LOOKED_AT).collect();
    let plain: Vec<char> = asked.iter().map(char::to_ascii_lowercase).collect();
    let mut names: Vec<&str> = tools.iter().map(|entry| entry.name).collect();
    let all = names.join(", ");
    names.sort_by_cached_key(|candidate| edits(&plain, candidate));
    names.truncate(SUGGESTIONS);
    BeamError::UnknownTool {
        name: asked.into_iter().collect(),
        nearest: names.join(", "),
        names: all,
    }
}

/// Fewest characters to insert, drop or exchange (Levenshtein 1966). Characters to insert count half: people shorten names.
fn edits(from: &[char], to: &str) -> usize {
    let mut row: Vec<usize> = (0..=from.len()).map(|dropped| 2 * dropped).collect();
    for wanted in to.chars() {
        let mut diagonal = row[0];
        row[0] += 1;
        for (index, own) in from.iter().enumerate() {
            let exchanged = diagonal + 2 * usize::from(*own != wanted);
            diagonal = row[index + 1];
            row[index + 1] = exchanged.min(diagonal + 1).min(row[index] + 2);
        }
    }
    row[from.len()]
}
