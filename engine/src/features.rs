//! What the engine asks of a device: what every device must have, and why; and what it can do without, and how.

use crate::{Error, Result};
use ash::vk;

/// Something a device has or lacks, by the name that `--without` takes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Feature {
    /// Vulkan's name where there is one.
    pub name: &'static str,
    /// The device has it, and it was not turned off.
    pub present: bool,
    /// Who needs it, or what is done without it.
    pub why: &'static str,
}

/// What the engine uses where it is to be had. Each has a way around it, which `--without` takes on any device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extra {
    /// The number of a list's commands is read on the GPU.
    DrawIndirectCount,
    /// One call draws many commands.
    MultiDrawIndirect,
    /// Descriptors are written into the command buffer.
    PushDescriptor,
    /// The size of a compute stage's subgroups can be asked for.
    SubgroupSizeControl,
    /// The host resets queries.
    HostQueryReset,
    /// Device memory that the host reads and writes.
    MappedMemory,
    /// The device says when it got how far.
    Timestamps,
    /// The device counts primitives and fragments.
    PipelineStatistics,
    /// Occlusion queries count samples.
    OcclusionQueryPrecise,
    /// Stages and resources have names in captures and messages.
    DebugUtils,
}

impl Extra {
    /// All of them.
    pub const ALL: [Extra; 10] = [
        Extra::DrawIndirectCount,
        Extra::MultiDrawIndirect,
        Extra::PushDescriptor,
        Extra::SubgroupSizeControl,
        Extra::HostQueryReset,
        Extra::MappedMemory,
        Extra::Timestamps,
        Extra::PipelineStatistics,
        Extra::OcclusionQueryPrecise,
        Extra::DebugUtils,
    ];

    /// What `--without` calls it.
    pub fn name(self) -> &'static str {
        match self {
            Extra::DrawIndirectCount => "drawIndirectCount",
            Extra::MultiDrawIndirect => "multiDrawIndirect",
            Extra::PushDescriptor => "VK_KHR_push_descriptor",
            Extra::SubgroupSizeControl => "subgroupSizeControl",
            Extra::HostQueryReset => "hostQueryReset",
            Extra::MappedMemory => "mappedDeviceMemory",
            Extra::Timestamps => "timestamps",
            Extra::PipelineStatistics => "pipelineStatisticsQuery",
            Extra::OcclusionQueryPrecise => "occlusionQueryPrecise",
            Extra::DebugUtils => "VK_EXT_debug_utils",
        }
    }

    fn without(self) -> &'static str {
        match self {
            Extra::DrawIndirectCount => {
                "without it lists draw all they have room for, and engine/clear_tail empties what is behind their end"
            }
            Extra::MultiDrawIndirect => "without it each command of a list is a call of its own",
            Extra::PushDescriptor => "without it stages bind descriptor sets from a pool that is reset each submission",
            Extra::SubgroupSizeControl => "without it prefix sums run on whatever subgroups the device makes",
            Extra::HostQueryReset => "without it queries are reset on the device",
            Extra::MappedMemory => "without it the host reads and writes buffers of stages through staging copies",
            Extra::Timestamps => "without it frames are timed and stages are not",
            Extra::PipelineStatistics => {
                "without it a frame has no counts of primitives and fragments (bench does not use them)"
            }
            Extra::OcclusionQueryPrecise => {
                "without it queries say whether a box shows, not by how much: min-pixels above 1 is refused"
            }
            Extra::DebugUtils => "without it stages and resources have no names in captures and messages",
        }
    }
}

/// The extras that a device has and that were not turned off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Extras(u32);

impl Extras {
    /// All of them: what an engine without a device records for.
    pub(crate) fn all() -> Self {
        Extra::ALL.into_iter().fold(Extras::default(), |all, extra| all.with(extra, true))
    }

    pub(crate) fn has(self, extra: Extra) -> bool {
        self.0 & 1 << extra as u32 != 0
    }

    fn with(self, extra: Extra, present: bool) -> Self {
        Extras(self.0 | u32::from(present) << extra as u32)
    }
}

/// Lists that a count lies beside are never cut in pieces, so a device must draw so many commands at once. Vulkan promises 65,535.
const LONGEST_COUNTED_LIST: u32 = 1 << 24;

/// What was found out about a device.
pub(crate) struct Found {
    pub(crate) needed: Vec<Feature>,
    pub(crate) optional: Vec<Feature>,
    pub(crate) extras: Extras,
}

