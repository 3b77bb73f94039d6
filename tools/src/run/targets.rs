//! The images that frames are drawn to, and how they are read back.

use super::samples::Sampled;
use super::stray::stray_px;
use crate::measures::metrics::FrameImages;
use anyhow::Result;
use culling::{View, World};
use engine::{Format, FrameReport, Gpu, Image, Target};
use shaders::types::SAMPLE_REACH_PX;

/// Colour, item buffer and depth of one size.
pub struct Targets {
    colour: Image,
    item: Image,
    depth: Image,
    count: Option<Image>,
    /// None: pixels have one sample.
    sampled: Option<Sampled>,
    /// How far beside a sample the device takes its depth.
    stray_px: f32,
}

impl Targets {
    /// Targets of `size` pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> engine::Result<Self> {
        Ok(Targets {
            colour: Image::new(gpu, "target.colour", Format::Colour, size)?,
            item: Image::new(gpu, "target.item", Format::Item, size)?,
            depth: Image::new(gpu, "target.depth", Format::Depth, size)?,
            count: None,
            sampled: None,
            stray_px: 0.0,
        })
    }

    /// The same with 1 or 4 samples a pixel. Measured pictures are then of the samples, twice as wide and high, and
    /// [`Targets::colour`] is what they come to.
    ///
    /// # Errors
    /// A device, or a format of its depth, that has not so many.
    pub fn with_samples(gpu: &Gpu, size: [u32; 2], samples: u32) -> Result<Self> {
        let targets = Self::new(gpu, size)?;
        if samples == 1 {
            return Ok(targets);
        }
        let sampled = Some(Sampled::new(gpu, size, samples)?);
        Ok(Targets { sampled, stray_px: stray_px(gpu)?, ..targets })
    }

    /// How far from a pixel's centre what is drawn there may be found: the device's vertex grid, and where pixels have several samples their reach
    /// and how far beside them their depths are taken.
    pub fn reach_px(&self, gpu: &Gpu) -> f32 {
        gpu.snap_px() + if self.sampled.is_some() { SAMPLE_REACH_PX + self.stray_px } else { 0.0 }
    }

    /// How far beside a sample the device takes its depth, in pixels: 0, but for faults of devices; 0 where pixels have one sample.
    pub fn stray_px(&self) -> f32 {
        self.stray_px
    }

    /// Samples a pixel.
    pub fn samples(&self) -> u32 {
        self.sampled.as_ref().map_or(1, Sampled::count)
    }

    /// The picture that frames draw.
    pub fn colour(&self) -> &Image {
        &self.colour
    }

    /// What timed frames draw to: colour and depth.
    pub fn timed(&self) -> Target {
        Target {
            size: self.colour.size(),
            colour: Some((self.colour.view(), Format::Colour)),
            item: None,
            depth: self.depth.view(),
            depth_read_only: false,
            strictly_nearer: false,
            samples: self.sampled.as_ref().map(Sampled::drawn),
        }
    }

    /// What untimed frames draw to: the item buffer too.
    pub fn with_items(&self) -> Target {
        let item = if self.sampled.is_some() { None } else { Some(self.item.view()) };
        Target { item, ..self.timed() }
    }

    /// A target that counts fragments instead of shading them. It shares the depth buffer.
    pub fn counting(&mut self, gpu: &Gpu) -> engine::Result<Target> {
        let count = match self.count.take() {
            Some(count) => count,
            None => Image::new(gpu, "target.count", Format::Heat, self.colour.size())?,
        };
        let colour = Some((count.view(), Format::Heat));
        self.count = Some(count);
        // Fragments are counted at the pixels' centres.
        Ok(Target { colour, samples: None, ..self.timed() })
    }

    /// Reads the counts of the last frame that counted: exact up to 2048 a pixel, where half floats end counting.
    pub fn read_counts(&self) -> engine::Result<Vec<u32>> {
        let Some(count) = &self.count else { return Ok(Vec::new()) };
        Ok(bytemuck::pod_collect_to_vec::<u8, u16>(&count.read()?).into_iter().map(count_from_half).collect())
    }

    /// Reads what a frame drew, once it is finished: all three images, of a frame that had the item buffer on; of several samples a pixel,
    /// these, and whose they are by drawing the frame's lists again.
    pub fn read_frame(&self, world: &World, view: &View, report: &FrameReport) -> Result<FrameImages> {
        match &self.sampled {
            None => Ok(self.read()?),
            Some(sampled) => sampled.read(&self.timed(), world, view, report),
        }
    }

    /// Reads all three images of the last frame that had the item buffer on; of several samples a pixel, what these came to.
    pub fn read(&self) -> engine::Result<FrameImages> {
        let [width, height] = self.colour.size();
        let [colour, depth, items] = Image::read_together([&self.colour, &self.depth, &self.item])?;
        Ok(FrameImages {
            width,
            height,
            colour: bytemuck::pod_collect_to_vec(&colour),
            depth: bytemuck::pod_collect_to_vec(&depth),
            items: bytemuck::pod_collect_to_vec(&items),
            seen_through: Vec::new(),
        })
    }

    /// What is counted by pixel, in a picture as large as those that [`Targets::read_frame`] gives.
    pub fn spread(&self, counts: Vec<u32>) -> Vec<u32> {
        if self.sampled.is_none() {
            return counts;
        }
        let twice = |row: &[u32]| row.iter().flat_map(|count| [*count; 2]).collect::<Vec<_>>();
        let rows = counts.chunks(self.colour.size()[0] as usize).map(twice);
        rows.flat_map(|row| row.repeat(2)).collect()
    }

    /// Reads the item buffer alone.
    pub fn read_items(&self) -> engine::Result<Vec<u32>> {
        Ok(bytemuck::pod_collect_to_vec(&self.item.read()?))
    }
}

/// A whole number stored as a half float, which is how the blender adds counts up.
fn count_from_half(bits: u16) -> u32 {
    let (exponent, fraction) = (i32::from(bits >> 10 & 31), u32::from(bits & 1023));
    if exponent < 15 {
        return 0;
    }
    let significand = 1024 + fraction;
    if exponent >= 25 {
        significand << (exponent - 25)
    } else {
        significand >> (25 - exponent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_floats_count_exactly() {
        for (bits, count) in
            [(0x0000, 0), (0x3c00, 1), (0x4000, 2), (0x4200, 3), (0x4900, 10), (0x63ff, 1023), (0x6800, 2048)]
        {
            assert_eq!(count_from_half(bits), count, "{bits:#x}");
        }
    }
}
