//! A world and devices to test with: a small box pressed onto a large one and slid across its edge.

use std::sync::{Arc, Mutex, PoisonError};

use glam::{DQuat, DVec3};
use pliant_device::{
    DeviceError, DeviceInfo, DeviceState, HapticDevice, ScriptedDevice, TimedPose, Trajectory,
    WorkspaceMap,
};
use pliant_mesh::{ConvexMesh, generate};
use pliant_sim::{Method, Object, Tool, VirtualCoupling, World, WorldDescription};
use pliant_spatial::{Pose, Wrench};

use crate::{Rate, ServoParts};

/// Half the edge of the tool [m]; its handle is its centre.
pub(crate) const TOOL_HALF: f64 = 0.005;

/// A tool of 10 mm over a block of 100 mm whose top is z = 0, coupled by 1000 N/m.
pub(crate) fn world() -> World {
    let cuboid =
        |half: DVec3| ConvexMesh::from_triangles(&generate::cuboid(half).unwrap()).unwrap();
    World::new(WorldDescription {
        tool: Tool {
            segments: vec![cuboid(DVec3::splat(TOOL_HALF))],
        },
        objects: vec![Object {
            name: "block".into(),
            shape: cuboid(DVec3::splat(0.05)),
            world_from_object: Pose::from_translation(DVec3::Z * -0.05),
            shading_threshold: None,
        }],
        coupling: VirtualCoupling::default(),
        method: Method::Constrained,
    })
    .unwrap()
}

/// Down onto the block, along x over its edge with a turn, in 0.4 s.
pub(crate) fn press_and_slide() -> Trajectory {
    let rows = [
        (0.0, DVec3::new(0.0, 0.0, 0.02), 0.0),
        (0.1, DVec3::new(0.0, 0.0, 0.003), 0.0),
        (0.2, DVec3::new(0.03, 0.01, 0.002), 0.4),
        (0.3, DVec3::new(0.05, 0.01, 0.002), 0.8),
        (0.4, DVec3::new(0.07, 0.0, 0.0), 0.8),
    ];
    let samples = rows.map(|(time, position, angle)| TimedPose {
        time,
        pose: Pose::new(
            DQuat::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), angle),
            position,
        ),
    });
    Trajectory::new(&samples).unwrap()
}

/// Down onto the block within 50 ms, then held 2 mm deep.
pub(crate) fn press() -> Trajectory {
    let samples = [(0.0, 0.01), (0.05, 0.003)].map(|(time, height)| TimedPose {
        time,
        pose: Pose::from_translation(DVec3::Z * height),
    });
    Trajectory::new(&samples).unwrap()
}

/// Held still at `position` [m].
pub(crate) fn still(position: DVec3) -> Trajectory {
    Trajectory::new(&[TimedPose {
        time: 0.0,
        pose: Pose::from_translation(position),
    }])
    .unwrap()
}

/// The world above with a scripted device, at 1 kHz, device frame and world the same.
pub(crate) fn parts(trajectory: Trajectory) -> ServoParts {
    ServoParts {
        world: world(),
        device: Box::new(ScriptedDevice::new("script", trajectory)),
        map: WorkspaceMap::IDENTITY,
        rate: Rate::DEFAULT,
    }
}

/// What a [`FaultyDevice`] was sent, and when it is to fail.
#[derive(Default)]
pub(crate) struct Probe {
    pub(crate) read_times: Vec<f64>,
    pub(crate) written: Vec<Wrench>,
    /// Reads from this one on fail.
    pub(crate) disconnected_at: Option<usize>,
    /// Reads from this one on give a quaternion of zeros.
    pub(crate) garbage_at: Option<usize>,
    /// This write is refused.
    pub(crate) refused_at: Option<usize>,
}

/// A scripted device that fails on demand and is watched from outside.
pub(crate) struct FaultyDevice {
    inner: ScriptedDevice,
    probe: Arc<Mutex<Probe>>,
}

impl FaultyDevice {
    pub(crate) fn new(trajectory: Trajectory, probe: Probe) -> (Box<Self>, Arc<Mutex<Probe>>) {
        let probe = Arc::new(Mutex::new(probe));
        let device = Self {
            inner: ScriptedDevice::new("faulty", trajectory),
            probe: Arc::clone(&probe),
        };
        (Box::new(device), probe)
    }
}

impl HapticDevice for FaultyDevice {
    fn info(&self) -> &DeviceInfo {
        self.inner.info()
    }

    fn read(&mut self, time_s: f64) -> Result<DeviceState, DeviceError> {
        let mut probe = self.probe.lock().unwrap_or_else(PoisonError::into_inner);
        let count = probe.read_times.len();
        probe.read_times.push(time_s);
        if probe.disconnected_at.is_some_and(|at| count >= at) {
            return Err(DeviceError::Disconnected {
                device: "faulty".into(),
            });
        }
        let mut state = self.inner.read(time_s)?;
        if probe.garbage_at.is_some_and(|at| count >= at) {
            state.pose.rotation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
        }
        Ok(state)
    }

    fn write(&mut self, wrench: &Wrench) -> Result<(), DeviceError> {
        let mut probe = self.probe.lock().unwrap_or_else(PoisonError::into_inner);
        let count = probe.written.len();
        probe.written.push(*wrench);
        if probe.refused_at == Some(count) {
            return Err(DeviceError::TimedOut {
                device: "faulty".into(),
                waited_s: 0.01,
            });
        }
        Ok(())
    }
}
