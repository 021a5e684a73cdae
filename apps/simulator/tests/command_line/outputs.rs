//! Where output goes: never over an input, whole or not at all, and quietly when nobody reads on.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::{json, pliant, scene, scenes, stderr, stdout};

/// A folder of its own with a scene that names a mesh and a motion.
fn copied() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for part in ["meshes", "trajectories"] {
        fs::create_dir(folder.path().join(part)).unwrap();
    }
    for file in [
        "any_mesh.ron",
        "meshes/star.obj",
        "trajectories/any_mesh.csv",
    ] {
        fs::copy(scenes().join(file), folder.path().join(file)).unwrap();
    }
    let path = folder.path().join("any_mesh.ron");
    (folder, path)
}

#[test]
fn outputs_never_overwrite_inputs() {
    let (folder, path) = copied();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let other = at("other.csv");
    fs::copy(at("trajectories/any_mesh.csv"), &other).unwrap();
    let inputs = [
        "any_mesh.ron",
        "meshes/star.obj",
        "trajectories/any_mesh.csv",
        "other.csv",
    ];
    let before: Vec<Vec<u8>> = inputs.map(|name| fs::read(at(name)).unwrap()).into();
    let path = path.to_str().unwrap();
    for (target, trajectory) in [
        (at("any_mesh.ron"), None),
        (at("meshes/../any_mesh.ron"), None),
        (at("meshes/star.obj"), None),
        (at("trajectories/any_mesh.csv"), None),
        (other.clone(), Some(&other)),
    ] {
        let mut arguments = vec!["run", path, "--csv", &target, "--ticks", "5"];
        if let Some(trajectory) = trajectory {
            arguments.extend(["--trajectory", trajectory]);
        }
        let output = pliant(&arguments);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{target}: {message}");
        let told = format!("--csv {target}: this would overwrite an input of this run, ");
        assert!(message.starts_with(&told), "{message}");
        assert!(stdout(&output).is_empty());
    }
    let after: Vec<Vec<u8>> = inputs.map(|name| fs::read(at(name)).unwrap()).into();
    assert!(before == after);
    // A motion that this run does not read is no input of it.
    json(&["run", path, "--ticks", "5", "--csv", &other]);
}

#[cfg(unix)]
#[test]
fn links_do_not_hide_that_an_output_is_an_input() {
    use std::os::unix::fs::symlink;
    let (folder, path) = copied();
    let link = folder.path().join("picture.png");
    symlink("any_mesh.ron", &link).unwrap();
    let text = fs::read(&path).unwrap();
    let run = |scene: &Path, target: &Path| {
        let (scene, target) = (scene.to_str().unwrap(), target.to_str().unwrap());
        pliant(&["run", scene, "--plot", target, "--ticks", "5"])
    };
    assert_eq!(run(&path, &link).status.code(), Some(1));
    // The scene by its link, the output by its name.
    let scene = folder.path().join("scene.png");
    fs::rename(&path, &scene).unwrap();
    fs::remove_file(&link).unwrap();
    symlink("scene.png", &path).unwrap();
    assert_eq!(run(&path, &scene).status.code(), Some(1));
    assert_eq!(fs::read(&scene).unwrap(), text);
}

#[test]
fn two_outputs_do_not_share_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("both.png");
    let same = folder.path().join(".").join("both.png");
    let output = pliant(&[
        "run",
        &scene("slot"),
        "--csv",
        target.to_str().unwrap(),
        "--plot",
        same.to_str().unwrap(),
    ]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("this would overwrite the file of --csv"));
    assert!(!target.exists());
}

#[test]
fn a_path_that_cannot_be_written_is_named_as_given_and_exits_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let inside = folder.path().display().to_string();
    for target in ["/no/such/folder/t.csv", &inside] {
        let output = pliant(&["run", &scene("slot"), "--csv", target]);
        let message = stderr(&output);
        assert_eq!(output.status.code(), Some(3), "{message}");
        let start = format!("{target}: cannot be written: ");
        assert!(message.starts_with(&start), "{message}");
        assert!(!message.contains(".pliant-"), "{message}");
        assert!(!message.contains(" at path "), "{message}");
    }
}

#[cfg(unix)]
#[test]
fn a_table_into_a_pipe_ends_quietly_when_its_reader_does() {
    use std::io::{BufRead, BufReader};
    let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .args(["run", &scene("slot"), "--csv", "/dev/stdout"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut first = String::new();
    let mut reader = BufReader::new(child.stdout.take().unwrap());
    reader.read_line(&mut first).unwrap();
    drop(reader);
    let output = child.wait_with_output().unwrap();
    assert!(first.starts_with("# scene slot, "), "{first}");
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).is_empty());
}

#[cfg(unix)]
#[test]
fn a_table_on_standard_output_comes_before_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("out.txt");
    // A file and not a pipe: both writers share its end.
    let status = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .args(["run", &scene("slot"), "--ticks", "3"])
        .args(["--csv", "/dev/stdout"])
        .stdout(fs::File::create(&target).unwrap())
        .status()
        .unwrap();
    assert!(status.success());
    let text = fs::read_to_string(&target).unwrap();
    let starts = [
        "# scene slot",
        "t_s,",
        "0.0,",
        "0.001,",
        "0.002,",
        "slot, method",
    ];
    for (line, start) in text.lines().zip(starts) {
        assert!(line.starts_with(start), "{line}");
    }
}

#[test]
fn a_failed_run_leaves_files_as_they_were() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("t.csv");
    fs::write(&target, "mine").unwrap();
    let arguments = [
        "run",
        &scene("slot"),
        "--csv",
        target.to_str().unwrap(),
        "--plot",
        "/no/such/p.png",
    ];
    assert_eq!(pliant(&arguments).status.code(), Some(3));
    assert_eq!(fs::read_to_string(&target).unwrap(), "mine");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_fault() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .args(["run", &scene("slot"), "--ticks", "50"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(stderr(&output).is_empty());
}
