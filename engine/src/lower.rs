//! From recorded steps to a Vulkan command buffer.

use crate::barriers::{Barrier, Point};
use crate::features::Extra;
use crate::gpu::Vulkan;
use crate::pipeline::{DrawState, Pipeline, INSTANCE_BINDING, VERTEX_BINDING};
use crate::recorder::{Faces, IndexedIndirect, Op, Primitives, Recorded, Surface};
use crate::target::{Format, Target};
use crate::timers::{TimerMode, MAX_TIMESTAMPS};
use crate::transfer::full_barrier;
use crate::{Error, Result};
use ash::vk;
use shaders::{Bound, BoundStage};
use vk::Handle;

mod copies;
mod queried;
mod shapes;

/// Bytes of an indexed indirect command.
const COMMAND_BYTES: u32 = 20;

/// How a submission is run.
pub(crate) struct How<'a> {
    /// What all of it is labelled with; nothing where it is empty.
    pub(crate) title: &'a str,
    /// None: stages are not timed.
    pub(crate) timer: Option<TimerMode>,
    pub(crate) statistics: Option<vk::QueryPool>,
    /// None: the device has none.
    pub(crate) timestamps: Option<vk::QueryPool>,
    pub(crate) barrier_every_stage: bool,
}

/// A command buffer ready to run.
pub(crate) struct Lowered {
    pub(crate) commands: vk::CommandBuffer,
}

struct Recording<'a> {
    vulkan: &'a Vulkan,
    commands: vk::CommandBuffer,
}

pub(crate) fn lower(vulkan: &Vulkan, ops: &[Recorded], how: &How<'_>) -> Result<Lowered> {
    let stamps = timestamps(ops.len(), &vulkan.info.name)?;
    assert_counts_do_not_lapse(ops);
    vulkan.descriptors.begin(&vulkan.device, &vulkan.names, ops)?;
    let commands = vulkan.begin_commands("frame")?;
    let recording = Recording { vulkan, commands };
    let device = &vulkan.device;
    let pools = [(how.timestamps, stamps), (how.statistics, 1)];
    for (pool, count) in pools.into_iter().filter_map(|(pool, count)| Some((pool?, count))) {
        // SAFETY: pools are this frame's own and idle; the command buffer is recording.
        unsafe {
            match vulkan.has(Extra::HostQueryReset) {
                true => device.reset_query_pool(pool, 0, count),
                false => device.cmd_reset_query_pool(commands, pool, 0, count),
            }
        }
    }
    full_barrier(device, commands);
    if let Some(pool) = how.statistics {
        // SAFETY: the query was reset above.
        unsafe { device.cmd_begin_query(commands, pool, 0, vk::QueryControlFlags::empty()) };
    }
    if !how.title.is_empty() {
        recording.label(how.title);
    }
    recording.stamp(how, 0);
    for (index, recorded) in ops.iter().enumerate() {
        recording.label(&recorded.label);
        if how.barrier_every_stage {
            full_barrier(device, commands);
        } else if let Some(barrier) = &recorded.barrier {
            recording.barrier(barrier);
        }
        recording.op(&recorded.op)?;
        recording.stamp(how, index as u32 + 1);
        recording.end_label();
    }
    if !how.title.is_empty() {
        recording.end_label();
    }
    if let Some(pool) = how.statistics {
        // SAFETY: the query was begun above, outside any rendering.
        unsafe { device.cmd_end_query(commands, pool, 0) };
    }
    full_barrier(device, commands);
    Ok(Lowered { commands })
}

/// Timestamps of a submission: one before its first stage, and one after each. An error where the pool has fewer.
fn timestamps(stages: usize, device: &str) -> Result<u32> {
    if stages >= MAX_TIMESTAMPS as usize {
        return Err(Error::TooLarge {
            what: "a frame".to_owned(),
            wanted: format!("{stages} stages"),
            limit: format!("{} stages a submission", MAX_TIMESTAMPS - 1),
            device: device.to_owned(),
            remedy: "use a method option that needs fewer".to_owned(),
        });
    }
    Ok(stages as u32 + 1)
}

