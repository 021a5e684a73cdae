//! Supports of up to three pairs of features in one direction, and the point between them.

use glam::DVec3;

use crate::rims::feature::FeaturePair;
use crate::support::{MinkowskiDifference, SupportMap};

/// Height of a triangle of supports that is no triangle, times its longest side.
const COLLINEAR: f64 = 1e-10;

/// The support of a pair in a direction.
#[derive(Clone, Copy, Default)]
pub(crate) struct Foot {
    in_a: DVec3,
    in_b: DVec3,
    point: DVec3,
    /// Tangents whose dyads add up to the derivative of the point by the direction.
    bends: [DVec3; 2],
    /// Share of the point of the surface that is met.
    weight: f64,
}

/// The supports of pairs in one direction.
pub(crate) struct Feet {
    feet: [Foot; 3],
    len: usize,
}

/// The point of the surface between feet.
pub(crate) struct Met {
    pub(crate) in_a: DVec3,
    pub(crate) in_b: DVec3,
    /// Of the point from the way out, with weights not below zero.
    pub(crate) miss: DVec3,
}

/// Two sides of a triangle from a common corner, the longest and the shortest, and the shortest across the longest: a
/// needle keeps its digits.
struct Sides {
    base: usize,
    far: usize,
    near: usize,
    long: DVec3,
    short: DVec3,
    across: DVec3,
}

