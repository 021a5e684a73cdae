//! Box against box: the closed form against brute force over corners, edges and separating axes, in every degeneracy.

use std::cell::Cell;

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cuboid, Rounded, SimplexCache, SupportMap, SupportPoint, closest_points,
    distance, overlap,
};
use pliant_spatial::Pose;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Largest error of any length, relative to the coordinates.
const TOLERANCE: f64 = 1e-13;

/// Two boxes, how they lie, and what lengths are relative to.
#[derive(Clone, Copy, Debug)]
struct Case {
    a: Cuboid,
    b: Cuboid,
    a_from_b: Pose,
}

impl Case {
    fn extent(&self) -> f64 {
        self.a.half.length() + self.b.half.length() + self.a_from_b.translation.length()
    }

    fn corners(cuboid: &Cuboid) -> [DVec3; 8] {
        [0, 1, 2, 3, 4, 5, 6, 7].map(|index| cuboid.vertex(index))
    }

    /// Corners of A and of B, in A.
    fn all_corners(&self) -> [[DVec3; 8]; 2] {
        let placed = Self::corners(&self.b).map(|p| self.a_from_b.transform_point(p));
        [Self::corners(&self.a), placed]
    }

    /// Gap between the supporting planes along a unit vector, over all corners.
    fn gap(&self, normal: DVec3) -> f64 {
        let [a, b] = self.all_corners();
        let top = a
            .iter()
            .map(|p| p.dot(normal))
            .fold(f64::NEG_INFINITY, f64::max);
        let bottom = b
            .iter()
            .map(|p| p.dot(normal))
            .fold(f64::INFINITY, f64::min);
        bottom - top
    }

    /// The signed distance: of overlapping boxes over all products of two sides, of separated ones over all corners and
    /// pairs of edges.
    fn truth(&self) -> f64 {
        let axes = DVec3::AXES;
        let sides: Vec<DVec3> = axes
            .into_iter()
            .chain(axes.map(|axis| self.a_from_b.rotation * axis))
            .collect();
        let mut best = f64::NEG_INFINITY;
        for (i, u) in sides.iter().enumerate() {
            for v in &sides[..i] {
                // Parallel sides to rounding; a face of the difference that thin decides nothing that others do not.
                if let Some(normal) = u.cross(*v).try_normalize() {
                    best = best.max(self.gap(normal)).max(self.gap(-normal));
                }
            }
        }
        if best <= 0.0 {
            return best;
        }
        self.distance_of_features()
    }

    fn distance_of_features(&self) -> f64 {
        let [of_a, of_b] = self.all_corners();
        let mut least = f64::INFINITY;
        for corner in of_b {
            let nearest = corner.clamp(-self.a.half, self.a.half);
            least = least.min(corner.distance(nearest));
        }
        for corner in of_a {
            let in_b = self.a_from_b.inverse_transform_point(corner);
            least = least.min(in_b.distance(in_b.clamp(-self.b.half, self.b.half)));
        }
        for [p, q] in edges(&of_a) {
            for [r, s] in edges(&of_b) {
                least = least.min(of_lines(q - p, s - r, p - r));
            }
        }
        least
    }
}

/// The twelve edges of a box by its corners, numbered by the signs of the coordinates.
fn edges(corners: &[DVec3; 8]) -> Vec<[DVec3; 2]> {
    (0..8_usize)
        .flat_map(|from| [1, 2, 4].map(|bit| (from, from | bit)))
        .filter(|(from, to)| from != to)
        .map(|(from, to)| [corners[from], corners[to]])
        .collect()
}

/// Distance of two points of the segments p + u·s and r + v·t, `between` = p − r, that are the nearest ones where both lie
/// inside. However near to parallel: an error of s costs only its part across v.
fn of_lines(u: DVec3, v: DVec3, between: DVec3) -> f64 {
    let cross = u.cross(v);
    let squared = cross.length_squared();
    if squared == 0.0 {
        return f64::INFINITY;
    }
    let s = (v.cross(between).dot(cross) / squared).clamp(0.0, 1.0);
    let from = between + u * s;
    let t = (from.dot(v) / v.length_squared()).clamp(0.0, 1.0);
    (from - v * t).length()
}

