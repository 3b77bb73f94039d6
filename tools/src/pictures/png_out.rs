//! Pictures of a frame's targets as PNG files: colour, depth, item buffer, overdraw, and what differs from the truth.

use crate::measures::metrics::{class_of, FrameImages, PixelClass, NO_ITEM};
use crate::results::files::{write_atomically, WriteError};
use image::{ExtendedColorType, ImageEncoder};
use std::io;
use std::path::Path;

/// The colour of what must not be: a depth that is no finite number, a pixel of the right object in a wrong colour.
const FAULT: [u8; 3] = [255, 0, 255];

/// An RGB image, row-major, top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// `width * height` colours.
    pub pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// The colour target without its alpha.
    pub fn colour(images: &FrameImages) -> Self {
        let pixels = images.colour.iter().map(|&[r, g, b, _]| [r, g, b]);
        Self::of(images.width, images.height, pixels.collect())
    }

    /// The depth target as grey: near is white, far dark, and the background (depth 0) black. The grey is linear in the
    /// logarithm of the stored depth, between the ends of `scale`: stored depth falls with 1 / distance, so that shown
    /// directly almost everything would be black. Darkest is 32, so that the farthest object still stands out from the
    /// background. Magenta: NaN or infinite. Two pictures can be compared if they share one scale.
    pub fn depth(images: &FrameImages, scale: DepthScale) -> Self {
        let pixels = images.depth.iter().map(|&depth| scale.grey(depth));
        Self::of(images.width, images.height, pixels.collect())
    }

    /// The item buffer: black where there is no object, otherwise a colour that only this object has (up to 2 million
    /// objects; then colours repeat), the same in every frame, and unlike those of its neighbours in the list.
    pub fn items(images: &FrameImages) -> Self {
        let pixels = images.items.iter().map(|&item| item_colour(item));
        Self::of(images.width, images.height, pixels.collect())
    }

    /// Fragments shaded per pixel as a heat map: 0 black, 1 blue, 4 green, 8 yellow, 16 red, 32 and more white; between
    /// these the colour changes evenly.
    pub fn overdraw(width: u32, height: u32, counts: &[u32]) -> Self {
        let pixels = counts.iter().map(|&count| heat(count));
        Self::of(width, height, pixels.collect())
    }

    /// Truth, method, and [what differs](Self::differences), side by side. Both frames have the same size.
    pub fn difference(truth: &FrameImages, method: &FrameImages) -> Self {
        Self::side_by_side(&[Self::colour(truth), Self::colour(method), Self::differences(truth, method)])
    }

    /// Red where the depth differs, blue where a tie went to another object (no error), magenta where the same object has
    /// another colour (a defect), and else the truth at a quarter of its brightness, to find one's way. Both frames have the
    /// same size.
    pub fn differences(truth: &FrameImages, method: &FrameImages) -> Self {
        let pixels = (0..truth.colour.len()).map(|pixel| match class_of(truth, method, pixel) {
            PixelClass::Differs => [255, 0, 0],
            PixelClass::Tied => [40, 80, 255],
            PixelClass::WrongColour => FAULT,
            PixelClass::Same => {
                let [red, green, blue, _] = truth.colour[pixel];
                [red / 4, green / 4, blue / 4]
            }
        });
        Self::of(truth.width, truth.height, pixels.collect())
    }

    /// Pictures from left to right, 4 grey pixels apart; lower ones end in black.
    pub fn side_by_side(pictures: &[Self]) -> Self {
        const GAP: usize = 4;
        let height = pictures.iter().map(|p| p.height).max().unwrap_or(0);
        let mut pixels = Vec::new();
        for y in 0..height as usize {
            for (index, picture) in pictures.iter().enumerate() {
                if index > 0 {
                    pixels.extend([[128; 3]; GAP]);
                }
                let row = y * picture.width as usize..(y + 1) * picture.width as usize;
                match picture.pixels.get(row) {
                    Some(row) => pixels.extend_from_slice(row),
                    None => pixels.extend((0..picture.width).map(|_| [0; 3])),
                }
            }
        }
        let width = pixels.len().checked_div(height as usize).unwrap_or(0) as u32;
        Self::of(width, height, pixels)
    }

    /// Writes a PNG file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<(), WriteError> {
        write_atomically(path, |to| self.encode(to))
    }

    /// Writes the bytes of a PNG file.
    pub fn encode(&self, to: &mut dyn io::Write) -> io::Result<()> {
        let encoder = image::codecs::png::PngEncoder::new(to);
        let bytes = self.pixels.as_flattened();
        let written = encoder.write_image(bytes, self.width, self.height, ExtendedColorType::Rgb8);
        written.map_err(|error| match error {
            image::ImageError::IoError(error) => error,
            other => io::Error::other(other.to_string()),
        })
    }

    fn of(width: u32, height: u32, pixels: Vec<[u8; 3]>) -> Self {
        assert_eq!(
            pixels.len(),
            width as usize * height as usize,
            "a picture of {width}x{height} has another number of pixels"
        );
        Self { width, height, pixels }
    }
}

