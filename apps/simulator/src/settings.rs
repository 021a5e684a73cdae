//! What the command line lays over a scene, and which files a run may write.

use std::cell::RefCell;
use std::io;
use std::path::{Path, PathBuf};

use pliant_scene::{Fault, Files, Override, Place, SceneError};

use crate::cli::RunArguments;
use crate::failure::Failure;
use crate::output;

/// Names `--trajectory` at the head of its errors.
const TRAJECTORY: &str = "--trajectory ";

/// What the command line sets, `--set` last.
///
/// # Errors
/// Usage, when an option and a `--set` are about the same field: neither would be the obvious winner.
pub(crate) fn overrides(arguments: &RunArguments) -> Result<Vec<Override>, Failure> {
    let mut overrides = options(arguments)?;
    let fixed: Vec<(String, String)> = overrides
        .iter()
        .map(|option| (option.argument.clone(), option.path.clone()))
        .chain(
            arguments
                .ticks
                .map(|ticks| (format!("--ticks {ticks}"), "seconds".to_owned())),
        )
        .collect();
    for setting in &arguments.set {
        let setting =
            Override::parse(setting).map_err(|error| Failure::Usage(error.to_string()))?;
        let clash = fixed
            .iter()
            .find(|(_, field)| concerns(&setting.path, field));
        if let Some((option, field)) = clash {
            return Err(Failure::Usage(format!(
                "`{option}` and `{}` both decide `{field}` of the scene; give one of them",
                setting.argument
            )));
        }
        overrides.push(setting);
    }
    Ok(overrides)
}

/// Whether setting `path` changes `field`: the field itself, or a whole that it is a part of.
fn concerns(path: &str, field: &str) -> bool {
    field
        .strip_prefix(path)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// Options that stand for a field of the scene.
fn options(arguments: &RunArguments) -> Result<Vec<Override>, Failure> {
    let mut options = Vec::new();
    let mut set = |flag: &str, path: &str, value: String| {
        options.push(Override {
            argument: format!("{flag} {value}"),
            path: path.to_owned(),
            value,
        });
    };
    if let Some(method) = arguments.method {
        set("--method", "method", method.name().to_owned());
    }
    if let Some(rate) = arguments.rate {
        set("--rate", "rate_hz", rate.to_string());
    }
    if let Some(seconds) = arguments.seconds {
        set("--seconds", "seconds", format!("{seconds:?}"));
    }
    if let Some(device) = &arguments.device {
        set("--device", "device", device.clone());
    }
    if let Some(path) = &arguments.trajectory {
        // From where the user stands, not from the folder of the scene.
        let argument = format!("{TRAJECTORY}{}", path.display());
        let absolute = std::path::absolute(path)
            .map_err(|error| Failure::Input(format!("{argument}: {error}")))?;
        let value = absolute.to_str().ok_or_else(|| {
            Failure::Input(format!(
                "{argument}: the path is not UTF-8; rename the file"
            ))
        })?;
        options.push(Override::string(argument, "trajectory.path", value));
    }
    Ok(options)
}

/// A scene's error; files named on the command line are sought elsewhere than those named in a scene.
pub(crate) fn explained(error: SceneError) -> Failure {
    match (&error.place, &error.fault) {
        (Place::Argument(argument), Fault::File { reason, .. })
            if argument.starts_with(TRAJECTORY) =>
        {
            Failure::Input(format!(
                "{argument}: cannot read the file: {reason}; paths on the command line are relative to the current folder"
            ))
        }
        _ => error.into(),
    }
}

/// The settings in force as they were typed, for the head of a table: `, --trajectory m.csv, --set rate_hz=2000`.
pub(crate) fn record(arguments: &RunArguments) -> String {
    let trajectory = arguments.trajectory.iter();
    let trajectory = trajectory.map(|path| format!(", {TRAJECTORY}{}", path.display()));
    let settings = arguments
        .set
        .iter()
        .map(|setting| format!(", --set {setting}"));
    let text: String = trajectory.chain(settings).collect();
    // The head is one line.
    text.chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}

/// Files that remember what was read of them.
pub(crate) struct Watched<'a> {
    files: &'a dyn Files,
    read: RefCell<Vec<PathBuf>>,
}

impl<'a> Watched<'a> {
    /// `files`, and the scene that has been read already.
    pub(crate) fn new(files: &'a dyn Files, scene: Option<&Path>) -> Self {
        Self {
            files,
            read: RefCell::new(scene.map(Path::to_owned).into_iter().collect()),
        }
    }

    /// Refuses outputs that would replace an input, or each other, under whatever name.
    pub(crate) fn guard(&self, arguments: &RunArguments) -> Result<(), Failure> {
        let mut taken: Vec<(PathBuf, String)> = Vec::new();
        for path in self.read.borrow().iter() {
            if let Ok(place) = std::fs::canonicalize(path) {
                taken.push((place, format!("an input of this run, {}", path.display())));
            }
        }
        let outputs = [("--csv", &arguments.csv), ("--plot", &arguments.plot)];
        for (flag, path) in outputs {
            // A path that leads nowhere is refused when it is opened; what is no file cannot be replaced.
            let place = path.as_deref().map(output::destination);
            let (Some(path), Some(Ok(place))) = (path, place) else {
                continue;
            };
            if place.exists() && !place.is_file() {
                continue;
            }
            if let Some((_, what)) = taken.iter().find(|(other, _)| *other == place) {
                return Err(Failure::Input(format!(
                    "{flag} {}: this would overwrite {what}; name another file",
                    path.display()
                )));
            }
            taken.push((place, format!("the file of {flag}")));
        }
        Ok(())
    }
}

impl Files for Watched<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.read.borrow_mut().push(path.to_owned());
        self.files.read(path)
    }
}

#[cfg(test)]
mod tests {
    use super::concerns;

    #[test]
    fn a_setting_concerns_its_field_and_its_parts() {
        assert!(concerns("rate_hz", "rate_hz"));
        assert!(concerns("trajectory", "trajectory.path"));
        assert!(concerns("trajectory.path", "trajectory.path"));
        assert!(!concerns("trajectory.speed", "trajectory.path"));
        assert!(!concerns("rate", "rate_hz"));
    }
}
