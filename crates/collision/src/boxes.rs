//! Box against box in closed form: the fifteen separating axes of Gottschalk, Lin & Manocha (1996), and witness points on
//! the face of the Minkowski difference that the best of them supports.
//!
//! The difference of two boxes is a zonotope t + Σ cₖ γₖ with six generators γ, the half sides, and c in [−1, 1]; all its
//! faces are square to these axes. Overlap is always answered by such a face. Apart, the nearest feature may also be an edge
//! or a vertex of the difference: from the face next to it, projecting on one box and the other in turn ends there. Every
//! answer is checked against the definition, a supporting plane and a point of the difference in it, before it is given;
//! where that fails, nothing is lost but time: GJK and EPA take over.

use glam::{DMat3, DVec3};
use pliant_spatial::Pose;

use crate::gjk::ClosestPoints;

mod foot;

/// Generators that rise less than this times the extent from the supporting plane lie in it: rounding cannot tell.
const FLUSH: f64 = 16.0 * f64::EPSILON;

/// What the witness points may miss the supporting plane by, times the extent.
const MISS: f64 = 64.0 * f64::EPSILON;

/// Number of face normals: A's three, then B's. Behind these the axes are numbered by edges, those of A running fastest.
const FACES: usize = 6;

/// Number of all axes.
const AXES: usize = 15;

/// Where the last query of two boxes ended: the number of an axis plus one; or behind these that of the corner of A next to
/// the nearest point; or zero. That of other boxes is harmless, for what it leads to is checked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Feature(u8);

/// Two boxes about their middles, in A's frame.
struct Boxes {
    half_a: DVec3,
    half_b: DVec3,
    /// Unit axes of B.
    axes_b: [DVec3; 3],
    /// From the middle of A to that of B [m].
    offset: DVec3,
    /// Bound of all coordinates [m]: what rounding is relative to.
    extent: f64,
}

/// A supporting plane of the difference.
#[derive(Clone, Copy)]
struct Plane {
    /// Unit, from A to B.
    normal: DVec3,
    /// The same in B.
    normal_in_b: DVec3,
    /// Height over the origin [m].
    separation: f64,
}

/// A plane and a point of each core whose difference lies in it.
struct Pair {
    plane: Plane,
    core_a: DVec3,
    core_b: DVec3,
}

/// The two boxes' closest points; `None` where rounding leaves doubt. Allocates nothing.
// Out of the callers: inlined it would enlarge the stack frame of every other pair of shapes.
#[inline(never)]
pub(crate) fn closest(
    halves: [DVec3; 2],
    a_from_b: &Pose,
    [radius_a, radius_b]: [f64; 2],
    last: &mut Feature,
) -> Option<ClosestPoints> {
    let boxes = Boxes::new(halves, a_from_b);
    let pair = boxes.again(*last).or_else(|| boxes.anew(last))?;
    let Plane {
        normal, separation, ..
    } = pair.plane;
    Some(ClosestPoints {
        witness_a: pair.core_a + normal * radius_a,
        witness_b: pair.core_b - normal * radius_b,
        normal,
        separation: separation - (radius_a + radius_b),
    })
}

/// Whether two boxes touch or overlap that are rounded by `radii` [m] together; `None` where rounding leaves doubt.
#[inline(never)]
pub(crate) fn overlap(
    halves: [DVec3; 2],
    a_from_b: &Pose,
    radii: f64,
    last: &mut Feature,
) -> Option<bool> {
    let boxes = Boxes::new(halves, a_from_b);
    let separation = boxes.plane(boxes.best_axis()).separation;
    if separation > radii + MISS * boxes.extent {
        return Some(false);
    }
    if separation <= 0.0 {
        return Some(true);
    }
    // Within reach of the radii the axes are no more than a bound, and touching is for `closest` to decide.
    let pair = boxes.again(*last).or_else(|| boxes.anew(last))?;
    Some(pair.plane.separation <= radii)
}

impl Boxes {
    fn new([half_a, half_b]: [DVec3; 2], a_from_b: &Pose) -> Self {
        let rotation = DMat3::from_quat(a_from_b.rotation);
        let offset = a_from_b.translation;
        Self {
            half_a,
            half_b,
            axes_b: [rotation.x_axis, rotation.y_axis, rotation.z_axis],
            offset,
            extent: offset.abs().element_sum() + half_a.element_sum() + half_b.element_sum(),
        }
    }

    /// Where the last query ended, if it was apart there and still is: a plane and a point in it settle the matter. In overlap
    /// another axis may have become the better one.
    fn again(&self, last: Feature) -> Option<Pair> {
        let number = usize::from(last.0).checked_sub(1)?;
        let pair = match number.checked_sub(AXES) {
            None => self.on_face(&self.plane(number)),
            Some(corner) => self.projected(self.corner(corner)),
        };
        (pair.plane.separation > 0.0 && self.holds(&pair)).then_some(pair)
    }

    /// Over all axes; `last` becomes what is found.
    fn anew(&self, last: &mut Feature) -> Option<Pair> {
        *last = Feature::default();
        let axis = self.best_axis();
        let plane = self.plane(axis);
        let pair = self.on_face(&plane);
        let apart = plane.separation > 0.0;
        if self.holds(&pair) {
            if apart {
                *last = Feature::from_number(axis);
            }
            return Some(pair);
        }
        if apart {
            let near = self.projected(pair.core_a);
            if self.holds(&near) {
                *last = Feature::from_number(AXES + corner_number(near.core_a));
                return Some(near);
            }
        }
        let pair = self.beside(&plane, pair.core_a);
        self.holds(&pair).then_some(pair)
    }

