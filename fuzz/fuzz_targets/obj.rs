//! OBJ from any bytes.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pliant_fuzz::judge_mesh;
use pliant_mesh::load;

fuzz_target!(|bytes: &[u8]| judge_mesh(load::obj(bytes)));
