//! Answers on cylinders and cones to the last digits.
//!
//! GJK and EPA meet a rim in chords. A chord that is short enough to lie on the circle is too short to tell its normal: at
//! best half the digits of a direction are right, and around an axis, where all directions are nearly equally deep, EPA's
//! buffers end before even those. But the vertices found tell *which* rims, edges and corners are met, and on these the
//! supports are known as functions of the direction. What remains is a smooth problem with two unknowns (collision.11):
//! the direction in which the met places are equally high and the way out crosses the surface between them.

use glam::{DVec2, DVec3};

use crate::gjk::{ClosestPoints, Plane};
use crate::support::{DifferencePoint, MinkowskiDifference, SupportMap};

mod foot;
mod place;

use foot::{Foot, between, least_weight, level, weigh};
use place::Place;
pub use place::Rim;
pub(crate) use place::key;

/// Distance between the foot of a plane and the points met there, and height of a place over the plane of others, that
/// rounding explains, times the largest coordinate.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

const STEP_LIMIT: u32 = 64;

/// Largest turn of one step [rad].
const LONGEST_STEP: f64 = 0.5;

/// The answer of a plane found by GJK or EPA: made exact where rims are met, the plane's own elsewhere.
pub(crate) fn settle<A, B>(
    difference: &MinkowskiDifference<'_, A, B>,
    plane: &Plane,
) -> Option<ClosestPoints>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    let mut search = Search::new(difference, plane)?;
    search.run();
    let Settled {
        outward,
        reach,
        in_a,
        in_b,
    } = search.best?;
    let core_b = difference.a_from_b.transform_point(in_b);
    let (radius_a, radius_b) = (difference.a.radius(), difference.b.radius());
    Some(ClosestPoints {
        witness_a: in_a - outward * radius_a,
        witness_b: core_b + outward * radius_b,
        normal: -outward,
        separation: -reach - (radius_a + radius_b),
    })
}

struct Search<'d, 's, A: ?Sized, B: ?Sized> {
    difference: &'d MinkowskiDifference<'s, A, B>,
    scale: f64,
    outward: DVec3,
    places: [Option<Place>; 3],
    len: usize,
    /// Lowest sum of height and miss so far, with what it belongs to unless that is the start.
    merit: f64,
    best: Option<Settled>,
}

/// A direction with the height of its plane and the points met, each in its shape's frame.
struct Settled {
    outward: DVec3,
    reach: f64,
    in_a: DVec3,
    in_b: DVec3,
}

