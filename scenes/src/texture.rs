//! Base colour textures: pixels in memory, and what a file's pictures become.

use image::{ImageReader, Limits};
use std::io::Cursor;

/// Longest side of a picture that is read, in pixels.
const LONGEST_SIDE: u32 = 16_384;
/// Most memory that decoding one picture may take: 16,384 x 4,096 pixels of 4 bytes.
const MOST_BYTES: u64 = 1 << 28;

/// What lies beyond a texture's borders, along one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texture again, every second time mirrored.
    Mirror,
    /// The texels at the border.
    Clamp,
}

/// Red, green, blue and alpha of a rectangle of texels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Texture {
    /// Name from the file, or of the generator.
    pub name: String,
    /// Width and height in texels, > 0.
    pub size: [u32; 2],
    /// Texels, row by row from the top, as they are stored in picture files: colours are not linear, alpha is.
    pub texels: Vec<[u8; 4]>,
    /// What lies beyond the borders, in x and y.
    pub wrap: [Wrap; 2],
}

impl Texture {
    /// Decodes a PNG or JPEG file.
    ///
    /// # Errors
    /// Why it could not be decoded, in one line.
    pub fn decode(name: String, file: &[u8]) -> Result<Self, String> {
        let mut reader =
            ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|error| error.to_string())?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(LONGEST_SIDE), Some(LONGEST_SIDE));
        limits.max_alloc = Some(MOST_BYTES);
        reader.limits(limits);
        let picture = reader.decode().map_err(|error| error.to_string())?.into_rgba8();
        let size = picture.dimensions().into();
        let texels = picture.pixels().map(|pixel| pixel.0).collect();
        Ok(Texture { name, size, texels, wrap: [Wrap::Repeat; 2] })
    }

    /// The same texels as a PNG file.
    pub(crate) fn encode(&self) -> Result<Vec<u8>, String> {
        let bytes = self.texels.as_flattened().to_vec();
        let picture = image::RgbaImage::from_raw(self.size[0], self.size[1], bytes);
        let picture =
            picture.ok_or_else(|| format!("texture '{}' has not as many texels as its size says", self.name))?;
        let mut file = Cursor::new(Vec::new());
        picture.write_to(&mut file, image::ImageFormat::Png).map_err(|error| error.to_string())?;
        Ok(file.into_inner())
    }

    /// Why it cannot be drawn, if so.
    pub(crate) fn fault(&self) -> Option<String> {
        let [width, height] = self.size.map(u64::from);
        (width * height == 0 || width * height != self.texels.len() as u64)
            .then(|| format!("its texture '{}' has {} texels for {width}x{height}", self.name, self.texels.len()))
    }
}
