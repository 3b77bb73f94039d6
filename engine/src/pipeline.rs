//! Pipelines, made on first use from what the shader generator wrote down.

use crate::depth::DepthFormat;
use crate::error::Named;
use crate::features::{Extra, Extras};
use crate::lock::lock;
use crate::names::Names;
use crate::recorder::{Faces, Primitives, Surface};
use crate::target::Format;
use crate::{pipeline_cache, AdapterInfo, Error, Result};
use ash::vk;
use shaders::{BindingKind, BoundStage, ShaderKind, StageInfo};
use std::collections::HashMap;
use std::ffi::CStr;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

mod constants;
mod replaced;
mod vertices;

use constants::Constants;
use replaced::Replaced;
pub(crate) use vertices::{INSTANCE_BINDING, VERTEX_BINDING};

const ENTRY: &CStr = c"main";

/// A pipeline and its layout.
#[derive(Clone, Copy)]
pub(crate) struct Pipeline {
    pub(crate) raw: vk::Pipeline,
    pub(crate) layout: vk::PipelineLayout,
    pub(crate) set: vk::DescriptorSetLayout,
    pub(crate) push_stages: vk::ShaderStageFlags,
}

/// What the drawing state of a pipeline depends on besides its stage.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct DrawState {
    pub(crate) colour: Option<Format>,
    pub(crate) item: bool,
    pub(crate) depth: DepthFormat,
    pub(crate) depth_write: bool,
    pub(crate) strictly_nearer: bool,
    pub(crate) primitives: Primitives,
    pub(crate) faces: Faces,
    /// How colours meet those that are there.
    pub(crate) surface: Surface,
    /// Samples a pixel.
    pub(crate) samples: u32,
}

