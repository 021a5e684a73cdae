//! What a run comes to.

use std::fmt::Write as _;

use glam::DVec3;
use pliant_servo::Sample;
use serde::Serialize;

/// Figures of a run. The names are those of the JSON object.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Summary {
    pub(crate) ticks: u64,
    pub(crate) contact_ticks: u64,
    /// Simulated time [s].
    pub(crate) seconds: f64,
    pub(crate) rate_hz: u32,
    pub(crate) max_force_n: f64,
    /// Of the visual tool into any object.
    pub(crate) max_penetration_m: f64,
    /// Largest |ΔF| − K·|Δx| of a tick, x the point of the haptic tool that is in contact.
    pub(crate) max_force_jump_n: f64,
    pub(crate) fallback_ticks: u64,
    pub(crate) held_ticks: u64,
    /// 0 where nothing kept to the wall clock.
    pub(crate) late_ticks: u64,
    /// Whether the run kept to the wall clock.
    #[serde(skip)]
    pub(crate) paced: bool,
    pub(crate) tick_ns: TickTimes,
}

/// Percentiles of the time a tick took [ns].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub(crate) struct TickTimes {
    pub(crate) p50: u64,
    pub(crate) p99: u64,
    pub(crate) p999: u64,
    pub(crate) max: u64,
}

impl TickTimes {
    /// Nearest-rank percentiles.
    pub(crate) fn of(mut times: Vec<u64>) -> Self {
        times.sort_unstable();
        let at = |per_mille: usize| {
            let rank = (times.len() * per_mille).div_ceil(1000).max(1);
            times.get(rank - 1).copied().unwrap_or(0)
        };
        Self {
            p50: at(500),
            p99: at(990),
            p999: at(999),
            max: at(1000),
        }
    }
}

/// Gathers a summary tick by tick.
pub(crate) struct Gauge {
    stiffness: f64,
    last: Option<Sample>,
    force_sum: f64,
    pub(crate) summary: Summary,
}

impl Gauge {
    /// For a coupling of `stiffness` [N/m].
    pub(crate) fn new(stiffness: f64, rate_hz: u32) -> Self {
        Self {
            stiffness,
            last: None,
            force_sum: 0.0,
            summary: Summary {
                ticks: 0,
                contact_ticks: 0,
                seconds: 0.0,
                rate_hz,
                max_force_n: 0.0,
                max_penetration_m: 0.0,
                max_force_jump_n: 0.0,
                fallback_ticks: 0,
                held_ticks: 0,
                late_ticks: 0,
                paced: false,
                tick_ns: TickTimes::default(),
            },
        }
    }

    /// Adds a tick, after which the visual tool was `penetration` [m] inside an object.
    pub(crate) fn add(&mut self, sample: &Sample, penetration: f64) {
        let summary = &mut self.summary;
        let output = &sample.output;
        let force = output.wrench.force.length();
        summary.ticks += 1;
        summary.seconds = summary.ticks as f64 / f64::from(summary.rate_hz);
        summary.contact_ticks += u64::from(output.contacts > 0);
        summary.held_ticks += u64::from(output.held);
        summary.fallback_ticks += u64::from(output.capped);
        summary.max_force_n = summary.max_force_n.max(force);
        summary.max_penetration_m = summary.max_penetration_m.max(penetration);
        if output.contacts > 0 {
            self.force_sum += force;
        }
        if let Some(last) = &self.last {
            let jump = force_jump(last, sample, self.stiffness);
            summary.max_force_jump_n = summary.max_force_jump_n.max(jump);
        }
        self.last = Some(*sample);
    }

    /// Mean force over the ticks in contact [N].
    pub(crate) fn mean_force(&self) -> f64 {
        self.force_sum / self.summary.contact_ticks.max(1) as f64
    }
}

/// By how much the force changed more than the hand's motion explains [N].
fn force_jump(last: &Sample, sample: &Sample, stiffness: f64) -> f64 {
    let (before, now) = (&last.output, &sample.output);
    let change = (now.wrench.force - before.wrench.force).length();
    // The same point of the haptic tool at both ticks: the one in contact now, or else the one that was.
    let in_handle = match (now.contact, before.contact) {
        (Some(contact), _) => now.world_from_visual.inverse_transform_point(contact.point),
        (None, Some(contact)) => before
            .world_from_visual
            .inverse_transform_point(contact.point),
        (None, None) => DVec3::ZERO,
    };
    let motion = now.world_from_haptic.transform_point(in_handle)
        - before.world_from_haptic.transform_point(in_handle);
    change - stiffness * motion.length()
}

