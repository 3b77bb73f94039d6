//! One frame: recorded stage by stage, run, timed.

use crate::features::Extra;
use crate::gpu::{Gpu, Vulkan};
use crate::lost;
use crate::lower::{self, Lowered};
use crate::recorder::{apart, IndexedIndirect, Op, Recorded, Recorder};
use crate::target::Target;
use crate::timers::{self, Queries, StageTime, TimerMode};
use crate::{Buffer, Error, Result};
use bytemuck::Pod;
use shaders::{engine, Bound, BufferRef, ComputeStage, GraphicsStage};
use std::marker::PhantomData;
use std::sync::atomic::Ordering;
use std::time::Instant;

mod kept;
mod occlusion;
mod shapes;

pub use occlusion::{OcclusionQueries, Queried};

/// A stage that was not recorded, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skip {
    /// Stage name, with the part of the frame behind a colon.
    pub label: String,
    /// Why it could not change the result.
    pub reason: &'static str,
}

/// What the device counted over a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Primitives that entered the pipelines.
    pub primitives: u64,
    /// Fragments shaded, which are those that passed the early tests.
    pub fragments: u64,
}

/// What a frame did and cost.
#[derive(Clone, Debug, Default)]
pub struct FrameReport {
    /// Stages in order of recording.
    pub stages: Vec<StageTime>,
    /// Stages that were not needed.
    pub skips: Vec<Skip>,
    /// From the first submission until the device was idle, in milliseconds.
    pub frame_ms: f64,
    /// What the host spent on recording, waits excluded, in milliseconds.
    pub host_ms: f64,
    /// What the device counted, if it was asked to and can.
    pub statistics: Option<Statistics>,
    /// What was drawn, in order.
    pub draws: Vec<IndexedIndirect>,
    /// Submissions.
    pub submissions: u32,
    /// Uploads that the device was waited for while the frame was recorded: submissions of their own, which none of the times count. What a
    /// method writes each frame belongs in [`crate::Placement::Upload`], so that there are none once it has run for a few frames.
    pub uploads: u64,
}

/// A frame being recorded. Dropping it unfinished runs nothing more.
pub struct Frame {
    gpu: Gpu,
    recorder: Recorder,
    title: String,
    report: FrameReport,
    queries: Option<Queries>,
    count_statistics: bool,
    timer: Option<TimerMode>,
    first_submit: Option<Instant>,
    host_since: Instant,
    /// What the host did for the frame before the device got any of it, milliseconds.
    before_submit_ms: f64,
    /// Uploads of the device before this frame.
    uploads_before: u64,
}

