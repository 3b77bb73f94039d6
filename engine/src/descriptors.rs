//! How stages get at their resources: descriptors pushed into the command buffer, or, on a device without
//! `VK_KHR_push_descriptor`, sets from a pool that is reset before each submission. Frames wait until they are done, so that no
//! set is in use then.

use crate::error::Named;
use crate::features::{Extra, Extras};
use crate::lock::lock;
use crate::names::Names;
use crate::pipeline::{descriptor_type, Pipeline};
use crate::recorder::{Op, Recorded};
use crate::Result;
use ash::vk;
use shaders::{BindingKind, Bound, BoundStage};
use std::sync::Mutex;
use vk::Handle;

/// What a device binds resources with.
pub(crate) enum Descriptors {
    Pushed(ash::khr::push_descriptor::Device),
    Pooled(Mutex<Pool>),
}

/// A pool and what it has room for.
#[derive(Default)]
pub(crate) struct Pool {
    raw: vk::DescriptorPool,
    room: Room,
}

/// Sets and their descriptors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Room {
    sets: u32,
    /// By kind of binding.
    descriptors: [u32; KINDS.len()],
}

const KINDS: [BindingKind; 4] =
    [BindingKind::StorageBuffer, BindingKind::SampledImage, BindingKind::GatheredImage, BindingKind::StorageImage];

impl Room {
    /// What some stages take, one set each.
    fn of<'a>(stages: impl Iterator<Item = &'a BoundStage>) -> Self {
        let mut room = Room::default();
        for stage in stages {
            room.sets += 1;
            for binding in stage.info.bindings {
                let kind = KINDS.iter().position(|kind| *kind == binding.kind);
                room.descriptors[kind.unwrap_or_default()] += 1;
            }
        }
        room
    }

    fn holds(&self, wanted: &Room) -> bool {
        self.sets >= wanted.sets && self.descriptors.iter().zip(&wanted.descriptors).all(|(has, wants)| has >= wants)
    }

    /// Room for twice as much, so that frames that grow step by step do not make a pool each.
    fn doubled(&self) -> Self {
        Room { sets: 2 * self.sets, descriptors: self.descriptors.map(|count| 2 * count) }
    }
}

impl Descriptors {
    pub(crate) fn new(instance: &ash::Instance, device: &ash::Device, extras: Extras) -> Self {
        if extras.has(Extra::PushDescriptor) {
            Descriptors::Pushed(ash::khr::push_descriptor::Device::new(instance, device))
        } else {
            Descriptors::Pooled(Mutex::default())
        }
    }

    /// Makes ready for a submission of these steps; those before it must be done.
    pub(crate) fn begin(&self, device: &ash::Device, names: &Names, ops: &[Recorded]) -> Result<()> {
        let Descriptors::Pooled(pool) = self else { return Ok(()) };
        let mut pool = lock(pool);
        let wanted = Room::of(ops.iter().filter_map(|recorded| stage_of(&recorded.op)));
        if pool.room.holds(&wanted) {
            if pool.raw.is_null() {
                return Ok(());
            }
            // SAFETY: no set is in use, as the submissions before this one were waited for.
            return unsafe { device.reset_descriptor_pool(pool.raw, Default::default()) }
                .named("vkResetDescriptorPool");
        }
        let made = Pool::new(device, names, wanted.doubled())?;
        // SAFETY: as above. Null is ignored.
        unsafe { device.destroy_descriptor_pool(pool.raw, None) };
        *pool = made;
        Ok(())
    }

