//! One pair of shapes for both libraries, and their times on the same placements.

use glam::DVec3;
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::{ConvexPolyhedron, SupportMap as ParrySupportMap};
use pliant_collision::{SimplexCache, SupportMap, closest_points};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;
use rand_chacha::ChaCha8Rng;

use super::clock::Clock;
use super::placements::{Pair, State, reach, size};

/// How the next query relates to the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Not at all.
    Cold,
    /// By a small step.
    Coherent,
}

/// A pair as each library takes it.
pub struct Duel<'s, A, B, P, Q> {
    /// A and B for this project's crate.
    pub own: (&'s A, &'s B),
    /// The same for the other library, where it takes part.
    pub parry: Option<(&'s P, &'s Q)>,
}

/// Single times of both [ns].
#[derive(Default)]
pub struct Sample {
    /// Of this project's crate.
    pub own: Vec<u64>,
    /// Of the other library.
    pub parry: Vec<u64>,
}

impl Sample {
    fn add(&mut self, other: Self) {
        self.own.extend(other.own);
        self.parry.extend(other.parry);
    }
}

impl<A, B, P, Q> Duel<'_, A, B, P, Q>
where
    A: SupportMap,
    B: SupportMap,
    P: ParrySupportMap,
    Q: ParrySupportMap,
{
    /// Times of `count` random placements, or of as many sequences.
    pub fn run(&self, state: State, mode: Mode, count: usize, random: &mut ChaCha8Rng) -> Sample {
        let (a, b) = self.own;
        let pair = Pair {
            a,
            b,
            size: size(a).min(size(b)),
            reach: 2.0 * (reach(a) + reach(b)),
        };
        let clock = Clock::new();
        match mode {
            Mode::Cold => {
                let poses: Vec<Pose> = (0..count).map(|_| pair.random(state, random)).collect();
                self.cold(&poses, &clock)
            }
            Mode::Coherent => {
                let mut sample = Sample::default();
                for _ in 0..count {
                    sample.add(self.coherent(&pair.sequence(state, random), &clock));
                }
                sample
            }
        }
    }

    fn cold(&self, poses: &[Pose], clock: &Clock) -> Sample {
        let (a, b) = self.own;
        let own = clock.times(
            poses.len(),
            || (),
            |(), i| closest_points(a, b, &poses[i], &mut SimplexCache::default()),
        );
        let parry = self.parry.map_or_else(Vec::new, |(p, q)| {
            let poses: Vec<ParryPose> = poses.iter().map(parry_pose).collect();
            clock.times(
                poses.len(),
                || (),
                |(), i| contact(&poses[i], p, q, &mut VoronoiSimplex::new(), None),
            )
        });
        Sample { own, parry }
    }

    /// The first step of a sequence has nothing to start from and is left out.
    fn coherent(&self, poses: &[Pose], clock: &Clock) -> Sample {
        let (a, b) = self.own;
        let own = clock.times(poses.len(), SimplexCache::default, |cache, i| {
            closest_points(a, b, &poses[i], cache)
        });
        let parry = self.parry.map_or_else(Vec::new, |(p, q)| {
            let poses: Vec<ParryPose> = poses.iter().map(parry_pose).collect();
            let start = || (VoronoiSimplex::new(), None);
            clock.times(poses.len(), start, |(simplex, direction), i| {
                let found = contact(&poses[i], p, q, simplex, *direction);
                if let GJKResult::ClosestPoints(_, _, normal) = found {
                    *direction = Some(normal);
                }
            })
        });
        Sample {
            own: own.into_iter().skip(1).collect(),
            parry: parry.into_iter().skip(1).collect(),
        }
    }
}

fn contact<P: ParrySupportMap, Q: ParrySupportMap>(
    pose: &ParryPose,
    p: &P,
    q: &Q,
    simplex: &mut VoronoiSimplex,
    direction: Option<Vector>,
) -> GJKResult {
    contact_support_map_support_map_with_params(pose, p, q, 1e3, simplex, direction)
}

/// A vector as the other library takes it.
pub fn parry_vector(v: DVec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

/// A placement as the other library takes it.
pub fn parry_pose(pose: &Pose) -> ParryPose {
    let q = pose.rotation;
    ParryPose::from_parts(
        parry_vector(pose.translation),
        Rotation::from_xyzw(q.x, q.y, q.z, q.w),
    )
}

/// A mesh as the other library takes it.
///
/// # Panics
/// When the other library refuses it.
pub fn parry_mesh(mesh: &ConvexMesh) -> ConvexPolyhedron {
    let points: Vec<Vector> = mesh.positions().iter().copied().map(parry_vector).collect();
    ConvexPolyhedron::from_convex_hull(&points).expect("a convex mesh has a hull")
}
