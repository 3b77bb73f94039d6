//! How stages are timed, and the self-check that decides it.
//!
//! A timestamp says when the device got that far. A driver that batches work (lavapipe) gets that far before the work is
//! done, and charges it to whoever flushes it; there a full barrier after each timestamp splits the stages properly.

use crate::features::Extra;
use crate::frame::{StageTime, Statistics};
use crate::gpu::{lock, Gpu, Vulkan};
use crate::recorder::Recorded;
use crate::{
    error::Named, Buffer, Faces, Format, Image, IndexedIndirect, Placement, Primitives, Result, Surface, Target,
};
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
    /// The device has no timestamps: frames are timed, stages are not.
    Off,
}

impl fmt::Display for TimerMode {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            TimerMode::Plain => "timestamps",
            TimerMode::Split => "timestamps with a full barrier after each",
            TimerMode::Off => "nothing: the device has no timestamps",
        })
    }
}

/// Stages that one submission can time.
pub(crate) const MAX_TIMESTAMPS: u32 = 4096;

/// Query pools of one frame.
pub(crate) struct Queries {
    pub(crate) timestamps: Option<vk::QueryPool>,
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
        let made = |info: &vk::QueryPoolCreateInfo<'_>, extra| {
            // SAFETY: the device is alive, and has what the pool is for.
            let make = || unsafe { vulkan.device.create_query_pool(info, None) }.named("vkCreateQueryPool");
            vulkan.has(extra).then(make).transpose()
        };
        Ok(Queries {
            timestamps: made(&timestamps, Extra::Timestamps)?,
            statistics: made(&statistics, Extra::PipelineStatistics)?,
        })
    }

    pub(crate) fn give_back(&self, queries: Queries) {
        lock(&self.0).push(queries);
    }

    pub(crate) fn destroy(&self, device: &ash::Device) {
        for queries in lock(&self.0).drain(..) {
            for pool in [queries.timestamps, queries.statistics].into_iter().flatten() {
                // SAFETY: the device is idle and about to go.
                unsafe { device.destroy_query_pool(pool, None) };
            }
        }
    }
}

/// Reads the timestamps of a finished submission.
pub(crate) fn stage_times(vulkan: &Vulkan, pool: vk::QueryPool, ops: &[Recorded]) -> Result<Vec<StageTime>> {
    let mut ticks = vec![0u64; ops.len() + 1];
    // SAFETY: the submission is done, and wrote this many timestamps.
    unsafe { vulkan.device.get_query_pool_results(pool, 0, &mut ticks, vk::QueryResultFlags::TYPE_64) }
        .named("vkGetQueryPoolResults")?;
    let ms = f64::from(vulkan.info.timestamp_ns) * 1e-6;
    let time = |(recorded, pair): (&Recorded, &[u64])| StageTime {
        label: recorded.label.clone(),
        ms: ticks_between(pair[0], pair[1], vulkan.info.timestamp_bits) as f64 * ms,
    };
    Ok(ops.iter().zip(ticks.windows(2)).map(time).collect())
}

/// Ticks from one timestamp to a later one. Those of fewer than 64 bits start again at 0: 36 bits of 83 ns after 95 minutes.
/// A device that steps back a little (clocks of several cores) took no time.
fn ticks_between(from: u64, to: u64, bits: u32) -> u64 {
    let shift = 64 - bits.clamp(1, 64);
    let ticks = (to << shift).wrapping_sub(from << shift);
    if ticks > u64::MAX / 2 {
        0
    } else {
        ticks >> shift
    }
}

/// Reads the pipeline statistics of a finished submission.
pub(crate) fn statistics(vulkan: &Vulkan, pool: vk::QueryPool) -> Result<Statistics> {
    let mut counted = [[0u64; 2]];
    // SAFETY: the submission is done and the query was begun and ended in it.
    unsafe { vulkan.device.get_query_pool_results(pool, 0, &mut counted, vk::QueryResultFlags::TYPE_64) }
        .named("vkGetQueryPoolResults")?;
    Ok(Statistics { primitives: counted[0][0], fragments: counted[0][1] })
}

/// Side of the picture that the self-check's heavy half fills, in pixels.
const CHECK_PX: u32 = 512;

/// Words that its heavy dispatch fills.
const CHECK_WORDS: u32 = 1 << 20;

