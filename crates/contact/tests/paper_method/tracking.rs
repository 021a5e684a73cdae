//! Figures 1 and 2: first contact, and motion across the normal.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::{DQuat, DVec3};
use pliant_contact::{PaperEvent, PaperParameters};
use pliant_mesh::Feature;
use pliant_spatial::Pose;

use crate::scene::{
    Bench, MM, aligned, corner_up, cuboid, mm, needle, obstacle, placed, pointing_down, rod,
};

const TIP: DVec3 = DVec3::new(0.1, 0.0, 0.0);

/// Motions of a hand in contact [m]: mixed signs, some along an axis, none longer than 30 µm.
fn motions() -> impl Iterator<Item = DVec3> {
    (0..40).map(|k| {
        let k = f64::from(k);
        mm(
            0.03 * (1.7 * k).sin(),
            0.02 * (2.3 * k).cos(),
            0.02 * (0.9 * k).sin() - 0.005,
        )
    })
}

/// Advances by `motions` and demands that the visual tool moves by C, exactly across `normal`, and that its contact point keeps
/// its height over the plane through `on_plane`.
fn assert_moves_by_c(bench: &mut Bench, normal: DVec3, on_plane: DVec3) {
    for motion in motions() {
        let before = bench.tracker.world_from_visual();
        let mut haptic = bench.tracker.world_from_haptic();
        haptic.translation += motion;
        let outcome = bench.advance(&haptic);
        let moved = outcome.world_from_visual.translation - before.translation;
        let c = motion - motion.dot(normal) * normal;
        assert!(
            (moved - c).length() <= 1e-15,
            "{motion}: {moved} is not {c}"
        );
        assert!(
            moved.dot(normal).abs() <= 1e-15,
            "{motion}: leaves the plane"
        );
        let tool_point = outcome.tool_point.unwrap();
        let height = (outcome.world_from_visual.transform_point(tool_point) - on_plane).dot(normal);
        assert!(height.abs() <= 1e-15, "{motion}: height {height:e}");
        let contact = outcome.contact.unwrap();
        assert!((contact.normal - normal).length() <= 1e-15);
        let spring = outcome.world_from_visual.translation - haptic.translation;
        assert!((contact.share - spring.length()).abs() <= 1e-15);
    }
}

#[test]
fn first_contact_puts_the_contact_point_on_the_surface() {
    let above = placed(pointing_down(), TIP, mm(10.0, -5.0, 25.5));
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), needle(), above);
    let free = bench.advance(&above);
    assert!(free.contact.is_none() && free.events.as_slice().is_empty());
    assert_eq!(free.world_from_visual, above);

    let inside = placed(pointing_down(), TIP, mm(10.0, -5.0, 24.9));
    let touched = bench.advance(&inside);
    let detected = PaperEvent::Detected {
        object: 0,
        segment: 0,
    };
    assert_eq!(touched.events.as_slice(), [detected]);
    let contact = touched.contact.unwrap();
    assert!(matches!(contact.feature, Feature::Face(_)));
    assert!((contact.normal - DVec3::Z).length() < 1e-15);
    assert!((contact.point - mm(10.0, -5.0, 25.0)).length() < 1e-12);
    assert!((contact.share - 0.1 * MM).abs() < 1e-12);
    let tip = touched.world_from_visual.transform_point(TIP);
    assert!((tip - mm(10.0, -5.0, 25.0)).length() < 1e-12);

    let left = bench.advance(&above);
    assert_eq!(left.events.as_slice(), [PaperEvent::Released]);
    assert!(left.contact.is_none());
    assert_eq!(left.world_from_visual, above);
}

#[test]
fn fig2_on_a_face_the_tool_moves_by_c() {
    for turn in [DVec3::ZERO, DVec3::new(0.3, -0.8, 0.5)] {
        let world_from_box = Pose::new(DQuat::from_scaled_axis(turn), mm(20.0, -30.0, 10.0));
        let surface = |depth: f64| {
            let in_box = placed(pointing_down(), TIP, mm(7.0, 4.0, 25.0 - depth));
            world_from_box * in_box
        };
        let mut bench = Bench::new(obstacle(cuboid(), world_from_box), needle(), surface(-0.5));
        bench.lead(&surface(1.0), 30);
        let normal = world_from_box.transform_vector(DVec3::Z);
        let on_plane = world_from_box.transform_point(mm(7.0, 4.0, 25.0));
        assert_moves_by_c(&mut bench, normal, on_plane);
    }
}

