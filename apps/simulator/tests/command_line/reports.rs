//! What runs and checks tell about scenes that are not as their author thinks.

use std::fs;

use super::{pliant, scene, scenes, stderr, stdout};

/// Standard output of a run or check that succeeds.
fn told(arguments: &[&str]) -> String {
    let output = pliant(arguments);
    assert!(output.status.success(), "{}", stderr(&output));
    stdout(&output)
}

#[test]
fn a_run_that_touches_nothing_says_how_far_it_stays() {
    let path = scene("probe_on_box");
    // The box reaches up to z = 0; the motion is the shipped one, lifted.
    let lift = "trajectory.pose.position=(0, 0, 1)";
    for command in ["run", "check"] {
        let plain = told(&[command, &path]);
        assert!(!plain.contains("no contact"), "{plain}");
    }
    let lifted = told(&["run", &path, "--set", lift]);
    assert!(
        lifted.contains("mm from every object; the nearest is box\n"),
        "{lifted}"
    );
    let empty = told(&["run", &path, "--set", "objects=[]"]);
    assert!(
        empty.contains("  no contact      the scene has no objects\n"),
        "{empty}"
    );
}

/// A scene of a rod whose handle rests at `z` [m] over a box with its top at 0; moves to x = `x` within 1 s.
fn resting(folder: &std::path::Path, z: f64, x: f64) -> String {
    let motion = format!("t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,{z},0,0,0,1\n1,{x},0,{z},0,0,0,1\n");
    fs::write(folder.join("m.csv"), motion).unwrap();
    let text = "(tool: (shape: rod(length: 0.02, width: 0.006, height: 0.006)),\n\
        objects: [(name: \"box, low\", shape: cuboid(size: (0.2, 0.4, 0.1)), pose: (position: (0, 0, -0.05)))],\n\
        trajectory: (path: \"m.csv\"))";
    let path = folder.join("s.ron");
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

#[test]
fn a_start_inside_an_object_is_told_with_its_depth() {
    let folder = tempfile::tempdir().unwrap();
    // The rod's lower side is 3 mm below the handle: 43 mm in.
    let path = resting(folder.path(), -0.04, 0.0);
    for arguments in [&["run", &path][..], &["check", &path]] {
        let text = told(arguments);
        assert!(
            text.contains("inside box, low, 43 mm deep; the force rises over 0.5 s\n"),
            "{text}"
        );
    }
    let paper = told(&["run", &path, "--method", "paper"]);
    assert!(paper.contains("inside box, low, 43 mm deep\n"), "{paper}");
    let path = resting(folder.path(), 0.01, 0.0);
    let clear = told(&["check", &path]);
    assert!(!clear.contains("inside"), "{clear}");
    assert!(
        clear.contains("the tool's path stays 7 mm from every object; the nearest is box, low\n"),
        "{clear}"
    );
}

#[test]
fn check_tells_sizes_speed_and_a_motion_in_the_wrong_unit() {
    let folder = tempfile::tempdir().unwrap();
    let path = resting(folder.path(), 0.01, 5.0);
    let text = told(&["check", &path]);
    for part in [
        "tool        20 mm long, 1 segment\n",
        "object      box, low: 200 x 400 x 100 mm, 8 vertices, 12 faces\n",
        "motion      of the handle from (0, 0, 10) to (5000, 0, 10) mm\n",
        "top speed   5 m/s, 0 rad/s\n",
        "force scale 1 device N per world N\n",
        "note        5 m/s is faster than a hand: is the file in metres?\n",
    ] {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
    let motion = folder.path().join("m.csv");
    let text = told(&["check", motion.to_str().unwrap()]);
    assert!(text.contains("is the file in metres?\n"), "{text}");
}

#[test]
fn check_of_a_flat_mesh_does_not_advise_its_hull() {
    let folder = tempfile::tempdir().unwrap();
    let flat = folder.path().join("flat.obj");
    fs::write(
        &flat,
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n",
    )
    .unwrap();
    let flat = flat.to_str().unwrap();
    for arguments in [&["check", flat][..], &["check", flat, "--unit", "mm"]] {
        let text = told(arguments);
        assert!(
            text.contains("the mesh encloses no volume and cannot be touched\n"),
            "{text}"
        );
        assert!(!text.contains("convex_hull"), "{text}");
    }
}

#[test]
fn check_states_all_lengths_in_one_unit() {
    let folder = tempfile::tempdir().unwrap();
    let dented = folder.path().join("dented.obj");
    // A pyramid of 10 cm whose base is dented by 2 cm.
    let text = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\nv 5 5 10\nv 5 5 2\n\
        f 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n";
    fs::write(&dented, text).unwrap();
    let text = told(&["check", dented.to_str().unwrap(), "--unit", "cm"]);
    assert!(
        text.contains("  size        100 x 100 x 100 mm\n"),
        "{text}"
    );
    let convex = text.lines().find(|line| line.starts_with("  convex "));
    let convex = convex.unwrap();
    assert!(convex.ends_with("(lengths in mm)"), "{convex}");
    assert!(convex.contains("(50, 50, 20)"), "{convex}");
}

#[test]
fn check_names_a_line_only_where_one_is_at_fault() {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes, place) in [
        ("short.glb", &b"glTF\x02\0\0\0"[..], ": "),
        ("short.stl", b"too short", ": "),
        ("empty.obj", b"", ": "),
        ("empty.gltf", b"{\n}", ":2:1: "),
        ("bad.obj", b"v 0 0 0\nv 0 x 0\n", ":2:1: "),
    ] {
        let path = folder.path().join(name);
        fs::write(&path, bytes).unwrap();
        let output = pliant(&["check", path.to_str().unwrap()]);
        let (message, start) = (stderr(&output), format!("{}{place}", path.display()));
        let rest = message.strip_prefix(&start);
        assert!(
            rest.is_some_and(|rest| !rest.starts_with(|c: char| c.is_ascii_digit())),
            "{start} begins no {message}"
        );
    }
}

#[test]
fn the_head_of_a_table_tells_the_settings_and_its_rows_name_the_object() {
    let folder = tempfile::tempdir().unwrap();
    let path = resting(folder.path(), 0.001, 0.0);
    let motion = scenes().join("trajectories/slot.csv").display().to_string();
    let target = folder.path().join("t.csv");
    let table = |more: &[&str]| {
        let arguments = ["run", &path, "--csv", target.to_str().unwrap()];
        told(&[&arguments[..], more].concat());
        fs::read_to_string(&target).unwrap()
    };
    let text = table(&["--set", "coupling.linear_stiffness=500", "--ticks", "3"]);
    let mut lines = text.lines();
    let version = env!("CARGO_PKG_VERSION");
    assert_eq!(
        lines.next().unwrap(),
        format!(
            "# scene s, method constrained, rate 1000 Hz, pliant {version}, --set coupling.linear_stiffness=500"
        )
    );
    assert!(lines.next().unwrap().ends_with(",energy_j,held,fallback"));
    let row = lines.nth(1).unwrap();
    assert!(row.contains(",\"box, low\",0,0.0,"), "{row}");
    assert!(row.ends_with(",0,0"), "{row}");
    let text = table(&["--trajectory", &motion, "--ticks", "3"]);
    let head = text.lines().next().unwrap();
    assert!(
        head.ends_with(&format!(", --trajectory {motion}")),
        "{head}"
    );
}

#[test]
fn a_motion_of_the_command_line_is_sought_where_the_user_stands() {
    let output = pliant(&["run", &scene("slot"), "--trajectory", "gone.csv"]);
    let message = stderr(&output);
    assert!(
        message.ends_with("; paths on the command line are relative to the current folder\n"),
        "{message}"
    );
    assert!(!message.contains("scene file"), "{message}");
}
