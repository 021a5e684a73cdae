//! Pairs whose distance or depth has a closed form.

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, Point, PointSet, Rounded, Segment, SimplexCache, SupportMap, Triangle,
    cast_shape, closest_points, distance, overlap,
};
use pliant_spatial::Pose;

fn solve<A: SupportMap, B: SupportMap>(a: &A, b: &B, a_from_b: &Pose) -> ClosestPoints {
    let mut cache = SimplexCache::default();
    let cold = closest_points(a, b, a_from_b, &mut cache);
    let warm = closest_points(a, b, a_from_b, &mut cache);
    assert!((cold.separation - warm.separation).abs() <= 1e-13 * (1.0 + cold.separation.abs()));
    assert!((cold.normal.length() - 1.0).abs() < 1e-14);
    let span = cold.witness_b - cold.witness_a;
    assert!(
        (span - cold.separation * cold.normal).length() < 1e-13 * (1.0 + cold.witness_a.length()),
        "{cold:?}"
    );
    assert_eq!(
        overlap(a, b, a_from_b, &mut SimplexCache::default()),
        distance(a, b, a_from_b, &mut SimplexCache::default()).is_none()
    );
    cold
}

fn unit_box() -> Cuboid {
    Cuboid {
        half: DVec3::splat(0.5),
    }
}

#[test]
fn parallel_boxes_apart_and_overlapping() {
    for (offset, expected) in [(1.3, 0.3), (1.0 + 1e-7, 1e-7), (0.8, -0.2), (1.0, 0.0)] {
        let found = solve(
            &unit_box(),
            &unit_box(),
            &Pose::from_translation(DVec3::X * offset),
        );
        assert!((found.separation - expected).abs() < 1e-15, "{found:?}");
        assert!((found.normal - DVec3::X).length() < 1e-14, "{found:?}");
    }
}

#[test]
fn identical_boxes_are_as_deep_as_they_are_wide() {
    let found = solve(&unit_box(), &unit_box(), &Pose::IDENTITY);
    assert!((found.separation + 1.0).abs() < 1e-14, "{found:?}");
}

#[test]
fn box_corner_over_face_edge_over_edge() {
    // Turned by 45° about z, then about the diagonal: a corner points down.
    let corner_down =
        DQuat::from_rotation_arc(DVec3::new(-1.0, -1.0, -1.0).normalize(), DVec3::NEG_Z);
    let half_diagonal = 0.75_f64.sqrt();
    for gap in [0.2, 1e-7, -1e-7, -0.05] {
        let pose = Pose::new(corner_down, DVec3::Z * (0.5 + half_diagonal + gap));
        let found = solve(&unit_box(), &unit_box(), &pose);
        assert!((found.separation - gap).abs() < 1e-14, "{gap} {found:?}");
        assert!((found.normal - DVec3::Z).length() < 1e-8, "{gap} {found:?}");
        assert!((found.witness_a - DVec3::new(0.0, 0.0, 0.5)).length() < 1e-8);
    }
    // Edge along y of B over edge along x of A, both at 45°.
    let half_edge = 0.5_f64.sqrt();
    let a_edge_up = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_4);
    let b_edge_down = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_4);
    for gap in [0.1, 1e-7, 1e-10, -1e-7, -0.05] {
        let pose = Pose::new(
            a_edge_up.inverse() * b_edge_down,
            a_edge_up.inverse() * (DVec3::Z * (2.0 * half_edge + gap)),
        );
        let found = solve(&unit_box(), &unit_box(), &pose);
        assert!((found.separation - gap).abs() < 1e-14, "{gap} {found:?}");
        let up = a_edge_up.inverse() * DVec3::Z;
        assert!((found.normal - up).length() < 1e-13, "{gap} {found:?}");
    }
}

