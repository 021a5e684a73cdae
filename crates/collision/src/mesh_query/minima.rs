//! Which of the triangles within reach are local minima of the separation; the definition is at
//! [`TriangleBvh::contacts`](crate::TriangleBvh::contacts).
//!
//! Everything is decided per mesh vertex and per mesh edge, in an open-addressing table that is emptied by counting up,
//! so the cost is linear in the triangles within reach also where a thousand of them share one vertex.

use glam::DVec3;
use pliant_mesh::TriangleMesh;

use crate::ClosestPoints;
use crate::bvh::TriangleBvh;

use super::{MeshContact, MeshFeature};

/// Corners of a triangle within this much of the highest one along the normal, relative to the triangle's size, count as
/// touched too. Far above the rounding of normals, far below any angle of consequence.
const LEVEL: f64 = 1e-9;

/// Normals of one plateau differ by rounding only, or by what ill-conditioned features leave.
const SAME_NORMAL: f64 = 1e-6;

/// No vertex: edges are keyed by two vertices, a vertex by itself and this.
const NONE: u32 = u32::MAX;

/// Marks the end of a chain of plateaus.
const END: u32 = u32::MAX;

/// Entries of the table per triangle: enough for the six vertices and edges of one that shares none; on a closed mesh,
/// with two per triangle, the table is at most a third full and probes are short.
const ROOM: usize = 7;

/// The lowest separation seen at each vertex and edge, and the plateaus that reach it.
#[derive(Debug, Default)]
pub(super) struct Minima {
    entries: Vec<Entry>,
    /// Generation of the entries that count.
    round: u32,
    kept: Vec<Kept>,
    links: Vec<Link>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    key: [u32; 2],
    round: u32,
    /// Head of the chain of plateaus.
    chain: u32,
    lowest: f64,
}

/// A local minimum with its plateau as a union-find tree.
#[derive(Clone, Copy, Debug)]
struct Kept {
    hit: u32,
    parent: u32,
}

/// A plateau that reaches a vertex.
#[derive(Clone, Copy, Debug)]
struct Link {
    kept: u32,
    next: u32,
}

/// Feature of a triangle that its supporting plane along `normal` touches.
pub(super) fn touched(
    bvh: &TriangleBvh,
    mesh: &TriangleMesh,
    triangle: u32,
    normal: DVec3,
) -> MeshFeature {
    let corners = mesh.corners(triangle);
    let vertices = mesh.triangles()[triangle as usize].map(|vertex| bvh.welded(vertex));
    let heights = corners.map(|corner| normal.dot(corner - corners[0]));
    let size = (corners[1] - corners[0])
        .abs()
        .max((corners[2] - corners[0]).abs())
        .max_element();
    let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - LEVEL * size;
    let mut found = [NONE; 3];
    let mut count = 0;
    for (vertex, height) in vertices.into_iter().zip(heights) {
        if height >= top && !found[..count].contains(&vertex) {
            found[count] = vertex;
            count += 1;
        }
    }
    match count {
        1 => MeshFeature::Vertex(found[0]),
        2 => MeshFeature::Edge([found[0].min(found[1]), found[0].max(found[1])]),
        _ => MeshFeature::Face,
    }
}

