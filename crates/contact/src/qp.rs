//! The nearest point of a convex cell: min ½|x − h|² subject to nᵢ·x ≥ bᵢ.
//!
//! Dual active set of Goldfarb and Idnani (1983) with the identity as Hessian: start at the free minimum h, add the most violated plane,
//! drop planes whose multiplier would turn negative. In three dimensions at most three planes are active, so every linear
//! system is a 1×1, 2×2 or 3×3 Gram matrix of normals. Departure: near-dependent normals are treated as dependent
//! (`PARALLEL`, `COPLANAR`) because multipliers between nearly opposite planes explode.

use glam::{DMat3, DVec3};

/// Half-space n·x ≥ b, n unit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) normal: DVec3,
    /// b [m].
    pub(crate) offset: f64,
}

/// Planes that hold the point, with their multipliers (length of the push along each normal [m], positive).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct ActiveSet {
    index: [usize; 3],
    multiplier: [f64; 3],
    len: usize,
}

/// Largest violation [m] that counts as none: far below the contact skin, far above rounding at metre size.
const VIOLATION: f64 = 1e-12;
/// Squared sine between two normals below which they count as parallel.
const PARALLEL: f64 = 1e-14;
/// Determinant of three normals below which they count as coplanar.
const COPLANAR: f64 = 1e-9;
/// Changes of the active set before giving up; 24 planes never took more than 12.
const MAX_CHANGES: usize = 200;

impl ActiveSet {
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Index of the plane and its multiplier [m].
    pub(crate) fn iter(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..self.len).map(|i| (self.index[i], self.multiplier[i]))
    }

    fn contains(&self, plane: usize) -> bool {
        self.index[..self.len].contains(&plane)
    }

    fn push(&mut self, plane: usize, multiplier: f64) {
        self.index[self.len] = plane;
        self.multiplier[self.len] = multiplier;
        self.len += 1;
    }

    fn remove(&mut self, slot: usize) {
        self.index.copy_within(slot + 1..self.len, slot);
        self.multiplier.copy_within(slot + 1..self.len, slot);
        self.len -= 1;
    }

    /// Coefficients r of the combination of active normals nearest to `vector`.
    fn coefficients(&self, planes: &[Plane], vector: DVec3) -> [f64; 3] {
        let n = |slot: usize| planes[self.index[slot]].normal;
        match self.len {
            0 => [0.0; 3],
            1 => [n(0).dot(vector), 0.0, 0.0],
            2 => {
                let axis = n(0).cross(n(1));
                let scale = 1.0 / axis.length_squared();
                [
                    vector.cross(n(1)).dot(axis) * scale,
                    n(0).cross(vector).dot(axis) * scale,
                    0.0,
                ]
            }
            _ => (DMat3::from_cols(n(0), n(1), n(2)).inverse() * vector).to_array(),
        }
    }

    /// Steps along the active normals [m] that together move `point` onto all active planes.
    fn multipliers_onto(&self, planes: &[Plane], point: DVec3) -> [f64; 3] {
        let n = |slot: usize| planes[self.index[slot]].normal;
        let lack = |slot: usize| planes[self.index[slot]].offset - n(slot).dot(point);
        match self.len {
            0 => [0.0; 3],
            1 => [lack(0), 0.0, 0.0],
            2 => {
                let axis = n(0).cross(n(1));
                let push = (n(1).cross(axis) * lack(0) + axis.cross(n(0)) * lack(1))
                    / axis.length_squared();
                self.coefficients(planes, push)
            }
            _ => {
                let columns = DMat3::from_cols(n(0), n(1), n(2));
                let push = columns.transpose().inverse() * DVec3::new(lack(0), lack(1), lack(2));
                self.coefficients(planes, push)
            }
        }
    }

    /// Part of the unit vector `normal` that the active normals cannot form, or `None` if they form it.
    fn free_part(&self, planes: &[Plane], normal: DVec3, r: &[f64; 3]) -> Option<DVec3> {
        let part = (0..self.len).fold(normal, |z, slot| {
            z - planes[self.index[slot]].normal * r[slot]
        });
        let square = part.length_squared();
        let independent = match self.len {
            0 => true,
            1 => square > PARALLEL,
            2 => {
                let axis = planes[self.index[0]]
                    .normal
                    .cross(planes[self.index[1]].normal);
                square * axis.length_squared() > COPLANAR * COPLANAR
            }
            _ => false,
        };
        independent.then_some(part)
    }
}

/// The point of the cell nearest to `target` and the planes that hold it; `None` when the cell is empty.
///
/// The multipliers t satisfy x − h = Σ tᵢ nᵢ (contact.3). Allocates nothing.
pub(crate) fn nearest_point(planes: &[Plane], target: DVec3) -> Option<(DVec3, ActiveSet)> {
    let mut x = target;
    let mut active = ActiveSet::default();
    for _ in 0..MAX_CHANGES {
        let Some(plane) = most_violated(planes, x, &active) else {
            return Some((polish(planes, target, &mut active), active));
        };
        if !add_plane(planes, plane, &mut x, &mut active) {
            return None;
        }
    }
    None
}

fn most_violated(planes: &[Plane], x: DVec3, active: &ActiveSet) -> Option<usize> {
    let mut worst = None;
    let mut least = -VIOLATION;
    for (index, plane) in planes.iter().enumerate() {
        let slack = plane.normal.dot(x) - plane.offset;
        if slack < least && !active.contains(index) {
            least = slack;
            worst = Some(index);
        }
    }
    worst
}

