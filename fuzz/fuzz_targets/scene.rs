//! Scenes from any bytes, built with files from memory.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::{build_in_memory, judge_place};
use pliant_scene::Scene;

const FILE: &str = "f/s.ron";

fuzz_target!(|bytes: &[u8]| {
    match Scene::from_bytes(bytes, FILE) {
        Ok(scene) => build_in_memory(&scene, FILE, bytes),
        Err(error) => judge_place(&error, FILE, bytes),
    }
});
