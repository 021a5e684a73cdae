//! Standard output, notes, and files that are whole or not there.

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, ErrorKind, Seek, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, SpooledTempFile, spooled_tempfile_in};

use crate::failure::Failure;

/// Bytes kept in memory before they move to a file that has no name; a minute at 1 kHz takes half of it.
const SPOOL: usize = 64 << 20;

/// A chain of links this long is taken for a ring, as the system does.
const MOST_LINKS: u32 = 40;

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

/// A file in the making: it takes its place only when it is complete, and until then has no name.
pub(crate) struct PendingFile {
    /// As the user named it.
    named: PathBuf,
    sink: Sink,
}

enum Sink {
    /// To be put at `target`, beside which it is kept.
    Whole {
        target: PathBuf,
        folder: PathBuf,
        content: SpooledTempFile,
    },
    /// A pipe or a device, which cannot be replaced.
    Stream(BufWriter<Box<dyn Write>>),
    /// The reader of a stream has gone away.
    Closed,
}

impl PendingFile {
    /// Tries before the work begins whether the file could be written, so that a wrong path is known early.
    pub(crate) fn create(named: &Path) -> Result<Self, Failure> {
        let sink = sink(named).map_err(|error| failed(named, &error))?;
        Ok(Self {
            named: named.to_owned(),
            sink,
        })
    }

    /// Adds bytes.
    pub(crate) fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let result = match &mut self.sink {
            Sink::Whole { content, .. } => content.write_all(bytes),
            Sink::Stream(stream) => stream.write_all(bytes),
            Sink::Closed => Ok(()),
        };
        self.quiet_when_closed(result)
    }

    /// Puts the file in its place.
    pub(crate) fn finish(mut self) -> Result<(), Failure> {
        let result = match &mut self.sink {
            Sink::Whole {
                target,
                folder,
                content,
            } => put(content, folder, target),
            Sink::Stream(stream) => stream.flush(),
            Sink::Closed => Ok(()),
        };
        self.quiet_when_closed(result)
    }

    fn quiet_when_closed(&mut self, result: io::Result<()>) -> Result<(), Failure> {
        match (result, &self.sink) {
            (Err(error), Sink::Stream(_)) if error.kind() == ErrorKind::BrokenPipe => {
                // What the buffer still holds would fail again.
                if let Sink::Stream(stream) = std::mem::replace(&mut self.sink, Sink::Closed) {
                    drop(stream.into_parts());
                }
                Ok(())
            }
            (result, _) => result.map_err(|error| failed(&self.named, &error)),
        }
    }
}

/// Where writing to `path` ends up: absolute, links followed, also a link to what is not there yet.
pub(crate) fn destination(path: &Path) -> io::Result<PathBuf> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        if let Ok(whole) = fs::canonicalize(&path) {
            return Ok(whole);
        }
        let name = path.file_name().ok_or(ErrorKind::NotFound)?;
        let parent = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let folder = fs::canonicalize(parent)?;
        let place = folder.join(name);
        match fs::read_link(&place) {
            Ok(link) => path = folder.join(link),
            Err(_) => return Ok(place),
        }
    }
    Err(io::Error::other("the link leads to itself"))
}

fn sink(named: &Path) -> io::Result<Sink> {
    let stream = |to: Box<dyn Write>| Ok(Sink::Stream(BufWriter::new(to)));
    // By its stream and not by its name: what follows on standard output must come after it.
    if named == Path::new("/dev/stdout") {
        return stream(Box::new(io::stdout()));
    }
    match fs::metadata(named) {
        Ok(metadata) if metadata.is_dir() => Err(io::Error::other("it is a folder")),
        Ok(metadata) if !metadata.is_file() => {
            stream(Box::new(File::options().write(true).open(named)?))
        }
        found => {
            let target = destination(named)?;
            let folder = target.parent().unwrap_or(Path::new("/")).to_owned();
            if found.is_ok() {
                File::options().write(true).open(&target)?;
            }
            tempfile::tempfile_in(&folder)?;
            let content = spooled_tempfile_in(SPOOL, &folder);
            Ok(Sink::Whole {
                target,
                folder,
                content,
            })
        }
    }
}

/// Gives the content a name beside `target`, then the name of `target`.
fn put(content: &mut SpooledTempFile, folder: &Path, target: &Path) -> io::Result<()> {
    content.rewind()?;
    let mut file = named_file(
        folder,
        fs::metadata(target).ok().map(|old| old.permissions()),
    )?;
    io::copy(content, &mut file)?;
    file.persist(target).map(drop).map_err(|error| error.error)
}

fn named_file(folder: &Path, permissions: Option<Permissions>) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pliant-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // As any new file: what the user's mask leaves of it.
        builder.permissions(Permissions::from_mode(0o666));
    }
    let file = builder.tempfile_in(folder)?;
    if let Some(permissions) = permissions {
        file.as_file().set_permissions(permissions)?;
    }
    Ok(file)
}

/// In the user's words: the system's reason without the name of the file that stands in meanwhile.
fn failed(named: &Path, error: &io::Error) -> Failure {
    let mut reason = error.to_string();
    if let Some(at) = reason.find(" at path ") {
        reason.truncate(at);
    }
    Failure::System(format!("{}: cannot be written: {reason}", named.display()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::{PendingFile, destination};

    #[test]
    fn a_file_appears_whole_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("t.csv");
        fs::write(&target, "old").unwrap();
        let mut dropped = PendingFile::create(&target).unwrap();
        dropped.write(b"new, but never finished").unwrap();
        drop(dropped);
        assert_eq!(fs::read_to_string(&target).unwrap(), "old");
        let mut finished = PendingFile::create(&target).unwrap();
        finished.write(b"new").unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "old");
        finished.finish().unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(PendingFile::create(folder.path()).is_err());
        assert!(PendingFile::create(&folder.path().join("no/t.csv")).is_err());
    }

    #[test]
    fn a_file_in_the_making_has_no_name_that_could_be_left_behind() {
        let folder = tempfile::tempdir().unwrap();
        let mut pending = PendingFile::create(&folder.path().join("t.csv")).unwrap();
        let block = vec![b'x'; 1 << 20];
        for _ in 0..65 {
            pending.write(&block).unwrap();
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        pending.finish().unwrap();
        let length = fs::metadata(folder.path().join("t.csv")).unwrap().len();
        assert_eq!(length, 65 << 20);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_written_through_and_survive() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("deep")).unwrap();
        symlink("deep/link", at("outer")).unwrap();
        symlink("target.csv", at("deep/link")).unwrap();
        for text in ["first", "second"] {
            let mut pending = PendingFile::create(&at("outer")).unwrap();
            pending.write(text.as_bytes()).unwrap();
            pending.finish().unwrap();
            assert!(at("outer").is_symlink() && at("deep/link").is_symlink());
            let target = at("deep/target.csv");
            assert!(!target.is_symlink());
            assert_eq!(fs::read_to_string(&target).unwrap(), text);
            // A file that is private stays so.
            let mode = fs::metadata(&target).unwrap().permissions().mode() & 0o777;
            assert_eq!(mode == 0o600, text == "second");
            fs::set_permissions(&target, fs::Permissions::from_mode(0o600)).unwrap();
        }
        symlink("ring", at("ring")).unwrap();
        assert!(destination(&at("ring")).is_err());
        assert!(PendingFile::create(&at("ring")).is_err());
    }
}