/// Steps in primal and dual space until `plane` holds; false when it cannot.
fn add_plane(planes: &[Plane], plane: usize, x: &mut DVec3, active: &mut ActiveSet) -> bool {
    let Plane { normal, offset } = planes[plane];
    let mut multiplier = 0.0;
    // Each pass but the last drops an active plane, so at most four are needed.
    for _ in 0..4 {
        let r = active.coefficients(planes, normal);
        let part = active.free_part(planes, normal, &r);
        let full_step = part.map_or(f64::INFINITY, |z| {
            (offset - normal.dot(*x)).max(0.0) / z.dot(normal)
        });
        let mut step = full_step;
        let mut blocking = None;
        for (slot, (m, r)) in active
            .multiplier
            .iter()
            .zip(&r)
            .take(active.len)
            .enumerate()
        {
            if *r > 1e-12 && m / r < step {
                step = m / r;
                blocking = Some(slot);
            }
        }
        if step.is_infinite() {
            return false;
        }
        *x += part.unwrap_or(DVec3::ZERO) * step;
        multiplier += step;
        for (m, r) in active.multiplier.iter_mut().zip(&r).take(active.len) {
            *m = (*m - step * r).max(0.0);
        }
        let Some(slot) = blocking else {
            active.push(plane, multiplier);
            return true;
        };
        active.remove(slot);
    }
    false
}

/// The point on all active planes nearest to the target, computed afresh so that steps leave no drift. The second pass corrects what
/// nearly parallel normals lose in the first.
fn polish(planes: &[Plane], target: DVec3, active: &mut ActiveSet) -> DVec3 {
    let mut point = target;
    let mut multiplier = [0.0; 3];
    for _ in 0..2 {
        let more = active.multipliers_onto(planes, point);
        for (slot, (sum, m)) in multiplier.iter_mut().zip(more).take(active.len).enumerate() {
            *sum += m;
            point += planes[active.index[slot]].normal * m;
        }
    }
    active.multiplier = multiplier.map(|m| m.max(0.0));
    point
}

#[cfg(test)]
mod tests {
    use super::{Plane, nearest_point};
    use glam::DVec3;

    fn plane(normal: [f64; 3], offset: f64) -> Plane {
        Plane {
            normal: DVec3::from_array(normal).normalize(),
            offset,
        }
    }

    #[test]
    fn a_free_target_is_its_own_answer() {
        let (x, active) =
            nearest_point(&[plane([0.0, 0.0, 1.0], -1.0)], DVec3::ONE).expect("feasible");
        assert_eq!(x, DVec3::ONE);
        assert!(active.is_empty());
    }

    #[test]
    fn one_plane_moves_the_target_along_its_normal() {
        let (x, active) =
            nearest_point(&[plane([0.0, 0.0, 1.0], 0.2)], DVec3::new(1.0, 2.0, -0.3)).expect("ok");
        assert!((x - DVec3::new(1.0, 2.0, 0.2)).length() < 1e-15);
        assert!((active.iter().map(|(_, t)| t).sum::<f64>() - 0.5).abs() < 1e-15);
    }

    #[test]
    fn opposite_planes_that_exclude_each_other_are_infeasible() {
        let planes = [plane([0.0, 0.0, 1.0], 0.1), plane([0.0, 0.0, -1.0], 0.1)];
        assert!(nearest_point(&planes, DVec3::ZERO).is_none());
    }

    #[test]
    fn a_corner_holds_with_three_planes() {
        let planes = [
            plane([1.0, 0.0, 0.0], 0.0),
            plane([0.0, 1.0, 0.0], 0.0),
            plane([0.0, 0.0, 1.0], 0.0),
        ];
        let (x, active) = nearest_point(&planes, DVec3::new(-1.0, -2.0, -3.0)).expect("ok");
        assert!(x.length() < 1e-15);
        assert_eq!(active.iter().count(), 3);
    }

    #[test]
    fn nearly_parallel_planes_hold_to_the_stated_violation() {
        for angle in [1e-2_f64, 1e-4, 3e-5, 1e-6] {
            let planes = [
                plane([0.0, angle.sin(), angle.cos()], 0.0),
                plane([0.0, -angle.sin(), angle.cos()], 0.0),
            ];
            let (x, _) = nearest_point(&planes, DVec3::new(0.3, 0.0, -5e-3)).expect("ok");
            for p in &planes {
                let slack = p.normal.dot(x) - p.offset;
                assert!(slack >= -1e-12, "{angle}: {slack:e} m");
            }
            assert!(
                (x - DVec3::new(0.3, 0.0, 0.0)).length() < 1e-7,
                "{angle}: {x}"
            );
        }
    }

    proptest::proptest! {
        /// Karush–Kuhn–Tucker: feasible, multipliers ≥ 0, x − h = Σ tᵢ nᵢ, complementary. These determine the answer.
        #[test]
        fn random_cells_satisfy_the_optimality_conditions(
            normals in proptest::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64), 1..24),
            target in (-3.0..3.0f64, -3.0..3.0f64, -3.0..3.0f64),
        ) {
            // The origin lies in every half-space, so the cell is never empty.
            let planes: Vec<Plane> = normals
                .iter()
                .filter(|n| DVec3::from(**n).length() > 0.1)
                .map(|n| plane([n.0, n.1, n.2], -0.2 - 0.1 * n.0.abs()))
                .collect();
            let h = DVec3::from(target);
            let (x, active) = nearest_point(&planes, h).expect("the origin is feasible");
            for p in &planes {
                proptest::prop_assert!(p.normal.dot(x) - p.offset >= -1e-11);
            }
            let mut sum = x - h;
            for (index, t) in active.iter() {
                proptest::prop_assert!(t >= 0.0);
                proptest::prop_assert!((planes[index].normal.dot(x) - planes[index].offset).abs() < 1e-11);
                sum -= planes[index].normal * t;
            }
            proptest::prop_assert!(sum.length() < 1e-9, "stationarity {}", sum.length());
        }
    }
}