    /// Binds a stage's resources.
    pub(crate) fn bind(
        &self,
        device: &ash::Device,
        commands: vk::CommandBuffer,
        stage: &BoundStage,
        pipeline: &Pipeline,
        point: vk::PipelineBindPoint,
    ) -> Result<()> {
        if stage.resources.is_empty() {
            return Ok(());
        }
        match self {
            // SAFETY: the writes fit the layout, as both come from one reflection, and live through the call.
            Descriptors::Pushed(push) => with_writes(stage, vk::DescriptorSet::null(), |writes| unsafe {
                push.cmd_push_descriptor_set(commands, point, pipeline.layout, 0, writes)
            }),
            Descriptors::Pooled(pool) => {
                let layouts = [pipeline.set];
                let info =
                    vk::DescriptorSetAllocateInfo::default().descriptor_pool(lock(pool).raw).set_layouts(&layouts);
                // SAFETY: `begin` made a pool with room for this submission's stages.
                let sets = unsafe { device.allocate_descriptor_sets(&info) }.named("vkAllocateDescriptorSets")?;
                // SAFETY: the set is new, and the writes fit its layout, as both come from one reflection.
                with_writes(stage, sets[0], |writes| unsafe { device.update_descriptor_sets(writes, &[]) });
                // SAFETY: the set lives until the next submission begins.
                unsafe { device.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &sets, &[]) };
            }
        }
        Ok(())
    }

    pub(crate) fn destroy(&self, device: &ash::Device) {
        if let Descriptors::Pooled(pool) = self {
            // SAFETY: the device is idle and about to go. Null is ignored.
            unsafe { device.destroy_descriptor_pool(lock(pool).raw, None) };
        }
    }
}

impl Pool {
    fn new(device: &ash::Device, names: &Names, room: Room) -> Result<Self> {
        let sizes: Vec<_> = KINDS
            .iter()
            .zip(room.descriptors)
            .filter(|(_, descriptor_count)| *descriptor_count > 0)
            .map(|(kind, descriptor_count)| vk::DescriptorPoolSize { ty: descriptor_type(*kind), descriptor_count })
            .collect();
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(room.sets).pool_sizes(&sizes);
        // SAFETY: the device is alive; the sizes live through the call.
        let raw = unsafe { device.create_descriptor_pool(&info, None) }.named("vkCreateDescriptorPool")?;
        names.give(raw, "descriptors");
        Ok(Pool { raw, room })
    }
}

/// The stage of a step that binds resources.
fn stage_of(op: &Op) -> Option<&BoundStage> {
    match op {
        Op::Dispatch { stage, .. }
        | Op::DispatchIndirect { stage, .. }
        | Op::Draw { stage, .. }
        | Op::Query { stage, .. }
        | Op::Shapes { stage, .. } => Some(stage).filter(|stage| !stage.resources.is_empty()),
        Op::Clear { .. }
        | Op::Fill { .. }
        | Op::Copy { .. }
        | Op::CopyImage { .. }
        | Op::FillImage { .. }
        | Op::ResolveColour { .. } => None,
    }
}

/// Passes on what writes a stage's resources to a set.
fn with_writes(stage: &BoundStage, set: vk::DescriptorSet, pass: impl FnOnce(&[vk::WriteDescriptorSet<'_>])) {
    let (mut buffers, mut images) = (Vec::new(), Vec::new());
    for bound in &stage.resources {
        let (buffer, image) = match bound {
            Bound::Buffer { raw, offset, size, .. } => (
                vk::DescriptorBufferInfo { buffer: vk::Buffer::from_raw(*raw), offset: *offset, range: *size },
                vk::DescriptorImageInfo::default(),
            ),
            Bound::Image(image) => (
                vk::DescriptorBufferInfo::default(),
                vk::DescriptorImageInfo::default()
                    .image_view(vk::ImageView::from_raw(image.view))
                    .image_layout(vk::ImageLayout::GENERAL),
            ),
        };
        buffers.push([buffer]);
        images.push([image]);
    }
    let write = |(index, binding): (usize, &shaders::BindingInfo)| {
        let write = vk::WriteDescriptorSet::default()
            .dst_set(set)
            .dst_binding(binding.binding)
            .descriptor_type(descriptor_type(binding.kind));
        match stage.resources[index] {
            Bound::Buffer { .. } => write.buffer_info(&buffers[index]),
            Bound::Image(_) => write.image_info(&images[index]),
        }
    };
    pass(&stage.info.bindings.iter().enumerate().map(write).collect::<Vec<_>>());
}
