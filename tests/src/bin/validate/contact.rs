//! The random campaigns of the separating-plane method, whole or as the subset that CI runs.

use std::process::ExitCode;
use std::time::Instant;

use pliant_tests::campaign::{Run, Verdict, campaign};

/// Runs and judges `runs`.
pub(crate) fn validate(runs: &[Run]) -> ExitCode {
    println!(
        "{:>18} {:>8} {:>3} {:>4} {:>6} {:>5} {:>5} {:>7} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>7} {:>6}",
        "setting",
        "tool",
        "n",
        "seed",
        "touch",
        "held",
        "cap",
        "changes",
        "inside",
        "cert.",
        "gap",
        "resid.",
        "vertices",
        "parry",
        "off",
        "lever",
        "force N",
        "s"
    );
    let mut failed = 0;
    let mut ticks = 0;
    for run in runs {
        let start = Instant::now();
        let verdict = campaign(run);
        ticks += verdict.ticks;
        print_row(run, &verdict, start.elapsed().as_secs_f64());
        for failure in verdict.failures(run) {
            println!("    FAILED: {failure}");
            failed += 1;
        }
    }
    println!(
        "{} runs, {ticks} ticks, {failed} demands failed",
        runs.len()
    );
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn print_row(run: &Run, v: &Verdict, seconds: f64) {
    println!(
        "{:>18} {:>8} {:>3} {:>4} {:>6} {:>5} {:>5} {:>7} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.1e} {:>8.1e} {:>6.3} {:>7.1} {:>6.1}",
        format!("{:?}", run.setting),
        format!("{:?}", run.tool),
        run.segments,
        run.seed,
        v.contact_ticks,
        v.held_ticks,
        v.capped_ticks,
        v.feature_changes,
        v.penetration,
        v.smallest_certificate,
        v.largest_contact_gap,
        v.residual,
        v.smallest_gap,
        v.parry_gap[1],
        v.contact_off_bodies,
        v.largest_lever,
        v.max_force,
        seconds
    );
}