/// The depths that [`Picture::depth`] shows darkest and brightest. Depth is reversed: 1 near, 0 far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthScale {
    /// Shown darkest; > 0.
    pub farthest: f32,
    /// Shown white; at least `farthest`.
    pub nearest: f32,
}

impl DepthScale {
    /// The scale that shows this depth target best: from its nearest pixel down to the farthest hundredth of the covered
    /// ones, which a single far speck may not claim for itself. With nothing covered, everything is background whatever
    /// the scale.
    pub fn of(depth: &[f32]) -> Self {
        let covered = depth.iter().copied().filter(|&d| d > 0.0 && d.is_finite());
        let mut covered: Vec<f32> = covered.collect();
        if covered.is_empty() {
            return Self { farthest: 1.0, nearest: 1.0 };
        }
        let rank = covered.len() / 100;
        let (_, &mut farthest, nearer) = covered.select_nth_unstable_by(rank, f32::total_cmp);
        let nearest = nearer.iter().copied().fold(farthest, f32::max);
        Self { farthest, nearest }
    }

    /// The grey that [`Picture::depth`] gives a depth.
    pub fn grey(self, depth: f32) -> [u8; 3] {
        if !depth.is_finite() {
            return FAULT;
        }
        [(255.0 * self.brightness(depth)).round() as u8; 3]
    }

    /// The same from 0 (background) to 1, before it is rounded.
    pub fn brightness(self, depth: f32) -> f64 {
        const DARKEST: f64 = 32.0 / 255.0;
        if depth <= 0.0 {
            return 0.0;
        }
        let log = |d: f32| f64::from(d).log2();
        let range = log(self.nearest) - log(self.farthest);
        let share = if range > 0.0 { ((log(depth) - log(self.farthest)) / range).clamp(0.0, 1.0) } else { 1.0 };
        DARKEST + share * (1.0 - DARKEST)
    }
}

/// Seven bits for each channel from a bijection of 21 bits, spread over 48..=255: no two of 2^21 indices share a colour,
/// and none is dark enough to be taken for the background.
fn item_colour(item: u32) -> [u8; 3] {
    const BITS: u32 = 21;
    const MASK: u32 = (1 << BITS) - 1;
    if item == NO_ITEM {
        return [0; 3];
    }
    // Odd factors and x ^ (x >> n) are bijections modulo 2^21.
    let mut hash = item & MASK;
    for factor in [0x9e_3779, 0x85_ebcb, 0xc2_b2af] {
        hash = hash.wrapping_mul(factor) & MASK;
        hash ^= hash >> 11;
    }
    [hash, hash >> 7, hash >> 14].map(|bits| (48 + (bits & 127) * 207 / 127) as u8)
}

