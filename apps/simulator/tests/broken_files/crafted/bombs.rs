//! glTF files that are small and would fill the memory or take for ever.

use super::judge_all;
use super::numbers::nested;
use crate::Verdict::{Refused, Touched};
use crate::documents::{TETRAHEDRON, binary, glb, with, with_nodes};

#[test]
#[expect(clippy::too_many_lines, reason = "one table")]
fn gltf_bombs() {
    let doubling: Vec<String> = (1..=40)
        .map(|i| format!(r#"{{"children":[{i},{i}]}}"#))
        .collect();
    let roots: Vec<String> = (0..1_000_000).map(|i| i.to_string()).collect();
    let many_nodes = |count: usize| {
        let nodes = vec![r#"{"mesh":0}"#; count].join(",");
        let json = TETRAHEDRON.replace(r#"{"mesh":0}"#, &nodes).replace(
            r#""scenes":[{"nodes":[0]}]"#,
            &format!(r#""scenes":[{{"nodes":[{}]}}]"#, roots[..count].join(",")),
        );
        glb(&json, &binary())
    };
    let primitive = r#"{"attributes":{"POSITION":0},"indices":1}"#;
    let lines = r#"{"attributes":{},"mode":1}"#;
    let crowd = |primitive: &str, count: usize, nodes: usize| {
        let json = TETRAHEDRON
            .replace(
                r#"{"attributes":{"POSITION":0},"indices":1}"#,
                &vec![primitive; count].join(","),
            )
            .replace(r#"{"mesh":0}"#, &vec![r#"{"mesh":0}"#; nodes].join(","))
            .replace(
                r#""scenes":[{"nodes":[0]}]"#,
                &format!(r#""scenes":[{{"nodes":[{}]}}]"#, roots[..nodes].join(",")),
            );
        glb(&json, &binary())
    };
    let deep = |open: &str, close: &str| {
        let value = format!("{}1{}", open.repeat(100_000), close.repeat(100_000));
        with(r#""scene":0"#, &format!(r#""extras":{value},"scene":0"#))
    };
    let list = |element: &str, count: usize| {
        with(
            r#""VEC3","count":4"#,
            &format!(
                r#""VEC3","count":4,"min":[{}]"#,
                vec![element; count].join(",")
            ),
        )
    };
    let cases = vec![
        (
            "chain",
            with_nodes(&nested(100_000, r#""translation":[0,0,0]"#)),
            Touched(4),
        ),
        (
            "doubling",
            with_nodes(&format!("{},{}", doubling.join(","), r#"{"mesh":0}"#)),
            Refused("instances of nodes"),
        ),
        (
            "instances_1e6",
            many_nodes(1_000_000),
            Refused("more than 524288 JSON objects"),
        ),
        (
            "instances_4e5",
            many_nodes(400_000),
            Refused("more than 262144 instances of nodes"),
        ),
        ("instances_1e4", many_nodes(10_000), Touched(40_000)),
        (
            "triangles",
            crowd(primitive, 1100, 1000),
            Refused("more than"),
        ),
        (
            "primitives",
            crowd(lines, 100_000, 100_000),
            Refused("more than 1048576 instances of primitives"),
        ),
        ("deep_arrays", deep("[", "]"), Refused("glTF JSON: ")),
        ("deep_objects", deep(r#"{"a":"#, "}"), Touched(4)),
        (
            "many_values",
            list("[]", 5_000_000),
            Refused("more than 8388608 JSON values"),
        ),
        ("values", list("1", 4_000_000), Touched(4)),
        (
            "objects",
            with(
                r#""scene":0"#,
                &format!(r#""cameras":[{}],"scene":0"#, vec!["{}"; 400_000].join(",")),
            ),
            Touched(4),
        ),
        (
            "loop",
            with_nodes(r#"{"children":[1]},{"mesh":0,"children":[0]}"#),
            Refused("loop of nodes"),
        ),
    ];
    judge_all("glb", cases);
}
