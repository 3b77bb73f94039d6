//! Lens flares whose brightness is how much of their light shows, asked by an occlusion query (GPU Gems 29.8): the other thing that queries
//! are good for. Nothing is culled by them, and no method knows of them.
//!
//! After a method's frame, a block of 16x16 pixels at the light's place and depth is drawn within a query, without colour and without
//! depth: what it counts over what the block holds is the fraction of the light that shows, and the brightness of the flare's sprites over
//! the finished picture. Pixels of the block beyond the picture's edge are not drawn, so they do not count, and the flare fades out as
//! its light leaves the picture instead of vanishing with its middle.
//!
//! "We issue the occlusion query in this frame and read its result in the next one" (29.8.2) is [`When::Next`]: no wait, and an error while
//! what hides the light moves on the screen. [`When::Same`] waits, which is a stage of its own. A light that is off the screen, or behind the
//! eye, is known not to show: nothing is asked, and nothing drawn.
//!
//! Next to the query stands an oracle that compares the depth buffer pixel by pixel ([`twin`] says the same in plain Rust). It runs in frames
//! whose work is counted, which are never timed; these leave the sprites out, because the errors of their pictures are those of culling.

mod light;
pub mod twin;

pub use light::{Light, Place};

use crate::{Error, Flare, Method, Result, Setup, TestedBoxes, View, Work, World};
use engine::{Buffer, DepthFormat, Extra, Frame, Gpu, OcclusionQueries, Placement, Queried, Shapes, Surface, Target};
use shaders::flares::{CountBlock, CountBlockConstants, CountSamples, CountSamplesConstants, DrawSprites, TestBlock};
use shaders::types::{FLARE_BLOCK_PX, FLARE_SPRITES};
use shaders::Stage;

/// Corners of a rectangle that two triangles make.
const CORNERS: u32 = 6;

/// When the answer to a query is used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum When {
    /// In the next frame.
    #[default]
    Next,
    /// In the same frame, which waits for it.
    Same,
}

impl When {
    /// All of them.
    pub const ALL: [When; 2] = [When::Next, When::Same];

    /// What it is called on the command line.
    pub fn name(self) -> &'static str {
        match self {
            When::Next => "next",
            When::Same => "same",
        }
    }
}

/// What flares there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// When answers are used.
    pub when: When,
    /// The light.
    pub light: Light,
}

/// The method, and after each of its frames a lens flare.
///
/// # Errors
/// A device that does not count samples; a light at a place where depths are kept as whole numbers, which are rounded as each device likes.
pub fn after(method: Box<dyn Method>, setup: &Setup<'_>, settings: Settings) -> Result<Box<dyn Method>> {
    Ok(Box::new(After { method, pass: Pass::new(setup.gpu, settings)? }))
}

struct After {
    method: Box<dyn Method>,
    pass: Pass,
}

impl Method for After {
    fn prepare(&mut self, world: &World, view: &View) -> Result<()> {
        self.method.prepare(world, view)
    }

    fn needs_items(&self, world: &World, view: &View) -> bool {
        self.method.needs_items(world, view)
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        self.method.frame(f, world, view, target)?;
        self.pass.frame(f, view, target)
    }

    fn count_work(&mut self, on: bool) {
        self.pass.counts = on;
        self.method.count_work(on);
    }

    fn work(&self) -> Result<Work> {
        Ok(Work { flare: Some(self.pass.flare()?), ..self.method.work()? })
    }

    fn tested_boxes(&self, world: &World) -> Result<Option<TestedBoxes>> {
        self.method.tested_boxes(world)
    }

    fn measured(&mut self, frame_ms: f64) {
        self.method.measured(frame_ms);
    }

    fn repeat(&mut self) {
        self.method.repeat();
    }

    fn choices(&self) -> Vec<String> {
        self.method.choices()
    }

    fn forget(&mut self) -> Result<()> {
        self.pass.forget();
        self.method.forget()
    }
}

struct Pass {
    settings: Settings,
    queries: OcclusionQueries,
    /// The oracle's sum.
    visible: Buffer<u32>,
    standard_depth: bool,
    /// The frame's work is counted.
    counts: bool,
    /// The last frame asked.
    asked: bool,
    /// The last frame's work was counted.
    counted: bool,
    used: u64,
    of: u64,
}

