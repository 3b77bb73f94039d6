//! The folder of a run's files, checked before the run, so that no measurement is lost.

use crate::results::files::{check_file, check_folder};
use crate::results::Results;
use anyhow::{Context, Result};
use std::path::Path;

/// The files that [`write()`] makes.
const RESULTS: [&str; 2] = ["results.json", "results.csv"];

/// Makes the folder for results if it is not there.
///
/// # Errors
/// There is a file in its place, or no right to make the folder or files in it.
pub fn make_folder(folder: &Path) -> Result<()> {
    check_folder(folder)?;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: cannot make this folder; choose another with --out", folder.display()))
}

/// Makes the folder, and checks before a run that results can be written there.
///
/// # Errors
/// As for [`make_folder`], and a folder or socket in place of a file.
pub fn ready(folder: &Path) -> Result<()> {
    make_folder(folder)?;
    RESULTS.iter().try_for_each(|name| Ok(check_file(&folder.join(name))?))
}

/// Writes results.json and results.csv to a folder, and makes it if needed. Both are tried; the first error is returned.
pub fn write(results: &Results, folder: &Path) -> Result<()> {
    make_folder(folder)?;
    let json = results.write_json(&folder.join(RESULTS[0]));
    let csv = results.write_csv(&folder.join(RESULTS[1]));
    Ok(json.and(csv)?)
}
