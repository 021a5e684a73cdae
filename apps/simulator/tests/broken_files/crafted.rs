//! Files made to break readers, one fault each, and what must become of them.

mod bombs;
mod containers;
mod numbers;
mod obj;
mod stl;

use crate::{Verdict, judge};

/// Writes each file into a fresh folder and judges it.
fn judge_all(extension: &str, cases: Vec<(&str, Vec<u8>, Verdict)>) {
    let work = tempfile::tempdir().unwrap();
    for (name, bytes, verdict) in cases {
        let name = format!("{name}.{extension}");
        let path = work.path().join(&name);
        std::fs::write(&path, bytes).unwrap();
        judge(&name, &path, work.path(), verdict);
        std::fs::remove_file(&path).unwrap();
    }
}
