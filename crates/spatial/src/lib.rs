//! Rigid placements, velocities and loads in three dimensions: `f64`, SI units, right-handed frames.
//!
//! Transforms are named `a_from_b`: `a_from_b.transform_point(p_in_b)` is the point in frame `a`, and
//! `a_from_b * b_from_c` is `a_from_c`.

mod pose;
mod wrench;

pub use pose::{Pose, quaternion_from_rotation_vector, rotation_vector};
pub use wrench::{Twist, Wrench};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;
