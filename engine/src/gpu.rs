//! The opened device, and everything made from it.

use crate::adapter::{self, AdapterInfo};
use crate::depth::DepthFormat;
use crate::descriptors::Descriptors;
use crate::error::Named;
use crate::features::{Extra, Extras};
use crate::instance::Instance;
use crate::lock::lock;
use crate::names::Names;
use crate::pipeline::Pipelines;
use crate::retired::RetiredList;
use crate::timers::{QueryStore, TimerMode};
use crate::{Error, Message, Result};
use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc};
use gpu_allocator::MemoryLocation;
use shaders::ResourceId;
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU32, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};

/// How to open a device.
#[derive(Clone, Debug, Default)]
pub struct GpuOptions {
    /// Index, or part of the name; none takes the best.
    pub device: Option<String>,
    /// Turn on the validation layer with synchronization validation; any message fails the frame.
    pub validation: bool,
    /// How stages are timed; none decides by the kind of device, see [`TimerMode::of`].
    pub timer: Option<TimerMode>,
    /// Where the pipeline cache lies; none keeps it in memory.
    pub cache_dir: Option<PathBuf>,
    /// Put a barrier before every stage, to tell a missing barrier from another bug.
    pub barrier_every_stage: bool,
    /// How depth is kept.
    pub depth: DepthFormat,
    /// Ask for what a [`crate::Window`] needs. A device without it is refused.
    pub windows: bool,
    /// Features to do without, by name, as if the device lacked them: so that each way around one is tested on any device.
    pub without: Vec<String>,
}

/// An opened Vulkan device, or a recorder without one. Cheap to clone.
///
/// Frames are recorded and run one at a time: two threads must not be between [`Gpu::frame`] and [`crate::Frame::finish`] at once
/// (they share one command pool), nor read or write buffers meanwhile.
#[derive(Clone)]
pub struct Gpu(pub(crate) Arc<Inner>);

pub(crate) struct Inner {
    pub(crate) vulkan: Option<Vulkan>,
    next_id: AtomicU32,
    names: Mutex<Vec<String>>,
    pub(crate) barrier_every_stage: bool,
}

pub(crate) struct Vulkan {
    pub(crate) device: ash::Device,
    pub(crate) descriptors: Descriptors,
    pub(crate) names: Names,
    pub(crate) queue: Mutex<vk::Queue>,
    /// What submissions signal, one after the other: whoever holds the queue uses it. Drivers make a fence with an event of the kernel: to make
    /// one and drop it took 0.56 ms of each submission on an H200 (580.159).
    pub(crate) submitted: vk::Fence,
    pub(crate) pool: Mutex<vk::CommandPool>,
    pub(crate) allocator: ManuallyDrop<Mutex<Allocator>>,
    pub(crate) pipelines: Pipelines,
    pub(crate) info: AdapterInfo,
    pub(crate) depth: DepthFormat,
    pub(crate) memory_bytes: AtomicU64,
    pub(crate) retired: RetiredList,
    pub(crate) queries: QueryStore,
    pub(crate) frames_alive: AtomicUsize,
    /// Uploads so far that were submissions of their own.
    pub(crate) uploads: AtomicU64,
    pub(crate) physical: vk::PhysicalDevice,
    pub(crate) family: u32,
    pub(crate) windows: bool,
    pub(crate) timer: OnceLock<TimerMode>,
    pub(crate) instance: Instance,
}

impl Gpu {
    /// Opens a device whose stages are not timed yet: [`Gpu::open`] decides how.
    pub(crate) fn open_untimed(options: &GpuOptions) -> Result<Self> {
        let instance = Instance::new(options.validation, options.windows)?;
        let (physical, info) = adapter::choose(&instance, options.device.as_deref(), &options.without)?;
        adapter::check_depth(&instance, physical, &info, options.depth)?;
        if options.windows {
            adapter::check_windows(&instance, physical, &info)?;
        }
        let (family, _) = adapter::graphics_family(&instance.raw, physical).ok_or_else(|| Error::MissingFeatures {
            device: info.name.clone(),
            missing: "a queue for graphics and compute".to_owned(),
        })?;
        let device = create_device(&instance.raw, physical, family, info.extras, options.windows)?;
        let vulkan = Vulkan::new(instance, physical, device, family, info, options)?;
        Ok(Gpu(Arc::new(Inner {
            vulkan: Some(vulkan),
            next_id: AtomicU32::new(0),
            names: Mutex::default(),
            barrier_every_stage: options.barrier_every_stage,
        })))
    }

