//! Laws of the glTF import, held by Debian's test models and by small files made here.

mod accessors;
mod compressed;
mod corpus;
mod crate_limits;
mod extensions;
mod files;
mod materials;
mod model;
mod models;
mod modes;
mod morphs;
mod motion;
mod mutations;
mod nodes;
mod skins;
mod uris;
