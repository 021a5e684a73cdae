//! House rules as checks over the files that git tracks or would add.
//!
//! A rule is a small function from a file (or all of them) to findings. Rules name what they look for in pieces, so that
//! this crate passes its own checks.

mod equations;
mod links;
mod machine;
mod naming;
mod text;

use crate::finding::{self, Finding};
use crate::process;
use crate::workspace::Workspace;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// A file of the project: its path from the root, with slashes, and its text.
#[derive(Debug, Clone, Copy)]
struct File<'a> {
    path: &'a str,
    text: &'a str,
}

/// Rules that look at one file at a time.
const FILE_RULES: &[fn(File<'_>) -> Vec<Finding>] = &[
    naming::no_mod_rs,
    naming::no_drawers,
    naming::scenes_in_their_folder,
    text::length,
    text::markers,
    text::white_space,
    text::no_glob_exports,
    machine::no_machine_paths,
    machine::no_neighbour_folders,
    machine::no_registry_settings,
    machine::lock_names_one_registry,
];

/// Rules that look at all files together.
const TREE_RULES: &[fn(&Tree) -> Vec<Finding>] = &[links::resolve, equations::tie];

/// Path to text; files that are not UTF-8 have none.
type Tree = BTreeMap<String, Option<String>>;

/// Checks the working tree of the current folder.
///
/// # Errors
/// When git fails, a file cannot be read or there are findings.
pub(crate) fn check() -> Result<()> {
    let tree = read_tree(&Workspace::load()?.root)?;
    let files = tree.iter().filter_map(|(path, text)| {
        Some(File {
            path,
            text: text.as_deref()?,
        })
    });
    let mut findings: Vec<Finding> = files
        .flat_map(|file| FILE_RULES.iter().flat_map(move |rule| rule(file)))
        .collect();
    findings.extend(TREE_RULES.iter().flat_map(|rule| rule(&tree)));
    println!(
        "    {} files, {} rules",
        tree.len(),
        FILE_RULES.len() + TREE_RULES.len()
    );
    finding::report("tidy", findings)
}

/// All Rust sources: path from the root, text.
///
/// # Errors
/// When git fails or a file cannot be read.
pub(crate) fn source_files(root: &Path) -> Result<BTreeMap<String, String>> {
    let sources = read_tree(root)?
        .into_iter()
        .filter(|(path, _)| is_rust(path));
    Ok(sources
        .filter_map(|(path, text)| Some((path, text?)))
        .collect())
}

fn read_tree(root: &Path) -> Result<Tree> {
    let mut git = Command::new("git");
    git.args([
        "ls-files",
        "-z",
        "--cached",
        "--others",
        "--exclude-standard",
    ])
    .current_dir(root);
    let listed = process::output(&mut git)
        .context("tidy needs git and a clone, to know which files are the project's")?;
    // A file deleted but not yet committed so is still listed.
    let present = listed
        .split_terminator('\0')
        .filter(|path| root.join(path).is_file());
    present
        .map(|path| Ok((path.to_owned(), read_text(&root.join(path))?)))
        .collect()
}

fn read_text(path: &Path) -> Result<Option<String>> {
    let bytes =
        std::fs::read(path).with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(String::from_utf8(bytes)
        .ok()
        .filter(|text| !text.contains('\0')))
}

fn is_rust(path: &str) -> bool {
    has_extension(path, &["rs"])
}

/// Written by hand: sources, prose, configuration; not data, pictures or the lock file.
fn is_handwritten(path: &str) -> bool {
    let name = path.rsplit('/').next().unwrap_or(path);
    has_extension(
        path,
        &["rs", "md", "toml", "ron", "yml", "yaml", "sh", "wgsl"],
    ) || !name.trim_start_matches('.').contains('.')
}

fn has_extension(path: &str, extensions: &[&str]) -> bool {
    Path::new(path)
        .extension()
        .is_some_and(|it| extensions.iter().any(|extension| it == *extension))
}

/// Findings on the lines for which `judge` has a message.
fn by_line<M: Into<String>>(file: File<'_>, judge: impl Fn(&str) -> Option<M>) -> Vec<Finding> {
    let lines = file.text.lines().enumerate();
    lines
        .filter_map(|(at, line)| Some(Finding::at(file.path, at + 1, judge(line)?)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn handwritten_files_are_told_from_data() {
        for path in [
            "a.rs",
            "docs/a.md",
            ".gitignore",
            ".ci/run",
            "LICENSE-MIT",
            "scenes/slot.ron",
        ] {
            assert!(is_handwritten(path), "{path}");
        }
        for path in [
            "Cargo.lock",
            "scenes/spot.obj",
            "a.csv",
            "tests/reference/a.json",
        ] {
            assert!(!is_handwritten(path), "{path}");
        }
    }

    #[test]
    fn tree_holds_sources_and_no_artefacts() {
        let tree = read_tree(&Workspace::load().unwrap().root).unwrap();
        assert!(tree["xtask/src/tidy.rs"].is_some());
        assert!(
            !tree
                .keys()
                .any(|path| path.starts_with("target/") || path.starts_with(".git/"))
        );
    }

    #[test]
    fn lines_are_counted_from_one() {
        let file = File {
            path: "a.rs",
            text: "x\ny\n",
        };
        let found = by_line(file, |line| (line == "y").then_some("is y"));
        assert_eq!(found, [Finding::at("a.rs", 2, "is y")]);
    }
}
