//! The images that a window shows, and what each answer of the window system asks for.

use crate::error::Named;
use crate::gpu::Vulkan;
use crate::{Error, Result};
use ash::{khr, vk};

/// The longest that a window may keep us waiting for an image, in nanoseconds: one that nobody sees may give none at all.
const PATIENCE_NS: u64 = 100_000_000;

/// What to do after an answer of the window system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Next {
    /// Go on: it was done.
    Go,
    /// Leave this frame out: the window has no image to give.
    Skip,
    /// Make the images again: they no longer fit the window.
    Images,
    /// Make the surface again, and its images: the window system took it back.
    Surface,
}

/// What an answer asks for; what no new image or surface would mend is an error. Suboptimal images are shown all the same: whether
/// their size fits is looked at before each frame.
pub(crate) fn next(call: &'static str, answer: vk::Result) -> Result<Next> {
    match answer {
        vk::Result::SUCCESS | vk::Result::SUBOPTIMAL_KHR => Ok(Next::Go),
        vk::Result::TIMEOUT | vk::Result::NOT_READY => Ok(Next::Skip),
        vk::Result::ERROR_OUT_OF_DATE_KHR => Ok(Next::Images),
        vk::Result::ERROR_SURFACE_LOST_KHR => Ok(Next::Surface),
        vk::Result::ERROR_DEVICE_LOST => Err(Error::DeviceLost { stage: LABEL.to_owned() }),
        result => Err(Error::Vulkan { call, result }),
    }
}

/// What showing a frame is called in captures and messages.
pub(crate) const LABEL: &str = "window/show";

