//! Long runs: the programs of `pliant-tests`, always in release, with their exit code kept.

use crate::process;
use anyhow::{Context, Result};
use std::process::ExitCode;

/// Runs program `name` of `pliant-tests` with `arguments` and hands back its exit code.
///
/// # Errors
/// When cargo cannot be started.
pub(crate) fn run(name: &str, arguments: &[String]) -> Result<ExitCode> {
    let mut command = process::cargo(&[
        "run",
        "--release",
        "--package",
        "pliant-tests",
        "--bin",
        name,
        "--",
    ]);
    command.args(arguments);
    let status = command.status().context("cargo could not be started")?;
    // No code means a signal ended it: that is a failure of the program.
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
