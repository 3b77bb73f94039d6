//! How objects and cameras move over time.

/// How the dynamic objects and cameras of a scene move. To be extended with node animation.
#[derive(Clone, Debug, Default)]
pub struct Motion {}
