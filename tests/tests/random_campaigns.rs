//! The fixed-seed subset of the random campaigns, one test a setting. The whole set: `cargo xtask validate contact --full`.

use pliant_tests::bodies::Setting;
use pliant_tests::campaign::{campaign, short_runs};

fn run_all(setting: Setting) {
    for run in short_runs().iter().filter(|run| run.setting == setting) {
        let failures = campaign(run).failures(run);
        assert!(failures.is_empty(), "{run:?}: {failures:#?}");
    }
}

#[test]
fn box_is_never_entered() {
    run_all(Setting::Box);
}

#[test]
fn plate_is_never_entered() {
    run_all(Setting::Plate);
}

#[test]
fn hull_is_never_entered() {
    run_all(Setting::Hull);
}

#[test]
fn latitude_longitude_ellipsoid_is_never_entered() {
    run_all(Setting::LatitudeLongitude);
}

#[test]
fn fibonacci_ellipsoid_is_never_entered() {
    run_all(Setting::Fibonacci);
}

#[test]
fn corner_is_never_entered() {
    run_all(Setting::Corner);
}

#[test]
fn slot_is_never_entered() {
    run_all(Setting::Slot);
}

#[test]
fn the_subset_has_a_hundred_thousand_ticks() {
    let ticks: u32 = short_runs().iter().map(|run| run.ticks).sum();
    assert!(ticks >= 100_000, "{ticks}");
}
