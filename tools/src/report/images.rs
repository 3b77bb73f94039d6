//! The report's pictures, collected while the untimed pass runs: each method's worst frame, and overdraw and item buffer of one
//! frame. Only these are kept, made small and packed as PNG, since a run may have many frames and methods.

use crate::measures::metrics::{class_of, FrameError, FrameImages, PixelClass};
use crate::pictures::png_out::Picture;
use crate::run::bench::Seen;
use base64::Engine;
use std::collections::BTreeMap;
use std::io;

/// Widest picture in a report, pixels.
const WIDEST: u32 = 640;

/// Settings whose overdraw and item buffer are shown; of a sweep's more, only the first setting of each method.
const SHOWN_IN_FULL: usize = 16;

/// A PNG file as a data URI, so that the report needs no other file.
pub type DataUri = String;

/// The pictures of a run.
#[derive(Default)]
pub struct Gallery {
    /// The frame whose overdraw and item buffers are shown.
    pub frame: usize,
    /// By label.
    pub of_method: BTreeMap<String, MethodPictures>,
    /// Labels whose overdraw and item buffer are wanted.
    wanted: Vec<String>,
}

/// One method's pictures.
#[derive(Default)]
pub struct MethodPictures {
    /// Its worst frame; none if every frame is as the truth.
    pub worst: Option<WorstFrame>,
    /// Overdraw as a heat map, and the item buffer, of [`Gallery::frame`].
    pub buffers: Option<[DataUri; 2]>,
}

/// A frame beside the truth.
pub struct WorstFrame {
    /// Its number, from 0.
    pub frame: usize,
    /// How far it is from the truth.
    pub error: FrameError,
    /// Truth, the method's picture, and the truth darkened with the difference marked.
    pub pictures: [DataUri; 3],
}

impl Gallery {
    /// For a run of so many frames of methods, given as label and id: the frame in the middle stands for all.
    pub fn new<'a>(frames: usize, methods: impl IntoIterator<Item = (String, &'a str)>) -> Self {
        let methods: Vec<_> = methods.into_iter().collect();
        let few = methods.len() <= SHOWN_IN_FULL;
        let first = |place: usize| methods[..place].iter().all(|(_, id)| *id != methods[place].1);
        let wanted = (0..methods.len()).filter(|&place| few || first(place));
        Gallery {
            frame: frames / 2,
            wanted: wanted.map(|place| methods[place].0.clone()).collect(),
            of_method: BTreeMap::new(),
        }
    }

    /// Takes what it wants of a measured frame.
    ///
    /// # Errors
    /// A picture cannot be packed.
    pub fn look(&mut self, seen: &Seen<'_>) -> io::Result<()> {
        let pictures = self.of_method.entry(seen.label.to_owned()).or_default();
        let (truth, images, error) = (seen.truth, &seen.measured.images, &seen.measured.error);
        if is_worse(error, pictures.worst.as_ref().map(|worst| &worst.error)) {
            let [truth, drawn, marked] = [small_colour(truth), small_colour(images), small_difference(truth, images)];
            let shown = [data_uri(&truth)?, data_uri(&drawn)?, data_uri(&marked)?];
            pictures.worst = Some(WorstFrame { frame: seen.frame, error: error.clone(), pictures: shown });
        }
        if seen.frame == self.frame && self.wanted.iter().any(|label| label == seen.label) {
            let overdraw = small_overdraw(images, &seen.measured.counts);
            pictures.buffers = Some([data_uri(&overdraw)?, data_uri(&small_items(images))?]);
        }
        Ok(())
    }
}

/// Does this frame show a fault, and a worse one than the worst so far? First counts PSNR, then missed objects, which need not
/// show where another object of equal depth covers them. The first of equally bad frames stays.
fn is_worse(error: &FrameError, worst: Option<&FrameError>) -> bool {
    let badness = |error: &FrameError| (-error.psnr_db.unwrap_or(f64::INFINITY), error.false_negatives as f64);
    let faulty = error.differing_pixels + error.wrong_colour_pixels + error.false_negatives > 0;
    faulty && worst.is_none_or(|worst| badness(error) > badness(worst))
}

/// Which source pixels each small pixel stands for.
struct Shrink {
    from: [usize; 2],
    to: [usize; 2],
}

impl Shrink {
    fn of(width: u32, height: u32) -> Self {
        let small = width.min(WIDEST);
        let small_height = (u64::from(height) * u64::from(small) / u64::from(width.max(1))).max(1);
        Shrink { from: [width as usize, height as usize], to: [small as usize, small_height as usize] }
    }

    /// The column and row of the small pixel that covers a source pixel.
    fn place_of(&self, pixel: usize) -> [usize; 2] {
        let at = [pixel % self.from[0], pixel / self.from[0]];
        // The last small pixel whose first source pixel is not beyond this one.
        std::array::from_fn(|axis| ((at[axis] + 1) * self.to[axis]).div_ceil(self.from[axis]) - 1)
    }

