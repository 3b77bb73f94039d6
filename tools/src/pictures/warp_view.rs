//! Pictures of depth warping: a frame's depth as predicted from the frame before, next to what is then drawn.

use crate::measures::metrics::{DepthErrors, FrameImages, NOTICED};
use crate::measures::stats::{self, by_label};
use crate::pictures::png_out::{DepthScale, Picture};
use crate::run::session::Session;
use crate::run::{Contender, Watched};
use anyhow::{bail, Context, Result};
use culling::warp::{Settings, Warp};
use engine::{Buffer, FrameReport, Placement};
use shaders::types::{TexelMotion, DEPTH_FAR};

/// Runs of a warp; the median counts.
const RUNS: usize = 9;

const HOLE: [u8; 3] = [255, 150, 0];
const TOO_NEAR: [u8; 3] = [255, 40, 40];
const TOO_FAR: [u8; 3] = [40, 120, 255];
const HOLE_AS_ERROR: [u8; 3] = [15, 50, 110];

/// A warped depth and the truth, by texel of the warp.
pub struct Warped {
    /// Width and height in texels.
    texels: [u32; 2],
    /// Pixels of a texel's side.
    reduction: u32,
    size: [u32; 2],
    motions: Vec<TexelMotion>,
    depth: Vec<f32>,
    truth: Vec<f32>,
    scale: DepthScale,
    stages: Vec<(String, f64)>,
}

/// Draws the frame before with the method, warps its depth, then draws the frame.
///
/// # Errors
/// The first frame, which has none before it, or a device or method that fails.
pub fn warp(session: &mut Session, contender: &mut Contender, frame: usize, settings: Settings) -> Result<Warped> {
    let Some(before) = frame.checked_sub(1) else {
        bail!("--frame 0: a warp starts from the frame before; give --frame 1 or more");
    };
    let last_view = session.look(before)?;
    contender.run(session, &last_view, Watched::Items)?;
    let settings = Settings { stored: true, ..settings }; // for the picture of it
    let mut warp = Warp::new(&session.gpu, &session.world, last_view.size, settings).context("depth warping")?;
    let mut f = session.gpu.frame();
    warp.keep(&mut f, &session.world, &last_view, &session.targets.with_items());
    f.finish().context("keeping a frame's depth")?;
    let view = session.look(frame)?;
    let [width, height] = warp.texels();
    let warped = Buffer::new(&session.gpu, "warped", (width * height) as usize, Placement::Storage)?;
    let mut reports = Vec::new();
    for _ in 0..RUNS {
        let mut f = session.gpu.frame();
        warp.frame(&mut f, &session.world, &view, warped.all())?;
        reports.push(f.finish().context("depth warping")?);
    }
    contender.run(session, &view, Watched::Items)?;
    let images = session.targets.read()?;
    Warped::of(&warp, &warped, settings, &images, median(&reports))
}

/// Each stage's median time: the first use of a stage includes compiling it, and others are disturbed by what else runs.
fn median(reports: &[FrameReport]) -> Vec<(String, f64)> {
    let Some(first) = reports.first() else { return Vec::new() };
    let times = |index: usize| reports.iter().map(|report| report.stages[index].ms).collect::<Vec<_>>();
    let typical = |index: usize| stats::median(&times(index)).unwrap_or(0.0);
    first.stages.iter().enumerate().map(|(index, stage)| (stage.label.clone(), typical(index))).collect()
}

/// What a warped texel stands for: the farthest depth of its pixels.
pub(crate) fn farthest_of_blocks(depth: &[f32], [width, height]: [u32; 2], reduction: u32) -> Vec<f32> {
    let across = width.div_ceil(reduction);
    let mut farthest = vec![f32::INFINITY; (across * height.div_ceil(reduction)) as usize];
    for (row, pixels) in (0..).zip(depth.chunks_exact(width as usize)) {
        for (column, depth) in (0..).zip(pixels) {
            let texel = &mut farthest[(row / reduction * across + column / reduction) as usize];
            *texel = texel.min(*depth);
        }
    }
    farthest
}

