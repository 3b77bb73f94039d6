//! Copies outside frames: uploads, read-backs, one-time commands. Each waits until it is done.

use crate::error::Named;
use crate::gpu::{Gpu, Vulkan};
use crate::lock::lock;
use crate::target::Format;
use crate::{DeviceKind, Error, Result};
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::vulkan::Allocation;
use gpu_allocator::MemoryLocation;
use shaders::Bound;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use vk::Handle;

/// Staging is done in pieces of this size, so that a large scene does not need twice its memory.
const PIECE_BYTES: usize = 32 << 20;

/// How long a device is asked whether it is done before the thread sleeps. On an H200 the sleep adds 0.05 to 0.09 ms to a submission.
const ASKED_FOR: Duration = Duration::from_millis(2);

/// A mapped buffer that lives for one copy.
struct Staging<'a> {
    vulkan: &'a Vulkan,
    raw: vk::Buffer,
    allocation: Option<Allocation>,
}

impl<'a> Staging<'a> {
    fn new(vulkan: &'a Vulkan, bytes: usize, location: MemoryLocation) -> Result<Self> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(bytes.max(4) as u64).usage(usage);
        // SAFETY: the device is alive.
        let raw = unsafe { vulkan.device.create_buffer(&info, None) }.named("vkCreateBuffer")?;
        vulkan.name(raw, "staging");
        let mut staging = Staging { vulkan, raw, allocation: None };
        // SAFETY: the buffer was just made.
        let requirements = unsafe { vulkan.device.get_buffer_memory_requirements(raw) };
        let allocation = vulkan.allocate("staging", requirements, location, true)?;
        // SAFETY: the memory was allocated for this buffer's requirements.
        unsafe { vulkan.device.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) }
            .named("vkBindBufferMemory")?;
        staging.allocation = Some(allocation);
        Ok(staging)
    }

    fn bytes(&mut self) -> Result<&mut [u8]> {
        let mapped = self.allocation.as_mut().and_then(Allocation::mapped_slice_mut);
        mapped.ok_or(Error::Vulkan { call: "mapping staging memory", result: vk::Result::ERROR_MEMORY_MAP_FAILED })
    }
}

impl Drop for Staging<'_> {
    fn drop(&mut self) {
        // SAFETY: the copy has been waited for.
        unsafe { self.vulkan.device.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.allocation.take() {
            self.vulkan.memory_bytes.fetch_sub(allocation.size(), Ordering::Relaxed);
            if let Err(error) = lock(&self.vulkan.allocator).free(allocation) {
                tracing::warn!(%error, "freeing staging memory");
            }
        }
    }
}

impl Gpu {
    /// Reads what a bound buffer range holds, now; the device must be idle (between frames) and the buffer alive.
    pub fn read_bound<T: Pod>(&self, bound: &Bound) -> Result<Vec<T>> {
        let bytes = self.read_bound_bytes(std::slice::from_ref(bound))?.remove(0);
        Ok(bytemuck::pod_collect_to_vec(&bytes[..bytes.len() / size_of::<T>() * size_of::<T>()]))
    }

    /// Reads several ranges as [`Gpu::read_bound`] does, with one wait for all; images are read elsewhere and come out empty.
    pub fn read_bound_bytes(&self, bounds: &[Bound]) -> Result<Vec<Vec<u8>>> {
        let source = |bound: &Bound| match bound {
            Bound::Buffer { raw, offset, size, .. } => {
                Source::Buffer { raw: vk::Buffer::from_raw(*raw), offset: *offset, bytes: *size as usize }
            }
            Bound::Image(_) => Source::Buffer { raw: vk::Buffer::null(), offset: 0, bytes: 0 },
        };
        self.stage_from(&bounds.iter().map(source).collect::<Vec<_>>())
    }

    pub(crate) fn stage_to_buffer(&self, to: vk::Buffer, bytes: &[u8]) -> Result<()> {
        let vulkan = self.vulkan()?;
        vulkan.uploads.fetch_add(1, Ordering::Relaxed);
        let mut staging = Staging::new(vulkan, bytes.len().min(PIECE_BYTES), MemoryLocation::CpuToGpu)?;
        for (index, piece) in bytes.chunks(PIECE_BYTES).enumerate() {
            staging.bytes()?[..piece.len()].copy_from_slice(piece);
            let region =
                vk::BufferCopy { src_offset: 0, dst_offset: (index * PIECE_BYTES) as u64, size: piece.len() as u64 };
            let from = staging.raw;
            // SAFETY: both buffers are alive through the wait and the region lies in both.
            vulkan.run_once(|device, commands| unsafe { device.cmd_copy_buffer(commands, from, to, &[region]) })?;
        }
        Ok(())
    }