    /// Whether the points belong to the plane: what is not a number does not.
    fn holds(&self, pair: &Pair) -> bool {
        let between = pair.core_b - pair.core_a;
        let miss = between - pair.plane.normal * pair.plane.separation;
        let limit = MISS * self.extent;
        miss.length_squared() <= limit * limit
    }

    /// The axis with the highest supporting plane (collision.12).
    fn best_axis(&self) -> usize {
        let (face, gap) = self.best_face();
        // A face is taken before edges that are no better: its witness points have more room.
        self.best_edge(gap + FLUSH * self.extent).unwrap_or(face)
    }

    /// The face normal with the widest gap between the planes, and that gap [m].
    fn best_face(&self) -> (usize, f64) {
        let [u, v, w] = self.axes_b;
        let of_b = u.abs() * self.half_b.x + v.abs() * self.half_b.y + w.abs() * self.half_b.z;
        let a = self.offset.abs() - (self.half_a + of_b);
        let along = |axis: DVec3| axis.dot(self.offset).abs() - axis.abs().dot(self.half_a);
        let b = DVec3::new(along(u), along(v), along(w)) - self.half_b;
        let mut best = (0, a.x);
        for (axis, gap) in (1..).zip([a.y, a.z, b.x, b.y, b.z]) {
            if gap > best.1 {
                best = (axis, gap);
            }
        }
        best
    }

    /// The pair of edges with the widest gap between the planes, if wider than `limit` [m].
    fn best_edge(&self, limit: f64) -> Option<usize> {
        let [u, v, w] = self.axes_b;
        let Self { half_a, half_b, .. } = *self;
        // Component i of u × v is the slope of v along the product of axis i and u, and but for its sign that of u along the
        // product of axis i and v. Taken from the axes as rounded, the gaps are right however short the products.
        let (uv, vw, wu) = (u.cross(v).abs(), v.cross(w).abs(), w.cross(u).abs());
        let of_b = [
            uv * half_b.y + wu * half_b.z,
            uv * half_b.x + vw * half_b.z,
            wu * half_b.x + vw * half_b.y,
        ];
        let mut best = None;
        // Signed squares compare like the gaps, without a root; and without a division but where one wins.
        let mut widest = limit * limit.abs();
        for (j, (axis, of_b)) in self.axes_b.into_iter().zip(of_b).enumerate() {
            let (next, last) = (yzx(axis), zxy(axis));
            let of_a = yzx(half_a) * last.abs() + zxy(half_a) * next.abs();
            let gaps = axis.cross(self.offset).abs() - (of_a + of_b);
            let lengths_squared = next * next + last * last;
            for i in 0..3 {
                let squared = gaps[i] * gaps[i].abs();
                if squared > widest * lengths_squared[i] {
                    widest = squared / lengths_squared[i];
                    best = Some(FACES + 3 * j + i);
                }
            }
        }
        best
    }

    /// The supporting plane across an axis, on B's side.
    fn plane(&self, axis: usize) -> Plane {
        let along = match axis {
            0..3 => DVec3::AXES[axis],
            3..FACES => self.axes_b[axis - 3],
            _ => DVec3::AXES[axis % 3].cross(self.axes_b[(axis - FACES) / 3 % 3]),
        };
        let normal = along.normalize();
        self.plane_across(if normal.dot(self.offset) < 0.0 {
            -normal
        } else {
            normal
        })
    }

    fn plane_across(&self, normal: DVec3) -> Plane {
        let normal_in_b = self.in_b(normal);
        let of_a = normal.abs().dot(self.half_a);
        let of_b = normal_in_b.abs().dot(self.half_b);
        Plane {
            normal,
            normal_in_b,
            separation: normal.dot(self.offset) - (of_a + of_b),
        }
    }

    /// A direction of A in B.
    fn in_b(&self, direction: DVec3) -> DVec3 {
        let [u, v, w] = self.axes_b;
        DVec3::new(direction.dot(u), direction.dot(v), direction.dot(w))
    }

    /// A direction of B in A.
    fn in_a(&self, direction: DVec3) -> DVec3 {
        let [u, v, w] = self.axes_b;
        u * direction.x + v * direction.y + w * direction.z
    }

    /// A corner of A; bit k of the number is set where coordinate k is positive.
    fn corner(&self, number: usize) -> DVec3 {
        let signed = |bit: usize, half: f64| if number & bit == 0 { -half } else { half };
        let Self { half_a, .. } = *self;
        DVec3::new(
            signed(1, half_a.x),
            signed(2, half_a.y),
            signed(4, half_a.z),
        )
    }
}

impl Feature {
    fn from_number(number: usize) -> Self {
        Self(u8::try_from(number + 1).unwrap_or(0))
    }
}

fn corner_number(point: DVec3) -> usize {
    usize::from(point.x > 0.0) | usize::from(point.y > 0.0) << 1 | usize::from(point.z > 0.0) << 2
}

fn yzx(v: DVec3) -> DVec3 {
    DVec3::new(v.y, v.z, v.x)
}

fn zxy(v: DVec3) -> DVec3 {
    DVec3::new(v.z, v.x, v.y)
}
