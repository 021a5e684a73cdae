//! Automation of the project: `cargo xtask ci` is everything a change must pass, the other commands are its parts and the
//! campaigns and benchmarks that take longer.
//!
//! Checks read the working tree and never write to it; what they build goes to the target folder.

#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command-line tool speaks on its standard streams"
)]

mod campaign;
mod ci;
mod examples;
mod finding;
mod layering;
mod package;
mod process;
mod tidy;
mod unused;
mod workspace;

use anyhow::Result;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

#[derive(Parser)]
#[command(name = "cargo xtask", about = "Project automation")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Everything a change must pass, fast checks first; with names, only those steps
    Ci {
        /// Steps to run, in the order of `ci`; all when none is named
        steps: Vec<ci::Step>,
    },
    /// House rules over the files git knows or would add
    Tidy,
    /// Crate edges, outside crates and manifest inheritance against the table in `layering/table.rs`
    Layering,
    /// Dependencies that no source of their crate names
    Unused,
    /// Runs every example of every library crate
    Examples,
    /// Packs the library crates and builds each from its tarball
    Package,
    /// Benchmarks, for example `bench tick`; arguments go to the `bench` program of `pliant-tests`
    Bench {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
    /// Campaigns, for example `validate contact --full`; arguments go to the `validate` program of `pliant-tests`
    Validate {
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<String>,
    },
}

fn main() -> ExitCode {
    match run(&Arguments::parse().command) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(command: &Command) -> Result<ExitCode> {
    match command {
        Command::Bench { arguments } => return campaign::run("bench", arguments),
        Command::Validate { arguments } => return campaign::run("validate", arguments),
        Command::Ci { steps } => ci::run(steps)?,
        Command::Tidy => tidy::check()?,
        Command::Layering => layering::check()?,
        Command::Unused => unused::check()?,
        Command::Examples => examples::check()?,
        Command::Package => package::check()?,
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn command_line_definition_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn campaign_flags_pass_through() {
        let parsed = Arguments::try_parse_from(["xtask", "validate", "contact", "--full"]).unwrap();
        let Command::Validate { arguments } = parsed.command else {
            panic!("parsed as another command");
        };
        assert_eq!(arguments, ["contact", "--full"]);
    }
}