type Key = (&'static str, Vec<u32>, Option<DrawState>);

/// All pipelines of a device.
pub(crate) struct Pipelines {
    made: Mutex<HashMap<Key, Pipeline>>,
    layouts: Mutex<HashMap<&'static str, (vk::DescriptorSetLayout, vk::PipelineLayout)>>,
    made_any: Mutex<bool>,
    /// Shaders to use in place of those built in.
    replaced: Mutex<Replaced>,
    /// What gathered textures are read with.
    sampler: vk::Sampler,
    cache: vk::PipelineCache,
    cache_file: Option<PathBuf>,
    info: AdapterInfo,
    names: Names,
}

impl Pipelines {
    pub(crate) fn new(device: &ash::Device, info: &AdapterInfo, folder: Option<&Path>, names: &Names) -> Result<Self> {
        let cache_file = folder.map(|folder| pipeline_cache::file(folder, info));
        let cache = pipeline_cache::load(device, cache_file.as_deref())?;
        // Nearest and clamped to the edge, as filled in; texels are gathered, never filtered.
        let nearest = vk::SamplerCreateInfo::default()
            .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .address_mode_w(vk::SamplerAddressMode::CLAMP_TO_EDGE);
        // SAFETY: the device is alive; the info lives through the call.
        let sampler = unsafe { device.create_sampler(&nearest, None) }.named("vkCreateSampler")?;
        names.give(cache, "pipelines");
        names.give(sampler, "gathering");
        Ok(Pipelines {
            sampler,
            made: Mutex::default(),
            layouts: Mutex::default(),
            made_any: Mutex::new(false),
            replaced: Mutex::default(),
            cache,
            cache_file,
            info: info.clone(),
            names: names.clone(),
        })
    }

    /// Writes the cache to its file, if it has one and anything was made since.
    pub(crate) fn save(&self, device: &ash::Device) {
        let Some(path) = &self.cache_file else { return };
        if std::mem::take(&mut *lock(&self.made_any)) {
            pipeline_cache::save(device, self.cache, path);
        }
    }

    /// The pipeline of a stage, with the drawing state if it draws.
    pub(crate) fn get(&self, device: &ash::Device, stage: &BoundStage, draw: Option<DrawState>) -> Result<Pipeline> {
        let key: Key = (stage.info.name, stage.constants.clone(), draw);
        if let Some(pipeline) = lock(&self.made).get(&key) {
            return Ok(*pipeline);
        }
        let pipeline = self.make(device, stage.info, &key)?;
        lock(&self.made).insert(key, pipeline);
        Ok(pipeline)
    }

    fn make(&self, device: &ash::Device, info: &'static StageInfo, (_, values, draw): &Key) -> Result<Pipeline> {
        let (set, layout) = self.layout(device, info)?;
        let raw = match draw {
            None => self.compute(device, info, values, layout)?,
            Some(state) => self.graphics(device, info, values, layout, state)?,
        };
        self.names.give(raw, info.name);
        *lock(&self.made_any) = true;
        Ok(Pipeline { raw, layout, set, push_stages: stage_flags(info) })
    }

    fn layout(
        &self,
        device: &ash::Device,
        info: &'static StageInfo,
    ) -> Result<(vk::DescriptorSetLayout, vk::PipelineLayout)> {
        let mut layouts = lock(&self.layouts);
        if let Some(made) = layouts.get(info.name) {
            return Ok(*made);
        }
        check_bindings(&self.info, info)?;
        let flags = stage_flags(info);
        let samplers = [self.sampler];
        let bindings: Vec<_> = info
            .bindings
            .iter()
            .map(|binding| {
                let layout = vk::DescriptorSetLayoutBinding::default()
                    .binding(binding.binding)
                    .descriptor_type(descriptor_type(binding.kind))
                    .descriptor_count(1)
                    .stage_flags(flags);
                match binding.kind {
                    BindingKind::GatheredImage => layout.immutable_samplers(&samplers),
                    _ => layout,
                }
            })
            .collect();
        let set_info =
            vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings).flags(set_flags(self.info.extras));
        // SAFETY: the device is alive; the arrays live through the calls.
        let set =
            unsafe { device.create_descriptor_set_layout(&set_info, None) }.named("vkCreateDescriptorSetLayout")?;
        let sets = [set];
        let ranges = [vk::PushConstantRange { stage_flags: flags, offset: 0, size: info.push_size }];
        let used = if info.push_size > 0 { &ranges[..] } else { &[] };
        let layout_info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets).push_constant_ranges(used);
        // SAFETY: as above.
        let layout = unsafe { device.create_pipeline_layout(&layout_info, None) }.named("vkCreatePipelineLayout")?;
        self.names.give(set, info.name);
        self.names.give(layout, info.name);
        layouts.insert(info.name, (set, layout));
        Ok((set, layout))
    }

    fn compute(
        &self,
        device: &ash::Device,
        stage: &StageInfo,
        values: &[u32],
        layout: vk::PipelineLayout,
    ) -> Result<vk::Pipeline> {
        let constants = Constants::new(stage, values);
        let specialization = constants.info();
        let module = self.shader(device, stage, &stage.modules[0])?;
        // A stage whose work group should be one subgroup says so by a constant of this name; the size is then required. It must
        // be right, if slower, whatever subgroups there are: not every device takes a size.
        let mut required = vk::PipelineShaderStageRequiredSubgroupSizeCreateInfo::default()
            .required_subgroup_size(self.info.subgroup_size);
        let has_size = self.info.extras.has(Extra::SubgroupSizeControl);
        let mut shader_stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(ENTRY)
            .specialization_info(&specialization);
        if has_size && stage.constants.iter().any(|constant| constant.name == "SUBGROUP_SIZE") {
            shader_stage =
                shader_stage.flags(vk::PipelineShaderStageCreateFlags::REQUIRE_FULL_SUBGROUPS).push_next(&mut required);
        }
        let info = [vk::ComputePipelineCreateInfo::default().stage(shader_stage).layout(layout)];
        // SAFETY: the module fits the layout: both come from one reflection.
        let made = unsafe { device.create_compute_pipelines(self.cache, &info, None) };
        // SAFETY: a module is not needed once the pipeline is made.
        unsafe { device.destroy_shader_module(module, None) };
        first(made, "vkCreateComputePipelines")
    }

    fn graphics(
        &self,
        device: &ash::Device,
        stage: &StageInfo,
        values: &[u32],
        layout: vk::PipelineLayout,
        state: &DrawState,
    ) -> Result<vk::Pipeline> {
        let constants = Constants::new(stage, values);
        let specialization = constants.info();
        let mut modules = Vec::new();
        for module in stage.modules {
            modules.push((module.kind, self.shader(device, stage, module)?));
        }
        let stages: Vec<_> = modules
            .iter()
            .map(|(kind, module)| {
                vk::PipelineShaderStageCreateInfo::default()
                    .stage(shader_flag(*kind))
                    .module(*module)
                    .name(ENTRY)
                    .specialization_info(&specialization)
            })
            .collect();
        let made = draw_pipeline(device, self.cache, stage, layout, state, &stages);
        for (_, module) in modules {
            // SAFETY: a module is not needed once the pipeline is made.
            unsafe { device.destroy_shader_module(module, None) };
        }
        made
    }

    pub(crate) fn destroy(&self, device: &ash::Device) {
        // SAFETY: called once, when the device is idle and about to go.
        unsafe {
            for pipeline in lock(&self.made).values() {
                device.destroy_pipeline(pipeline.raw, None);
            }
            for (set, layout) in lock(&self.layouts).values() {
                device.destroy_pipeline_layout(*layout, None);
                device.destroy_descriptor_set_layout(*set, None);
            }
            device.destroy_sampler(self.sampler, None);
            device.destroy_pipeline_cache(self.cache, None);
        }
    }
}