/// Everything the answer promises.
fn check(case: &Case, found: &ClosestPoints) {
    let tolerance = TOLERANCE * case.extent();
    let truth = case.truth();
    let error = found.separation - truth;
    assert!(error.abs() <= tolerance, "{truth:e} {found:?} {case:?}");
    assert!(
        (found.normal.length() - 1.0).abs() < 1e-14,
        "{found:?} {case:?}"
    );
    let gap = case.gap(found.normal);
    assert!(
        (gap - found.separation).abs() <= tolerance,
        "{gap:e} {found:?} {case:?}"
    );
    let span = found.witness_b - found.witness_a;
    let oblique = span - found.normal * found.separation;
    assert!(oblique.length() <= tolerance, "{found:?} {case:?}");
    let in_b = case.a_from_b.inverse_transform_point(found.witness_b);
    for (cuboid, point) in [(&case.a, found.witness_a), (&case.b, in_b)] {
        let outside = (point.abs() - cuboid.half).max_element();
        assert!(outside.abs() <= tolerance, "{outside:e} {found:?} {case:?}");
    }
}

/// The answer from scratch, in both roles, after itself, from the cache of another pair, and on the plane of contact.
fn check_all(case: &Case, foreign: &mut SimplexCache) {
    let Case { a, b, a_from_b } = case;
    let mut cache = SimplexCache::default();
    let found = closest_points(a, b, a_from_b, &mut cache);
    check(case, &found);
    check(case, &closest_points(a, b, a_from_b, &mut cache));
    check(case, &closest_points(a, b, a_from_b, foreign));
    let swapped = Case {
        a: *b,
        b: *a,
        a_from_b: a_from_b.inverse(),
    };
    let back = closest_points(b, a, &swapped.a_from_b, &mut SimplexCache::default());
    check(&swapped, &back);
    // Within rounding of touching either answer is right.
    if found.separation.abs() > TOLERANCE * case.extent() {
        for mut cache in [SimplexCache::default(), cache] {
            let apart = distance(a, b, a_from_b, &mut cache).is_some();
            assert_eq!(apart, found.separation > 0.0, "{found:?} {case:?}");
            let meet = overlap(a, b, a_from_b, &mut cache);
            assert_eq!(meet, found.separation <= 0.0, "{found:?} {case:?}");
        }
    }
    let touching = Case {
        a_from_b: Pose::new(
            a_from_b.rotation,
            a_from_b.translation - found.normal * found.separation,
        ),
        ..*case
    };
    let touch = closest_points(a, b, &touching.a_from_b, &mut cache);
    assert!(
        touch.separation.abs() <= TOLERANCE * case.extent(),
        "{found:?} {case:?}"
    );
}

fn vector(random: &mut ChaCha8Rng) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| random.random_range(-1.0..1.0)))
}

/// Boxes, needles, plates, and those without thickness, length or any extent.
fn cuboid(random: &mut ChaCha8Rng) -> Cuboid {
    let half = vector(random).abs() + 0.05;
    let scales = match random.random_range(0..8) {
        0 => DVec3::new(1.0, 1e-3, 1e-3),
        1 => DVec3::new(1.0, 1.0, 1e-3),
        2 => DVec3::new(1.0, 1.0, 0.0),
        3 => DVec3::new(1.0, 0.0, 0.0),
        4 if random.random_bool(0.2) => DVec3::ZERO,
        5 => DVec3::splat(10_f64.powi(random.random_range(-4..4))),
        _ => DVec3::ONE,
    };
    // Sides as long as those of the other one meet flush.
    let rounded = if random.random_bool(0.3) {
        (half * 2.0).ceil() * 0.5
    } else {
        half
    };
    Cuboid {
        half: rounded * scales,
    }
}