impl Summary {
    /// One object on one line.
    pub(crate) fn json(&self) -> String {
        let text = serde_json::to_string(self).expect("numbers and names always serialise");
        text + "\n"
    }

    /// For people.
    pub(crate) fn text(&self, head: &str, mean_force: f64) -> String {
        let mut text = format!("{head}\n");
        let part = 100.0 * self.contact_ticks as f64 / self.ticks.max(1) as f64;
        let mut line = |name: &str, value: String| {
            let _ = writeln!(text, "  {name:<16}{value}");
        };
        line("time", format!("{} s at {} Hz", self.seconds, self.rate_hz));
        line(
            "ticks",
            format!(
                "{}, {} in contact ({part:.0} %)",
                self.ticks, self.contact_ticks
            ),
        );
        line(
            "force",
            format!(
                "{:.2} N at most, {mean_force:.2} N on average in contact",
                self.max_force_n
            ),
        );
        line(
            "force jump",
            format!(
                "{:.3} N at most beyond the motion of the hand",
                self.max_force_jump_n
            ),
        );
        line(
            "penetration",
            format!(
                "{:.4} µm at most, visual tool into any object",
                self.max_penetration_m * 1e6
            ),
        );
        line(
            "held, fallback",
            format!("{}, {} ticks", self.held_ticks, self.fallback_ticks),
        );
        if self.paced {
            line("late", format!("{} ticks", self.late_ticks));
        }
        line("tick time", self.tick_ns.text());
        text
    }
}

impl TickTimes {
    /// In microseconds.
    pub(crate) fn text(&self) -> String {
        let us = |ns: u64| ns as f64 * 1e-3;
        format!(
            "median {:.1} µs, 99 % {:.1} µs, 99.9 % {:.1} µs, maximum {:.1} µs",
            us(self.p50),
            us(self.p99),
            us(self.p999),
            us(self.max)
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};
    use pliant_device::DeviceState;
    use pliant_servo::Sample;
    use pliant_sim::TickOutput;
    use pliant_spatial::{Pose, Twist, Wrench};

    use super::{Gauge, TickTimes};

    /// A tick in which a hand at `hand` feels `force` [N], with no contact reported.
    fn sample(hand: Pose, force: DVec3) -> Sample {
        Sample {
            tick: 0,
            time: 0.0,
            device: DeviceState {
                pose: hand,
                twist: Twist::ZERO,
                buttons: 0,
            },
            output: TickOutput {
                world_from_haptic: hand,
                world_from_visual: hand,
                wrench: Wrench {
                    force,
                    torque: DVec3::ZERO,
                },
                contacts: 1,
                contact: None,
                penetration_of_haptic: 0.0,
                held: false,
                capped: true,
                coupling_energy: 0.0,
            },
            device_wrench: Wrench::ZERO,
        }
    }

    #[test]
    fn a_force_jump_is_what_the_motion_of_the_hand_does_not_explain() {
        let mut gauge = Gauge::new(1000.0, 1000);
        let at = |x: f64| Pose::from_translation(DVec3::X * x);
        gauge.add(&sample(at(0.0), DVec3::ZERO), 0.0);
        // 1 mm at 1000 N/m explains 1 N.
        gauge.add(&sample(at(0.001), DVec3::Z), 2e-9);
        assert!(gauge.summary.max_force_jump_n.abs() < 1e-12);
        gauge.add(&sample(at(0.001), DVec3::Z * 1.5), 1e-9);
        assert!((gauge.summary.max_force_jump_n - 0.5).abs() < 1e-12);
        // Turning about the handle moves the point in contact: here the handle's origin, which stays.
        let turned = Pose::new(DQuat::from_rotation_z(1.0), DVec3::X * 0.001);
        gauge.add(&sample(turned, DVec3::Z * 4.0), 0.0);
        assert!((gauge.summary.max_force_jump_n - 2.5).abs() < 1e-12);
        let summary = &gauge.summary;
        assert_eq!(
            (summary.ticks, summary.contact_ticks, summary.fallback_ticks),
            (4, 4, 4)
        );
        assert!((summary.seconds - 0.004).abs() < 1e-15);
        assert!((summary.max_penetration_m - 2e-9).abs() < 1e-20);
        assert!((gauge.mean_force() - 6.5 / 4.0).abs() < 1e-12);
    }

    #[test]
    fn percentiles_are_ranks() {
        let times = TickTimes::of((1..=2000).rev().collect());
        assert_eq!(
            (times.p50, times.p99, times.p999, times.max),
            (1000, 1980, 1998, 2000)
        );
        assert_eq!(TickTimes::of(vec![7]).p50, 7);
        assert_eq!(TickTimes::of(Vec::new()), TickTimes::default());
    }
}