/// See [`Picture::overdraw`].
fn heat(count: u32) -> [u8; 3] {
    const STOPS: [(u32, [u8; 3]); 6] = [
        (0, [0, 0, 0]),
        (1, [0, 0, 255]),
        (4, [0, 255, 0]),
        (8, [255, 255, 0]),
        (16, [255, 0, 0]),
        (32, [255, 255, 255]),
    ];
    let between = STOPS.windows(2).find(|pair| count < pair[1].0);
    let Some(&[(low, from), (high, to)]) = between.and_then(|pair| pair.first_chunk()) else {
        return [255; 3];
    };
    let part = f64::from(count - low) / f64::from(high - low);
    std::array::from_fn(|channel| {
        let (from, to) = (f64::from(from[channel]), f64::from(to[channel]));
        (from + part * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::files::tests::Folder;
    use std::collections::HashSet;

    fn frame(depth: Vec<f32>) -> FrameImages {
        let count = depth.len();
        FrameImages {
            width: count as u32,
            height: 1,
            colour: vec![[100, 40, 8, 255]; count],
            depth,
            items: vec![0; count],
            seen_through: vec![],
        }
    }

    #[test]
    fn a_picture_is_read_back_as_it_was_written() {
        let folder = Folder::new("png-roundtrip");
        let path = folder.0.join("items.png");
        let mut images = frame(vec![0.0; 6]);
        (images.width, images.height) = (3, 2);
        images.items = vec![0, 1, 2, 3, 70_000, NO_ITEM];
        let picture = Picture::items(&images);
        picture.write(&path).unwrap();
        let bytes = std::fs::read(&path).unwrap();
        let format = image::ImageFormat::Png;
        let read = image::load_from_memory_with_format(&bytes, format).unwrap();
        let read = read.into_rgb8();
        assert_eq!(read.dimensions(), (3, 2));
        assert_eq!(read.into_raw(), picture.pixels.as_flattened());
        assert_eq!(folder.names(), ["items.png"]);
        let nowhere = folder.0.join("no/items.png");
        let error = picture.write(&nowhere).unwrap_err().to_string();
        assert!(error.contains("no/items.png: cannot write it"), "{error}");
    }

    #[test]
    fn nearer_is_brighter_and_background_is_black() {
        let images = frame(vec![0.0, 1e-6, 1e-3, 0.5, 1.0]);
        let picture = Picture::depth(&images, DepthScale::of(&images.depth));
        let greys: Vec<u8> = picture.pixels.iter().map(|grey| grey[0]).collect();
        assert!(greys.windows(2).all(|pair| pair[0] < pair[1]), "{greys:?}");
        assert_eq!((greys[0], greys[1], greys[4]), (0, 32, 255));
        // A step of the same factor is a step of the same grey.
        assert_eq!(greys[2], 32 + (223.0f64 * 0.5).round() as u8);
    }

    #[test]
    fn any_depth_has_a_picture() {
        for depth in [vec![0.0; 4], vec![0.25; 4], vec![], vec![f32::MIN_POSITIVE, 1e-45, 1.0, 3.0]] {
            let images = frame(depth);
            let picture = Picture::depth(&images, DepthScale::of(&images.depth));
            let expected = |&depth: &f32| depth == 0.0;
            let black = picture.pixels.iter().map(|grey| *grey == [0; 3]);
            assert!(black.eq(images.depth.iter().map(expected)));
        }
        let broken = frame(vec![f32::NAN, f32::INFINITY, -1.0, 0.5]);
        let picture = Picture::depth(&broken, DepthScale::of(&broken.depth));
        assert_eq!(picture.pixels, [FAULT, FAULT, [0; 3], [255; 3]]);
    }

    #[test]
    fn one_far_speck_does_not_take_the_contrast() {
        let mut depth: Vec<f32> = (0..1000).map(|i| 0.1 + i as f32 * 1e-4).collect();
        let before = DepthScale::of(&depth);
        depth[0] = 1e-30;
        let after = DepthScale::of(&depth);
        assert_eq!(before, after);
        assert!(after.farthest >= 0.1);
    }

    #[test]
    fn no_two_objects_share_a_colour_and_none_is_black() {
        let colours: HashSet<_> = (0..1u32 << 21).map(item_colour).collect();
        assert_eq!(colours.len(), 1 << 21);
        assert!(colours.iter().flatten().all(|&channel| channel >= 48));
        assert_eq!(item_colour(NO_ITEM), [0; 3]);
    }

    #[test]
    fn the_heat_map_has_its_documented_stops() {
        let counts = [0, 1, 4, 8, 16, 32, 33, u32::MAX];
        let picture = Picture::overdraw(8, 1, &counts);
        let white = [255; 3];
        let expected = [[0; 3], [0, 0, 255], [0, 255, 0], [255, 255, 0], [255, 0, 0], white, white, white];
        assert_eq!(picture.pixels, expected);
        assert_eq!(heat(6), [128, 255, 0]);
    }

    #[test]
    fn the_difference_shows_each_class_in_its_colour() {
        let truth = frame(vec![0.5; 4]);
        let mut method = truth.clone();
        method.depth[1] = 0.25;
        method.items[2] = 1;
        method.colour[3] = [0; 4];
        let picture = Picture::difference(&truth, &method);
        assert_eq!((picture.width, picture.height), (4 + 4 + 4 + 4 + 4, 1));
        assert_eq!(picture.pixels[4], [128; 3]);
        assert_eq!(picture.pixels[11], [0; 3], "the method's colour");
        assert_eq!(picture.pixels[16..], [[25, 10, 2], [255, 0, 0], [40, 80, 255], FAULT]);
    }

    #[test]
    fn pictures_of_other_heights_are_filled_with_black() {
        let white = |width, height| Picture::overdraw(width, height, &vec![32; (width * height) as usize]);
        let both = Picture::side_by_side(&[white(2, 1), white(1, 3)]);
        assert_eq!((both.width, both.height), (7, 3));
        assert_eq!(both.pixels[7..9], [[0; 3]; 2]);
        assert_eq!(both.pixels[20], [255; 3]);
        assert_eq!(Picture::side_by_side(&[]).pixels.len(), 0);
    }
}
