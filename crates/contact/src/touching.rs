//! Closest points of two bodies in contact, found from the normal of the last tick.
//!
//! At a gap of a skin the direction from one body's last nearest point to the other's is of no use as a search direction: a hand's step
//! of 0.1 mm is a thousand gaps, so it points along the surface, and GJK is sent around the object, over a number of vertices that
//! grows with the tessellation. Lifted by a length L along a normal n that is nearly right, the same bodies give directions
//! that turn by no more than the step over L.
//!
//! With D the Minkowski difference tool − object, let v be its nearest point after the lift and m = v/|v|. Where m = n, the plane with normal n
//! supports D at v − L n = (|v| − L) n, which is a multiple of n: the nearest point of D without the lift, whatever L is. So n ← m is
//! repeated to a fixed point: the proximal point method (Rockafellar 1976), which ends after finitely many steps on a
//! polyhedron (contact.15).

use glam::DVec3;
use pliant_collision::{ClosestPoints, SimplexCache, distance};
use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

/// Lift over the radius of the object. On a sphere the error of the normal shrinks by 0.1 / 1.1 in each step, and a hand's step of a
/// thousandth of the radius turns the search direction by a hundredth.
const LIFT: f64 = 0.1;
/// Steps to the fixed point; a new face takes two. Without it the caller asks for the distance as it is.
const MAX_STEPS: u32 = 5;
/// Each step lifts by this part of the last lift. Above an edge of D of dihedral angle θ the fixed point is reached in steps of the
/// distance from it over L, so that a constant lift would need as many steps as L θ is wider than that distance.
const SHRINK: f64 = 0.1;
/// Chord between unit normals that counts as none: the normal of a face 0.3 mm wide is computed to 1e-13, and at the gap of a contact
/// skin it leaves the direction between the nearest points within 1e-5 rad of the normal of the plane.
const FIXED: f64 = 1e-12;
/// Objects of fewer vertices are not lifted: there a search in a useless direction ends after a few steps too.
const COARSE: usize = 256;

/// Closest points of `object` and `segment` near the supporting planes with the unit normal `normal` (object's frame, object to
/// segment), whose gap along it is `gap` [m]; in the object's frame, as [`pliant_collision::closest_points`].
///
/// `None` where the object is coarse, the gap wide, or no fixed point near. Overlap is allowed: then the plane is one whose depth no plane
/// near it undercuts (contact.15). Allocates nothing.
pub(crate) fn touching_points(
    object: &ConvexMesh,
    segment: &ConvexMesh,
    object_from_segment: &Pose,
    (normal, gap): (DVec3, f64),
    cache: &mut SimplexCache,
) -> Option<ClosestPoints> {
    let mut lift = LIFT * object.radius() - gap;
    if object.positions().len() < COARSE || lift <= 0.0 {
        return None;
    }
    let mut normal = normal;
    for _ in 0..MAX_STEPS {
        let shift = lift * normal;
        let lifted = Pose::new(
            object_from_segment.rotation,
            object_from_segment.translation + shift,
        );
        let found = distance(object, segment, &lifted, cache)?;
        if (found.normal - normal).length_squared() <= FIXED * FIXED {
            return Some(ClosestPoints {
                witness_b: found.witness_b - shift,
                separation: found.separation - lift,
                ..found
            });
        }
        normal = found.normal;
        lift *= SHRINK;
    }
    None
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};
    use pliant_collision::{SimplexCache, closest_points};
    use pliant_mesh::{ConvexMesh, generate};
    use pliant_spatial::Pose;

    use super::touching_points;

    /// A block sliding over an ellipsoid: at every step it is put at `gap` from where it would touch.
    fn slide(gap: f64, mut check: impl FnMut(f64, f64, f64)) -> u32 {
        let radii = DVec3::new(0.06, 0.05, 0.04);
        let mesh = generate::latitude_longitude_ellipsoid(radii, 96, 67).expect("sizes");
        let object = ConvexMesh::from_triangles(&mesh).expect("convex");
        let mesh = generate::cuboid(DVec3::new(0.02, 0.003, 0.003)).expect("sizes");
        let segment = ConvexMesh::from_triangles(&mesh).expect("convex");
        let mut cache = SimplexCache::default();
        let mut last = None;
        let mut answered = 0;
        for step in 0..400 {
            let t = 2e-3 * f64::from(step);
            let rotation = DQuat::from_euler(glam::EulerRot::ZYX, 0.3 + 3.0 * t, 0.4 * t, 0.7 * t);
            let far = Pose::new(rotation, DVec3::new(0.02 * t.cos(), 0.03 * t.sin(), 0.1));
            let apart = closest_points(&object, &segment, &far, &mut SimplexCache::default());
            // Close the distance twice: the first time along a normal that is not the one at contact.
            let mut pose = far;
            let mut found = apart;
            for left in [1e-3, gap, gap] {
                pose.translation -= (found.separation - left) * found.normal;
                found = closest_points(&object, &segment, &pose, &mut SimplexCache::default());
            }
            let kept = last.replace(found.normal).unwrap_or(found.normal);
            let near = touching_points(&object, &segment, &pose, (kept, 0.0), &mut cache);
            let Some(near) = near else { continue };
            answered += 1;
            let between = near.witness_b - near.witness_a - near.separation * near.normal;
            let normal = (near.normal - found.normal).length();
            check(near.separation - found.separation, normal, between.length());
        }
        answered
    }

    #[test]
    fn a_fixed_point_is_the_nearest_point() {
        let answered = slide(1e-7, |separation, normal, between| {
            assert!(
                separation.abs() < 1e-14,
                "separation off by {separation:e} m"
            );
            assert!(normal < 1e-5, "normal off by {normal:e}");
            assert!(between < 1e-12, "witnesses off by {between:e} m");
        });
        assert!(answered > 150, "{answered} of 400");
    }

    #[test]
    fn shallow_overlap_has_the_depth_of_a_full_search_up_to_the_next_plane() {
        // Of two planes next to each other both may have their foot on their own face; their depths differ by 1 µm · θ²/2.
        let answered = slide(-1e-6, |separation, _, between| {
            assert!(separation < 1e-13, "shallower by {separation:e} m");
            assert!(separation > -1e-9, "deeper by {separation:e} m");
            assert!(between < 1e-12, "witnesses off by {between:e} m");
        });
        assert!(answered > 150, "{answered} of 400");
    }

    #[test]
    fn coarse_objects_and_wide_gaps_are_left_to_the_plain_search() {
        let block = |half: f64| {
            let mesh = generate::cuboid(DVec3::splat(half)).expect("sizes");
            ConvexMesh::from_triangles(&mesh).expect("convex")
        };
        let mut cache = SimplexCache::default();
        let pose = Pose::from_translation(DVec3::Z * 0.06);
        let kept = (DVec3::Z, 0.0);
        assert!(touching_points(&block(0.05), &block(0.01), &pose, kept, &mut cache).is_none());
        let mesh = generate::fibonacci_ellipsoid(DVec3::splat(0.05), 400).expect("sizes");
        let ball = ConvexMesh::from_triangles(&mesh).expect("convex");
        let kept = (DVec3::Z, 0.01);
        assert!(touching_points(&ball, &block(0.01), &pose, kept, &mut cache).is_none());
    }
}