impl Pass {
    fn new(gpu: &Gpu, settings: Settings) -> Result<Self> {
        let depth = gpu.depth();
        if !gpu.has(Extra::OcclusionQueryPrecise) {
            let needs = "'occlusionQueryPrecise' of the device to count samples; leave --flares out".to_owned();
            return Err(Error::Flares { needs });
        }
        let floats = matches!(depth, DepthFormat::ReversedD32 | DepthFormat::StandardD32);
        if !floats && matches!(settings.light, Light::At(_)) {
            let needs = format!("depths as floats for a light at a place, not {depth}; give a direction with --light");
            return Err(Error::Flares { needs });
        }
        Ok(Pass {
            settings,
            queries: OcclusionQueries::new(gpu, "flares.queries", 1)?,
            visible: Buffer::with_data(gpu, "flares.visible", &[0], Placement::Storage)?,
            standard_depth: depth.is_standard(),
            counts: false,
            asked: false,
            counted: false,
            used: 0,
            of: 0,
        })
    }

    fn frame(&mut self, f: &mut Frame, view: &View, target: &Target) -> Result<()> {
        let known = self.answer()?.unwrap_or(0); // 1. "read its result in the next one"
        let place = self.settings.light.place(view); // 2. where the light is on the screen
        (self.asked, self.counted) = (place.is_some(), self.counts);
        self.of = u64::from(FLARE_BLOCK_PX * FLARE_BLOCK_PX * target.samples.map_or(1, |samples| samples.count));
        f.part("");
        let Some(place) = place else {
            self.used = 0;
            for stage in [TestBlock::INFO, DrawSprites::INFO] {
                f.skip(stage.name, "the light is not on the screen");
            }
            return Ok(());
        };
        let block = Shapes { corners: CORNERS, count: 1, surface: Surface::Opaque };
        let queried = Queried { queries: &self.queries, first: 0 };
        // 3. "render a block of pixels (say, 16x16) and see what fraction of them actually got rendered"
        f.query_shapes(TestBlock { block: place.block }, block, queried, &target.test_only());
        if self.counts {
            self.count(f, &place, target);
        }
        self.used = match self.settings.when {
            When::Next => known,
            When::Same => {
                f.part("flares");
                let samples = f.wait_for_queries(&self.queries, 0..1)?;
                f.part("");
                samples[0]
            }
        };
        self.draw(f, &place, target); // 4. "use this fraction to modulate the lens flare's brightness"
        Ok(())
    }

    /// The oracle.
    fn count(&self, f: &mut Frame, place: &Place, target: &Target) {
        let (block, visible) = (place.block, self.visible.all());
        f.fill("flares/clear_count", visible, 0);
        let over = [FLARE_BLOCK_PX; 2];
        match target.samples {
            None => {
                let constants = CountBlockConstants { standard_depth: self.standard_depth };
                f.dispatch_over(CountBlock { depth: target.depth, visible, block, constants }, over);
            }
            Some(of) => {
                let constants = CountSamplesConstants { standard_depth: self.standard_depth };
                let stage = CountSamples { depth: of.depth, visible, block, samples: of.count, constants };
                f.dispatch_over(stage, over);
            }
        }
    }

    fn draw(&self, f: &mut Frame, place: &Place, target: &Target) {
        if self.used == 0 || self.counts {
            let reason = if self.used == 0 { "nothing of the light showed" } else { "errors are of the picture below" };
            f.skip(DrawSprites::INFO.name, reason);
            return;
        }
        let [width, height] = target.size.map(|side| side as f32);
        let sprites = DrawSprites {
            light: place.light.as_vec2().to_array(),
            brightness: (self.used as f64 / self.of as f64) as f32,
            height_over_width: height / width,
        };
        let shapes = Shapes { corners: CORNERS, count: FLARE_SPRITES, surface: Surface::Light };
        f.draw_shapes(sprites, shapes, &Target { item: None, depth_read_only: true, ..*target });
    }

    /// What the last frame's query counted; it is done.
    fn answer(&self) -> Result<Option<u64>> {
        Ok(if self.asked { Some(self.queries.read(0..1)?[0]) } else { None })
    }

    fn flare(&self) -> Result<Flare> {
        let visible = match (self.counted, self.asked) {
            (true, true) => Some(u64::from(self.visible.read()?[0])),
            (true, false) => Some(0),
            (false, _) => None,
        };
        Ok(Flare { used: self.used, asked: self.answer()?, visible, of: self.of })
    }

    fn forget(&mut self) {
        (self.asked, self.counted, self.used) = (false, false, 0);
    }
}
