//! A ring of corners and the ears that can be cut from it.

use std::collections::VecDeque;

use glam::DVec2;

use super::{orient, turns_back};

/// A ring of corners from which ears are cut.
pub(super) struct Clipper<'a> {
    flat: &'a [DVec2],
    before: Vec<u32>,
    after: Vec<u32>,
    /// Corners that turn right or go straight on; some may have come to turn left since.
    reflex: Vec<u32>,
    /// Corners to look at; clipped ones may be among them.
    waiting: VecDeque<u32>,
    alive: Vec<bool>,
    /// A corner of the ring.
    pub(super) first: u32,
    /// Number of corners in the ring.
    left: usize,
}

impl<'a> Clipper<'a> {
    pub(super) fn new(flat: &'a [DVec2], outline: &[u32]) -> Self {
        let mut clipper = Self {
            flat,
            before: vec![0; flat.len()],
            after: vec![0; flat.len()],
            reflex: Vec::new(),
            waiting: outline.iter().copied().collect(),
            alive: vec![false; flat.len()],
            first: outline[0],
            left: outline.len(),
        };
        for (&corner, &next) in outline.iter().zip(outline.iter().cycle().skip(1)) {
            clipper.after[corner as usize] = next;
            clipper.before[next as usize] = corner;
            clipper.alive[corner as usize] = true;
        }
        clipper.reflex = outline.to_vec();
        clipper.forget_convex();
        clipper
    }

    /// A corner between its neighbours.
    pub(super) fn corners(&self, corner: u32) -> [u32; 3] {
        [
            self.before[corner as usize],
            corner,
            self.after[corner as usize],
        ]
    }

    /// Positive where the outline turns left.
    pub(super) fn turn(&self, corner: u32) -> f64 {
        let [a, b, c] = self.corners(corner).map(|i| self.flat[i as usize]);
        orient(a, b, c)
    }

    pub(super) fn ring(&self) -> Vec<u32> {
        let next = |&i: &u32| Some(self.after[i as usize]);
        std::iter::successors(Some(self.first), next)
            .take(self.left)
            .collect()
    }

    /// Removes what clipping has made convex, or gone, from the reflex corners.
    fn forget_convex(&mut self) {
        let mut reflex = std::mem::take(&mut self.reflex);
        reflex.retain(|&i| self.alive[i as usize] && self.turn(i) <= 0.0);
        self.reflex = reflex;
    }

    /// The next ear to cut while more than three corners are left. Corners without area, at the place of a neighbour or
    /// where the outline turns back, come about where parts that touch are cut from each other: they go at once, or
    /// the turn of the outline around them would pass for an ear.
    pub(super) fn next_ear(&mut self) -> Option<u32> {
        while self.left > 3 {
            let Some(corner) = self.waiting.pop_front() else {
                // Where the outline touches itself an ear can come free far from the last cut.
                return self.ring().into_iter().find(|&corner| self.is_ear(corner));
            };
            if !self.alive[corner as usize] {
                continue;
            }
            if self.is_spike(corner) {
                self.clip(corner);
            } else if self.is_ear(corner) {
                return Some(corner);
            }
        }
        None
    }

    pub(super) fn clip(&mut self, ear: u32) {
        let [before, _, after] = self.corners(ear);
        let was_reflex = [before, after].map(|i| self.turn(i) <= 0.0);
        self.alive[ear as usize] = false;
        self.after[before as usize] = after;
        self.before[after as usize] = before;
        (self.first, self.left) = (after, self.left - 1);
        let freed =
            was_reflex[0] && self.turn(before) > 0.0 || was_reflex[1] && self.turn(after) > 0.0;
        if freed {
            self.forget_convex();
        }
        for corner in [before, after] {
            if self.is_spike(corner) {
                self.waiting.push_front(corner);
            } else {
                self.waiting.push_back(corner);
            }
        }
    }

    /// At the place of the corner before, or where the outline turns back (mesh.14).
    fn is_spike(&self, corner: u32) -> bool {
        let [a, b, c] = self.corners(corner).map(|i| self.flat[i as usize]);
        a == b || turns_back(a, b, c)
    }

    /// Turns left, and no other corner lies in the triangle or enters it where it touches one of its corners
    /// (mesh.13).
    fn is_ear(&self, corner: u32) -> bool {
        let own = self.corners(corner);
        let [a, b, c] = own.map(|i| self.flat[i as usize]);
        if orient(a, b, c) <= 0.0 {
            return false;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        self.reflex.iter().filter(|i| !own.contains(i)).all(|&i| {
            let p = self.flat[i as usize];
            if p.cmplt(low).any() || p.cmpgt(high).any() {
                return true;
            }
            let wedge = if p == a {
                [c, b]
            } else if p == b {
                [a, c]
            } else if p == c {
                [b, a]
            } else {
                let inside =
                    orient(a, b, p) >= 0.0 && orient(b, c, p) >= 0.0 && orient(c, a, p) >= 0.0;
                return !inside;
            };
            let [before, _, after] = self.corners(i).map(|k| self.flat[k as usize]);
            ![before, after]
                .iter()
                .any(|&q| orient(p, wedge[1], q) > 0.0 && orient(p, q, wedge[0]) > 0.0)
        })
    }
}
