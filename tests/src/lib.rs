//! Campaigns, judges and motions shared by the tests that span crates.

pub mod beam;
pub mod bodies;
pub mod campaign;
pub mod collision;
pub mod collision_bench;
pub mod hand;
pub mod judge;
pub mod motion;
pub mod parry;
pub mod skip;
