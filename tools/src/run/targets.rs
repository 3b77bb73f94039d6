//! The images that frames are drawn to, and how they are read back.

use crate::measures::metrics::FrameImages;
use engine::{Format, Gpu, Image, Result, Target};

/// Colour, item buffer and depth of one size.
pub struct Targets {
    colour: Image,
    item: Image,
    depth: Image,
    count: Option<Image>,
}

impl Targets {
    /// Targets of `size` pixels.
    pub fn new(gpu: &Gpu, size: [u32; 2]) -> Result<Self> {
        Ok(Targets {
            colour: Image::new(gpu, "target.colour", Format::Colour, size)?,
            item: Image::new(gpu, "target.item", Format::Item, size)?,
            depth: Image::new(gpu, "target.depth", Format::Depth, size)?,
            count: None,
        })
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
        }
    }

    /// What untimed frames draw to: the item buffer too.
    pub fn with_items(&self) -> Target {
        Target { item: Some(self.item.view()), ..self.timed() }
    }

    /// A target that counts fragments instead of shading them. It shares the depth buffer.
    pub fn counting(&mut self, gpu: &Gpu) -> Result<Target> {
        let count = match self.count.take() {
            Some(count) => count,
            None => Image::new(gpu, "target.count", Format::Heat, self.colour.size())?,
        };
        let colour = Some((count.view(), Format::Heat));
        self.count = Some(count);
        Ok(Target { colour, ..self.timed() })
    }

    /// Reads the counts of the last frame that counted: exact up to 2048 a pixel, where half floats end counting.
    pub fn read_counts(&self) -> Result<Vec<u32>> {
        let Some(count) = &self.count else { return Ok(Vec::new()) };
        Ok(bytemuck::pod_collect_to_vec::<u8, u16>(&count.read()?).into_iter().map(count_from_half).collect())
    }

    /// Reads all three images of the last frame that had the item buffer on.
    pub fn read(&self) -> Result<FrameImages> {
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

    /// Reads the item buffer alone.
    pub fn read_items(&self) -> Result<Vec<u32>> {
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
