//! Dependencies that nothing uses.
//!
//! The scan here always runs: a dependency must be named (`name::`, `use name`) in the sources of its crate, outside comments;
//! one that only tests and examples name belongs under `[dev-dependencies]`. Where `cargo-machete` is installed it runs too.

use crate::finding::{self, Finding};
use crate::process;
use crate::workspace::Workspace;
use crate::{layering, tidy};
use anyhow::Result;

/// Checks all members, and says which tools did.
///
/// # Errors
/// When sources cannot be read or there are findings.
pub(crate) fn check() -> Result<()> {
    let workspace = Workspace::load()?;
    let files = tidy::source_files(&workspace.root)?;
    let mut findings = Vec::new();
    for member in &workspace.members {
        let Ok(folder) = member.folder.strip_prefix(&workspace.root) else {
            continue;
        };
        let folder = format!("{}/", folder.display());
        let sources: Vec<Source<'_>> = files
            .iter()
            .filter(|(path, _)| path.starts_with(&folder))
            .map(|(path, text)| Source {
                shipped: is_shipped(&path[folder.len()..]),
                text,
            })
            .collect();
        let judged = member.dependencies.iter().filter_map(|dependency| {
            // Where every crate is allowed, it does not matter which table names it.
            let anywhere = dependency.dev || layering::is_free(&member.name);
            let needed = if anywhere { Use::Tests } else { Use::Shipped };
            judge(
                &dependency.package,
                where_used(&dependency.import, &sources),
                needed,
            )
        });
        findings.extend(judged.map(|message| Finding::whole(&member.name, message)));
    }
    finding::report("unused dependencies", findings)?;
    if process::succeeds(&mut process::cargo(&["machete", "--version"])) {
        println!("    checked by the scan of xtask and by cargo-machete");
        return process::run(&mut process::cargo(&["machete"]));
    }
    println!("    checked by the scan of xtask alone (cargo-machete is not installed)");
    Ok(())
}

struct Source<'a> {
    /// Part of the library or program, not of its tests or examples.
    shipped: bool,
    text: &'a str,
}

fn is_shipped(path_in_member: &str) -> bool {
    path_in_member.starts_with("src/") || path_in_member == "build.rs"
}

/// How far into a crate the use of a dependency reaches.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    Nowhere,
    /// Tests, examples, benchmarks, examples in documentation.
    Tests,
    Shipped,
}

fn judge(package: &str, used: Use, needed: Use) -> Option<String> {
    match used {
        _ if used >= needed => None,
        Use::Nowhere => Some(format!("dependency {package} is used nowhere: remove it")),
        _ => Some(format!(
            "dependency {package} is used by tests or examples only: move it to dev-dependencies"
        )),
    }
}

fn where_used(import: &str, sources: &[Source<'_>]) -> Use {
    let best =
        sources.iter().map(
            |source| match (names_in_code(source.text, import), source.shipped) {
                (true, true) => Use::Shipped,
                (true, false) => Use::Tests,
                (false, _) if names_in_documentation(source.text, import) => Use::Tests,
                (false, _) => Use::Nowhere,
            },
        );
    best.max().unwrap_or(Use::Nowhere)
}

fn names_in_code(text: &str, import: &str) -> bool {
    text.lines()
        .map(str::trim_start)
        .any(|line| !line.starts_with("//") && names(line, import))
}

fn names_in_documentation(text: &str, import: &str) -> bool {
    let is_documentation = |line: &&str| line.starts_with("///") || line.starts_with("//!");
    text.lines()
        .map(str::trim_start)
        .filter(is_documentation)
        .any(|line| names(line, import))
}

/// Whether a line uses crate `import` in a path.
fn names(line: &str, import: &str) -> bool {
    line.match_indices(import)
        .any(|(at, found)| is_use(&line[..at], &line[at + found.len()..]))
}

fn is_use(before: &str, after: &str) -> bool {
    let starts =
        !before.ends_with(|c: char| c.is_alphanumeric() || c == '_') && !before.ends_with("::");
    let is_import = before.ends_with("use ") || before.ends_with("extern crate ");
    starts && (after.starts_with("::") || (is_import && after.starts_with([';', ' '])))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uses_are_recognised() {
        for line in [
            "use glam::DVec3;",
            "let a = glam::DVec3::X;",
            "use glam;",
            "use glam as g;",
            "#[derive(glam::D)]",
        ] {
            assert!(names(line, "glam"), "{line}");
        }
    }

    #[test]
    fn mentions_are_no_uses() {
        for line in [
            "use my_glam::X;",
            "let glam = 1;",
            "use a::glam::B;",
            "the glam crate",
        ] {
            assert!(!names(line, "glam"), "{line}");
        }
        assert!(!names_in_code(
            "// use glam::DVec3;\n/// glam::DVec3",
            "glam"
        ));
    }

    #[test]
    fn reach_of_a_use_is_told() {
        let source = |shipped, text| Source { shipped, text };
        assert_eq!(where_used("ron", &[]), Use::Nowhere);
        assert_eq!(
            where_used("ron", &[source(true, "fn a() {}")]),
            Use::Nowhere
        );
        assert_eq!(
            where_used("ron", &[source(false, "use ron::from_str;")]),
            Use::Tests
        );
        assert_eq!(
            where_used("ron", &[source(true, "//! use ron::from_str;")]),
            Use::Tests
        );
        assert_eq!(
            where_used(
                "ron",
                &[source(false, ""), source(true, "    ron::from_str(s)")]
            ),
            Use::Shipped
        );
    }

    #[test]
    fn unused_and_misplaced_dependencies_are_found() {
        assert!(
            judge("ron", Use::Nowhere, Use::Shipped)
                .unwrap()
                .contains("used nowhere")
        );
        assert!(
            judge("ron", Use::Nowhere, Use::Tests)
                .unwrap()
                .contains("used nowhere")
        );
        assert!(
            judge("ron", Use::Tests, Use::Shipped)
                .unwrap()
                .contains("dev-dependencies")
        );
        assert_eq!(judge("ron", Use::Tests, Use::Tests), None);
        assert_eq!(judge("ron", Use::Shipped, Use::Tests), None);
    }

    #[test]
    fn shipped_sources_are_told_from_tests() {
        assert!(
            is_shipped("src/lib.rs") && is_shipped("src/bin/bench.rs") && is_shipped("build.rs")
        );
        assert!(!is_shipped("tests/laws.rs") && !is_shipped("examples/lever.rs"));
    }
}
