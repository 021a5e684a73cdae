//! A few triangles in any disorder, a convex shape beside them, and what every query must say about the two.

use arbitrary::Arbitrary;
use glam::DVec3;
use pliant_collision::{
    ClosestPoints, MeshCache, MeshContact, Point, SimplexCache, Triangle, TriangleBvh,
    closest_points,
};
use pliant_mesh::TriangleMesh;
use pliant_spatial::Pose;

use crate::pair::{Description, Number, Placement, Shape, TOLERANCE, points, reach, vector};

/// Few enough to ask every triangle, enough for a tree of some levels.
const MOST_TRIANGLES: usize = 32;

/// How far inside a triangle, as a share of it, and how steeply a ray must cross it to hit it whatever the rounding.
const CLEAR: f64 = 1e-6;

/// Triangles, a shape that goes from one placement to another, and where it is cast.
#[derive(Arbitrary, Debug)]
pub struct Soup {
    vertices: Vec<[Number; 3]>,
    triangles: Vec<[u8; 3]>,
    shape: Description,
    placement: Placement,
    next: Placement,
    margin: Number,
    motion: [Number; 3],
    /// Power of ten of all lengths, modulo 13, from 1e-6 on.
    size: u8,
}

/// One query: everything but the caches.
struct Scene<'a> {
    mesh: &'a TriangleMesh,
    bvh: &'a TriangleBvh,
    shape: &'a Shape,
    pose: Pose,
    margin: f64,
    /// Largest error of any length.
    error: f64,
}

impl Soup {
    /// The triangles, degenerate ones included.
    fn mesh(&self, size: f64) -> Option<TriangleMesh> {
        let positions = points(&self.vertices, size);
        let count = positions.len().max(1);
        let corner = |v: u8| (usize::from(v) % count) as u32;
        let triangles = self.triangles.iter().take(MOST_TRIANGLES);
        let triangles = triangles.map(|t| t.map(corner)).collect();
        TriangleMesh::new(positions, triangles).ok()
    }
}

/// Panics unless all queries of the mesh keep their contract, cold and warm, and agree with every triangle asked.
pub fn judge_soup(soup: &Soup) {
    let size = 10_f64.powi(i32::from(soup.size % 13) - 6);
    let Some(mesh) = soup.mesh(size) else {
        return;
    };
    let shape = soup.shape.shape(size);
    let motion = vector(soup.motion) * size;
    let bvh = TriangleBvh::new(&mesh);
    let mut warm = MeshCache::default();
    for placement in [&soup.placement, &soup.next, &soup.placement] {
        let pose = placement.pose(size);
        let of_mesh = mesh.bounds().min.abs().max(mesh.bounds().max.abs());
        let coordinates = of_mesh.max_element()
            + reach(&shape)
            + pose.translation.abs().max_element()
            + motion.length();
        let scene = Scene {
            mesh: &mesh,
            bvh: &bvh,
            shape: &shape,
            pose,
            margin: soup.margin.get() * size,
            error: TOLERANCE * coordinates,
        };
        let separations = scene.separations();
        scene.judge_contacts(&separations, &mut MeshCache::default());
        scene.judge_contacts(&separations, &mut warm);
        scene.judge_deepest(&separations, &mut warm);
        scene.judge_points();
        scene.judge_ray(motion);
        scene.judge_cast(motion);
    }
}

