//! What a stage is specialised by, as pipelines take it.

use ash::vk;
use shaders::StageInfo;

/// Specialization constants in the form Vulkan takes them.
pub(super) struct Constants {
    entries: Vec<vk::SpecializationMapEntry>,
    bytes: Vec<u8>,
}

impl Constants {
    pub(super) fn new(stage: &StageInfo, values: &[u32]) -> Self {
        let entry = |(index, constant): (usize, &shaders::ConstantInfo)| vk::SpecializationMapEntry {
            constant_id: constant.id,
            offset: (index * 4) as u32,
            size: 4,
        };
        let entries = stage.constants.iter().enumerate().map(entry).collect();
        Constants { entries, bytes: bytemuck::cast_slice(values).to_vec() }
    }

    pub(super) fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.entries).data(&self.bytes)
    }
}