    /// An engine without a device: frames are recorded and can be read as text, but not run.
    pub fn without_device() -> Self {
        Gpu(Arc::new(Inner {
            vulkan: None,
            next_id: AtomicU32::new(0),
            names: Mutex::default(),
            barrier_every_stage: false,
        }))
    }

    /// What is known of the device; none without one.
    pub fn info(&self) -> Option<&AdapterInfo> {
        self.0.vulkan.as_ref().map(|vulkan| &vulkan.info)
    }

    /// How stages are timed on this device.
    pub fn timer_mode(&self) -> TimerMode {
        self.0.vulkan.as_ref().and_then(|vulkan| vulkan.timer.get().copied()).unwrap_or(TimerMode::Split)
    }

    /// Whether the device has something that can be done without; an engine without a device records as if it had all.
    pub fn has(&self, extra: Extra) -> bool {
        self.info().map_or(Extras::all(), |info| info.extras).has(extra)
    }

    /// How depth is kept.
    pub fn depth(&self) -> DepthFormat {
        self.0.vulkan.as_ref().map_or(DepthFormat::default(), |vulkan| vulkan.depth)
    }

    /// Lanes of a subgroup; 8 without a device.
    pub fn subgroup_size(&self) -> u32 {
        self.info().map_or(8, |info| info.subgroup_size)
    }

    /// The grid that vertex positions are snapped to, in pixels.
    pub fn snap_px(&self) -> f32 {
        self.info().map_or(1.0 / 256.0, |info| info.snap_px)
    }

    /// Device memory in use, in MiB.
    pub fn memory_mib(&self) -> f64 {
        let bytes = self.0.vulkan.as_ref().map_or(0, |vulkan| vulkan.memory_bytes.load(Ordering::Relaxed));
        bytes as f64 / (1024.0 * 1024.0)
    }

    /// What the validation layer said since this was last asked.
    pub fn take_messages(&self) -> Vec<Message> {
        self.0.vulkan.as_ref().map(|vulkan| vulkan.instance.messages.take()).unwrap_or_default()
    }

    /// The name that a resource was made with.
    pub fn resource_name(&self, id: ResourceId) -> String {
        lock(&self.0.names).get(id.0 as usize).cloned().unwrap_or_default()
    }

    /// Writes the pipeline cache to disk, if it has a place there. Failing to is no error: it is only a cache.
    pub fn save_pipeline_cache(&self) {
        if let Some(vulkan) = &self.0.vulkan {
            vulkan.pipelines.save(&vulkan.device);
        }
    }

    pub(crate) fn new_id(&self, name: &str) -> ResourceId {
        let mut names = lock(&self.0.names);
        let id = self.0.next_id.fetch_add(1, Ordering::Relaxed);
        names.push(name.to_owned());
        ResourceId(id)
    }

    pub(crate) fn vulkan(&self) -> Result<&Vulkan> {
        self.0.vulkan.as_ref().ok_or(Error::RecordingOnly)
    }
}

fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    extras: Extras,
    windows: bool,
) -> Result<ash::Device> {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&priorities)];
    let core = vk::PhysicalDeviceFeatures::default()
        .multi_draw_indirect(extras.has(Extra::MultiDrawIndirect))
        .draw_indirect_first_instance(true)
        .fragment_stores_and_atomics(true)
        .occlusion_query_precise(extras.has(Extra::OcclusionQueryPrecise))
        .pipeline_statistics_query(extras.has(Extra::PipelineStatistics));
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default()
        .draw_indirect_count(extras.has(Extra::DrawIndirectCount))
        .scalar_block_layout(true)
        .host_query_reset(extras.has(Extra::HostQueryReset));
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .maintenance4(true)
        .shader_demote_to_helper_invocation(true)
        .subgroup_size_control(extras.has(Extra::SubgroupSizeControl))
        .compute_full_subgroups(extras.has(Extra::SubgroupSizeControl));
    let swapchain = windows.then_some(ash::khr::swapchain::NAME.as_ptr());
    let push = ash::khr::push_descriptor::NAME.as_ptr();
    let extensions: Vec<_> = extras.has(Extra::PushDescriptor).then_some(push).into_iter().chain(swapchain).collect();
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&core)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: the features were checked by `adapter::choose`; everything pointed to lives through the call.
    unsafe { instance.create_device(physical, &info, None) }.named("vkCreateDevice")
}

