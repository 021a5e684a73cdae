//! Arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use pliant_scene::Unit;
use pliant_servo::Rate;

/// More than this fill the memory with tick times.
pub(crate) const MOST_TICKS: u64 = 100_000_000;

/// The longest run [s]: that of scenes.
const MOST_SECONDS: f64 = 86_400.0;

const EXIT_CODES: &str = "\
Exit codes:
  0  fine
  1  the input is wrong: a scene, mesh, motion or setting, or an output that would overwrite one
  2  usage: an unknown option, a value out of its range, options that contradict each other
  3  a device or system fault: no such folder, no permission, a full disk";

const TABLE: &str = "\
Write every tick to a table

A comment line names scene, method, rate, version and the settings in force; then come the names of the columns and one \
line a tick. Units are in the names: s, m, n (newton), nm (newton metre), j (joule).
  t_s                    simulated time
  haptic_*, visual_*     handle pose of the haptic and the visual tool in the world: position, unit quaternion
  force_*, torque_*      on the hand, world axes, torque about the haptic handle
  contacts               places that press
  contact_object         name of the object that presses most, empty without contact
  contact_element        which segment of the tool it presses, from 0 at the handle
  tip_deflection_m       of the tip against a rigid tool
  energy_j               in the coupling spring
  held                   1: the visual tool keeps the last orientation that was free
  fallback               1: the solver stopped at its limit of rounds";

const SETTING: &str = "\
Set a field of the scene, for instance `coupling.linear_stiffness=500`

Paths in it are relative to the folder of the scene. A field that an option decides as well (--method, --rate, --seconds, \
--ticks, --trajectory, --device) is refused: give one of them.";

/// Feel virtual objects through a tool: forces at haptic rate from scene files.
#[derive(Debug, Parser)]
#[command(name = "pliant", version, args_conflicts_with_subcommands = true, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    /// Scene file (.ron); without it an ellipsoid that is built in
    pub(crate) scene: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scene and report forces, penetration and tick times
    #[command(after_help = EXIT_CODES)]
    Run(RunArguments),
    /// Say what is in scenes (.ron), meshes (.obj, .stl, .gltf, .glb) and trajectories (.csv)
    #[command(after_help = EXIT_CODES)]
    Check(CheckArguments),
}

#[derive(Args, Debug)]
pub(crate) struct RunArguments {
    /// Scene file (.ron)
    #[arg(required = true)]
    pub(crate) scene: Option<PathBuf>,
    /// Without a window; this version has none, so it changes nothing
    #[arg(long)]
    pub(crate) headless: bool,
    /// Simulated time to run [s], up to a day; the scene's own without it
    #[arg(long, value_name = "S", conflicts_with = "ticks", allow_hyphen_values = true, value_parser = seconds)]
    pub(crate) seconds: Option<f64>,
    /// Servo ticks to run, instead of a time
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = ticks)]
    pub(crate) ticks: Option<u64>,
    /// Hand motion instead of the scene's, relative to the current folder
    #[arg(long, value_name = "CSV")]
    pub(crate) trajectory: Option<PathBuf>,
    /// Where the motion comes from: scripted
    #[arg(long, value_name = "NAME", value_parser = device)]
    pub(crate) device: Option<String>,
    /// Servo ticks a second, 500 to 10000
    #[arg(long, value_name = "HZ", allow_hyphen_values = true, value_parser = rate)]
    pub(crate) rate: Option<u32>,
    /// Set a field of the scene, for instance `coupling.linear_stiffness=500`
    #[arg(long, value_name = "F=V", long_help = SETTING)]
    pub(crate) set: Vec<String>,
    /// How contact is resolved
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodArgument>,
    /// Keep to the wall clock
    #[arg(long)]
    pub(crate) realtime: bool,
    /// Replay N times and take each tick's shortest time
    #[arg(long, value_name = "N", default_value_t = 1, allow_hyphen_values = true, value_parser = repeat)]
    pub(crate) repeat: u32,
    /// Write every tick to a table
    #[arg(long, value_name = "CSV", long_help = TABLE)]
    pub(crate) csv: Option<PathBuf>,
    /// Draw force, depth and tick time over time
    #[arg(long, value_name = "PNG", value_parser = picture)]
    pub(crate) plot: Option<PathBuf>,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

impl RunArguments {
    /// All defaults.
    pub(crate) fn of_scene(scene: Option<PathBuf>) -> Self {
        Self {
            scene,
            headless: false,
            seconds: None,
            ticks: None,
            trajectory: None,
            device: None,
            rate: None,
            set: Vec::new(),
            method: None,
            realtime: false,
            repeat: 1,
            csv: None,
            plot: None,
            json: false,
        }
    }
}

#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum MethodArgument {
    /// Certified separating planes
    Constrained,
    /// The published method, for comparison
    Paper,
}

impl MethodArgument {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Constrained => "constrained",
            Self::Paper => "paper",
        }
    }
}

#[derive(Args, Debug)]
pub(crate) struct CheckArguments {
    /// Files to check
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<PathBuf>,
    /// Unit of the numbers in mesh files, to report their size in mm: m, mm, cm or inch
    #[arg(long, value_parser = unit)]
    pub(crate) unit: Option<Unit>,
}

fn unit(name: &str) -> Result<Unit, String> {
    Unit::from_name(name).ok_or_else(|| "expected m, mm, cm or inch".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(value) if value > 0.0 && value <= MOST_SECONDS => Ok(value),
        _ => Err(format!(
            "expected a number of seconds above 0 and up to {MOST_SECONDS}"
        )),
    }
}

fn ticks(text: &str) -> Result<u64, String> {
    whole(text, (1, MOST_TICKS))
}

fn rate(text: &str) -> Result<u32, String> {
    let (low, high) = (Rate::MIN_HZ, Rate::MAX_HZ);
    whole(text, (u64::from(low), u64::from(high))).map(|hz| u32::try_from(hz).unwrap_or(high))
}

fn repeat(text: &str) -> Result<u32, String> {
    whole(text, (1, 10_000)).map(|times| u32::try_from(times).unwrap_or(1))
}

fn whole(text: &str, (low, high): (u64, u64)) -> Result<u64, String> {
    match text.trim().parse() {
        Ok(value) if (low..=high).contains(&value) => Ok(value),
        _ => Err(format!("expected a whole number from {low} to {high}")),
    }
}

fn device(name: &str) -> Result<String, String> {
    if name == "scripted" {
        Ok(name.to_owned())
    } else {
        Err("unknown device; this version has: scripted".to_owned())
    }
}

/// A PNG file, or a pipe or device of any name.
fn picture(path: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(path);
    let extension = path.extension().and_then(|extension| extension.to_str());
    let is_png = extension.is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    if is_png || (path.exists() && !path.is_file()) {
        Ok(path)
    } else {
        Err("plots are PNG files; give a name that ends in .png".to_owned())
    }
}
