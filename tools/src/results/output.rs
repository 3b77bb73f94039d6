//! Standard output and standard error. A reader that has gone away (`| head`) is no error; a full disk is, and is named.
//!
//! Names of scenes, devices, objects and labels may come from foreign files. A terminal obeys control characters, so they are escaped,
//! for example as `\u{1b}`.

use anyhow::{Context, Result};
use serde::Serialize;
use std::borrow::Cow;
use std::io::{ErrorKind, Write};

/// Prints a text and ends its line. Control characters except line ends are escaped.
pub(crate) fn say(text: &str) -> Result<()> {
    put(format!("{}\n", shown(text)).as_bytes())
}

/// Prints a value as JSON.
pub(crate) fn say_json(value: &impl Serialize) -> Result<()> {
    let text = serde_json::to_string_pretty(value)?;
    // JSON allows unescaped control characters (DEL, C1) only within strings, where `\u` means the same.
    let escaped = |text: &mut String, letter: char| match letter {
        letter if is_obeyed(letter) && letter != '\n' => *text += &format!("\\u{:04x}", u32::from(letter)),
        letter => text.push(letter),
    };
    let mut plain = String::with_capacity(text.len() + 1);
    text.chars().for_each(|letter| escaped(&mut plain, letter));
    plain.push('\n');
    put(plain.as_bytes())
}

/// Prints bytes as they are.
pub(crate) fn put(bytes: &[u8]) -> Result<()> {
    let mut out = std::io::stdout().lock();
    written(out.write_all(bytes).and_then(|()| out.flush()))
}

/// Turns the result of writing to standard output into an error that names it.
pub(crate) fn written(outcome: std::io::Result<()>) -> Result<()> {
    match outcome {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(error).context("standard output: cannot write to it")
        }
        _ => Ok(()),
    }
}

/// Prints a line to standard error. A failure cannot be reported anywhere.
pub(crate) fn warn(text: &str) {
    let _ = writeln!(std::io::stderr(), "{}", shown(text));
}

/// Escapes control characters except line ends.
pub(crate) fn shown(text: &str) -> Cow<'_, str> {
    escaped(text, |letter| is_obeyed(letter) && letter != '\n')
}

/// Escapes all control characters, for a name within a line or table.
pub(crate) fn one_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_obeyed)
}

fn escaped(text: &str, is_escaped: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut plain = String::with_capacity(text.len());
    for letter in text.chars() {
        match is_escaped(letter) {
            true => plain.extend(letter.escape_default()),
            false => plain.push(letter),
        }
    }
    Cow::Owned(plain)
}

/// True if a terminal does not show this character but obeys it: control characters (C0, DEL and C1), marks of the writing direction,
/// and ends of lines and paragraphs.
pub(crate) fn is_obeyed(letter: char) -> bool {
    let turns =
        matches!(letter, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    letter.is_control() || turns || matches!(letter, '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_control_character_reaches_the_terminal() {
        let evil = "a\u{1b}[31mb\u{7}\u{9b}2Jc\r\td\u{7f}\u{202e}e\nf";
        assert_eq!(shown(evil), "a\\u{1b}[31mb\\u{7}\\u{9b}2Jc\\r\\td\\u{7f}\\u{202e}e\nf");
        assert!(one_line(evil).ends_with("e\\nf"));
        assert!(matches!(shown("Größe → 3 × 2"), Cow::Borrowed(_)));
    }
}
