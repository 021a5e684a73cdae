//! A mesh cut across x into neighbouring slices, from its lowest x on: one sweep over vertices and edges, however many
//! slices there are.

use glam::DVec3;
use pliant_mesh::TriangleMesh;

/// Where the sweep stands. Holds each vertex and edge once; what it hands out is no more than the next slice.
pub(super) struct Slices<'a> {
    positions: &'a [DVec3],
    /// Ascending in x.
    vertices: Vec<u32>,
    /// Those that cross a border: lower end first, ascending in x of that end.
    edges: Vec<[u32; 2]>,
    /// How many of `edges` begin below `start`.
    begun: usize,
    /// Those of them that end above it.
    open: Vec<[u32; 2]>,
    /// Ends of the slices to come [m].
    ends: std::vec::IntoIter<f64>,
    /// Where the last slice ended [m], and where `open` edges cross that border.
    start: f64,
    border: Vec<DVec3>,
}

impl<'a> Slices<'a> {
    /// Slices that end at `ends` [m], in ascending order; each begins where the one before ends.
    pub(super) fn new(mesh: &'a TriangleMesh, ends: Vec<f64>) -> Self {
        let positions = mesh.positions();
        let x = |v: u32| positions[v as usize].x;
        let mut vertices: Vec<u32> = (0..).take(positions.len()).collect();
        vertices.sort_unstable_by(|&a, &b| x(a).total_cmp(&x(b)));
        // On a fine mesh most edges lie within a slice: what is left is quickly sorted.
        let crosses = |&[low, high]: &[u32; 2]| {
            let first_above = ends.partition_point(|&end| end <= x(low));
            ends.get(first_above).is_some_and(|&end| end < x(high))
        };
        let mut edges: Vec<[u32; 2]> = mesh
            .triangles()
            .iter()
            .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
            .map(|[a, b]| if x(a) < x(b) { [a, b] } else { [b, a] })
            .filter(crosses)
            .collect();
        edges.sort_unstable_by(|p, q| x(p[0]).total_cmp(&x(q[0])).then_with(|| p.cmp(q)));
        edges.dedup();
        Self {
            positions,
            vertices,
            edges,
            begun: 0,
            open: Vec::new(),
            ends: ends.into_iter(),
            start: mesh.bounds().min.x,
            border: Vec::new(),
        }
    }

    /// Moves the sweep to a border.
    fn cross(&mut self, border: f64) {
        let at = |v: u32| self.positions[v as usize];
        while let Some(&edge) = self.edges.get(self.begun)
            && at(edge[0]).x < border
        {
            self.open.push(edge);
            self.begun += 1;
        }
        self.open.retain(|&[_, high]| at(high).x > border);
        let crossings = self.open.iter().map(|&[low, high]| {
            let (low, high) = (at(low), at(high));
            let crossing = low.lerp(high, (border - low.x) / (high.x - low.x));
            DVec3::new(border, crossing.y, crossing.z)
        });
        self.border = crossings.collect();
    }
}

impl Iterator for Slices<'_> {
    /// The points whose hull is that of the part of the mesh in the slice [m]: vertices there, and where edges cross both
    /// borders.
    type Item = Vec<DVec3>;

    fn next(&mut self) -> Option<Vec<DVec3>> {
        let end = self.ends.next()?;
        let x = |v: u32| self.positions[v as usize].x;
        let from = self.vertices.partition_point(|&v| x(v) < self.start);
        let to = self.vertices.partition_point(|&v| x(v) <= end);
        let mut inside = self.vertices[from..to.max(from)].to_vec();
        // The vertices of a hull keep the order of its points: let it be that of the mesh.
        inside.sort_unstable();
        let mut points: Vec<DVec3> = inside.iter().map(|&v| self.positions[v as usize]).collect();
        points.append(&mut self.border);
        self.cross(end);
        points.extend(&self.border);
        self.start = end;
        Some(points)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::Slices;
    use glam::{DQuat, DVec3};
    use pliant_mesh::{TriangleMesh, generate};
    use pliant_spatial::Pose;

    /// The definition: every vertex and every edge asked for every slice.
    fn slice(mesh: &TriangleMesh, start: f64, end: f64) -> Vec<DVec3> {
        let positions = mesh.positions();
        let within = positions.iter().filter(|p| (start..=end).contains(&p.x));
        let mut points: Vec<DVec3> = within.copied().collect();
        let edges: BTreeSet<(u32, u32)> = mesh
            .triangles()
            .iter()
            .flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)])
            .map(|(a, b)| (a.min(b), a.max(b)))
            .collect();
        for (a, b) in edges {
            let (a, b) = (positions[a as usize], positions[b as usize]);
            for border in [start, end] {
                if a.x.min(b.x) < border && border < a.x.max(b.x) {
                    let part = (border - a.x) / (b.x - a.x);
                    let crossing = a + part * (b - a);
                    points.push(DVec3::new(border, crossing.y, crossing.z));
                }
            }
        }
        points
    }

    /// Compared as sets: on a grid finer than any feature, coarser than rounding.
    fn rounded(points: &[DVec3]) -> Vec<DVec3> {
        // Plus 0: there is no -0 on the grid.
        let on_grid = |p: &DVec3| (p * 1e9).round() + DVec3::ZERO;
        let mut points: Vec<DVec3> = points.iter().map(on_grid).collect();
        points.sort_unstable_by(|p, q| p.to_array().partial_cmp(&q.to_array()).unwrap());
        points
    }

    #[test]
    fn slices_of_one_sweep_are_those_of_the_definition() {
        let turn = Pose::from_rotation(DQuat::from_rotation_z(0.4));
        let shapes = [
            generate::capsule(0.01, 0.1, 7, 5).unwrap(),
            generate::tube(0.02, 0.01, 0.1, 9).unwrap(),
            // Vertices on borders, and edges that cross all of them.
            generate::cuboid(DVec3::new(0.05, 0.02, 0.01)).unwrap(),
            generate::fibonacci_ellipsoid(DVec3::new(0.05, 0.01, 0.02), 300).unwrap(),
        ];
        for shape in shapes {
            for mesh in [shape.transformed(&turn), shape] {
                let (low, high) = (mesh.bounds().min.x, mesh.bounds().max.x);
                for count in [1, 2, 7, 64] {
                    let border = |i: u32| low + (high - low) * f64::from(i) / f64::from(count);
                    let mut slices = Slices::new(&mesh, (1..=count).map(border).collect());
                    for index in 0..count {
                        let points = slices.next().unwrap();
                        let expected = slice(&mesh, border(index), border(index + 1));
                        assert_eq!(rounded(&points), rounded(&expected), "{index} of {count}");
                    }
                }
            }
        }
    }
}
