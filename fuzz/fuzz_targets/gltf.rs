//! glTF and GLB from any bytes; buffers of other names are parts of the same bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::judge_mesh;
use pliant_mesh::load;

fuzz_target!(|bytes: &[u8]| {
    let mut buffer = |name: &str| match bytes.get(name.len()..) {
        Some(part) if name != "gone" => Ok(part.to_vec()),
        _ => Err("there is no such file".to_owned()),
    };
    judge_mesh(load::gltf(bytes, &mut buffer));
});
