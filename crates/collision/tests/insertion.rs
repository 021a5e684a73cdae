//! Cylinders and cones that move a little from query to query, deep in each other: the remembered answer is the cold one, and
//! among directions equally deep the normal stays.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DQuat, DVec3};
use pliant_collision::{
    ClosestPoints, Cone, Cuboid, Cylinder, PointSet, Rounded, SimplexCache, SupportMap,
    closest_points,
};
use pliant_spatial::Pose;

const PEG: Cylinder = Cylinder {
    half_length: 0.5,
    radius: 0.3,
};

const BLOCK: Cylinder = Cylinder {
    half_length: 0.6,
    radius: 0.45,
};

/// Of a tick in an insertion along z.
fn inserted(tick: u32) -> DVec3 {
    DVec3::Z * (1.15 - 1.1 * f64::from(tick) / 2000.0)
}

fn is_radial(found: &ClosestPoints) -> bool {
    found.normal.z.abs() < 0.1
}

#[test]
fn the_normal_of_an_exactly_coaxial_insertion_stays() {
    for (a, b) in [(PEG, BLOCK), (BLOCK, PEG), (PEG, PEG)] {
        let mut cache = SimplexCache::default();
        let mut last: Option<ClosestPoints> = None;
        let (mut turns, mut radial) = (0, 0);
        for tick in 0..2000 {
            let pose = Pose::from_translation(inserted(tick));
            let found = closest_points(&a, &b, &pose, &mut cache);
            let depth = (a.half_length + b.half_length - inserted(tick).z).min(a.radius + b.radius);
            if inserted(tick).z < a.half_length + b.half_length {
                assert!((found.separation + depth).abs() < 1e-12, "{tick} {found:?}");
            }
            let turn = last.map_or(0.0, |last| (last.normal - found.normal).length());
            turns += u32::from(turn > 1e-9);
            radial += u32::from(is_radial(&found));
            last = Some(found);
        }
        // From the disc to the side, where that becomes shallower.
        assert!(turns <= 1 && radial > 300, "{turns} {radial}");
    }
}

/// A hand's drift: the side exit is where the axes are furthest apart, and turns as the offset does.
#[test]
fn the_normal_of_a_smooth_insertion_turns_with_the_offset() {
    let mut cache = SimplexCache::default();
    let mut last: Option<(ClosestPoints, f64)> = None;
    let mut radial = 0;
    for tick in 1000..3000 {
        let time = f64::from(tick) / 1000.0;
        let angle = 3.0 * time + 0.5 * (7.0 * time).sin();
        let eccentric = 2e-4 * (1.2 + (5.0 * time).sin());
        let aside = DVec3::new(angle.cos(), angle.sin(), 0.0) * eccentric;
        let pose = Pose::from_translation(inserted(tick - 1000) + aside);
        let found = closest_points(&PEG, &BLOCK, &pose, &mut cache);
        if let Some((before, angle_before)) = last
            && is_radial(&before)
            && is_radial(&found)
        {
            let turn = (before.normal - found.normal).length();
            assert!(turn <= (angle - angle_before).abs() + 1e-9, "{tick} {turn}");
            assert!((found.separation + 0.75 - eccentric).abs() < 1e-12);
            radial += 1;
        }
        last = Some((found, angle));
    }
    assert!(radial > 300, "{radial}");
}

/// Deterministic numbers (Knuth's multiplier).
struct Random(u64);

impl Random {
    /// In [0, 1).
    fn number(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(self.0 >> 32).expect("32 bits")) / 4_294_967_296.0
    }

    fn below(&mut self, count: u32) -> u32 {
        (0..count)
            .rev()
            .find(|&k| self.number() * f64::from(k + 1) < 1.0)
            .unwrap_or(0)
    }

    fn vector(&mut self) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| 2.0 * self.number() - 1.0))
    }

    /// Nothing, something, or any power of ten down to rounding.
    fn amount(&mut self) -> f64 {
        match self.below(5) {
            0 => 0.0,
            1 => self.number(),
            _ => 10_f64.powf(-10.0 * self.number()),
        }
    }

    fn length(&mut self) -> f64 {
        0.1 + 0.5 * self.number()
    }

    fn shape(&mut self, kinds: u32) -> Box<dyn SupportMap> {
        let radius = if self.below(2) == 0 {
            0.0
        } else {
            0.3 * self.number()
        };
        match self.below(kinds) {
            0 => Box::new(Rounded {
                core: Cylinder {
                    half_length: self.length(),
                    radius: self.length(),
                },
                radius,
            }),
            1 => Box::new(Rounded {
                core: Cone {
                    half_length: self.length(),
                    base_radius: self.length(),
                    top_radius: self.length() * f64::from(self.below(2)),
                },
                radius,
            }),
            2 => Box::new(Rounded {
                core: Cuboid {
                    half: DVec3::new(self.length(), self.length(), self.length()),
                },
                radius,
            }),
            _ => Box::new(Rounded {
                core: PointSet(&PRISM),
                radius,
            }),
        }
    }
}

/// Six corners at each end.
const PRISM: [DVec3; 12] = {
    let mut corners = [DVec3::ZERO; 12];
    let ring = [
        (0.4, 0.0),
        (0.2, 0.35),
        (-0.2, 0.35),
        (-0.4, 0.0),
        (-0.2, -0.35),
        (0.2, -0.35),
    ];
    let mut k = 0;
    while k < 12 {
        let (x, y) = ring[k % 6];
        corners[k] = DVec3::new(x, y, if k < 6 { -0.5 } else { 0.5 });
        k += 1;
    }
    corners
};

