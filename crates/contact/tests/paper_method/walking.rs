//! Figure 3: the contact point goes over from component to component.
//!
//! The tools are pointed enough for the ray of figure 4 to miss, so that only the walk can act.

use glam::DVec3;
use pliant_contact::PaperEvent;
use pliant_mesh::{ConvexMesh, Feature};
use pliant_spatial::Pose;

use crate::scene::{
    Bench, Log, MM, aligned, blade, corner_up, gable, mm, needle, obstacle, placed, pointing_down,
    pyramid, rod,
};

const TIP: DVec3 = DVec3::new(0.1, 0.0, 0.0);
const HALF_EDGE_WIDTH: f64 = 0.5e-4;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Vertex,
    Edge,
    Face,
}

fn kind(feature: Feature) -> Kind {
    match feature {
        Feature::Vertex(_) => Kind::Vertex,
        Feature::Edge(_) => Kind::Edge,
        Feature::Face(_) => Kind::Face,
    }
}

/// Components that differ in normal, in the order in which the walk saw them: coplanar triangles count as one.
fn route(log: &Log, shape: &ConvexMesh) -> Vec<Feature> {
    let mesh = shape.topology();
    let normal = |feature: Feature| match feature {
        Feature::Vertex(v) => mesh.vertex_pseudonormal(v),
        Feature::Edge(e) => mesh.edge_normal(e),
        Feature::Face(f) => mesh.face_normal(f),
    };
    let mut route: Vec<Feature> = Vec::new();
    for event in &log.events {
        let PaperEvent::Walked { from, to } = *event else {
            panic!("{event:?}: nothing but walking was expected");
        };
        for feature in [from, to] {
            let known = route.last();
            if known.is_none_or(|&last| normal(last).distance(normal(feature)) > 1e-9) {
                route.push(feature);
            }
        }
    }
    route
}

/// Leads a tool point over the top of an object whose height above x is `−|x|·tan(slope)`, from x = −3 mm to 3 mm and back,
/// 1 mm under the surface; returns the two logs.
fn over_and_back(bench: &mut Bench, slope: f64) -> [Log; 2] {
    let rotation = pointing_down();
    let under = |x: f64, depth: f64| {
        let z = -x.abs() * slope.tan() - depth;
        placed(rotation, TIP, mm(x, 0.0, z))
    };
    // Straight in along the normal of the left slope, so that nothing slides.
    let into = mm(slope.sin(), 0.0, -slope.cos()) / MM;
    let entry = mm(-3.0, 0.0, -3.0 * slope.tan());
    bench.lead(&placed(rotation, TIP, entry - 0.2 * MM * into), 1);
    bench.lead(&placed(rotation, TIP, entry + MM * into), 60);
    let deep = MM / slope.cos() / MM;
    let mut legs = [3.0, -3.0].map(|end| {
        let mut log = bench.lead(&under(0.0, deep), 150);
        let rest = bench.lead(&under(end, deep), 150);
        log.events.extend(rest.events);
        log.deepest = log.deepest.max(rest.deepest);
        log.widest = log.widest.max(rest.widest);
        log
    });
    legs[0]
        .events
        .retain(|e| !matches!(e, PaperEvent::Detected { .. }));
    legs
}

fn slope() -> f64 {
    20.0_f64.to_radians()
}

#[test]
fn fig3_face_to_edge_to_face_and_back() {
    let start = placed(pointing_down(), TIP, mm(-3.0, 0.0, 5.0));
    let object = obstacle(gable(slope()), Pose::IDENTITY);
    let mut bench = Bench::new(object, needle(), start);
    for (log, side) in over_and_back(&mut bench, slope()).iter().zip([1.0, -1.0]) {
        let route = route(log, &bench.obstacles[0].shape);
        assert_eq!(
            route.iter().map(|f| kind(*f)).collect::<Vec<_>>(),
            [Kind::Face, Kind::Edge, Kind::Face]
        );
        let mesh = bench.obstacles[0].shape.topology();
        let (Feature::Edge(ridge), Feature::Face(face)) = (route[1], route[2]) else {
            unreachable!()
        };
        assert!(mesh.edge_normal(ridge).distance(DVec3::Z) < 1e-15);
        let expected = DVec3::new(side * slope().sin(), 0.0, slope().cos());
        assert!(mesh.face_normal(face).distance(expected) < 1e-12);
        assert!(log.deepest < 1e-9, "{log:?}");
        // On the strip the tip is as far above the slopes as they fall over half its width.
        assert!(
            log.widest < HALF_EDGE_WIDTH * slope().sin() + 1e-9,
            "{}",
            log.widest
        );
    }
}

