//! Haptic rendering through flexible tools: the command line.
//!
//! `pliant run` steps a scene in virtual time and reports on it, `pliant check` says what is in a file. Exit codes: 0
//! fine, 1 the input is wrong, 2 usage, 3 a device or system fault.

mod check;
mod cli;
mod embedded;
mod failure;
mod output;
mod plot;
mod run;
mod settings;
mod summary;
mod survey;
mod trace;

use std::process::ExitCode;

use clap::Parser;

use crate::cli::{Cli, Command, RunArguments};

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match cli.command {
        Some(Command::Run(arguments)) => run::run(&arguments),
        Some(Command::Check(arguments)) => check::check(&arguments),
        None => {
            let arguments = RunArguments::of_scene(cli.scene);
            let scene = &arguments.scene;
            output::note(&format!(
                "pliant: this version has no window; running {} headless",
                scene
                    .as_ref()
                    .map_or(embedded::NAME.into(), |path| path.display().to_string())
            ));
            run::run(&arguments)
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