    pub(crate) fn stage_from_buffer(&self, raw: vk::Buffer, offset: u64, bytes: usize) -> Result<Vec<u8>> {
        Ok(self.stage_from(&[Source::Buffer { raw, offset, bytes }])?.remove(0))
    }

    /// Copies all of them back in one submission: each submission waits, and costs more than a small copy.
    pub(crate) fn stage_from(&self, sources: &[Source]) -> Result<Vec<Vec<u8>>> {
        let vulkan = self.vulkan()?;
        let lengths: Vec<usize> = sources.iter().map(|source| source.bytes(vulkan)).collect();
        let starts: Vec<usize> = lengths
            .iter()
            .scan(0usize, |end, bytes| Some(std::mem::replace(end, *end + bytes.next_multiple_of(ALIGNED_BYTES))))
            .collect();
        let total: usize = lengths.iter().map(|bytes| bytes.next_multiple_of(ALIGNED_BYTES)).sum();
        if total == 0 {
            return Ok(vec![Vec::new(); sources.len()]);
        }
        let mut staging = Staging::new(vulkan, total, MemoryLocation::GpuToCpu)?;
        let to = staging.raw;
        vulkan.run_once(|device, commands| {
            for (source, start) in sources.iter().zip(&starts) {
                source.copy(device, commands, to, *start as u64);
            }
        })?;
        let staged = staging.bytes()?;
        Ok(starts.iter().zip(&lengths).map(|(start, bytes)| staged[*start..start + bytes].to_vec()).collect())
    }

    pub(crate) fn stage_to_image(&self, to: vk::Image, format: Format, size: [u32; 2], bytes: &[u8]) -> Result<()> {
        let vulkan = self.vulkan()?;
        let mut staging = Staging::new(vulkan, bytes.len(), MemoryLocation::CpuToGpu)?;
        staging.bytes()?[..bytes.len()].copy_from_slice(bytes);
        let (from, region) = (staging.raw, whole_image(format, size));
        vulkan.run_once(|device, commands| {
            // SAFETY: the image is in the general layout and alive through the wait; the buffer holds all its texels.
            unsafe { device.cmd_copy_buffer_to_image(commands, from, to, vk::ImageLayout::GENERAL, &[region]) };
        })
    }
}

/// Where copies begin in a shared buffer: a multiple of all texels' sizes.
const ALIGNED_BYTES: usize = 16;

/// What is copied back to the host.
pub(crate) enum Source {
    Buffer { raw: vk::Buffer, offset: u64, bytes: usize },
    Image { raw: vk::Image, format: Format, size: [u32; 2] },
}

impl Source {
    fn bytes(&self, vulkan: &Vulkan) -> usize {
        match self {
            Source::Buffer { bytes, .. } => *bytes,
            Source::Image { format, size, .. } => {
                size[0] as usize * size[1] as usize * format.texel_bytes(vulkan.depth)
            }
        }
    }

    /// Records the copy to a buffer that has room for it from `start` on.
    fn copy(&self, device: &ash::Device, commands: vk::CommandBuffer, to: vk::Buffer, start: u64) {
        match *self {
            Source::Buffer { bytes: 0, .. } => {}
            Source::Buffer { raw, offset, bytes } => {
                let region = [vk::BufferCopy { src_offset: offset, dst_offset: start, size: bytes as u64 }];
                // SAFETY: both buffers are alive through the wait and the region lies in both.
                unsafe { device.cmd_copy_buffer(commands, raw, to, &region) };
            }
            Source::Image { raw, format, size } => {
                let region = [whole_image(format, size).buffer_offset(start)];
                // SAFETY: the image is in the general layout and alive through the wait; the buffer has room for it.
                unsafe { device.cmd_copy_image_to_buffer(commands, raw, vk::ImageLayout::GENERAL, to, &region) };
            }
        }
    }
}

