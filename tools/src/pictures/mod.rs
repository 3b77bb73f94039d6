//! Pictures of what a frame did: its targets as PNG files ([`png_out`]), the boxes that it tested ([`boxes_view`]), and depth warped from
//! the frame before ([`warp_view`]).

pub mod boxes_view;
pub(crate) mod lines;
pub mod png_out;
pub mod warp_view;
