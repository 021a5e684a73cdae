//! Reference cases of beams.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use pliant_tests::beam::judge_file;

/// The reference file of this repository.
pub(crate) fn open_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/beam-open.json")
}

/// Judges every case of a file and prints the errors by kind.
pub(crate) fn validate_file(path: &Path) -> ExitCode {
    let report = match judge_file(path) {
        Ok(report) => report,
        Err(error) => {
            eprintln!("error: {error:#}");
            return ExitCode::FAILURE;
        }
    };
    println!(
        "{:<44} {:>6} {:>12} {:>12} {:>8}",
        "kind", "cases", "worst error", "/ allowed", "failed"
    );
    for (kind, row) in &report.rows {
        println!(
            "{kind:<44} {:>6} {:>12.2e} {:>12.2} {:>8}",
            row.count,
            row.worst,
            row.worst_share,
            row.failures.len()
        );
        for failure in &row.failures {
            println!(
                "    FAILED: {}: {:.3e}, allowed {:.1e}",
                failure.case, failure.error, failure.allowed
            );
        }
    }
    println!("{} comparisons failed", report.failed());
    if report.failed() == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}
