//! The search for a direction in which pairs of features are level and the way out passes between them (collision.11).

use glam::{DVec2, DVec3};
use pliant_spatial::Pose;

use crate::gjk::{ClosestPoints, Exit, Goal, Plane, SimplexCache, search};
use crate::rims::Answer;
use crate::rims::feature::FeaturePair;
use crate::rims::foot::Feet;
use crate::rims::memory::Memory;
use crate::simplex::Simplex;
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

mod disc;

/// Distance between the foot of a plane and the points met there, and height of a pair over the plane of others, that
/// rounding explains, times the largest coordinate.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Gap or depth in which rounding leaves nothing to be told about the direction, times the largest coordinate.
const TOUCHING: f64 = 256.0 * f64::EPSILON;

/// Newton's steps on the pairs met first: where these are the right ones three or four are enough.
const STEP_LIMIT: u32 = 16;

/// Descents with pairs found anew.
const DESCENT_LIMIT: u32 = 48;

/// Largest turn of one step [rad].
const LONGEST_STEP: f64 = 0.5;

/// A turn after which the same pairs are still likely to be met [rad].
const SHORT_STEP: f64 = 1e-3;

/// Of a step that leads over a ridge; then the ridge itself is the answer.
const SHORTEST_STRIDE: f64 = 1e-6;

/// Turn that tells apart pairs of equal height [rad].
const TILT: f64 = 1e-8;

/// Miss of a resumed search that has closed, times the largest coordinate.
const CLOSED: f64 = 1e-14;

/// Turn between an answer and a step towards it in the last stage of Newton's method [rad].
const NEAR: f64 = 1e-2;

/// How far beyond the way out the nearest point is sought that tells the pairs, times the largest coordinate.
const LEAD: f64 = 1e-3;

pub(super) struct Search<'d, 's, A: ?Sized, B: ?Sized> {
    difference: &'d MinkowskiDifference<'s, A, B>,
    scale: f64,
    pub(super) outward: DVec3,
    pub(super) pairs: [FeaturePair; 3],
    pub(super) len: usize,
    /// Lowest sum of height and miss so far, with what it belongs to unless that is the start.
    merit: f64,
    best: Option<Settled>,
    /// Height of the plane at the start [m]: what settles higher has left for another valley.
    start: f64,
    /// The way was not one of short steps downhill: what it passed over is unknown.
    pub(super) wandered: bool,
    /// Direction of the start and how far around it is to be explored [rad].
    pub(super) origin: (DVec3, f64),
    /// An answer that need not be found again: its direction and pairs.
    pub(super) known: Option<(DVec3, [FeaturePair; 3], usize)>,
}

/// How Newton's steps on a set of pairs end.
#[derive(PartialEq)]
pub(super) enum Run {
    /// At a level point of the surface square under the way out.
    Exact,
    /// Close to the answer known already.
    Known,
    /// Nowhere.
    Lost,
}

/// A direction with the height of its plane and the points met, each in its shape's frame.
struct Settled {
    outward: DVec3,
    reach: f64,
    in_a: DVec3,
    in_b: DVec3,
    memory: Memory,
}

/// What the pairs make of a direction.
struct Measure {
    /// Height of the plane that supports the difference.
    reach: f64,
    /// To rounding the pairs are the highest, and the way out passes between them,
    closed: bool,
    /// else, of pairs that are the highest, the one on the wrong side of the others, and the direction away from it.
    outside: Option<(usize, DVec3)>,
    /// It also meets the surface there, and the height falls in no direction.
    exact: bool,
    /// The turn to the next direction [rad].
    change: DVec3,
    /// The pairs levelled.
    pairs: ([FeaturePair; 3], usize),
    /// The pair that reaches furthest.
    highest: FeaturePair,
}

