//! Nothing is missed: box queries of both hierarchies against all boxes, in `f64`, on coordinates chosen to round badly.

use glam::DVec3;
use pliant_collision::{ObjectBvh, TriangleBvh};
use pliant_mesh::{Aabb, TriangleMesh};
use proptest::prelude::{Strategy, prop_assert, prop_assert_eq, prop_oneof, proptest};

/// A coordinate: round, one unit in the last place beside it, or any.
fn coordinate() -> impl Strategy<Value = f64> {
    let round = (-8..=8).prop_map(|i: i32| f64::from(i) / 8.0);
    let beside = (-8..=8, 0..2).prop_map(|(i, up)| {
        let value = f64::from(i) / 3.0;
        if up == 0 {
            value.next_up()
        } else {
            value.next_down()
        }
    });
    prop_oneof![round, beside, -1.0..1.0]
}

fn point() -> impl Strategy<Value = DVec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

/// Where and how large: near or 10⁴ m off, from micrometres to kilometres.
fn placement() -> impl Strategy<Value = (f64, DVec3)> {
    let origin = prop_oneof![
        (0..1).prop_map(|_| DVec3::ZERO),
        point().prop_map(|p| p * 1e4),
        point().prop_map(|p| p * 1e-3),
    ];
    let scale = prop_oneof![
        (0..1).prop_map(|_| 1e-6),
        (0..1).prop_map(|_| 1.0),
        (0..1).prop_map(|_| 1e3 / 3.0)
    ];
    (scale, origin)
}

proptest! {
    #[test]
    fn triangles_whose_boxes_meet_are_found(
        corners in proptest::collection::vec((point(), point(), point()), 1..60),
        (scale, origin) in placement(), pick in 0..60_usize, with in point(),
    ) {
        let place = |p: DVec3| p * scale + origin;
        let positions: Vec<DVec3> = corners.iter().flat_map(|t| [place(t.0), place(t.1), place(t.2)]).collect();
        let count = u32::try_from(corners.len()).expect("small");
        let triangles = (0..count).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mesh = TriangleMesh::new(positions.clone(), triangles).expect("valid");
        let bvh = TriangleBvh::new(&mesh);
        // A box that ends exactly where some corner is.
        let wanted = Aabb::from_points(&[positions[pick % positions.len()], place(with)]);
        let mut found = Vec::new();
        bvh.overlapping(&wanted, |triangle| found.push(triangle));
        found.sort_unstable();
        let near = wanted.inflated(2e-7 * mesh.bounds().diagonal() + 1e-12 * origin.length());
        for triangle in 0..count {
            let bounds = Aabb::from_points(&mesh.corners(triangle));
            let reported = found.binary_search(&triangle).is_ok();
            prop_assert!(reported || !bounds.overlaps(&wanted), "{triangle} is missed");
            prop_assert!(!reported || bounds.overlaps(&near), "{triangle} is far");
        }
    }

    #[test]
    fn objects_boxes_rays_pairs_and_refits(
        corners in proptest::collection::vec((point(), point()), 0..40),
        moved in proptest::collection::vec((point(), point()), 40),
        (scale, origin) in placement(), query in (point(), point()), slot in 0..40_usize,
    ) {
        let place = |p: DVec3| p * scale + origin;
        let around = |t: &(DVec3, DVec3)| Aabb::from_points(&[place(t.0), place(t.0 + 0.3 * t.1)]);
        let mut boxes: Vec<Aabb> = corners.iter().map(around).collect();
        // An unbounded object, such as a floor, and one that is not there.
        if slot < boxes.len() {
            boxes[slot].min.x = f64::NEG_INFINITY;
            boxes[slot].max.y = f64::INFINITY;
            boxes[slot / 2] = Aabb::EMPTY;
        }
        let mut bvh = ObjectBvh::new(&boxes);
        for round in 0..2 {
            let wanted = around(&query);
            let mut found = Vec::new();
            bvh.overlapping(&wanted, |object| found.push(object as usize));
            for (object, bounds) in boxes.iter().enumerate() {
                prop_assert!(found.contains(&object) || !bounds.overlaps(&wanted), "{object}, round {round}");
                prop_assert!(!found.contains(&object) || bounds.min.x <= bounds.max.x);
            }
            let mut pairs = Vec::new();
            bvh.pairs(&boxes, |a, b| pairs.push((a as usize, b as usize)));
            let total = pairs.len();
            pairs.sort_unstable();
            pairs.dedup();
            prop_assert_eq!(pairs.len(), total, "no pair twice");
            let (start, way) = (place(query.0), query.1.normalize_or(DVec3::X));
            let mut along = Vec::new();
            bvh.along_ray(start, way, f64::INFINITY, |object, reach| {
                along.push(object as usize);
                reach
            });
            for (i, a) in boxes.iter().enumerate() {
                let meets = |j: &usize| a.overlaps(&boxes[*j]) && *j > i;
                for j in (0..boxes.len()).filter(meets) {
                    prop_assert!(pairs.binary_search(&(i, j)).is_ok(), "{i} {j}");
                }
                let middle = a.center();
                let ahead = (middle - start).dot(way);
                let through = middle.is_finite() && (start + way * ahead).distance(middle) < 1e-9 * scale;
                prop_assert!(!through || ahead < 0.0 || along.contains(&i), "{i} on the ray");
            }
            boxes = boxes.iter().zip(&moved).map(|(_, to)| around(to)).collect();
            bvh.refit(&boxes);
        }
    }
}

#[test]
fn rays_to_the_middles_of_boxes_meet_them() {
    let boxes: Vec<Aabb> = (0..200)
        .map(|i| {
            let angle = 2.4 * f64::from(i);
            let middle = DVec3::new(angle.cos(), angle.sin(), 0.01 * f64::from(i)) * 1e4;
            Aabb::from_points(&[middle - 1e-3, middle + 1e-3])
        })
        .collect();
    let bvh = ObjectBvh::new(&boxes);
    for (object, bounds) in boxes.iter().enumerate() {
        let way = bounds.center().normalize();
        let mut nearest = None;
        bvh.along_ray(DVec3::ZERO, way, 1e5, |candidate, _| {
            nearest = Some(candidate as usize);
            0.0
        });
        assert_eq!(nearest, Some(object));
    }
}
