//! Queries of the collision crate, on all shapes, apart and deep, with cold and warm caches, and those of the mesh hierarchy.

use glam::DVec3;
use pliant_collision::{
    MeshCache, ObjectBvh, PointSet, SimplexCache, TriangleBvh, cast_ray, cast_shape,
    closest_points, distance, overlap,
};
use pliant_mesh::{Aabb, generate};
use pliant_spatial::Pose;
use pliant_tests::collision::families::{Family, Pair};
use pliant_tests::collision::kinds::{Kind, prism};

use crate::allocations;

/// Asks everything of a pair twice with one cache; the signed distance.
fn ask_all(pair: &Pair) -> f64 {
    let [a, b] = &pair.shapes;
    let pose = &pair.a_from_b;
    let mut cache = SimplexCache::default();
    let mut separation = 0.0;
    a.with(|a| {
        b.with(|b| {
            for _ in 0..2 {
                let found = closest_points(a, b, pose, &mut cache);
                separation = found.separation;
                distance(a, b, pose, &mut cache);
                overlap(a, b, pose, &mut cache);
                let motion = found.normal * (-2.0 * pair.size);
                cast_shape(a, b, pose, motion, &mut cache);
            }
            cast_ray(a, DVec3::splat(3.0), DVec3::splat(-1.0).normalize(), 10.0);
        });
    });
    separation
}

#[test]
fn no_query_of_convex_shapes_allocates() {
    let families = [
        Family::Apart,
        Family::Penetrating,
        Family::FacesParallel,
        Family::Identical,
        Family::Concentric,
        Family::Flat,
    ];
    let round = [Kind::Cylinder, Kind::Cone];
    let small = Kind::SMALL.iter().enumerate().flat_map(|(number, &a)| {
        let others = Kind::SMALL[number..].iter().chain(&[Kind::Ellipsoid]);
        others.map(move |&b| [a, b])
    });
    let turned = round
        .iter()
        .flat_map(|&a| Kind::SMALL.iter().chain(&round).map(move |&b| [a, b]));
    let kinds: Vec<[Kind; 2]> = small.chain(turned).collect();
    let (mut apart, mut deep) = (0, 0);
    for family in families {
        for &kinds in &kinds {
            for seed in 0..4 {
                let pair = family.pair(kinds, seed);
                let before = allocations();
                let separation = ask_all(&pair);
                let count = allocations() - before;
                assert_eq!(count, 0, "{family:?} {kinds:?} {seed}");
                apart += u32::from(separation > 0.0);
                deep += u32::from(separation < -0.01 * pair.size);
            }
        }
    }
    assert!(apart > 500 && deep > 500, "{apart} apart, {deep} deep");
}

#[test]
fn no_query_of_the_mesh_hierarchy_allocates() {
    let radii = DVec3::new(0.06, 0.05, 0.04);
    let mesh = generate::latitude_longitude_ellipsoid(radii, 96, 67).expect("enough sectors");
    let bvh = TriangleBvh::new(&mesh);
    let before = allocations();
    let (mut met, mut hits) = (0, 0);
    for step in 0..1000 {
        let angle = f64::from(step) * 0.1;
        let point = DVec3::new(angle.cos(), angle.sin(), 0.3 * angle.sin()) * 0.07;
        bvh.overlapping(&Aabb::from_points(&[point]).inflated(0.02), |_| met += 1);
        hits += u32::from(
            bvh.cast_ray(&mesh, point, -point.normalize(), 1.0)
                .is_some(),
        );
        hits += u32::from(bvh.closest_point(&mesh, point, 1.0).is_some());
    }
    assert_eq!(allocations() - before, 0);
    assert!(met > 1000 && hits == 2000, "{met} met, {hits} hits");
}

/// After one round along a path the buffers are as large as the path needs.
#[test]
fn no_shape_query_of_the_mesh_hierarchy_allocates_after_a_round() {
    let radii = DVec3::new(0.06, 0.05, 0.04);
    let mesh = generate::latitude_longitude_ellipsoid(radii, 96, 67).expect("enough sectors");
    let mut bvh = TriangleBvh::new(&mesh);
    let tool: Vec<DVec3> = prism(0.6).iter().map(|&corner| corner * 0.03).collect();
    let path = |step: u32| {
        let angle = f64::from(step) * 0.01;
        let place = DVec3::new(0.062 * angle.cos(), 0.052 * angle.sin(), 0.003);
        Pose::new(glam::DQuat::from_rotation_x(0.1 * angle), place)
    };
    let mut cache = MeshCache::default();
    let mut found = 0;
    let mut round = |bvh: &TriangleBvh| {
        for step in 0..629 {
            let (pose, tool) = (path(step), PointSet(&tool));
            found += bvh.contacts(&mesh, &tool, &pose, 1e-3, &mut cache).len();
            found += bvh
                .every_contact(&mesh, &tool, &pose, 0.0, &mut cache)
                .len();
            let deepest = bvh.deepest(&mesh, &tool, &pose, 0.1, &mut cache);
            found += usize::from(deepest.is_some());
            let hit = bvh.cast_shape(&mesh, &tool, &pose, -pose.translation);
            found += usize::from(hit.is_some());
        }
    };
    round(&bvh);
    let before = allocations();
    round(&bvh);
    assert_eq!(allocations() - before, 0);
    assert!(found > 2000, "{found}");
    let before = allocations();
    bvh.refit(&mesh);
    assert_eq!(allocations() - before, 0);
}

#[test]
fn no_query_of_the_object_hierarchy_allocates() {
    let box_at = |x: f64| Aabb::from_points(&[DVec3::X * x]).inflated(0.6);
    let boxes: Vec<Aabb> = (0..100).map(|i| box_at(f64::from(i))).collect();
    let mut bvh = ObjectBvh::new(&boxes);
    let before = allocations();
    let mut met = 0;
    bvh.overlapping(&box_at(10.0), |_| met += 1);
    bvh.pairs(&boxes, |_, _| met += 1);
    bvh.refit(&boxes);
    assert_eq!(allocations() - before, 0);
    assert!(met > 99, "{met}");
}
