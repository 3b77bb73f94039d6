//! What moves texels between images and buffers.

use super::{range, Recording};
use crate::target::Format;
use crate::transfer::whole_image;
use ash::vk;
use shaders::Bound;
use vk::Handle;

impl Recording<'_> {
    pub(super) fn copy_image(&self, from: u64, format: Format, size: [u32; 2], to: &Bound) {
        let (to, offset, _) = range(to);
        let region = [whole_image(format, size).buffer_offset(offset)];
        let (from, layout) = (vk::Image::from_raw(from), vk::ImageLayout::GENERAL);
        // SAFETY: images are always in the general layout; the buffer has room by `Frame::copy_depth`'s contract.
        unsafe { self.vulkan.device.cmd_copy_image_to_buffer(self.commands, from, layout, to, &region) };
    }

    pub(super) fn fill_image(&self, from: &Bound, to: u64, format: Format, size: [u32; 2]) {
        let (from, offset, _) = range(from);
        let region = [whole_image(format, size).buffer_offset(offset)];
        let (to, layout) = (vk::Image::from_raw(to), vk::ImageLayout::GENERAL);
        // SAFETY: images are always in the general layout; the buffer holds all texels by the contract of `Samples`.
        unsafe { self.vulkan.device.cmd_copy_buffer_to_image(self.commands, from, to, layout, &region) };
    }

    pub(super) fn resolve_colour(&self, from: u64, to: u64, [width, height]: [u32; 2]) {
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let region = [vk::ImageResolve {
            src_subresource: layers,
            dst_subresource: layers,
            extent: vk::Extent3D { width, height, depth: 1 },
            ..Default::default()
        }];
        let (from, to) = (vk::Image::from_raw(from), vk::Image::from_raw(to));
        let layout = vk::ImageLayout::GENERAL;
        // SAFETY: images are always in the general layout; both have this size and one format, and the second has one sample.
        unsafe { self.vulkan.device.cmd_resolve_image(self.commands, from, layout, to, layout, &region) };
    }
}
