//! Random motion: the state stays finite and repeats.

use glam::{DQuat, DVec3};
use pliant_contact::{Obstacle, PaperEvent, PaperParameters};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

use crate::scene::{Bench, MM, cuboid, ellipsoid, mm, obstacle, rod};

/// Deterministic numbers in [−1, 1): multiply-with-carry by the constants of G. Marsaglia (2003).
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = 4_294_957_665 * (self.0 & 0xffff_ffff) + (self.0 >> 32);
        let low = u32::try_from(self.0 & 0xffff_ffff).unwrap();
        f64::from(low) / f64::from(1_u32 << 31) - 1.0
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::new(self.roll(), self.roll(), self.roll())
    }
}

struct Run {
    poses: Vec<Pose>,
    contact_ticks: u32,
    walked: u32,
    /// Deepest overlap of the visual tool, judged on every fifth tick [m].
    deepest: f64,
}

/// 10⁴ ticks of a hand that is pulled towards the object's middle and pushed about, at most 1 m/s and 10 rad/s.
fn run(objects: Vec<Obstacle>, segments: u32, parameters: &PaperParameters, seed: u64) -> Run {
    let mut dice = Dice(seed);
    let mut haptic = Pose::from_translation(mm(-50.0, 0.0, 60.0));
    let mut bench = Bench::with(objects, rod(3.0 * MM, segments), haptic, parameters);
    let (mut velocity, mut spin) = (DVec3::ZERO, DVec3::ZERO);
    let mut result = Run {
        poses: Vec::new(),
        contact_ticks: 0,
        walked: 0,
        deepest: 0.0,
    };
    for tick in 0..10_000 {
        let middle = haptic.transform_point(mm(50.0, 0.0, 0.0));
        // Towards a shell of 50 mm around the middle, so that it enters and leaves.
        let pull = middle.normalize_or_zero() * (0.05 - middle.length()) * 2.0;
        velocity = (velocity * 0.98 + 0.1 * dice.vector() + pull).clamp_length_max(1.0);
        spin = (spin * 0.98 + dice.vector()).clamp_length_max(10.0);
        haptic.translation += velocity * 1e-3;
        haptic.rotation = (DQuat::from_scaled_axis(spin * 1e-3) * haptic.rotation).normalize();
        let outcome = bench.advance(&haptic);
        assert!(outcome.world_from_visual.is_finite());
        if let Some(contact) = outcome.contact {
            assert!(contact.point.is_finite() && contact.share.is_finite());
            assert!((contact.normal.length() - 1.0).abs() < 1e-9);
            result.contact_ticks += 1;
            if tick % 5 == 0 {
                let separation = bench.separation(&outcome.world_from_visual);
                result.deepest = result.deepest.max(-separation);
            }
        }
        let walks = outcome.events.as_slice().iter();
        result.walked += u32::try_from(
            walks
                .filter(|e| matches!(e, PaperEvent::Walked { .. }))
                .count(),
        )
        .unwrap();
        result.poses.push(outcome.world_from_visual);
    }
    result
}

/// One run, judged, and one to compare with it.
fn assert_finite_and_repeatable(shape: &ConvexMesh, segments: u32) {
    let object = obstacle(shape.clone(), Pose::IDENTITY);
    let objects = vec![object];
    let every_tick = PaperParameters::default();
    let first = run(objects.clone(), segments, &every_tick, 0x2003_0001);
    assert!(
        first.contact_ticks > 3000,
        "{} contact ticks",
        first.contact_ticks
    );
    assert!(first.walked > 50, "{} walks", first.walked);
    // With detection on every tick a single object is never entered.
    assert!(
        first.deepest < 1.1e-9,
        "{segments} segments: {:e} m",
        first.deepest
    );
    let again = run(objects, segments, &every_tick, 0x2003_0001);
    assert!(first.poses == again.poses);
}

#[test]
fn random_motion_on_a_box_stays_finite_and_repeats() {
    assert_finite_and_repeatable(&cuboid(), 1);
    assert_finite_and_repeatable(&cuboid(), 10);
}

#[test]
fn random_motion_on_an_ellipsoid_stays_finite_and_repeats() {
    assert_finite_and_repeatable(&ellipsoid(), 1);
    assert_finite_and_repeatable(&ellipsoid(), 10);
}

#[test]
fn random_motion_with_detection_every_other_tick_stays_finite() {
    let every_other = PaperParameters {
        detection_interval: 2,
        ..PaperParameters::default()
    };
    let object = vec![obstacle(ellipsoid(), Pose::IDENTITY)];
    let result = run(object, 10, &every_other, 0x2003_0002);
    assert!(
        result.contact_ticks > 3000,
        "{} contact ticks",
        result.contact_ticks
    );
    // In between the tool may sink in by what its points move in a tick: 1 m/s and 10 rad/s at up to 0.1 m.
    assert!(
        (1e-4..2e-3).contains(&result.deepest),
        "{:e} m",
        result.deepest
    );
}

#[test]
fn between_two_objects_back_off_has_no_rule() {
    // A slot of 8 mm between two boxes, and a rod of 6 mm that turns in it.
    let slot = [-54.0, 54.0]
        .map(|y| obstacle(cuboid(), Pose::from_translation(mm(0.0, y, 0.0))))
        .to_vec();
    let every_tick = PaperParameters::default();
    let result = run(slot.clone(), 1, &every_tick, 0x2003_0003);
    assert!(
        result.contact_ticks > 1000,
        "{} contact ticks",
        result.contact_ticks
    );
    // Pushed out of one box into the other and back, it stays in both.
    assert!(
        (1e-3..6e-3).contains(&result.deepest),
        "{:e} m",
        result.deepest
    );
    assert!(result.poses == run(slot, 1, &every_tick, 0x2003_0003).poses);
}
