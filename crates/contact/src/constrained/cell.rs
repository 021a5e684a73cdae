//! The free convex cell around the visual tool: one certified separating plane per (obstacle, segment) pair.
//!
//! For a unit normal n from obstacle O to segment T at orientation R the plane offset is
//! `b = s_O(n) + s_{−RT}(n) + ε` (contact.1) with the support function s; every handle position x with n·x ≥ b keeps that pair
//! apart, whatever supplied n (contact.2).

use glam::{DQuat, DVec3};
use pliant_collision::{SimplexCache, SupportMap, distance};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

use crate::Obstacle;
use crate::qp::{ActiveSet, Plane};
use crate::touching::touching_points;

/// Gap kept between visual tool and obstacle [m]: large against rounding (1e-16 m), small against anything felt. At 1e-9 detection
/// answers get refused; 1e-6 and 1e-8 give the same forces.
pub const SKIN: f64 = 1e-7;
/// A normal is accepted only when two support calls certify this part of the skin.
const ACCEPTED_GAP: f64 = SKIN / 4.0;
/// A pair counts as covered by another's plane down to this much below the leader's gap [m].
const COVERED: f64 = 1e-11;
/// Cosine of half the largest turn (0.05 rad, five times what a fast hand turns in a tick) along which normals may follow the tool.
const SMALL_TURN_COSINE: f64 = 0.999_687_5;

/// Borrowed geometry of one tick.
#[derive(Clone, Copy)]
pub(crate) struct Bodies<'a> {
    pub(crate) obstacles: &'a [Obstacle],
    pub(crate) segments: &'a [ConvexMesh],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    /// Unit, world, obstacle → tool.
    pub(crate) normal: DVec3,
    /// Largest n·p over the obstacle, world [m], and where.
    pub(crate) obstacle_bound: f64,
    pub(crate) obstacle_vertex: u32,
    /// Smallest n·(R t) over the segment [m], and where.
    pub(crate) segment_bound: f64,
    pub(crate) segment_vertex: u32,
    /// Middle between the closest points of the last detection, world [m].
    pub(crate) witness: DVec3,
    cache: SimplexCache,
    /// The pair this normal was adopted from, itself if detected: the one to detect next.
    leader: usize,
    /// Detection round this pair's normal was last decided in.
    round: u64,
}

/// Planes of all pairs, obstacle-major, and the pose they are valid at.
#[derive(Clone, Debug)]
pub(crate) struct Cell {
    pub(crate) pose: Pose,
    pub(crate) pairs: Vec<Pair>,
    segment_count: usize,
    round: u64,
    queue: Vec<usize>,
    planes: Vec<Plane>,
    saved: Vec<Pair>,
    saved_rotation: DQuat,
}

impl Cell {
    pub(crate) fn new(bodies: Bodies<'_>, pose: Pose) -> Self {
        let blank = Pair {
            normal: DVec3::Z,
            obstacle_bound: 0.0,
            obstacle_vertex: 0,
            segment_bound: 0.0,
            segment_vertex: 0,
            witness: DVec3::ZERO,
            cache: SimplexCache::default(),
            leader: 0,
            round: 0,
        };
        let count = bodies.obstacles.len() * bodies.segments.len();
        Self {
            pose,
            pairs: (0..count).map(|leader| Pair { leader, ..blank }).collect(),
            saved: vec![blank; count],
            saved_rotation: pose.rotation,
            segment_count: bodies.segments.len(),
            round: 0,
            queue: Vec::with_capacity(count),
            planes: Vec::with_capacity(count),
        }
    }

    /// The bodies are as many as at creation.
    pub(crate) fn fits(&self, bodies: Bodies<'_>) -> bool {
        bodies.segments.len() == self.segment_count
            && bodies.obstacles.len() * self.segment_count == self.pairs.len()
    }

    /// Keeps a copy of the planes and the orientation.
    pub(crate) fn save(&mut self) {
        self.saved.copy_from_slice(&self.pairs);
        self.saved_rotation = self.pose.rotation;
    }

