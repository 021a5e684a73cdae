//! The scene that is built in, and files in general.

use std::io;
use std::path::Path;

use pliant_scene::{Disk, Files};

/// Names the built-in scene in messages.
pub(crate) const NAME: &str = "probe_on_ellipsoid";

/// Text of the built-in scene.
pub(crate) const SCENE: &str = include_str!("../../../scenes/probe_on_ellipsoid.ron");

/// The only file that the built-in scene names.
const TRAJECTORY: (&str, &str) = (
    "trajectories/probe_on_ellipsoid.csv",
    include_str!("../../../scenes/trajectories/probe_on_ellipsoid.csv"),
);

/// Files of the built-in scene, else of this machine: overrides may name any.
pub(crate) struct EmbeddedFiles;

impl Files for EmbeddedFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let (name, text) = TRAJECTORY;
        if path == Path::new(name) {
            return Ok(text.into());
        }
        Disk.read(path)
    }
}