fn turn(random: &mut ChaCha8Rng) -> DQuat {
    let quarter = DQuat::from_axis_angle(
        DVec3::AXES[random.random_range(0..3)],
        f64::from(random.random_range(0..4)) * std::f64::consts::FRAC_PI_2,
    );
    let axis = if random.random_bool(0.5) {
        DVec3::AXES[random.random_range(0..3)]
    } else {
        vector(random)
    };
    let hair = || 10_f64.powf(-16.0);
    match random.random_range(0..6) {
        0 => DQuat::IDENTITY,
        1 => quarter,
        2 => DQuat::from_scaled_axis(axis * random.random_range(-3.0..3.0)),
        3 => quarter * DQuat::from_scaled_axis(axis * (hair() * random.random_range(0.1..30.0))),
        4 => {
            quarter * DQuat::from_scaled_axis(axis * 10_f64.powf(random.random_range(-17.0..-2.0)))
        }
        _ => DQuat::from_scaled_axis(vector(random) * 3.0),
    }
    .normalize()
}

/// From coincident to far apart, on a grid of halves, in contact to rounding, or anywhere.
fn case(random: &mut ChaCha8Rng) -> Case {
    let (a, b, rotation) = (cuboid(random), cuboid(random), turn(random));
    let b = if random.random_bool(0.2) { a } else { b };
    let reach = a.half.max_element().max(b.half.max_element());
    let halves = |v: DVec3| (v * 4.0).round() * 0.5;
    let offset = match random.random_range(0..6) {
        0 => DVec3::ZERO,
        1 => halves(vector(random)),
        2 => vector(random) * reach * 1e4,
        3 => vector(random) * reach * 3.0,
        _ => vector(random) * reach,
    };
    let mut case = Case {
        a,
        b,
        a_from_b: Pose::new(rotation, offset),
    };
    if random.random_bool(0.5) {
        let found = closest_points(&a, &b, &case.a_from_b, &mut SimplexCache::default());
        let gap = match random.random_range(0..3) {
            0 => 0.0,
            1 => random.random_range(-0.01..0.01) * reach,
            _ => reach * 10_f64.powf(random.random_range(-17.0..-3.0)),
        };
        case.a_from_b.translation += found.normal * (gap - found.separation);
    }
    let scale = 10_f64.powi(random.random_range(-6..=4));
    Case {
        a: Cuboid {
            half: a.half * scale,
        },
        b: Cuboid {
            half: b.half * scale,
        },
        a_from_b: Pose::new(rotation, case.a_from_b.translation * scale),
    }
}

#[test]
fn boxes_of_all_kinds_agree_with_brute_force() {
    let mut random = ChaCha8Rng::seed_from_u64(15);
    let mut foreign = SimplexCache::default();
    for _ in 0..30_000 {
        check_all(&case(&mut random), &mut foreign);
    }
}

/// A box that counts how often the search asks for a support point, which the closed form never does.
struct Counted<'c> {
    cuboid: Cuboid,
    calls: &'c Cell<u32>,
}

impl SupportMap for Counted<'_> {
    fn support(&self, direction: DVec3, start: u32) -> SupportPoint {
        self.calls.set(self.calls.get() + 1);
        self.cuboid.support(direction, start)
    }

    fn vertex(&self, index: u32) -> DVec3 {
        self.cuboid.vertex(index)
    }

    fn interior_point(&self) -> DVec3 {
        DVec3::ZERO
    }

    fn core_box(&self) -> Option<DVec3> {
        self.cuboid.core_box()
    }
}

#[test]
fn the_search_is_left_to_cases_that_rounding_decides() {
    let mut random = ChaCha8Rng::seed_from_u64(16);
    let calls = Cell::new(0);
    let mut searched = [0, 0];
    for _ in 0..30_000 {
        let case = case(&mut random);
        let [a, b] = [case.a, case.b].map(|cuboid| Counted {
            cuboid,
            calls: &calls,
        });
        let found = closest_points(&a, &b, &case.a_from_b, &mut SimplexCache::default());
        if calls.take() > 0 {
            searched[usize::from(found.separation > 0.0)] += 1;
        }
    }
    let [deep, apart] = searched;
    assert!(deep <= 30 && apart <= 300, "{searched:?}");
}

