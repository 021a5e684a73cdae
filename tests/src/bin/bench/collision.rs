//! Queries of the collision crate beside those of `parry3d-f64`.

use std::path::Path;

use anyhow::Result;
use pliant_tests::collision_bench::clock::Times;
use pliant_tests::collision_bench::report::{Row, run as measure};

/// Measures, prints and writes all rows.
pub(crate) fn run(json: &Path) -> Result<()> {
    println!(
        "{:<17} {:<11} {:<9} {:>8} {:>19} {:>19} {:>9}",
        "bodies", "state", "mode", "queries", "own p50/p99 ns", "parry p50/p99 ns", "of listed"
    );
    let table = measure(print_measured);
    println!(
        "\nmachine factor {:.2}: parry's medians today by those listed",
        table.machine_factor
    );
    let mut missed = 0;
    for row in &table.rows {
        let (Some(target), Some(met)) = (row.target_today, row.met) else {
            continue;
        };
        missed += u32::from(!met);
        println!(
            "{:<17} {:<11} {:<9} {:>9.0} ns of {:>6.0} allowed today, parry {:>7}: {}",
            row.bodies,
            row.state,
            row.mode,
            row.own.p50,
            target,
            row.parry
                .map_or_else(|| "–".to_owned(), |parry| format!("{:.0}", parry.p50)),
            if met { "met" } else { "MISSED" }
        );
    }
    println!("{missed} targets missed");
    crate::write_json(json, &table)
}

fn print_measured(row: &Row) {
    let times = |times: Times| format!("{:.0}/{:.0}", times.p50, times.p99);
    let factor = row
        .parry
        .zip(row.parry_listed)
        .map_or_else(String::new, |(parry, listed)| {
            format!("{:.2}", parry.p50 / listed)
        });
    println!(
        "{:<17} {:<11} {:<9} {:>8} {:>19} {:>19} {:>9}",
        row.bodies,
        row.state,
        row.mode,
        row.queries,
        times(row.own),
        row.parry.map_or_else(String::new, times),
        factor
    );
}