/// All texels of an image, tightly packed, at the start of a buffer.
pub(crate) fn whole_image(format: Format, [width, height]: [u32; 2]) -> vk::BufferImageCopy {
    let layers =
        vk::ImageSubresourceLayers { aspect_mask: format.aspect(), mip_level: 0, base_array_layer: 0, layer_count: 1 };
    let extent = vk::Extent3D { width, height, depth: 1 };
    vk::BufferImageCopy::default().image_subresource(layers).image_extent(extent)
}

/// Everything before, before everything after: for the edges of submissions, where no tracker looks.
pub(crate) fn full_barrier(device: &ash::Device, commands: vk::CommandBuffer) {
    let barrier = [everything()];
    // SAFETY: the command buffer is recording, outside a rendering.
    unsafe { device.cmd_pipeline_barrier2(commands, &vk::DependencyInfo::default().memory_barriers(&barrier)) };
}

/// The barrier of [`full_barrier`].
pub(crate) fn everything() -> vk::MemoryBarrier2<'static> {
    vk::MemoryBarrier2::default()
        .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
        // The host too: mapped buffers are read once the submission's fence is passed.
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::HOST)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
}

impl Vulkan {
    /// Records commands, runs them between full barriers and waits.
    pub(crate) fn run_once(&self, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) -> Result<()> {
        let commands = self.begin_commands("copy")?;
        full_barrier(&self.device, commands);
        record(&self.device, commands);
        full_barrier(&self.device, commands);
        self.run(commands).map_err(|result| match result {
            vk::Result::ERROR_DEVICE_LOST => Error::DeviceLost { stage: "a copy".to_owned() },
            result => Error::Vulkan { call: "vkQueueSubmit2", result },
        })
    }

    pub(crate) fn begin_commands(&self, name: &str) -> Result<vk::CommandBuffer> {
        let pool = lock(&self.pool);
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(*pool)
            .level(vk::CommandBufferLevel::PRIMARY)
            .command_buffer_count(1);
        // SAFETY: the pool is locked and alive.
        let commands = unsafe { self.device.allocate_command_buffers(&info) }.named("vkAllocateCommandBuffers")?[0];
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the command buffer was just made.
        unsafe { self.device.begin_command_buffer(commands, &begin) }.named("vkBeginCommandBuffer")?;
        // Once it is begun: RenderDoc forgets what it was called before.
        self.name(commands, name);
        Ok(commands)
    }

    /// Ends, submits, waits and frees the command buffer.
    pub(crate) fn run(&self, commands: vk::CommandBuffer) -> std::result::Result<(), vk::Result> {
        self.run_between(commands, &[], &[])
    }

    /// The same, begun once the device has passed some semaphores and signalling others at its end.
    pub(crate) fn run_between(
        &self,
        commands: vk::CommandBuffer,
        after: &[vk::SemaphoreSubmitInfo<'_>],
        before: &[vk::SemaphoreSubmitInfo<'_>],
    ) -> std::result::Result<(), vk::Result> {
        let queue = lock(&self.queue);
        let pool = lock(&self.pool);
        // SAFETY: the command buffer is recording and comes from the pool; queue and pool are locked, so the fence is ours and not signalled.
        // Commands are freed, and the fence used again, only after the wait.
        unsafe {
            self.device.end_command_buffer(commands)?;
            let infos = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
            let submits = [vk::SubmitInfo2::default()
                .command_buffer_infos(&infos)
                .wait_semaphore_infos(after)
                .signal_semaphore_infos(before)];
            self.device.queue_submit2(*queue, &submits, self.submitted)?;
            self.wait()?;
            self.device.free_command_buffers(*pool, &[commands]);
            self.device.reset_fences(&[self.submitted])
        }
    }

    /// Waits until the submission is done. A device of its own is asked again and again first, as waking a thread takes longer than many a
    /// submission; one that computes on the processor needs the thread's time itself.
    fn wait(&self) -> std::result::Result<(), vk::Result> {
        let since = Instant::now();
        // SAFETY: the fence is alive, and was handed to a submission.
        unsafe {
            while self.info.kind != DeviceKind::Cpu && since.elapsed() < ASKED_FOR {
                if self.device.get_fence_status(self.submitted)? {
                    return Ok(());
                }
                std::hint::spin_loop();
            }
            self.device.wait_for_fences(&[self.submitted], true, u64::MAX)
        }
    }
}
