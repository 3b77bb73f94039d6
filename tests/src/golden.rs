//! Texts that change only when someone means it.

use std::path::PathBuf;

/// Compares a text with `tests/golden/NAME.txt`. `SIGHTLINE_BLESS=1` writes the file instead: read the difference before
/// you commit it.
///
/// # Panics
/// If the text differs.
pub fn compare(name: &str, text: &str) {
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/golden")).join(format!("{name}.txt"));
    if std::env::var_os("SIGHTLINE_BLESS").is_some() {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, text).unwrap();
        return;
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n");
    let differs = kept.lines().zip(text.lines()).position(|(kept, text)| kept != text);
    let line = differs.unwrap_or(kept.lines().count().min(text.lines().count())) + 1;
    assert!(
        kept == text,
        "{} differs from line {line} on; if that is meant, run again with SIGHTLINE_BLESS=1. It is now:\n{text}",
        path.display()
    );
}
