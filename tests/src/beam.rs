//! Reference cases of beams, and what is asked of this project's answers to them.

pub mod linear;
pub mod nonlinear;
pub mod reference;
pub mod report;

use std::path::Path;

use anyhow::{Result, ensure};

use report::Report;

/// Judges every case of a file.
///
/// # Errors
/// When the file cannot be read, holds no case, or a case makes no beam.
pub fn judge_file(path: &Path) -> Result<Report> {
    let reference = reference::read(path)?;
    let mut report = Report::default();
    for case in &reference.linear_random {
        linear::judge(case, &mut report)?;
    }
    for case in &reference.nonlinear_tables {
        nonlinear::judge_table(case, &mut report)?;
    }
    for case in &reference.nonlinear_random {
        nonlinear::judge_space(case, &mut report)?;
    }
    ensure!(!report.rows.is_empty(), "{} holds no cases", path.display());
    Ok(report)
}
