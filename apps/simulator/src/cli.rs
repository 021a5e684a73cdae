//! Arguments.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};
use pliant_scene::Unit;

/// Feel virtual objects through a tool: forces at haptic rate from scene files.
#[derive(Debug, Parser)]
#[command(name = "pliant", version, args_conflicts_with_subcommands = true)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Option<Command>,
    /// Scene file (.ron); without it an ellipsoid that is built in
    pub(crate) scene: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Run a scene and report forces, penetration and tick times
    Run(RunArguments),
    /// Say what is in scenes (.ron), meshes (.obj, .stl, .gltf, .glb) and trajectories (.csv)
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
    /// Simulated time to run [s]; the scene's own without it
    #[arg(long, value_name = "S", conflicts_with = "ticks")]
    pub(crate) seconds: Option<f64>,
    /// Servo ticks to run
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) ticks: Option<u64>,
    /// Hand motion instead of the scene's
    #[arg(long, value_name = "CSV")]
    pub(crate) trajectory: Option<PathBuf>,
    /// Where the motion comes from: scripted
    #[arg(long, value_name = "NAME")]
    pub(crate) device: Option<String>,
    /// Servo ticks a second, 500 to 10000
    #[arg(long, value_name = "HZ")]
    pub(crate) rate: Option<u32>,
    /// Set a field of the scene, for instance `coupling.linear_stiffness=500`
    #[arg(long, value_name = "F=V")]
    pub(crate) set: Vec<String>,
    /// How contact is resolved
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodArgument>,
    /// Keep to the wall clock
    #[arg(long)]
    pub(crate) realtime: bool,
    /// Replay N times and take each tick's shortest time
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) repeat: u32,
    /// Write every tick to a table
    #[arg(long, value_name = "CSV")]
    pub(crate) csv: Option<PathBuf>,
    /// Draw force, depth and tick time over time
    #[arg(long, value_name = "PNG")]
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
