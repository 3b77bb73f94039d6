//! Buffers. New memory is always zero: drivers do not promise it, and lavapipe does not do it.

use crate::error::Named;
use crate::features::Extra;
use crate::gpu::{Gpu, Vulkan};
use crate::retired::Retired;
use crate::{Error, Result};
use ash::vk;
use bytemuck::Pod;
use gpu_allocator::vulkan::Allocation;
use gpu_allocator::MemoryLocation;
use shaders::{BufferRef, ResourceId};
use std::marker::PhantomData;
use vk::Handle;

/// What a buffer is for, which decides where it lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Placement {
    /// Read and written by stages.
    Storage,
    /// Vertices and indices: may be larger than a storage range.
    Geometry,
    /// Written by the host each frame, read by stages.
    Upload,
    /// Written by stages or copies, read by the host.
    ReadBack,
}

/// A typed GPU buffer of a fixed number of elements.
pub struct Buffer<T> {
    gpu: Gpu,
    id: ResourceId,
    raw: vk::Buffer,
    bytes: u64,
    len: usize,
    allocation: Option<Allocation>,
    placement: Placement,
    element: PhantomData<fn() -> T>,
}

impl<T: Pod> From<&Buffer<T>> for BufferRef<T> {
    fn from(buffer: &Buffer<T>) -> Self {
        buffer.all()
    }
}

impl<T: Pod> Buffer<T> {
    /// Makes a zeroed buffer of `len` elements; an empty one still binds (as one element).
    pub fn new(gpu: &Gpu, name: &str, len: usize, placement: Placement) -> Result<Self> {
        let bytes = (len.max(1) * size_of::<T>()).next_multiple_of(4) as u64;
        let id = gpu.new_id(name);
        let mut buffer = Buffer {
            gpu: gpu.clone(),
            id,
            raw: vk::Buffer::null(),
            bytes,
            len,
            allocation: None,
            placement,
            element: PhantomData,
        };
        if let Some(vulkan) = &gpu.0.vulkan {
            check_range(vulkan, name, bytes, placement)?;
            (buffer.raw, buffer.allocation) = create(vulkan, name, bytes, placement)?;
            buffer.clear(vulkan)?;
        }
        Ok(buffer)
    }

    /// Makes a buffer and fills it.
    pub fn with_data(gpu: &Gpu, name: &str, data: &[T], placement: Placement) -> Result<Self> {
        let mut buffer = Self::new(gpu, name, data.len(), placement)?;
        buffer.write(data)?;
        Ok(buffer)
    }

    /// Elements in the buffer.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True if the buffer has no elements.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The whole buffer, as a stage binds it.
    pub fn all(&self) -> BufferRef<T> {
        BufferRef { id: self.id, raw: self.raw.as_raw(), offset: 0, size: self.bytes, element: PhantomData }
    }

    /// Writes `data` to the front of the buffer, now. Mapped memory is written directly, other memory through staging.
    pub fn write(&mut self, data: &[T]) -> Result<()> {
        assert!(data.len() <= self.len, "writing {} elements to a buffer of {}", data.len(), self.len);
        let bytes: &[u8] = bytemuck::cast_slice(data);
        if bytes.is_empty() || self.gpu.0.vulkan.is_none() {
            return Ok(());
        }
        if let Some(mapped) = self.mapped() {
            mapped[..bytes.len()].copy_from_slice(bytes);
            return Ok(());
        }
        self.gpu.clone().stage_to_buffer(self.raw, bytes)
    }

