//! Writing a file whole or not at all: into a temporary file in the same folder, then renamed over the target.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Why a file could not be written. One line that names the file.
#[derive(Debug, thiserror::Error)]
#[error("{}: cannot write it: {cause}; nothing was left behind", path.display())]
pub struct WriteError {
    /// The file asked for.
    pub path: PathBuf,
    /// What the system said: a full disk, a missing folder, a missing right. Not a `source`: the line has it already.
    pub cause: io::Error,
}

/// Writes `path` through `fill`. A reader sees the old content or the new one, never a part of either; when anything
/// fails, the disk being full included, the old content stays and the temporary file is removed.
pub fn write_atomically(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), WriteError> {
    let failed = |cause| WriteError { path: path.to_path_buf(), cause };
    let temporary = temporary_beside(path).map_err(failed)?;
    let written = fill_file(&temporary, fill).and_then(|()| fs::rename(&temporary, path));
    written.map_err(|cause| {
        // The first error is the one to report; a temporary file that was never made cannot be removed.
        let _ = fs::remove_file(&temporary);
        failed(cause)
    })
}

/// `sync_all` because some file systems report a full disk only then.
fn fill_file(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut writer = BufWriter::new(File::create_new(path)?);
    fill(&mut writer)?;
    let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
    file.sync_all()
}

/// A name in the same folder (a rename must not cross file systems), unique among threads and processes.
fn temporary_beside(path: &Path) -> io::Result<PathBuf> {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "not the name of a file"))?;
    let mut hidden = std::ffi::OsString::from(".");
    hidden.push(name);
    let count = COUNTER.fetch_add(1, Ordering::Relaxed);
    hidden.push(format!(".{}.{count}.tmp", std::process::id()));
    Ok(path.with_file_name(hidden))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A folder of its own for each test, removed at the end.
    pub(crate) struct Folder(pub PathBuf);

    impl Folder {
        pub(crate) fn new(test: &str) -> Self {
            let path = std::env::temp_dir().join(format!("sightline-{test}-{}", std::process::id()));
            let _ = fs::remove_dir_all(&path);
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        pub(crate) fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).unwrap();
            let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
            names.sort();
            names
        }
    }

    impl Drop for Folder {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    #[test]
    fn a_written_file_replaces_the_old_one() {
        let folder = Folder::new("files-replace");
        let path = folder.0.join("a.txt");
        write_atomically(&path, |w| w.write_all(b"old")).unwrap();
        write_atomically(&path, |w| w.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_failed_write_keeps_the_old_file_and_leaves_nothing() {
        let folder = Folder::new("files-failed");
        let path = folder.0.join("a.txt");
        write_atomically(&path, |w| w.write_all(b"old")).unwrap();
        let full = write_atomically(&path, |w| {
            w.write_all(b"half of the ne")?;
            Err(io::Error::from(io::ErrorKind::StorageFull))
        });
        // As the program prints it, the chain of causes: the system's words must not be there twice.
        let message = format!("{:#}", anyhow::Error::from(full.unwrap_err()));
        let said = io::Error::from(io::ErrorKind::StorageFull).to_string();
        assert_eq!(message.matches(&said).count(), 1, "{message}");
        assert!(message.contains("a.txt: cannot write it"), "{message}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(folder.names(), ["a.txt"]);
    }

    #[test]
    fn a_missing_folder_or_name_is_an_error_that_names_the_file() {
        let folder = Folder::new("files-missing");
        for path in [folder.0.join("no/such/a.txt"), PathBuf::from("/")] {
            let message = write_atomically(&path, |_| Ok(())).unwrap_err().to_string();
            assert!(message.starts_with(&path.display().to_string()));
        }
    }
}
