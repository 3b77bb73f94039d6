//! Targets of several samples a pixel: when what stages read must be made of the samples anew.

use super::{uses, Op};
use crate::target::{Format, KeptSample, Samples, Target};
use shaders::{engine, Bound, BufferRef, Stage};
use std::marker::PhantomData;

/// What a frame has drawn to since its depth or colour was made of its samples.
#[derive(Default)]
pub(crate) struct Unresolved {
    pub(crate) standard_depth: bool,
    depths: Vec<(Target, Samples)>,
    colours: Vec<(Target, Samples)>,
}

impl Unresolved {
    /// What a step needs before it, where it reads depths of targets that were drawn to; and takes note of what it draws to itself.
    pub(crate) fn before(&mut self, op: &Op) -> Vec<(&'static str, Op)> {
        let mut steps = Vec::new();
        if !self.depths.is_empty() {
            let touched = uses(op);
            let (read, rest): (Vec<_>, Vec<_>) = self
                .depths
                .drain(..)
                .partition(|(target, _)| touched.iter().any(|touch| touch.resource == target.depth.id));
            self.depths = rest;
            steps.extend(read.iter().flat_map(|(target, samples)| self.depth(target, samples)));
        }
        match op {
            Op::Draw { target, .. } | Op::Query { target, .. } | Op::Shapes { target, .. } | Op::Clear { target } => {
                self.note(target)
            }
            _ => {}
        }
        steps
    }

    fn note(&mut self, target: &Target) {
        let Some(samples) = target.samples else { return };
        if !target.depth_read_only && self.depths.iter().all(|(known, _)| known.depth != target.depth) {
            self.depths.push((*target, samples));
        }
        let is_new = || self.colours.iter().all(|(known, _)| known.colour != target.colour);
        if samples.colour.is_some() && target.colour.is_some() && is_new() {
            self.colours.push((*target, samples));
        }
    }

    fn depth(&self, target: &Target, samples: &Samples) -> Vec<(&'static str, Op)> {
        let Bound::Buffer { id, raw, offset, size } = samples.resolved else { return Vec::new() };
        let least = (samples.kept == KeptSample::Farthest) != self.standard_depth;
        let stage = engine::ResolveDepth {
            depth: samples.depth,
            resolved: BufferRef { id, raw, offset, size, element: PhantomData },
            size_px: target.size,
            samples: samples.count,
            constants: engine::ResolveDepthConstants { least },
        };
        // Within what every device can run, as pictures are.
        let groups = [0, 1].map(|axis| target.size[axis].div_ceil(engine::ResolveDepth::INFO.local_size[axis]));
        let fill = Op::FillImage { from: samples.resolved, to: target.depth, format: Format::Depth, size: target.size };
        vec![
            (engine::ResolveDepth::INFO.name, Op::Dispatch { stage: stage.bind(), groups }),
            ("target/keep_resolved_depth", fill),
        ]
    }

    /// The colours of all targets that were drawn to.
    pub(crate) fn colours(&mut self) -> Vec<(&'static str, Op)> {
        let step = |(target, samples): (Target, Samples)| {
            let (to, _) = target.colour?;
            let op = Op::ResolveColour { from: samples.colour?, to, size: target.size };
            Some(("target/resolve_colour", op))
        };
        self.colours.drain(..).filter_map(step).collect()
    }
}