impl<'d, 's, A, B> Search<'d, 's, A, B>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    pub(super) fn new(difference: &'d MinkowskiDifference<'s, A, B>, plane: &Plane) -> Self {
        let mut foot = DVec3::ZERO;
        let mut scale = 0.0_f64;
        let vertices = plane.simplex.vertices();
        for (vertex, &weight) in vertices.iter().zip(plane.simplex.weights()) {
            let point = difference.vertex(vertex.a, vertex.b).point;
            foot += point * weight;
            scale = scale.max(point.length()).max(difference.size_at(vertex));
        }
        let miss = (foot - plane.normal * plane.separation).length();
        let mut search = Self {
            difference,
            scale,
            outward: -plane.normal,
            pairs: [FeaturePair::of(difference, &vertices[0]); 3],
            len: 0,
            merit: miss - plane.separation,
            best: None,
            start: -plane.separation,
            wandered: false,
            origin: (-plane.normal, f64::INFINITY),
            known: None,
        };
        search.take_pairs(&plane.simplex);
        search
    }

    /// At the direction and with the pairs of an earlier answer. `None` where there are none.
    pub(super) fn from_memory(
        difference: &'d MinkowskiDifference<'s, A, B>,
        memory: &Memory,
    ) -> Option<Self> {
        let mut vertices = memory.vertices(difference);
        let mut search = Self::from_pair(difference, memory.outward(), &vertices.next()?);
        for vertex in vertices {
            let size = difference.size_at(&vertex);
            search.scale = search.scale.max(vertex.point.length()).max(size);
            search.take(FeaturePair::of(difference, &vertex));
        }
        Some(search)
    }

    pub(super) fn from_pair(
        difference: &'d MinkowskiDifference<'s, A, B>,
        outward: DVec3,
        vertex: &DifferencePoint,
    ) -> Self {
        Self {
            difference,
            scale: vertex.point.length().max(difference.size_at(vertex)),
            outward,
            pairs: [FeaturePair::of(difference, vertex); 3],
            len: 1,
            merit: f64::INFINITY,
            best: None,
            start: f64::INFINITY,
            wandered: false,
            origin: (outward, f64::INFINITY),
            known: None,
        }
    }

    /// Newton's method on the pairs met, with others where these lead nowhere.
    pub(super) fn settle(&mut self, plane: &Plane) {
        // Touching to rounding every direction is the answer; the one from the feature is the one that makes sense.
        if plane.separation.abs() <= TOUCHING * self.scale {
            return;
        }
        self.try_discs();
        if self.is_settled() {
            return;
        }
        let run = self.run();
        // Exact on the way down from somewhere else is no answer, unless others are looked for as well.
        if run == Run::Lost || self.known.is_none() && !self.is_settled() {
            self.outward = -plane.normal;
            self.descend(&plane.simplex);
            self.wandered = true;
        }
    }

    /// Whether the search has left the surroundings of its start.
    fn is_far(&self) -> bool {
        let (outward, around) = self.origin;
        outward.distance_squared(self.outward) > around * around
    }

    /// Whether the direction and the pairs are almost those of the known answer.
    fn is_known(&self) -> bool {
        let same = |pairs: &[FeaturePair]| {
            let mut own = self.pairs[..self.len].iter();
            pairs.len() == self.len && own.all(|pair| pairs.contains(pair))
        };
        self.known.as_ref().is_some_and(|(outward, pairs, len)| {
            outward.distance_squared(self.outward) < NEAR * NEAR && same(&pairs[..*len])
        })
    }

    /// Whether the best answer so far is one to rounding.
    pub(super) fn is_settled(&self) -> bool {
        let closed = |best: &Settled| self.merit - best.reach <= CLOSED * self.scale;
        self.best.as_ref().is_some_and(closed)
    }

    /// The best so far, on the rounded surfaces.
    pub(super) fn answer(self) -> Option<Answer> {
        let best = self.best?;
        let outward = best.outward;
        let core_b = self.difference.a_from_b.transform_point(best.in_b);
        let (radius_a, radius_b) = (self.difference.a.radius(), self.difference.b.radius());
        let found = ClosestPoints {
            witness_a: best.in_a - outward * radius_a,
            witness_b: core_b + outward * radius_b,
            normal: -outward,
            separation: -best.reach - (radius_a + radius_b),
        };
        Some(Answer {
            found,
            memory: best.memory,
        })
    }

    /// The pairs of a simplex, each once.
    fn take_pairs(&mut self, simplex: &Simplex) {
        self.len = 0;
        for vertex in simplex.vertices() {
            self.take(FeaturePair::of(self.difference, vertex));
        }
    }

    /// Notes an answer if it is the best so far: the sum of height and miss counts.
    fn offer(&mut self, outward: DVec3, reach: f64, [in_a, in_b]: [DVec3; 2], miss: DVec3) {
        let merit = miss.length() + reach;
        if merit < self.merit {
            self.merit = merit;
            self.best = Some(Settled {
                outward,
                reach,
                in_a,
                in_b,
                memory: Memory::new(outward, &self.pairs[..self.len]),
            });
        }
    }

    /// Newton's method on the pairs as they are, but for those that turn out to be on the wrong side or too low. Whether that
    /// was all: a level point of the surface square under the way out.
    pub(super) fn run(&mut self) -> Run {
        let mut before = f64::INFINITY;
        let mut changed = true;
        for _ in 0..STEP_LIMIT {
            let Some(measure) = self.measure() else {
                return Run::Lost;
            };
            let uphill = measure.closed && measure.reach > before + ROUNDING * self.scale;
            self.wandered |= uphill || changed && self.is_far();
            changed = false;
            before = if measure.closed {
                measure.reach
            } else {
                f64::INFINITY
            };
            match measure.outside {
                _ if measure.exact && measure.reach > self.start + ROUNDING * self.scale => {
                    return Run::Lost;
                }
                _ if measure.exact => return Run::Exact,
                _ if measure.closed => {
                    self.outward = (self.outward + measure.change).normalize();
                    if self.is_known() && measure.reach <= self.start + ROUNDING * self.scale {
                        return Run::Known;
                    }
                }
                Some((index, towards)) if self.exchange(index, towards) => changed = true,
                Some((index, _)) if self.len > 1 => {
                    changed = true;
                    self.len -= 1;
                    self.pairs.swap(index, self.len);
                }
                None if self.take(measure.highest) => self.wandered = true,
                _ => return Run::Lost,
            }
        }
        Run::Lost
    }

    /// Adds a pair that is higher than the others. Whether there was room.
    pub(super) fn take(&mut self, pair: FeaturePair) -> bool {
        let room = self.len < 3 && !self.pairs[..self.len].contains(&pair);
        if room {
            self.pairs[self.len] = pair;
            self.len += 1;
        }
        room
    }

    /// Gives a pair for the one of equal height that lies furthest in a direction. Whether there is one.
    fn exchange(&mut self, index: usize, towards: DVec3) -> bool {
        let tilted = self.outward + towards * TILT;
        let support = self.difference.support(tilted, &DifferencePoint::NONE);
        let pair = FeaturePair::of(self.difference, &support);
        let new = !self.pairs[..self.len].contains(&pair);
        if new {
            self.pairs[index] = pair;
        }
        new
    }

    /// [`Search::run`] with the pairs found anew after every long step, and never uphill.
    pub(super) fn descend(&mut self, simplex: &Simplex) {
        let mut cache = SimplexCache::default();
        cache.remember(simplex);
        let mut lowest: Option<(DVec3, Measure)> = None;
        let mut stride = 1.0;
        for _ in 0..DESCENT_LIMIT {
            if self.project(&mut cache).is_none() {
                return;
            }
            let projected = self.outward;
            let Some(measure) = self.closing_in() else {
                return;
            };
            if measure.exact {
                return;
            }
            match &lowest {
                // Over a ridge: a shorter step.
                Some((outward, before)) if measure.reach > before.reach + ROUNDING * self.scale => {
                    stride *= 0.25;
                    if stride < SHORTEST_STRIDE {
                        self.outward = *outward;
                        self.meet(before.pairs, measure.highest);
                        return;
                    }
                    self.outward = (outward + before.change * stride).normalize();
                }
                _ => {
                    stride = 1.0;
                    if !measure.closed {
                        // Pairs that tell nothing: on from where the nearest point is.
                        self.outward = projected;
                    }
                    let outward = self.outward;
                    let change = if measure.closed {
                        measure.change
                    } else {
                        DVec3::ZERO
                    };
                    self.outward = (outward + change).normalize();
                    lowest = Some((outward, Measure { change, ..measure }));
                }
            }
        }
    }

    /// Measures, and takes short steps while they close in.
    fn closing_in(&mut self) -> Option<Measure> {
        let mut measure = self.measure()?;
        for _ in 0..STEP_LIMIT {
            if measure.exact || !measure.closed || measure.change.length() > SHORT_STEP {
                break;
            }
            self.outward = (self.outward + measure.change).normalize();
            measure = self.measure()?;
        }
        Some(measure)
    }

    /// Ends where the pairs of one side of a ridge and the highest beyond it are level.
    fn meet(&mut self, (pairs, len): ([FeaturePair; 3], usize), beyond: FeaturePair) {
        self.pairs = pairs;
        self.len = len;
        if len < 3 && !pairs[..len].contains(&beyond) {
            self.pairs[len] = beyond;
            self.len += 1;
        }
        self.run();
    }

    /// Turns to where the point of the difference is nearest to one beyond the way out, never a deeper direction, and takes
    /// the pairs met there.
    fn project(&mut self, cache: &mut SimplexCache) -> Option<()> {
        let start = self
            .difference
            .support(self.outward, &DifferencePoint::NONE);
        let reach = start.point.dot(self.outward);
        let beyond = self.outward * (reach + LEAD * self.scale);
        let a_from_b = self.difference.a_from_b;
        let pose = Pose::new(a_from_b.rotation, a_from_b.translation - beyond);
        let moved = MinkowskiDifference::new(self.difference.a, self.difference.b, &pose);
        let Exit::Apart(found) = search(&moved, cache, Goal::Distance) else {
            return None;
        };
        cache.remember(&found.simplex);
        self.outward = -found.normal;
        self.take_pairs(&found.simplex);
        Some(())
    }

    /// Levels the direction and weighs its pairs. `None` where one of them has no support in it.
    fn measure(&mut self) -> Option<Measure> {
        let difference = self.difference;
        let outward = loop {
            let feet = Feet::new(difference, &self.pairs[..self.len], self.outward)?;
            match feet.level(difference, self.outward) {
                Ok(level) => break level,
                Err(between) => {
                    self.len -= 1;
                    self.pairs.swap(between, self.len);
                }
            }
        };
        self.outward = outward;
        let mut feet = Feet::new(difference, &self.pairs[..self.len], outward)?;
        let support = difference.support(outward, &DifferencePoint::NONE);
        let highest = feet.height(outward);
        // Rims are polygons to their support mapping: the circle may reach further by rounding.
        let reach = support.point.dot(outward).max(highest);
        let exit = outward * reach;
        let offset = feet.weigh(difference, exit);
        let met = feet.met(exit);
        self.offer(outward, reach, [met.in_a, met.in_b], met.miss);
        let rounding = ROUNDING * self.scale;
        let (least, weight) = feet.least_weight();
        let supports = reach - highest <= rounding;
        let closed = supports && weight >= -ROUNDING;
        let outside = (supports && !closed).then(|| (least, feet.away_from(difference, least)));
        let (change, crest) = self.newton(&feet, offset, reach);
        Some(Measure {
            reach,
            closed,
            outside,
            exact: closed && !crest && offset.length() <= rounding,
            change,
            pairs: (self.pairs, self.len),
            highest: FeaturePair::of(difference, &support),
        })
    }

    /// Newton's step for the height of the plane in the directions that keep the pairs level, and whether it leads off a
    /// crest.
    fn newton(&self, feet: &Feet, offset: DVec3, reach: f64) -> (DVec3, bool) {
        let outward = self.outward;
        let axes = match self.len {
            1 => {
                let (u, w) = outward.any_orthonormal_pair();
                [u, w]
            }
            2 => {
                let along = feet.edge(self.difference, [0, 1]);
                [outward.cross(along).normalize_or_zero(), DVec3::ZERO]
            }
            _ => return (DVec3::ZERO, false),
        };
        let slope = DVec2::new(offset.dot(axes[0]), offset.dot(axes[1]));
        let [uu, uw, ww] = feet.bend(axes);
        let (uu, ww) = (uu - reach, ww - reach * axes[1].length_squared());
        // Axes of the second derivative: downhill along each, also where it bends the other way.
        let turn = 0.5 * (2.0 * uw).atan2(uu - ww);
        let (sine, cosine) = turn.sin_cos();
        let mut change = DVec2::ZERO;
        let mut crest = false;
        for axis in [DVec2::new(cosine, sine), DVec2::new(-sine, cosine)] {
            let bend = uu * axis.x * axis.x + 2.0 * uw * axis.x * axis.y + ww * axis.y * axis.y;
            let slope = slope.dot(axis);
            let falls = bend < -ROUNDING * self.scale;
            crest |= falls;
            if falls || bend.abs() * LONGEST_STEP <= slope.abs() {
                if falls || slope != 0.0 {
                    change -= axis * (LONGEST_STEP * slope.signum());
                }
            } else {
                change -= axis * (slope / bend.abs());
            }
        }
        let change = axes[0] * change.x + axes[1] * change.y;
        (change.clamp_length_max(LONGEST_STEP), crest)
    }
}