impl Warped {
    /// What a warp made of the frame before, beside the frame that was then drawn.
    pub(crate) fn of(
        warp: &Warp,
        warped: &Buffer<f32>,
        settings: Settings,
        images: &FrameImages,
        stages: Vec<(String, f64)>,
    ) -> Result<Self> {
        let size = [images.width, images.height];
        Ok(Warped {
            texels: warp.texels(),
            reduction: settings.reduction,
            size,
            motions: warp.read_motions()?,
            // Holes, which are farther than far, are shown as far.
            depth: warped.read()?.into_iter().map(|depth| depth.max(DEPTH_FAR)).collect(),
            truth: farthest_of_blocks(&images.depth, size, settings.reduction),
            scale: DepthScale::of(&images.depth),
            stages,
        })
    }

    /// How far the warp is from the truth, on the scale of its pictures.
    ///
    /// # Errors
    /// A warp of another size than the truth.
    pub fn errors(&self) -> Result<DepthErrors> {
        Ok(DepthErrors::of(&self.depth, &self.truth, self.texels[0], |depth| self.scale.brightness(depth))?)
    }

    /// The warped depth as grey, on the truth's scale.
    pub fn picture(&self) -> Picture {
        self.enlarged(|texel| self.scale.grey(self.depth[texel]))
    }

    /// Motion: its direction as a hue (right red, down yellow-green, left cyan, up violet), its length as brightness; the
    /// longest of nineteen in twenty is brightest. Black: nothing there.
    pub fn motion(&self) -> Picture {
        let longest = self.length_at(0.95).max(f32::MIN_POSITIVE);
        self.enlarged(|texel| match self.motions[texel] {
            TexelMotion { depth: 0.0, .. } => [0; 3],
            TexelMotion { offset: [x, y], .. } => {
                let strength = (x.hypot(y) / longest).min(1.0);
                hue(y.atan2(x)).map(|channel| (32.0 + strength * 223.0 * channel) as u8)
            }
        })
    }

    /// The truth, dimmed, with orange where the warp found nothing.
    pub fn holes(&self) -> Picture {
        self.enlarged(
            |texel| {
                if self.depth[texel] == 0.0 && self.truth[texel] > 0.0 {
                    HOLE
                } else {
                    self.dimmed(texel)
                }
            },
        )
    }

    /// The truth, dimmed; red where the warp is nearer, blue where it is farther, the stronger the more, up to twice or
    /// half; dark blue where it found nothing.
    pub fn error(&self) -> Picture {
        self.enlarged(|texel| {
            let (warped, truth) = (self.depth[texel], self.truth[texel]);
            if warped == 0.0 && truth > 0.0 {
                return HOLE_AS_ERROR;
            }
            // Infinite where something was predicted and nothing is.
            let octaves = if warped == truth { 0.0 } else { (warped / truth).log2().abs().min(1.0) };
            if octaves < NOTICED.ln_1p() / std::f32::consts::LN_2 {
                return self.dimmed(texel);
            }
            let colour = if warped > truth { TOO_NEAR } else { TOO_FAR };
            let strength = 0.45 + 0.55 * octaves.sqrt();
            colour.map(|channel| (f32::from(channel) * strength) as u8)
        })
    }

    /// Errors, motion and times in words.
    ///
    /// # Errors
    /// A warp of another size than the truth.
    pub fn caption(&self) -> Result<String> {
        let errors = self.errors()?;
        let decibel = |psnr: Option<f64>| psnr.map_or("identical".to_owned(), |psnr| format!("{psnr:.1} dB"));
        let times: Vec<_> = by_label(&self.stages).iter().map(|(label, ms)| format!("{label} {ms:.1}")).collect();
        let sum: f64 = self.stages.iter().map(|(_, ms)| ms).sum();
        Ok(format!(
            "PSNR {}, SSIM {:.4}; nearer than real: PSNR {}, {:.2} % by more than {noticed:.0} %; farther: PSNR {}, {:.2} % \
             by more than {noticed:.0} %, holes {:.2} %; motion {:.1} px in the middle, {:.1} px at most of \
             95 %; {sum:.1} ms: {}",
            decibel(errors.psnr_db),
            errors.ssim,
            decibel(errors.nearer_psnr_db),
            errors.nearer_percent,
            decibel(errors.farther_psnr_db),
            errors.farther_percent,
            errors.hole_percent,
            self.length_at(0.5) * self.reduction as f32,
            self.length_at(0.95) * self.reduction as f32,
            times.join(", "),
            noticed = 100.0 * NOTICED,
        ))
    }

