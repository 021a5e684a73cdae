//! `pliant run`: steps the servo and keeps what is asked for.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use indicatif::{ProgressBar, ProgressStyle};
use pliant_scene::{BuiltScene, Disk, Files, Scene};
use pliant_servo::{Clock, MonotonicClock, Pacer, Rate, Sample, Servo, ServoError, ServoParts};
use pliant_sim::{tick, visual_penetration};

use crate::cli::{MOST_TICKS, RunArguments};
use crate::embedded::{self, EmbeddedFiles};
use crate::failure::Failure;
use crate::output::{self, PendingFile};
use crate::plot::{self, PlotData};
use crate::settings::{self, Watched};
use crate::summary::{Gauge, TickTimes};
use crate::survey;
use crate::trace::{Head, Trace};

/// Ticks between two looks of the progress bar at the clock.
const PROGRESS_INTERVAL: u64 = 256;

/// Runs a scene.
pub(crate) fn run(arguments: &RunArguments) -> Result<(), Failure> {
    let settings = settings::overrides(arguments)?;
    let (scene, files) = scene(arguments)?;
    let files = Watched::new(files, arguments.scene.as_deref());
    let built = scene
        .with_overrides(&settings)?
        .build(&files)
        .map_err(settings::explained)?;
    files.guard(arguments)?;
    let run = Run::new(&built, arguments)?;
    let pending = |path: &Option<PathBuf>| path.as_deref().map(PendingFile::create).transpose();
    let (csv, png) = (pending(&arguments.csv)?, pending(&arguments.plot)?);
    let mut records = Records {
        gauge: Gauge::new(built.world.coupling().linear_stiffness, built.rate_hz),
        curves: png.is_some().then(Curves::default),
        trace: csv
            .map(|file| Trace::new(file, &run.head(arguments)))
            .transpose()?,
    };
    let (times, late_ticks) = run.repeated(arguments.repeat, &mut records)?;
    let Records {
        mut gauge,
        curves,
        trace,
    } = records;
    // Ticks that wait for nothing are never late, whatever they take.
    gauge.summary.paced = arguments.realtime;
    gauge.summary.late_ticks = late_ticks;
    gauge.summary.tick_ns = TickTimes::of(times.clone());
    if let Some(trace) = trace {
        trace.finish()?;
    }
    if let (Some(mut file), Some(curves)) = (png, curves) {
        let data = run.plot_data(curves, &times, &gauge);
        let picture = plot::png(&data).map_err(|error| Failure::System(error.to_string()))?;
        file.write(&picture)?;
        file.finish()?;
    }
    output::print(&if arguments.json {
        gauge.summary.json()
    } else {
        run.report(&gauge)
    })
}

/// The scene as it stands in its file, and where its other files come from.
fn scene(arguments: &RunArguments) -> Result<(Scene, &'static dyn Files), Failure> {
    let Some(path) = &arguments.scene else {
        let scene = Scene::from_str(embedded::SCENE, &format!("{}.ron", embedded::NAME))?;
        return Ok((scene, &EmbeddedFiles));
    };
    let bytes = std::fs::read(path)
        .map_err(|error| Failure::Input(format!("{}: {error}", path.display())))?;
    Ok((
        Scene::from_bytes(&bytes, &path.display().to_string())?,
        &Disk,
    ))
}

/// Everything that a pass over the scene needs.
struct Run<'a> {
    built: &'a BuiltScene,
    name: String,
    rate: Rate,
    ticks: u64,
    realtime: bool,
}

