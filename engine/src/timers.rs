//! How stages are timed, and the self-check that decides it.
//!
//! A timestamp says when the device got that far. A driver that batches work (lavapipe) gets that far before the work is
//! done, and charges it to whoever flushes it; there a full barrier after each timestamp splits the stages properly.

use crate::gpu::{lock, Gpu, Vulkan};
use crate::{error::Named, Buffer, Format, Image, IndexedIndirect, Placement, Primitives, Result, Target};
use ash::vk;
use std::fmt;
use std::sync::Mutex;

/// How stages are kept apart in time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimerMode {
    /// A timestamp after each stage; the device charges work to the stage that asked for it.
    Plain,
    /// A timestamp and then a full barrier after each stage.
    Split,
}

impl fmt::Display for TimerMode {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            TimerMode::Plain => "timestamps",
            TimerMode::Split => "timestamps with a full barrier after each",
        })
    }
}

/// Stages that one submission can time.
pub(crate) const MAX_TIMESTAMPS: u32 = 4096;

/// Query pools of one frame.
pub(crate) struct Queries {
    pub(crate) timestamps: vk::QueryPool,
    pub(crate) statistics: Option<vk::QueryPool>,
}

/// Query pools that wait for a frame.
#[derive(Default)]
pub(crate) struct QueryStore(Mutex<Vec<Queries>>);

impl QueryStore {
    pub(crate) fn take(&self, vulkan: &Vulkan) -> Result<Queries> {
        if let Some(queries) = lock(&self.0).pop() {
            return Ok(queries);
        }
        let timestamps =
            vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(MAX_TIMESTAMPS);
        let statistics = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::PIPELINE_STATISTICS)
            .query_count(1)
            .pipeline_statistics(
                vk::QueryPipelineStatisticFlags::INPUT_ASSEMBLY_PRIMITIVES
                    | vk::QueryPipelineStatisticFlags::FRAGMENT_SHADER_INVOCATIONS,
            );
        // SAFETY: the device is alive; statistics are asked for only where the feature is on.
        unsafe {
            Ok(Queries {
                timestamps: vulkan.device.create_query_pool(&timestamps, None).named("vkCreateQueryPool")?,
                statistics: if vulkan.statistics {
                    Some(vulkan.device.create_query_pool(&statistics, None).named("vkCreateQueryPool")?)
                } else {
                    None
                },
            })
        }
    }

    pub(crate) fn give_back(&self, queries: Queries) {
        lock(&self.0).push(queries);
    }

    pub(crate) fn destroy(&self, device: &ash::Device) {
        for queries in lock(&self.0).drain(..) {
            // SAFETY: the device is idle and about to go.
            unsafe {
                device.destroy_query_pool(queries.timestamps, None);
                if let Some(statistics) = queries.statistics {
                    device.destroy_query_pool(statistics, None);
                }
            }
        }
    }
}

/// Side of the picture that the self-check's heavy half fills, in pixels.
const CHECK_PX: u32 = 512;

/// Does the device charge work to the stage that asked for it? A heavy drawing and a light dispatch are timed together with
/// plain timestamps: if the light one gets more than a fifth of the time, they are not kept apart. (Drawing, because
/// lavapipe runs dispatches at once and puts drawings off.)
pub(crate) fn self_check(gpu: &Gpu) -> Result<TimerMode> {
    if gpu.info().is_some_and(|info| info.timestamp_ns == 0.0) {
        return Ok(TimerMode::Split);
    }
    let size = [CHECK_PX; 2];
    let colour = Image::new(gpu, "engine.timer_check.colour", Format::Colour, size)?;
    let depth = Image::new(gpu, "engine.timer_check.depth", Format::Depth, size)?;
    let target = Target {
        size,
        colour: Some((colour.view(), Format::Colour)),
        item: None,
        depth: depth.view(),
        depth_read_only: false,
    };
    let words = Buffer::<u32>::new(gpu, "engine.timer_check.words", 64, Placement::Storage)?;
    let corners = Buffer::with_data(gpu, "engine.timer_check.corners", &[0u32, 1, 2], Placement::Storage)?;
    let command = shaders::types::DrawCommand { index_count: 3, instance_count: 1, ..Default::default() };
    let commands = Buffer::with_data(gpu, "engine.timer_check.commands", &[command], Placement::Storage)?;
    let draw = IndexedIndirect {
        vertices: corners.all().into(),
        indices: corners.all().into(),
        commands: commands.all().into(),
        count: None,
        max_draws: 1,
        primitives: Primitives::Triangles,
    };
    let mut shares = Vec::new();
    for _ in 0..3 {
        let mut frame = gpu.frame();
        frame.timer_mode(TimerMode::Plain);
        frame.clear(&target);
        frame.draw(shaders::engine::SpinPixels {}, draw, &target);
        frame.dispatch(shaders::engine::SpinWords { words: words.all(), word_count: 64 }, 64);
        let report = frame.finish()?;
        let total: f64 = report.stages.iter().map(|stage| stage.ms).sum();
        shares.push(report.stages.last().map_or(1.0, |light| light.ms) / total.max(1e-9));
    }
    shares.sort_by(f64::total_cmp);
    tracing::debug!(?shares, "timer self-check: share of the light stage");
    Ok(if shares[1] < 0.2 { TimerMode::Plain } else { TimerMode::Split })
}
