//! A tool that is created inside obstacles.

use glam::DVec3;
use pliant_collision::{SimplexCache, closest_points};
use pliant_spatial::Pose;

use super::cell::{Bodies, Cell, SKIN};
use crate::qp::nearest_point;

/// How the tool stood when its planes were set up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Start {
    /// Free of every obstacle.
    Free,
    /// It overlapped and has been moved out.
    MovedOut,
    /// It overlaps, and the exits of several obstacles exclude each other.
    Inside,
}

/// Sets up the planes at `pose` and moves the tool out of overlap.
///
/// Every segment of one obstacle gets the same exit normal, the one with the shallowest exit over *all* segments (contact.11):
/// penetration normals of single segments contradict each other.
pub(crate) fn separate(cell: &mut Cell, bodies: Bodies<'_>, pose: Pose) -> Start {
    cell.pose = pose;
    let mut overlapping = false;
    for obstacle in 0..bodies.obstacles.len() {
        overlapping |= set_exit_normals(cell, bodies, obstacle);
    }
    if !overlapping {
        return Start::Free;
    }
    match nearest_point(cell.planes(), pose.translation) {
        Some((position, _)) => {
            cell.pose.translation = position;
            Start::MovedOut
        }
        None => Start::Inside,
    }
}

/// Normals of one obstacle's pairs at the present pose; whether any pair is closer than half the skin.
fn set_exit_normals(cell: &mut Cell, bodies: Bodies<'_>, obstacle: usize) -> bool {
    let body = &bodies.obstacles[obstacle];
    let object_from_visual = body.world_from_object.inverse() * cell.pose;
    let mut shallowest = f64::INFINITY;
    let mut exit = DVec3::Z;
    let mut overlapping = false;
    for pair in cell.group(obstacle) {
        let segment = &bodies.segments[cell.segment_of(pair)];
        let mut cache = SimplexCache::default();
        let closest = closest_points(&body.shape, segment, &object_from_visual, &mut cache);
        let normal = body.world_from_object.transform_vector(closest.normal);
        cell.set_normal(bodies, pair, normal.normalize_or(DVec3::Z));
        if closest.separation >= 0.5 * SKIN {
            continue;
        }
        overlapping = true;
        let smallest = cell
            .group(obstacle)
            .map(|other| cell.gap_along(bodies, other, pair))
            .fold(f64::INFINITY, f64::min);
        if -smallest < shallowest {
            shallowest = -smallest;
            exit = cell.pairs[pair].normal;
        }
    }
    if overlapping {
        for pair in cell.group(obstacle) {
            cell.set_normal(bodies, pair, exit);
        }
    }
    overlapping
}
