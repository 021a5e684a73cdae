//! One tick from device sample to the force that depends on it.

use pliant_device::{DeviceError, DeviceState, HapticDevice, QUATERNION_TOLERANCE, WorkspaceMap};
use pliant_sim::{State, TickInput, TickOutput, World};
use pliant_spatial::Wrench;
use thiserror::Error;

use crate::Rate;

/// What a servo is made of.
pub struct ServoParts {
    /// What is touched, and with what.
    pub world: World,
    /// What is held.
    pub device: Box<dyn HapticDevice>,
    /// Where the device lies in the world.
    pub map: WorkspaceMap,
    /// How often it ticks.
    pub rate: Rate,
}

/// A world coupled to a device. Dropping it commands no force to the device.
pub struct Servo {
    parts: ServoParts,
    state: State,
    next_tick: u64,
}

/// What one tick read, computed and commanded. Holds no clock reading: equal motion gives equal samples.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Number of the tick, from 0.
    pub tick: u64,
    /// Simulated time: `tick` over rate [s].
    pub time: f64,
    /// The reading, in the frame of the device.
    pub device: DeviceState,
    /// The world's answer, in the world frame.
    pub output: TickOutput,
    /// The wrench sent to the device: device axes, torque about the handle origin [N, N·m].
    pub device_wrench: Wrench,
}

/// Why a servo stopped. The device has been commanded no force, if it still took a command.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ServoError {
    /// The device failed.
    #[error("tick {tick} ({time} s): {source}")]
    Device {
        /// Tick that failed.
        tick: u64,
        /// Its simulated time [s].
        time: f64,
        /// What the device reported, or what is wrong with its sample.
        source: DeviceError,
    },
}

impl Servo {
    /// Ready for tick 0. Reads the device once, at time 0: the visual tool starts where the haptic tool is.
    ///
    /// # Errors
    /// [`ServoError::Device`] when the device gives no usable pose.
    pub fn new(mut parts: ServoParts) -> Result<Self, ServoError> {
        let reading = read(parts.device.as_mut(), 0.0).map_err(|source| ServoError::Device {
            tick: 0,
            time: 0.0,
            source,
        })?;
        let world_from_haptic = parts.map.pose_to_world(&reading.pose);
        let state = State::new(&parts.world, world_from_haptic);
        Ok(Self {
            parts,
            state,
            next_tick: 0,
        })
    }

    /// One tick: read the device, map to the world, advance, map back, command. Allocates nothing unless it fails.
    ///
    /// # Errors
    /// [`ServoError::Device`] when the device fails, sends a pose that is none, or refuses the wrench. The device is then
    /// commanded no force. After a failed read the next call tries the same tick again; after a refused wrench the tick is
    /// done and the next call runs the next one.
    pub fn step(&mut self) -> Result<Sample, ServoError> {
        self.step_with(pliant_sim::tick)
    }

    /// [`Self::step`] with the tick in the caller's hands, who may time it: `tick` is called once, with the arguments of
    /// [`pliant_sim::tick`], and has to return what that returns.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn step_with(
        &mut self,
        tick: impl FnOnce(&World, &mut State, &TickInput, f64) -> TickOutput,
    ) -> Result<Sample, ServoError> {
        let number = self.next_tick;
        let time = self.parts.rate.time_of(number);
        let result = self.exchange(time, tick);
        let (device, output, device_wrench) = result.map_err(|source| {
            self.release();
            ServoError::Device {
                tick: number,
                time,
                source,
            }
        })?;
        Ok(Sample {
            tick: number,
            time,
            device,
            output,
            device_wrench,
        })
    }

    fn exchange(
        &mut self,
        time: f64,
        tick: impl FnOnce(&World, &mut State, &TickInput, f64) -> TickOutput,
    ) -> Result<(DeviceState, TickOutput, Wrench), DeviceError> {
        let ServoParts {
            world,
            device,
            map,
            rate,
        } = &mut self.parts;
        let reading = read(device.as_mut(), time)?;
        let input = TickInput {
            world_from_haptic: map.pose_to_world(&reading.pose),
        };
        let output = tick(world, &mut self.state, &input, rate.dt());
        self.next_tick += 1;
        let device_wrench = map.wrench_to_device(&output.wrench);
        device.write(&device_wrench)?;
        Ok((reading, output, device_wrench))
    }

    /// Commands no force. A failure is not reported: there is nothing left to try, and the cause has been.
    fn release(&mut self) {
        let _ = self.parts.device.write(&Wrench::ZERO);
    }

    /// What is touched, and with what.
    pub fn world(&self) -> &World {
        &self.parts.world
    }

    /// The state after the last tick.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What is held.
    pub fn device(&self) -> &dyn HapticDevice {
        self.parts.device.as_ref()
    }

    /// Where the device lies in the world.
    pub fn map(&self) -> &WorkspaceMap {
        &self.parts.map
    }

    /// How often it ticks.
    pub fn rate(&self) -> Rate {
        self.parts.rate
    }

    /// Number of the tick that runs next; equals the number of ticks done.
    pub fn next_tick(&self) -> u64 {
        self.next_tick
    }
}

