//! A real hand: the recorded stylus that touched eight landmarks, scaled onto hulls of real meshes and the 12,672-face object.

use std::path::PathBuf;

use glam::{DQuat, DVec3};
use pliant_contact::SKIN;
use pliant_device::Trajectory;
use pliant_mesh::{ConvexMesh, load};
use pliant_scene::read_trajectory;
use pliant_sim::{
    Method, Object, State, TickInput, TickOutput, VirtualCoupling, World, WorldDescription, tick,
    visual_penetration,
};
use pliant_spatial::Pose;
use pliant_tests::bodies::{Setting, TOOL_LENGTH, ToolKind};
use pliant_tests::campaign::PERIOD;
use pliant_tests::parry::ParryJudge;
use pliant_tests::skip::skipped;

/// Mean radius every object is scaled to [m].
const RADIUS: f64 = 0.05;

/// The independent library judges every so many ticks.
const JUDGE_INTERVAL: u32 = 200;

fn data(path: &str) -> Option<Vec<u8>> {
    let folder = PathBuf::from(std::env::var_os("PLIANT_DATA")?);
    Some(std::fs::read(folder.join(path)).expect("PLIANT_DATA names the folder of test data"))
}

/// The hull of a mesh file, centred and scaled to the mean radius.
fn hull(path: &str) -> Option<ConvexMesh> {
    let mesh = load::obj(&data(path)?).expect("a good mesh").mesh;
    let raw = ConvexMesh::hull(mesh.positions()).expect("a solid");
    let centre = raw.centroid();
    let mean = raw
        .positions()
        .iter()
        .map(|p| (*p - centre).length())
        .sum::<f64>()
        / raw.positions().len() as f64;
    let points: Vec<DVec3> = raw
        .positions()
        .iter()
        .map(|p| (*p - centre) * (RADIUS / mean))
        .collect();
    Some(ConvexMesh::hull(&points).expect("a solid"))
}

/// The recorded tip motion about its own middle, scaled so that the tip spends half its time within 0.8 of the objects' mean radius.
struct Recording {
    trajectory: Trajectory,
    middle: DVec3,
    scale: f64,
}

impl Recording {
    fn new(bytes: &[u8]) -> Self {
        let trajectory =
            read_trajectory(bytes, "plus_stylus_tip_landmarks_15hz.csv").expect("a good recording");
        let positions: Vec<DVec3> = trajectory.knots().map(|k| k.pose.translation).collect();
        let middle = positions.iter().sum::<DVec3>() / positions.len() as f64;
        let mut distances: Vec<f64> = positions.iter().map(|p| (*p - middle).length()).collect();
        distances.sort_by(f64::total_cmp);
        let scale = 0.8 * RADIUS / distances[distances.len() / 2];
        Self {
            trajectory,
            middle,
            scale,
        }
    }

    /// Ticks that fit into the recording.
    fn ticks(&self) -> u32 {
        let mut ticks = 0;
        while f64::from(ticks + 1) * PERIOD <= self.trajectory.duration() {
            ticks += 1;
        }
        ticks
    }

    /// Handle pose at `time` from the start [s]; the recorded tracker axis that points along the stylus is its local −z, taken to the tool's +x.
    fn handle(&self, time: f64) -> Pose {
        let (pose, _) = self.trajectory.sample(self.trajectory.start() + time);
        let rotation = pose.rotation * DQuat::from_rotation_arc(DVec3::X, -DVec3::Z);
        let tip = (pose.translation - self.middle) * self.scale;
        Pose::new(rotation, tip - rotation * DVec3::X * TOOL_LENGTH)
    }
}

struct Trace {
    bytes: Vec<u8>,
    ticks: u32,
    contact_ticks: u32,
}

/// The independent library sees no overlap a micrometre out along the separating directions, and in contact no gap beyond two skins.
fn judge(world: &World, state: &State, judge: &ParryJudge, output: &TickOutput) {
    let tracker = state.constrained().expect("the constrained method");
    let visual = output.world_from_visual;
    for segment in 0..world.tool().segments.len() {
        let id = u32::try_from(segment).expect("few segments");
        let (normal, _) = tracker.separating_plane(0, id);
        assert!(!judge.overlaps(0, segment, &visual, normal * 1e-6));
    }
    if output.contacts > 0 {
        let nearest = judge.nearest(&visual);
        assert!(
            (0.25 * SKIN..2.0 * SKIN).contains(&nearest),
            "{nearest} m apart in contact"
        );
    }
}

fn run(shape: ConvexMesh, segments: u32, recording: &Recording) -> Trace {
    let world = World::new(WorldDescription {
        tool: ToolKind::Cone.tool(segments),
        objects: vec![Object {
            name: "object".to_owned(),
            shape,
            world_from_object: Pose::IDENTITY,
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })
    .expect("valid");
    let parry = ParryJudge::new(&world, &ToolKind::Cone.tool(1).segments[0]);
    let mut state = State::new(&world, recording.handle(0.0));
    let mut trace = Trace {
        bytes: Vec::new(),
        ticks: recording.ticks(),
        contact_ticks: 0,
    };
    for index in 1..=trace.ticks {
        let input = TickInput {
            world_from_haptic: recording.handle(f64::from(index) * PERIOD),
        };
        let output = tick(&world, &mut state, &input, PERIOD);
        trace.contact_ticks += u32::from(output.contacts > 0);
        assert!(visual_penetration(&world, &state) <= 1e-9, "tick {index}");
        assert!(!output.held && !output.capped, "tick {index}");
        if index % JUDGE_INTERVAL == 0 {
            judge(&world, &state, &parry, &output);
        }
        let wrench = output.wrench;
        for v in [
            wrench.force,
            wrench.torque,
            output.world_from_visual.translation,
        ] {
            trace
                .bytes
                .extend(v.to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
    }
    trace
}

#[test]
fn the_recorded_stylus_runs_over_real_shapes_with_the_same_bytes_twice() {
    let Some(motion) = data("trajectories/plus_stylus_tip_landmarks_15hz.csv") else {
        skipped(4, "PLIANT_DATA is not set");
        return;
    };
    let recording = Recording::new(&motion);
    let ellipsoid = Setting::LatitudeLongitude.objects().remove(0).shape;
    let spot = hull("meshes/spot.obj").expect("data");
    let molar = hull("meshes/derived_molar_access_mm_55k.obj").expect("data");
    let cases = [
        ("ellipsoid", ellipsoid, 1),
        ("spot", spot.clone(), 1),
        ("spot", spot, 10),
        ("molar", molar, 1),
    ];
    for (name, shape, segments) in cases {
        let first = run(shape.clone(), segments, &recording);
        assert!(first.ticks > 66_000, "{}", first.ticks);
        let share = f64::from(first.contact_ticks) / f64::from(first.ticks);
        assert!(
            3.0 * share >= 1.0,
            "{name}, {segments} segments: contact in {share:.3} of all ticks, a third asked"
        );
        let second = run(shape, segments, &recording);
        assert!(
            first.bytes == second.bytes,
            "{name}, {segments} segments, contact in {share:.3} of all ticks: two runs differ"
        );
    }
}