    /// Exchanges planes and orientation with the kept copy.
    pub(crate) fn swap_saved(&mut self) {
        std::mem::swap(&mut self.saved, &mut self.pairs);
        std::mem::swap(&mut self.saved_rotation, &mut self.pose.rotation);
    }

    pub(crate) fn obstacle_of(&self, pair: usize) -> usize {
        pair / self.segment_count
    }

    pub(crate) fn segment_of(&self, pair: usize) -> usize {
        pair % self.segment_count
    }

    /// Pairs of one obstacle.
    pub(crate) fn group(&self, obstacle: usize) -> std::ops::Range<usize> {
        obstacle * self.segment_count..(obstacle + 1) * self.segment_count
    }

    /// Certified gap of a pair along its own normal [m].
    pub(crate) fn gap(&self, pair: usize) -> f64 {
        let pair = &self.pairs[pair];
        pair.normal.dot(self.pose.translation) + pair.segment_bound - pair.obstacle_bound
    }

    /// Gap of `pair` along the normal of `leader`, both of one obstacle [m].
    pub(crate) fn gap_along(&self, bodies: Bodies<'_>, pair: usize, leader: usize) -> f64 {
        let Pair {
            normal,
            obstacle_bound,
            ..
        } = self.pairs[leader];
        let segment = &bodies.segments[self.segment_of(pair)];
        let start = self.pairs[pair].segment_vertex;
        let (bound, _) = segment_bound(segment, self.pose.rotation, normal, start);
        normal.dot(self.pose.translation) + bound - obstacle_bound
    }

    /// Gives `pair` the unit world normal `n` and its supports.
    pub(crate) fn set_normal(&mut self, bodies: Bodies<'_>, pair: usize, normal: DVec3) {
        let obstacle = &bodies.obstacles[self.obstacle_of(pair)];
        let segment = &bodies.segments[self.segment_of(pair)];
        let entry = &mut self.pairs[pair];
        entry.normal = normal;
        (entry.obstacle_bound, entry.obstacle_vertex) =
            obstacle_bound(obstacle, normal, entry.obstacle_vertex);
        (entry.segment_bound, entry.segment_vertex) =
            segment_bound(segment, self.pose.rotation, normal, entry.segment_vertex);
    }

    /// Support offsets of the segments for a new orientation. Normals are kept; where a kept one would push the tool, the normal turned
    /// with the tool is taken if it leaves the larger gap: under a face of the tool the contact normal is fixed to the tool.
    /// Segments that share a normal decide together, as one segment would.
    pub(crate) fn turn(&mut self, bodies: Bodies<'_>, rotation: DQuat) {
        let turn = rotation * self.pose.rotation.conjugate();
        let is_small = turn.w.abs() > SMALL_TURN_COSINE;
        self.pose.rotation = rotation;
        for index in 0..self.pairs.len() {
            let segment = &bodies.segments[self.segment_of(index)];
            let pair = &mut self.pairs[index];
            (pair.segment_bound, pair.segment_vertex) =
                segment_bound(segment, rotation, pair.normal, pair.segment_vertex);
        }
        if is_small {
            for index in 0..self.pairs.len() {
                self.turn_normal(bodies, index, turn);
            }
        }
    }

    /// Turns the normal of `first` and of all later pairs of its obstacle that share it, if that widens their smallest gap.
    fn turn_normal(&mut self, bodies: Bodies<'_>, first: usize, turn: DQuat) {
        let normal = self.pairs[first].normal;
        let group = self.group(self.obstacle_of(first));
        let shared_before = self.pairs[group.start..first]
            .iter()
            .any(|pair| pair.normal == normal);
        if shared_before {
            return;
        }
        self.queue.clear();
        self.queue.extend(first..group.end);
        self.queue.retain(|&pair| self.pairs[pair].normal == normal);
        let smallest = |cell: &Self| {
            let gaps = cell.queue.iter().map(|&pair| cell.gap(pair));
            gaps.fold(f64::INFINITY, f64::min)
        };
        let kept = smallest(self);
        if kept >= SKIN {
            return;
        }
        let turned = (turn * normal).normalize();
        self.set_normals(bodies, turned);
        if smallest(self) <= kept {
            self.set_normals(bodies, normal);
        }
    }

