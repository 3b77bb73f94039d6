//! Writes files whole or not at all: into a temporary file in the same folder, which is then renamed to the file. A symbolic link
//! stays, and its target is replaced. Devices and pipes cannot be replaced; bytes are written to them.

use std::ffi::OsString;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Why a file could not be written. One line that names the file.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}: {cause}{remedy}", path.display())]
pub struct WriteError {
    /// The file or folder asked for.
    pub path: PathBuf,
    /// The system's reason: a full disk, a missing folder, a missing right. Not a `source`: the line has it already.
    pub cause: io::Error,
    problem: &'static str,
    remedy: &'static str,
}

impl WriteError {
    fn new(path: &Path, cause: io::Error) -> Self {
        let remedy = match cause.kind() {
            ErrorKind::StorageFull | ErrorKind::QuotaExceeded => "; free some space there; nothing was left behind",
            _ => "; nothing was left behind",
        };
        WriteError { path: path.to_path_buf(), cause, problem: "cannot write it", remedy }
    }

    fn of_folder(path: &Path, cause: io::Error) -> Self {
        let problem = match path.is_dir() {
            true => "cannot make files in this folder; choose another with --out",
            false => "cannot make this folder; choose another with --out",
        };
        WriteError { path: path.to_path_buf(), cause, problem, remedy: "" }
    }
}

/// The kind of a path that bytes are written to.
enum Place {
    /// This regular file is made or replaced.
    File(PathBuf),
    /// A device or pipe takes the bytes as they come.
    Stream(Stream),
}

/// A file that cannot be replaced.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Stream {
    /// A named pipe, which may have no reader.
    #[cfg(unix)]
    Fifo,
    /// A character device, or an open file without a name.
    Device,
}

/// Reads a file of text with at most `most_bytes` bytes.
///
/// # Errors
/// A file that cannot be read, is larger, or is not UTF-8. The error does not name the file.
pub fn read_text(path: &Path, most_bytes: u64) -> io::Result<String> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most_bytes {
        return Err(io::Error::other(format!("it is larger than {most_bytes} bytes")));
    }
    String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, "it is not UTF-8 text"))
}

/// Writes `path` through `fill`. A reader of a regular file sees the old content or the new one, never a part of either. On any error,
/// a full disk included, the old content stays and the temporary file is removed.
///
/// # Errors
/// A folder, disk or socket of that name; no right to write there; a full disk; a named pipe that nobody reads.
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    let written = match place_of(path) {
        Ok(Place::File(file)) => replace(&file, fill),
        Ok(Place::Stream(stream)) => pass_on(path, stream, fill),
        Err(cause) => Err(cause),
    };
    written.map_err(|cause| WriteError::new(path, cause))
}

/// Checks before a long run that [`write_atomically`] could write a file. The file is not touched.
///
/// # Errors
/// As for [`write_atomically`], except a full disk and a pipe without a reader, which may both change.
pub fn check_file(path: &Path) -> Result<(), WriteError> {
    let checked = match place_of(path) {
        Ok(Place::File(file)) => try_beside(&file),
        Ok(Place::Stream(Stream::Device)) => OpenOptions::new().write(true).open(path).map(drop),
        #[cfg(unix)]
        Ok(Place::Stream(Stream::Fifo)) => Ok(()),
        Err(cause) => Err(cause),
    };
    checked.map_err(|cause| WriteError::new(path, cause))
}

/// Checks that files could be made in a folder, or in the folder above it that exists. The folder is not made.
///
/// # Errors
/// The name is not that of a folder, or there is no right to make files there.
pub fn check_folder(folder: &Path) -> Result<(), WriteError> {
    let failed = |cause| WriteError::of_folder(folder, cause);
    let named = folder.ancestors().filter(|part| !part.as_os_str().is_empty());
    let there = named.map(Path::to_path_buf).find(|part| fs::symlink_metadata(part).is_ok());
    let there = there.unwrap_or_else(|| PathBuf::from("."));
    if !fs::metadata(&there).map_err(failed)?.is_dir() {
        let text = format!("{} is not a folder", there.display());
        return Err(failed(io::Error::new(ErrorKind::NotADirectory, text)));
    }
    try_beside(&there.join("file")).map_err(failed)
}