impl Drop for Servo {
    fn drop(&mut self) {
        self.release();
    }
}

/// A reading whose pose is one: finite and of unit quaternion, which is normalised.
fn read(device: &mut dyn HapticDevice, time: f64) -> Result<DeviceState, DeviceError> {
    let mut reading = device.read(time)?;
    let norm_error = (reading.pose.rotation.length() - 1.0).abs();
    if reading.pose.is_finite() && norm_error <= QUATERNION_TOLERANCE {
        // Only when needed: normalising a unit quaternion may move its last bit.
        if norm_error > f64::EPSILON {
            reading.pose.rotation = reading.pose.rotation.normalize();
        }
        return Ok(reading);
    }
    Err(DeviceError::InvalidSample {
        device: device.info().name.clone(),
        reason: format!(
            "its pose is {:?}; it needs finite numbers and a unit quaternion",
            reading.pose
        ),
    })
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use glam::{DQuat, DVec3};
    use pliant_device::{DeviceError, WorkspaceMap};
    use pliant_spatial::{Pose, Wrench};

    use super::{Servo, ServoError, ServoParts};
    use crate::test_bench::{
        FaultyDevice, Probe, TOOL_HALF, parts, press, press_and_slide, still, world,
    };
    use crate::{Rate, run_virtual};

    #[test]
    fn a_tick_reads_at_its_own_time_and_commands_the_spring_force() {
        let depth = 0.002;
        let (device, probe) =
            FaultyDevice::new(still(DVec3::Z * (TOOL_HALF - depth)), Probe::default());
        let mut servo = Servo::new(ServoParts {
            device,
            rate: Rate::new(2000).unwrap(),
            ..parts(press_and_slide())
        })
        .unwrap();
        let mut last = None;
        run_virtual(&mut servo, 2000, |sample| last = Some(*sample)).unwrap();
        let last = last.unwrap();
        assert_eq!((last.tick, servo.next_tick()), (1999, 2000));
        assert!((last.time - 0.9995).abs() < 1e-15);
        // 1000 N/m over 2 mm; the skin of the contact method takes 0.1 µm.
        let force = last.device_wrench.force;
        assert!((force - DVec3::Z * 2.0).length() < 1e-3, "{force}");
        let probe = probe.lock().unwrap();
        assert_eq!(probe.read_times.len(), 2001);
        assert_eq!(probe.read_times[1].to_bits(), 0.0_f64.to_bits());
        assert_eq!(probe.read_times[2000].to_bits(), last.time.to_bits());
        assert_eq!(*probe.written.last().unwrap(), last.device_wrench);
    }

    #[test]
    fn a_mapped_device_feels_the_scaled_and_turned_force() {
        // The device lies on its side: its y is the world's z. Its workspace is a third of the world's.
        let (scale, force_scale, depth) = (3.0, 0.5, 0.002);
        let turned = Pose::from_rotation(DQuat::from_rotation_x(FRAC_PI_2));
        let at_device = DVec3::Y * ((TOOL_HALF - depth) / scale);
        let mut servo = Servo::new(ServoParts {
            map: WorkspaceMap::new(turned, scale, force_scale).unwrap(),
            ..parts(still(at_device))
        })
        .unwrap();
        let mut felt = Wrench::ZERO;
        run_virtual(&mut servo, 1000, |sample| felt = sample.device_wrench).unwrap();
        let (expected, along) = (force_scale * 1000.0 * depth, felt.force.dot(DVec3::Y));
        assert!((along - expected).abs() < 1e-3, "{felt:?}");
        assert!((felt.force - DVec3::Y * along).length() < 1e-9);
    }

    #[test]
    fn two_runs_give_the_same_samples_and_a_timed_tick_changes_none() {
        let samples = |timed: &dyn Fn(&mut Servo) -> super::Sample| {
            let mut servo = Servo::new(parts(press_and_slide())).unwrap();
            let samples: Vec<_> = (0..450).map(|_| timed(&mut servo)).collect();
            let pressing = samples.iter().filter(|s| s.output.contacts > 0).count();
            assert!(pressing > 150, "only {pressing} ticks in contact");
            format!("{samples:?}")
        };
        let plain = samples(&|servo| servo.step().unwrap());
        let timed = samples(&|servo| {
            let mut calls = 0;
            let sample = servo.step_with(|world, state, input, dt| {
                calls += 1;
                assert!((dt - 0.001).abs() < 1e-18);
                pliant_sim::tick(world, state, input, dt)
            });
            assert_eq!(calls, 1);
            sample.unwrap()
        });
        assert!(plain == timed);
    }

    #[test]
    fn a_lost_device_stops_the_servo_at_that_tick_without_force() {
        let (device, probe) = FaultyDevice::new(
            press(),
            Probe {
                disconnected_at: Some(101),
                ..Probe::default()
            },
        );
        let mut servo = Servo::new(ServoParts {
            device,
            ..parts(press_and_slide())
        })
        .unwrap();
        let mut seen = 0;
        let error = run_virtual(&mut servo, 200, |_| seen += 1).unwrap_err();
        let ServoError::Device { tick, source, .. } = &error;
        assert_eq!((*tick, seen, servo.next_tick()), (100, 100, 100));
        assert!(matches!(source, DeviceError::Disconnected { .. }));
        assert!(error.to_string().starts_with("tick 100 (0.1 s)"), "{error}");
        let probe = probe.lock().unwrap();
        assert!(probe.written[99].force.z > 1.0);
        assert_eq!(probe.written[100], Wrench::ZERO);
    }

    #[test]
    fn a_pose_that_is_none_never_reaches_the_world() {
        let garbage = |at| {
            let (device, probe) = FaultyDevice::new(
                press(),
                Probe {
                    garbage_at: Some(at),
                    ..Probe::default()
                },
            );
            let servo = Servo::new(ServoParts {
                device,
                ..parts(press_and_slide())
            });
            (servo, probe)
        };
        assert!(garbage(0).0.is_err());
        let (servo, probe) = garbage(2);
        let mut servo = servo.unwrap();
        servo.step().unwrap();
        let before = format!("{:?}", servo.state());
        let ServoError::Device { source, .. } = servo.step().unwrap_err();
        assert!(matches!(source, DeviceError::InvalidSample { .. }));
        assert_eq!(format!("{:?}", servo.state()), before);
        assert_eq!(probe.lock().unwrap().written[1], Wrench::ZERO);
    }

    #[test]
    fn a_refused_wrench_is_an_error_and_the_tick_is_done() {
        let (device, probe) = FaultyDevice::new(
            press(),
            Probe {
                refused_at: Some(3),
                ..Probe::default()
            },
        );
        let mut servo = Servo::new(ServoParts {
            device,
            ..parts(press_and_slide())
        })
        .unwrap();
        assert!(run_virtual(&mut servo, 10, |_| ()).is_err());
        assert_eq!(servo.next_tick(), 4);
        assert_eq!(probe.lock().unwrap().written[4], Wrench::ZERO);
        assert_eq!(servo.step().unwrap().tick, 4);
    }

    #[test]
    fn a_dropped_servo_leaves_no_force() {
        let (device, probe) = FaultyDevice::new(press(), Probe::default());
        let mut servo = Servo::new(ServoParts {
            world: world(),
            device,
            map: WorkspaceMap::IDENTITY,
            rate: Rate::DEFAULT,
        })
        .unwrap();
        run_virtual(&mut servo, 100, |_| ()).unwrap();
        assert!(probe.lock().unwrap().written[99].force.z > 1.0);
        drop(servo);
        assert_eq!(*probe.lock().unwrap().written.last().unwrap(), Wrench::ZERO);
    }
}