    /// Gives all queued pairs, of one obstacle, the unit world normal `n` and their supports.
    fn set_normals(&mut self, bodies: Bodies<'_>, normal: DVec3) {
        for slot in 0..self.queue.len() {
            self.set_normal(bodies, self.queue[slot], normal);
        }
    }

    /// The planes n·x ≥ b of all pairs at the present orientation, in pair order.
    pub(crate) fn planes(&mut self) -> &[Plane] {
        self.planes.clear();
        self.planes.extend(self.pairs.iter().map(|pair| Plane {
            normal: pair.normal,
            offset: pair.obstacle_bound - pair.segment_bound + SKIN,
        }));
        &self.planes
    }

    /// Detection for every pair, coverage included.
    pub(crate) fn refresh_all(&mut self, bodies: Bodies<'_>) {
        self.round += 1;
        for obstacle in 0..bodies.obstacles.len() {
            self.queue.clear();
            let group = self.group(obstacle);
            self.queue.extend(group);
            self.refresh_queue(bodies, obstacle);
        }
    }

    /// Detection for the pairs that hold the tool and for those their planes do not cover; returns the largest change of a holding
    /// normal (chord length between unit vectors).
    ///
    /// Only holding planes need a fresh normal: a plane that is slack at the minimum of a convex problem does not influence it.
    pub(crate) fn refresh_active(&mut self, bodies: Bodies<'_>, active: &ActiveSet) -> f64 {
        self.round += 1;
        let mut before = [(0, DVec3::ZERO); 3];
        let mut held = 0;
        for (slot, (pair, _)) in before.iter_mut().zip(active.iter()) {
            *slot = (pair, self.pairs[pair].normal);
            held += 1;
        }
        for &(first, _) in &before[..held] {
            if self.pairs[first].round == self.round {
                continue;
            }
            let obstacle = self.obstacle_of(first);
            self.queue.clear();
            for &(pair, _) in &before[..held] {
                let leader = self.leader(pair);
                if self.obstacle_of(pair) == obstacle && !self.queue.contains(&leader) {
                    self.queue.push(leader);
                }
            }
            self.refresh_queue(bodies, obstacle);
        }
        before[..held]
            .iter()
            .map(|&(pair, normal)| (self.pairs[pair].normal - normal).length())
            .fold(0.0, f64::max)
    }

    /// The pair whose detection gave `pair` its normal. Of several segments behind one plane it is the one that touches; the others'
    /// own nearest points would give normals of their seams.
    fn leader(&self, pair: usize) -> usize {
        let mut leader = pair;
        // A chain of adoptions is never longer than the group.
        for _ in 0..self.segment_count {
            leader = self.pairs[leader].leader;
        }
        leader
    }

    /// Every plane holding the tool was decided in the present round.
    pub(crate) fn is_fresh(&self, active: &ActiveSet) -> bool {
        active
            .iter()
            .all(|(pair, _)| self.pairs[pair].round == self.round)
    }

    /// Detects the queued pairs of one obstacle, queues whatever a fresh plane cuts off, then lets covered pairs adopt.
    fn refresh_queue(&mut self, bodies: Bodies<'_>, obstacle: usize) {
        for slot in 0..self.queue.len() {
            self.pairs[self.queue[slot]].round = self.round;
        }
        let mut next = 0;
        while next < self.queue.len() {
            let pair = self.queue[next];
            next += 1;
            self.detect(bodies, pair);
            let gap = self.gap(pair);
            for other in self.group(obstacle) {
                if self.pairs[other].round != self.round
                    && self.gap_along(bodies, other, pair) < gap - COVERED
                {
                    self.pairs[other].round = self.round;
                    self.queue.push(other);
                }
            }
        }
        self.adopt_covering_planes(bodies, obstacle);
    }

