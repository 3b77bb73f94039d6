//! Opening a device, and the check of how its stages are timed.

use crate::features::Extra;
use crate::{
    Buffer, Faces, Format, Gpu, GpuOptions, Image, IndexedIndirect, Placement, Primitives, Result, Surface, Target,
    TimerMode,
};

impl Gpu {
    /// Opens a device.
    pub fn open(options: &GpuOptions) -> Result<Self> {
        let gpu = Gpu::open_untimed(options)?;
        let mode = match options.timer {
            _ if !gpu.has(Extra::Timestamps) => TimerMode::Off,
            Some(mode) => mode,
            None => gpu.info().map_or(TimerMode::Split, |info| TimerMode::of(info.kind)),
        };
        if let Some(vulkan) = &gpu.0.vulkan {
            vulkan.timer.get_or_init(|| mode);
        }
        Ok(gpu)
    }

    /// Measures whether plain timestamps charge work to the right stage on this device; if not, [`TimerMode::Split`] is needed. A busy
    /// machine can change the answer, so only messages to people may depend on it.
    ///
    /// # Errors
    /// An error of the device.
    pub fn check_timers(&self) -> Result<TimerMode> {
        match self.has(Extra::Timestamps) {
            true => check_timers(self),
            false => Ok(TimerMode::Off),
        }
    }
}

/// Side of the picture that the check's heavy half fills, in pixels.
const CHECK_PX: u32 = 512;

/// Words that its heavy dispatch fills.
const CHECK_WORDS: u32 = 1 << 20;

/// Does the device charge work to the stage that asked for it? Light stages are timed with plain timestamps, alone and beside
/// heavy ones: a light dispatch after a heavy drawing, and a light clear before a heavy dispatch. If either then takes three
/// times as long and a fifth of the whole, stages are not kept apart. (lavapipe puts drawings off and runs dispatches at once,
/// so that a clear is charged with the dispatch behind it.)
fn check_timers(gpu: &Gpu) -> Result<TimerMode> {
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
    tracing::debug!(?drawn_on, ?dispatched_on, "timer check: light stages that were charged with the work of others");
    let often = |charged: &[bool]| charged.iter().filter(|charged| **charged).count() >= 2;
    Ok(if often(&drawn_on) || often(&dispatched_on) { TimerMode::Split } else { TimerMode::Plain })
}

/// True if a light stage was charged with the work of its heavy neighbour.
fn overcharge(alone_ms: f64, beside_ms: f64, total_ms: f64) -> bool {
    beside_ms > 3.0 * alone_ms && beside_ms > 0.2 * total_ms
}

/// The resources of the check.
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
                samples: None,
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
    use super::overcharge;

    #[test]
    fn a_light_stage_that_pays_for_its_neighbour_is_noticed() {
        assert!(overcharge(0.1, 1.7, 2.0));
        assert!(!overcharge(0.1, 0.12, 2.0), "as light as alone");
        assert!(!overcharge(0.001, 0.01, 2.0), "noise beside a heavy stage");
    }
}
