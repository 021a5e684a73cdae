//! The layers as data: what each crate may use. Changing a row changes the architecture; `docs/architecture.md` says why.

/// What one crate may depend on, dev-dependencies aside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Row {
    /// Package name.
    pub(crate) package: &'static str,
    /// Library crates of the workspace it may use.
    pub(crate) inside: Allowed,
    /// Crates from elsewhere it may use, besides [`ANYWHERE`].
    pub(crate) outside: Allowed,
}

/// A set of package names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Allowed {
    /// These and no others.
    Only(&'static [&'static str]),
    /// All there are.
    Any,
}

/// Outside crates every crate may use: the vector types of all interfaces, and error enums.
pub(crate) const ANYWHERE: &[&str] = &["glam", "thiserror"];

/// One row per member, lowest layer first; a crate may only use crates above it in this list.
pub(crate) const ROWS: &[Row] = &[
    row("pliant-spatial", &[], &[]),
    // Parsers of mesh formats, data URIs inside glTF, exact orientation tests for the convex hull.
    row(
        "pliant-mesh",
        &["pliant-spatial"],
        &["tobj", "gltf", "stl_io", "base64", "robust"],
    ),
    row("pliant-beam", &["pliant-spatial"], &[]),
    row("pliant-device", &["pliant-spatial"], &["rusb"]),
    row(
        "pliant-collision",
        &["pliant-spatial", "pliant-mesh"],
        &["obvhs"],
    ),
    row(
        "pliant-render",
        &["pliant-spatial", "pliant-mesh"],
        &["wgpu"],
    ),
    row(
        "pliant-contact",
        &["pliant-spatial", "pliant-mesh", "pliant-collision"],
        &[],
    ),
    row(
        "pliant-sim",
        &[
            "pliant-spatial",
            "pliant-mesh",
            "pliant-beam",
            "pliant-collision",
            "pliant-contact",
        ],
        &[],
    ),
    // Latest-value channel, ring, scheduling of the one real-time thread.
    row(
        "pliant-servo",
        &["pliant-spatial", "pliant-device", "pliant-sim"],
        &["rtrb", "triple_buffer", "thread-priority"],
    ),
    row(
        "pliant-scene",
        &[
            "pliant-spatial",
            "pliant-mesh",
            "pliant-beam",
            "pliant-device",
            "pliant-collision",
            "pliant-contact",
            "pliant-sim",
        ],
        &["serde", "serde_json", "ron", "csv"],
    ),
    Row {
        package: "pliant",
        inside: Allowed::Any,
        outside: Allowed::Only(APPLICATION),
    },
    Row {
        package: "pliant-tests",
        inside: Allowed::Any,
        outside: Allowed::Any,
    },
    row_of_tool("xtask"),
];

/// Command line, window, plots, pictures, progress and result files of the application.
const APPLICATION: &[&str] = &[
    "ab_glyph",
    "anyhow",
    "clap",
    "eframe",
    "egui",
    "egui_plot",
    "epaint_default_fonts",
    "hdrhistogram",
    "indicatif",
    "plotters",
    "png",
    "serde",
    "serde_json",
    "tempfile",
];

const fn row(
    package: &'static str,
    inside: &'static [&'static str],
    outside: &'static [&'static str],
) -> Row {
    Row {
        package,
        inside: Allowed::Only(inside),
        outside: Allowed::Only(outside),
    }
}

/// A tool stands beside the workspace: it must build while every crate is broken.
const fn row_of_tool(package: &'static str) -> Row {
    Row {
        package,
        inside: Allowed::Only(&[]),
        outside: Allowed::Any,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_point_upwards_only() {
        for (position, row) in ROWS.iter().enumerate() {
            let Allowed::Only(inside) = row.inside else {
                continue;
            };
            for used in inside {
                let found = ROWS[..position].iter().any(|above| above.package == *used);
                assert!(
                    found,
                    "{} may use {used}, which is not above it",
                    row.package
                );
            }
        }
    }

    #[test]
    fn invariants_of_the_design_hold_in_the_table() {
        let allows = |package: &str, used: &str| {
            let row = ROWS.iter().find(|row| row.package == package).unwrap();
            [row.inside, row.outside]
                .iter()
                .any(|set| matches!(set, Allowed::Only(names) if names.contains(&used)))
        };
        assert!(allows("pliant-scene", "serde") && allows("pliant-scene", "pliant-sim"));
        for below_scene in &ROWS[..9] {
            assert!(
                !allows(below_scene.package, "serde"),
                "{} knows serde",
                below_scene.package
            );
        }
        assert!(
            !allows("pliant-render", "pliant-sim") && !allows("pliant-contact", "pliant-device")
        );
        assert!(!allows("pliant-beam", "pliant-mesh") && !allows("pliant-scene", "pliant-render"));
    }
}
