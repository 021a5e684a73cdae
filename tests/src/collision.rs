//! The judges of the collision crate: reference files, and random campaigns against an exhaustive oracle.
//!
//! The oracle shares no code with GJK and EPA: it enumerates faces, edges and vertices, or, of cylinders and cones, searches
//! over directions. What it says is proved per answer from both sides wherever shapes are apart, by a pair of points and by a
//! pair of planes.

pub mod answer;
pub mod campaign;
pub mod core;
pub mod exact;
pub mod families;
pub mod kinds;
pub mod oracle;
pub mod placement;
pub mod reference;
pub mod round;
pub mod search;
pub mod shape;
pub mod snippet;
pub mod truth;
pub mod verdict;
