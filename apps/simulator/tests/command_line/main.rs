//! The binary as users meet it: exit codes, messages, files.
#![allow(clippy::unwrap_used, reason = "a failed step fails the test")]

mod outputs;
mod reports;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

fn scene(name: &str) -> String {
    scenes().join(format!("{name}.ron")).display().to_string()
}

fn pliant(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pliant"))
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Runs, expects success, and returns the JSON object.
fn json(arguments: &[&str]) -> serde_json::Value {
    let output = pliant(&[arguments, &["--json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_str(&stdout(&output)).unwrap()
}

#[test]
fn json_has_exactly_the_promised_keys_and_simulated_time() {
    let path = scene("probe_on_box");
    let value = json(&[
        "run",
        &path,
        "--headless",
        "--ticks",
        "1500",
        "--rate",
        "2000",
    ]);
    let keys: Vec<&str> = value
        .as_object()
        .unwrap()
        .keys()
        .map(String::as_str)
        .collect();
    let mut expected = [
        "ticks",
        "contact_ticks",
        "seconds",
        "rate_hz",
        "max_force_n",
        "max_penetration_m",
        "max_force_jump_n",
        "fallback_ticks",
        "held_ticks",
        "late_ticks",
        "tick_ns",
    ];
    let mut sorted = keys.clone();
    sorted.sort_unstable();
    expected.sort_unstable();
    assert_eq!(sorted, expected);
    assert_eq!(
        (value["ticks"].as_u64(), value["rate_hz"].as_u64()),
        (Some(1500), Some(2000))
    );
    assert!((value["seconds"].as_f64().unwrap() - 0.75).abs() < 1e-12);
    assert!(value["contact_ticks"].as_u64().unwrap() > 300);
    let force = value["max_force_n"].as_f64().unwrap();
    assert!((1.0..8.0).contains(&force), "{force}");
    assert!(value["max_penetration_m"].as_f64().unwrap() <= 1e-9);
    for percentile in ["p50", "p99", "p999", "max"] {
        assert!(value["tick_ns"][percentile].as_u64().unwrap() > 0);
    }
}

#[test]
fn smooth_geometry_steps_no_force_beyond_the_hand() {
    let value = json(&["run", &scene("probe_on_ellipsoid"), "--repeat", "2"]);
    assert!(
        value["max_force_jump_n"].as_f64().unwrap() <= 0.05,
        "{value}"
    );
    assert_eq!(value["fallback_ticks"].as_u64(), Some(0));
    assert_eq!(value["held_ticks"].as_u64(), Some(0));
}

#[test]
fn the_force_follows_settings_and_methods_differ() {
    let path = scene("probe_on_ellipsoid");
    let force = |arguments: &[&str]| {
        let all = [&["run", &path, "--seconds", "2"], arguments].concat();
        json(&all)["max_force_n"].as_f64().unwrap()
    };
    let plain = force(&[]);
    let soft = force(&["--set", "coupling.linear_stiffness=500"]);
    assert!((soft / plain - 0.5).abs() < 1e-6, "{plain} N, {soft} N");
    let paper = force(&["--method", "paper"]);
    assert!((paper - plain).abs() > 1e-6, "{paper} N, {plain} N");
}

#[test]
fn equal_runs_write_equal_tables() {
    let folder = tempfile::tempdir().unwrap();
    let tables: Vec<Vec<u8>> = ["a.csv", "b.csv"]
        .iter()
        .map(|name| {
            let target = folder.path().join(name);
            json(&[
                "run",
                &scene("two_objects"),
                "--csv",
                target.to_str().unwrap(),
            ]);
            fs::read(target).unwrap()
        })
        .collect();
    assert!(tables[0] == tables[1]);
    let text = String::from_utf8(tables[0].clone()).unwrap();
    let mut lines = text.lines();
    let head = lines.next().unwrap();
    assert!(
        head.starts_with("# scene two_objects, method constrained, rate 1000 Hz, pliant "),
        "{head}"
    );
    let columns: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!((columns[0], columns.len()), ("t_s", 28));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 7700);
    assert!(rows.iter().all(|row| row.len() == 28));
    // Read back, the spring explains the force to the last bits: F = k (visual − haptic).
    let number = |row: &[&str], name: &str| -> f64 {
        row[columns.iter().position(|c| *c == name).unwrap()]
            .parse()
            .unwrap()
    };
    let mut pressed = 0;
    for row in rows.iter().filter(|row| row[21] == "1") {
        let offset = number(row, "visual_z_m") - number(row, "haptic_z_m");
        assert!((number(row, "force_z_n") - 1000.0 * offset).abs() < 1e-3);
        pressed += 1;
    }
    assert!(pressed > 1000, "{pressed}");
}

#[test]
fn a_plot_is_a_png_of_its_size() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("p.png");
    json(&[
        "run",
        &scene("slot"),
        "--seconds",
        "1",
        "--plot",
        target.to_str().unwrap(),
    ]);
    let reader = png::Decoder::new(std::io::Cursor::new(fs::read(&target).unwrap()));
    let mut reader = reader.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!((info.width, info.height), (1600, 1200));
    let inked = pixels
        .chunks_exact(3)
        .filter(|p| p.iter().all(|&c| c < 90))
        .count();
    assert!(inked > 5000, "{inked} dark pixels: axes and text");
}

#[test]
fn wrong_input_exits_with_1_and_says_where() {
    let folder = tempfile::tempdir().unwrap();
    let broken = folder.path().join("broken.ron");
    fs::write(&broken, "(\n  tool: 5,\n)").unwrap();
    let motion = folder.path().join("m.csv");
    fs::write(&motion, "t_s,x_m,y_m,z_m,qx,qy,qz,qw\n0,0,0,zero,0,0,0,1\n").unwrap();
    let (broken, motion) = (broken.to_str().unwrap(), motion.to_str().unwrap());
    let good = scene("slot");
    let cases: [(&[&str], String); 5] = [
        (&["run", broken], format!("{broken}:2:9: ")),
        (&["run", "gone.ron"], "gone.ron: ".to_owned()),
        (
            &["run", &good, "--trajectory", motion],
            format!("{motion}:2:7: `zero`"),
        ),
        (
            &["run", &good, "--trajectory", "gone.csv"],
            "--trajectory gone.csv: cannot read the file: ".to_owned(),
        ),
        (
            &["run", &good, "--set", "tool.lenght=1"],
            "--set tool.lenght=1: unknown field".to_owned(),
        ),
    ];
    for (arguments, start) in cases {
        let output = pliant(arguments);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {message}");
        assert!(message.starts_with(&start), "{arguments:?}: {message}");
        assert!(stdout(&output).is_empty());
    }
}

#[test]
fn wrong_usage_exits_with_2() {
    let good = scene("slot");
    for arguments in [
        &["run"][..],
        &["check"],
        &["run", &good, "--ticks", "5", "--seconds", "1"],
        &["run", &good, "--method", "magic"],
        &["run", &good, "--no-such-flag"],
        &["run", &good, "--set", "rate_hz"],
        &["check", "--unit", "mile", &good],
    ] {
        assert_eq!(pliant(arguments).status.code(), Some(2), "{arguments:?}");
    }
    assert_eq!(pliant(&["--version"]).status.code(), Some(0));
}

#[test]
fn values_out_of_an_options_range_are_usage() {
    let good = scene("slot");
    for (option, values, told) in [
        (
            "--seconds",
            &["0", "-1", "NaN", "inf", "-inf", "1e9", "soon"][..],
            "expected a number of seconds above 0 and up to 86400",
        ),
        (
            "--ticks",
            &["0", "-1", "1.5", "100000001"],
            "expected a whole number from 1 to 100000000",
        ),
        (
            "--rate",
            &["7", "-1000", "20000", "NaN"],
            "expected a whole number from 500 to 10000",
        ),
        (
            "--repeat",
            &["0", "-3"],
            "expected a whole number from 1 to 10000",
        ),
        (
            "--device",
            &["hand:arm"],
            "unknown device; this version has: scripted",
        ),
        ("--plot", &["p.jpg", "p"], "plots are PNG files"),
    ] {
        for value in values {
            let output = pliant(&["run", &good, option, value]);
            let message = stderr(&output);
            assert_eq!(output.status.code(), Some(2), "{option} {value}: {message}");
            let start = format!("error: invalid value '{value}' for '{option} <");
            assert!(message.starts_with(&start), "{message}");
            assert!(message.contains(told), "{message}");
        }
    }
    let long = pliant(&["run", &good, "--seconds", "86400", "--rate", "10000"]);
    assert_eq!(long.status.code(), Some(2), "{}", stderr(&long));
}

#[test]
fn an_option_and_a_setting_of_the_same_field_are_refused() {
    let good = scene("slot");
    let motion = scenes().join("trajectories/slot.csv");
    let motion = motion.to_str().unwrap();
    for (option, value, setting) in [
        ("--method", "paper", "method=constrained"),
        ("--rate", "2000", "rate_hz=1000"),
        ("--seconds", "1.0", "seconds=2"),
        ("--ticks", "10", "seconds=2"),
        ("--device", "scripted", "device=scripted"),
        ("--trajectory", motion, "trajectory.path=m.csv"),
        ("--trajectory", motion, "trajectory=(path:\"m.csv\")"),
    ] {
        let output = pliant(&["run", &good, option, value, "--set", setting]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{setting}: {message}");
        let both = format!("`{option} {value}` and `--set {setting}` both decide");
        assert!(message.contains(&both), "{message}");
    }
    // Fields beside that of the option are free.
    json(&[
        "run",
        &good,
        "--trajectory",
        motion,
        "--set",
        "trajectory.speed=2",
    ]);
}

#[test]
fn help_tells_the_exit_codes_and_the_columns() {
    for arguments in [&["--help"][..], &["run", "--help"], &["check", "--help"]] {
        let output = pliant(arguments);
        assert_eq!(output.status.code(), Some(0));
        let text = stdout(&output);
        assert!(text.contains("Exit codes:\n  0  fine\n  1  "), "{text}");
    }
    let text = stdout(&pliant(&["run", "--help"]));
    for part in [
        "contact_object ",
        "tip_deflection_m ",
        "--trajectory, --device) is refused",
    ] {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
}

#[test]
fn check_reports_every_file_also_after_a_wrong_one() {
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.obj");
    fs::write(&bad, "v 0 0 0\nv 1 0\nf 1 2 3\n").unwrap();
    let star = scenes().join("meshes/star.obj");
    let motion = scenes().join("trajectories/slot.csv");
    let output = pliant(&[
        "check",
        "--unit",
        "mm",
        bad.to_str().unwrap(),
        star.to_str().unwrap(),
        motion.to_str().unwrap(),
        &scene("any_mesh"),
        "x.txt",
    ]);
    assert_eq!(output.status.code(), Some(1));
    let (told, found) = (stderr(&output), stdout(&output));
    assert!(
        told.starts_with(&format!("{}:2:1: ", bad.display())),
        "{told}"
    );
    assert!(told.contains("x.txt: "), "{told}");
    for part in [
        "vertices    22\n",
        "faces       40\n",
        "shells      1\n",
        "closed      yes\n",
        "convex      no: ",
        "winding     outward\n",
        "mm³\n",
        ": trajectory\n",
        "duration    7.5 s\n",
        ": scene\n",
        "object      star: ",
    ] {
        assert!(found.contains(part), "{part:?} is not in\n{found}");
    }
    // Points at 42 mm: the outline's box is 42 + 42 cos 36° by 84 sin 72°.
    assert!(
        found.contains("size        75.9787 x 79.8887 x 30 mm\n"),
        "{found}"
    );
}

#[test]
fn shipped_scenes_and_motions_pass_the_check() {
    let mut files: Vec<String> = Vec::new();
    for folder in [
        scenes(),
        scenes().join("trajectories"),
        scenes().join("meshes"),
    ] {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension != "md") {
                files.push(path.display().to_string());
            }
        }
    }
    assert!(files.len() >= 13, "{files:?}");
    let arguments: Vec<&str> = ["check"]
        .into_iter()
        .chain(files.iter().map(String::as_str))
        .collect();
    let output = pliant(&arguments);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
}

#[test]
fn without_a_command_the_built_in_scene_runs_and_says_that_there_is_no_window() {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(
        stderr(&output),
        "pliant: this version has no window; running probe_on_ellipsoid headless\n"
    );
    assert!(stdout(&output).starts_with("probe_on_ellipsoid, method constrained\n"));
}

#[test]
fn real_time_takes_as_long_as_it_simulates() {
    let start = std::time::Instant::now();
    json(&["run", &scene("slot"), "--realtime", "--ticks", "300"]);
    assert!(start.elapsed().as_secs_f64() >= 0.299);
}

/// Without a beat to keep, a count of late ticks would say that the machine is fast enough when nobody looked.
#[test]
fn late_ticks_are_counted_in_real_time_only() {
    let path = scene("slot");
    let plain = ["run", &path, "--ticks", "50"];
    let paced = ["run", &path, "--ticks", "50", "--realtime"];
    assert_eq!(json(&plain)["late_ticks"], 0);
    assert!(json(&paced)["late_ticks"].is_u64());
    let late = |arguments: &[&str]| stdout(&pliant(arguments)).contains("\n  late ");
    assert!(!late(&plain) && late(&paced));
}
