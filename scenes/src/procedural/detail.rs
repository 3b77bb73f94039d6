//! How finely the meshes of a scene are divided.

/// The finest level of [`super::SceneOptions::detail`]. Meshes are shared by objects, so that every scene's still fit into 1 GiB.
pub const MOST_DETAIL: u32 = 4;

/// A level of detail: at 1 a mesh is as it is written down, each level above doubles the divisions of every edge, and 0 halves
/// those of what is round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Detail(u32);

impl Default for Detail {
    fn default() -> Self {
        Detail(1)
    }
}

impl Detail {
    /// The level of that number, or the finest.
    pub(super) fn new(level: u32) -> Self {
        Detail(level.min(MOST_DETAIL))
    }

    pub(super) fn level(self) -> u32 {
        self.0
    }

    /// How many sides something round has that has `standard` at level 1; 3 or more.
    pub(super) fn sides(self, standard: usize) -> usize {
        self.rows(standard).max(3)
    }

    /// How many pieces something curved has that has `standard` at level 1; 1 or more.
    pub(super) fn rows(self, standard: usize) -> usize {
        ((standard << self.0) / 2).max(1)
    }

    /// How many pieces an edge of something flat has.
    pub(super) fn cuts(self) -> usize {
        1 << self.0.saturating_sub(1)
    }
}
