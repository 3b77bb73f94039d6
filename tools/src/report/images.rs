//! The report's pictures, collected while the untimed pass runs: each method's worst frame, and overdraw and item buffer of one
//! frame. Only these are kept, made small and packed as PNG, since a run may have many frames and methods.

use crate::bench::Seen;
use crate::metrics::{class_of, FrameError, FrameImages, PixelClass};
use crate::png_out::Picture;
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
            let shown = [small_colour(truth)?, small_colour(images)?, small_difference(truth, images)?];
            pictures.worst = Some(WorstFrame { frame: seen.frame, error: error.clone(), pictures: shown });
        }
        if seen.frame == self.frame && self.wanted.iter().any(|label| label == seen.label) {
            pictures.buffers = Some([small_overdraw(images, &seen.measured.counts)?, small_items(images)?]);
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

    /// The picture whose every pixel is made of the source pixels (by index) that it covers, at least one. Together they
    /// are all pixels of the source, each once.
    fn picture(&self, colour: impl Fn(&[usize]) -> [u8; 3]) -> io::Result<DataUri> {
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
        data_uri(&Picture { width: self.to[0] as u32, height: self.to[1] as u32, pixels })
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

fn small_colour(images: &FrameImages) -> io::Result<DataUri> {
    Shrink::of(images.width, images.height)
        .picture(|covered| mean(covered.iter().map(|&pixel| rgb(images.colour[pixel]))))
}

/// A single wrong pixel must not be averaged away: the gravest class among the covered pixels gives the colour. The colours are
/// those of [`Picture::difference`].
fn small_difference(truth: &FrameImages, method: &FrameImages) -> io::Result<DataUri> {
    let marked = Picture::differences(truth, method);
    let gravity = |pixel: usize| match class_of(truth, method, pixel) {
        PixelClass::WrongColour => 3,
        PixelClass::Differs => 2,
        PixelClass::Tied => 1,
        PixelClass::Same => 0,
    };
    Shrink::of(truth.width, truth.height).picture(|covered| {
        let gravest = covered.iter().map(|&pixel| gravity(pixel)).max().unwrap_or(0);
        let of_gravest: Vec<_> = covered.iter().filter(|&&pixel| gravity(pixel) == gravest).collect();
        mean(of_gravest.into_iter().map(|&pixel| marked.pixels[pixel]))
    })
}

fn small_overdraw(images: &FrameImages, counts: &[u32]) -> io::Result<DataUri> {
    let heat = Picture::overdraw(images.width, images.height, counts);
    Shrink::of(images.width, images.height).picture(|covered| mean(covered.iter().map(|&pixel| heat.pixels[pixel])))
}

/// Colours of objects are names: their mean would name an object that is not there. The middle pixel stands for all.
fn small_items(images: &FrameImages) -> io::Result<DataUri> {
    let items = Picture::items(images);
    Shrink::of(images.width, images.height).picture(|covered| items.pixels[covered[covered.len() / 2]])
}

#[cfg(test)]
mod tests;
