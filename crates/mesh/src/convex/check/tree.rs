//! Boxes over vertices, halved along their longest side: the vertex farthest along a direction by branch
//! and bound.

use glam::DVec3;

use crate::Aabb;

/// Vertices per leaf; below this a box test costs more than it saves.
const LEAF: usize = 8;

pub(super) struct VertexTree {
    /// Leaves: `count` vertices from `start`. Inner nodes: the children `index + 1` and `start`.
    nodes: Vec<Node>,
    points: Vec<(u32, DVec3)>,
}

struct Node {
    center: DVec3,
    half: DVec3,
    start: usize,
    /// Zero for inner nodes.
    count: usize,
}

impl VertexTree {
    pub(super) fn new(positions: &[DVec3]) -> Self {
        let mut tree = Self {
            nodes: Vec::new(),
            points: (0..).zip(positions.iter().copied()).collect(),
        };
        tree.split(0, positions.len());
        tree
    }

    /// The highest vertex with `normal · p > offset` and its height over that plane [m], if any (mesh.10).
    pub(super) fn highest_above(&self, normal: DVec3, offset: f64) -> Option<(u32, f64)> {
        let spread = normal.abs();
        let mut best = None;
        let mut limit = offset;
        let mut stack = vec![0];
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index];
            if normal.dot(node.center) + spread.dot(node.half) <= limit {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.start, index + 1]);
                continue;
            }
            for &(vertex, p) in &self.points[node.start..node.start + node.count] {
                let height = normal.dot(p);
                if height > limit {
                    limit = height;
                    best = Some((vertex, height - offset));
                }
            }
        }
        best
    }

    fn split(&mut self, start: usize, end: usize) {
        let points = &mut self.points[start..end];
        let bounds = points.iter().fold(Aabb::EMPTY, |b, &(_, p)| b.including(p));
        let node = Node {
            center: bounds.center(),
            half: 0.5 * bounds.size(),
            start,
            count: if points.len() <= LEAF {
                points.len()
            } else {
                0
            },
        };
        let index = self.nodes.len();
        self.nodes.push(node);
        if points.len() <= LEAF {
            return;
        }
        let axis = bounds.size().max_position();
        let middle = points.len() / 2;
        points.select_nth_unstable_by(middle, |p, q| {
            p.1[axis].total_cmp(&q.1[axis]).then(p.0.cmp(&q.0))
        });
        self.split(start, start + middle);
        self.nodes[index].start = self.nodes.len();
        self.split(start + middle, end);
    }
}

#[cfg(test)]
mod tests {
    use super::VertexTree;
    use glam::DVec3;

    #[test]
    fn agrees_with_a_scan() {
        let points: Vec<DVec3> = (0..500)
            .map(|i| {
                let t = f64::from(i);
                DVec3::new((t * 1.3).sin(), (t * 2.7).sin() * 3.0, (t * 0.9).cos())
            })
            .collect();
        let tree = VertexTree::new(&points);
        for i in 0..100 {
            let t = f64::from(i);
            let d = DVec3::new(t.sin(), (t * 1.7).cos(), (t * 0.3).sin()).normalize();
            let scan = points
                .iter()
                .map(|p| p.dot(d))
                .fold(f64::NEG_INFINITY, f64::max);
            let (vertex, height) = tree.highest_above(d, scan - 0.5).unwrap();
            assert!((height - 0.5).abs() < 1e-15);
            assert!((points[vertex as usize].dot(d) - scan).abs() < 1e-15);
            assert_eq!(tree.highest_above(d, scan), None);
        }
    }
}
