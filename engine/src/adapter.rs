//! Which device: listing, features, choice.

use crate::depth::DepthFormat;
use crate::error::Named;
use crate::instance::Instance;
use crate::{Error, Result};
use ash::vk;
use std::fmt;

/// What sort of device it is, best first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum DeviceKind {
    /// A GPU with its own memory.
    Discrete,
    /// A GPU that shares the host's memory.
    Integrated,
    /// A GPU seen through a hypervisor, or of an unknown sort.
    Virtual,
    /// A CPU: lavapipe.
    Cpu,
}

/// What is known of a device before it is opened.
#[derive(Clone, Debug)]
pub struct AdapterInfo {
    /// The driver's name for the device.
    pub name: String,
    /// What sort it is.
    pub kind: DeviceKind,
    /// Driver name and version.
    pub driver: String,
    /// Vulkan version, as "1.3.230".
    pub api: String,
    /// What Sightline needs and the device lacks; empty if it can be used.
    pub missing: Vec<String>,
    /// What is used where present: (name, present, what it is for).
    pub optional: Vec<(&'static str, bool, &'static str)>,
    /// Largest image side in pixels.
    pub max_image_px: u32,
    /// Largest storage buffer range in bytes.
    pub max_storage_bytes: u64,
    /// Lanes of a subgroup.
    pub subgroup_size: u32,
    /// The grid that vertex positions are snapped to, pixels.
    pub snap_px: f32,
    /// Nanoseconds a timestamp tick; 0 if there are no timestamps.
    pub timestamp_ns: f32,
    /// Identifies driver and device for caches.
    pub cache_key: String,
}

impl fmt::Display for AdapterInfo {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} ({:?}, {}, Vulkan {})", self.name, self.kind, self.driver, self.api)?;
        if !self.missing.is_empty() {
            write!(out, ", cannot be used: lacks {}", self.missing.join(", "))?;
        }
        Ok(())
    }
}

/// All devices, best first: discrete, integrated, virtual, CPU; within a sort in the driver's order.
pub(crate) fn list(instance: &Instance) -> Result<Vec<(vk::PhysicalDevice, AdapterInfo)>> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }.named("vkEnumeratePhysicalDevices")?;
    let mut found: Vec<_> = devices.into_iter().map(|device| (device, describe(&instance.raw, device))).collect();
    found.sort_by_key(|(_, info)| info.kind);
    Ok(found)
}

/// The device that `--device` names by index or by part of its name; the best usable one if it names none.
pub(crate) fn choose(instance: &Instance, wanted: Option<&str>) -> Result<(vk::PhysicalDevice, AdapterInfo)> {
    let found = list(instance)?;
    if found.is_empty() {
        return Err(Error::NoDevice);
    }
    let position = match wanted {
        None => found.iter().position(|(_, info)| info.missing.is_empty()).or(Some(0)),
        Some(wanted) => match wanted.parse::<usize>() {
            Ok(index) => Some(index).filter(|index| *index < found.len()),
            Err(_) => found.iter().position(|(_, info)| info.name.to_lowercase().contains(&wanted.to_lowercase())),
        },
    };
    let names = || {
        found
            .iter()
            .enumerate()
            .map(|(index, (_, info))| format!("{index}: {}", info.name))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let Some(position) = position else {
        return Err(Error::NoSuchDevice { wanted: wanted.unwrap_or_default().to_owned(), found: names() });
    };
    let (device, info) = found[position].clone();
    if !info.missing.is_empty() {
        return Err(Error::MissingFeatures { device: info.name, missing: info.missing.join(", ") });
    }
    Ok((device, info))
}

/// An error if the device cannot draw to and read depth of that format.
pub(crate) fn check_depth(
    instance: &Instance,
    device: vk::PhysicalDevice,
    info: &AdapterInfo,
    depth: DepthFormat,
) -> Result<()> {
    // SAFETY: the device handle comes from this instance.
    let found = unsafe { instance.raw.get_physical_device_format_properties(device, depth.vulkan()) };
    let needed = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT
        | vk::FormatFeatureFlags::SAMPLED_IMAGE
        | vk::FormatFeatureFlags::TRANSFER_SRC;
    if found.optimal_tiling_features.contains(needed) {
        return Ok(());
    }
    Err(Error::MissingFeatures {
        device: info.name.clone(),
        missing: format!("depth buffers of {depth} that can be read"),
    })
}

/// An error if the device cannot show pictures in windows.
pub(crate) fn check_windows(instance: &Instance, device: vk::PhysicalDevice, info: &AdapterInfo) -> Result<()> {
    // SAFETY: the device handle comes from this instance.
    let extensions = unsafe { instance.raw.enumerate_device_extension_properties(device) }
        .named("vkEnumerateDeviceExtensionProperties")?;
    if extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(ash::khr::swapchain::NAME)) {
        return Ok(());
    }
    Err(Error::MissingFeatures { device: info.name.clone(), missing: "VK_KHR_swapchain (windows)".to_owned() })
}

