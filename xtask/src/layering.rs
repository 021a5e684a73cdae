//! Layers: each member's dependencies against the table, and what every member's manifest must inherit.

mod table;

use crate::finding::{self, Finding};
use crate::workspace::{Member, Workspace};
use anyhow::Result;
use table::{ANYWHERE, Allowed, ROWS, Row};
use toml::{Table, Value};

/// Package fields that only the root manifest may set.
const INHERITED: [&str; 3] = ["edition", "rust-version", "license"];

/// Checks the workspace of the current folder.
///
/// # Errors
/// When cargo metadata fails or there are findings.
pub(crate) fn check() -> Result<()> {
    let workspace = Workspace::load()?;
    let libraries: Vec<&str> = workspace
        .libraries()
        .map(|member| member.name.as_str())
        .collect();
    let members: Vec<&str> = workspace
        .members
        .iter()
        .map(|member| member.name.as_str())
        .collect();
    let mut findings = Vec::new();
    for member in &workspace.members {
        findings.extend(check_edges(member, &libraries, &members));
        findings.extend(check_inheritance(&member.name, &member.manifest));
        if member.is_library {
            findings.extend(check_usable_alone(member));
        }
    }
    println!("    {} members against {} rows", members.len(), ROWS.len());
    finding::report("layering", findings)
}

/// Whether the table lets tests and campaigns of this package use whatever they like.
pub(crate) fn is_free(package: &str) -> bool {
    ROWS.iter().any(|row| {
        row.package == package && row.inside == Allowed::Any && row.outside == Allowed::Any
    })
}

fn check_edges(member: &Member, libraries: &[&str], members: &[&str]) -> Vec<Finding> {
    let Some(row) = ROWS.iter().find(|row| row.package == member.name) else {
        let message = "has no row in xtask/src/layering/table.rs: say there what it may use";
        return vec![Finding::whole(&member.name, message)];
    };
    let used = member
        .dependencies
        .iter()
        .filter(|dependency| !dependency.dev)
        .map(|it| it.package.as_str());
    used.filter_map(|used| refuse(row, used, libraries, members))
        .collect()
}

/// The finding about one edge, if the table does not allow it.
fn refuse(row: &Row, used: &str, libraries: &[&str], members: &[&str]) -> Option<Finding> {
    let is_member = members.contains(&used);
    if is_member && !libraries.contains(&used) {
        let message = format!("depends on {used}, which is no library; nothing may use it");
        return Some(Finding::whole(row.package, message));
    }
    let (set, kind) = if is_member {
        (row.inside, "workspace")
    } else {
        (row.outside, "outside")
    };
    let Allowed::Only(names) = set else {
        return None;
    };
    if names.contains(&used) || (!is_member && ANYWHERE.contains(&used)) {
        return None;
    }
    let allowed = if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    };
    let common = if is_member {
        String::new()
    } else {
        format!(" (and anywhere: {})", ANYWHERE.join(", "))
    };
    let message = format!(
        "depends on {used}, which its layer does not allow; {kind} crates allowed: {allowed}{common}"
    );
    Some(Finding::whole(row.package, message))
}

fn check_inheritance(package: &str, manifest: &Table) -> Vec<Finding> {
    let inherits = |table: Option<&Value>| {
        table
            .and_then(|it| it.get("workspace"))
            .and_then(Value::as_bool)
            == Some(true)
    };
    let fields = INHERITED
        .iter()
        .filter(|field| !inherits(manifest.get("package").and_then(|it| it.get(field))));
    let mut findings: Vec<Finding> = fields
        .map(|field| {
            Finding::whole(
                package,
                format!("sets its own {field}: write `{field}.workspace = true`"),
            )
        })
        .collect();
    if !inherits(manifest.get("lints")) {
        findings.push(Finding::whole(
            package,
            "does not inherit the lints: write `[lints]` with `workspace = true`",
        ));
    }
    findings
}

