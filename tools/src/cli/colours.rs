//! When messages are coloured.

use std::ffi::OsStr;

/// True if what is written there may be coloured: to a terminal, unless `NO_COLOR` says otherwise (no-color.org: by any value but
/// an empty one). Tables and JSON never are.
pub fn coloured(is_terminal: bool, no_color: Option<&OsStr>) -> bool {
    is_terminal && no_color.is_none_or(OsStr::is_empty)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_terminals_that_want_them_get_colours() {
        assert!(coloured(true, None));
        assert!(coloured(true, Some(OsStr::new(""))));
        assert!(!coloured(true, Some(OsStr::new("1"))));
        assert!(!coloured(true, Some(OsStr::new("0"))));
        assert!(!coloured(false, None));
    }
}
