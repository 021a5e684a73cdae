//! Many ticks, as fast as possible or on the beat.

use crate::{Clock, Pacer, PacingReport, Sample, Servo, ServoError};

/// Runs `ticks` ticks in virtual time: one after the other, waiting for nothing. `on_sample` sees each.
///
/// # Errors
/// [`ServoError`] of the tick that failed; those before it have been seen.
pub fn run_virtual(
    servo: &mut Servo,
    ticks: u64,
    mut on_sample: impl FnMut(&Sample),
) -> Result<(), ServoError> {
    for _ in 0..ticks {
        on_sample(&servo.step()?);
    }
    Ok(())
}

/// Runs `ticks` ticks on the beat of `clock`, the first at once. `on_sample` sees each, within its period: what it does must
/// be short. Samples equal those of [`run_virtual`] whenever the device moves equally.
///
/// # Errors
/// As [`run_virtual`].
pub fn run_paced(
    servo: &mut Servo,
    clock: &impl Clock,
    ticks: u64,
    mut on_sample: impl FnMut(&Sample),
) -> Result<PacingReport, ServoError> {
    let mut pacer = Pacer::new(servo.rate(), clock.now());
    for _ in 0..ticks {
        pacer.wait(clock);
        on_sample(&servo.step()?);
    }
    Ok(pacer.report())
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;
    use std::time::Duration;

    use super::{run_paced, run_virtual};
    use crate::test_bench::{parts, press_and_slide};
    use crate::{Clock, ManualClock, MonotonicClock, Servo};

    const MS: Duration = Duration::from_millis(1);

    /// All samples as text, which tells every number to its last bit.
    fn trace(run: impl FnOnce(&mut Servo, &mut dyn FnMut(&crate::Sample))) -> Vec<String> {
        let mut servo = Servo::new(parts(press_and_slide())).unwrap();
        let mut trace = Vec::new();
        let mut contacts = 0;
        run(&mut servo, &mut |sample| {
            contacts += u32::from(sample.output.contacts > 0);
            trace.push(format!("{sample:?}"));
        });
        assert!(contacts > 50, "{contacts}");
        trace
    }

    #[test]
    fn paced_and_virtual_runs_give_the_same_samples_also_through_a_stall() {
        let in_virtual_time = trace(|servo, see| run_virtual(servo, 300, see).unwrap());
        let paced = trace(|servo, see| {
            let clock = ManualClock::new();
            let report = run_paced(servo, &clock, 300, see).unwrap();
            assert_eq!((report.ticks, report.late_ticks), (300, 0));
            assert_eq!(clock.now(), MS * 299);
        });
        assert!(paced == in_virtual_time);
        let stalled = trace(|servo, see| {
            let clock = ManualClock::new();
            let report = run_paced(servo, &clock, 300, |sample| {
                if sample.tick == 150 {
                    clock.advance(MS * 40);
                }
                see(sample);
            });
            assert_eq!(report.unwrap().late_ticks, 1);
        });
        assert!(stalled == in_virtual_time);
        let real = trace(|servo, see| {
            let report = run_paced(servo, &MonotonicClock::new(), 300, see).unwrap();
            assert_eq!(report.ticks, 300);
        });
        assert!(real == in_virtual_time);
    }

    #[test]
    fn after_a_stall_the_beat_goes_on_one_period_apart() {
        let mut servo = Servo::new(parts(press_and_slide())).unwrap();
        let clock = ManualClock::new();
        let previous = Cell::new(Duration::ZERO);
        let report = run_paced(&mut servo, &clock, 100, |sample| {
            let begun = clock.now();
            let expected = match sample.tick {
                0 => Duration::ZERO,
                51 => MS * 255 / 10,
                _ => MS,
            };
            assert_eq!(
                begun.saturating_sub(previous.get()),
                expected,
                "tick {}",
                sample.tick
            );
            previous.set(begun);
            if sample.tick == 50 {
                clock.advance(MS * 255 / 10);
            }
        })
        .unwrap();
        assert_eq!((report.late_ticks, report.skipped_periods), (1, 24));
        assert_eq!(report.max_lateness, MS * 245 / 10);
    }
}