impl<'d, 's, A, B> Search<'d, 's, A, B>
where
    A: SupportMap + ?Sized,
    B: SupportMap + ?Sized,
{
    /// `None` where no rim is met or the plane is exact already.
    fn new(difference: &'d MinkowskiDifference<'s, A, B>, plane: &Plane) -> Option<Self> {
        let vertices = plane.simplex.vertices();
        if !vertices
            .iter()
            .any(|vertex| Place::of(difference, vertex).is_turned())
        {
            return None;
        }
        let mut foot = DVec3::ZERO;
        let mut scale = 0.0_f64;
        for (vertex, &weight) in vertices.iter().zip(plane.simplex.weights()) {
            let point = difference.vertex(vertex.a, vertex.b).point;
            foot += point * weight;
            scale = scale.max(point.length());
        }
        let miss = (foot - plane.normal * plane.separation).length();
        let mut search = Self {
            difference,
            scale,
            outward: -plane.normal,
            places: [None; 3],
            len: 0,
            merit: miss - plane.separation,
            best: None,
        };
        for vertex in vertices {
            let place = Place::of(difference, vertex);
            if !search.places.contains(&Some(place)) && search.len < 3 {
                search.places[search.len] = Some(place);
                search.len += 1;
            }
        }
        Some(search)
    }

    fn run(&mut self) {
        for _ in 0..STEP_LIMIT {
            if self.step().is_none() {
                break;
            }
        }
    }

    /// `None` at the end.
    fn step(&mut self) -> Option<()> {
        let feet = self.feet()?;
        let Some(level) = level(self.outward, &feet[..self.len]) else {
            self.remove(between(&feet[..self.len]));
            return (self.len > 0).then_some(());
        };
        self.outward = level;
        let mut feet = self.feet()?;
        let outward = self.outward;
        let support = self.difference.support(outward, &DifferencePoint::NONE);
        let highest = feet[..self.len]
            .iter()
            .fold(f64::NEG_INFINITY, |highest, foot| {
                highest.max(foot.point.dot(outward))
            });
        // Rims are polygons to their support mapping: the circle may reach further by rounding.
        let reach = support.point.dot(outward).max(highest);
        let exit = outward * reach;
        weigh(&mut feet[..self.len], exit);
        let least = least_weight(&feet[..self.len]);
        let offset = self.record(&feet, exit, reach);
        let exact = offset.length() <= ROUNDING * self.scale;
        let place = Place::of(self.difference, &support);
        if reach - highest > ROUNDING * self.scale && !self.places.contains(&Some(place)) {
            self.add(place);
            return Some(());
        }
        if let Some((index, weight)) = least
            && weight < 0.0
            && self.len > 1
        {
            self.remove(index);
            return Some(());
        }
        if self.len == 3 {
            return (!exact).then_some(());
        }
        let crest = self.turn(&feet, offset, reach);
        (crest || !exact).then_some(())
    }

    fn feet(&self) -> Option<[Foot; 3]> {
        let mut feet = [Foot::default(); 3];
        let along_b = self.difference.direction_in_b(self.outward);
        for (foot, place) in feet.iter_mut().zip(self.places.iter().flatten()) {
            let (in_a, bend_a) = place.a.furthest(-self.outward)?;
            let (in_b, bend_b) = place.b.furthest(along_b)?;
            *foot = Foot {
                in_a,
                in_b,
                point: self.difference.difference(in_a, in_b),
                bends: [bend_a, self.difference.direction_in_a(bend_b)],
                weight: 0.0,
            };
        }
        Some(feet)
    }

    /// Notes what the feet make of the exit; the point met there less the exit.
    fn record(&mut self, feet: &[Foot; 3], exit: DVec3, reach: f64) -> DVec3 {
        let inside = feet[..self.len].iter().map(|foot| foot.weight.max(0.0));
        let sum: f64 = inside.clone().sum();
        let (mut in_a, mut in_b, mut met, mut free) =
            (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        for (foot, weight) in feet.iter().zip(inside) {
            in_a += foot.in_a * (weight / sum);
            in_b += foot.in_b * (weight / sum);
            met += (foot.point - exit) * (weight / sum);
            free += (foot.point - exit) * foot.weight;
        }
        let merit = met.length() + reach;
        if merit < self.merit {
            self.merit = merit;
            self.best = Some(Settled {
                outward: self.outward,
                reach,
                in_a,
                in_b,
            });
        }
        free
    }

    fn add(&mut self, place: Place) {
        if self.len < 3 {
            self.places[self.len] = Some(place);
            self.len += 1;
            return;
        }
        // Of the three triangles with it the one over which the way out passes.
        let old = self.places;
        let mut best = (f64::NEG_INFINITY, old);
        for slot in 0..3 {
            self.places = old;
            self.places[slot] = Some(place);
            let Some(feet) = self.feet() else { continue };
            let Some(outward) = level(self.outward, &feet) else {
                continue;
            };
            let mut feet = feet;
            let exit = outward * outward.dot(feet[0].point);
            weigh(&mut feet, exit);
            if let Some((_, weight)) = least_weight(&feet)
                && weight > best.0
            {
                best = (weight, self.places);
            }
        }
        self.places = best.1;
    }

    fn remove(&mut self, index: usize) {
        self.len -= 1;
        self.places.swap(index, self.len);
        self.places[self.len] = None;
    }

    /// Newton's step for the height of the plane in the directions that keep the places level. Whether it led off a crest.
    fn turn(&mut self, feet: &[Foot; 3], offset: DVec3, reach: f64) -> bool {
        let outward = self.outward;
        let [u, w] = if self.len == 2 {
            let along = (feet[1].point - feet[0].point).normalize();
            [outward.cross(along), DVec3::ZERO]
        } else {
            let (u, w) = outward.any_orthonormal_pair();
            [u, w]
        };
        let slope = DVec2::new(offset.dot(u), offset.dot(w));
        // What bends is the height of the plane; where nothing may turn it bends up.
        let (mut uu, mut uw, mut ww) = (-reach, 0.0, -reach * w.length_squared());
        for foot in &feet[..self.len] {
            for bend in foot.bends {
                let (along_u, along_w) = (bend.dot(u), bend.dot(w));
                uu += foot.weight * along_u * along_u;
                uw += foot.weight * along_u * along_w;
                ww += foot.weight * along_w * along_w;
            }
        }
        // Axes of the second derivative: downhill along each, also where it bends the other way.
        let turn = 0.5 * (2.0 * uw).atan2(uu - ww);
        let (sine, cosine) = turn.sin_cos();
        let mut change = DVec2::ZERO;
        let mut crest = false;
        for axis in [DVec2::new(cosine, sine), DVec2::new(-sine, cosine)] {
            let bend = uu * axis.x * axis.x + 2.0 * uw * axis.x * axis.y + ww * axis.y * axis.y;
            let slope = slope.dot(axis);
            let falls = bend < -8.0 * ROUNDING * self.scale;
            crest |= falls;
            if falls || bend.abs() * LONGEST_STEP <= slope.abs() {
                if falls || slope != 0.0 {
                    change -= axis * (LONGEST_STEP * slope.signum());
                }
            } else {
                change -= axis * (slope / bend.abs());
            }
        }
        let change = u * change.x + w * change.y;
        let change = change.clamp_length_max(LONGEST_STEP);
        self.outward = (outward + change).normalize();
        crest
    }
}