#[test]
fn a_slide_is_answered_alike_warm_and_cold() {
    let mut random = ChaCha8Rng::seed_from_u64(17);
    let mut cache = SimplexCache::default();
    for _ in 0..300 {
        let mut case = case(&mut random);
        let size = case.a.half.max_element() + case.b.half.max_element();
        let (heading, spin) = (vector(&mut random), vector(&mut random));
        for _ in 0..50 {
            case.a_from_b.translation += heading * (0.02 * size);
            let turned = DQuat::from_scaled_axis(spin * 0.02) * case.a_from_b.rotation;
            case.a_from_b.rotation = turned.normalize();
            let found = closest_points(&case.a, &case.b, &case.a_from_b, &mut cache);
            check(&case, &found);
        }
    }
}

#[test]
fn rounding_adds_to_the_gap_along_the_normal() {
    let mut random = ChaCha8Rng::seed_from_u64(18);
    for _ in 0..3_000 {
        let case = case(&mut random);
        let [radius_a, radius_b] =
            [(); 2].map(|()| case.a.half.max_element() * random.random_range(0.0..0.3));
        let (a, b) = (
            Rounded {
                core: case.a,
                radius: radius_a,
            },
            Rounded {
                core: case.b,
                radius: radius_b,
            },
        );
        let mut cache = SimplexCache::default();
        let cores = closest_points(&case.a, &case.b, &case.a_from_b, &mut cache);
        let found = closest_points(&a, &b, &case.a_from_b, &mut SimplexCache::default());
        let tolerance = TOLERANCE * case.extent();
        let expected = cores.separation - (radius_a + radius_b);
        assert!((found.separation - expected).abs() <= tolerance);
        let core_a = found.witness_a - found.normal * radius_a;
        let core_b = found.witness_b + found.normal * radius_b;
        let of_cores = ClosestPoints {
            witness_a: core_a,
            witness_b: core_b,
            separation: found.separation + (radius_a + radius_b),
            ..found
        };
        check(&case, &of_cores);
        if found.separation.abs() <= tolerance {
            continue;
        }
        let meet = overlap(&a, &b, &case.a_from_b, &mut cache);
        assert_eq!(meet, found.separation <= 0.0, "{found:?} {case:?}");
        let apart = distance(&a, &b, &case.a_from_b, &mut cache).is_some();
        assert_eq!(apart, found.separation > 0.0, "{found:?} {case:?}");
    }
}

#[test]
fn flush_faces_touch_in_the_middle_of_what_they_share() {
    let a = Cuboid { half: DVec3::ONE };
    let b = Cuboid {
        half: DVec3::new(1.0, 0.5, 0.5),
    };
    let pose = Pose::from_translation(DVec3::new(1.9, 0.75, 0.0));
    let found = closest_points(&a, &b, &pose, &mut SimplexCache::default());
    assert!((found.separation + 0.1).abs() < 1e-15, "{found:?}");
    assert!((found.normal - DVec3::X).length() < 1e-15, "{found:?}");
    let middle = DVec3::new(1.0, 0.5, 0.0);
    assert!((found.witness_a - middle).length() < 1e-15, "{found:?}");
}

#[test]
fn numbers_that_are_none_end() {
    let cuboid = Cuboid { half: DVec3::ONE };
    let wild = [f64::NAN, f64::INFINITY, -1.0, 1e300, 1e-300];
    for value in wild {
        let strange = Cuboid {
            half: DVec3::new(1.0, value, 1.0),
        };
        let poses = [
            Pose::from_translation(DVec3::splat(value)),
            Pose::new(
                DQuat::from_xyzw(value, 0.0, 0.0, 1.0),
                DVec3::new(0.5, 0.2, 0.1),
            ),
        ];
        for pose in poses {
            let mut cache = SimplexCache::default();
            closest_points(&cuboid, &strange, &pose, &mut cache);
            closest_points(&strange, &cuboid, &pose, &mut cache);
            distance(&strange, &strange, &pose, &mut cache);
            overlap(&cuboid, &cuboid, &pose, &mut cache);
        }
    }
}
