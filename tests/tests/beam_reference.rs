//! Judges all methods of the beam crate by the reference cases of `reference/beam-open.json`: small deflections against section-force
//! integration, large ones against elliptic integrals, closed forms and shooting.

use std::path::Path;

use pliant_tests::beam::judge_file;
use pliant_tests::beam::report::{Finding, Report};

#[test]
fn all_reference_cases_pass() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference/beam-open.json");
    let report = judge_file(&path).expect("the reference file is part of the project");
    let failures: Vec<_> = report.rows.values().flat_map(|row| &row.failures).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    let count = |kind: &str| {
        let rows = report
            .rows
            .iter()
            .filter(|(name, _)| name.starts_with(kind));
        rows.map(|(_, row)| row.count).sum::<u32>()
    };
    // 60 cases by five methods and half of them by a sixth; 32 and 30 at three numbers of elements.
    assert_eq!(count("linear_random"), 60 * 5 + 30);
    assert_eq!(count("nonlinear_random"), 30 * 3);
    assert_eq!(
        report.rows.values().map(|row| row.count).sum::<u32>(),
        330 + 90 + 32 * 3
    );
}

#[test]
fn errors_above_the_allowed_and_no_numbers_fail() {
    let mut report = Report::default();
    for error in [0.5, 1.0, 1.5, f64::NAN] {
        report.add(Finding {
            kind: "k".to_owned(),
            case: "c".to_owned(),
            error,
            allowed: 1.0,
        });
    }
    assert_eq!(report.failed(), 2);
}
