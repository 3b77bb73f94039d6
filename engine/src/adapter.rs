//! Which device: listing, features, choice.

use crate::depth::DepthFormat;
use crate::error::Named;
use crate::features::{self, Extra, Extras, Feature, Found};
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
    /// What every device must have, and who needs it.
    pub needed: Vec<Feature>,
    /// What is used where present, and what is done without.
    pub optional: Vec<Feature>,
    pub(crate) extras: Extras,
    /// Commands that one call may draw.
    pub(crate) most_draws: u32,
    /// Storage buffers that one stage may bind.
    pub(crate) most_buffers: u32,
    /// Largest image side in pixels.
    pub max_image_px: u32,
    /// Largest storage buffer range in bytes.
    pub max_storage_bytes: u64,
    /// Largest buffer of any use in bytes.
    pub max_buffer_bytes: u64,
    /// Lanes of a subgroup.
    pub subgroup_size: u32,
    /// The grid that vertex positions are snapped to, pixels.
    pub snap_px: f32,
    /// Numbers of samples that colours and depths of a picture may have, a bit each.
    pub(crate) samples: vk::SampleCountFlags,
    /// Whether samples lie where Vulkan's table of standard sample locations says.
    pub standard_samples: bool,
    /// Nanoseconds a timestamp tick; 0 if there are no timestamps.
    pub timestamp_ns: f32,
    /// Bits of a timestamp before it starts again at 0; 0 if there are no timestamps.
    pub timestamp_bits: u32,
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

/// Every Vulkan device of this machine, best first, without opening any.
pub fn adapters() -> Result<Vec<AdapterInfo>> {
    let instance = Instance::new(false, false)?;
    Ok(list(&instance, &[])?.into_iter().map(|(_, info)| info).collect())
}

/// One line a device: index, name, kind, what it lacks.
pub fn device_lines() -> Result<Vec<String>> {
    Ok(adapters()?.iter().enumerate().map(|(index, info)| format!("{index}: {info}")).collect())
}

/// All devices, best first: discrete, integrated, virtual, CPU; within a sort in the driver's order.
pub(crate) fn list(instance: &Instance, without: &[String]) -> Result<Vec<(vk::PhysicalDevice, AdapterInfo)>> {
    // SAFETY: the instance is alive.
    let devices = unsafe { instance.raw.enumerate_physical_devices() }.named("vkEnumeratePhysicalDevices")?;
    let mut found: Vec<_> =
        devices.into_iter().map(|device| (device, describe(&instance.raw, device, without))).collect();
    found.sort_by_key(|(_, info)| info.kind);
    Ok(found)
}

/// The device that `--device` names by index or by part of its name, less what is to be done `without`; the best usable one if
/// it names none.
pub(crate) fn choose(
    instance: &Instance,
    wanted: Option<&str>,
    without: &[String],
) -> Result<(vk::PhysicalDevice, AdapterInfo)> {
    let found = list(instance, without)?;
    if found.is_empty() {
        return Err(Error::NoDevice);
    }
    let position = match wanted {
        None => found.iter().position(|(_, info)| info.missing.is_empty()).or(Some(0)),
        // An empty text is a part of every name, so it would match any device.
        Some("") => None,
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
    features::check_names(without, &info.needed, &info.optional)?;
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

fn describe(instance: &ash::Instance, device: vk::PhysicalDevice, without: &[String]) -> AdapterInfo {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut sizes = vk::PhysicalDeviceMaintenance4Properties::default();
    let mut properties =
        vk::PhysicalDeviceProperties2::default().push_next(&mut driver).push_next(&mut subgroup).push_next(&mut sizes);
    // SAFETY: the device handle comes from this instance; the chain lives through the call.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let core = properties.properties;
    let (limits, version) = (core.limits, core.api_version);
    let text = |name: std::result::Result<&std::ffi::CStr, _>| {
        name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
    };
    let bits = graphics_family(instance, device).map_or(0, |(_, family)| family.timestamp_valid_bits);
    let Found { needed, optional, extras } = found(instance, device, version, bits, without);
    let missing = needed.iter().filter(|feature| !feature.present).map(|feature| feature.name.to_owned()).collect();
    let has = |extra| extras.has(extra);
    let cache_key = core.pipeline_cache_uuid.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    AdapterInfo {
        name: text(core.device_name_as_c_str()),
        kind: kind(core.device_type),
        driver: format!("{} {}", text(driver.driver_name_as_c_str()), text(driver.driver_info_as_c_str()))
            .trim()
            .to_owned(),
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        missing,
        needed,
        optional,
        extras,
        most_draws: if has(Extra::MultiDrawIndirect) { limits.max_draw_indirect_count.max(1) } else { 1 },
        most_buffers: limits.max_per_stage_descriptor_storage_buffers,
        max_image_px: limits
            .max_image_dimension2_d
            .min(limits.max_framebuffer_width)
            .min(limits.max_framebuffer_height)
            .min(limits.max_viewport_dimensions[0])
            .min(limits.max_viewport_dimensions[1]),
        // 0: a layer in between does not know the property.
        max_buffer_bytes: if sizes.max_buffer_size > 0 { sizes.max_buffer_size } else { u64::MAX },
        max_storage_bytes: u64::from(limits.max_storage_buffer_range),
        subgroup_size: subgroup.subgroup_size,
        snap_px: (0.5f32).powi(limits.sub_pixel_precision_bits as i32),
        samples: limits.framebuffer_color_sample_counts
            & limits.framebuffer_depth_sample_counts
            & limits.sampled_image_color_sample_counts
            & limits.sampled_image_depth_sample_counts,
        standard_samples: limits.standard_sample_locations != 0,
        timestamp_ns: if has(Extra::Timestamps) { limits.timestamp_period } else { 0.0 },
        timestamp_bits: if has(Extra::Timestamps) { bits } else { 0 },
        cache_key: format!("{cache_key}-{:08x}-{:08x}-{:08x}", core.vendor_id, core.device_id, core.driver_version),
    }
}

/// What the device has. Features decide, not the version: RenderDoc 1.24 says 1.2 of devices that it passes 1.3 through to.
fn found(instance: &ash::Instance, device: vk::PhysicalDevice, version: u32, bits: u32, without: &[String]) -> Found {
    if version < vk::API_VERSION_1_2 {
        let vulkan = Feature { name: "Vulkan 1.3", present: false, why: "everything" };
        return Found { needed: vec![vulkan], optional: Vec::new(), extras: Extras::default() };
    }
    features::find(instance, device, bits, without)
}

/// The first queue family for graphics and compute: its index and properties.
pub(crate) fn graphics_family(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
) -> Option<(u32, vk::QueueFamilyProperties)> {
    // SAFETY: the handle comes from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let wanted = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let index = families.iter().position(|family| family.queue_flags.contains(wanted))?;
    Some((index as u32, families[index]))
}

fn kind(kind: vk::PhysicalDeviceType) -> DeviceKind {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => DeviceKind::Discrete,
        vk::PhysicalDeviceType::INTEGRATED_GPU => DeviceKind::Integrated,
        vk::PhysicalDeviceType::CPU => DeviceKind::Cpu,
        _ => DeviceKind::Virtual,
    }
}