impl Vulkan {
    fn new(
        instance: Instance,
        physical: vk::PhysicalDevice,
        device: ash::Device,
        family: u32,
        info: AdapterInfo,
        options: &GpuOptions,
    ) -> Result<Self> {
        let descriptors = Descriptors::new(&instance.raw, &device, info.extras);
        // SAFETY: the extension is loaded when its function answers; without it labels are left out.
        let has_labels =
            unsafe { instance.raw.get_device_proc_addr(device.handle(), c"vkCmdBeginDebugUtilsLabelEXT".as_ptr()) }
                .is_some();
        let has_labels = has_labels && info.extras.has(Extra::DebugUtils);
        let names = Names(has_labels.then(|| ash::ext::debug_utils::Device::new(&instance.raw, &device)));
        names.give(device.handle(), "device");
        // SAFETY: the family was asked for when the device was made.
        let queue = unsafe { device.get_device_queue(family, 0) };
        names.give(queue, "queue");
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the device is alive.
        let pool = unsafe { device.create_command_pool(&pool_info, None) }.named("vkCreateCommandPool")?;
        names.give(pool, "commands");
        // SAFETY: the device is alive.
        let submitted = unsafe { device.create_fence(&Default::default(), None) }.named("vkCreateFence")?;
        names.give(submitted, "submission");
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: device.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        })
        .map_err(|source| Error::OutOfMemory { what: "the allocator".to_owned(), mib: 0.0, source })?;
        let pipelines = Pipelines::new(&device, &info, options.cache_dir.as_deref(), &names)?;
        Ok(Vulkan {
            descriptors,
            names,
            queue: Mutex::new(queue),
            submitted,
            pool: Mutex::new(pool),
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            pipelines,
            info,
            depth: options.depth,
            memory_bytes: AtomicU64::new(0),
            retired: RetiredList::default(),
            queries: QueryStore::default(),
            frames_alive: AtomicUsize::new(0),
            uploads: AtomicU64::new(0),
            physical,
            family,
            windows: options.windows,
            timer: OnceLock::new(),
            instance,
            device,
        })
    }

    pub(crate) fn has(&self, extra: Extra) -> bool {
        self.info.extras.has(extra)
    }

    /// Device memory for a resource.
    pub(crate) fn allocate(
        &self,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Allocation> {
        let description = AllocationCreateDesc {
            name,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let allocation = lock(&self.allocator).allocate(&description).map_err(|source| Error::OutOfMemory {
            what: name.to_owned(),
            mib: requirements.size as f64 / (1024.0 * 1024.0),
            source,
        })?;
        self.memory_bytes.fetch_add(allocation.size(), Ordering::Relaxed);
        Ok(allocation)
    }

    /// Frees what was dropped, if no recorded frame can still name it.
    pub(crate) fn bury(&self) {
        if self.frames_alive.load(Ordering::Acquire) == 0 {
            self.free_retired();
        }
    }

    fn free_retired(&self) {
        for one in self.retired.take() {
            let bytes = one.free(&self.device, &self.allocator);
            self.memory_bytes.fetch_sub(bytes, Ordering::Relaxed);
        }
    }

    /// Gives a Vulkan object the name that captures and messages show.
    pub(crate) fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        self.names.give(handle, name);
    }
}

impl Drop for Vulkan {
    fn drop(&mut self) {
        // SAFETY: after the wait nothing is in use; objects go before the device, and the instance goes after this.
        unsafe {
            let _ = self.device.device_wait_idle();
        }
        self.free_retired();
        self.pipelines.save(&self.device);
        self.pipelines.destroy(&self.device);
        self.queries.destroy(&self.device);
        self.descriptors.destroy(&self.device);
        // SAFETY: dropped once, here; no allocation outlives it because buffers and images hold the `Gpu`.
        unsafe { ManuallyDrop::drop(&mut self.allocator) };
        // SAFETY: as above.
        unsafe {
            self.device.destroy_fence(self.submitted, None);
            self.device.destroy_command_pool(*lock(&self.pool), None);
            self.device.destroy_device(None);
        }
    }
}