#[test]
fn spheres_capsules_and_their_cores() {
    let sphere = |radius| Rounded {
        core: Point(DVec3::ZERO),
        radius,
    };
    let direction = DVec3::new(2.0, -1.0, 0.5).normalize();
    for (offset, expected) in [(1.0, 0.5), (0.3, -0.2)] {
        let pose = Pose::from_translation(direction * offset);
        let found = solve(&sphere(0.2), &sphere(0.3), &pose);
        assert!((found.separation - expected).abs() < 1e-15, "{found:?}");
        assert!((found.normal - direction).length() < 1e-15);
        assert!((found.witness_a - direction * 0.2).length() < 1e-15);
    }
    let concentric = solve(&sphere(0.2), &sphere(0.3), &Pose::IDENTITY);
    assert!((concentric.separation + 0.5).abs() < 1e-15);

    let capsule = Rounded {
        core: Segment {
            a: DVec3::NEG_Z,
            b: DVec3::Z,
        },
        radius: 0.1,
    };
    let quarter = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    for height in [0.5, 0.05] {
        let crossed = solve(&capsule, &capsule, &Pose::new(quarter, DVec3::Y * height));
        assert!((crossed.separation - (height - 0.2)).abs() < 1e-15);
        let parallel = solve(
            &capsule,
            &capsule,
            &Pose::from_translation(DVec3::Y * height),
        );
        assert!((parallel.separation - (height - 0.2)).abs() < 1e-15);
    }
    let through = solve(&capsule, &capsule, &Pose::from_rotation(quarter));
    assert!((through.separation + 0.2).abs() < 1e-15, "{through:?}");
    assert!((through.normal.dot(DVec3::Y).abs() - 1.0).abs() < 1e-15);
    let in_line = solve(&capsule, &capsule, &Pose::from_translation(DVec3::Z * 2.5));
    assert!((in_line.separation - 0.3).abs() < 1e-15);
    let same = solve(&capsule, &capsule, &Pose::IDENTITY);
    assert!((same.separation + 0.2).abs() < 1e-15, "{same:?}");
    assert!(same.normal.z.abs() < 1e-15, "the way out is sideways");
}

#[test]
fn segment_against_triangle() {
    let triangle = Triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
    let over = Segment {
        a: DVec3::new(0.2, 0.2, 0.3),
        b: DVec3::new(0.3, 0.2, 0.9),
    };
    let found = solve(&triangle, &over, &Pose::IDENTITY);
    assert!((found.separation - 0.3).abs() < 1e-15);
    assert!((found.witness_a - DVec3::new(0.2, 0.2, 0.0)).length() < 1e-15);
    // Past the hypotenuse x + y = 1 at (0.5, 0.5).
    let beyond = Segment {
        a: DVec3::new(1.0, 1.0, -1.0),
        b: DVec3::new(1.0, 1.0, 1.0),
    };
    let found = solve(&triangle, &beyond, &Pose::IDENTITY);
    assert!((found.separation - 0.5_f64.sqrt()).abs() < 1e-15);
    // Stuck through the face: out along the normal takes 0.1, sideways through the nearest edge takes 0.05.
    let through = |x: f64| Segment {
        a: DVec3::new(x, 0.3, -0.1),
        b: DVec3::new(x, 0.3, 0.4),
    };
    let found = solve(&triangle, &through(0.3), &Pose::IDENTITY);
    assert!((found.separation + 0.1).abs() < 1e-15, "{found:?}");
    let found = solve(&triangle, &through(0.05), &Pose::IDENTITY);
    assert!((found.separation + 0.05).abs() < 1e-15, "{found:?}");
    assert!((found.normal - DVec3::NEG_X).length() < 1e-14, "{found:?}");
}

#[test]
fn flat_and_degenerate_shapes_have_no_depth_but_an_answer() {
    let plate = Cuboid {
        half: DVec3::new(1.0, 0.5, 0.0),
    };
    let coplanar = Pose::new(DQuat::from_rotation_z(0.3), DVec3::new(0.2, 0.1, 0.0));
    let found = solve(&plate, &plate, &coplanar);
    assert!(found.separation.abs() < 1e-15, "{found:?}");
    assert!((found.normal.z.abs() - 1.0).abs() < 1e-14, "{found:?}");
    let point = Point(DVec3::new(0.1, 0.2, 0.0));
    assert!(solve(&plate, &point, &Pose::IDENTITY).separation.abs() < 1e-15);
    assert!(solve(&point, &point, &Pose::IDENTITY).separation.abs() < 1e-15);
    let nothing = PointSet(&[]);
    assert!(solve(&nothing, &nothing, &Pose::IDENTITY).separation.abs() < 1e-15);
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X];
    let found = solve(
        &PointSet(&line),
        &PointSet(&line),
        &Pose::from_translation(DVec3::X),
    );
    assert!(found.separation.abs() < 1e-15, "{found:?}");
}

#[test]
fn stale_caches_of_other_shapes_do_no_harm() {
    let mut cache = SimplexCache::default();
    let pose = Pose::from_translation(DVec3::X * 1.3);
    closest_points(&unit_box(), &unit_box(), &pose, &mut cache);
    let triangle = Triangle([DVec3::ZERO, DVec3::X, DVec3::Y]);
    let found = closest_points(
        &triangle,
        &Point(DVec3::new(0.2, 0.2, 0.7)),
        &Pose::IDENTITY,
        &mut cache,
    );
    assert!((found.separation - 0.7).abs() < 1e-15);
}

