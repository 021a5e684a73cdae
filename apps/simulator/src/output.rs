//! Standard output, notes, and files that are whole or not there.

use std::fs::{self, File};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::failure::Failure;

/// A line on standard error; where nobody reads it, nothing is lost.
pub(crate) fn note(message: &str) {
    let _ = writeln!(io::stderr(), "{message}");
}

/// A text on standard output. A reader that has gone away (`| head`) is not a fault.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    let result = stdout
        .write_all(text.as_bytes())
        .and_then(|()| stdout.flush());
    match result {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::System(format!("standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A file in the making: it takes its place only when it is complete.
pub(crate) struct PendingFile {
    target: PathBuf,
    writer: BufWriter<Sink>,
}

enum Sink {
    /// Beside the target, to be renamed.
    Temporary(NamedTempFile),
    /// The target is a pipe or a device, which cannot be replaced.
    Direct(File),
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Temporary(file) => file.write(bytes),
            Self::Direct(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Temporary(file) => file.flush(),
            Self::Direct(file) => file.flush(),
        }
    }
}

impl PendingFile {
    /// Opens before the work begins, so that a wrong path is known early.
    pub(crate) fn create(target: &Path) -> Result<Self, Failure> {
        let refuse = |error: &dyn std::fmt::Display| {
            Failure::Input(format!("{}: cannot be written: {error}", target.display()))
        };
        let sink = match fs::metadata(target) {
            Ok(metadata) if metadata.is_dir() => return Err(refuse(&"it is a folder")),
            Ok(metadata) if !metadata.is_file() => {
                let file = File::options().write(true).open(target);
                Sink::Direct(file.map_err(|error| refuse(&error))?)
            }
            _ => Sink::Temporary(temporary(target).map_err(|error| refuse(&error))?),
        };
        Ok(Self {
            target: target.to_owned(),
            writer: BufWriter::new(sink),
        })
    }

    /// Adds bytes.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let result = self.writer.write_all(bytes);
        result.map_err(|error| failed(&self.target, &error))
    }

    /// Puts the file in its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        let Self { target, writer } = self;
        let sink = writer
            .into_inner()
            .map_err(|error| failed(&target, error.error()))?;
        match sink {
            Sink::Temporary(file) => file
                .persist(&target)
                .map(drop)
                .map_err(|error| failed(&target, &error.error)),
            Sink::Direct(_) => Ok(()),
        }
    }
}

fn failed(target: &Path, error: &io::Error) -> Failure {
    Failure::System(format!("{}: {error}", target.display()))
}

fn temporary(target: &Path) -> io::Result<NamedTempFile> {
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pliant-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file: what the user's mask leaves of it.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::PendingFile;

    #[test]
    fn a_file_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("t.csv");
        std::fs::write(&target, "old").unwrap();
        let mut dropped = PendingFile::create(&target).unwrap();
        dropped.write(b"new, but never finished").unwrap();
        drop(dropped);
        assert_eq!(std::fs::read_to_string(&target).unwrap(), "old");
        let mut finished = PendingFile::create(&target).unwrap();
        finished.write(b"new").unwrap();
        assert_eq!(std::fs::read_to_string(&target).unwrap(), "old");
        finished.finish().unwrap();
        assert_eq!(std::fs::read_to_string(&target).unwrap(), "new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(PendingFile::create(folder.path()).is_err());
        assert!(PendingFile::create(&folder.path().join("no/t.csv")).is_err());
    }
}