    fn dimmed(&self, texel: usize) -> [u8; 3] {
        self.scale.grey(self.truth[texel]).map(|channel| channel / 3)
    }

    /// The length, in texels, that this share of all motions does not exceed; 0 if nothing moves.
    fn length_at(&self, share: f64) -> f32 {
        let there = self.motions.iter().filter(|motion| motion.depth > 0.0);
        let mut lengths: Vec<f32> = there.map(|motion| motion.offset[0].hypot(motion.offset[1])).collect();
        lengths.sort_unstable_by(f32::total_cmp);
        lengths.get((share * lengths.len() as f64) as usize).or(lengths.last()).copied().unwrap_or(0.0)
    }

    /// A picture of full size from the colour of each texel.
    fn enlarged(&self, colour: impl Fn(usize) -> [u8; 3]) -> Picture {
        let colours: Vec<[u8; 3]> = (0..self.depth.len()).map(colour).collect();
        let [width, height] = self.size;
        let texel = |x: u32, y: u32| (y / self.reduction * self.texels[0] + x / self.reduction) as usize;
        let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| colours[texel(x, y)]);
        Picture { width, height, pixels: pixels.collect() }
    }
}

/// The colour wheel, channels 0..=1: angle 0 is red.
fn hue(angle: f32) -> [f32; 3] {
    let sixth = angle.rem_euclid(std::f32::consts::TAU) / std::f32::consts::TAU * 6.0;
    [0.0, 4.0, 2.0].map(|shift| {
        let distance = (sixth + shift).rem_euclid(6.0) - 3.0;
        (distance.abs() - 1.0).clamp(0.0, 1.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn warped(depth: Vec<f32>, truth: Vec<f32>) -> Warped {
        let motions = depth.iter().map(|depth| TexelMotion { offset: [3.0, -4.0], depth: *depth }).collect();
        let scale = DepthScale::of(&truth);
        let texels = [depth.len() as u32, 1];
        Warped { texels, reduction: 2, size: [2 * texels[0] - 1, 1], motions, depth, truth, scale, stages: Vec::new() }
    }

    #[test]
    fn each_error_has_its_colour() {
        let shown = warped(vec![0.5, 0.5, 0.2, 0.0, 0.0], vec![0.5, 0.2, 0.5, 0.5, 0.0]);
        let [same, near, far, hole, nothing] = [0, 2, 4, 6, 8].map(|pixel| shown.error().pixels[pixel]);
        assert!(same[0] == same[1] && same[1] == same[2] && same[0] > 0);
        assert!(near[0] > 200 && near[2] < 100, "{near:?}");
        assert!(far[2] > 200 && far[0] < 100, "{far:?}");
        assert_eq!((hole, nothing), (HOLE_AS_ERROR, [0; 3]));
        let caption = shown.caption().unwrap();
        assert!(
            caption.contains("20.00 % by more than 1 %; farther") && caption.contains("40.00 % by more"),
            "{caption}"
        );
        assert!(caption.contains("holes 20.00 %"), "{caption}");
        assert_eq!([0, 6, 8].map(|pixel| shown.holes().pixels[pixel] == HOLE), [false, true, false]);
        assert_eq!(shown.errors().unwrap().hole_percent, 20.0);
    }

    #[test]
    fn motion_is_shown_by_direction_and_absent_where_nothing_is() {
        let shown = warped(vec![0.5, 0.0], vec![0.5, 0.0]);
        let motion = shown.motion();
        assert_eq!(motion.pixels.len(), 3);
        assert_eq!(motion.pixels[2], [0; 3]);
        assert!(motion.pixels[0].iter().any(|channel| *channel > 200));
        assert_eq!(hue(0.0), [1.0, 0.0, 0.0]);
        let caption = shown.caption().unwrap();
        assert!(caption.contains("motion 10.0 px"), "{caption}");
        assert!(
            caption.starts_with("PSNR identical, SSIM 1.0000; nearer than real: PSNR identical, 0.00 %"),
            "{caption}"
        );
    }

    #[test]
    fn a_block_is_as_far_as_its_farthest_pixel() {
        let depth = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4];
        assert_eq!(farthest_of_blocks(&depth, [3, 2], 2), [0.5, 0.4]);
    }
}
