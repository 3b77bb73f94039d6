//! Files are written whole or not at all; folders, links, devices and pipes stay in place.

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
        Err(io::Error::from(ErrorKind::StorageFull))
    });
    // The program prints the chain of causes: the system's message must not be there twice.
    let message = format!("{:#}", anyhow::Error::from(full.unwrap_err()));
    let said = io::Error::from(ErrorKind::StorageFull).to_string();
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

/// The name of the temporary file was 20 letters longer than the target's.
#[test]
fn a_name_as_long_as_names_may_be_is_written() {
    let folder = Folder::new("files-long");
    for length in [250, 254, 255] {
        let name = "n".repeat(length);
        write_atomically(&folder.0.join(&name), |w| w.write_all(b"long")).unwrap();
        check_file(&folder.0.join(&name)).unwrap();
    }
    assert_eq!(folder.names().len(), 3);
}

#[test]
fn what_cannot_be_written_is_known_before_and_named() {
    let folder = Folder::new("files-check");
    fs::write(folder.0.join("file"), "kept").unwrap();
    check_file(&folder.0.join("new.txt")).unwrap();
    check_file(&folder.0.join("file")).unwrap();
    check_folder(&folder.0.join("not/there/yet")).unwrap();
    check_folder(Path::new("not-there-either")).unwrap();
    assert_eq!(folder.names(), ["file"], "nothing is made or left");
    let faults = [
        (check_file(&folder.0), "it is a folder"),
        (check_file(&folder.0.join("new.txt/")), "not the name of a file"),
        (check_file(&folder.0.join("not/there.txt")), "cannot write it"),
        (check_folder(&folder.0.join("file")), "file is not a folder"),
        (check_folder(&folder.0.join("file/below")), "file is not a folder"),
    ];
    for (fault, expected) in faults {
        let message = fault.unwrap_err().to_string();
        assert!(message.contains(expected) && message.contains("files-check"), "{message}");
    }
    assert_eq!(fs::read(folder.0.join("file")).unwrap(), b"kept");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::io::Read;
    use std::os::unix::fs::{symlink, FileTypeExt, PermissionsExt};

    /// Each link was replaced by a regular file.
    #[test]
    fn a_link_leads_on_and_its_target_is_written() {
        let folder = Folder::new("files-links");
        fs::create_dir(folder.0.join("there")).unwrap();
        fs::write(folder.0.join("there/old"), "old").unwrap();
        symlink("there/old", folder.0.join("to-old")).unwrap();
        symlink("to-old", folder.0.join("twice")).unwrap();
        symlink("there/new", folder.0.join("to-new")).unwrap();
        for (link, target) in [("to-old", "there/old"), ("twice", "there/old"), ("to-new", "there/new")] {
            let path = folder.0.join(link);
            check_file(&path).unwrap();
            write_atomically(&path, |w| w.write_all(link.as_bytes())).unwrap();
            assert!(fs::symlink_metadata(&path).unwrap().is_symlink(), "{link}");
            assert_eq!(fs::read(folder.0.join(target)).unwrap(), link.as_bytes());
        }
        symlink("circle", folder.0.join("circle")).unwrap();
        let message = write_atomically(&folder.0.join("circle"), |_| Ok(())).unwrap_err().to_string();
        assert!(message.contains("circle: cannot write it"), "{message}");
    }

    #[test]
    fn a_device_stays_one_and_takes_the_bytes() {
        let null = Path::new("/dev/null");
        check_file(null).unwrap();
        write_atomically(null, |w| w.write_all(b"gone")).unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
        let full = Path::new("/dev/full");
        if full.exists() {
            let message = write_atomically(full, |w| w.write_all(b"too much")).unwrap_err().to_string();
            assert!(message.starts_with("/dev/full: cannot write it") && message.contains("space"), "{message}");
            assert!(fs::metadata(full).unwrap().file_type().is_char_device());
        }
    }

    #[test]
    fn a_pipe_passes_on_what_is_written_and_needs_a_reader() {
        let folder = Folder::new("files-fifo");
        let path = folder.0.join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&path).status().unwrap();
        assert!(made.success());
        check_file(&path).unwrap();
        let message = write_atomically(&path, |w| w.write_all(b"x")).unwrap_err().to_string();
        assert!(message.contains("nobody reads this pipe"), "{message}");
        // A reader that is opened for writing too does not wait for the writer.
        let mut reader = OpenOptions::new().read(true).write(true).open(&path).unwrap();
        write_atomically(&path, |w| w.write_all(b"through")).unwrap();
        let mut bytes = [0; 7];
        reader.read_exact(&mut bytes).unwrap();
        assert_eq!(&bytes, b"through");
        assert!(fs::metadata(&path).unwrap().file_type().is_fifo());
    }

    #[test]
    fn sockets_are_refused() {
        let folder = Folder::new("files-socket");
        let path = folder.0.join("socket");
        let _socket = std::os::unix::net::UnixListener::bind(&path).unwrap();
        for fault in [check_file(&path), write_atomically(&path, |_| Ok(()))] {
            assert!(fault.unwrap_err().to_string().contains("it is a socket"));
        }
    }

    #[test]
    fn a_replaced_file_keeps_its_rights() {
        let folder = Folder::new("files-rights");
        let path = folder.0.join("a.txt");
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).unwrap();
        write_atomically(&path, |w| w.write_all(b"new")).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    }
}
