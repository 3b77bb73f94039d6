//! The images that frames are drawn to, and how they are read back.

use crate::metrics::FrameImages;
use engine::{Format, Gpu, Image, Result, Target};

/// Colour, item buffer and depth of one size.
pub struct Targets {
    colour: Image,
    item: Image,
    depth: Image,
}

impl Targets {
    /// Targets of `size` pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self> {
        Ok(Targets {
            colour: Image::new(gpu, "target.colour", Format::Colour, size)?,
            item: Image::new(gpu, "target.item", Format::Item, size)?,
            depth: Image::new(gpu, "target.depth", Format::Depth, size)?,
        })
    }

    /// What timed frames draw to: colour and depth.
    pub fn timed(&self) -> Target {
        Target {
            size: self.colour.size(),
            colour: Some((self.colour.view(), Format::Colour)),
            item: None,
            depth: self.depth.view(),
        }
    }

    /// What untimed frames draw to: the item buffer too.
    pub fn with_items(&self) -> Target {
        Target { item: Some(self.item.view()), ..self.timed() }
    }

    /// Reads all three images of the last frame that had the item buffer on.
    pub fn read(&self) -> Result<FrameImages> {
        let [width, height] = self.colour.size();
        Ok(FrameImages {
            width,
            height,
            colour: bytemuck::pod_collect_to_vec(&self.colour.read()?),
            depth: bytemuck::pod_collect_to_vec(&self.depth.read()?),
            items: self.read_items()?,
        })
    }

    /// Reads the item buffer alone.
    pub fn read_items(&self) -> Result<Vec<u32>> {
        Ok(bytemuck::pod_collect_to_vec(&self.item.read()?))
    }
}
