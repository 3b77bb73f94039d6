//! What images hold, and what a frame draws to.

use crate::depth::DepthFormat;
use ash::vk;
use shaders::ImageRef;

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
}

impl Format {
    pub(crate) fn vulkan(self, depth: DepthFormat) -> vk::Format {
        match self {
            Format::Colour => vk::Format::R8G8B8A8_UNORM,
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
            Format::Colour | Format::Item => 4,
        }
    }

    /// The name of the Vulkan format.
    pub fn name(self, depth: DepthFormat) -> &'static str {
        match self {
            Format::Colour => "R8G8B8A8_UNORM",
            Format::Item => "R32_UINT",
            Format::Depth => depth.name(),
            Format::Heat => "R16_SFLOAT",
        }
    }
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
}

impl Target {
    /// The same images, on which what was drawn before keeps its pixels against what is as near.
    pub fn keeping_ties(&self) -> Target {
        Target { strictly_nearer: true, ..*self }
    }

    /// The same depth, tested and written, and nothing else: what a depth prepass draws to.
    pub fn depth_only(&self) -> Target {
        Target { colour: None, item: None, ..*self }
    }

    /// The same depth, tested and not written, and nothing else: what visibility tests draw to.
    pub fn test_only(&self) -> Target {
        Target { colour: None, item: None, depth_read_only: true, ..*self }
    }
}
