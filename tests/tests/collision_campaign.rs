//! The subset of the random collision campaign that runs with the tests; `cargo xtask validate collision --full` runs all.

use pliant_tests::collision::campaign::{Extent, run};

#[test]
fn random_pairs_of_all_families_and_kinds_pass() {
    let report = run(Extent::SHORT);
    assert!(report.total(|row| row.pairs) > 50_000);
    assert!(report.total(|row| row.undecided) == 0);
    assert!(report.failures.is_empty(), "{:#?}", report.failures);
}
