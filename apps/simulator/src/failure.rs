//! How a command ends when it does not end well.

use std::process::ExitCode;

use clap::CommandFactory;
use clap::error::ErrorKind;
use pliant_scene::SceneError;

use crate::cli::Cli;
use crate::output;

/// Decides the exit code.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input is wrong and the user has been told: exit code 1.
    Reported,
    /// The input is wrong: exit code 1.
    Input(String),
    /// Arguments do not go together: exit code 2.
    Usage(String),
    /// A device, the disk or the system failed: exit code 3.
    System(String),
}

impl Failure {
    /// Tells the user, as far as that has not been done.
    pub(crate) fn report(&self) -> ExitCode {
        match self {
            Self::Reported => ExitCode::from(1),
            Self::Input(message) => {
                output::note(message);
                ExitCode::from(1)
            }
            Self::Usage(message) => {
                // In the words and colours of all other faults of usage.
                let mut command = Cli::command();
                command.build();
                let found = command.find_subcommand("run").cloned();
                let mut command = found.unwrap_or(command);
                let _ = command.error(ErrorKind::ArgumentConflict, message).print();
                ExitCode::from(2)
            }
            Self::System(message) => {
                output::note(message);
                ExitCode::from(3)
            }
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::Input(error.to_string())
    }
}
