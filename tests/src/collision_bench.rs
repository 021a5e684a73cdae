//! The collision crate against `parry3d-f64` in one process: same shapes, same placements, same clock.

pub mod clock;
pub mod duel;
pub mod mesh;
pub mod placements;
pub mod report;
pub mod rows;