    /// Reads the whole buffer, now; the device must be idle (between frames). Zeros where there is no device.
    pub fn read(&self) -> Result<Vec<T>> {
        if self.gpu.0.vulkan.is_none() {
            return Ok(vec![T::zeroed(); self.len]);
        }
        if let Some(mapped) = self.readable() {
            let bytes = &mapped[..self.len * size_of::<T>()];
            return Ok(bytemuck::pod_collect_to_vec(bytes));
        }
        let bytes = self.gpu.stage_from_buffer(self.raw, 0, self.len * size_of::<T>())?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// Mapped memory that the host can write as it is. Memory that must be flushed is written through staging: the allocator asks
    /// for coherent memory only where the host is the one to use it.
    fn mapped(&mut self) -> Option<&mut [u8]> {
        self.is_mapped(vk::MemoryPropertyFlags::HOST_COHERENT)
            .then(|| self.allocation.as_mut().and_then(Allocation::mapped_slice_mut))
            .flatten()
    }

    /// Mapped memory that the host can read as it is. What it does not keep in its caches is read word by word over the bus, so that
    /// a copy is faster.
    fn readable(&self) -> Option<&[u8]> {
        self.is_mapped(vk::MemoryPropertyFlags::HOST_COHERENT | vk::MemoryPropertyFlags::HOST_CACHED)
            .then(|| self.allocation.as_ref().and_then(Allocation::mapped_slice))
            .flatten()
    }

    fn is_mapped(&self, wanted: vk::MemoryPropertyFlags) -> bool {
        let on_device = matches!(self.placement, Placement::Storage | Placement::Geometry);
        let properties = self.allocation.as_ref().map(Allocation::memory_properties).unwrap_or_default();
        properties.contains(wanted) && (!on_device || self.gpu.has(Extra::MappedMemory))
    }

    fn clear(&mut self, vulkan: &Vulkan) -> Result<()> {
        if let Some(mapped) = self.mapped() {
            mapped.fill(0);
            return Ok(());
        }
        let raw = self.raw;
        vulkan.run_once(|device, commands| {
            // SAFETY: the buffer was just made with transfer usage; the command buffer is recording.
            unsafe { device.cmd_fill_buffer(commands, raw, 0, vk::WHOLE_SIZE, 0) };
        })
    }
}

fn check_range(vulkan: &Vulkan, name: &str, bytes: u64, placement: Placement) -> Result<()> {
    let (most, of) = match placement {
        Placement::Geometry => (vulkan.info.max_buffer_bytes, "in one buffer"),
        _ => (vulkan.info.max_storage_bytes.min(vulkan.info.max_buffer_bytes), "in one storage buffer"),
    };
    if bytes <= most {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("buffer '{name}'"),
        wanted: format!("{bytes} bytes"),
        limit: format!("{most} bytes {of}"),
        device: vulkan.info.name.clone(),
        remedy: "use a smaller --scale or --size".to_owned(),
    })
}

fn create(vulkan: &Vulkan, name: &str, bytes: u64, placement: Placement) -> Result<(vk::Buffer, Option<Allocation>)> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::INDIRECT_BUFFER
        | vk::BufferUsageFlags::VERTEX_BUFFER
        | vk::BufferUsageFlags::INDEX_BUFFER
        | vk::BufferUsageFlags::TRANSFER_SRC
        | vk::BufferUsageFlags::TRANSFER_DST;
    let info = vk::BufferCreateInfo::default().size(bytes).usage(usage).sharing_mode(vk::SharingMode::EXCLUSIVE);
    // SAFETY: the device is alive.
    let raw = unsafe { vulkan.device.create_buffer(&info, None) }.named("vkCreateBuffer")?;
    // SAFETY: the buffer was just made.
    let requirements = unsafe { vulkan.device.get_buffer_memory_requirements(raw) };
    let location = match placement {
        Placement::Storage | Placement::Geometry => MemoryLocation::GpuOnly,
        Placement::Upload => MemoryLocation::CpuToGpu,
        Placement::ReadBack => MemoryLocation::GpuToCpu,
    };
    let allocation = vulkan.allocate(name, requirements, location, true);
    let bound = allocation.and_then(|allocation| {
        // SAFETY: the memory was allocated for this buffer's requirements.
        let bound = unsafe { vulkan.device.bind_buffer_memory(raw, allocation.memory(), allocation.offset()) };
        bound.named("vkBindBufferMemory").map(|()| allocation)
    });
    match bound {
        Ok(allocation) => {
            vulkan.name(raw, name);
            Ok((raw, Some(allocation)))
        }
        Err(error) => {
            // SAFETY: nothing uses the buffer.
            unsafe { vulkan.device.destroy_buffer(raw, None) };
            Err(error)
        }
    }
}

impl<T> Drop for Buffer<T> {
    fn drop(&mut self) {
        if let (Some(vulkan), Some(allocation)) = (&self.gpu.0.vulkan, self.allocation.take()) {
            vulkan.retired.push(Retired { buffer: self.raw, allocation: Some(allocation), ..Retired::default() });
            vulkan.bury();
        }
    }
}
