//! Scenes become worlds, and what cannot be built says where and why.
#![allow(
    clippy::too_many_lines,
    clippy::unwrap_used,
    reason = "tables of cases; a failed step fails the test"
)]

use glam::DVec3;
use pliant_scene::{BuiltScene, MemoryFiles, Override, Scene, SceneError};

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
const MOTION: &str = "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,1,0,0,0,1\n2,0.1,0,1,0,0,0,1\n";

/// A scene in the folder `f` with this tool and object, built.
fn build(tool: &str, object: &str, rest: &str) -> Result<BuiltScene, SceneError> {
    let text = format!(
        "(\ntool: ({tool}),\nobjects: [(name: \"o\", shape: {object})],\ntrajectory: (path: \"m.csv\"),\n{rest})"
    );
    let files = [
        ("f/cube.obj", CUBE.to_owned()),
        ("f/open.obj", CUBE.replace("f 4 1 5 8\n", "")),
        ("f/bad.obj", CUBE.replacen("v 1 0 0", "v 1 zero 0", 1)),
        ("f/cube.xyz", CUBE.to_owned()),
        ("f/m.csv", MOTION.to_owned()),
    ];
    let files = files
        .into_iter()
        .map(|(path, text)| (path.into(), text.into_bytes()));
    Scene::from_str(&text, "f/s.ron")?.build(&MemoryFiles(files.collect()))
}

const ROD: &str = "shape: rod(length: 0.1, width: 0.006, height: 0.004)";
const BOX: &str = "cuboid(size: (0.1, 0.2, 0.05))";