/// Haptic hovering: at a gap of 1e-7 m the normal must be exact, or the certified separation is not the distance.
#[test]
fn separation_is_the_support_gap_at_haptic_distances() {
    let tool = Cuboid {
        half: DVec3::new(0.05, 0.004, 0.002),
    };
    let object = Cuboid {
        half: DVec3::new(0.06, 0.05, 0.04),
    };
    let mut cache = SimplexCache::default();
    for step in 0..2000 {
        let angle = 1e-3 * f64::from(step);
        let rotation = DQuat::from_scaled_axis(DVec3::new(angle, 0.7 * angle, -0.4 * angle));
        // Onto a gap of 1e-7 along the normal found.
        let far = Pose::new(rotation, DVec3::new(0.01 * angle, 0.02, 0.3));
        let first = closest_points(&object, &tool, &far, &mut cache);
        let near = Pose::new(
            rotation,
            far.translation - first.normal * (first.separation - 1e-7),
        );
        let found = closest_points(&object, &tool, &near, &mut cache);
        let top = object.support(found.normal, 0).point.dot(found.normal);
        let in_tool = near.inverse_transform_vector(-found.normal);
        let bottom = near.transform_point(tool.support(in_tool, 0).point);
        let gap = bottom.dot(found.normal) - top;
        assert!((found.separation - 1e-7).abs() < 1e-14, "{step} {found:?}");
        assert!(
            (gap - found.separation).abs() < 1e-16,
            "{step} {gap} {found:?}"
        );
        let span = found.witness_b - found.witness_a;
        assert!(
            (span.length() - found.separation).abs() < 1e-15,
            "{step} {found:?}"
        );
    }
}

#[test]
fn witnesses_lie_on_the_side_that_leaves_when_both_sides_are_as_near() {
    let stick = Cuboid {
        half: DVec3::Z * 0.9,
    };
    let around = Cuboid {
        half: DVec3::new(0.07, 0.9, 0.8),
    };
    let pose = Pose::from_translation(DVec3::new(0.0, -0.5, 1.0));
    let found = solve(&stick, &around, &pose);
    assert!((found.separation + 0.07).abs() < 1e-15, "{found:?}");
}

/// Which of many equally near points is answered: what the documentation's front page says.
#[test]
fn shared_lines_are_met_at_an_end_and_shared_faces_in_the_middle() {
    let rod = Rounded::capsule(DVec3::ZERO, DVec3::X, 0.1);
    let pose = Pose::from_translation(DVec3::new(0.3, 0.5, 0.0));
    let found = closest_points(&rod, &rod, &pose, &mut SimplexCache::default());
    let x = found.witness_a.x;
    assert!(
        (x - 0.3).abs() < 1e-15 || (x - 1.0).abs() < 1e-15,
        "{found:?}"
    );
    assert!((found.witness_b - DVec3::new(x, 0.4, 0.0)).length() < 1e-15);
    let cube = Cuboid {
        half: DVec3::splat(0.5),
    };
    let pose = Pose::from_translation(DVec3::new(0.4, 0.2, 1.25));
    let found = closest_points(&cube, &cube, &pose, &mut SimplexCache::default());
    let middle = DVec3::new(0.2, 0.1, 0.5);
    assert!((found.witness_a - middle).length() < 1e-14, "{found:?}");
}

/// Parallel to 1.5e-13 rad and thrown onto one line: rounding decides where the lines cross, and put the point of A past the end
/// of B by 1.2e-5 m.
#[test]
fn segments_that_cross_at_almost_no_angle_meet_where_both_are() {
    let f = f64::from_bits;
    let v = |x: u64, y: u64, z: u64| DVec3::new(f(x), f(y), f(z));
    let half_a = v(
        0x3fb8_c63f_757f_98f7,
        0x3fd2_c85f_8f94_bdb5,
        0xbfd0_c61a_c783_a3b9,
    );
    let half_b = v(
        0xbfcc_2b0d_dbb3_933c,
        0x3fb8_1504_a79f_232d,
        0x3fcc_461d_d8e2_80e6,
    );
    let [a, b] = [half_a, half_b].map(|half| Segment { a: -half, b: half });
    let rotation = DQuat::from_xyzw(
        f(0x3fa5_71d4_de8f_7886),
        f(0x3fec_6f80_cd9f_0638),
        f(0x3fd4_8a08_9e88_0075),
        f(0xbfd4_ccc0_0937_76f0),
    );
    let apart = Pose::new(
        rotation,
        v(
            0x3f5d_dfde_d384_9f1e,
            0xbfc3_8b0c_18ad_4161,
            0x3fbe_5f92_a033_e8df,
        ),
    );
    let found = solve(&a, &b, &apart);
    let motion = -found.normal * (found.separation + 0.1);
    let hit = cast_shape(&a, &b, &apart, motion, &mut SimplexCache::default()).unwrap();
    let there = Pose::new(rotation, apart.translation + motion * hit.fraction);
    let [start, end] = [b.a, b.b].map(|end| there.transform_point(end));
    let along = end - start;
    let share = ((hit.witness - start).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    assert!(hit.witness.distance(start + along * share) < 1e-15);
}
