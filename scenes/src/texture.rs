//! Base colour textures: pixels in memory, and what a file's pictures become.

mod webp;

use image::{ColorType, ImageReader, Limits};
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
    /// Decodes a PNG, JPEG or WebP file. Alpha of 16 bits is rounded to 8.
    ///
    /// # Errors
    /// Why it could not be decoded, in one line.
    pub fn decode(name: String, file: &[u8]) -> Result<Self, String> {
        Self::decode_for(name, file, None).map(|(texture, _)| texture)
    }

    /// Decodes a file for an alpha test: texels of 16 bits whose alpha is at least `least` are rounded to 8 bits that are, and all others to 8
    /// bits that are not. Returns whether alpha has 16 bits, so that `least` matters.
    ///
    /// # Errors
    /// The reason why it could not be decoded, in one line.
    pub(crate) fn decode_for(name: String, file: &[u8], least: Option<f64>) -> Result<(Self, bool), String> {
        if webp::is_webp(file) {
            return Ok((webp::decode(name, file)?, false));
        }
        let mut reader =
            ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|error| error.to_string())?;
        let mut limits = Limits::default();
        (limits.max_image_width, limits.max_image_height) = (Some(LONGEST_SIDE), Some(LONGEST_SIDE));
        limits.max_alloc = Some(MOST_BYTES);
        reader.limits(limits);
        let picture = reader.decode().map_err(|error| error.to_string())?;
        let size = [picture.width(), picture.height()];
        let is_fine = matches!(picture.color(), ColorType::La16 | ColorType::Rgba16);
        let fine = is_fine.then(|| picture.to_rgba16());
        let picture = picture.into_rgba8();
        let mut texels: Vec<[u8; 4]> = picture.pixels().map(|pixel| pixel.0).collect();
        for (texel, fine) in texels.iter_mut().zip(fine.iter().flat_map(|fine| fine.pixels())) {
            texel[3] = alpha_byte(fine.0[3], least);
        }
        Ok((Texture { name, size, texels, wrap: [Wrap::Repeat; 2] }, is_fine))
    }

    /// Returns the number of texels that a picture file declares.
    pub(crate) fn texels_of(file: &[u8]) -> Result<usize, String> {
        let (width, height) = if webp::is_webp(file) {
            webp::dimensions(file)?
        } else {
            let reader =
                ImageReader::new(Cursor::new(file)).with_guessed_format().map_err(|error| error.to_string())?;
            reader.into_dimensions().map_err(|error| error.to_string())?
        };
        Ok(usize::try_from(u64::from(width) * u64::from(height)).unwrap_or(usize::MAX))
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

/// Alpha of 16 bits in 8, on the same side of `least`. Numbers that a file means to be equal differ by the rounding of `f32`, 2^-24 each.
fn alpha_byte(alpha: u16, least: Option<f64>) -> u8 {
    const MEANT_EQUAL: f64 = 1.0 / (1u32 << 22) as f64;
    let exact = f64::from(alpha) / f64::from(u16::MAX);
    let nearest = (255.0 * exact).round();
    let byte = match least.map(|least| least * (1.0 - MEANT_EQUAL)) {
        None => nearest,
        Some(least) if exact >= least => nearest.max((255.0 * least).ceil()),
        Some(least) => nearest.min((255.0 * least).ceil() - 1.0),
    };
    // `as` ends at 0 and at 255.
    byte as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alpha_of_16_bits_stays_on_its_side_of_the_cutoff() {
        for (alpha, least) in
            [(19_399, 0.2955), (19_464, 0.2975), (65_530, 1.0), (65_535, 1.0), (0, 0.0), (7, 1.5), (1, 1e-9)]
        {
            let there = f64::from(alpha) / 65_535.0 >= least;
            assert_eq!(f64::from(alpha_byte(alpha, Some(least))) / 255.0 >= least, there, "{alpha} at {least}");
        }
        let meant = f64::from(128.0f32 / 255.0);
        assert_eq!(alpha_byte(128 * 257, Some(meant)), 128, "equal but for the rounding of f32");
        assert_eq!((alpha_byte(19_399, None), alpha_byte(65_535, None)), (75, 255));
    }
}
