//! Images, always in the general layout.

use crate::error::Named;
use crate::gpu::{Gpu, Vulkan};
use crate::retired::Retired;
use crate::target::Format;
use crate::transfer::Source;
use crate::{Error, Result};
use ash::vk;
use gpu_allocator::vulkan::Allocation;
use gpu_allocator::MemoryLocation;
use shaders::{ImageRef, ResourceId};
use vk::Handle;

/// A 2D image with one level.
pub struct Image {
    gpu: Gpu,
    id: ResourceId,
    raw: vk::Image,
    view: vk::ImageView,
    allocation: Option<Allocation>,
    format: Format,
    size: [u32; 2],
    samples: u32,
}

impl Image {
    /// Makes an image of `size` in pixels. Its contents are undefined until it is cleared or drawn to.
    pub fn new(gpu: &Gpu, name: &str, format: Format, size: [u32; 2]) -> Result<Self> {
        Self::with_samples(gpu, name, format, size, 1)
    }

    /// The same of so many samples a pixel: it is drawn to, and read by stages or resolved, but never copied or read back.
    ///
    /// # Errors
    /// A number that the device does not have, or a device without room.
    pub fn with_samples(gpu: &Gpu, name: &str, format: Format, size: [u32; 2], samples: u32) -> Result<Self> {
        let id = gpu.new_id(name);
        let mut image = Image {
            gpu: gpu.clone(),
            id,
            raw: vk::Image::null(),
            view: vk::ImageView::null(),
            allocation: None,
            format,
            size,
            samples,
        };
        if let Some(vulkan) = &gpu.0.vulkan {
            check_size(vulkan, name, size)?;
            check_samples(vulkan, name, samples)?;
            image.create(vulkan, name)?;
        }
        Ok(image)
    }

    /// The image as a stage binds it.
    pub fn view(&self) -> ImageRef {
        ImageRef { id: self.id, view: self.view.as_raw(), image: self.raw.as_raw() }
    }

    /// What it holds.
    pub fn format(&self) -> Format {
        self.format
    }

    /// Width and height in pixels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Reads the whole image, row by row from the top, now; the device must be idle (between frames). Depth comes as reversed
    /// floats, in whatever format it is kept.
    ///
    /// # Panics
    /// If it has several samples a pixel.
    pub fn read(&self) -> Result<Vec<u8>> {
        let [texels] = Self::read_together([self])?;
        Ok(texels)
    }

    /// Reads several images of one device as [`Image::read`] does, with one wait for all.
    ///
    /// # Panics
    /// If one has several samples a pixel.
    pub fn read_together<const N: usize>(images: [&Image; N]) -> Result<[Vec<u8>; N]> {
        assert!(images.iter().all(|image| image.samples == 1), "samples are read by a stage");
        let Some(first) = images.first() else { return Ok(std::array::from_fn(|_| Vec::new())) };
        let sources = images.map(|image| Source::Image { raw: image.raw, format: image.format, size: image.size });
        let mut texels = first.gpu.stage_from(&sources)?.into_iter();
        Ok(images.map(|image| {
            let texels = texels.next().unwrap_or_default();
            if image.format == Format::Depth {
                image.gpu.depth().reversed(texels)
            } else {
                texels
            }
        }))
    }

    /// Writes all pixels of a colour image, row by row from the top, now; the device must be idle (between frames).
    ///
    /// # Panics
    /// If it holds no colours, or another number of pixels.
    pub fn write(&mut self, pixels: &[[u8; 4]]) -> Result<()> {
        assert_eq!(self.format, Format::Colour, "only colours are written");
        assert_eq!(pixels.len(), self.size[0] as usize * self.size[1] as usize, "an image has all its pixels");
        self.gpu.stage_to_image(self.raw, self.format, self.size, pixels.as_flattened())
    }

    fn create(&mut self, vulkan: &Vulkan, name: &str) -> Result<()> {
        let attachment = match self.format {
            Format::Depth => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            _ => vk::ImageUsageFlags::COLOR_ATTACHMENT,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(self.format.vulkan(vulkan.depth))
            .extent(vk::Extent3D { width: self.size[0], height: self.size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::from_raw(self.samples))
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(
                attachment
                    | vk::ImageUsageFlags::SAMPLED
                    | vk::ImageUsageFlags::TRANSFER_SRC
                    | vk::ImageUsageFlags::TRANSFER_DST,
            );
        // SAFETY: the device is alive and the size was checked. What fails half-way is freed by `Drop` of `self`'s retired
        // parts or, for a bare image, leaks only until the device goes, which follows such an error.
        unsafe {
            self.raw = vulkan.device.create_image(&info, None).named("vkCreateImage")?;
            let requirements = vulkan.device.get_image_memory_requirements(self.raw);
            let allocation = vulkan.allocate(name, requirements, MemoryLocation::GpuOnly, false)?;
            let (memory, offset) = (allocation.memory(), allocation.offset());
            self.allocation = Some(allocation);
            vulkan.device.bind_image_memory(self.raw, memory, offset).named("vkBindImageMemory")?;
            let range = self.range();
            let view = vk::ImageViewCreateInfo::default()
                .image(self.raw)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format.vulkan(vulkan.depth))
                .subresource_range(range);
            self.view = vulkan.device.create_image_view(&view, None).named("vkCreateImageView")?;
        }
        vulkan.name(self.raw, name);
        vulkan.name(self.view, name);
        self.to_general_layout(vulkan)
    }

    fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            aspect_mask: self.format.aspect(),
            base_mip_level: 0,
            level_count: 1,
            base_array_layer: 0,
            layer_count: 1,
        }
    }

    fn to_general_layout(&self, vulkan: &Vulkan) -> Result<()> {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(vk::ImageLayout::UNDEFINED)
            .new_layout(vk::ImageLayout::GENERAL)
            .image(self.raw)
            .subresource_range(self.range())];
        // SAFETY: the image is alive and unused.
        vulkan.run_once(|device, commands| unsafe {
            device.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().image_memory_barriers(&barrier));
        })
    }
}

fn check_samples(vulkan: &Vulkan, name: &str, samples: u32) -> Result<()> {
    if samples == 1 || vulkan.info.samples.contains(vk::SampleCountFlags::from_raw(samples)) {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("'{name}'"),
        wanted: format!("{samples} samples a pixel"),
        limit: format!("{:?}", vulkan.info.samples),
        device: vulkan.info.name.clone(),
        remedy: "use one sample".to_owned(),
    })
}

fn check_size(vulkan: &Vulkan, name: &str, size: [u32; 2]) -> Result<()> {
    let limit = vulkan.info.max_image_px;
    if size.iter().all(|side| (1..=limit).contains(side)) {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("image '{name}'"),
        wanted: format!("{}x{} pixels", size[0], size[1]),
        limit: format!("1 to {limit} pixels a side"),
        device: vulkan.info.name.clone(),
        remedy: "choose another --size".to_owned(),
    })
}

impl Drop for Image {
    fn drop(&mut self) {
        if let (Some(vulkan), Some(allocation)) = (&self.gpu.0.vulkan, self.allocation.take()) {
            let (image, view, allocation) = (self.raw, self.view, Some(allocation));
            vulkan.retired.push(Retired { image, view, allocation, ..Retired::default() });
            vulkan.bury();
        }
    }
}
