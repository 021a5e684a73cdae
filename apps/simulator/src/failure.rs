//! How a command ends when it does not end well.

use pliant_scene::SceneError;

/// Decides the exit code.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The input is wrong and the user has been told: exit code 1.
    Reported,
    /// The input is wrong: exit code 1.
    Input(String),
    /// A device, the disk or the system failed: exit code 3.
    System(String),
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::Input(error.to_string())
    }
}
