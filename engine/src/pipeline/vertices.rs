//! Where vertices and instances are bound, and how they lie.

use ash::vk;
use shaders::{StageInfo, VertexFormat};

/// Where the vertex buffer and the instance buffer are bound.
pub(crate) const VERTEX_BINDING: u32 = 0;
pub(crate) const INSTANCE_BINDING: u32 = 1;

/// What a stage reads of vertices and instances.
pub(super) fn vertex_layout(
    info: &StageInfo,
) -> (Vec<vk::VertexInputBindingDescription>, Vec<vk::VertexInputAttributeDescription>) {
    let rates = [
        (VERTEX_BINDING, info.vertex_stride, vk::VertexInputRate::VERTEX),
        (INSTANCE_BINDING, info.instance_stride, vk::VertexInputRate::INSTANCE),
    ];
    let used = rates.into_iter().filter(|(_, stride, _)| *stride > 0);
    let bindings =
        used.map(|(binding, stride, input_rate)| vk::VertexInputBindingDescription { binding, stride, input_rate });
    let attribute = |binding: u32, attribute: &shaders::VertexAttribute| vk::VertexInputAttributeDescription {
        location: attribute.location,
        binding,
        format: match attribute.format {
            VertexFormat::Float => vk::Format::R32_SFLOAT,
            VertexFormat::Float2 => vk::Format::R32G32_SFLOAT,
            VertexFormat::Float3 => vk::Format::R32G32B32_SFLOAT,
            VertexFormat::Float4 => vk::Format::R32G32B32A32_SFLOAT,
            VertexFormat::Snorm16x2 => vk::Format::R16G16_SNORM,
            VertexFormat::Uint => vk::Format::R32_UINT,
        },
        offset: attribute.offset,
    };
    let of_vertex = info.vertex.iter().map(|one| attribute(VERTEX_BINDING, one));
    let of_instance = info.instance.iter().map(|one| attribute(INSTANCE_BINDING, one));
    (bindings.collect(), of_vertex.chain(of_instance).collect())
}