fn describe(instance: &ash::Instance, device: vk::PhysicalDevice) -> AdapterInfo {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut subgroup);
    // SAFETY: the device handle comes from this instance; the chain lives through the call.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let core = properties.properties;
    let version = core.api_version;
    let text = |name: std::result::Result<&std::ffi::CStr, _>| {
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    };
    let (missing, optional) = features(instance, device, version);
    let cache_key = core.pipeline_cache_uuid.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    AdapterInfo {
        name: text(core.device_name_as_c_str()),
        kind: kind(core.device_type),
        driver: format!("{} {}", text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str())),
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        missing,
        optional,
        max_image_px: core
            .limits
            .max_image_dimension2_d
            .min(core.limits.max_framebuffer_width)
            .min(core.limits.max_framebuffer_height),
        max_storage_bytes: u64::from(core.limits.max_storage_buffer_range),
        subgroup_size: subgroup.subgroup_size,
        snap_px: (0.5f32).powi(core.limits.sub_pixel_precision_bits as i32),
        timestamp_ns: if core.limits.timestamp_compute_and_graphics == vk::TRUE {
            core.limits.timestamp_period
        } else {
            0.0
        },
        cache_key: format!("{cache_key}-{:08x}-{:08x}-{:08x}", core.vendor_id, core.device_id, core.driver_version),
    }
}

fn kind(kind: vk::PhysicalDeviceType) -> DeviceKind {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
        vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
        _ => DeviceKind::Virtual,
    }
}

type Optional = Vec<(&'static str, bool, &'static str)>;

/// What the device lacks, and which optional features it has.
fn features(instance: &ash::Instance, device: vk::PhysicalDevice, version: u32) -> (Vec<String>, Optional) {
    // Features decide, not the version: RenderDoc 1.24 says 1.2 of devices that it passes 1.3 through to.
    if version < vk::API_VERSION_1_2 {
        return (vec!["Vulkan 1.3".to_owned()], Vec::new());
    }
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut v12).push_next(&mut v13);
    // SAFETY: the device handle comes from this instance; the chain lives through the call.
    unsafe { instance.get_physical_device_features2(device, &mut all) };
    let core = all.features;
    // SAFETY: as above.
    let extensions = unsafe { instance.enumerate_device_extension_properties(device) }.unwrap_or_default();
    let push_descriptor =
        extensions.iter().any(|extension| extension.extension_name_as_c_str() == Ok(ash::khr::push_descriptor::NAME));
    let needed = [
        ("multiDrawIndirect", core.multi_draw_indirect),
        ("drawIndirectFirstInstance", core.draw_indirect_first_instance),
        ("fragmentStoresAndAtomics", core.fragment_stores_and_atomics),
        ("drawIndirectCount", v12.draw_indirect_count),
        ("scalarBlockLayout", v12.scalar_block_layout),
        ("hostQueryReset", v12.host_query_reset),
        ("dynamicRendering", v13.dynamic_rendering),
        ("synchronization2", v13.synchronization2),
        ("maintenance4", v13.maintenance4),
        ("subgroupSizeControl", v13.subgroup_size_control),
        ("computeFullSubgroups", v13.compute_full_subgroups),
        ("VK_KHR_push_descriptor", u32::from(push_descriptor)),
    ];
    let missing =
        needed.iter().filter(|(_, present)| *present == vk::FALSE).map(|(name, _)| (*name).to_owned()).collect();
    let optional = vec![(
        "pipelineStatisticsQuery",
        core.pipeline_statistics_query == vk::TRUE,
        "primitive and fragment counts of a frame (not used by bench)",
    )];
    (missing, optional)
}
