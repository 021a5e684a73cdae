//! Objects, tools and a bench that advances the tracker and judges it with fresh collision queries.

use glam::{DMat3, DQuat, DVec3};
use pliant_collision::{SimplexCache, closest_points};
use pliant_contact::{Obstacle, PaperEvent, PaperOutcome, PaperParameters, PaperTracker};
use pliant_mesh::{ConvexMesh, generate};
use pliant_spatial::Pose;

pub(crate) const MM: f64 = 1e-3;

pub(crate) fn mm(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z) * MM
}

/// 100 × 100 × 50 mm; top face at z = 25 mm.
pub(crate) fn cuboid() -> ConvexMesh {
    ConvexMesh::from_triangles(&generate::cuboid(mm(50.0, 50.0, 25.0)).unwrap()).unwrap()
}

/// Half axes 60/50/40 mm, 12,672 faces.
pub(crate) fn ellipsoid() -> ConvexMesh {
    let mesh = generate::latitude_longitude_ellipsoid(mm(60.0, 50.0, 40.0), 96, 67).unwrap();
    assert_eq!(mesh.triangles().len(), 12_672);
    ConvexMesh::from_triangles(&mesh).unwrap()
}

/// Roof with its ridge on the y axis at z = 0 and slopes that fall by `slope` to both sides.
pub(crate) fn gable(slope: f64) -> ConvexMesh {
    let eaves = -50.0 * slope.tan();
    let mut points = Vec::new();
    for y in [-50.0, 50.0] {
        points.push(mm(0.0, y, 0.0));
        for x in [-50.0, 50.0] {
            points.extend([mm(x, y, eaves), mm(x, y, -60.0)]);
        }
    }
    ConvexMesh::hull(&points).unwrap()
}

/// Four-sided pyramid with its apex at the origin whose faces (`corner_turn` = 45°) or edges (0°) fall towards ±x and ±y.
pub(crate) fn pyramid(edge_slope: f64, corner_turn: f64) -> ConvexMesh {
    let mut points = vec![DVec3::ZERO];
    for corner in 0..4 {
        let angle = corner_turn + f64::from(corner) * std::f64::consts::FRAC_PI_2;
        let down = 50.0 * edge_slope.tan();
        points.push(mm(50.0 * angle.cos(), 50.0 * angle.sin(), -down));
    }
    ConvexMesh::hull(&points).unwrap()
}

/// Tip at (100, 0, 0) mm, half angle 2.3°.
pub(crate) fn needle() -> Vec<ConvexMesh> {
    let cone = generate::cone([4.0 * MM, 0.0], 100.0 * MM, 16).unwrap();
    vec![ConvexMesh::from_triangles(&cone).unwrap()]
}

/// Square rod of 100 mm and the given half width, cut into equal segments.
pub(crate) fn rod(half_width: f64, segments: u32) -> Vec<ConvexMesh> {
    let length = 100.0 * MM / f64::from(segments);
    let half = DVec3::new(0.5 * length, half_width, half_width);
    let block = generate::cuboid(half).unwrap();
    (0..segments)
        .map(|k| {
            let center = Pose::from_translation(DVec3::X * (length * (f64::from(k) + 0.5)));
            ConvexMesh::from_triangles(&block.transformed(&center)).unwrap()
        })
        .collect()
}

/// Wedge of 60° with its edge along y, 20 mm long, at the tip (100, ±10, 0) mm.
pub(crate) fn blade() -> Vec<ConvexMesh> {
    let half_width = 20.0 * 30.0_f64.to_radians().tan();
    let mut points = Vec::new();
    for y in [-10.0, 10.0] {
        points.push(mm(100.0, y, 0.0));
        points.extend([mm(80.0, y, half_width), mm(80.0, y, -half_width)]);
    }
    vec![ConvexMesh::hull(&points).unwrap()]
}

/// Rotation that takes handle directions (`along`, `up`) to world directions; each pair orthonormal.
pub(crate) fn aligned(handle: [DVec3; 2], world: [DVec3; 2]) -> DQuat {
    let basis = |[a, b]: [DVec3; 2]| DMat3::from_cols(a, b, a.cross(b));
    DQuat::from_mat3(&(basis(world) * basis(handle).transpose())).normalize()
}

/// Handle +x pointing to world −z, handle y kept.
pub(crate) fn pointing_down() -> DQuat {
    aligned([DVec3::X, DVec3::Y], [DVec3::NEG_Z, DVec3::Y])
}

/// Handle pose at which the tool's point `in_handle` is at `in_world` [m].
pub(crate) fn placed(rotation: DQuat, in_handle: DVec3, in_world: DVec3) -> Pose {
    Pose::new(rotation, in_world - rotation * in_handle)
}