impl<'a> Run<'a> {
    fn new(built: &'a BuiltScene, arguments: &RunArguments) -> Result<Self, Failure> {
        let rate = Rate::new(built.rate_hz).map_err(|error| Failure::Input(error.to_string()))?;
        let of_seconds = (built.seconds * f64::from(rate.hz())).round().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive, and a scene lasts a day at most"
        )]
        let ticks = arguments.ticks.unwrap_or(of_seconds as u64);
        if ticks > MOST_TICKS {
            let message =
                format!("{ticks} ticks are more than {MOST_TICKS}; run fewer ticks or seconds");
            let by_option = arguments.seconds.is_some() || arguments.rate.is_some();
            return Err(if by_option {
                Failure::Usage(message)
            } else {
                Failure::Input(message)
            });
        }
        let stem = arguments.scene.as_deref().and_then(Path::file_stem);
        Ok(Self {
            built,
            name: stem.map_or(embedded::NAME.into(), |stem| {
                stem.to_string_lossy().into_owned()
            }),
            rate,
            ticks,
            realtime: arguments.realtime,
        })
    }

    /// All ticks, recorded, and `repeat` − 1 times again for each tick's shortest time [ns]. Returns these times and how
    /// many ticks began late.
    fn repeated(&self, repeat: u32, records: &mut Records) -> Result<(Vec<u64>, u64), Failure> {
        let bar = progress(self.ticks * u64::from(repeat));
        let mut times = Vec::new();
        let mut late_ticks = self.pass(&bar, &mut |ns, sample, servo| {
            times.push(ns);
            records.add(sample, visual_penetration(servo.world(), servo.state()))
        })?;
        for _ in 1..repeat {
            let mut shortest = times.iter_mut();
            late_ticks += self.pass(&bar, &mut |ns, _, _| {
                if let Some(time) = shortest.next() {
                    *time = ns.min(*time);
                }
                Ok(())
            })?;
        }
        bar.finish_and_clear();
        Ok((times, late_ticks))
    }

    /// All ticks once; `on_tick` gets each one's time [ns]. Returns how many began late.
    fn pass(
        &self,
        bar: &ProgressBar,
        on_tick: &mut dyn FnMut(u64, &Sample, &Servo) -> Result<(), Failure>,
    ) -> Result<u64, Failure> {
        let fault = |error: ServoError| Failure::System(error.to_string());
        let mut servo = Servo::new(ServoParts {
            world: self.built.world.clone(),
            device: Box::new(self.built.device()),
            map: self.built.map,
            rate: self.rate,
        })
        .map_err(fault)?;
        let clock = MonotonicClock::new();
        let mut pacer = Pacer::new(self.rate, clock.now());
        for number in 0..self.ticks {
            if self.realtime {
                pacer.wait(&clock);
            }
            let mut ns = 0;
            let sample = servo
                .step_with(|world, state, input, dt| {
                    let start = Instant::now();
                    let output = tick(world, state, input, dt);
                    ns = u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX);
                    output
                })
                .map_err(fault)?;
            on_tick(ns, &sample, &servo)?;
            if number % PROGRESS_INTERVAL == 0 {
                bar.inc(PROGRESS_INTERVAL);
            }
        }
        Ok(pacer.report().late_ticks)
    }

    fn head(&self, arguments: &RunArguments) -> Head<'_> {
        Head {
            scene: &self.name,
            method: self.built.method.name(),
            rate_hz: self.built.rate_hz,
            settings: settings::record(arguments),
            objects: self.built.world.object_names(),
        }
    }

    /// For people: the figures, and what explains a run that felt odd.
    fn report(&self, gauge: &Gauge) -> String {
        let head = format!("{}, method {}", self.name, self.built.method.name());
        let mut text = gauge.summary.text(&head, gauge.mean_force());
        let mut line = |name: &str, value: &str| {
            let _ = writeln!(text, "  {name:<16}{value}");
        };
        if let Some(start) = survey::start(self.built) {
            line("start", &start);
        }
        if gauge.summary.contact_ticks == 0 {
            line(
                "no contact",
                &survey::missed(self.built, gauge.summary.seconds),
            );
        }
        text
    }

    fn plot_data(&self, curves: Curves, times: &[u64], gauge: &Gauge) -> PlotData {
        let summary = &gauge.summary;
        let names = self.built.world.object_names();
        let touched = curves.touched.iter();
        let touched: Vec<&str> = touched
            .map(|&index| names[index as usize].as_str())
            .collect();
        let touched = match touched.len() {
            2..=4 => format!("; touched: {}", touched.join(", ")),
            _ => String::new(),
        };
        PlotData {
            title: format!("{}, method {}", self.name, self.built.method.name()),
            subtitle: format!(
                "{} s at {} Hz; {} of {} ticks in contact; at most {:.2} N{touched}",
                summary.seconds,
                summary.rate_hz,
                summary.contact_ticks,
                summary.ticks,
                summary.max_force_n
            ),
            end: summary.seconds,
            time: curves.time,
            force: curves.force,
            depth: curves.depth,
            tick: times.iter().map(|&ns| ns as f64 * 1e-3).collect(),
            tick_note: summary.tick_ns.text(),
            contact: curves.contact,
            held: curves.held,
        }
    }
}

/// What is kept of a run.
struct Records {
    gauge: Gauge,
    curves: Option<Curves>,
    trace: Option<Trace>,
}

impl Records {
    fn add(&mut self, sample: &Sample, penetration: f64) -> Result<(), Failure> {
        self.gauge.add(sample, penetration);
        if let Some(curves) = &mut self.curves {
            curves.add(sample);
        }
        self.trace
            .as_mut()
            .map_or(Ok(()), |trace| trace.add(sample))
    }
}

/// What the plot shows of each tick.
#[derive(Default)]
struct Curves {
    time: Vec<f64>,
    force: [Vec<f64>; 4],
    depth: Vec<f64>,
    contact: Vec<bool>,
    held: Vec<bool>,
    /// Indices of the objects that pressed most at some time.
    touched: BTreeSet<u32>,
}

impl Curves {
    fn add(&mut self, sample: &Sample) {
        let output = &sample.output;
        let force = output.wrench.force;
        self.time.push(sample.time);
        for (curve, value) in self
            .force
            .iter_mut()
            .zip([force.x, force.y, force.z, force.length()])
        {
            curve.push(value);
        }
        self.depth.push(output.penetration_of_haptic * 1e3);
        self.contact.push(output.contacts > 0);
        self.held.push(output.held);
        self.touched
            .extend(output.contact.map(|contact| contact.object));
    }
}

/// On standard error, and only where that is a terminal.
fn progress(ticks: u64) -> ProgressBar {
    let bar = ProgressBar::new(ticks);
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {percent} %, {eta} left") {
        bar.set_style(style);
    }
    bar
}
