//! Reference pairs of convex shapes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use pliant_collision::SimplexCache;
use pliant_tests::collision::campaign::{Extent, Report, run};
use pliant_tests::collision::reference::read;
use pliant_tests::collision::verdict::judge;

/// The reference file of this repository.
pub(crate) fn open_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/collision-open.json")
}

/// What became of a family.
#[derive(Default)]
struct Family {
    cases: u32,
    worst_error: f64,
    worst_share: f64,
    /// Number of the case and reason.
    failures: Vec<(u64, String)>,
}

/// Judges every pair of a file and prints the result per family.
pub(crate) fn validate_file(path: &Path) -> ExitCode {
    let reference = match read(path) {
        Ok(reference) => reference,
        Err(error) => {
            eprintln!("error: {error:#}");
            return ExitCode::FAILURE;
        }
    };
    let mut families: BTreeMap<&str, Family> = BTreeMap::new();
    let mut caches: BTreeMap<[usize; 2], SimplexCache> = BTreeMap::new();
    for case in &reference.cases {
        let verdict = judge(&reference, case, caches.entry(case.shapes).or_default());
        let family = families.entry(&case.family).or_default();
        family.cases += 1;
        family.worst_error = family.worst_error.max(verdict.worst_error);
        family.worst_share = family.worst_share.max(verdict.worst_share);
        let faults = verdict.faults.into_iter().map(|fault| (case.id, fault));
        family.failures.extend(faults);
    }
    print_families(&families);
    let mut failed: Vec<u64> = families
        .values()
        .flat_map(|family| family.failures.iter().map(|(id, _)| *id))
        .collect();
    failed.sort_unstable();
    failed.dedup();
    println!("{} cases, {} failed", reference.cases.len(), failed.len());
    if failed.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn print_families(families: &BTreeMap<&str, Family>) {
    println!(
        "{:<26} {:>6} {:>15} {:>15} {:>8}",
        "family", "cases", "worst error m", "/ tolerance", "failed"
    );
    for (name, family) in families {
        let mut failed: Vec<u64> = family.failures.iter().map(|(id, _)| *id).collect();
        failed.dedup();
        println!(
            "{name:<26} {:>6} {:>15.2e} {:>15.1e} {:>8}",
            family.cases,
            family.worst_error,
            family.worst_share,
            failed.len()
        );
        for (id, fault) in &family.failures {
            println!("    FAILED: case {id}, {fault}");
        }
    }
}

/// The reference file and the whole campaign.
pub(crate) fn validate_all(extent: Extent) -> ExitCode {
    let file = validate_file(&open_file());
    let report = run(extent);
    print_report(&report);
    let passed = report.total(|row| row.failed + row.undecided) == 0;
    if passed && file == ExitCode::SUCCESS {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn print_report(report: &Report) {
    println!(
        "{:<16} {:<10} {:>8} {:>10} {:>10} {:>9} {:>9} {:>8}",
        "family", "class", "pairs", "placements", "worst/size", "> 1e-12", "undecided", "failed"
    );
    for ((family, class), row) in &report.rows {
        println!(
            "{:<16} {:<10} {:>8} {:>10} {:>10.1e} {:>9} {:>9} {:>8}  {}",
            format!("{family:?}"),
            format!("{class:?}"),
            row.pairs,
            row.placements,
            row.worst,
            row.blurred,
            row.undecided,
            row.failed,
            row.faults
                .iter()
                .map(|(fault, count)| format!("{fault:?} {count}"))
                .collect::<Vec<_>>()
                .join(", ")
        );
    }
    for failure in &report.failures {
        let item = failure.item;
        println!(
            "FAILED: {:?} {:?} number {}, step {} ({}), signed distance {:e} m: {:?}\n{}",
            item.family,
            item.kinds,
            item.index,
            failure.step,
            failure.how,
            failure.truth,
            failure.faults,
            failure.snippet
        );
    }
    println!(
        "{} pairs, {} placements, {} above 1e-12 of the size, {} undecided, {} failed",
        report.total(|row| row.pairs),
        report.total(|row| row.placements),
        report.total(|row| row.blurred),
        report.total(|row| row.undecided),
        report.total(|row| row.failed)
    );
}
