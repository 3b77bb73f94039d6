//! Drawings whose commands are counted by occlusion queries.

use super::{range, Recording};
use crate::features::Extra;
use crate::recorder::{IndexedIndirect, QueriesRef};
use crate::target::Target;
use crate::Result;
use ash::vk;
use shaders::BoundStage;
use vk::Handle;

impl Recording<'_> {
    pub(super) fn query(
        &self,
        stage: &BoundStage,
        draw: &IndexedIndirect,
        (queries, first): (QueriesRef, u32),
        target: &Target,
    ) -> Result<()> {
        let device = &self.vulkan.device;
        let pool = vk::QueryPool::from_raw(queries.raw);
        // SAFETY: the range lies in the pool: `Frame::query_boxes` checked it. No rendering is open, and a query that is reset
        // here is not used by what came before in this submission: pools are numbered on between waits.
        unsafe { device.cmd_reset_query_pool(self.commands, pool, first, draw.max_draws) };
        let precise = match self.vulkan.has(Extra::OcclusionQueryPrecise) {
            true => vk::QueryControlFlags::PRECISE,
            false => vk::QueryControlFlags::empty(),
        };
        let (commands, commands_at, _) = range(&draw.commands);
        self.draw_with(stage, draw, target, || {
            for index in 0..draw.max_draws {
                let at = commands_at + u64::from(index * super::COMMAND_BYTES);
                // SAFETY: inside a rendering with pipeline and buffers bound; begin and end pair up, and the query was reset.
                unsafe {
                    device.cmd_begin_query(self.commands, pool, first + index, precise);
                    device.cmd_draw_indexed_indirect(self.commands, commands, at, 1, super::COMMAND_BYTES);
                    device.cmd_end_query(self.commands, pool, first + index);
                }
            }
        })
    }
}
