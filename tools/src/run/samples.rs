//! Pictures of several samples a pixel: what they are drawn to, and how the samples are read.

use crate::measures::metrics::FrameImages;
use anyhow::{bail, Context, Result};
use culling::{View, World};
use engine::{Buffer, DepthFormat, Format, FrameReport, Gpu, Image, KeptSample, Placement, Samples, Target};
use shaders::engine::{SpreadSamples, SpreadSamplesConstants};

/// The only number of samples but 1: `engine/spread_samples` lays them out in squares.
pub const SAMPLES: u32 = 4;

/// Colours, depths and owners of samples.
pub(super) struct Sampled {
    gpu: Gpu,
    count: u32,
    size: [u32; 2],
    colour: Image,
    depth: Image,
    /// Depths of pixels on their way into the image that stages read.
    resolved: Buffer<f32>,
    owners: Image,
    spread: Buffer<u32>,
}

impl Sampled {
    pub(super) fn new(gpu: &Gpu, size: [u32; 2], count: u32) -> Result<Self> {
        if count != SAMPLES {
            bail!("--samples {count}: 1 or {SAMPLES} samples a pixel");
        }
        if !matches!(gpu.depth(), DepthFormat::ReversedD32 | DepthFormat::StandardD32) {
            bail!(
                "--samples {count}: depths of samples are resolved as floats, not as {}; leave --depth-format out",
                gpu.depth()
            );
        }
        let image = |name: &str, format: Format| Image::with_samples(gpu, name, format, size, count);
        let pixels = size[0] as usize * size[1] as usize;
        Ok(Sampled {
            gpu: gpu.clone(),
            count,
            size,
            colour: image("samples.colour", Format::Colour).context("--samples")?,
            depth: image("samples.depth", Format::Depth).context("--samples")?,
            resolved: Buffer::new(gpu, "samples.resolved", pixels, Placement::Storage)?,
            owners: image("samples.owners", Format::Owner).context("--samples")?,
            spread: Buffer::new(gpu, "samples.spread", pixels * count as usize, Placement::Storage)?,
        })
    }

    /// Depths of samples as they are, reversed, in a picture twice as wide and high.
    pub(super) fn read_depths(&self) -> Result<Vec<f32>> {
        let depth = self.spread(&self.depth, true)?;
        Ok(depth.into_iter().map(f32::from_bits).map(|kept| self.reversed(kept)).collect())
    }

    pub(super) fn count(&self) -> u32 {
        self.count
    }

    /// What frames draw to beside the images that stages read.
    pub(super) fn drawn(&self) -> Samples {
        Samples {
            count: self.count,
            colour: Some(self.colour.view()),
            depth: self.depth.view(),
            kept: KeptSample::Farthest,
            resolved: self.resolved.all().into(),
        }
    }

    /// What a frame left, a sample each, in pictures twice as wide and high; drawing its lists once more, in their order, says whose each is.
    pub(super) fn read(&self, drawn: &Target, world: &World, view: &View, report: &FrameReport) -> Result<FrameImages> {
        let colour = self.spread(&self.colour, false)?;
        let depth = self.read_depths()?;
        let samples = Samples { colour: Some(self.owners.view()), ..self.drawn() };
        let colour_of_pixels = drawn.colour.map(|(image, _)| (image, Format::Owner));
        let target = Target { colour: colour_of_pixels, item: None, samples: Some(samples), ..*drawn };
        let mut f = self.gpu.frame();
        f.clear(&target);
        world.draw_again(&mut f, &report.draws, view, &target);
        f.finish_unresolved().context("drawing whose samples are")?;
        Ok(FrameImages {
            width: 2 * self.size[0],
            height: 2 * self.size[1],
            colour: bytemuck::cast_vec(colour.into_iter().map(u32::to_ne_bytes).collect()),
            depth,
            items: self.spread(&self.owners, false)?,
            seen_through: Vec::new(),
        })
    }

    fn reversed(&self, kept: f32) -> f32 {
        if self.gpu.depth().is_standard() {
            1.0 - kept
        } else {
            kept
        }
    }

    fn spread(&self, image: &Image, floats: bool) -> Result<Vec<u32>> {
        let mut f = self.gpu.frame();
        let stage = SpreadSamples {
            image: image.view(),
            spread: self.spread.all(),
            size_px: self.size,
            constants: SpreadSamplesConstants { floats },
        };
        f.dispatch(stage, self.spread.len() as u32);
        f.finish().context("reading samples")?;
        Ok(self.spread.read()?)
    }
}