/// What a device has, less what is to be done `without`.
pub(crate) fn find(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
    timestamp_bits: u32,
    without: &[String],
) -> Found {
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut v12).push_next(&mut v13);
    // SAFETY: the device handle comes from this instance; the chain lives through the call.
    unsafe { instance.get_physical_device_features2(device, &mut all) };
    let core = all.features;
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut sizes = vk::PhysicalDeviceSubgroupSizeControlProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut subgroup).push_next(&mut sizes);
    // SAFETY: as above.
    unsafe { instance.get_physical_device_properties2(device, &mut properties) };
    let limits = properties.properties.limits;
    // SAFETY: as above.
    let (extensions, memory) = unsafe {
        let extensions = instance.enumerate_device_extension_properties(device).unwrap_or_default();
        (extensions, instance.get_physical_device_memory_properties(device))
    };
    let on = |feature: vk::Bool32| feature == vk::TRUE;
    let adds = subgroup.supported_operations.contains(vk::SubgroupFeatureFlags::ARITHMETIC)
        && subgroup.supported_stages.contains(vk::ShaderStageFlags::COMPUTE);
    let needed = [
        (
            "drawIndirectFirstInstance",
            on(core.draw_indirect_first_instance),
            "every drawing: a command names its object by its first instance",
        ),
        (
            "fragmentStoresAndAtomics",
            on(core.fragment_stores_and_atomics),
            "drawings that set a flag for each object whose fragments they see",
        ),
        ("scalarBlockLayout", on(v12.scalar_block_layout), "every stage: buffers lie as their Rust structs do"),
        ("dynamicRendering", on(v13.dynamic_rendering), "every drawing and clear"),
        ("synchronization2", on(v13.synchronization2), "every barrier and submission"),
        (
            "shaderDemoteToHelperInvocation",
            on(v13.shader_demote_to_helper_invocation),
            "masked surfaces, whose fragments are discarded",
        ),
        ("maintenance4", on(v13.maintenance4), "prefix sums, whose work group is one subgroup of the device's size"),
        ("subgroup arithmetic", adds, "prefix sums, which put lists in order"),
    ];
    let present = |extra| match extra {
        Extra::DrawIndirectCount => {
            on(v12.draw_indirect_count) && limits.max_draw_indirect_count >= LONGEST_COUNTED_LIST
        }
        Extra::MultiDrawIndirect => on(core.multi_draw_indirect),
        Extra::PushDescriptor => extensions
            .iter()
            .any(|extension| extension.extension_name_as_c_str() == Ok(ash::khr::push_descriptor::NAME)),
        Extra::SubgroupSizeControl => {
            on(v13.subgroup_size_control)
                && on(v13.compute_full_subgroups)
                && sizes.required_subgroup_size_stages.contains(vk::ShaderStageFlags::COMPUTE)
        }
        Extra::HostQueryReset => on(v12.host_query_reset),
        Extra::MappedMemory => memory.memory_types_as_slice().iter().any(|one| one.property_flags.contains(MAPPED)),
        Extra::Timestamps => timestamp_bits > 0,
        Extra::PipelineStatistics => on(core.pipeline_statistics_query),
        Extra::OcclusionQueryPrecise => on(core.occlusion_query_precise),
        // An extension of the instance, which comes from the loader or a layer: `gpu.rs` asks whether it is there.
        Extra::DebugUtils => true,
    };
    let wanted = |name: &str| !without.iter().any(|off| off.eq_ignore_ascii_case(name));
    let mut found = Found { needed: Vec::new(), optional: Vec::new(), extras: Extras::default() };
    for (name, present, why) in needed {
        found.needed.push(Feature { name, present: present && wanted(name), why });
    }
    for extra in Extra::ALL {
        let (name, why) = (extra.name(), extra.without());
        let present = present(extra) && wanted(name);
        found.extras = found.extras.with(extra, present);
        found.optional.push(Feature { name, present, why });
    }
    found
}

/// Device memory that the host can write without flushing.
const MAPPED: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::from_raw(
    vk::MemoryPropertyFlags::DEVICE_LOCAL.as_raw()
        | vk::MemoryPropertyFlags::HOST_VISIBLE.as_raw()
        | vk::MemoryPropertyFlags::HOST_COHERENT.as_raw(),
);

/// An error if one of the names is that of nothing that can be turned off.
pub(crate) fn check_names(without: &[String], needed: &[Feature], optional: &[Feature]) -> Result<()> {
    let known = optional.iter().chain(needed).map(|feature| feature.name);
    match without.iter().find(|name| !known.clone().any(|known| known.eq_ignore_ascii_case(name))) {
        None => Ok(()),
        Some(wanted) => Err(Error::NoSuchFeature {
            wanted: wanted.clone(),
            known: optional.iter().map(|feature| feature.name).collect::<Vec<_>>().join(", "),
        }),
    }
}
