//! Placements of one shape at another, by the oracle's eyes: nothing here asks the crate under test.

use glam::{DQuat, DVec3};
use pliant_spatial::Pose;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::families::{power, rotation};
use super::kinds::unit;
use super::shape::Shape;
use super::truth::Oracle;

/// Two shapes about to be placed.
pub struct Placement<'s> {
    /// At rest.
    pub a: &'s Shape,
    /// To be placed.
    pub b: &'s Shape,
    /// What gaps and depths are relative to [m].
    pub size: f64,
    /// Source of all choices.
    pub random: &'s mut ChaCha8Rng,
}

impl Placement<'_> {
    /// At a gap of 1e-12 to 1 of the size.
    pub fn apart(&mut self) -> Pose {
        let gap = self.size * power(self.random, -12.0, 0.0);
        self.imposed(gap)
    }

    /// At a depth of 1e-12 to 0.5 of the size.
    pub fn penetrating(&mut self) -> Pose {
        let depth = self.size * power(self.random, -12.0, -0.3);
        self.imposed(-depth)
    }

    /// A vertex of B on a vertex of A; with radii, the balls about them touching.
    pub fn vertex_on_vertex(&mut self) -> Pose {
        let turn = self.turn();
        let [p, q] = [self.a, self.b].map(|shape| {
            let vertices = &shape.core.vertices;
            vertices[self.random.random_range(0..vertices.len())]
        });
        let reach = unit(self.random) * (self.a.radius + self.b.radius);
        Pose::new(turn, p - turn * q + reach)
    }

    /// A face of B against a face of A, `tilt` [rad] from parallel, at a small gap of either sign or none.
    pub fn parallel_faces(&mut self, tilt: f64) -> Pose {
        let [n, m] = [self.a, self.b].map(|shape| {
            let faces = &shape.core.triangles;
            if faces.is_empty() {
                unit(self.random)
            } else {
                faces[self.random.random_range(0..faces.len())].normal
            }
        });
        let spin = DQuat::from_axis_angle(n, self.random.random_range(0.0..6.0));
        let turn = self.tilted(spin * DQuat::from_rotation_arc(m, -n), tilt);
        self.across(turn, n)
    }

    /// An edge of B along an edge of A, `tilt` [rad] from parallel, at a small gap of either sign or none.
    pub fn parallel_edges(&mut self, tilt: f64) -> Pose {
        let [p, q] = [self.a, self.b].map(|shape| {
            let edges = &shape.core.edges;
            let edge = edges[self.random.random_range(0..edges.len())];
            let [from, to] = edge.ends.map(|end| shape.core.vertices[end as usize]);
            (to - from).try_normalize().unwrap_or(DVec3::Z)
        });
        let spin = DQuat::from_axis_angle(p, self.random.random_range(0.0..6.0));
        let turn = self.tilted(spin * DQuat::from_rotation_arc(q, p), tilt);
        let across = DQuat::from_axis_angle(p, self.random.random_range(0.0..6.0));
        self.across(turn, across * p.any_orthonormal_vector())
    }

    /// Flat shapes in the plane z = 0, beside each other, touching or overlapping.
    pub fn in_one_plane(&mut self) -> Pose {
        let angle = match self.random.random_range(0..3) {
            0 => 0.0,
            1 => std::f64::consts::FRAC_PI_2,
            _ => self.random.random_range(0.0..6.0),
        };
        let turn = DQuat::from_rotation_z(angle);
        let heading = self.random.random_range(0.0..6.0_f64);
        let direction = DVec3::new(heading.cos(), heading.sin(), 0.0);
        let gap = self.small_gap();
        let mut pose = self.slab(turn, direction, gap);
        if self.random.random() {
            pose.translation *= self.random.random_range(0.0..1.0);
        }
        pose
    }

    /// Quarter turns about the axes; along each axis centred, flush inside or outside, or anyhow.
    pub fn along_axes(&mut self) -> Pose {
        let quarter = std::f64::consts::FRAC_PI_2;
        let turn = match self.random.random_range(0..6) {
            0..3 => DQuat::IDENTITY,
            3 => DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0),
            4 => DQuat::from_rotation_z(quarter),
            _ => DQuat::from_rotation_x(quarter) * DQuat::from_rotation_y(quarter),
        };
        let bounds = |shape: &Shape, turn: DQuat| {
            let points = shape.core.vertices.iter().map(|&v| turn * v);
            let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            let (low, high) = points.fold(none, |(low, high), p| (low.min(p), high.max(p)));
            (low - shape.radius, high + shape.radius)
        };
        let a = bounds(self.a, DQuat::IDENTITY);
        let b = bounds(self.b, turn);
        let mut translation = DVec3::ZERO;
        for axis in 0..3 {
            translation[axis] = match self.random.random_range(0..6) {
                0 => a.1[axis] - b.0[axis],
                1 => a.0[axis] - b.1[axis],
                2 => a.1[axis] - b.1[axis],
                3 => a.0[axis] - b.0[axis],
                4 => self.random.random_range(-1.0..1.0) * self.size + a.0[axis] - b.0[axis],
                _ => 0.5 * (a.0[axis] + a.1[axis] - b.0[axis] - b.1[axis]),
            };
        }
        Pose::new(turn, translation)
    }

    /// The same frame, or one turned or moved by next to nothing, or by a half turn.
    pub fn almost_same_place(&mut self) -> Pose {
        let turn = match self.random.random_range(0..5) {
            0 | 1 => DQuat::IDENTITY,
            2 => DQuat::from_xyzw(0.0, 0.0, 1.0, 0.0),
            3 => self.tilted(DQuat::IDENTITY, 1e-3),
            _ => {
                let tilt = power(self.random, -16.0, -6.0);
                self.tilted(DQuat::IDENTITY, tilt)
            }
        };
        let translation = match self.random.random_range(0..4) {
            0 | 1 => DVec3::ZERO,
            2 => unit(self.random) * (self.size * power(self.random, -16.0, -6.0)),
            _ => unit(self.random) * (self.size * power(self.random, -2.0, 0.0)),
        };
        Pose::new(turn, translation)
    }

    /// Centres at one point, or apart by rounding.
    pub fn concentric(&mut self) -> Pose {
        let turn = self.turn();
        let [p, q] = [self.a, self.b].map(centre);
        let noise = match self.random.random_range(0..3) {
            0 => unit(self.random) * (1e-15 * self.size),
            _ => DVec3::ZERO,
        };
        Pose::new(turn, p - turn * q + noise)
    }

    /// B's centre somewhere in A.
    pub fn inside(&mut self) -> Pose {
        let turn = self.turn();
        let vertices = &self.a.core.vertices;
        let mut at = DVec3::ZERO;
        let mut total = 0.0;
        for _ in 0..4 {
            let weight: f64 = self.random.random_range(0.0..1.0);
            at += vertices[self.random.random_range(0..vertices.len())] * weight;
            total += weight;
        }
        Pose::new(turn, at / total - turn * centre(self.b))
    }

    /// On top of each other along z, `tilt` [rad] from parallel, the slab between them empty or as thin as rounding.
    pub fn stacked(&mut self, tilt: f64) -> Pose {
        let turn = self.tilted(DQuat::IDENTITY, tilt);
        let gap = match self.random.random_range(0..3) {
            0 => self.size * self.random.random_range(-1.0..1.0) * 1e-14,
            _ => 0.0,
        };
        let mut pose = self.slab(turn, DVec3::Z, gap);
        let shift = unit(self.random) * (0.3 * self.size * self.random.random_range(0.0..1.0));
        pose.translation += DVec3::new(shift.x, shift.y, 0.0);
        pose
    }

    fn turn(&mut self) -> DQuat {
        match self.random.random_range(0..4) {
            0 => DQuat::IDENTITY,
            _ => rotation(self.random),
        }
    }

    fn tilted(&mut self, turn: DQuat, tilt: f64) -> DQuat {
        if tilt == 0.0 {
            return turn.normalize();
        }
        (DQuat::from_scaled_axis(unit(self.random) * tilt) * turn).normalize()
    }

    /// None, or 1e-15 to 0.5 of the size either way.
    fn small_gap(&mut self) -> f64 {
        let gap = self.size * power(self.random, -15.0, -0.3);
        match self.random.random_range(0..4) {
            0 | 1 => 0.0,
            2 => gap,
            _ => -gap,
        }
    }

    /// Across a direction at a small gap, moved sideways at random.
    fn across(&mut self, turn: DQuat, direction: DVec3) -> Pose {
        let gap = self.small_gap();
        let mut pose = self.slab(turn, direction, gap);
        let side = unit(self.random) * (self.size * self.random.random_range(0.0..0.7));
        pose.translation += side - direction * side.dot(direction);
        pose
    }

    /// Centres on a line along `direction`, supporting planes across it `gap` [m] apart.
    fn slab(&self, turn: DQuat, direction: DVec3, gap: f64) -> Pose {
        let [p, q] = [self.a, self.b].map(centre);
        let reach = self.a.height(p, direction) + self.b.height(q, turn.conjugate() * -direction);
        Pose::new(turn, p - turn * q + direction * (reach + gap))
    }

    /// At a signed distance, exactly so if positive, and roughly if the way out stays the same.
    fn imposed(&mut self, separation: f64) -> Pose {
        let turn = rotation(self.random);
        let direction = unit(self.random);
        let mut pose = self.slab(turn, direction, 0.1 * self.size);
        let side = unit(self.random) * (self.size * self.random.random_range(0.0..0.4));
        pose.translation += side - direction * side.dot(direction);
        let (cores, normal) = Oracle::new(self.a, self.b, &pose).signed_distance();
        let now = cores - (self.a.radius + self.b.radius);
        pose.translation -= normal * (now - separation);
        pose
    }
}

/// Mean of the vertices: in the hull.
fn centre(shape: &Shape) -> DVec3 {
    let vertices = &shape.core.vertices;
    let origin = vertices[0];
    let sum: DVec3 = vertices.iter().map(|&v| v - origin).sum();
    origin + sum / vertices.len() as f64
}
