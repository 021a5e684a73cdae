//! `validate contact [--full]` and `validate collision [FILE] [--full]`: reference cases and random campaigns, whole or as the
//! subset that CI runs. Exits 1 on any failure.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command that prints its report"
)]

mod collision;
mod contact;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use pliant_tests::campaign::{full_runs, short_runs};

#[derive(Parser)]
struct Arguments {
    #[command(subcommand)]
    subject: Subject,
}

/// What to validate.
#[derive(Subcommand)]
enum Subject {
    /// Random campaigns of the separating-plane method
    Contact {
        /// Every run instead of the fixed-seed subset
        #[arg(long)]
        full: bool,
    },
    /// Reference pairs of convex shapes
    Collision {
        /// A file of the format "convex-pairs-1"; the one of this repository when none is named
        file: Option<PathBuf>,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().subject {
        Subject::Contact { full: true } => contact::validate(&full_runs()),
        Subject::Contact { full: false } => contact::validate(&short_runs()),
        Subject::Collision { file } => {
            collision::validate_file(&file.unwrap_or_else(collision::open_file))
        }
    }
}
