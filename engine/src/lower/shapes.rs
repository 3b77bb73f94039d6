//! Drawings without buffers.

use super::Recording;
use crate::features::Extra;
use crate::recorder::{Faces, Primitives, QueriesRef, Shapes};
use crate::target::Target;
use crate::Result;
use ash::vk;
use shaders::BoundStage;
use vk::Handle;

impl Recording<'_> {
    pub(super) fn shapes(
        &self,
        stage: &BoundStage,
        shapes: &Shapes,
        query: Option<(QueriesRef, u32)>,
        target: &Target,
    ) -> Result<()> {
        let device = &self.vulkan.device;
        let query = query.map(|(queries, index)| (vk::QueryPool::from_raw(queries.raw), index));
        let precise = match self.vulkan.has(Extra::OcclusionQueryPrecise) {
            true => vk::QueryControlFlags::PRECISE,
            false => vk::QueryControlFlags::empty(),
        };
        if let Some((pool, index)) = query {
            // SAFETY: the query lies in the pool: `Frame::query_shapes` checked it. No rendering is open.
            unsafe { device.cmd_reset_query_pool(self.commands, pool, index, 1) };
        }
        self.bind(stage, Some(self.state((Primitives::Triangles, Faces::Both, shapes.surface), target)))?;
        self.rendering(target, vk::AttachmentLoadOp::LOAD, || {
            // SAFETY: inside a rendering with the formats the pipeline was made for, which reads no buffer of vertices; begin and end
            // pair up, and the query was reset.
            unsafe {
                if let Some((pool, index)) = query {
                    device.cmd_begin_query(self.commands, pool, index, precise);
                }
                device.cmd_draw(self.commands, shapes.corners, shapes.count, 0, 0);
                if let Some((pool, index)) = query {
                    device.cmd_end_query(self.commands, pool, index);
                }
            }
        });
        Ok(())
    }
}