#[test]
fn meshes_come_in_metres() {
    for (unit, metres) in [("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("inch", 0.0254)] {
        let mesh = format!("mesh(path: \"cube.obj\", unit: {unit}, scale: 2)");
        let built = build(ROD, &mesh, "").unwrap();
        let size = built.world.obstacles()[0].shape.bounds().size();
        assert!(
            (size - DVec3::splat(2.0 * metres)).length() < 1e-15,
            "{unit}"
        );
    }
}

#[test]
fn faults_of_geometry_and_files_have_their_place() {
    for (tool, object, rest, start, part) in [
        (
            ROD,
            "mesh(path: \"gone.obj\", unit: mm)",
            "",
            "f/s.ron:3:41: ",
            "cannot read `f/gone.obj`: ",
        ),
        (
            ROD,
            "mesh(path: \"open.obj\", unit: mm)",
            "",
            "f/s.ron:3:30: ",
            "convex_hull: true",
        ),
        (
            ROD,
            "mesh(path: \"bad.obj\", unit: mm)",
            "",
            "f/bad.obj:2:1: ",
            "zero",
        ),
        (
            ROD,
            "mesh(path: \"cube.xyz\", unit: mm)",
            "",
            "f/cube.xyz: ",
            "expected .obj",
        ),
        (
            ROD,
            "tube(outer_radius: 2, inner_radius: 1, length: 1)",
            "",
            "f/s.ron:3:30: ",
            "convex_hull: true",
        ),
        (
            ROD,
            "tube(outer_radius: 1, inner_radius: 2, length: 1)",
            "",
            "f/s.ron:3:30: ",
            "inner",
        ),
        (
            ROD,
            "latitude_longitude_ellipsoid(radii: (1, 1, 1), sectors: 4000, bands: 4000)",
            "",
            "f/s.ron:3:30: ",
            "faces are more",
        ),
        (
            "shape: capsule(length: 0.1, radius: 0.005, sectors: 4096, bands: 4096)",
            BOX,
            "",
            "f/s.ron:2:15: ",
            "67108864 faces are more than 4000000; choose fewer sectors",
        ),
        (
            ROD,
            "latitude_longitude_ellipsoid(radii: (1, 1, 1), sectors: 2000, bands: 1000)",
            "",
            "f/s.ron:3:30: ",
            "4000000 faces are more than the 3999988 that are left of 4000000 for a whole scene; choose fewer",
        ),
        (
            "shape: capsule(length: 0.01, radius: 0.005)",
            BOX,
            "",
            "f/s.ron:2:15: ",
            "longer than 0.01 m",
        ),
        (
            ROD,
            BOX,
            "coupling: (angular_stiffness: 5)",
            "f/s.ron:5:31: ",
            "infinity",
        ),
    ] {
        let message = build(tool, object, rest).unwrap_err().to_string();
        assert!(
            message.starts_with(start),
            "{tool} {object} {rest}: {message}"
        );
        assert!(message.contains(part), "{message}");
    }
}

#[test]
fn faults_inside_a_named_file_say_who_named_it() {
    let mesh = "mesh(path: \"bad.obj\", unit: mm)";
    let message = build(ROD, mesh, "").unwrap_err().to_string();
    assert!(message.starts_with("f/bad.obj:2:1: "), "{message}");
    assert!(message.ends_with(" (named at f/s.ron:3:41)"), "{message}");
    let tool = "shape: mesh(file: (path: \"bad.obj\", unit: mm))";
    let message = build(tool, BOX, "").unwrap_err().to_string();
    assert!(message.ends_with(" (named at f/s.ron:2:33)"), "{message}");

    let text = format!("(\ntool: ({ROD}), objects: [],\n trajectory: (path: \"m.csv\"))");
    let files = MemoryFiles([("m.csv".into(), b"t_s,x_m\n".to_vec())].into());
    let scene = Scene::from_str(&text, "s.ron").unwrap();
    let message = scene.build(&files).unwrap_err().to_string();
    assert!(message.starts_with("m.csv:1:1: "), "{message}");
    assert!(message.ends_with(" (named at s.ron:3:21)"), "{message}");
    let setting = Override::parse("trajectory.path=./m.csv").unwrap();
    let files = MemoryFiles([("./m.csv".into(), b"t_s,x_m\n".to_vec())].into());
    let scene = scene.with_overrides(&[setting]).unwrap();
    let message = scene.build(&files).unwrap_err().to_string();
    let end = " (named by --set trajectory.path=./m.csv)";
    assert!(message.ends_with(end), "{message}");
}

#[test]
fn reasons_why_a_shape_is_not_convex_are_short_and_in_metres() {
    let tube = "tube(outer_radius: 0.0123456789, inner_radius: 0.01, length: 0.1)";
    let message = build(ROD, tube, "").unwrap_err().to_string();
    assert!(message.ends_with(" (lengths in metres)"), "{message}");
    assert!(
        message.contains("use its hull (`convex_hull: true` in a scene"),
        "{message}"
    );
    let longest = message
        .split(|c: char| !c.is_ascii_digit())
        .map(str::len)
        .max();
    assert!(longest <= Some(8), "{message}");
}

#[test]
fn needles_are_built_or_refused_for_their_proportions() {
    let sectors = "length: 0.2, sectors: 5";
    let needles = |radius: &str| {
        [
            format!("cylinder(radius: {radius}, {sectors})"),
            format!("capsule(radius: {radius}, {sectors})"),
            format!("cone(base_radius: {radius}, tip_radius: 0, {sectors})"),
        ]
    };
    for object in needles("1e-8") {
        build(ROD, &object, "").unwrap();
        build(
            &format!("shape: {}", object.replace("cylinder", "pin")),
            BOX,
            "",
        )
        .unwrap();
    }
    for radius in ["1e-12", "1e-13", "1e-20", "1e-300"] {
        for object in needles(radius) {
            let tool = object.replace("cylinder", "pin");
            for error in [
                build(ROD, &object, ""),
                build(&format!("shape: {tool}"), BOX, ""),
            ] {
                let message = error.unwrap_err().to_string();
                let cause = ["thin for its size", "the mesh is flat", "lie on a line"];
                assert!(cause.iter().any(|c| message.contains(c)), "{message}");
                assert!(!message.contains("convex_hull"), "{message}");
            }
        }
    }
}

#[test]
fn hulls_are_taken_only_on_request() {
    for object in [
        "mesh(path: \"open.obj\", unit: mm, convex_hull: true)",
        "tube(outer_radius: 2, inner_radius: 1, length: 1, convex_hull: true)",
    ] {
        build(ROD, object, "").unwrap();
    }
}

#[test]
fn segments_share_their_borders_and_fill_the_tool() {
    for (tool, volume) in [
        (ROD, 0.1 * 0.006 * 0.004),
        (
            "shape: pin(length: 0.1, radius: 0.002, sectors: 6)",
            0.1 * 1.5 * 3.0_f64.sqrt() * 4e-6,
        ),
        (
            "shape: cone(length: 0.1, base_radius: 0.004, tip_radius: 0, sectors: 4)",
            0.1 * 2.0 * 16e-6 / 3.0,
        ),
        (
            "shape: mesh(file: (path: \"cube.obj\", unit: mm), axis: (0, 0, -1))",
            1e-9,
        ),
        (
            "shape: capsule(length: 0.1, radius: 0.004, sectors: 12)",
            f64::NAN,
        ),
    ] {
        let one = build(tool, BOX, "").unwrap();
        let whole = &one.world.tool().segments[0];
        let ten = build(&format!("{tool}, segments: 10"), BOX, "").unwrap();
        let segments = &ten.world.tool().segments;
        assert_eq!(segments.len(), 10);
        assert!(segments[0].bounds().min.x.abs() < 1e-18, "{tool}");
        for pair in segments.windows(2) {
            assert_eq!(
                pair[0].bounds().max.x.to_bits(),
                pair[1].bounds().min.x.to_bits(),
                "{tool}"
            );
        }
        assert!(
            (segments[9].bounds().max.x - whole.bounds().max.x).abs() < 1e-17,
            "{tool}"
        );
        let sum: f64 = segments.iter().map(volume_of).sum();
        assert!((sum / volume_of(whole) - 1.0).abs() < 1e-9, "{tool}: {sum}");
        assert!(
            volume.is_nan() || (sum / volume - 1.0).abs() < 1e-9,
            "{tool}: {sum}"
        );
    }
}

/// Sum of the tetrahedra under the faces.
fn volume_of(mesh: &pliant_mesh::ConvexMesh) -> f64 {
    let topology = mesh.topology();
    (0..topology.face_count())
        .map(|face| {
            let face = pliant_mesh::FaceId(u32::try_from(face).unwrap());
            let [a, b, c] = topology.face_vertices(face).map(|v| topology.position(v));
            a.dot(b.cross(c)) / 6.0
        })
        .sum()
}

#[test]
fn the_motion_is_scaled_placed_and_played_at_its_speed() {
    let rest = "workspace: (position_scale: 3)";
    let text = format!(
        "(tool: ({ROD}), objects: [], {rest}, trajectory: (path: \"m.csv\", scale: 2, speed: 4, \
         pose: (position: (0, 1, 0), rotation: (axis: (0, 0, 1), angle_deg: 90))))"
    );
    let files = MemoryFiles([("m.csv".into(), MOTION.into())].into());
    let built = Scene::from_str(&text, "s.ron")
        .unwrap()
        .build(&files)
        .unwrap();
    assert!((built.seconds - 0.5).abs() < 1e-15);
    let end = built.trajectory.sample(0.5).0;
    assert!(
        (end.translation - DVec3::new(0.0, 1.2, 2.0)).length() < 1e-12,
        "{end:?}"
    );
    assert!((built.map.position_scale() - 3.0).abs() < 1e-15);
}

#[test]
fn a_motion_without_duration_needs_seconds() {
    let text = format!("(\ntool: ({ROD}), objects: [],\n trajectory: (path: \"m.csv\"))");
    let still = MOTION.lines().take(2).collect::<Vec<_>>().join("\n");
    let files = MemoryFiles([("m.csv".into(), still.into_bytes())].into());
    let scene = Scene::from_str(&text, "s.ron").unwrap();
    let message = scene.build(&files).unwrap_err().to_string();
    assert!(
        message.starts_with("s.ron:3:21: the trajectory lasts 0 s"),
        "{message}"
    );
}
