//! glTF documents built here: transforms, buffers, modes, and hostile variants.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use pliant_mesh::{TriangleMesh, load};

use crate::{cube, document, glb, no_buffers};

#[test]
fn transforms_instances_and_mirrors() {
    // A parent that mirrors and scales by 2, with the mesh once at the parent and once below, shifted.
    let nodes = r#"[{"mesh":0,"scale":[-2,2,2],"children":[1]},{"mesh":0,"translation":[5,0,0],"rotation":[0,0,0.6,0.8]}]"#;
    let (json, binary) = document(&cube(), nodes, "");
    let mesh = load::gltf(&glb(&json, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!((mesh.triangles().len(), mesh.shells()), (24, 2));
    assert!(
        (mesh.signed_volume() - 2.0 * 64.0).abs() < 1e-4,
        "outward again: {}",
        mesh.signed_volume()
    );
    assert!(mesh.bounds().min.x < -11.9 && (mesh.bounds().max.x - 2.0).abs() < 1e-9);

    let matrix = r#"[{"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 7,8,9,1]}]"#;
    let (json, binary) = document(&cube(), matrix, "");
    let mesh = load::gltf(&glb(&json, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!(mesh.bounds().center(), DVec3::new(7.0, 8.0, 9.0));
}

/// The same triangles in the same order; vertices may be numbered otherwise.
fn same_triangles(a: &TriangleMesh, b: &TriangleMesh) -> bool {
    a.triangles().len() == b.triangles().len()
        && (0..)
            .take(a.triangles().len())
            .all(|i| a.corners(i) == b.corners(i))
}

#[test]
fn buffers_by_data_uri_and_by_resolver() {
    let (_, binary) = document(&cube(), "[]", "");
    let uri = format!(
        r#","uri":"data:application/octet-stream;base64,{}""#,
        STANDARD.encode(&binary)
    );
    let (json, _) = document(&cube(), r#"[{"mesh":0}]"#, &uri);
    let inline = load::gltf(json.as_bytes(), &mut no_buffers).unwrap().mesh;
    assert!(same_triangles(&inline, &cube()));
    let (json, _) = document(&cube(), r#"[{"mesh":0}]"#, r#","uri":"my%20cube.bin""#);
    let mut asked = Vec::new();
    let loaded = load::gltf(json.as_bytes(), &mut |name| {
        asked.push(name.to_owned());
        Ok(binary.clone())
    });
    assert!(same_triangles(&loaded.unwrap().mesh, &cube()));
    assert_eq!(asked, ["my cube.bin"], "asked once");
    let error = load::gltf(json.as_bytes(), &mut no_buffers).unwrap_err();
    assert_eq!(
        error.to_string(),
        "buffers[0]: `my%20cube.bin`: there are none"
    );
}

#[test]
fn hostile_documents_get_an_error() {
    let (good, binary) = document(&cube(), r#"[{"mesh":0}]"#, "");
    assert!(load::gltf(&glb(&good, &binary), &mut no_buffers).is_ok());
    let cases = [
        (r#""count":8"#, r#""count":9"#, "do not fit"),
        (
            r#""count":8"#,
            r#""count":18446744073709551615"#,
            "do not fit",
        ),
        (
            r#""count":8"#,
            r#""count":7"#,
            "index 7, but there are 7 positions",
        ),
        (r#""count":36"#, r#""count":4000000000"#, "do not fit"),
        (
            r#""byteOffset":96"#,
            r#""byteOffset":18446744073709551615"#,
            "beyond",
        ),
        (
            r#""bufferView":1"#,
            r#""bufferView":2"#,
            "refers to bufferViews[2]",
        ),
        (
            r#""buffer":0,"byteLength":96"#,
            r#""buffer":3,"byteLength":96"#,
            "refers to buffers[3]",
        ),
        (
            r#""POSITION":0"#,
            r#""POSITION":7"#,
            "accessors[7]: does not exist",
        ),
        (r#""indices":1"#, r#""indices":0"#, "wrong type"),
        (r#""indices":1"#, r#""indices":1,"mode":9"#, "mode is none"),
        ("5123", "5122", "wrong componentType"),
        ("5126", "5125", "positions of integers"),
        (r#""mesh":0"#, r#""mesh":1"#, "refers to number 1"),
        (r#""mesh":0"#, r#""mesh":0,"children":[0]"#, "loop"),
        (r#""nodes":[0]"#, r#""nodes":[4]"#, "refers to number 4"),
        (r#""scene":0"#, r#""scene":1"#, "refers to number 1"),
        (r#""mesh":0"#, r#""mesh":0,"scale":[0,1,1]"#, "no triangles"),
        (
            r#""mesh":0"#,
            r#""mesh":0,"rotation":[0,0,0,0]"#,
            "quaternion",
        ),
        (r#""mesh":0"#, r#""mesh":0,"translation":[1e39,0,0]"#, ""),
        (r#""version":"2.0""#, r#""version":"1.0""#, "asset.version"),
        (
            r#""scene":0"#,
            r#""extensionsRequired":["VENDOR_new"],"scene":0"#,
            "needs extension VENDOR_new",
        ),
        (
            r#""byteLength":96"#,
            r#""byteLength":96,"byteStride":4"#,
            "byteStride 4 is smaller",
        ),
        (r#""scene":0"#, r#""scene":0,"scenes""#, "glTF JSON, line"),
    ];
    for (from, to, expected) in cases {
        assert!(good.contains(from), "{from}");
        let error = load::gltf(&glb(&good.replacen(from, to, 1), &binary), &mut no_buffers)
            .unwrap_err()
            .to_string();
        assert!(error.contains(expected), "{to}: {error}");
    }
    // Forty levels of two children that are the same node would be a million million instances.
    let chain: Vec<String> = (1..=40)
        .map(|i| format!(r#"{{"children":[{i},{i}]}}"#))
        .collect();
    let explosive = good.replacen(
        r#"[{"mesh":0}]"#,
        &format!(r#"[{},{{"mesh":0}}]"#, chain.join(",")),
        1,
    );
    let error = load::gltf(&glb(&explosive, &binary), &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("instances of nodes"), "{error}");
    let mut infinite = binary.clone();
    infinite[..4].copy_from_slice(&f32::NAN.to_le_bytes());
    let error = load::gltf(&glb(&good, &infinite), &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("accessors[0]: element 0"), "{error}");
    // The header that makes a trusting reader reserve 4 GiB.
    let error = load::gltf(b"glTF\x02\0\0\0\0\0\0\0", &mut no_buffers)
        .unwrap_err()
        .to_string();
    assert!(error.contains("a length of 0 bytes"), "{error}");
    let deep = format!("{}{}", "{\"a\":".repeat(100_000), "}".repeat(100_000));
    assert!(load::gltf(deep.as_bytes(), &mut no_buffers).is_err());
}

#[test]
fn strips_fans_and_other_modes() {
    let square = TriangleMesh::new(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y],
        vec![[0, 1, 2]],
    )
    .unwrap();
    let (list, binary) = document(&square, r#"[{"mesh":0}]"#, "");
    let strip = list.replace(r#","indices":1"#, r#","mode":5"#);
    let mesh = load::gltf(&glb(&strip, &binary), &mut no_buffers)
        .unwrap()
        .mesh;
    assert_eq!(mesh.triangles().len(), 2);
    assert!((0..2).all(|i| {
        let [a, b, c] = mesh.corners(i);
        (b - a).cross(c - a).z > 0.9
    }));
    let fan = list.replace(r#","indices":1"#, r#","mode":6"#);
    assert_eq!(
        load::gltf(&glb(&fan, &binary), &mut no_buffers)
            .unwrap()
            .mesh
            .triangles()
            .len(),
        2
    );
    for mode in 0..4 {
        let other = list.replace(r#","indices":1"#, &format!(r#","mode":{mode}"#));
        let error = load::gltf(&glb(&other, &binary), &mut no_buffers)
            .unwrap_err()
            .to_string();
        assert!(error.contains("points or lines skipped"), "{error}");
    }
}