/// Does the device charge work to the stage that asked for it? Light stages are timed with plain timestamps, alone and beside
/// heavy ones: a light dispatch after a heavy drawing, and a light clear before a heavy dispatch. If either then takes three
/// times as long and a fifth of the whole, stages are not kept apart. (lavapipe puts drawings off and runs dispatches at once,
/// so that a clear is charged with the dispatch behind it.)
pub(crate) fn self_check(gpu: &Gpu) -> Result<TimerMode> {
    let check = Check::new(gpu)?;
    let (mut drawn_on, mut dispatched_on) = (Vec::new(), Vec::new());
    for _ in 0..3 {
        let alone = check.run(gpu, false, 1)?;
        let after_drawing = check.run(gpu, true, 1)?;
        let before_dispatch = check.run(gpu, false, CHECK_WORDS)?;
        let last = |times: &[f64]| times.last().copied().unwrap_or(0.0);
        drawn_on.push(overcharge(last(&alone), last(&after_drawing), after_drawing.iter().sum()));
        dispatched_on.push(overcharge(alone[0], before_dispatch[0], before_dispatch.iter().sum()));
    }
    tracing::debug!(?drawn_on, ?dispatched_on, "timer self-check: what light stages were charged with");
    let often = |charged: &[bool]| charged.iter().filter(|charged| **charged).count() >= 2;
    Ok(if often(&drawn_on) || often(&dispatched_on) { TimerMode::Split } else { TimerMode::Plain })
}

/// True if a light stage was charged with the work of its heavy neighbour.
fn overcharge(alone_ms: f64, beside_ms: f64, total_ms: f64) -> bool {
    beside_ms > 3.0 * alone_ms && beside_ms > 0.2 * total_ms
}

/// What the self-check runs on.
struct Check {
    _images: [Image; 2],
    target: Target,
    words: Buffer<u32>,
    corners: Buffer<u32>,
    commands: Buffer<shaders::types::DrawCommand>,
}

impl Check {
    fn new(gpu: &Gpu) -> Result<Self> {
        let size = [CHECK_PX; 2];
        let colour = Image::new(gpu, "engine.timer_check.colour", Format::Colour, size)?;
        let depth = Image::new(gpu, "engine.timer_check.depth", Format::Depth, size)?;
        let command = shaders::types::DrawCommand { index_count: 3, instance_count: 1, ..Default::default() };
        Ok(Check {
            target: Target {
                size,
                colour: Some((colour.view(), Format::Colour)),
                item: None,
                depth: depth.view(),
                depth_read_only: false,
                strictly_nearer: false,
            },
            _images: [colour, depth],
            words: Buffer::new(gpu, "engine.timer_check.words", CHECK_WORDS as usize, Placement::Storage)?,
            corners: Buffer::with_data(gpu, "engine.timer_check.corners", &[0, 1, 2], Placement::Storage)?,
            commands: Buffer::with_data(gpu, "engine.timer_check.commands", &[command], Placement::Storage)?,
        })
    }

    /// Clears, draws a heavy triangle if told to, and dispatches over so many words: the time of each, in milliseconds.
    fn run(&self, gpu: &Gpu, draws: bool, words: u32) -> Result<Vec<f64>> {
        let mut frame = gpu.frame();
        frame.timer_mode(TimerMode::Plain);
        frame.clear(&self.target);
        if draws {
            let draw = IndexedIndirect {
                vertices: self.corners.all().into(),
                instances: self.corners.all().into(),
                indices: self.corners.all().into(),
                commands: self.commands.all().into(),
                count: None,
                max_draws: 1,
                primitives: Primitives::Triangles,
                faces: Faces::Both,
                surface: Surface::Opaque,
            };
            frame.draw(shaders::engine::SpinPixels {}, draw, &self.target);
        }
        frame.dispatch(shaders::engine::SpinWords { words: self.words.all(), word_count: words }, words);
        Ok(frame.finish()?.stages.iter().map(|stage| stage.ms).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::{overcharge, ticks_between};

    #[test]
    fn timestamps_that_start_again_at_zero_still_tell_the_time() {
        assert_eq!(ticks_between(5, 12, 64), 7);
        assert_eq!(ticks_between((1 << 36) - 3, 4, 36), 7);
        assert_eq!(ticks_between(u64::MAX - 2, 4, 64), 7);
        assert_eq!(ticks_between(12, 5, 64), 0, "a step back");
        assert_eq!(ticks_between(12, 5, 36), 0, "a step back");
        // Bits beyond the valid ones mean nothing.
        assert_eq!(ticks_between(0xff << 36 | 5, 12, 36), 7);
    }

    #[test]
    fn a_light_stage_that_pays_for_its_neighbour_is_noticed() {
        assert!(overcharge(0.1, 1.7, 2.0));
        assert!(!overcharge(0.1, 0.12, 2.0), "as light as alone");
        assert!(!overcharge(0.001, 0.01, 2.0), "noise beside a heavy stage");
    }
}