impl Minima {
    /// Writes the local minima among `hits` to `minima`; `tolerance` [m] is what rounding may add to a separation (collision.46).
    pub(super) fn select(
        &mut self,
        (bvh, mesh): (&TriangleBvh, &TriangleMesh),
        hits: &[MeshContact],
        tolerance: f64,
        minima: &mut Vec<MeshContact>,
    ) {
        minima.clear();
        self.kept.clear();
        self.links.clear();
        if hits.len() == 1 {
            minima.push(hits[0]);
            return;
        }
        self.clear_for(hits.len());
        let vertices_of = |hit: &MeshContact| {
            mesh.triangles()[hit.triangle as usize].map(|vertex| bvh.welded(vertex))
        };
        for hit in hits {
            let [a, b, c] = vertices_of(hit);
            for key in [
                [a, NONE],
                [b, NONE],
                [c, NONE],
                edge(a, b),
                edge(b, c),
                edge(c, a),
            ] {
                let entry = self.entry(key);
                entry.lowest = entry.lowest.min(hit.closest.separation);
            }
        }
        for (index, hit) in (0..).zip(hits) {
            let lowest = match hit.feature {
                MeshFeature::Vertex(vertex) => self.entry([vertex, NONE]).lowest,
                MeshFeature::Edge(edge) => self.entry(edge).lowest,
                MeshFeature::Face => f64::INFINITY,
            };
            if lowest < hit.closest.separation - tolerance {
                continue;
            }
            let (vertices, count) = match hit.feature {
                MeshFeature::Vertex(vertex) => ([vertex; 3], 1),
                MeshFeature::Edge([a, b]) => ([a, b, b], 2),
                MeshFeature::Face => (vertices_of(hit), 3),
            };
            self.keep(index, &vertices[..count], hits, tolerance);
        }
        for index in 0..self.kept.len() {
            let kept = self.kept[index];
            // The root of a plateau is its first member.
            if kept.parent as usize == index {
                minima.push(hits[kept.hit as usize]);
            }
        }
    }

    /// Joins a local minimum to the plateaus that reach the vertices it touches.
    fn keep(&mut self, hit: u32, vertices: &[u32], hits: &[MeshContact], tolerance: f64) {
        let own = index(self.kept.len());
        self.kept.push(Kept { hit, parent: own });
        let closest = &hits[hit as usize].closest;
        for &vertex in vertices {
            let mut link = self.entry([vertex, NONE]).chain;
            let mut joined = false;
            while link != END && !joined {
                let Link { kept, next } = self.links[link as usize];
                let other = &hits[self.kept[kept as usize].hit as usize].closest;
                if level(closest, other, tolerance) {
                    self.join(own, kept);
                    joined = true;
                }
                link = next;
            }
            if !joined {
                let new = index(self.links.len());
                let entry = self.entry([vertex, NONE]);
                let next = entry.chain;
                entry.chain = new;
                self.links.push(Link { kept: own, next });
            }
        }
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.kept[a.max(b) as usize].parent = a.min(b);
    }

    fn root(&mut self, mut of: u32) -> u32 {
        while self.kept[of as usize].parent != of {
            let grand = self.kept[self.kept[of as usize].parent as usize].parent;
            self.kept[of as usize].parent = grand;
            of = grand;
        }
        of
    }

    /// An empty table with room for the vertices and edges of so many triangles.
    fn clear_for(&mut self, triangles: usize) {
        const VOID: Entry = Entry {
            key: [NONE; 2],
            round: 0,
            chain: END,
            lowest: f64::INFINITY,
        };
        let room = (ROOM * triangles).next_power_of_two();
        if self.entries.len() < room || self.round == u32::MAX {
            let room = room.max(self.entries.len());
            self.entries.clear();
            self.entries.resize(room, VOID);
            self.round = 0;
        }
        self.round += 1;
    }

    /// The entry of a key, made if need be.
    fn entry(&mut self, key: [u32; 2]) -> &mut Entry {
        let mask = self.entries.len() - 1;
        let mut slot = hash(key) & mask;
        while self.entries[slot].round == self.round && self.entries[slot].key != key {
            slot = (slot + 1) & mask;
        }
        let entry = &mut self.entries[slot];
        if entry.round != self.round {
            *entry = Entry {
                key,
                round: self.round,
                chain: END,
                lowest: f64::INFINITY,
            };
        }
        entry
    }
}

/// The same separation and normal.
fn level(a: &ClosestPoints, b: &ClosestPoints, tolerance: f64) -> bool {
    (a.separation - b.separation).abs() <= tolerance
        && (a.normal - b.normal).abs().max_element() <= SAME_NORMAL
}

fn edge(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Fibonacci hashing (Knuth 1998, §6.4) of the two numbers.
fn hash([a, b]: [u32; 2]) -> usize {
    let key = u64::from(a) << 32 | u64::from(b);
    let mixed = (key ^ key >> 31).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (mixed >> 32) as usize
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "there are fewer contacts than triangles, which u32 counts"
)]
fn index(of: usize) -> u32 {
    of as u32
}