pub(crate) fn obstacle(shape: ConvexMesh, world_from_object: Pose) -> Obstacle {
    Obstacle {
        shape,
        world_from_object,
        shading_threshold: None,
    }
}

/// The box stood on one corner: the opposite one at the origin, its pseudonormal +z, one of its edges falling towards +x.
pub(crate) fn corner_up() -> Obstacle {
    let up = DVec3::ONE.normalize();
    // The box edge from the corner along −x, seen from above, points to +x.
    let across = (DVec3::NEG_X + up * up.x).normalize();
    let turn = aligned([across, up], [DVec3::X, DVec3::Z]);
    obstacle(cuboid(), placed(turn, mm(50.0, 50.0, 25.0), DVec3::ZERO))
}

/// What the judge saw over some ticks.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) events: Vec<PaperEvent>,
    /// Deepest overlap of the visual tool [m].
    pub(crate) deepest: f64,
    /// Widest gap of the visual tool while in contact [m].
    pub(crate) widest: f64,
    /// Ticks in contact.
    pub(crate) contact_ticks: u32,
}

impl Log {
    pub(crate) fn backed_off(&self) -> bool {
        self.events
            .iter()
            .any(|e| matches!(e, PaperEvent::BackedOff { .. }))
    }

    pub(crate) fn slid(&self) -> usize {
        let slides = self.events.iter();
        slides
            .filter(|e| matches!(e, PaperEvent::SlidByRay { .. }))
            .count()
    }
}

pub(crate) struct Bench {
    pub(crate) obstacles: Vec<Obstacle>,
    pub(crate) segments: Vec<ConvexMesh>,
    pub(crate) tracker: PaperTracker,
}

impl Bench {
    pub(crate) fn new(obstacle: Obstacle, segments: Vec<ConvexMesh>, start: Pose) -> Self {
        let parameters = PaperParameters::default();
        Self::with(vec![obstacle], segments, start, &parameters)
    }

    pub(crate) fn with(
        obstacles: Vec<Obstacle>,
        segments: Vec<ConvexMesh>,
        start: Pose,
        parameters: &PaperParameters,
    ) -> Self {
        let tracker = PaperTracker::new(&obstacles, &segments, parameters, start);
        Self {
            obstacles,
            segments,
            tracker,
        }
    }

    pub(crate) fn advance(&mut self, haptic: &Pose) -> PaperOutcome {
        self.tracker
            .advance(&self.obstacles, &self.segments, haptic)
    }

    /// Least signed gap between the tool at `pose` and the objects [m], by fresh queries.
    pub(crate) fn separation(&self, world_from_handle: &Pose) -> f64 {
        let gaps = self.obstacles.iter().flat_map(|obstacle| {
            let placement = obstacle.world_from_object.inverse() * *world_from_handle;
            self.segments.iter().map(move |segment| {
                let mut cache = SimplexCache::default();
                closest_points(&obstacle.shape, segment, &placement, &mut cache).separation
            })
        });
        gaps.fold(f64::INFINITY, f64::min)
    }

    /// Leads the haptic tool in `ticks` even steps from where it is to `end`, turning about the handle point `pivot` [m].
    pub(crate) fn lead_about(&mut self, pivot: DVec3, end: &Pose, ticks: u32) -> Log {
        let start = self.tracker.world_from_haptic();
        let (from, to) = (start.transform_point(pivot), end.transform_point(pivot));
        let mut log = Log {
            events: Vec::new(),
            deepest: 0.0,
            widest: 0.0,
            contact_ticks: 0,
        };
        for tick in 1..=ticks {
            let t = f64::from(tick) / f64::from(ticks);
            let rotation = start.rotation.slerp(end.rotation, t).normalize();
            let outcome = self.advance(&placed(rotation, pivot, from.lerp(to, t)));
            log.events.extend(outcome.events.as_slice());
            if outcome.contact.is_some() {
                let separation = self.separation(&outcome.world_from_visual);
                log.deepest = log.deepest.max(-separation);
                log.widest = log.widest.max(separation);
                log.contact_ticks += 1;
            }
        }
        log
    }

    pub(crate) fn lead(&mut self, end: &Pose, ticks: u32) -> Log {
        self.lead_about(DVec3::ZERO, end, ticks)
    }

    /// Leads the haptic tool by a translation [m].
    pub(crate) fn lead_by(&mut self, motion: DVec3, ticks: u32) -> Log {
        let start = self.tracker.world_from_haptic();
        let end = Pose::new(start.rotation, start.translation + motion);
        self.lead(&end, ticks)
    }
}
