//! Laws of the glTF import, held by Debian's test models and by small files made here.

mod accessors;
mod crate_limits;
mod files;
mod materials;
mod model;
mod models;
mod modes;
mod motion;
mod mutations;
mod nodes;
mod skins;