impl Feet {
    /// `None` where a rim lies square to the direction.
    pub(crate) fn new<A, B>(
        difference: &MinkowskiDifference<'_, A, B>,
        pairs: &[FeaturePair],
        outward: DVec3,
    ) -> Option<Self>
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let mut feet = [Foot::default(); 3];
        let along_b = difference.direction_in_b(outward);
        for (foot, pair) in feet.iter_mut().zip(pairs) {
            let (in_a, bend_a) = pair.a.furthest(-outward)?;
            let (in_b, bend_b) = pair.b.furthest(along_b)?;
            *foot = Foot {
                in_a,
                in_b,
                point: difference.difference(in_a, in_b),
                bends: [bend_a, difference.direction_in_a(bend_b)],
                weight: 0.0,
            };
        }
        Some(Self {
            feet,
            len: pairs.len(),
        })
    }

    fn all(&self) -> &[Foot] {
        &self.feet[..self.len]
    }

    /// Height of the highest over the origin along a direction.
    pub(crate) fn height(&self, outward: DVec3) -> f64 {
        let heights = self.all().iter().map(|foot| foot.point.dot(outward));
        heights.fold(f64::NEG_INFINITY, f64::max)
    }

    /// The foot with the least weight, and that weight.
    pub(crate) fn least_weight(&self) -> (usize, f64) {
        let weights = self.all().iter().map(|foot| foot.weight).enumerate();
        weights.fold((0, f64::INFINITY), |least, own| {
            if own.1 < least.1 { own } else { least }
        })
    }

    /// Vector between two feet. From the shapes' own points, since those of a small shape are close in its frame and of
    /// the size of the large one in the difference.
    pub(crate) fn edge<A, B>(
        &self,
        difference: &MinkowskiDifference<'_, A, B>,
        [from, to]: [usize; 2],
    ) -> DVec3
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let (from, to) = (&self.feet[from], &self.feet[to]);
        difference.direction_in_a(to.in_b - from.in_b) - (to.in_a - from.in_a)
    }

    /// The direction nearest to `outward` in which all feet are equally high. `Err`: they are on one line; with the one
    /// between the others.
    pub(crate) fn level<A, B>(
        &self,
        difference: &MinkowskiDifference<'_, A, B>,
        outward: DVec3,
    ) -> Result<DVec3, usize>
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        match self.len {
            2 => {
                let edge = self.edge(difference, [0, 1]);
                let along = edge.try_normalize().ok_or(1_usize)?;
                Ok(without(outward, &[along]))
            }
            3 => {
                let sides = self.sides(difference);
                let flat = sides.across.length() <= COLLINEAR * sides.long.length();
                if flat {
                    return Err(sides.near);
                }
                let axes = [sides.long.normalize(), sides.across.normalize()];
                let cross = axes[0].cross(axes[1]);
                let guess = if cross.dot(outward) < 0.0 {
                    -cross
                } else {
                    cross
                };
                Ok(without(guess, &axes))
            }
            _ => Ok(outward),
        }
    }

    /// Direction from a foot square to the line of the others, or along that to the other.
    pub(crate) fn away_from<A, B>(
        &self,
        difference: &MinkowskiDifference<'_, A, B>,
        index: usize,
    ) -> DVec3
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let next = (index + 1) % self.len;
        let mut across = self.edge(difference, [index, next]);
        if self.len == 3 {
            let along = self.edge(difference, [next, (index + 2) % 3]);
            let along = along.normalize_or_zero();
            for _ in 0..2 {
                across -= along * along.dot(across);
            }
        }
        across.normalize_or_zero()
    }

    fn sides<A, B>(&self, difference: &MinkowskiDifference<'_, A, B>) -> Sides
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let ends = [[0, 1], [1, 2], [2, 0]];
        let edges = ends.map(|between| self.edge(difference, between));
        let lengths = edges.map(DVec3::length_squared);
        let side = |better: fn(f64, f64) -> bool, not: usize| {
            (0..3)
                .filter(|&index| index != not)
                .reduce(|best, index| {
                    if better(lengths[index], lengths[best]) {
                        index
                    } else {
                        best
                    }
                })
                .unwrap_or(0)
        };
        let longest = side(|a, b| a > b, 3);
        let shortest = side(|a, b| a < b, longest);
        let base = if ends[shortest].contains(&ends[longest][0]) {
            ends[longest][0]
        } else {
            ends[longest][1]
        };
        let from_base = |index: usize| {
            if ends[index][0] == base {
                (ends[index][1], edges[index])
            } else {
                (ends[index][0], -edges[index])
            }
        };
        let (far, long) = from_base(longest);
        let (near, short) = from_base(shortest);
        let along = long.normalize_or_zero();
        let across = short - along * along.dot(short);
        Sides {
            base,
            far,
            near,
            long,
            short,
            across: across - along * along.dot(across),
        }
    }

    /// Sets the weights with which the feet make up the point of their line or plane nearest to `exit`; returns that point
    /// less `exit`.
    pub(crate) fn weigh<A, B>(
        &mut self,
        difference: &MinkowskiDifference<'_, A, B>,
        exit: DVec3,
    ) -> DVec3
    where
        A: SupportMap + ?Sized,
        B: SupportMap + ?Sized,
    {
        let from = |foot: &Foot| exit - foot.point;
        match self.len {
            2 => {
                let edge = self.edge(difference, [0, 1]);
                let way = from(&self.feet[0]);
                let share = way.dot(edge) / edge.length_squared();
                self.feet[0].weight = 1.0 - share;
                self.feet[1].weight = share;
                edge * share - way
            }
            3 => {
                let sides = self.sides(difference);
                let way = from(&self.feet[sides.base]);
                let of_near = way.dot(sides.across) / sides.across.length_squared();
                let rest = way - sides.short * of_near;
                let of_far = rest.dot(sides.long) / sides.long.length_squared();
                self.feet[sides.near].weight = of_near;
                self.feet[sides.far].weight = of_far;
                self.feet[sides.base].weight = 1.0 - of_near - of_far;
                sides.long * of_far - rest
            }
            _ => {
                self.feet[0].weight = 1.0;
                -from(&self.feet[0])
            }
        }
    }

    /// The point made up with the weights, those below zero left out.
    pub(crate) fn met(&self, exit: DVec3) -> Met {
        let inside = self.all().iter().map(|foot| foot.weight.max(0.0));
        let sum: f64 = inside.clone().sum();
        let mut met = Met {
            in_a: DVec3::ZERO,
            in_b: DVec3::ZERO,
            miss: DVec3::ZERO,
        };
        for (foot, weight) in self.all().iter().zip(inside) {
            met.in_a += foot.in_a * (weight / sum);
            met.in_b += foot.in_b * (weight / sum);
            met.miss += (foot.point - exit) * (weight / sum);
        }
        met
    }

    /// Second derivative of the height along and across two directions, but for the height itself: uu, uw and ww.
    pub(crate) fn bend(&self, [u, w]: [DVec3; 2]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for foot in self.all() {
            for bend in foot.bends {
                let (along_u, along_w) = (bend.dot(u), bend.dot(w));
                sum[0] += foot.weight * along_u * along_u;
                sum[1] += foot.weight * along_u * along_w;
                sum[2] += foot.weight * along_w * along_w;
            }
        }
        sum
    }
}

/// A vector without its parts along orthonormal axes, to rounding of what is left; as a unit vector.
fn without(vector: DVec3, axes: &[DVec3]) -> DVec3 {
    let mut rest = vector;
    for _ in 0..2 {
        for &axis in axes {
            rest -= axis * axis.dot(rest);
        }
        rest = rest.normalize_or(vector);
    }
    rest
}
