//! Standard output, where a reader that has gone away (`| head`) is no error.

use anyhow::Result;
use std::io::{ErrorKind, Write};

/// Prints a text and ends its line.
pub(crate) fn say(text: &str) -> Result<()> {
    put(format!("{text}\n").as_bytes())
}

/// Prints bytes as they are.
pub(crate) fn put(bytes: &[u8]) -> Result<()> {
    match std::io::stdout().write_all(bytes) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}
