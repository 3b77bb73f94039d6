//! WebP files, decoded by the `image-webp` crate.

use super::{Texture, Wrap, LONGEST_SIDE, MOST_BYTES};
use image_webp::WebPDecoder;
use std::io::Cursor;

/// True if a file has the signature of WebP.
pub(super) fn is_webp(file: &[u8]) -> bool {
    file.starts_with(b"RIFF") && file.get(8..).is_some_and(|rest| rest.starts_with(b"WEBP"))
}

/// Returns width and height from the file's header.
pub(super) fn dimensions(file: &[u8]) -> Result<(u32, u32), String> {
    Ok(WebPDecoder::new(Cursor::new(file)).map_err(|error| error.to_string())?.dimensions())
}

/// Decodes a WebP file; of an animation, its first frame.
pub(super) fn decode(name: String, file: &[u8]) -> Result<Texture, String> {
    let mut decoder = WebPDecoder::new(Cursor::new(file)).map_err(|error| error.to_string())?;
    decoder.set_memory_limit(MOST_BYTES as usize);
    let (width, height) = decoder.dimensions();
    // The decoder holds four bytes a pixel, with or without alpha.
    if width.max(height) > LONGEST_SIDE || 4 * u64::from(width) * u64::from(height) > MOST_BYTES {
        return Err(format!("its {width}x{height} pixels are too many; reduce it to {LONGEST_SIDE}x4096 at most"));
    }
    let size = decoder.output_buffer_size().ok_or("it is larger than memory")?;
    let mut pixels = vec![0; size];
    decoder.read_image(&mut pixels).map_err(|error| error.to_string())?;
    let texels = match decoder.has_alpha() {
        true => pixels.chunks_exact(4).map(|texel| [texel[0], texel[1], texel[2], texel[3]]).collect(),
        false => pixels.chunks_exact(3).map(|texel| [texel[0], texel[1], texel[2], 255]).collect(),
    };
    Ok(Texture { name, size: [width, height], texels, wrap: [Wrap::Repeat; 2] })
}