#[test]
fn fig3_face_to_vertex_to_face_and_back() {
    // Faces towards ±x: the edges, on the diagonals, are flatter than the faces.
    let edge_slope = (slope().tan() * std::f64::consts::FRAC_1_SQRT_2).atan();
    let shape = pyramid(edge_slope, std::f64::consts::FRAC_PI_4);
    let start = placed(pointing_down(), TIP, mm(-3.0, 0.0, 5.0));
    let mut bench = Bench::new(obstacle(shape, Pose::IDENTITY), needle(), start);
    for (log, side) in over_and_back(&mut bench, slope()).iter().zip([1.0, -1.0]) {
        let mesh = bench.obstacles[0].shape.topology();
        let route = route(log, &bench.obstacles[0].shape);
        assert!(
            route
                .iter()
                .any(|f| matches!(f, Feature::Vertex(v) if mesh.position(*v) == DVec3::ZERO)),
            "{route:?}"
        );
        let (first, last) = (route[0], route[route.len() - 1]);
        for (feature, sign) in [(first, -side), (last, side)] {
            let Feature::Face(face) = feature else {
                panic!("{feature:?} is not a face")
            };
            let expected = DVec3::new(sign * slope().sin(), 0.0, slope().cos());
            assert!(mesh.face_normal(face).distance(expected) < 1e-12);
        }
        assert!(log.deepest < 1e-9, "{log:?}");
        assert!(log.widest < HALF_EDGE_WIDTH, "{}", log.widest);
    }
}

#[test]
fn fig3_with_tool_edge_along_object_edge() {
    let start = placed(pointing_down(), TIP, mm(-3.0, 0.0, 5.0));
    let object = obstacle(gable(slope()), Pose::IDENTITY);
    let mut bench = Bench::new(object, blade(), start);
    for log in &over_and_back(&mut bench, slope()) {
        let route = route(log, &bench.obstacles[0].shape);
        assert_eq!(
            route.iter().map(|f| kind(*f)).collect::<Vec<_>>(),
            [Kind::Face, Kind::Edge, Kind::Face]
        );
        assert!(
            log.deepest < 1e-9 && log.widest < HALF_EDGE_WIDTH,
            "{log:?}"
        );
    }
}

#[test]
fn fig3_with_tool_edge_across_object_edges() {
    // The blade's edge lies across the two pyramid edges over the x axis, which meet at the apex.
    let shape = pyramid(slope(), 0.0);
    let start = placed(pointing_down(), TIP, mm(-3.0, 0.0, 5.0));
    let mut bench = Bench::new(obstacle(shape, Pose::IDENTITY), blade(), start);
    for (log, side) in over_and_back(&mut bench, slope()).iter().zip([1.0, -1.0]) {
        let mesh = bench.obstacles[0].shape.topology();
        let route = route(log, &bench.obstacles[0].shape);
        let [
            Feature::Edge(from),
            Feature::Vertex(apex),
            Feature::Edge(to),
        ] = route[..]
        else {
            panic!("{route:?} is not edge, vertex, edge")
        };
        assert_eq!(mesh.position(apex), DVec3::ZERO);
        for (edge, sign) in [(from, -side), (to, side)] {
            let expected = DVec3::new(sign * slope().sin(), 0.0, slope().cos());
            assert!(mesh.edge_normal(edge).distance(expected) < 1e-12);
        }
        assert!(
            log.deepest < 1e-9 && log.widest < HALF_EDGE_WIDTH,
            "{log:?}"
        );
    }
}

#[test]
fn fig3_with_tool_face_on_object_vertex() {
    // Flat on the corner first, then tilted about it until it almost lies on one of the three faces, then off over that face.
    let object = corner_up();
    let in_box = DVec3::new(1.0, 0.02, 0.02).normalize();
    let steep = object.world_from_object.transform_vector(in_box);
    let face_normal = object.world_from_object.transform_vector(DVec3::X);
    let on_tool = mm(50.0, 0.0, -3.0);
    let flat = placed(glam::DQuat::IDENTITY, on_tool, mm(0.0, 0.0, 0.5));
    let mut bench = Bench::new(object, rod(3.0 * MM, 1), flat);
    bench.lead_by(mm(0.0, 0.0, -1.5), 30);
    let side = steep.cross(DVec3::Z).normalize();
    let tilted = aligned(
        [DVec3::Y, DVec3::Z],
        [(side - steep * side.dot(steep)).normalize(), steep],
    );
    // Yaw first: the rod's axis at right angles to the tilt.
    let yawed = aligned([DVec3::Y, DVec3::Z], [side, DVec3::Z]);
    let under = mm(0.0, 0.0, -1.0);
    let yaw = bench.lead_about(on_tool, &placed(yawed, on_tool, under), 100);
    let tilt = bench.lead_about(on_tool, &placed(tilted, on_tool, under), 100);
    assert!(
        yaw.events.is_empty() && tilt.events.is_empty(),
        "{yaw:?} {tilt:?}"
    );
    let off = (face_normal - DVec3::Z * face_normal.z).normalize();
    let log = bench.lead_by(0.1 * MM * off, 1);
    let Some(PaperEvent::Walked { from, .. }) = log.events.first() else {
        panic!("{log:?}: the ray hits further than the step, so the point walks");
    };
    assert_eq!(kind(*from), Kind::Vertex);
    let contact = bench
        .advance(&bench.tracker.world_from_haptic())
        .contact
        .unwrap();
    assert!(contact.normal.distance(face_normal) < 1e-12, "{contact:?}");
    assert!(
        log.deepest < 1e-9 && log.widest < HALF_EDGE_WIDTH,
        "{log:?}"
    );
}