impl Frame {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        if let Some(vulkan) = &gpu.0.vulkan {
            vulkan.bury();
            vulkan.frames_alive.fetch_add(1, Ordering::AcqRel);
        }
        let mut recorder = Recorder::default();
        recorder.standard_depth(gpu.depth().is_standard());
        Frame {
            gpu: gpu.clone(),
            recorder,
            title: String::new(),
            report: FrameReport::default(),
            queries: None,
            count_statistics: false,
            timer: Some(gpu.timer_mode()).filter(|mode| *mode != TimerMode::Off),
            first_submit: None,
            host_since: Instant::now(),
            before_submit_ms: 0.0,
            uploads_before: gpu.uploads(),
        }
    }

    /// Asks the device to count primitives and fragments, where it can. Not for timed frames.
    pub fn count_statistics(&mut self) {
        self.count_statistics = true;
    }

    pub(crate) fn timer_mode(&mut self, mode: TimerMode) {
        self.timer = Some(mode);
    }

    /// Measures the frame alone: no timestamp, and no barrier for its sake, stands between stages. The report then has no stages.
    pub fn without_stage_times(&mut self) {
        self.timer = None;
    }

    /// Says what the frame is of, such as the method that draws it: a label around its stages in captures.
    pub fn title(&mut self, title: &str) {
        self.title = title.to_owned();
    }

    /// Names the part of the frame that the following stages belong to ("early", "late"); "" for none.
    pub fn part(&mut self, part: &'static str) {
        self.recorder.part(part);
    }

    /// Runs a compute stage over at least `invocations` invocations in x.
    pub fn dispatch<S: ComputeStage>(&mut self, stage: S, invocations: u32) {
        self.dispatch_groups(stage, invocations.div_ceil(S::INFO.local_size[0].max(1)));
    }

    /// Runs a compute stage over `groups` work groups.
    pub fn dispatch_groups<S: ComputeStage>(&mut self, stage: S, groups: u32) {
        if groups == 0 {
            self.skip(S::INFO.name, "nothing to do");
            return;
        }
        self.recorder.push(S::INFO.name, Op::Dispatch { stage: stage.bind(), groups: lower::folded(groups) });
    }

    /// Runs a compute stage over at least `size` invocations in x and y: a picture's texels. No larger than a picture may be,
    /// which the grid of every device covers.
    pub fn dispatch_over<S: ComputeStage>(&mut self, stage: S, size: [u32; 2]) {
        let groups = [0, 1].map(|axis| size[axis].div_ceil(S::INFO.local_size[axis].max(1)));
        if groups.contains(&0) {
            self.skip(S::INFO.name, "nothing to do");
            return;
        }
        self.recorder.push(S::INFO.name, Op::Dispatch { stage: stage.bind(), groups });
    }

    /// Runs a compute stage over the grid in `groups` (three words on the GPU).
    pub fn dispatch_indirect<S: ComputeStage>(&mut self, stage: S, groups: BufferRef<u32>) {
        self.recorder.push(S::INFO.name, Op::DispatchIndirect { stage: stage.bind(), groups });
    }

    /// Draws to the target, with depth test.
    pub fn draw<S: GraphicsStage>(&mut self, stage: S, draw: IndexedIndirect, target: &Target) {
        if draw.max_draws == 0 {
            self.skip(S::INFO.name, "no objects");
            return;
        }
        self.report.draws.push(draw);
        self.record_draw(stage, draw, target);
    }

    /// A device that cannot read the number of commands draws all there is room for: those behind the number get no instance
    /// first (Kim 2015, IV.3).
    fn record_draw<S: GraphicsStage>(&mut self, stage: S, mut draw: IndexedIndirect, target: &Target) {
        if !self.gpu.has(Extra::DrawIndirectCount) {
            if let Some(count) = draw.count.take() {
                self.clear_tail(count, &draw);
            }
        }
        let stage = stage.bind();
        for draw in apart(&stage, draw, self.gpu.has(Extra::MultiDrawIndirect)) {
            self.recorder.push(S::INFO.name, Op::Draw { stage: stage.clone(), draw, target: *target });
        }
    }

    fn clear_tail(&mut self, count: BufferRef<u32>, draw: &IndexedIndirect) {
        let Bound::Buffer { id, raw, offset, size } = draw.commands else { return };
        // Bound from their beginnings: a range need not begin where a stage may bind one.
        let commands = BufferRef { id, raw, offset: 0, size: offset + size, element: PhantomData };
        let stage = engine::ClearTail {
            count: BufferRef { offset: 0, size: count.offset + count.size, ..count },
            commands,
            count_word: (count.offset / 4) as u32,
            first_word: (offset / 4) as u32,
            command_count: draw.max_draws,
        };
        self.dispatch(stage, draw.max_draws);
    }

    /// Draws objects without showing them: their depth ahead of the draws that do. Not among the report's draws.
    pub fn draw_unshown<S: GraphicsStage>(&mut self, stage: S, draw: IndexedIndirect, target: &Target) {
        self.record_draw(stage, draw, target);
    }

    /// Draws what shows no object: boxes that are tested. Not among the report's draws.
    pub fn test_boxes<S: GraphicsStage>(&mut self, stage: S, draw: IndexedIndirect, target: &Target) {
        self.record_draw(stage, draw, target);
    }

    /// Clears the target: colour to black, items to none, depth to far.
    pub fn clear(&mut self, target: &Target) {
        self.recorder.push("target/clear", Op::Clear { target: *target });
    }

    /// Sets every word of a buffer.
    pub fn fill<T: Pod>(&mut self, label: &str, buffer: impl Into<BufferRef<T>>, value: u32) {
        let buffer: BufferRef<T> = buffer.into();
        self.recorder.push(label, Op::Fill { buffer: buffer.into(), value });
    }

    /// Copies a buffer to another one at least as long.
    pub fn copy<T: Pod>(&mut self, label: &str, from: BufferRef<T>, to: BufferRef<T>) {
        self.recorder.push(label, Op::Copy { from: from.into(), to: to.into() });
    }

    /// Notes that a stage was not needed.
    pub fn skip(&mut self, stage: &str, reason: &'static str) {
        let label = self.recorder.label(stage);
        self.report.skips.push(Skip { label, reason });
    }

    /// The frame recorded so far, as text: stages, what they touch, and the barriers between them.
    pub fn text(&self) -> String {
        self.recorder.text(|id| self.gpu.resource_name(id))
    }

    /// The steps recorded since the last submission, with the barriers derived between them.
    pub fn recorded(&self) -> &[Recorded] {
        &self.recorder.ops
    }

    /// Runs what was recorded and waits for it. For methods that need the host in the middle of a frame; the wait is in
    /// the frame's time.
    pub fn submit_and_wait(&mut self) -> Result<()> {
        let gpu = self.gpu.clone();
        let vulkan = gpu.vulkan()?;
        let ops = self.recorder.take();
        if ops.is_empty() {
            return Ok(());
        }
        let queries = match self.queries.take() {
            Some(queries) => queries,
            None => vulkan.queries.take(&vulkan.device, vulkan.info.extras, &vulkan.names)?,
        };
        let result = self.run(vulkan, &queries, &ops);
        self.queries = Some(queries);
        result
    }

    fn run(&mut self, vulkan: &Vulkan, queries: &Queries, ops: &[Recorded]) -> Result<()> {
        let how = lower::How {
            title: &self.title,
            timer: self.timer,
            statistics: if self.count_statistics { queries.statistics } else { None },
            timestamps: queries.timestamps,
            barrier_every_stage: self.gpu.0.barrier_every_stage,
        };
        let lowered: Lowered = lower::lower(vulkan, ops, &how)?;
        self.report.host_ms += self.host_since.elapsed().as_secs_f64() * 1e3;
        let started = *self.first_submit.get_or_insert_with(Instant::now);
        let done = vulkan.run(lowered.commands);
        self.report.frame_ms = self.before_submit_ms + started.elapsed().as_secs_f64() * 1e3;
        self.host_since = Instant::now();
        self.report.submissions += 1;
        done.map_err(|result| lost::submit_error(vulkan, result, queries.timestamps, ops))?;
        if let (Some(_), Some(pool)) = (self.timer, queries.timestamps) {
            let ticks = timers::read_ticks(&vulkan.device, pool, ops.len())?;
            let info = &vulkan.info;
            self.report.stages.extend(timers::stage_times(ops, &ticks, info.timestamp_ns, info.timestamp_bits));
        }
        if let Some(pool) = how.statistics {
            let [primitives, fragments] = timers::statistics(&vulkan.device, pool)?;
            let sum = self.report.statistics.get_or_insert_default();
            sum.primitives += primitives;
            sum.fragments += fragments;
        }
        Ok(())
    }

    /// Runs what was recorded, waits, and reads a buffer: a read-back in the middle of a frame. What that takes beyond the
    /// stages themselves is a row of its own, `frame/read_back`, so that the stall shows.
    pub fn read<T: Pod>(&mut self, buffer: &Buffer<T>) -> Result<Vec<T>> {
        self.stalled("frame/read_back", |_| buffer.read())
    }

    /// Does on the host what a stage would do on the device: a row of its own, whose name starts with `frame/` as it is in no capture, and
    /// part of the frame's time instead of the host's for recording, as the device has nothing to do meanwhile.
    pub fn on_host<T>(&mut self, label: &str, work: impl FnOnce() -> T) -> T {
        let since = Instant::now();
        let done = work();
        let took = since.elapsed();
        self.host_since += took;
        let ms = took.as_secs_f64() * 1e3;
        if self.first_submit.is_none() {
            self.before_submit_ms += ms;
        }
        if self.timer.is_some() {
            self.report.stages.push(StageTime { label: self.recorder.label(label), ms });
        }
        done
    }

    /// Waits for what was recorded and reads something of it; a stall, with a row of its own beside the stages' times.
    fn stalled<T>(&mut self, label: &str, read: impl FnOnce(&mut Self) -> Result<T>) -> Result<T> {
        let (first, since) = (self.report.stages.len(), Instant::now());
        self.submit_and_wait()?;
        let data = read(self)?;
        self.host_since = Instant::now();
        if self.timer.is_none() {
            return Ok(data);
        }
        let stall = timers::stall(self.recorder.label(label), since.elapsed(), &self.report.stages[first..]);
        self.report.stages.push(stall);
        Ok(data)
    }

    /// Runs what is left and reports what the frame did: samples' colours become pixels'. A message of the validation layer is an error.
    pub fn finish(mut self) -> Result<FrameReport> {
        self.recorder.resolve_colours();
        self.finish_unresolved()
    }

    /// The same, leaving the pixels' colours as they were: of a frame whose samples are read themselves.
    pub fn finish_unresolved(mut self) -> Result<FrameReport> {
        self.submit_and_wait()?;
        self.report.uploads = self.gpu.uploads() - self.uploads_before;
        if self.gpu.vulkan()?.instance.validating {
            if let Some(message) = self.gpu.take_messages().into_iter().next() {
                return Err(Error::Validation { stage: message.stage, text: message.text });
            }
        }
        Ok(std::mem::take(&mut self.report))
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        if let Some(vulkan) = &self.gpu.0.vulkan {
            vulkan.frames_alive.fetch_sub(1, Ordering::AcqRel);
            if let Some(queries) = self.queries.take() {
                vulkan.queries.give_back(queries);
            }
        }
    }
}

impl Gpu {
    fn uploads(&self) -> u64 {
        self.0.vulkan.as_ref().map_or(0, |vulkan| vulkan.uploads.load(Ordering::Relaxed))
    }

    /// Starts recording a frame.
    pub fn frame(&self) -> Frame {
        Frame::new(self)
    }
}