fn place_of(path: &Path) -> io::Result<Place> {
    let refused = |kind, text: &str| Err(io::Error::new(kind, text.to_owned()));
    let has_end =
        path.as_os_str().as_encoded_bytes().last().is_some_and(|last| !std::path::is_separator(*last as char));
    if path.file_name().is_none() || !has_end {
        return refused(ErrorKind::InvalidInput, "not the name of a file");
    }
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => refused(ErrorKind::IsADirectory, "it is a folder; name a file in it"),
        Ok(found) if found.is_file() => Ok(match resolved(path) {
            Ok(file) => Place::File(file),
            // An open file without a name, under /proc.
            Err(_) => Place::Stream(Stream::Device),
        }),
        Ok(found) => stream_of(&found).map(Place::Stream),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Place::File(end_of_links(path)?)),
        Err(error) => Err(error),
    }
}

/// Follows symbolic links to a regular file.
fn resolved(path: &Path) -> io::Result<PathBuf> {
    if fs::symlink_metadata(path)?.is_symlink() {
        return fs::canonicalize(path);
    }
    Ok(path.to_path_buf())
}

/// Follows symbolic links to a file that does not exist yet.
fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    const MOST_LINKS: usize = 40;
    let mut at = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&at) {
            Ok(target) => at = at.parent().unwrap_or(Path::new("")).join(target),
            Err(_) => return Ok(at),
        }
    }
    Err(io::Error::other("its symbolic links lead in a circle"))
}

#[cfg(unix)]
fn stream_of(found: &Metadata) -> io::Result<Stream> {
    use std::os::unix::fs::FileTypeExt;
    let kind = found.file_type();
    let refused = |text: &str| Err(io::Error::new(ErrorKind::InvalidInput, text.to_owned()));
    match () {
        () if kind.is_fifo() => Ok(Stream::Fifo),
        () if kind.is_char_device() => Ok(Stream::Device),
        () if kind.is_block_device() => refused("it is a disk, whose content would be lost; name a file"),
        () => refused("it is a socket; name a file"),
    }
}

#[cfg(not(unix))]
fn stream_of(_: &Metadata) -> io::Result<Stream> {
    Ok(Stream::Device)
}

/// Writes all bytes to a device or pipe at once. If `fill` fails, nothing is written.
fn pass_on(path: &Path, stream: Stream, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut bytes = Vec::new();
    fill(&mut bytes)?;
    // The probe stays open: the pipe's reader must not see an end before the bytes.
    let _probe = match stream {
        #[cfg(unix)]
        Stream::Fifo => Some(probe(path)?),
        Stream::Device => None::<File>,
    };
    let mut file = OpenOptions::new().write(true).open(path)?;
    file.write_all(&bytes)?;
    file.flush()
}

/// Opens a named pipe without waiting. Without a reader, a plain open would wait for ever.
#[cfg(unix)]
fn probe(path: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    OpenOptions::new().write(true).custom_flags(libc::O_NONBLOCK).open(path).map_err(|error| {
        match error.raw_os_error() {
            Some(libc::ENXIO) => io::Error::other("nobody reads this pipe; start its reader first"),
            _ => error,
        }
    })
}

fn replace(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let (temporary, file) = temporary_beside(path)?;
    let written = fill_file(file, fill).and_then(|()| keep_rights(path, &temporary));
    written.and_then(|()| fs::rename(&temporary, path)).inspect_err(|_| {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
    })
}

/// `sync_all` because some file systems report a full disk only then.
fn fill_file(file: File, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(file);
    fill(&mut writer)?;
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.sync_all()
}

/// Gives the new file the permissions of the old one.
fn keep_rights(old: &Path, new: &Path) -> io::Result<()> {
    match fs::metadata(old) {
        Ok(found) => fs::set_permissions(new, found.permissions()),
        Err(_) => Ok(()),
    }
}

fn try_beside(path: &Path) -> io::Result<()> {
    let (temporary, file) = temporary_beside(path)?;
    drop(file);
    fs::remove_file(temporary)
}

/// Makes a new file in the same folder, as a rename must not cross file systems. Its name does not contain the other name, which may be
/// as long as the file system allows.
fn temporary_beside(path: &Path) -> io::Result<(PathBuf, File)> {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    const TRIES: usize = 1000;
    let mut failed = io::Error::other("no name for a temporary file is free");
    for _ in 0..TRIES {
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let temporary = path.with_file_name(OsString::from(format!(".sightline-{}-{count}.tmp", std::process::id())));
        match File::create_new(&temporary) {
            Ok(file) => return Ok((temporary, file)),
            // A killed process of the same number left this file behind.
            Err(error) if error.kind() == ErrorKind::AlreadyExists => failed = error,
            Err(error) => return Err(error),
        }
    }
    Err(failed)
}

#[cfg(test)]
pub(crate) mod tests;
