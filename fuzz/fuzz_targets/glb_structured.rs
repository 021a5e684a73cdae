//! GLB files that are nearly right: a document of a few fields, most of them sound, packed as the format demands.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::{Document, judge_mesh};
use pliant_mesh::load;

fuzz_target!(|document: Document| {
    let mut buffer = |_: &str| Err("there is no such file".to_owned());
    judge_mesh(load::gltf(&document.glb(), &mut buffer));
});
