//! The one CI command: its steps in order, timed, up to the first that fails.
//!
//! The steps from clippy to packages share the dev profile and one feature set, so third-party crates are compiled at most twice:
//! once to be checked (clippy, docs, packages) and once to be linked (tests, examples).

use crate::process::{self, cargo};
use crate::{examples, layering, package, tidy, unused};
use anyhow::{Context, Result, ensure};
use clap::ValueEnum;
use std::path::PathBuf;
use std::process::Command;
use std::time::{Duration, Instant};

/// One step, in the order in which they run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub(crate) enum Step {
    /// Formatting
    Fmt,
    /// House rules
    Tidy,
    /// Crate edges
    Layering,
    /// Unused dependencies
    Unused,
    /// Lints, as errors
    Clippy,
    /// All tests
    Test,
    /// Every example of a library crate runs
    Examples,
    /// Documentation, warnings as errors
    Docs,
    /// Library crates build from their tarballs
    Package,
}

/// How one step went.
struct Outcome {
    step: Step,
    time: Duration,
    passed: bool,
}

/// Runs the steps named, or all, and prints a table of their times.
///
/// # Errors
/// When a component of the toolchain is missing or a step fails; later steps do not run.
pub(crate) fn run(named: &[Step]) -> Result<()> {
    let steps = in_order(named);
    require_components(&steps)?;
    let mut outcomes = Vec::new();
    let mut failure = Ok(());
    for (at, step) in steps.iter().enumerate() {
        println!("==> [{}/{}] {}", at + 1, steps.len(), name(*step));
        let start = Instant::now();
        failure = perform(*step);
        let outcome = Outcome {
            step: *step,
            time: start.elapsed(),
            passed: failure.is_ok(),
        };
        println!(
            "    {} in {:.1} s",
            if outcome.passed { "passed" } else { "FAILED" },
            outcome.time.as_secs_f64()
        );
        outcomes.push(outcome);
        if failure.is_err() {
            break;
        }
    }
    print!("\n{}", table(&outcomes, steps.len()));
    failure.with_context(|| {
        format!(
            "step {} failed",
            outcomes
                .last()
                .map_or_else(String::new, |last| name(last.step))
        )
    })
}

fn in_order(named: &[Step]) -> Vec<Step> {
    let all = Step::value_variants();
    all.iter()
        .copied()
        .filter(|step| named.is_empty() || named.contains(step))
        .collect()
}

fn perform(step: Step) -> Result<()> {
    match step {
        Step::Fmt => process::run(&mut cargo(&["fmt", "--all", "--check"])),
        Step::Tidy => tidy::check(),
        Step::Layering => layering::check(),
        Step::Unused => unused::check(),
        Step::Clippy => process::run(&mut cargo(&[
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "--deny",
            "warnings",
        ])),
        Step::Test => process::run(&mut tests()),
        Step::Examples => examples::check(),
        Step::Docs => process::run(
            cargo(&["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "--deny warnings"),
        ),
        Step::Package => package::check(),
    }
}

/// All tests; without the folder of test data where `PLIANT_DATA` names none, as on a machine that has only this repository.
fn tests() -> Command {
    let mut tests = cargo(&["test", "--workspace"]);
    let named = std::env::var_os("PLIANT_DATA").map(PathBuf::from);
    if let Some(folder) = named.filter(|folder| !folder.is_dir()) {
        println!(
            "    PLIANT_DATA names {}, which is no folder: tests that need it are skipped",
            folder.display()
        );
        tests.env_remove("PLIANT_DATA");
    }
    tests
}

/// Rustup may install a toolchain without these; without the check cargo speaks of an unknown command.
fn require_components(steps: &[Step]) -> Result<()> {
    for (step, command, component) in [
        (Step::Fmt, "fmt", "rustfmt"),
        (Step::Clippy, "clippy", "clippy"),
    ] {
        let needed = steps.contains(&step);
        ensure!(
            !needed || process::succeeds(&mut cargo(&[command, "--version"])),
            "the toolchain lacks {component}: install it with `rustup component add {component}`"
        );
    }
    Ok(())
}

fn name(step: Step) -> String {
    step.to_possible_value()
        .map_or_else(String::new, |value| value.get_name().to_owned())
}

fn table(outcomes: &[Outcome], planned: usize) -> String {
    let row = |name: &str, time: Duration, note: &str| {
        format!("{name:<10} {:>8.1} s{note}\n", time.as_secs_f64())
    };
    let steps = outcomes.iter().map(|Outcome { step, time, passed }| {
        let note = if *passed { "  passed" } else { "  FAILED" };
        row(&name(*step), *time, note)
    });
    let left = planned - outcomes.len();
    let note = if left == 0 {
        String::new()
    } else {
        format!("  {left} not run")
    };
    let total = row(
        "total",
        outcomes.iter().map(|outcome| outcome.time).sum(),
        &note,
    );
    steps.chain([total]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_steps_run_and_named_ones_keep_the_order() {
        assert_eq!(in_order(&[]).len(), 9);
        assert_eq!(in_order(&[Step::Docs, Step::Fmt]), [Step::Fmt, Step::Docs]);
    }

    #[test]
    fn table_tells_what_failed_and_what_never_ran() {
        let outcome = |step, seconds, passed| Outcome {
            step,
            time: Duration::from_secs(seconds),
            passed,
        };
        let text = table(
            &[
                outcome(Step::Fmt, 1, true),
                outcome(Step::Clippy, 61, false),
            ],
            9,
        );
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "fmt             1.0 s  passed");
        assert_eq!(lines[1], "clippy         61.0 s  FAILED");
        assert_eq!(lines[2], "total          62.0 s  7 not run");
    }
}