fn check_usable_alone(member: &Member) -> Vec<Finding> {
    let mut findings = Vec::new();
    if !member.folder.join("README.md").is_file() {
        findings.push(Finding::whole(
            &member.name,
            "has no README.md: what it is, a small example, what it does not do",
        ));
    }
    if member.examples.is_empty() {
        findings.push(Finding::whole(
            &member.name,
            "has no example: add one runnable file to its examples folder",
        ));
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workspace::Dependency;

    const LIBRARIES: [&str; 4] = [
        "pliant-spatial",
        "pliant-mesh",
        "pliant-device",
        "pliant-contact",
    ];
    const MEMBERS: [&str; 6] = [
        "pliant-spatial",
        "pliant-mesh",
        "pliant-device",
        "pliant-contact",
        "pliant",
        "pliant-tests",
    ];

    fn findings_of(package: &str, dependencies: &[(&str, bool)]) -> Vec<String> {
        let dependencies = dependencies
            .iter()
            .map(|(name, dev)| Dependency {
                package: (*name).into(),
                import: (*name).into(),
                dev: *dev,
            })
            .collect();
        let member = Member {
            name: package.into(),
            version: "0.1.0".into(),
            folder: "no-such-folder".into(),
            is_library: true,
            manifest: Table::new(),
            examples: Vec::new(),
            dependencies,
        };
        check_edges(&member, &LIBRARIES, &MEMBERS)
            .iter()
            .map(Finding::to_string)
            .collect()
    }

    #[test]
    fn allowed_edges_pass() {
        let edges = [
            ("pliant-mesh", false),
            ("glam", false),
            ("thiserror", false),
        ];
        assert_eq!(findings_of("pliant-contact", &edges), Vec::<String>::new());
        assert_eq!(
            findings_of(
                "pliant-tests",
                &[("pliant-device", false), ("nalgebra", false)]
            ),
            Vec::<String>::new()
        );
    }

    #[test]
    fn forbidden_workspace_edge_names_crate_edge_and_allowed() {
        let found = findings_of("pliant-contact", &[("pliant-device", false)]);
        assert_eq!(found.len(), 1);
        assert!(
            found[0].starts_with("pliant-contact: depends on pliant-device"),
            "{}",
            found[0]
        );
        assert!(
            found[0].contains("allowed: pliant-spatial, pliant-mesh, pliant-collision"),
            "{}",
            found[0]
        );
    }

    #[test]
    fn forbidden_outside_crate_is_found_and_dev_is_free() {
        let found = findings_of("pliant-contact", &[("serde", false)]);
        assert!(
            found[0].contains("outside crates allowed: none (and anywhere: glam, thiserror)"),
            "{}",
            found[0]
        );
        assert_eq!(
            findings_of(
                "pliant-contact",
                &[("serde", true), ("pliant-device", true)]
            ),
            Vec::<String>::new()
        );
    }

    #[test]
    fn nothing_uses_application_or_tests() {
        assert!(
            findings_of("pliant-tests", &[("pliant", false)])[0].contains("nothing may use it")
        );
        assert!(
            findings_of("pliant", &[("pliant-tests", false)])[0].contains("nothing may use it")
        );
    }

    #[test]
    fn unknown_member_must_get_a_row() {
        assert!(findings_of("pliant-audio", &[])[0].contains("has no row"));
    }

    #[test]
    fn inheritance_is_demanded_field_by_field() {
        let good = "package.edition.workspace = true\npackage.rust-version = { workspace = true }\n\
                    package.license.workspace = true\n[lints]\nworkspace = true\n";
        assert_eq!(check_inheritance("a", &good.parse().unwrap()), Vec::new());
        let own_edition = good.replace("edition.workspace = true", "edition = \"2021\"");
        assert!(
            check_inheritance("a", &own_edition.parse().unwrap())[0]
                .message
                .contains("its own edition")
        );
        let no_lints = good.replace(
            "[lints]\nworkspace = true",
            "[lints.rust]\nunsafe_code = \"allow\"",
        );
        assert!(
            check_inheritance("a", &no_lints.parse().unwrap())[0]
                .message
                .contains("inherit the lints")
        );
        assert_eq!(check_inheritance("a", &Table::new()).len(), 4);
    }

    #[test]
    fn library_needs_readme_and_example() {
        let member = Member {
            name: "pliant-mesh".into(),
            version: "0.1.0".into(),
            folder: "no-such-folder".into(),
            is_library: true,
            manifest: Table::new(),
            examples: Vec::new(),
            dependencies: Vec::new(),
        };
        assert_eq!(check_usable_alone(&member).len(), 2);
    }
}