/// An error if a stage binds more buffers than the device lets it: Vulkan promises 4, devices give 30 or more.
fn check_bindings(adapter: &AdapterInfo, info: &StageInfo) -> Result<()> {
    let buffers = info.bindings.iter().filter(|binding| binding.kind == BindingKind::StorageBuffer).count();
    if buffers <= adapter.most_buffers as usize {
        return Ok(());
    }
    Err(Error::TooLarge {
        what: format!("stage '{}'", info.name),
        wanted: format!("{buffers} storage buffers"),
        limit: format!("{} a stage", adapter.most_buffers),
        device: adapter.name.clone(),
        remedy: "choose another method or device".to_owned(),
    })
}

fn draw_pipeline(
    device: &ash::Device,
    cache: vk::PipelineCache,
    info: &StageInfo,
    layout: vk::PipelineLayout,
    state: &DrawState,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
) -> Result<vk::Pipeline> {
    let (bindings, attributes) = vertices::vertex_layout(info);
    let vertex = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&bindings)
        .vertex_attribute_descriptions(&attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default().topology(match state.primitives {
        Primitives::Triangles => vk::PrimitiveTopology::TRIANGLE_LIST,
        Primitives::Lines => vk::PrimitiveTopology::LINE_LIST,
        Primitives::Points => vk::PrimitiveTopology::POINT_LIST,
    });
    let viewport = vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .line_width(1.0)
        .front_face(vk::FrontFace::COUNTER_CLOCKWISE)
        .cull_mode(match state.faces {
            Faces::Both => vk::CullModeFlags::NONE,
            Faces::Front => vk::CullModeFlags::BACK,
        });
    let samples = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::from_raw(state.samples));
    let depth = vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(true)
        .depth_write_enable(state.depth_write)
        .depth_compare_op(state.depth.nearer(state.strictly_nearer));
    let replace = vk::PipelineColorBlendAttachmentState::default().color_write_mask(vk::ColorComponentFlags::RGBA);
    let add = replace
        .blend_enable(true)
        .src_color_blend_factor(vk::BlendFactor::ONE)
        .dst_color_blend_factor(vk::BlendFactor::ONE)
        .color_blend_op(vk::BlendOp::ADD);
    let over = add
        .src_color_blend_factor(vk::BlendFactor::SRC_ALPHA)
        .dst_color_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
        .src_alpha_blend_factor(vk::BlendFactor::ONE)
        .dst_alpha_blend_factor(vk::BlendFactor::ONE_MINUS_SRC_ALPHA)
        .alpha_blend_op(vk::BlendOp::ADD);
    let blend = match state.colour {
        Some(Format::Heat) => add,
        _ => match state.surface {
            Surface::Translucent => over,
            Surface::Light => add,
            Surface::Opaque | Surface::Masked => replace,
        },
    };
    let formats = attachment_formats(state);
    let blends = vec![blend; formats.len()];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(&formats)
        .depth_attachment_format(state.depth.vulkan());
    let create = [vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertex)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering)];
    // SAFETY: modules, layout and vertex input come from one reflection; everything pointed to lives through the call.
    first(unsafe { device.create_graphics_pipelines(cache, &create, None) }, "vkCreateGraphicsPipelines")
}

/// Colour first, then the item buffer.
fn attachment_formats(state: &DrawState) -> Vec<vk::Format> {
    let formats = state.colour.into_iter().chain(state.item.then_some(Format::Item));
    formats.map(|format| format.vulkan(state.depth)).collect()
}

fn first(
    made: std::result::Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
    call: &'static str,
) -> Result<vk::Pipeline> {
    match made {
        Ok(pipelines) => Ok(pipelines[0]),
        Err((_, result)) => Err(Error::Vulkan { call, result }),
    }
}

fn shader_flag(kind: ShaderKind) -> vk::ShaderStageFlags {
    match kind {
        ShaderKind::Vertex => vk::ShaderStageFlags::VERTEX,
        ShaderKind::Fragment => vk::ShaderStageFlags::FRAGMENT,
        ShaderKind::Compute => vk::ShaderStageFlags::COMPUTE,
    }
}

fn stage_flags(info: &StageInfo) -> vk::ShaderStageFlags {
    info.modules.iter().fold(vk::ShaderStageFlags::empty(), |flags, module| flags | shader_flag(module.kind))
}

pub(crate) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::SampledImage => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::GatheredImage => vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        BindingKind::StorageImage => vk::DescriptorType::STORAGE_IMAGE,
    }
}

/// How layouts of sets are made: for descriptors that are pushed, or that lie in a pool.
fn set_flags(extras: Extras) -> vk::DescriptorSetLayoutCreateFlags {
    if extras.has(Extra::PushDescriptor) {
        vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR
    } else {
        vk::DescriptorSetLayoutCreateFlags::empty()
    }
}
