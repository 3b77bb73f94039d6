//! Occlusion queries: how many fragments of a drawing pass the depth test, counted by the device and read on the host.

use super::Frame;
use crate::error::Named;
use crate::features::Extra;
use crate::gpu::Gpu;
use crate::recorder::{IndexedIndirect, Op, QueriesRef};
use crate::retired::Retired;
use crate::target::Target;
use crate::Result;
use ash::vk;
use shaders::GraphicsStage;
use std::fmt;
use std::ops::Range;
use vk::Handle;

/// A pool of occlusion queries. Those of a submission are reset by it: a result must be read before its query is used again.
pub struct OcclusionQueries {
    gpu: Gpu,
    raw: vk::QueryPool,
    len: u32,
}

impl fmt::Debug for OcclusionQueries {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{} occlusion queries", self.len)
    }
}

impl Drop for OcclusionQueries {
    fn drop(&mut self) {
        if let Some(vulkan) = &self.gpu.0.vulkan {
            vulkan.retired.push(Retired { queries: self.raw, ..Retired::default() });
            vulkan.bury();
        }
    }
}

impl OcclusionQueries {
    /// A pool of `len` queries.
    pub fn new(gpu: &Gpu, name: &str, len: u32) -> Result<Self> {
        let raw = match &gpu.0.vulkan {
            None => vk::QueryPool::null(),
            Some(vulkan) => {
                let info =
                    vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::OCCLUSION).query_count(len.max(1));
                // SAFETY: the device is alive; every Vulkan device has occlusion queries.
                let raw = unsafe { vulkan.device.create_query_pool(&info, None) }.named("vkCreateQueryPool")?;
                vulkan.name(raw, name);
                raw
            }
        };
        Ok(OcclusionQueries { gpu: gpu.clone(), raw, len })
    }

    /// Queries in the pool.
    pub fn len(&self) -> u32 {
        self.len
    }

    pub(super) fn raw(&self) -> u64 {
        self.raw.as_raw()
    }

    /// True if there are none.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// True if results are numbers of samples. A device without `occlusionQueryPrecise` says only whether there were any: 0, or
    /// something else.
    pub fn counts_samples(&self) -> bool {
        self.gpu.has(Extra::OcclusionQueryPrecise)
    }

    /// Reads results of a submission that is done: those of the last frame, or, in the middle of one, what
    /// [`Frame::wait_for_queries`] has waited for.
    pub fn read(&self, queries: Range<u32>) -> Result<Vec<u64>> {
        assert!(queries.end <= self.len, "query {} of {}", queries.end, self.len);
        let mut samples = vec![0u64; queries.len()];
        if samples.is_empty() {
            return Ok(samples);
        }
        let vulkan = self.gpu.vulkan()?;
        // SAFETY: the range lies in the pool. Nothing is waited for: were a query not done, the call would say so.
        unsafe {
            vulkan.device.get_query_pool_results(self.raw, queries.start, &mut samples, vk::QueryResultFlags::TYPE_64)
        }
        .named("vkGetQueryPoolResults")?;
        Ok(samples)
    }
}

/// Where the results of a drawing's queries go: one query for each of its commands.
#[derive(Clone, Copy, Debug)]
pub struct Queried<'a> {
    /// The pool.
    pub queries: &'a OcclusionQueries,
    /// The query of the first command.
    pub first: u32,
}

impl Frame {
    /// Draws objects as [`Frame::draw`] does, each command counted by a query of its own.
    pub fn query_objects<S: GraphicsStage>(&mut self, stage: S, draw: IndexedIndirect, queried: Queried, to: &Target) {
        if draw.max_draws > 0 {
            self.report.draws.push(draw);
        }
        self.query_boxes(stage, draw, queried, to);
    }

    /// Draws what shows no object, each command counted by a query of its own.
    ///
    /// # Panics
    /// If the draw has a count on the GPU, or the pool has no room: which query is whose is known on the host.
    pub fn query_boxes<S: GraphicsStage>(&mut self, stage: S, draw: IndexedIndirect, queried: Queried, to: &Target) {
        if draw.max_draws == 0 {
            self.skip(S::INFO.name, "nothing to ask");
            return;
        }
        let Queried { queries, first } = queried;
        assert!(draw.count.is_none(), "{}: a queried draw has no count", S::INFO.name);
        assert!(first + draw.max_draws <= queries.len(), "{}: more draws than queries", S::INFO.name);
        let named = QueriesRef { raw: queries.raw() };
        let op = Op::Query { stage: stage.bind(), draw, queries: named, first_query: first, target: *to };
        self.recorder.push(S::INFO.name, op);
    }

    /// Runs what was recorded, waits, and reads queries of it. What that takes beyond the stages themselves is a row of its own,
    /// `frame/wait_for_queries`, so that the stall shows.
    pub fn wait_for_queries(&mut self, queries: &OcclusionQueries, range: Range<u32>) -> Result<Vec<u64>> {
        self.stalled("frame/wait_for_queries", |_| queries.read(range))
    }
}
