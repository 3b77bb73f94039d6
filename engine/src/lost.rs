//! Which stage was running when the device was lost: the timestamps that did get written say how far it came.

use crate::gpu::Vulkan;
use crate::recorder::Recorded;
use crate::Error;
use ash::vk;

/// Turns a failed submission into an error; a lost device names the last stage that started.
pub(crate) fn submit_error(
    vulkan: &Vulkan,
    result: vk::Result,
    pool: Option<vk::QueryPool>,
    ops: &[Recorded],
) -> Error {
    match result {
        vk::Result::ERROR_DEVICE_LOST => Error::DeviceLost { stage: last_started(&written(vulkan, pool, ops), ops) },
        result => Error::Vulkan { call: "vkQueueSubmit2", result },
    }
}

/// Which of the submission's timestamps were written. Some drivers still say after the device is lost; none is an answer too.
fn written(vulkan: &Vulkan, pool: Option<vk::QueryPool>, ops: &[Recorded]) -> Vec<bool> {
    let Some(pool) = pool else { return Vec::new() };
    let mut ticks = vec![[0u64; 2]; ops.len() + 1];
    let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
    // SAFETY: the pool has this many timestamps. On a lost device the call may fail, but not misbehave; what it leaves
    // unwritten stays unavailable.
    let _ = unsafe { vulkan.device.get_query_pool_results(pool, 0, &mut ticks, flags) };
    ticks.iter().map(|[_, available]| *available != 0).collect()
}

/// Timestamp 0 is written before the first stage, timestamp i after stage i - 1. If none was written, all stages are named.
fn last_started(written: &[bool], ops: &[Recorded]) -> String {
    let finished = written.iter().take_while(|written| **written).count();
    match finished.checked_sub(1).and_then(|stage| ops.get(stage)) {
        Some(running) => running.label.clone(),
        None => ops.iter().map(|op| op.label.as_str()).collect::<Vec<_>>().join(", "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recorder::Op;
    use shaders::{Bound, ResourceId};

    fn stages() -> Vec<Recorded> {
        let buffer = Bound::Buffer { id: ResourceId(0), raw: 0, offset: 0, size: 4 };
        let one = |label: &str| Recorded { label: label.to_owned(), op: Op::Fill { buffer, value: 0 }, barrier: None };
        vec![one("first"), one("second"), one("third")]
    }

    #[test]
    fn the_stage_after_the_last_timestamp_was_running() {
        assert_eq!(last_started(&[true, false, false, false], &stages()), "first");
        assert_eq!(last_started(&[true, true, true, false], &stages()), "third");
    }

    #[test]
    fn without_timestamps_all_stages_are_named() {
        assert_eq!(last_started(&[false; 4], &stages()), "first, second, third");
        assert_eq!(last_started(&[true; 4], &stages()), "first, second, third");
    }
}