/// See [`IndexedIndirect`]: a programming error, caught where it can be seen.
fn assert_counts_do_not_lapse(ops: &[Recorded]) {
    let mut counted = false;
    for recorded in ops {
        if let Op::Draw { draw, .. } | Op::Query { draw, .. } = &recorded.op {
            assert!(
                draw.count.is_some() || !counted,
                "{}: a draw without a count after one with a count",
                recorded.label
            );
            counted |= draw.count.is_some();
        }
    }
}

impl Recording<'_> {
    fn stamp(&self, how: &How<'_>, index: u32) {
        let (Some(timer), Some(pool)) = (how.timer, how.timestamps) else { return };
        let device = &self.vulkan.device;
        // SAFETY: `index` is within the pool: `lower` checked it.
        unsafe { device.cmd_write_timestamp2(self.commands, vk::PipelineStageFlags2::ALL_COMMANDS, pool, index) };
        if timer == TimerMode::Split {
            full_barrier(device, self.commands);
        }
    }

    fn label(&self, label: &str) {
        let (Some(labels), Ok(name)) = (&self.vulkan.names.0, std::ffi::CString::new(label)) else { return };
        // SAFETY: the name lives through the call; every label is ended by `end_label`.
        unsafe {
            labels.cmd_begin_debug_utils_label(self.commands, &vk::DebugUtilsLabelEXT::default().label_name(&name))
        };
    }

    fn end_label(&self) {
        if let Some(labels) = &self.vulkan.names.0 {
            // SAFETY: a label is open.
            unsafe { labels.cmd_end_debug_utils_label(self.commands) };
        }
    }

    fn barrier(&self, barrier: &Barrier) {
        let memory = [memory_barrier(barrier)];
        let info = vk::DependencyInfo::default().memory_barriers(&memory);
        // SAFETY: the command buffer is recording, outside a rendering.
        unsafe { self.vulkan.device.cmd_pipeline_barrier2(self.commands, &info) };
    }

    fn op(&self, op: &Op) -> Result<()> {
        let device = &self.vulkan.device;
        match op {
            Op::Dispatch { stage, groups } => {
                self.bind(stage, None)?;
                let [x, y] = *groups;
                // SAFETY: pipeline, descriptors and push constants are bound.
                unsafe { device.cmd_dispatch(self.commands, x, y, 1) };
            }
            Op::DispatchIndirect { stage, groups } => {
                self.bind(stage, None)?;
                // SAFETY: as above; the buffer holds three words.
                unsafe { device.cmd_dispatch_indirect(self.commands, vk::Buffer::from_raw(groups.raw), groups.offset) };
            }
            Op::Draw { stage, draw, target } => self.draw(stage, draw, target)?,
            Op::Query { stage, draw, queries, first_query, target } => {
                self.query(stage, draw, (*queries, *first_query), target)?;
            }
            Op::Shapes { stage, shapes, query, target } => self.shapes(stage, shapes, *query, target)?,
            Op::Clear { target } => self.rendering(target, vk::AttachmentLoadOp::CLEAR, || ()),
            Op::Fill { buffer, value } => {
                let (raw, offset, size) = range(buffer);
                // SAFETY: the range lies in the buffer; all our buffers have transfer usage and whole words.
                unsafe { device.cmd_fill_buffer(self.commands, raw, offset, size, *value) };
            }
            Op::Copy { from, to } => {
                let ((from, src_offset, size), (to, dst_offset, _)) = (range(from), range(to));
                let region = [vk::BufferCopy { src_offset, dst_offset, size }];
                // SAFETY: the destination is at least as long, by `Frame::copy`'s contract.
                unsafe { device.cmd_copy_buffer(self.commands, from, to, &region) };
            }
            Op::CopyImage { from, format, size, to } => self.copy_image(from.image, *format, *size, to),
            Op::FillImage { from, to, format, size } => self.fill_image(from, to.image, *format, *size),
            Op::ResolveColour { from, to, size } => self.resolve_colour(from.image, to.image, *size),
        }
        Ok(())
    }

    fn draw(&self, stage: &BoundStage, draw: &IndexedIndirect, target: &Target) -> Result<()> {
        let device = &self.vulkan.device;
        let (commands, commands_at, _) = range(&draw.commands);
        // SAFETY: inside a rendering with pipeline and buffers bound; commands and count are alive and in range.
        self.draw_with(stage, draw, target, || unsafe {
            match draw.count {
                Some(count) => device.cmd_draw_indexed_indirect_count(
                    self.commands,
                    commands,
                    commands_at,
                    vk::Buffer::from_raw(count.raw),
                    count.offset,
                    draw.max_draws,
                    COMMAND_BYTES,
                ),
                None => {
                    for (first, count) in pieces(draw.max_draws, self.vulkan.info.most_draws) {
                        let at = commands_at + u64::from(first) * u64::from(COMMAND_BYTES);
                        device.cmd_draw_indexed_indirect(self.commands, commands, at, count, COMMAND_BYTES);
                    }
                }
            }
        })
    }

    /// Runs `inside` in a rendering to the target, with the stage's pipeline and the draw's buffers bound.
    fn draw_with(
        &self,
        stage: &BoundStage,
        draw: &IndexedIndirect,
        target: &Target,
        inside: impl FnOnce(),
    ) -> Result<()> {
        self.bind(stage, Some(self.state((draw.primitives, draw.faces, draw.surface), target)))?;
        let device = &self.vulkan.device;
        let (vertices, vertices_at, _) = range(&draw.vertices);
        let (indices, indices_at, _) = range(&draw.indices);
        self.rendering(target, vk::AttachmentLoadOp::LOAD, || {
            // SAFETY: inside a rendering with the formats the pipeline was made for; buffers are alive and in range.
            unsafe {
                device.cmd_bind_vertex_buffers(self.commands, VERTEX_BINDING, &[vertices], &[vertices_at]);
                if stage.info.instance_stride > 0 {
                    let (instances, at, _) = range(&draw.instances);
                    device.cmd_bind_vertex_buffers(self.commands, INSTANCE_BINDING, &[instances], &[at]);
                }
                device.cmd_bind_index_buffer(self.commands, indices, indices_at, vk::IndexType::UINT32);
            }
            inside();
        });
        Ok(())
    }

    /// How a pipeline draws such things to the target.
    fn state(&self, (primitives, faces, surface): (Primitives, Faces, Surface), target: &Target) -> DrawState {
        DrawState {
            colour: target.colour.map(|(_, format)| format),
            item: target.item.is_some(),
            depth: self.vulkan.depth,
            depth_write: !target.depth_read_only && surface.hides(),
            strictly_nearer: target.strictly_nearer,
            primitives,
            faces,
            surface: if surface.hides() { Surface::Opaque } else { surface },
            samples: target.samples.map_or(1, |samples| samples.count),
        }
    }

    /// Runs `inside` between the begin and end of a rendering to the target.
    fn rendering(&self, target: &Target, load: vk::AttachmentLoadOp, inside: impl FnOnce()) {
        let [width, height] = target.size;
        let area = vk::Rect2D { offset: vk::Offset2D { x: 0, y: 0 }, extent: vk::Extent2D { width, height } };
        let attachment = |view: u64, clear: vk::ClearValue| {
            vk::RenderingAttachmentInfo::default()
                .image_view(vk::ImageView::from_raw(view))
                .image_layout(vk::ImageLayout::GENERAL)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let cleared = |format: Format| vk::ClearValue {
            color: match format {
                Format::Item => vk::ClearColorValue { uint32: [shaders::types::ITEM_NONE; 4] },
                // All bytes of nobody's index are full.
                Format::Owner => vk::ClearColorValue { float32: [1.0; 4] },
                _ => vk::ClearColorValue { float32: [0.0; 4] },
            },
        };
        let [far_depth, near_depth] = self.vulkan.depth.range();
        let far = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: far_depth, stencil: 0 } };
        let colours: Vec<_> =
            target.drawn_colours().map(|(image, format)| attachment(image.view, cleared(format))).collect();
        let mut depth = attachment(target.drawn_depth().view, far);
        if target.depth_read_only {
            depth = depth.store_op(vk::AttachmentStoreOp::NONE);
        }
        let info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colours)
            .depth_attachment(&depth);
        let device = &self.vulkan.device;
        let viewport = [vk::Viewport {
            x: 0.0,
            y: 0.0,
            width: width as f32,
            height: height as f32,
            min_depth: far_depth,
            max_depth: near_depth,
        }];
        // SAFETY: views are alive and in the general layout; begin and end pair up.
        unsafe {
            device.cmd_begin_rendering(self.commands, &info);
            device.cmd_set_viewport(self.commands, 0, &viewport);
            device.cmd_set_scissor(self.commands, 0, &[area]);
            inside();
            device.cmd_end_rendering(self.commands);
        }
    }

    fn bind(&self, stage: &BoundStage, draw: Option<DrawState>) -> Result<()> {
        let device = &self.vulkan.device;
        let point = if draw.is_some() { vk::PipelineBindPoint::GRAPHICS } else { vk::PipelineBindPoint::COMPUTE };
        let pipeline: Pipeline = self.vulkan.pipelines.get(device, stage, draw)?;
        // SAFETY: the pipeline is alive as long as the device.
        unsafe { device.cmd_bind_pipeline(self.commands, point, pipeline.raw) };
        self.vulkan.descriptors.bind(device, self.commands, stage, &pipeline, point)?;
        if stage.info.push_size > 0 {
            let bytes = &stage.push[..stage.info.push_size as usize];
            // SAFETY: the layout's range is `push_size` bytes for these stages.
            unsafe { device.cmd_push_constants(self.commands, pipeline.layout, pipeline.push_stages, 0, bytes) };
        }
        Ok(())
    }
}