#[test]
fn fig2_with_tool_edge_on_object_edge() {
    // The rod's edge, down along the slope between the two faces, crosses the box edge x = 50, z = 25 mm.
    let out = DVec3::new(1.0, 0.0, 1.0) * FRAC_1_SQRT_2;
    let along = DVec3::new(1.0, 0.0, -1.0) * FRAC_1_SQRT_2;
    let rotation = aligned(
        [DVec3::X, DVec3::new(0.0, 1.0, 1.0) * FRAC_1_SQRT_2],
        [along, out],
    );
    let on_tool = mm(50.0, -3.0, -3.0);
    let on_edge = mm(50.0, 8.0, 25.0);
    let above = placed(rotation, on_tool, on_edge + 0.5 * MM * out);
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), rod(3.0 * MM, 1), above);
    bench.lead_by(-1.5 * MM * out, 30);
    assert_moves_by_c(&mut bench, out, on_edge);
    let contact = bench.advance(&bench.tracker.world_from_haptic()).contact;
    assert!(matches!(contact.unwrap().feature, Feature::Edge(_)));
}

#[test]
fn fig2_with_tool_face_on_object_vertex() {
    let above = placed(DQuat::IDENTITY, mm(50.0, 0.0, -3.0), mm(0.0, 0.0, 0.5));
    let mut bench = Bench::new(corner_up(), rod(3.0 * MM, 1), above);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let contact = bench.advance(&bench.tracker.world_from_haptic()).contact;
    assert!(matches!(contact.unwrap().feature, Feature::Vertex(_)));
    assert_moves_by_c(&mut bench, DVec3::Z, DVec3::ZERO);
}

#[test]
fn the_orientation_is_copied_and_the_contact_point_stays_on_the_face() {
    let above = placed(pointing_down(), TIP, mm(0.0, 0.0, 25.5));
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), needle(), above);
    bench.lead_by(mm(0.0, 0.0, -2.5), 50);
    let mut haptic = bench.tracker.world_from_haptic();
    // 40 ticks turn the needle by 0.15 rad and lift its tip by 1 mm of the 2 mm it is pressed in.
    for _ in 0..40 {
        haptic.rotation =
            (DQuat::from_scaled_axis(DVec3::new(2e-3, -1e-3, 3e-3)) * haptic.rotation).normalize();
        let outcome = bench.advance(&haptic);
        assert_eq!(outcome.world_from_visual.rotation, haptic.rotation);
        let tip = outcome.world_from_visual.transform_point(TIP);
        assert!((tip.z - 25.0 * MM).abs() < 1e-15, "{tip}");
    }
}

#[test]
fn detection_every_other_tick_finds_and_loses_contact_a_tick_later() {
    let parameters = PaperParameters {
        detection_interval: 2,
        ..PaperParameters::default()
    };
    let at = |z: f64| placed(pointing_down(), TIP, mm(0.0, 0.0, z));
    let object = vec![obstacle(cuboid(), Pose::IDENTITY)];
    let mut bench = Bench::with(object, needle(), at(26.0), &parameters);
    let touching: Vec<bool> = [26.0, 24.5, 24.5, 24.4, 26.0, 26.0, 24.5]
        .map(|z| bench.advance(&at(z)).contact.is_some())
        .to_vec();
    // Detection runs on ticks 0, 2, 4, 6.
    assert_eq!(touching, [false, false, true, true, false, false, true]);
}

#[test]
fn a_pose_that_is_not_finite_changes_nothing() {
    let above = placed(pointing_down(), TIP, mm(0.0, 0.0, 25.5));
    let mut bench = Bench::new(obstacle(cuboid(), Pose::IDENTITY), needle(), above);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let before = bench.tracker.world_from_visual();
    let outcome = bench.advance(&Pose::from_translation(DVec3::NAN));
    assert_eq!(outcome.world_from_visual, before);
    assert!(outcome.contact.is_some() && outcome.events.as_slice().is_empty());
}
