//! What a frame leaves in its targets, kept beyond it.

use super::Frame;
use crate::depth::DepthFormat;
use crate::lower;
use crate::recorder::Op;
use crate::target::{Format, Target};
use crate::Buffer;
use bytemuck::Pod;
use shaders::{engine, ImageRef, Stage};

impl Frame {
    /// Keeps the target's depth beyond the frame: a float a pixel, reversed, row by row from the top.
    ///
    /// # Panics
    /// If the buffer has no room for it.
    pub fn copy_depth(&mut self, label: &str, target: &Target, to: &Buffer<f32>) {
        let depth = self.gpu.depth();
        if depth == DepthFormat::ReversedD32 {
            self.copy_image(label, target.depth, Format::Depth, target.size, to);
            return;
        }
        let [width, height] = target.size;
        assert!(
            to.len() >= width as usize * height as usize,
            "{label}: {} words for {width}x{height} texels",
            to.len()
        );
        let constants = engine::CopyDepthConstants { standard_depth: depth.is_standard() };
        let stage = engine::CopyDepth { depth: target.depth, copied: to.all(), size_px: target.size, constants };
        let groups = lower::folded((width * height).div_ceil(engine::CopyDepth::INFO.local_size[0]));
        self.recorder.push(label, Op::Dispatch { stage: stage.bind(), groups });
    }

    /// Keeps the target's item buffer beyond the frame: an object a pixel, row by row from the top; nothing if the target
    /// has none.
    ///
    /// # Panics
    /// If the buffer has no room for it.
    pub fn copy_items(&mut self, label: &str, target: &Target, to: &Buffer<u32>) {
        if let Some(items) = target.item {
            self.copy_image(label, items, Format::Item, target.size, to);
        }
    }

    fn copy_image<T: Pod>(&mut self, label: &str, from: ImageRef, format: Format, size: [u32; 2], to: &Buffer<T>) {
        let texels = size[0] as usize * size[1] as usize;
        assert!(to.len() >= texels, "{label}: {} words for {texels} texels", to.len());
        self.recorder.push(label, Op::CopyImage { from, format, size, to: to.all().into() });
    }
}
