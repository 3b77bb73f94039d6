//! The choice of a texture's image: its own, or one that an extension names.

use gltf::json::image::Image;
use gltf::json::texture::Texture;
use gltf::json::Index;
use serde_json::Value;

/// The index that the `gltf` crate stores for a texture without a source.
const NO_SOURCE: usize = u32::MAX as usize;

/// Extensions that name another image, in formats that are not read.
const UNREAD: [&str; 5] =
    ["KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif", "EXT_texture_astc", "MOZ_texture_rgbe"];

/// Recognises picture formats that are not read. Returns the format and its extension.
pub(super) fn unread(file: &[u8]) -> Option<&'static str> {
    match file {
        [0xab, b'K', b'T', b'X', b' ', ..] => Some("KTX, of KHR_texture_basisu"),
        [b'D', b'D', b'S', b' ', ..] => Some("DDS, of MSFT_texture_dds"),
        [_, _, _, _, b'f', b't', b'y', b'p', b'a', b'v', b'i', ..] => Some("AVIF, of EXT_texture_avif"),
        _ => None,
    }
}

/// Returns the images that a texture may be read from, the best first: that of EXT_texture_webp, then its own, which the extension calls a
/// fallback.
///
/// # Errors
/// The reason why there is none, in one line that names the extension.
pub(super) fn sources(texture: &Texture) -> Result<Vec<Index<Image>>, String> {
    let extension = |name: &str| texture.extensions.as_ref()?.others.get(name);
    let own = Some(texture.source).filter(|source| source.value() != NO_SOURCE);
    let webp = extension("EXT_texture_webp").and_then(|webp| webp.get("source")).and_then(Value::as_u64);
    let webp = webp.and_then(|source| u32::try_from(source).ok()).map(Index::new);
    let sources: Vec<Index<Image>> = webp.into_iter().chain(own).collect();
    if !sources.is_empty() {
        return Ok(sources);
    }
    match UNREAD.into_iter().find(|name| extension(name).is_some()) {
        Some(name) => Err(format!(
            "only the extension {name} names its image, and that format is not read; \
             export the scene with PNG, JPEG or WebP textures"
        )),
        None => Err("it names no image".into()),
    }
}
