//! Where a box lies, and whether it can be asked about.

use crate::roc::twin::selection;
use shaders::types::{Bounds, CullView, SELECT_NONE, SELECT_TESTED};

/// Where a box lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Out of view.
    Outside,
    /// In view, and reaches the near plane: its box cannot be asked about.
    Near,
    /// In view.
    Testable,
}

impl Place {
    pub(super) fn of(bound: &Bounds, view: &CullView) -> Place {
        match selection(bound, 0, view) {
            SELECT_NONE => Place::Outside,
            SELECT_TESTED => Place::Testable,
            _ => Place::Near,
        }
    }
}
