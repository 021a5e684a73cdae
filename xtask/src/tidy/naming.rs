//! Where files live and what they are called.

use super::{File, has_extension, is_rust};
use crate::finding::Finding;

/// Names that say nothing about what is inside.
const DRAWERS: [&str; 8] = [
    "util", "utils", "common", "helper", "helpers", "misc", "prelude", "shared",
];

/// `foo.rs` lies beside `foo/`.
pub(super) fn no_mod_rs(file: File<'_>) -> Vec<Finding> {
    let is_mod = file.path.rsplit('/').next() == Some("mod.rs");
    found_if(
        is_mod,
        file,
        "a module folder's file lies beside it: rename to <folder>.rs, one level up",
    )
}

/// Modules are named after what they hold.
pub(super) fn no_drawers(file: File<'_>) -> Vec<Finding> {
    let path = file.path.strip_suffix(".rs").unwrap_or(file.path);
    let drawer = path.split('/').find(|part| DRAWERS.contains(part));
    let message =
        drawer.map(|name| format!("`{name}` is a drawer: name the module after what it holds"));
    found_if(
        is_rust(file.path) && drawer.is_some(),
        file,
        &message.unwrap_or_default(),
    )
}

/// Scenes are shared by tests, benchmarks and people, so they have one place. A crate's tests may keep broken samples.
pub(super) fn scenes_in_their_folder(file: File<'_>) -> Vec<Finding> {
    let belongs_to_tests = file.path.split('/').any(|part| part == "tests");
    let strays = has_extension(file.path, &["ron"])
        && !file.path.starts_with("scenes/")
        && !belongs_to_tests;
    let mut findings = found_if(strays, file, "scene files live in scenes/");
    let known = has_extension(file.path, &["ron", "csv", "obj", "stl", "gltf", "md"]);
    let odd = file.path.starts_with("scenes/") && !known;
    findings.extend(found_if(
        odd,
        file,
        "scenes/ holds scenes (.ron), trajectories (.csv), meshes and their descriptions",
    ));
    findings
}

fn found_if(condition: bool, file: File<'_>, message: &str) -> Vec<Finding> {
    if condition {
        vec![Finding::whole(file.path, message)]
    } else {
        Vec::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(path: &str) -> File<'_> {
        File { path, text: "" }
    }

    #[test]
    fn mod_rs_is_found() {
        assert_eq!(no_mod_rs(file("crates/mesh/src/load/mod.rs")).len(), 1);
        assert!(no_mod_rs(file("crates/mesh/src/load.rs")).is_empty());
    }

    #[test]
    fn drawers_are_found_as_file_and_as_folder() {
        assert!(
            no_drawers(file("crates/mesh/src/utils.rs"))[0]
                .message
                .contains("`utils`")
        );
        assert_eq!(no_drawers(file("tests/tests/common/scene.rs")).len(), 1);
        assert!(no_drawers(file("crates/mesh/src/commons.rs")).is_empty());
        assert!(no_drawers(file("docs/common/figure.md")).is_empty());
    }

    #[test]
    fn stray_scenes_are_found() {
        assert_eq!(
            scenes_in_their_folder(file("apps/simulator/slot.ron")).len(),
            1
        );
        assert_eq!(scenes_in_their_folder(file("scenes/slot.rson")).len(), 1);
        assert!(scenes_in_their_folder(file("scenes/slot.ron")).is_empty());
        assert!(scenes_in_their_folder(file("crates/scene/tests/broken/unit.ron")).is_empty());
    }
}
