//! What an outside observer measures on a state; slower than a tick and not part of it.

use pliant_collision::{SimplexCache, closest_points};

use crate::{State, World};

/// Deepest overlap of the visual tool with any object [m], 0 when it is free: closest-point queries from scratch, independent of
/// the planes the tick keeps.
pub fn visual_penetration(world: &World, state: &State) -> f64 {
    let world_from_visual = state.world_from_visual();
    let mut deepest: f64 = 0.0;
    for obstacle in world.obstacles() {
        let object_from_visual = obstacle.world_from_object.inverse() * world_from_visual;
        for segment in &world.tool().segments {
            let mut cache = SimplexCache::default();
            let closest = closest_points(&obstacle.shape, segment, &object_from_visual, &mut cache);
            deepest = deepest.max(-closest.separation);
        }
    }
    deepest
}