/// The pixels that a surface will take: the window's own, or what is wanted where the surface follows its images; none if that is no
/// pixel, as of a minimised window.
pub(crate) fn extent(capabilities: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> Option<[u32; 2]> {
    let current = capabilities.current_extent;
    let [width, height] = if current.width == u32::MAX { wanted } else { [current.width, current.height] };
    let (least, most) = (capabilities.min_image_extent, capabilities.max_image_extent);
    if width == 0 || height == 0 || most.width == 0 || most.height == 0 {
        return None;
    }
    Some([width.clamp(least.width, most.width), height.clamp(least.height, most.height)])
}

/// Images of one size that a window shows in turn.
pub(crate) struct Swapchain {
    loader: khr::swapchain::Device,
    raw: vk::SwapchainKHR,
    images: Vec<vk::Image>,
    pub(crate) size: [u32; 2],
    given: vk::Semaphore,
    /// By image: the device is done with it. An image that is given anew has been shown, so its semaphore is free.
    done: Vec<vk::Semaphore>,
}

/// What the images of a surface must be like.
pub(crate) struct Wish {
    pub(crate) surface: vk::SurfaceKHR,
    pub(crate) format: vk::SurfaceFormatKHR,
    pub(crate) mode: vk::PresentModeKHR,
    pub(crate) size: [u32; 2],
    pub(crate) capabilities: vk::SurfaceCapabilitiesKHR,
}

impl Swapchain {
    /// Images for a surface. What was there before must be gone.
    pub(crate) fn new(vulkan: &Vulkan, wish: &Wish) -> std::result::Result<Self, vk::Result> {
        let loader = khr::swapchain::Device::new(&vulkan.instance.raw, &vulkan.device);
        let most = if wish.capabilities.max_image_count == 0 { u32::MAX } else { wish.capabilities.max_image_count };
        let [width, height] = wish.size;
        let opaque = [vk::CompositeAlphaFlagsKHR::OPAQUE, vk::CompositeAlphaFlagsKHR::INHERIT];
        let supported =
            |alpha: &vk::CompositeAlphaFlagsKHR| wish.capabilities.supported_composite_alpha.contains(*alpha);
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(wish.surface)
            .min_image_count((wish.capabilities.min_image_count + 1).min(most))
            .image_format(wish.format.format)
            .image_color_space(wish.format.color_space)
            .image_extent(vk::Extent2D { width, height })
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
            .image_sharing_mode(vk::SharingMode::EXCLUSIVE)
            .pre_transform(wish.capabilities.current_transform)
            .composite_alpha(opaque.into_iter().find(supported).unwrap_or(vk::CompositeAlphaFlagsKHR::PRE_MULTIPLIED))
            .present_mode(wish.mode)
            .clipped(true);
        // SAFETY: the surface is alive and shown by no other swapchain; format, mode and size are among those it said it takes.
        let raw = unsafe { loader.create_swapchain(&info, None) }?;
        let mut made = Swapchain {
            loader,
            raw,
            images: Vec::new(),
            size: wish.size,
            given: vk::Semaphore::null(),
            done: Vec::new(),
        };
        let filled = made.fill(vulkan);
        if filled.is_err() {
            made.destroy(vulkan);
        }
        filled.map(|()| made)
    }

    fn fill(&mut self, vulkan: &Vulkan) -> std::result::Result<(), vk::Result> {
        // SAFETY: the swapchain was just made and the device is alive.
        unsafe {
            self.images = self.loader.get_swapchain_images(self.raw)?;
            self.given = vulkan.device.create_semaphore(&Default::default(), None)?;
            for _ in 0..self.images.len() {
                self.done.push(vulkan.device.create_semaphore(&Default::default(), None)?);
            }
        }
        vulkan.name(self.raw, "window");
        self.images.iter().for_each(|image| vulkan.name(*image, "window.image"));
        vulkan.name(self.given, "window.given");
        self.done.iter().for_each(|done| vulkan.name(*done, "window.done"));
        Ok(())
    }

    /// Copies a picture of the same size, in the general layout, to the window's next image and shows that.
    pub(crate) fn show(&self, vulkan: &Vulkan, picture: vk::Image) -> Result<Next> {
        // SAFETY: nothing waits for the semaphore: the last submission that did is done.
        let given = unsafe { self.loader.acquire_next_image(self.raw, PATIENCE_NS, self.given, vk::Fence::null()) };
        let index = match given {
            Ok((index, _)) => index,
            Err(answer) => return next("vkAcquireNextImageKHR", answer),
        };
        let (image, done) = (self.images[index as usize], self.done[index as usize]);
        let commands = vulkan.begin_commands("window")?;
        self.copy(vulkan, commands, picture, image);
        let whole = vk::PipelineStageFlags2::ALL_COMMANDS;
        let after = [vk::SemaphoreSubmitInfo::default().semaphore(self.given).stage_mask(whole)];
        let before = [vk::SemaphoreSubmitInfo::default().semaphore(done).stage_mask(whole)];
        if let Err(answer) = vulkan.run_between(commands, &after, &before) {
            return next("vkQueueSubmit2", answer);
        }
        let (swapchains, indices, waits) = ([self.raw], [index], [done]);
        let info =
            vk::PresentInfoKHR::default().wait_semaphores(&waits).swapchains(&swapchains).image_indices(&indices);
        let queue = crate::lock::lock(&vulkan.queue);
        // SAFETY: the queue is locked; the image was given, is in the layout for showing, and its semaphore will be signalled.
        match unsafe { self.loader.queue_present(*queue, &info) } {
            Ok(_) => Ok(Next::Go),
            Err(answer) => next("vkQueuePresentKHR", answer),
        }
    }

    fn copy(&self, vulkan: &Vulkan, commands: vk::CommandBuffer, from: vk::Image, to: vk::Image) {
        let device = &vulkan.device;
        let label = vk::DebugUtilsLabelEXT::default().label_name(c"window/show");
        let layout = |old: vk::ImageLayout, new: vk::ImageLayout| {
            [vk::ImageMemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
                .old_layout(old)
                .new_layout(new)
                .image(to)
                .subresource_range(WHOLE)]
        };
        let writable = layout(vk::ImageLayout::UNDEFINED, vk::ImageLayout::TRANSFER_DST_OPTIMAL);
        let shown = layout(vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::ImageLayout::PRESENT_SRC_KHR);
        // A blit and not a copy: the window may keep its channels in another order.
        let region = [blit(self.size, self.size)];
        // SAFETY: the command buffer is recording; both images are alive until the submission is waited for, and of this size.
        unsafe {
            if let Some(labels) = &vulkan.names.0 {
                labels.cmd_begin_debug_utils_label(commands, &label);
            }
            device.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&writable));
            device.cmd_blit_image(
                commands,
                from,
                vk::ImageLayout::GENERAL,
                to,
                vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                &region,
                vk::Filter::NEAREST,
            );
            device.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&shown));
            if let Some(labels) = &vulkan.names.0 {
                labels.cmd_end_debug_utils_label(commands);
            }
        }
    }

    /// Waits until nothing is in use and frees all of it.
    pub(crate) fn destroy(&mut self, vulkan: &Vulkan) {
        let _queue = crate::lock::lock(&vulkan.queue);
        // SAFETY: called once; after the wait nothing of it is in use. Null handles are ignored.
        unsafe {
            let _ = vulkan.device.device_wait_idle();
            vulkan.device.destroy_semaphore(self.given, None);
            for done in self.done.drain(..) {
                vulkan.device.destroy_semaphore(done, None);
            }
            self.loader.destroy_swapchain(self.raw, None);
        }
    }
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

/// All of one image to all of another.
pub(crate) fn blit(from: [u32; 2], to: [u32; 2]) -> vk::ImageBlit {
    let layers = vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        mip_level: 0,
        base_array_layer: 0,
        layer_count: 1,
    };
    let corners = |[width, height]: [u32; 2]| {
        [vk::Offset3D { x: 0, y: 0, z: 0 }, vk::Offset3D { x: width as i32, y: height as i32, z: 1 }]
    };
    vk::ImageBlit {
        src_subresource: layers,
        src_offsets: corners(from),
        dst_subresource: layers,
        dst_offsets: corners(to),
    }
}

/// The surface of a window as far as it can be asked about, and what is chosen of it.
pub(crate) struct Terms {
    pub(crate) format: vk::SurfaceFormatKHR,
    pub(crate) mode: vk::PresentModeKHR,
}

