//! Merging vertices at the same place, so that seams of texture coordinates or separate triangles close up.

use std::collections::HashMap;

use glam::DVec3;

use super::TriangleMesh;
use super::coincident::first_at;

/// What [`TriangleMesh::welded`] changed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WeldReport {
    /// Vertices that became one with an earlier one.
    pub merged_vertices: usize,
    /// Vertices that no triangle used.
    pub unused_vertices: usize,
    /// Triangles that had, or came to have, a repeated corner.
    pub dropped_triangles: usize,
}

impl TriangleMesh {
    /// Merges each vertex into the first earlier one within `tolerance` [m] (0: equal coordinates), drops
    /// triangles with a repeated corner and vertices that no triangle uses. The order of what remains is
    /// kept. When every triangle would collapse the mesh is returned unchanged with an empty report.
    pub fn welded(&self, tolerance: f64) -> (Self, WeldReport) {
        if tolerance > 0.0 {
            self.merged(Some(nearby_targets(&self.positions, tolerance)))
        } else {
            self.merged(first_at(&self.positions))
        }
    }

    /// [`TriangleMesh::welded`] with the vertex that each one becomes; all stay without a list.
    pub(super) fn merged(&self, target: Option<Vec<u32>>) -> (Self, WeldReport) {
        let target = target.unwrap_or_else(|| (0..).take(self.positions.len()).collect());
        let kept: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .map(|t| t.map(|v| target[v as usize]))
            .filter(|&[a, b, c]| a != b && b != c && c != a)
            .collect();
        if kept.is_empty() {
            return (self.clone(), WeldReport::default());
        }
        let mut used = vec![false; target.len()];
        for &v in self.triangles.iter().flatten() {
            used[v as usize] = true;
        }
        let unused = used.iter().filter(|&&u| !u).count();
        let merged = (0..)
            .zip(&target)
            .zip(&used)
            .filter(|&((i, &t), &u)| u && t != i)
            .count();
        let report = WeldReport {
            merged_vertices: merged,
            unused_vertices: unused,
            dropped_triangles: self.triangles.len() - kept.len(),
        };
        (compacted(&self.positions, &kept), report)
    }
}

/// The mesh without the vertices that no triangle uses; the rest keeps its order.
pub(crate) fn without_unused(mesh: TriangleMesh) -> TriangleMesh {
    let mut used = vec![false; mesh.positions.len()];
    for &v in mesh.triangles.as_flattened() {
        used[v as usize] = true;
    }
    if used.contains(&false) {
        compacted(&mesh.positions, &mesh.triangles)
    } else {
        mesh
    }
}

/// Only the vertices that `triangles` use, in their old order.
pub(crate) fn compacted(positions: &[DVec3], triangles: &[[u32; 3]]) -> TriangleMesh {
    let mut new_index = vec![u32::MAX; positions.len()];
    for &v in triangles.iter().flatten() {
        new_index[v as usize] = 0;
    }
    let mut kept = Vec::new();
    for (slot, &p) in new_index.iter_mut().zip(positions) {
        if *slot == 0 {
            *slot =
                u32::try_from(kept.len()).expect("a checked mesh has fewer vertices than u32::MAX");
            kept.push(p);
        }
    }
    let triangles = triangles
        .iter()
        .map(|t| t.map(|v| new_index[v as usize]))
        .collect();
    TriangleMesh::trusted(kept, triangles)
}

/// For each vertex the first kept one within `tolerance`: a grid of cells as wide as the tolerance, so that
/// only the 27 cells around a vertex can hold one.
fn nearby_targets(positions: &[DVec3], tolerance: f64) -> Vec<u32> {
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut target = Vec::with_capacity(positions.len());
    for (i, &p) in (0..).zip(positions) {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "saturates: beyond 2^63 cells the coordinates are equal within the tolerance or never near"
        )]
        let cell = (p / tolerance).floor().to_array().map(|x| x as i64);
        let near = neighbour_cells(cell)
            .filter_map(|c| cells.get(&c))
            .flatten()
            .copied()
            .filter(|&v| positions[v as usize].distance(p) <= tolerance)
            .min();
        if near.is_none() {
            cells.entry(cell).or_default().push(i);
        }
        target.push(near.unwrap_or(i));
    }
    target
}

fn neighbour_cells([x, y, z]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27_i64).map(move |k| {
        [
            x.saturating_add(k % 3 - 1),
            y.saturating_add(k / 3 % 3 - 1),
            z.saturating_add(k / 9 - 1),
        ]
    })
}

#[cfg(test)]
mod tests {
    use super::WeldReport;
    use crate::TriangleMesh;
    use glam::DVec3;

    /// A square of two triangles with six separate vertices, one of them off by `gap`, and a stray vertex.
    fn seam(gap: f64) -> TriangleMesh {
        let positions = vec![
            DVec3::ZERO,
            DVec3::X,
            DVec3::ONE,
            DVec3::splat(7.0),
            DVec3::new(-0.0, gap, 0.0),
            DVec3::ONE,
            DVec3::Y,
        ];
        TriangleMesh::new(positions, vec![[0, 1, 2], [4, 5, 6], [0, 4, 5]]).unwrap()
    }

    #[test]
    fn equal_positions_become_one() {
        let (mesh, report) = seam(0.0).welded(0.0);
        assert_eq!(mesh.triangles(), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions().len(), 4);
        let expected = WeldReport {
            merged_vertices: 2,
            unused_vertices: 1,
            dropped_triangles: 1,
        };
        assert_eq!(report, expected);
    }

    #[test]
    fn tolerance_decides_about_near_positions() {
        assert_eq!(seam(1e-6).welded(0.0).0.positions().len(), 5);
        assert_eq!(seam(1e-6).welded(0.9e-6).0.positions().len(), 5);
        assert_eq!(seam(1e-6).welded(1.1e-6).0.positions().len(), 4);
        assert_eq!(seam(-1e-6).welded(1.1e-6).0.positions().len(), 4);
    }

    #[test]
    fn a_mesh_that_would_vanish_stays() {
        let mesh = seam(0.0);
        assert_eq!(mesh.welded(100.0), (mesh, WeldReport::default()));
    }
}
