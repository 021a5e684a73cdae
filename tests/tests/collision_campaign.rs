//! The subset of the random collision campaign that runs with the tests; `cargo xtask validate collision --full` runs all.

use pliant_tests::collision::answer::Fault;
use pliant_tests::collision::campaign::{Extent, Failure, run};
use pliant_tests::collision::families::Family;
use pliant_tests::collision::kinds::Kind;

/// Families in which cylinders and cones are not yet always answered to 1e-9: where almost all directions are equally deep
/// EPA's buffers end first, and on simplices far smaller than the coordinates rounding decides. [`Family::HugeAndTiny`] is
/// open for all shapes: one witness in some thousand pairs.
const UNSETTLED: [Family; 7] = [
    Family::Identical,
    Family::Concentric,
    Family::Needles,
    Family::Plates,
    Family::TenKilometres,
    Family::FarFromOrigin,
    Family::Doubled,
];

#[test]
fn random_pairs_of_all_families_and_kinds_pass() {
    let report = run(Extent::SHORT);
    assert!(report.total(|row| row.pairs) > 50_000);
    assert!(report.total(|row| row.undecided) == 0);
    let settled = |failure: &&Failure| {
        let turned = failure.item.kinds.into_iter().any(Kind::is_turned);
        let family = failure.item.family;
        family != Family::HugeAndTiny && !(turned && UNSETTLED.contains(&family))
    };
    let failures: Vec<&Failure> = report.failures.iter().filter(settled).collect();
    assert!(failures.is_empty(), "{failures:#?}");
    // Of cylinders and cones all that is certified holds: planes, witness points on the shapes, unit normals.
    let certified = [
        Fault::NotFinite,
        Fault::NotUnit,
        Fault::Normal,
        Fault::Outside,
        Fault::Oracle,
    ];
    let faults = report.rows.values().flat_map(|row| row.faults.keys());
    for fault in faults {
        assert!(!certified.contains(fault), "{report:#?}");
    }
}
