//! `bench tick [--json FILE]` and `bench collision [--json FILE]`: times, as a table and as JSON.
#![allow(clippy::print_stdout, reason = "a command that prints its report")]

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
    /// Queries of the collision crate beside those of `parry3d-f64`
    Collision,
}

fn main() -> Result<()> {
    let Arguments { subject, json } = Arguments::parse();
    match subject {
        Subject::Tick => tick::run(&json.unwrap_or_else(|| "target/bench/tick.json".into())),
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
