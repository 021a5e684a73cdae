//! Random pairs by family: every way in which collision libraries are known to fail.

use std::sync::Arc;

use glam::{DQuat, DVec3};
use pliant_spatial::Pose;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::kinds::{Copies, Form, Kind, unit};
use super::placement::Placement;
use super::shape::Shape;

/// A way of making pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Family {
    /// Gaps of 1e-12 to 1 of the size.
    Apart,
    /// Depths of 1e-12 to 0.5 of the size.
    Penetrating,
    /// A vertex on a vertex.
    VertexOnVertex,
    /// Two faces parallel, touching or nearly so, apart or not.
    FacesParallel,
    /// Two edges parallel.
    EdgesParallel,
    /// Both flat and in one plane.
    Coplanar,
    /// Quarter turns, sides flush.
    AxisAligned,
    /// The same shape twice, at the same place or nearly so.
    Identical,
    /// Centres at the same point.
    Concentric,
    /// One small inside the other.
    Inside,
    /// Faces or edges parallel but for 1e-15 to 1e-6 rad.
    NearlyParallel,
    /// Thin plates tilted by 1e-16 to 1e-14 rad, touching.
    TiltedPlates,
    /// A thousand times longer than wide.
    Needles,
    /// A thousand times wider than thick.
    Plates,
    /// 1e4 : 1.
    HugeAndTiny,
    /// 1e-6 m.
    Micrometre,
    /// 1e4 m.
    TenKilometres,
    /// 1e4 sizes from the frames' origins.
    FarFromOrigin,
    /// Without volume.
    Flat,
    /// Every vertex twice.
    Doubled,
}

/// Two shapes at a placement.
#[derive(Clone, Debug)]
pub struct Pair {
    /// A and B.
    pub shapes: [Arc<Shape>; 2],
    /// Placement of B in A's frame.
    pub a_from_b: Pose,
    /// Of the smaller shape, or of the other where that is a point [m].
    pub size: f64,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 20] = [
        Self::Apart,
        Self::Penetrating,
        Self::VertexOnVertex,
        Self::FacesParallel,
        Self::EdgesParallel,
        Self::Coplanar,
        Self::AxisAligned,
        Self::Identical,
        Self::Concentric,
        Self::Inside,
        Self::NearlyParallel,
        Self::TiltedPlates,
        Self::Needles,
        Self::Plates,
        Self::HugeAndTiny,
        Self::Micrometre,
        Self::TenKilometres,
        Self::FarFromOrigin,
        Self::Flat,
        Self::Doubled,
    ];

    /// A pair of this family, the same for the same seed.
    pub fn pair(self, kinds: [Kind; 2], seed: u64) -> Pair {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let forms = self.forms(&mut random);
        let first = match self {
            Self::Identical => kinds[random.random_range(0..2)],
            _ => kinds[0],
        };
        let a = first.shape(&forms[0], &mut random);
        let b = match self {
            Self::Identical => a.clone(),
            _ => kinds[1].shape(&forms[1], &mut random),
        };
        let sizes = [a.size(), b.size()];
        let smaller = sizes.into_iter().filter(|&size| size > 0.0);
        let size = smaller.fold(f64::INFINITY, f64::min);
        // Two points have no size; what they are scaled by stands for it.
        let size = if size.is_finite() {
            size
        } else {
            forms[0].scale.min(forms[1].scale)
        };
        let mut placement = Placement {
            a: &a,
            b: &b,
            size,
            random: &mut random,
        };
        let a_from_b = self.place(&mut placement);
        Pair {
            shapes: [a, b],
            a_from_b,
            size,
        }
    }

    fn forms(self, random: &mut ChaCha8Rng) -> [Form; 2] {
        let thin = DVec3::new(1e-3, 1e-3, 1.0);
        let mut either = |form: Form, other: Form| match random.random_range(0..3) {
            0 => [form, other],
            1 => [other, form],
            _ => [form, form],
        };
        let plain = Form::PLAIN;
        match self {
            Self::Needles => either(Form::stretched(thin), plain),
            Self::Plates => either(Form::stretched(DVec3::new(1.0, 1.0, 1e-3)), plain),
            Self::Flat => either(Form::stretched(DVec3::new(1.0, 1.0, 0.0)), plain),
            Self::Coplanar => [Form::stretched(DVec3::new(1.0, 1.0, 0.0)); 2],
            Self::TiltedPlates => {
                let mut plate = || Form::stretched(DVec3::new(1.0, 1.0, power(random, -6.0, -2.0)));
                [plate(), plate()]
            }
            Self::Micrometre => [Form::scaled(1e-6); 2],
            Self::TenKilometres => [Form::scaled(1e4); 2],
            Self::HugeAndTiny => {
                let mut forms = [Form::scaled(1e4), plain];
                if random.random() {
                    forms.reverse();
                }
                forms
            }
            Self::Inside => {
                let mut forms = [plain, Form::scaled(power(random, -3.0, -1.0))];
                if random.random() {
                    forms.reverse();
                }
                forms
            }
            Self::FarFromOrigin => {
                let mut far = || Form {
                    offset: unit(random) * 1e4,
                    ..plain
                };
                [far(), far()]
            }
            Self::Doubled => either(
                Form {
                    copies: Copies::Two,
                    ..plain
                },
                plain,
            ),
            _ => [plain; 2],
        }
    }

    fn place(self, placement: &mut Placement<'_>) -> Pose {
        match self {
            Self::Apart => placement.apart(),
            Self::Penetrating => placement.penetrating(),
            Self::VertexOnVertex => placement.vertex_on_vertex(),
            Self::FacesParallel => placement.parallel_faces(0.0),
            Self::EdgesParallel => placement.parallel_edges(0.0),
            Self::Coplanar => placement.in_one_plane(),
            Self::AxisAligned => placement.along_axes(),
            Self::Identical => placement.almost_same_place(),
            Self::Concentric => placement.concentric(),
            Self::Inside => placement.inside(),
            Self::NearlyParallel => {
                let tilt = power(placement.random, -15.0, -6.0);
                if placement.random.random() {
                    placement.parallel_faces(tilt)
                } else {
                    placement.parallel_edges(tilt)
                }
            }
            Self::TiltedPlates => {
                let tilt = power(placement.random, -16.0, -14.0);
                placement.stacked(tilt)
            }
            _ => match placement.random.random_range(0..8) {
                0 | 1 => placement.apart(),
                2 | 3 => placement.penetrating(),
                4 => placement.vertex_on_vertex(),
                5 => placement.parallel_faces(0.0),
                6 => placement.along_axes(),
                _ => placement.concentric(),
            },
        }
    }
}

/// 10 to a power between the two.
pub fn power(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    10f64.powf(random.random_range(low..high))
}

/// A turn about a random axis, all equally likely enough.
pub fn rotation(random: &mut ChaCha8Rng) -> DQuat {
    DQuat::from_axis_angle(unit(random), random.random_range(0.0..std::f64::consts::PI))
}

/// Twenty small steps from a placement.
pub fn walk(start: &Pose, size: f64, centre_in_b: DVec3, random: &mut ChaCha8Rng) -> Vec<Pose> {
    let mut pose = *start;
    (0..20)
        .map(|_| {
            let turn = unit(random) * random.random_range(1e-3..1e-2);
            let step = unit(random) * (size * random.random_range(1e-4..5e-3));
            let rotation = (DQuat::from_scaled_axis(turn) * pose.rotation).normalize();
            let centre = pose.transform_point(centre_in_b) + step;
            pose = Pose::new(rotation, centre - rotation * centre_in_b);
            pose
        })
        .collect()
}