impl Terms {
    /// Chooses of what a surface offers.
    pub(crate) fn of(vulkan: &Vulkan, surfaces: &khr::surface::Instance, surface: vk::SurfaceKHR) -> Result<Self> {
        let refused = |why: &str| Error::Window { device: vulkan.info.name.clone(), why: why.to_owned() };
        // SAFETY: surface and device handles come from this instance and are alive.
        let (shows, formats, modes, capabilities) = unsafe {
            (
                surfaces.get_physical_device_surface_support(vulkan.physical, vulkan.family, surface),
                surfaces.get_physical_device_surface_formats(vulkan.physical, surface),
                surfaces.get_physical_device_surface_present_modes(vulkan.physical, surface),
                surfaces.get_physical_device_surface_capabilities(vulkan.physical, surface),
            )
        };
        if !shows.named("vkGetPhysicalDeviceSurfaceSupportKHR")? {
            return Err(refused("its queue shows nothing on this display"));
        }
        let capabilities = capabilities.named("vkGetPhysicalDeviceSurfaceCapabilitiesKHR")?;
        if !capabilities.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_DST) {
            return Err(refused("pictures cannot be copied to it"));
        }
        let formats = formats.named("vkGetPhysicalDeviceSurfaceFormatsKHR")?;
        let format = choose_format(&formats).ok_or_else(|| refused("it has no format of 8 bits a channel"))?;
        let modes = modes.named("vkGetPhysicalDeviceSurfacePresentModesKHR")?;
        Ok(Terms { format, mode: choose_mode(&modes) })
    }
}

/// Colours are ready for the display, so that none of the formats that encode them once more will do.
fn choose_format(formats: &[vk::SurfaceFormatKHR]) -> Option<vk::SurfaceFormatKHR> {
    let wanted = [vk::Format::B8G8R8A8_UNORM, vk::Format::R8G8B8A8_UNORM];
    let fits = |format: &&vk::SurfaceFormatKHR| {
        wanted.contains(&format.format) && format.color_space == vk::ColorSpaceKHR::SRGB_NONLINEAR
    };
    formats.iter().find(fits).copied()
}

/// The newest picture without waiting, where that is to be had; what every device has otherwise. Neither tears.
fn choose_mode(modes: &[vk::PresentModeKHR]) -> vk::PresentModeKHR {
    let newest = vk::PresentModeKHR::MAILBOX;
    if modes.contains(&newest) {
        newest
    } else {
        vk::PresentModeKHR::FIFO
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn capabilities(current: [u32; 2], least: u32, most: u32) -> vk::SurfaceCapabilitiesKHR {
        let extent = |[width, height]: [u32; 2]| vk::Extent2D { width, height };
        vk::SurfaceCapabilitiesKHR {
            current_extent: extent(current),
            min_image_extent: extent([least; 2]),
            max_image_extent: extent([most; 2]),
            ..Default::default()
        }
    }

    #[test]
    fn every_answer_of_the_window_system_is_met() {
        let of = |answer| next("a call", answer);
        assert_eq!(of(vk::Result::SUCCESS).unwrap(), Next::Go);
        assert_eq!(of(vk::Result::SUBOPTIMAL_KHR).unwrap(), Next::Go);
        assert_eq!(of(vk::Result::TIMEOUT).unwrap(), Next::Skip);
        assert_eq!(of(vk::Result::ERROR_OUT_OF_DATE_KHR).unwrap(), Next::Images);
        assert_eq!(of(vk::Result::ERROR_SURFACE_LOST_KHR).unwrap(), Next::Surface);
        assert!(matches!(of(vk::Result::ERROR_DEVICE_LOST), Err(Error::DeviceLost { .. })));
        assert!(of(vk::Result::ERROR_OUT_OF_HOST_MEMORY).unwrap_err().to_string().contains("a call failed"));
    }

    #[test]
    fn a_surface_says_its_size_or_takes_ours_or_has_none() {
        assert_eq!(extent(&capabilities([640, 480], 640, 640), [1, 1]), Some([640, 640]));
        assert_eq!(extent(&capabilities([u32::MAX; 2], 16, 4096), [1280, 8]), Some([1280, 16]));
        assert_eq!(extent(&capabilities([0, 0], 0, 4096), [1280, 720]), None, "minimised");
        assert_eq!(extent(&capabilities([640, 480], 0, 0), [1280, 720]), None, "minimised, as some drivers say it");
        assert_eq!(extent(&capabilities([u32::MAX; 2], 1, 4096), [0, 720]), None);
    }

    #[test]
    fn colours_are_not_encoded_twice() {
        let format = |format| vk::SurfaceFormatKHR { format, color_space: vk::ColorSpaceKHR::SRGB_NONLINEAR };
        let both = [format(vk::Format::B8G8R8A8_SRGB), format(vk::Format::B8G8R8A8_UNORM)];
        assert_eq!(choose_format(&both).map(|chosen| chosen.format), Some(vk::Format::B8G8R8A8_UNORM));
        assert_eq!(choose_format(&both[..1]), None);
        assert_eq!(choose_mode(&[vk::PresentModeKHR::IMMEDIATE, vk::PresentModeKHR::FIFO]), vk::PresentModeKHR::FIFO);
    }
}