    /// Redundant planes: a pair whose gap along a leader's normal is no smaller than the leader's takes that normal and so adds no plane
    /// of its own (contact.6). Without this a straight tool cut in segments catches on its own seams.
    fn adopt_covering_planes(&mut self, bodies: Bodies<'_>, obstacle: usize) {
        let mut queue = std::mem::take(&mut self.queue);
        queue.sort_unstable_by(|&a, &b| self.gap(a).total_cmp(&self.gap(b)).then(a.cmp(&b)));
        let mut leaders = 0;
        for slot in 0..queue.len() {
            let pair = queue[slot];
            if !self.adopt_from(bodies, &queue[..leaders], pair) {
                queue.swap(leaders, slot);
                leaders += 1;
            }
        }
        for other in self.group(obstacle) {
            let is_decided = self.pairs[other].round == self.round;
            if !is_decided && self.adopt_from(bodies, &queue[..leaders], other) {
                self.pairs[other].round = self.round;
            }
        }
        self.queue = queue;
    }

    /// Gives `pair` the normal of the first leader whose plane keeps it out too; whether there is one.
    fn adopt_from(&mut self, bodies: Bodies<'_>, leaders: &[usize], pair: usize) -> bool {
        let covering = leaders
            .iter()
            .copied()
            .find(|&leader| self.gap_along(bodies, pair, leader) >= self.gap(leader) - COVERED);
        if let Some(leader) = covering {
            self.set_normal(bodies, pair, self.pairs[leader].normal);
            self.pairs[pair].leader = leader;
        }
        covering.is_some()
    }

    /// Closest points of one pair suggest a normal.
    fn detect(&mut self, bodies: Bodies<'_>, pair: usize) {
        let obstacle = &bodies.obstacles[self.obstacle_of(pair)];
        let segment = &bodies.segments[self.segment_of(pair)];
        let object_from_visual = obstacle.world_from_object.inverse() * self.pose;
        let gap = self.gap(pair);
        let entry = &mut self.pairs[pair];
        entry.leader = pair;
        let (shape, cache) = (&obstacle.shape, &mut entry.cache);
        let kept = obstacle
            .world_from_object
            .inverse_transform_vector(entry.normal);
        let near = touching_points(shape, segment, &object_from_visual, (kept, gap), cache)
            .filter(|closest| closest.separation > 0.0);
        let Some(closest) = near.or_else(|| distance(shape, segment, &object_from_visual, cache))
        else {
            return;
        };
        let normal = obstacle.world_from_object.transform_vector(closest.normal);
        if self.accept(bodies, pair, normal) {
            self.pairs[pair].witness = obstacle
                .world_from_object
                .transform_point(0.5 * (closest.witness_a + closest.witness_b));
        }
    }

    /// Takes a normal over if it is finite and two support calls certify a gap of at least ε/4 along it (contact.5); otherwise the kept
    /// one, still certified, stays.
    fn accept(&mut self, bodies: Bodies<'_>, pair: usize, normal: DVec3) -> bool {
        let Some(normal) = normal.try_normalize() else {
            return false;
        };
        let kept = self.pairs[pair];
        self.set_normal(bodies, pair, normal);
        let accepted = self.gap(pair) >= ACCEPTED_GAP;
        if !accepted {
            self.pairs[pair] = kept;
        }
        accepted
    }

    /// Smallest certified gap over all pairs [m].
    pub(crate) fn smallest_gap(&self) -> f64 {
        (0..self.pairs.len())
            .map(|pair| self.gap(pair))
            .fold(f64::INFINITY, f64::min)
    }
}

/// Largest n·p over the obstacle in the world [m] and the vertex that has it.
pub(crate) fn obstacle_bound(obstacle: &Obstacle, normal: DVec3, start: u32) -> (f64, u32) {
    let local = obstacle.world_from_object.inverse_transform_vector(normal);
    let support = obstacle.shape.support(local, start);
    let shift = normal.dot(obstacle.world_from_object.translation);
    (local.dot(support.point) + shift, support.index)
}

/// Smallest n·(R t) over the segment [m] and the vertex that has it.
pub(crate) fn segment_bound(
    segment: &ConvexMesh,
    rotation: DQuat,
    normal: DVec3,
    start: u32,
) -> (f64, u32) {
    let local = rotation.conjugate() * normal;
    let support = segment.support(-local, start);
    (local.dot(support.point), support.index)
}

#[cfg(test)]
mod tests;