impl Scene<'_> {
    fn closest(&self, triangle: u32, pose: &Pose) -> ClosestPoints {
        let corners = Triangle(self.mesh.corners(triangle));
        closest_points(&corners, self.shape, pose, &mut SimplexCache::default())
    }

    fn triangles(&self) -> impl Iterator<Item = u32> {
        (0..).take(self.mesh.triangles().len())
    }

    fn separations(&self) -> Vec<f64> {
        self.triangles()
            .map(|triangle| self.closest(triangle, &self.pose).separation)
            .collect()
    }

    fn judge_contact(&self, hit: &MeshContact, separations: &[f64]) {
        let closest = &hit.closest;
        let expected = separations[hit.triangle as usize];
        assert!(
            (closest.separation - expected).abs() <= self.error,
            "{expected} expected: {hit:?}"
        );
        let step = closest.witness_b - closest.witness_a - closest.normal * closest.separation;
        assert!(
            step.length() <= self.error,
            "the witnesses are {step} off: {hit:?}"
        );
        assert!((closest.normal.length() - 1.0).abs() <= 1e-9, "{hit:?}");
    }

    /// Every triangle within the margin, and of those the minima.
    fn judge_contacts(&self, separations: &[f64], cache: &mut MeshCache) {
        let (mesh, bvh) = (self.mesh, self.bvh);
        let every = bvh.every_contact(mesh, self.shape, &self.pose, self.margin, cache);
        assert!(every.is_sorted_by(|a, b| a.triangle < b.triangle));
        for hit in every {
            self.judge_contact(hit, separations);
            assert!(hit.closest.separation <= self.margin, "{hit:?}");
        }
        for (triangle, &separation) in (0..).zip(separations) {
            assert!(
                separation > self.margin - self.error
                    || every.iter().any(|hit| hit.triangle == triangle),
                "triangle {triangle}, {separation} away, is missing from {every:?}"
            );
        }
        let minima = bvh.contacts(mesh, self.shape, &self.pose, self.margin, cache);
        for hit in minima {
            self.judge_contact(hit, separations);
            assert!(hit.closest.separation <= self.margin, "{hit:?}");
        }
        let lowest = separations.iter().copied().fold(f64::INFINITY, f64::min);
        // At the margin itself rounding decides, which differs between two queries.
        assert!(
            lowest > self.margin - self.error
                || minima
                    .iter()
                    .any(|hit| hit.closest.separation <= lowest + self.error),
            "{lowest} is none of {minima:?}"
        );
    }

    fn judge_deepest(&self, separations: &[f64], cache: &mut MeshCache) {
        let least = separations.iter().copied().fold(f64::INFINITY, f64::min);
        for cache in [cache, &mut MeshCache::default()] {
            let found = self
                .bvh
                .deepest(self.mesh, self.shape, &self.pose, f64::INFINITY, cache);
            let hit = found.expect("there is no limit");
            self.judge_contact(&hit, separations);
            assert!(
                hit.closest.separation <= least + self.error,
                "{least} is deeper than {hit:?}"
            );
        }
    }

    fn judge_points(&self) {
        let at = self.pose.translation;
        let pose = Pose::from_translation(at);
        let distance = |triangle: u32| {
            let corners = Triangle(self.mesh.corners(triangle));
            let cache = &mut SimplexCache::default();
            closest_points(&corners, &Point(DVec3::ZERO), &pose, cache).separation
        };
        let nearest = self.bvh.closest_point(self.mesh, at, f64::INFINITY);
        let nearest = nearest.expect("there is no limit");
        let least = self.triangles().map(distance).fold(f64::INFINITY, f64::min);
        assert!(
            (nearest.distance - least.max(0.0)).abs() <= self.error,
            "{least} away: {nearest:?}"
        );
        let length = nearest.point.distance(at);
        assert!(
            (nearest.distance - length).abs() <= self.error,
            "{nearest:?}"
        );
        let own = distance(nearest.triangle);
        assert!((nearest.distance - own.max(0.0)).abs() <= self.error);
    }

    fn judge_ray(&self, motion: DVec3) {
        let (origin, direction) = (self.pose.translation, motion.normalize_or(DVec3::X));
        let found = self
            .bvh
            .cast_ray(self.mesh, origin, direction, motion.length());
        let distance = found.map_or(motion.length(), |(_, hit)| hit.distance);
        if let Some((triangle, hit)) = found {
            assert!((hit.normal.length() - 1.0).abs() <= 1e-9, "{hit:?}");
            assert!((0.0..=motion.length()).contains(&hit.distance), "{hit:?}");
            let off = (origin + direction * hit.distance - hit.point).length();
            assert!(off <= self.error, "{hit:?} is {off} off the ray");
            let corners = Triangle(self.mesh.corners(triangle));
            let pose = Pose::from_translation(hit.point);
            let cache = &mut SimplexCache::default();
            let off = closest_points(&corners, &Point(DVec3::ZERO), &pose, cache).separation;
            assert!(off <= self.error, "{hit:?} is {off} off the triangle");
        }
        for triangle in self.triangles() {
            if let Some(crossing) = clear_crossing(&self.mesh.corners(triangle), origin, direction)
            {
                assert!(
                    crossing >= distance - self.error / CLEAR,
                    "triangle {triangle} is met at {crossing}, before {found:?}"
                );
            }
        }
    }

    fn judge_cast(&self, motion: DVec3) {
        let at = |fraction: f64| {
            Pose::new(
                self.pose.rotation,
                self.pose.translation + motion * fraction,
            )
        };
        let gap = |fraction: f64| {
            let pose = at(fraction);
            let gaps = self.triangles().map(|t| self.closest(t, &pose).separation);
            gaps.fold(f64::INFINITY, f64::min)
        };
        let found = self
            .bvh
            .cast_shape(self.mesh, self.shape, &self.pose, motion);
        let fraction = found.as_ref().map_or(1.0, |hit| hit.contact.fraction);
        if let Some(hit) = found {
            assert!((0.0..=1.0).contains(&fraction), "{hit:?}");
            assert!((hit.contact.normal.length() - 1.0).abs() <= 1e-9, "{hit:?}");
            assert!(hit.contact.witness.is_finite(), "{hit:?}");
            let gap = self.closest(hit.triangle, &at(fraction)).separation;
            assert!(gap <= self.error, "{gap} apart at the hit: {hit:?}");
        }
        for part in 0..=8 {
            let part = f64::from(part) / 8.0;
            let gap = gap(part * fraction);
            assert!(
                gap >= -self.error || (found.is_some() && fraction == 0.0),
                "{gap} deep at {part} of the way to {found:?}"
            );
        }
    }
}

/// Where a ray crosses a triangle well inside and steeply; `None` where rounding may have a say.
fn clear_crossing([p, q, r]: &[DVec3; 3], origin: DVec3, direction: DVec3) -> Option<f64> {
    let (pq, pr) = (q - p, r - p);
    let cross = pq.cross(pr);
    let longest = pq.length().max(pr.length()).max((r - q).length());
    let steep = cross.dot(direction);
    if cross.length() <= CLEAR * longest * longest || steep.abs() <= CLEAR * cross.length() {
        return None;
    }
    let distance = cross.dot(p - origin) / steep;
    let foot = origin + direction * distance - p;
    let of_q = foot.cross(pr).dot(cross) / cross.length_squared();
    let of_r = pq.cross(foot).dot(cross) / cross.length_squared();
    let inside = of_q.min(of_r).min(1.0 - of_q - of_r) >= 1e-3;
    (inside && distance >= 0.0).then_some(distance)
}
