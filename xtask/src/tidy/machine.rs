//! Nothing about the machine a file was written on: absolute paths, neighbouring folders, where packages come from.

use super::{File, by_line, is_handwritten};
use crate::finding::Finding;

/// First folders of absolute paths that exist on some machines only.
const MACHINE_FOLDERS: [&str; 6] = ["home", "root", "work", "tmp", "Users", "mnt"];

/// The folder with test data from elsewhere, beside the clone; only the script that sets `PLIANT_DATA` knows it.
const NEIGHBOUR: &str = concat!("..", "/shared");
const KNOWS_NEIGHBOUR: &str = ".ci/run";

/// Settings that redirect package downloads, and index addresses.
const REGISTRY_SETTINGS: [&str; 5] = [
    concat!("sparse", "+http"),
    concat!("registry", "+http"),
    concat!("replace", "-with"),
    concat!("index", "-url"),
    concat!("[", "source."),
];

const LOCKED_SOURCE: &str = concat!("registry", "+https://github.com/rust-lang/crates.io-index");

/// No absolute path into somebody's machine; tests take a temporary folder from the library for it.
pub(super) fn no_machine_paths(file: File<'_>) -> Vec<Finding> {
    by_line(file, |line| {
        let folder = MACHINE_FOLDERS
            .iter()
            .find(|folder| contains_absolute(line, folder))?;
        Some(format!(
            "absolute path /{folder}/…: it exists on one machine only"
        ))
    })
}

/// The project is complete without the folders beside it.
pub(super) fn no_neighbour_folders(file: File<'_>) -> Vec<Finding> {
    if file.path == KNOWS_NEIGHBOUR {
        return Vec::new();
    }
    by_line(file, |line| {
        let message =
            format!("`{NEIGHBOUR}` may be named in {KNOWS_NEIGHBOUR} only; use PLIANT_DATA");
        line.contains(NEIGHBOUR).then_some(message)
    })
}

/// Where packages come from is the machine's business.
pub(super) fn no_registry_settings(file: File<'_>) -> Vec<Finding> {
    if !is_handwritten(file.path) {
        return Vec::new();
    }
    by_line(file, |line| {
        let setting = REGISTRY_SETTINGS
            .iter()
            .find(|setting| line.contains(*setting))?;
        Some(format!(
            "`{setting}`: where packages come from belongs into the machine's configuration"
        ))
    })
}

/// Published crates can only use published crates, and everybody must be able to fetch them.
pub(super) fn lock_names_one_registry(file: File<'_>) -> Vec<Finding> {
    if file.path != "Cargo.lock" {
        return Vec::new();
    }
    by_line(file, |line| {
        let source = line.strip_prefix("source = ")?.trim_matches('"');
        (source != LOCKED_SOURCE)
            .then(|| format!("locked from {source}: only {LOCKED_SOURCE} is open to everybody"))
    })
}

/// Whether the line holds `/folder/` as the beginning of a path rather than in the middle of one.
fn contains_absolute(line: &str, folder: &str) -> bool {
    let pattern = format!("/{folder}/");
    let inside_path = |c: char| c.is_alphanumeric() || "._-~/})>*$".contains(c);
    line.match_indices(&pattern)
        .any(|(at, _)| !line[..at].ends_with(inside_path))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absolute_paths_are_found() {
        for folder in MACHINE_FOLDERS {
            let text = format!("see \"/{folder}/ada/spot.obj\"\n");
            assert_eq!(
                no_machine_paths(File {
                    path: "a.md",
                    text: &text
                })
                .len(),
                1,
                "{folder}"
            );
            let inner = format!("target/{folder}/x and https://example.org/{folder}/x\n");
            assert!(
                no_machine_paths(File {
                    path: "a.md",
                    text: &inner
                })
                .is_empty(),
                "{folder}"
            );
        }
    }

    #[test]
    fn neighbour_is_known_to_one_script() {
        let text = format!("cp {NEIGHBOUR}/data .\n");
        assert_eq!(
            no_neighbour_folders(File {
                path: "README.md",
                text: &text
            })
            .len(),
            1
        );
        assert!(
            no_neighbour_folders(File {
                path: KNOWS_NEIGHBOUR,
                text: &text
            })
            .is_empty()
        );
    }

    #[test]
    fn registry_settings_are_found() {
        for setting in REGISTRY_SETTINGS {
            let text = format!("x = \"{setting}s://example.org\"\n");
            assert_eq!(
                no_registry_settings(File {
                    path: ".cargo/config.toml",
                    text: &text
                })
                .len(),
                1,
                "{setting}"
            );
        }
        assert!(
            no_registry_settings(File {
                path: "Cargo.toml",
                text: "glam = \"0.34\"\n"
            })
            .is_empty()
        );
    }

    #[test]
    fn foreign_locked_sources_are_found() {
        let good = format!("name = \"glam\"\nsource = \"{LOCKED_SOURCE}\"\n");
        assert!(
            lock_names_one_registry(File {
                path: "Cargo.lock",
                text: &good
            })
            .is_empty()
        );
        let git = "source = \"git+https://example.org/glam\"\n";
        assert_eq!(
            lock_names_one_registry(File {
                path: "Cargo.lock",
                text: git
            })
            .len(),
            1
        );
    }
}
