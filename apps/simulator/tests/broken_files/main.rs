//! `pliant check` over broken and awkward files, by name and named by a scene: a message that names file and fault, or
//! a load where the file is merely awkward; never a panic, an abort, a hang or more than a gigabyte.
#![allow(clippy::unwrap_used, reason = "a failed step fails the test")]

mod crafted;
mod documents;
mod table;

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Longest time one file may take: far above what the slowest needs on a busy machine in a debug build.
const PATIENCE: Duration = Duration::from_mins(1);

/// Address space one file may take [KiB]; only Linux has a shell that sets it.
const MEMORY: &str = "1048576";

/// What became of a child process.
struct Outcome {
    /// None when a signal ended it.
    code: Option<i32>,
    out: String,
    err: String,
}

/// Runs `pliant check` on a file as a process of its own, so that an abort or too much memory is seen.
fn check(path: &Path, folder: &Path) -> Outcome {
    let streams = [folder.join("out.txt"), folder.join("err.txt")];
    let [out, err] = streams.each_ref().map(|path| File::create(path).unwrap());
    let binary = env!("CARGO_BIN_EXE_pliant");
    let mut command = if cfg!(target_os = "linux") {
        let mut shell = Command::new("sh");
        shell.args(["-c", "ulimit -v \"$0\" && exec \"$@\"", MEMORY, binary]);
        shell
    } else {
        Command::new(binary)
    };
    let mut child = command
        .arg("check")
        .arg(path)
        .stdin(Stdio::null())
        .stdout(out)
        .stderr(err)
        .spawn()
        .unwrap();
    let start = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if start.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("{}: no answer after {PATIENCE:?}", path.display());
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let [out, err] = streams.map(|path| fs::read_to_string(path).unwrap());
    Outcome {
        code: status.code(),
        out,
        err,
    }
}

impl Outcome {
    /// Exit 0 and a report with `text`.
    fn loads(&self, file: &str, text: &str) {
        assert_eq!(self.code, Some(0), "{file}: {}", self.err);
        assert!(
            self.out.contains(text),
            "{file}: no `{text}` in {}",
            self.out
        );
    }

    /// Exit 1, nothing but a message that names `file` and the fault.
    fn refused(&self, file: &str, fault: &str) {
        assert_eq!(self.code, Some(1), "{file}: {}{}", self.out, self.err);
        assert!(self.out.is_empty(), "{file}: {}", self.out);
        let name = Path::new(file).file_name().unwrap().to_string_lossy();
        assert!(
            self.err.contains(&*name),
            "{file} is not named: {}",
            self.err
        );
        assert!(
            self.err.contains(fault),
            "{file}: no `{fault}` in {}",
            self.err
        );
        assert!(!self.err.contains("panicked"), "{file}: {}", self.err);
    }
}

/// A scene in `folder` whose only object is the hull of a mesh file.
fn scene_naming(mesh: &Path, folder: &Path) -> PathBuf {
    let motion =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/trajectories/any_mesh.csv");
    let scene = format!(
        "(
    rate_hz: 1000,
    coupling: (linear_stiffness: 1000),
    tool: (shape: rod(length: 0.1, width: 0.006, height: 0.006)),
    objects: [(name: \"object\", shape: mesh(path: {:?}, unit: mm, convex_hull: true))],
    trajectory: (path: {:?}),
)",
        mesh.display().to_string(),
        motion.display().to_string()
    );
    let path = folder.join("scene.ron");
    fs::write(&path, scene).unwrap();
    path
}

/// What must become of a file.
#[derive(Clone, Copy)]
enum Verdict {
    /// It loads with so many faces, and a scene can touch its hull.
    Touched(u32),
    /// It loads with so many faces, which enclose nothing: a scene refuses it.
    Flat(u32),
    /// It is refused with this text.
    Refused(&'static str),
}

/// Checks a file by itself and named by a scene.
fn judge(name: &str, path: &Path, work: &Path, verdict: Verdict) {
    let direct = check(path, work);
    let in_scene = check(&scene_naming(path, work), work);
    match verdict {
        Verdict::Touched(faces) => {
            direct.loads(name, &format!("\n  faces       {faces}\n"));
            in_scene.loads(name, ": scene\n");
        }
        Verdict::Flat(faces) => {
            direct.loads(name, &format!("\n  faces       {faces}\n"));
            in_scene.refused(name, "no volume");
        }
        Verdict::Refused(fault) => {
            direct.refused(name, fault);
            // A fault of the whole file, or of bytes, is none of line 1.
            let of_line_1 = fault.starts_with(":1:1: ") || direct.err.contains("glTF JSON");
            assert!(
                of_line_1 || !direct.err.contains(":1:1: "),
                "{name}: {}",
                direct.err
            );
            in_scene.refused(name, fault);
            let place = "scene.ron:5:";
            assert!(in_scene.err.contains(place), "{name}: {}", in_scene.err);
        }
    }
}
