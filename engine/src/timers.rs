//! How stages are timed.
//!
//! A timestamp says when the device got that far. A driver that batches work (lavapipe) gets that far before the work is
//! done, and charges it to whoever flushes it; there a full barrier after each timestamp splits the stages properly.
//!
//! The kind of device decides, not a measurement: results say how stages were timed, and two runs of one command must say the same.

use crate::error::Named;
use crate::features::{Extra, Extras};
use crate::lock::lock;
use crate::names::Names;
use crate::recorder::Recorded;
use crate::{DeviceKind, Result};
use ash::vk;
use std::fmt;
use std::sync::Mutex;
use std::time::Duration;

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

impl TimerMode {
    /// The timer mode of a kind of device where the user chooses none. A CPU driver batches work; a GPU works off its commands in
    /// order.
    pub fn of(kind: DeviceKind) -> Self {
        match kind {
            DeviceKind::Cpu => TimerMode::Split,
            DeviceKind::Discrete | DeviceKind::Integrated | DeviceKind::Virtual => TimerMode::Plain,
        }
    }
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

/// What a stage cost.
#[derive(Clone, Debug, PartialEq)]
pub struct StageTime {
    /// Stage name, with the part of the frame behind a colon.
    pub label: String,
    /// Milliseconds on the device.
    pub ms: f64,
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
    pub(crate) fn take(&self, device: &ash::Device, extras: Extras, names: &Names) -> Result<Queries> {
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
        let made = |info: &vk::QueryPoolCreateInfo<'_>, extra: Extra| {
            // SAFETY: the device is alive, and has what the pool is for.
            let make = || unsafe { device.create_query_pool(info, None) }.named("vkCreateQueryPool");
            let pool = extras.has(extra).then(make).transpose()?;
            pool.into_iter().for_each(|pool| names.give(pool, extra.name()));
            Ok(pool)
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

/// Reads the timestamps of a finished submission: one before its first stage, and one after each of its stages.
pub(crate) fn read_ticks(device: &ash::Device, pool: vk::QueryPool, stages: usize) -> Result<Vec<u64>> {
    let mut ticks = vec![0u64; stages + 1];
    // SAFETY: the submission is done, and wrote this many timestamps.
    unsafe { device.get_query_pool_results(pool, 0, &mut ticks, vk::QueryResultFlags::TYPE_64) }
        .named("vkGetQueryPoolResults")?;
    Ok(ticks)
}

/// Returns the time of each stage. `ticks` holds one timestamp before the first stage and one after each stage, of `tick_ns` nanoseconds a
/// tick and `bits` valid bits.
pub(crate) fn stage_times(ops: &[Recorded], ticks: &[u64], tick_ns: f32, bits: u32) -> Vec<StageTime> {
    let tick_ms = f64::from(tick_ns) * 1e-6;
    let time = |(recorded, pair): (&Recorded, &[u64])| StageTime {
        label: recorded.label.clone(),
        ms: ticks_between(pair[0], pair[1], bits) as f64 * tick_ms,
    };
    ops.iter().zip(ticks.windows(2)).map(time).collect()
}

/// Returns the row of a wait: the milliseconds that it took beyond the stages that ran meanwhile.
pub(crate) fn stall(label: String, waited: Duration, stages: &[StageTime]) -> StageTime {
    let busy: f64 = stages.iter().map(|stage| stage.ms).sum();
    StageTime { label, ms: (waited.as_secs_f64() * 1e3 - busy).max(0.0) }
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

/// Reads the pipeline statistics of a finished submission: primitives, and fragments shaded.
pub(crate) fn statistics(device: &ash::Device, pool: vk::QueryPool) -> Result<[u64; 2]> {
    let mut counted = [[0u64; 2]];
    // SAFETY: the submission is done and the query was begun and ended in it.
    unsafe { device.get_query_pool_results(pool, 0, &mut counted, vk::QueryResultFlags::TYPE_64) }
        .named("vkGetQueryPoolResults")?;
    Ok(counted[0])
}

#[cfg(test)]
mod tests;
