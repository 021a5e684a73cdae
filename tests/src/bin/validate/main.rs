//! `validate beam [FILE]`, `validate contact [--full]` and `validate collision [FILE] [--full]`: reference cases and random campaigns, whole or as the
//! subset that CI runs. Exits 1 on any failure.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command that prints its report"
)]

mod beam;
mod collision;
mod contact;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use pliant_tests::campaign::{full_runs, short_runs};
use pliant_tests::collision::campaign::Extent;

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
    /// Reference cases of beams
    Beam {
        /// A file of such cases; the one of this repository when none is named
        file: Option<PathBuf>,
    },
    /// Reference pairs of convex shapes, or random pairs against the oracle
    Collision {
        /// A file of the format "convex-pairs-1"; the one of this repository when none is named
        #[arg(conflicts_with = "full")]
        file: Option<PathBuf>,
        /// The file of this repository and then more than 10⁶ random pairs
        #[arg(long)]
        full: bool,
        /// Random pairs of each family and two kinds of shape
        #[arg(long, requires = "full", default_value_t = Extent::FULL.pairs_per_cell)]
        pairs_per_cell: u32,
    },
}

fn main() -> ExitCode {
    match Arguments::parse().subject {
        Subject::Contact { full: true } => contact::validate(&full_runs()),
        Subject::Contact { full: false } => contact::validate(&short_runs()),
        Subject::Beam { file } => beam::validate_file(&file.unwrap_or_else(beam::open_file)),
        Subject::Collision {
            full: true,
            pairs_per_cell,
            ..
        } => collision::validate_all(Extent {
            pairs_per_cell,
            ..Extent::FULL
        }),
        Subject::Collision { file, .. } => {
            collision::validate_file(&file.unwrap_or_else(collision::open_file))
        }
    }
}