fn range(bound: &Bound) -> (vk::Buffer, u64, u64) {
    match bound {
        Bound::Buffer { raw, offset, size, .. } => (vk::Buffer::from_raw(*raw), *offset, *size),
        Bound::Image(_) => (vk::Buffer::null(), 0, 0),
    }
}

/// A list in pieces that the device draws at once: where each begins, and how long it is.
fn pieces(draws: u32, most: u32) -> impl Iterator<Item = (u32, u32)> {
    (0..draws).step_by(most.max(1) as usize).map(move |first| (first, most.min(draws - first)))
}

/// Groups that every device can run in one dimension of a grid.
const MOST_GROUPS: u32 = 65_535;

/// A grid of at least `groups`, in two dimensions; shaders unfold it (`include/grid.glsl`).
pub fn folded(groups: u32) -> [u32; 2] {
    let rows = groups.div_ceil(MOST_GROUPS);
    [groups.div_ceil(rows.max(1)), rows]
}

/// The barrier as Vulkan takes it: from the stages that touched something, and the writes of those that wrote, to all that follows.
fn memory_barrier(barrier: &Barrier) -> vk::MemoryBarrier2<'static> {
    let mut stages = vk::PipelineStageFlags2::empty();
    let mut accesses = vk::AccessFlags2::empty();
    for point in Point::ALL.into_iter().filter(|point| barrier.after & point.bit() != 0) {
        let (stage, write) = source(point);
        stages |= stage;
        accesses |= if barrier.written & point.bit() != 0 { write } else { vk::AccessFlags2::empty() };
    }
    vk::MemoryBarrier2::default()
        .src_stage_mask(stages)
        .src_access_mask(accesses)
        .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
        .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
}

/// The Vulkan stages and write accesses of a point.
fn source(point: Point) -> (vk::PipelineStageFlags2, vk::AccessFlags2) {
    use vk::{AccessFlags2 as Access, PipelineStageFlags2 as Stage};
    match point {
        Point::Indirect => (Stage::DRAW_INDIRECT, Access::empty()),
        Point::Vertices => (Stage::VERTEX_INPUT, Access::empty()),
        Point::Drawing => (Stage::VERTEX_SHADER | Stage::FRAGMENT_SHADER, Access::SHADER_STORAGE_WRITE),
        Point::Depth => {
            (Stage::EARLY_FRAGMENT_TESTS | Stage::LATE_FRAGMENT_TESTS, Access::DEPTH_STENCIL_ATTACHMENT_WRITE)
        }
        Point::Colour => (Stage::COLOR_ATTACHMENT_OUTPUT, Access::COLOR_ATTACHMENT_WRITE),
        Point::Compute => (Stage::COMPUTE_SHADER, Access::SHADER_STORAGE_WRITE),
        Point::Transfer => (Stage::ALL_TRANSFER, Access::TRANSFER_WRITE),
    }
}

#[cfg(test)]
mod tests;
