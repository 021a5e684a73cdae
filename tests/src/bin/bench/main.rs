//! `bench tick`, `bench collision` and `bench beam`, each with `[--json FILE]`: times, as a table and as JSON.
#![allow(clippy::print_stdout, reason = "a command that prints its report")]

mod beam;
mod collision;
mod tick;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use serde::Serialize;

#[derive(Parser)]
struct Arguments {
    /// What to measure.
    subject: Subject,
    /// Where the figures go; `target/bench/SUBJECT.json` when not given.
    #[arg(long)]
    json: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum Subject {
    /// One tick of the simulation
    Tick,
    /// Solvers of the beam crate beside `nalgebra` and `faer`
    Beam,
    /// Queries of the collision crate beside those of `parry3d-f64`
    Collision,
}

fn main() -> Result<()> {
    let Arguments { subject, json } = Arguments::parse();
    match subject {
        Subject::Tick => tick::run(&json.unwrap_or_else(|| "target/bench/tick.json".into())),
        Subject::Beam => beam::run(&json.unwrap_or_else(|| "target/bench/beam.json".into())),
        Subject::Collision => {
            collision::run(&json.unwrap_or_else(|| "target/bench/collision.json".into()))
        }
    }
}

fn write_json(json: &Path, figures: &impl Serialize) -> Result<()> {
    if let Some(folder) = json.parent() {
        std::fs::create_dir_all(folder)
            .with_context(|| format!("creating {}", folder.display()))?;
    }
    std::fs::write(json, serde_json::to_string_pretty(figures)?)
        .with_context(|| format!("writing {}", json.display()))?;
    println!("written to {}", json.display());
    Ok(())
}
