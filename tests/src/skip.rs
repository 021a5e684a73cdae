//! How a test says what it could not try.

use std::io::{Write, stderr};

/// Says on standard error that `cases` cases are skipped for `reason`. Written past the test harness, which swallows what a passing test
/// prints with the print macros.
pub fn skipped(cases: usize, reason: &str) {
    // Nobody can be told that telling failed.
    let _ = writeln!(stderr(), "skipped {cases} cases: {reason}");
}