/// Near-coaxial, crossed and free placements, steps from nothing to 2 % of the size; tilts of 1e-8 are among them.
#[test]
fn warm_answers_are_the_cold_ones() {
    let mut random = Random(99);
    let mut deep = 0;
    for pair in 0..1200 {
        let (a, b) = (random.shape(2), random.shape(4));
        let (a, b) = if pair % 2 == 0 {
            (&*a, &*b)
        } else {
            (&*b, &*a)
        };
        let mut rotation = DQuat::from_scaled_axis(random.vector() * random.amount());
        if random.below(4) == 0 {
            rotation *= DQuat::from_rotation_x(FRAC_PI_2);
        }
        let aside = random.vector() * (0.5 * random.amount());
        let along = DVec3::Z * (1.6 * random.number() * f64::from(random.below(3).min(1)));
        let mut pose = Pose::new(rotation, aside + along);
        let step = random.vector() * (0.02 * random.amount());
        let turn = DQuat::from_scaled_axis(random.vector() * (0.02 * random.amount()));
        let mut cache = SimplexCache::default();
        for tick in 0..6 {
            let warm = closest_points(a, b, &pose, &mut cache);
            let cold = closest_points(a, b, &pose, &mut SimplexCache::default());
            let apart = (warm.separation - cold.separation).abs();
            assert!(apart < 1e-9, "{pair} {tick} {pose:?} {warm:?} {cold:?}");
            assert!(warm.doubt() < 1e-9, "{pair} {tick} {pose:?} {warm:?}");
            deep += u32::from(warm.separation < -0.05);
            pose = Pose::new((turn * pose.rotation).normalize(), pose.translation + step);
        }
    }
    assert!(deep > 2000, "{deep}");
}

/// Of two opposite ways out that change places the shallower one is taken, however little it is.
#[test]
fn an_opposite_exit_is_taken_when_it_becomes_shallower() {
    let disc = Rounded {
        core: Cylinder {
            half_length: 0.067,
            radius: 0.215,
        },
        radius: 0.3,
    };
    let roller = Cylinder {
        half_length: 0.49,
        radius: 0.27,
    };
    let mut cache = SimplexCache::default();
    for tick in 0..200 {
        let height = 1e-6 * (TAU * f64::from(tick) / 20.0).sin();
        let pose = Pose::new(DQuat::from_rotation_x(FRAC_PI_2), DVec3::Z * height);
        let found = closest_points(&disc, &roller, &pose, &mut cache);
        let depth = 0.067 + 0.27 + 0.3 - height.abs();
        assert!((found.separation + depth).abs() < 1e-10, "{tick} {found:?}");
    }
}

/// A plate that slides and tilts over another, as a random walk found it.
fn over_a_plate() -> [Pose; 4] {
    [
        Pose::new(
            DQuat::from_xyzw(
                -4.559_653_119_421_149e-17,
                8.786_949_509_405_769e-17,
                -6.221_433_970_290_018e-17,
                1.0,
            ),
            DVec3::new(
                -0.009_011_106_404_065_845,
                0.089_145_403_648_581_99,
                8.689_289_970_614_94e-06,
            ),
        ),
        Pose::new(
            DQuat::from_xyzw(
                -0.002_009_682_059_286_826_4,
                0.002_669_280_946_824_432_7,
                0.001_358_921_246_293_134_7,
                0.999_993_494_703_987_5,
            ),
            DVec3::new(
                -0.008_405_553_136_814_403,
                0.088_471_596_554_381_29,
                0.001_042_533_195_218_815_7,
            ),
        ),
        Pose::new(
            DQuat::from_xyzw(
                -0.000_884_277_190_055_904_2,
                0.003_786_121_468_302_735,
                -0.000_137_679_550_048_238_9,
                0.999_992_432_162_574,
            ),
            DVec3::new(
                -0.006_993_407_198_756_824,
                0.088_409_026_403_178_15,
                0.001_169_452_490_908_771_2,
            ),
        ),
        Pose::new(
            DQuat::from_xyzw(
                -0.001_798_616_992_954_372_9,
                0.003_245_938_217_096_520_7,
                0.002_516_048_253_701_726,
                0.999_989_949_131_084_4,
            ),
            DVec3::new(
                -0.006_400_703_479_824_576_5,
                0.088_820_847_573_772_68,
                2.923_053_590_300_111e-06,
            ),
        ),
    ]
}

/// The base disc of the remembered pair is not the highest point along its axis, which the apex is.
#[test]
fn a_disc_below_the_apex_is_no_way_out() {
    let a = Cone {
        half_length: 8.003_466_664_620_659e-06,
        base_radius: 0.356_840_534_670_823_44,
        top_radius: 0.0,
    };
    let b = Cone {
        half_length: 6.858_233_059_591_805e-07,
        base_radius: 0.177_287_785_164_753_24,
        top_radius: 0.014_938_319_802_307_969,
    };
    let poses = over_a_plate();
    let mut cache = SimplexCache::default();
    for pose in &poses {
        let warm = closest_points(&a, &b, pose, &mut cache);
        let cold = closest_points(&a, &b, pose, &mut SimplexCache::default());
        assert!(
            (warm.separation - cold.separation).abs() < 1e-12,
            "{warm:?} {cold:?}"
        );
        assert!(
            warm.witness_a.z.abs() <= a.half_length * (1.0 + 1e-9),
            "{warm:?}"
        );
    }
}
