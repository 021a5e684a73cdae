//! Random damage to good files.

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use pliant_mesh::generate;
use proptest::prelude::any;
use proptest::proptest;

use crate::{data, document, files_below, glb, load_bytes};

/// Overwrites, cuts and inserts as `choices` say, over and over with each third of them.
fn damaged(bytes: &[u8], choices: &[(u32, u8, u8)]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for &(place, kind, value) in choices {
        if bytes.is_empty() {
            break;
        }
        let at = place as usize % bytes.len();
        match kind % 8 {
            0 => bytes.truncate(at),
            1 => drop(bytes.remove(at)),
            2 => bytes.insert(at, value),
            // Digits, so that numbers in text change without breaking it.
            3 | 4 => bytes[at] = b'0' + value % 10,
            5 => bytes[at] ^= 1 << (value % 8),
            6 => bytes[at] = b"-+.eE/,\"{}[] \n\\#"[usize::from(value) % 16],
            _ => bytes[at] = value,
        }
    }
    bytes
}

/// Loading must end with a mesh that can be inspected or an error that says something.
fn survive(path: &Path, bytes: &[u8]) {
    match load_bytes(path, bytes) {
        Ok(loaded) => assert!(!loaded.mesh.triangles().is_empty()),
        Err(error) => assert!(error.to_string().len() > 10),
    }
}

proptest! {
    #[test]
    fn damaged_small_files_never_panic(choices in proptest::collection::vec(any::<(u32, u8, u8)>(), 1..6)) {
        let ball = generate::latitude_longitude_ellipsoid(DVec3::ONE, 5, 4).unwrap();
        let (json, binary) = document(&ball, r#"[{"mesh":0,"scale":[1,2,3],"children":[1]},{"mesh":0}]"#, "");
        survive(Path::new("x/a.glb"), &damaged(&glb(&json, &binary), &choices));
        let uri = format!(r#","uri":"data:;base64,{}""#, STANDARD.encode(&binary));
        let (json, _) = document(&ball, r#"[{"mesh":0}]"#, &uri);
        survive(Path::new("x/a.gltf"), &damaged(json.as_bytes(), &choices));
        let obj = "v 0 0 0\nv 1.5 0 0\nv 1 1e0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3 -1\nf 1//2 3 4\nl 1 2\n";
        survive(Path::new("x/a.obj"), &damaged(obj.as_bytes(), &choices));
        let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";
        survive(Path::new("x/a.stl"), &damaged(text.as_bytes(), &choices));
        let mut stl = vec![0; 80];
        stl.extend(2_u32.to_le_bytes());
        stl.extend([1.0_f32; 12].iter().flat_map(|x| x.to_le_bytes()).chain([0, 0]));
        stl.extend([2.0_f32; 12].iter().flat_map(|x| x.to_le_bytes()).chain([0, 0]));
        survive(Path::new("x/a.stl"), &damaged(&stl, &choices));
    }
}

#[test]
fn damaged_real_files_never_panic() {
    let Some(folder) = data(2000) else { return };
    let mut files = files_below(&folder.join("gltf"));
    files.extend(files_below(&folder.join("bad")));
    files.retain(|f| f.metadata().unwrap().len() < 60_000);
    // A fixed sequence (multiplier by P. L'Ecuyer 1999), so that a failure can be repeated.
    let mut state = 1_u64;
    let mut draw = || {
        state = state
            .wrapping_mul(2_862_933_555_777_941_757)
            .wrapping_add(3_037_000_493);
        u32::try_from(state >> 32).unwrap()
    };
    for file in &files {
        let bytes = std::fs::read(file).unwrap();
        for _ in 0..25 {
            let count = 1 + draw() % 6;
            let choices: Vec<(u32, u8, u8)> = (0..count)
                .map(|_| (draw(), draw().to_le_bytes()[3], draw().to_le_bytes()[3]))
                .collect();
            survive(file, &damaged(&bytes, &choices));
        }
    }
}
