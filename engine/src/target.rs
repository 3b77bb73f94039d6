//! What images hold, and what a frame draws to.

use crate::depth::DepthFormat;
use ash::vk;
use shaders::{Bound, ImageRef};

/// What an image holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// Red, green, blue, alpha, 8 bits each.
    Colour,
    /// An object index a pixel: the item buffer.
    Item,
    /// Depth, in the device's [`DepthFormat`].
    Depth,
    /// A half float a pixel: counts of fragments.
    Heat,
    /// The bytes of an object index a sample: an item buffer where pixels have several samples, as not every device has whole numbers there.
    Owner,
}

impl Format {
    pub(crate) fn vulkan(self, depth: DepthFormat) -> vk::Format {
        match self {
            Format::Colour | Format::Owner => vk::Format::R8G8B8A8_UNORM,
            Format::Item => vk::Format::R32_UINT,
            Format::Depth => depth.vulkan(),
            Format::Heat => vk::Format::R16_SFLOAT,
        }
    }

    pub(crate) fn aspect(self) -> vk::ImageAspectFlags {
        if self == Format::Depth {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        }
    }

    /// Bytes a texel takes in a copy.
    pub(crate) fn texel_bytes(self, depth: DepthFormat) -> usize {
        match self {
            Format::Heat => 2,
            Format::Depth => depth.texel_bytes(),
            Format::Colour | Format::Item | Format::Owner => 4,
        }
    }

    /// The name of the Vulkan format.
    pub fn name(self, depth: DepthFormat) -> &'static str {
        match self {
            Format::Colour | Format::Owner => "R8G8B8A8_UNORM",
            Format::Item => "R32_UINT",
            Format::Depth => depth.name(),
            Format::Heat => "R16_SFLOAT",
        }
    }
}

/// What a frame draws to where pixels have several samples.
///
/// Stages go on reading [`Target::depth`]: before one does, the frame resolves the samples' depths into it, whenever they were drawn to since
/// (`engine/resolve_depth`). [`Target::colour`] is resolved at the frame's end. There is no item buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Samples {
    /// How many, of a pixel.
    pub count: u32,
    /// The colours that are drawn.
    pub colour: Option<ImageRef>,
    /// The depths that are drawn.
    pub depth: ImageRef,
    /// Which of them the pixel's is.
    pub kept: KeptSample,
    /// Room for a float a pixel: resolved depths on their way into the image.
    pub resolved: Bound,
}

/// Which sample's depth becomes the pixel's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum KeptSample {
    /// The farthest: what lies behind it lies behind every sample, so that culling stays right.
    #[default]
    Farthest,
    /// The nearest, which says too much is hidden at every outline: what tests plant.
    Nearest,
}

/// What a frame draws to. The item buffer is bound only where a truth or method needs it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Target {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// First colour attachment, with what it holds.
    pub colour: Option<(ImageRef, Format)>,
    /// The item buffer.
    pub item: Option<ImageRef>,
    /// The depth buffer.
    pub depth: ImageRef,
    /// Depth is only tested, and may be read as a texture at the same time.
    pub depth_read_only: bool,
    /// A fragment must be nearer than what is there. Otherwise one as near passes too, so that the last one drawn stays.
    pub strictly_nearer: bool,
    /// None: pixels have one sample.
    pub samples: Option<Samples>,
}

impl Target {
    /// The same images, on which what was drawn before keeps its pixels against what is as near.
    pub fn keeping_ties(&self) -> Target {
        Target { strictly_nearer: true, ..*self }
    }

    /// The same depth, tested and written, and nothing else: what a depth prepass draws to.
    pub fn depth_only(&self) -> Target {
        Target { colour: None, item: None, samples: self.samples.map(Samples::without_colour), ..*self }
    }

    /// The same depth, tested and not written, and nothing else: what visibility tests draw to.
    pub fn test_only(&self) -> Target {
        Target { depth_read_only: true, ..self.depth_only() }
    }

    /// The images that are drawn to, in the order of attachments.
    pub(crate) fn drawn_colours(&self) -> impl Iterator<Item = (ImageRef, Format)> {
        let colour = match (self.colour, self.samples) {
            (Some((_, format)), Some(samples)) => samples.colour.map(|image| (image, format)),
            (colour, _) => colour,
        };
        colour.into_iter().chain(self.item.map(|image| (image, Format::Item)))
    }

    /// The depth that is drawn to.
    pub(crate) fn drawn_depth(&self) -> ImageRef {
        self.samples.map_or(self.depth, |samples| samples.depth)
    }
}

impl Samples {
    fn without_colour(self) -> Samples {
        Samples { colour: None, ..self }
    }
}
