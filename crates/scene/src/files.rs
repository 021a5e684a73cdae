//! Where the files that a scene names come from: the disk, or anything a caller puts in its place.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

/// Reads whole files.
pub trait Files {
    /// The bytes of `path`.
    ///
    /// # Errors
    /// When there is no such file or it cannot be read.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;
}

/// Files of this machine: regular ones, because a scene or a mesh can name any path and a device or a pipe has no end.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if std::fs::metadata(path)?.is_file() {
            std::fs::read(path)
        } else {
            let message = "it is a folder or a device, not a file";
            Err(io::Error::new(io::ErrorKind::InvalidInput, message))
        }
    }
}

/// Files in memory: scenes built into a program, and tests.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles(pub BTreeMap<PathBuf, Vec<u8>>);

impl Files for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.0
            .get(path)
            .cloned()
            .ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "there is no such file"))
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::{Disk, Files};
    use std::path::Path;

    #[test]
    fn what_has_no_end_is_not_read() {
        for path in ["/dev/zero", "/dev", "../../../../../../../../dev/zero"] {
            let error = Disk.read(Path::new(path)).unwrap_err();
            assert!(error.to_string().contains("not a file"), "{path}: {error}");
        }
    }
}
