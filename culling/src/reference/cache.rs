//! Visible sets on disk: one file a run, named by a hash of everything that they depend on.

use super::VisibleSets;
use sha2::{Digest, Sha256};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

/// The number goes up whenever worlds put objects in another order, as sets are by place in it.
const MAGIC: &[u8; 8] = b"SLVIS002";

/// The file of a run's visible sets in `folder`. `key` says scene, path, size, frames and device, each in full.
fn file(folder: &Path, key: &str) -> PathBuf {
    let digest = Sha256::digest(key.as_bytes());
    let name: String = digest.iter().take(16).map(|byte| format!("{byte:02x}")).collect();
    folder.join(format!("visible-{name}.bin"))
}

/// The stored sets of a run; none if there are none, or if the file does not fit (it is then written again).
pub fn load(folder: &Path, key: &str, objects: usize, frames: usize) -> Option<VisibleSets> {
    let bytes = std::fs::read(file(folder, key)).ok()?;
    let (body, digest) = bytes.split_at_checked(bytes.len().checked_sub(32)?)?;
    if Sha256::digest(body).as_slice() != digest {
        return None;
    }
    let mut body = body;
    let mut magic = [0; 8];
    body.read_exact(&mut magic).ok()?;
    let stored = [read_count(&mut body)?, read_count(&mut body)?];
    if &magic != MAGIC || stored != [objects as u64, frames as u64] {
        return None;
    }
    let words =
        body.chunks_exact(8).map(|word| word.try_into().map(u64::from_le_bytes)).collect::<Result<_, _>>().ok()?;
    VisibleSets::from_words(objects, frames, words)
}

fn read_count(body: &mut &[u8]) -> Option<u64> {
    let mut bytes = [0; 8];
    body.read_exact(&mut bytes).ok()?;
    Some(u64::from_le_bytes(bytes))
}

/// Stores the sets of a run; written beside and renamed, so that no reader sees half a file.
pub fn save(folder: &Path, key: &str, sets: &VisibleSets) -> io::Result<()> {
    let mut body = MAGIC.to_vec();
    body.extend((sets.objects() as u64).to_le_bytes());
    body.extend((sets.len() as u64).to_le_bytes());
    body.extend(sets.words().iter().flat_map(|word| word.to_le_bytes()));
    let digest = Sha256::digest(&body);
    let path = file(folder, key);
    let beside = path.with_extension(format!("{}.tmp", std::process::id()));
    std::fs::create_dir_all(folder)?;
    let mut out = std::fs::File::create(&beside)?;
    let written =
        out.write_all(&body).and_then(|()| out.write_all(&digest)).and_then(|()| std::fs::rename(&beside, &path));
    if written.is_err() {
        let _ = std::fs::remove_file(&beside);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stored_sets_come_back_and_damaged_ones_do_not() {
        let folder = std::env::temp_dir().join(format!("sightline-visible-{}", std::process::id()));
        let mut sets = VisibleSets::new(70);
        sets.push_items(&[3, 69]);
        save(&folder, "a run", &sets).unwrap();
        assert_eq!(load(&folder, "a run", 70, 1), Some(sets));
        assert_eq!(load(&folder, "another run", 70, 1), None);
        assert_eq!(load(&folder, "a run", 70, 2), None);
        let path = file(&folder, "a run");
        let mut bytes = std::fs::read(&path).unwrap();
        bytes[30] ^= 1;
        std::fs::write(&path, bytes).unwrap();
        assert_eq!(load(&folder, "a run", 70, 1), None, "a flipped bit must not pass for truth");
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
