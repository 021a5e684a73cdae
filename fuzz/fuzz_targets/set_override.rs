//! Settings laid over a scene, one a line.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::{build_in_memory, judge_place};
use pliant_scene::{Override, Scene};

const FILE: &str = "f/s.ron";

/// Every kind of value that a path can lead to.
const TEXT: &str = r#"(
    method: constrained, // how contact is resolved
    tool: (shape: rod(length: 0.1, width: 0.006, height: 0.006), segments: 2),
    objects: [
        (name: "box", shape: cuboid(size: (1, 1, 1)), pose: (position: (0, 0, 0))),
        (name: "m", shape: mesh(path: "a.obj", unit: mm)), (name: "e", shape: fibonacci_ellipsoid(radii: [1, 2, 3], points: 20)),
    ],
    trajectory: (path: "a.csv"),
)"#;

fuzz_target!(|settings: &str| {
    let overrides: Result<Vec<Override>, _> = settings.lines().map(Override::parse).collect();
    let overrides = match overrides {
        Ok(overrides) => overrides,
        Err(error) => return judge_place(&error, FILE, TEXT.as_bytes()),
    };
    let scene = Scene::from_str(TEXT, FILE).expect("the scene is sound");
    match scene.with_overrides(&overrides) {
        Ok(scene) => build_in_memory(&scene, FILE, TEXT.as_bytes()),
        Err(error) => judge_place(&error, FILE, TEXT.as_bytes()),
    }
});
