//! `sightline stress`: a seeded catalogue of numeric worst cases, and worlds by chance, through every exact method.
//!
//! A drill ([`catalogue`]) is drawn whole, which is the truth, and by each method ([`run()`]); an exact method may lose no object and
//! change no pixel, under the raster conditions ([`conditions`]). A failure is made small ([`shrink`]) and kept ([`save`]). How near each family came to failing is measured by
//! what its bounds had to spare ([`footprints`]).

pub mod catalogue;
pub mod conditions;
pub mod footprints;
pub mod lab;
mod random;
pub mod refusals;
pub mod run;
pub mod save;
pub mod settings;
pub mod shrink;
pub mod worlds;

pub use lab::{Lab, Subject};
pub use random::Random;
pub use run::{run, Outcome, Plan};
pub use worlds::Case;