    /// The picture whose every pixel is made of the source pixels (by index) that it covers, at least one. Together they
    /// are all pixels of the source, each once.
    fn picture(&self, colour: impl Fn(&[usize]) -> [u8; 3]) -> Picture {
        let range =
            |axis: usize, at: usize| at * self.from[axis] / self.to[axis]..(at + 1) * self.from[axis] / self.to[axis];
        let mut pixels = Vec::with_capacity(self.to[0] * self.to[1]);
        let mut covered = Vec::new();
        for y in 0..self.to[1] {
            for x in 0..self.to[0] {
                covered.clear();
                covered.extend(range(1, y).flat_map(|row| range(0, x).map(move |column| row * self.from[0] + column)));
                pixels.push(colour(&covered));
            }
        }
        Picture { width: self.to[0] as u32, height: self.to[1] as u32, pixels }
    }
}

fn data_uri(picture: &Picture) -> io::Result<DataUri> {
    let mut bytes = Vec::new();
    picture.encode(&mut bytes)?;
    Ok(format!("data:image/png;base64,{}", base64::engine::general_purpose::STANDARD.encode(bytes)))
}

/// The mean of 8-bit channels, rounded.
fn mean(colours: impl ExactSizeIterator<Item = [u8; 3]>) -> [u8; 3] {
    let count = colours.len().max(1) as u32;
    let mut sums = [count / 2; 3];
    for colour in colours {
        (0..3).for_each(|channel| sums[channel] += u32::from(colour[channel]));
    }
    sums.map(|sum| (sum / count) as u8)
}

fn rgb([red, green, blue, _]: [u8; 4]) -> [u8; 3] {
    [red, green, blue]
}

fn small_colour(images: &FrameImages) -> Picture {
    Shrink::of(images.width, images.height)
        .picture(|covered| mean(covered.iter().map(|&pixel| rgb(images.colour[pixel]))))
}

/// A single wrong pixel must not be averaged away: the gravest class among the covered pixels gives the colour. The colours are
/// those of [`Picture::difference`]. A frame around all faults shows where to look.
fn small_difference(truth: &FrameImages, method: &FrameImages) -> Picture {
    let marked = Picture::differences(truth, method);
    let gravity = |pixel: usize| match class_of(truth, method, pixel) {
        PixelClass::WrongColour => 3,
        PixelClass::Differs => 2,
        PixelClass::Tied => 1,
        PixelClass::Same => 0,
    };
    let shrink = Shrink::of(truth.width, truth.height);
    let mut small = shrink.picture(|covered| {
        let gravest = covered.iter().map(|&pixel| gravity(pixel)).max().unwrap_or(0);
        let of_gravest: Vec<_> = covered.iter().filter(|&&pixel| gravity(pixel) == gravest).collect();
        mean(of_gravest.into_iter().map(|&pixel| marked.pixels[pixel]))
    });
    let faults = (0..marked.pixels.len()).filter(|&pixel| gravity(pixel) >= 2);
    frame_around(&mut small, faults.map(|pixel| shrink.place_of(pixel)));
    small
}

/// Draws a yellow frame around places (column and row), some pixels away from them; none without places.
fn frame_around(picture: &mut Picture, places: impl Iterator<Item = [usize; 2]>) {
    const COLOUR: [u8; 3] = [255, 220, 0];
    const GAP: usize = 6;
    const THICK: usize = 2;
    let extent = places.fold(None, |extent: Option<[[usize; 2]; 2]>, at| {
        let [low, high] = extent.unwrap_or([at, at]);
        Some([[low[0].min(at[0]), low[1].min(at[1])], [high[0].max(at[0]), high[1].max(at[1])]])
    });
    let Some([low, high]) = extent else { return };
    let size = [picture.width as usize, picture.height as usize];
    // How far outside of the faults a place is, along the axis where it is farthest.
    let outside = |at: [usize; 2]| {
        let along = |axis: usize| low[axis].saturating_sub(at[axis]).max(at[axis].saturating_sub(high[axis]));
        along(0).max(along(1))
    };
    for y in 0..size[1] {
        for x in 0..size[0] {
            if (GAP..GAP + THICK).contains(&outside([x, y])) {
                picture.pixels[y * size[0] + x] = COLOUR;
            }
        }
    }
}

/// The mean of the colours, so that what is thin fades instead of jumping.
fn small_overdraw(images: &FrameImages, counts: &[u32]) -> Picture {
    let heat = Picture::overdraw(images.width, images.height, counts);
    Shrink::of(images.width, images.height).picture(|covered| mean(covered.iter().map(|&pixel| heat.pixels[pixel])))
}

/// Colours of objects are names: their mean would name an object that is not there. The middle pixel stands for all.
fn small_items(images: &FrameImages) -> Picture {
    let items = Picture::items(images);
    Shrink::of(images.width, images.height).picture(|covered| items.pixels[covered[covered.len() / 2]])
}

#[cfg(test)]
mod tests;
