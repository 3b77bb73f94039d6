//! A case on a device: methods run through its shots, next to the truth. Errors are the device's or its validation layer's.

use crate::measures::metrics::{compare, FrameError, FrameImages, Truth};
use crate::run::targets::Targets;
use crate::run::truth::draw_truth;
use crate::stress::Case;
use anyhow::{Context, Result};
use culling::{draw_lists, drawn_by, Drawn, Entry, Method, Options, Setup, View, VisibleSets, World};
use engine::{FrameReport, Gpu};
use scenes::{Scene, Shot};
use shaders::types::DrawCommand;
use std::sync::Arc;

/// What laws run: a method of the list with options, or one that a test made.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Its options.
    pub options: Options,
    /// Makes it.
    pub make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>,
}

impl Subject {
    /// The method of that name, at its defaults.
    ///
    /// # Panics
    /// If there is none.
    pub fn named(id: &str) -> Self {
        let entry: &Entry = culling::find(id).unwrap();
        Subject { options: entry.default_options(), make: entry.make }
    }

    /// With one option set.
    ///
    /// # Panics
    /// If it has no such option or value.
    pub fn with(mut self, option: &str, value: &str) -> Self {
        self.options.set(option, value).unwrap();
        self
    }

    /// True if it can leave stages out.
    pub fn can_skip(&self) -> bool {
        self.options.all().contains_key("skip")
    }
}

/// One frame of a method.
pub struct Take {
    /// What it did.
    pub report: FrameReport,
    /// What it drew: the pictures. Items are world objects.
    pub images: FrameImages,
    /// What it drew: the objects.
    pub drawn: Drawn,
    /// Its draw lists, in order, to the bit.
    pub commands: Vec<DrawCommand>,
}

/// A scene on the device, with targets.
pub struct Lab {
    /// The device.
    pub gpu: Gpu,
    /// The scene.
    pub scene: Scene,
    /// The scene on the device.
    pub world: World,
    /// What is drawn to.
    pub targets: Targets,
    /// Width and height in pixels.
    pub size: [u32; 2],
}

impl Lab {
    /// Puts a case's scene on the device.
    pub fn new(gpu: &Gpu, case: &Case) -> Result<Self> {
        Self::with_samples(gpu, case, 1)
    }

    /// The same, drawn with so many samples a pixel.
    pub fn with_samples(gpu: &Gpu, case: &Case, samples: u32) -> Result<Self> {
        let world = World::new(gpu, &case.scene).with_context(|| case.name.clone())?;
        let targets = Targets::with_samples(gpu, case.size, samples)?;
        Ok(Lab { gpu: gpu.clone(), scene: case.scene.clone(), world, targets, size: case.size })
    }

    /// Changes the picture's size.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        self.targets = Targets::with_samples(&self.gpu, size, self.targets.samples())?;
        self.size = size;
        Ok(())
    }

    /// Moves the scene to a shot's time and looks through it.
    pub fn look(&mut self, shot: &Shot, frame: usize) -> Result<View> {
        self.world.set_time(&self.scene, shot.seconds)?;
        Ok(View::new(shot, self.size, frame, self.targets.reach_px(&self.gpu)))
    }

    /// The truth of a shot: everything is drawn.
    pub fn truth(&mut self, shot: &Shot) -> Result<Truth> {
        let view = self.look(shot, 0)?;
        Ok(Truth::new(draw_truth(&self.gpu, &self.world, &self.targets, &view)?, self.world.total())?)
    }

    /// The truth of each shot, and their visible sets.
    pub fn truths(&mut self, shots: &[Shot]) -> Result<(Vec<Truth>, Arc<VisibleSets>)> {
        let truths = shots.iter().map(|shot| self.truth(shot)).collect::<Result<Vec<Truth>>>()?;
        let mut sets = VisibleSets::new(self.world.total());
        truths.iter().for_each(|truth| sets.push_items(&truth.images().visible_items()));
        Ok((truths, Arc::new(sets)))
    }

    /// Makes a method for this world.
    pub fn make(&self, subject: &Subject, visible: &Arc<VisibleSets>) -> Result<Box<dyn Method>> {
        let visible = Some(visible.clone());
        let setup = Setup { gpu: &self.gpu, world: &self.world, options: &subject.options, visible };
        let made = (subject.make)(&setup).and_then(|method| culling::translucent::after(method, &setup));
        made.with_context(|| subject.options.label())
    }

    /// Runs one frame with the item buffer on.
    pub fn take(&mut self, method: &mut dyn Method, shot: &Shot, frame: usize) -> Result<Take> {
        let view = self.look(shot, frame)?;
        self.take_through(method, &view)
    }

    /// The same through a view, of objects where they are now.
    pub fn take_through(&mut self, method: &mut dyn Method, view: &View) -> Result<Take> {
        let report = self.run(method, view, true)?;
        let images = self.targets.read_frame(&self.world, view, &report)?;
        self.developed(report, images)
    }

    /// Runs one frame as it is timed, without the item buffer; the items are what an earlier frame left.
    pub fn take_timed(&mut self, method: &mut dyn Method, shot: &Shot, frame: usize) -> Result<Take> {
        let view = self.look(shot, frame)?;
        let report = self.run(method, &view, false)?;
        let images = self.targets.read_frame(&self.world, &view, &report)?;
        self.developed(report, images)
    }

    /// Runs a method, new or not, through all shots.
    pub fn film(&mut self, method: &mut dyn Method, shots: &[Shot]) -> Result<Vec<Take>> {
        shots.iter().enumerate().map(|(frame, shot)| self.take(method, shot, frame)).collect()
    }

    fn run(&mut self, method: &mut dyn Method, view: &View, items: bool) -> Result<FrameReport> {
        method.prepare(&self.world, view)?;
        let target = if items || method.needs_items(&self.world, view) {
            self.targets.with_items()
        } else {
            self.targets.timed()
        };
        let mut f = self.gpu.frame();
        method.frame(&mut f, &self.world, view, &target)?;
        f.finish().with_context(|| format!("frame {}", view.frame))
    }

    fn developed(&self, report: FrameReport, images: FrameImages) -> Result<Take> {
        let lists = draw_lists(&self.gpu, &report)?;
        let drawn = drawn_by(&self.world, &report, &lists);
        Ok(Take { report, images, drawn, commands: lists.concat() })
    }
}

/// How far a take is from the truth.
pub fn error_of(truth: &Truth, take: &Take) -> Result<FrameError> {
    Ok(compare(truth, &take.images, &take.drawn.objects)?)
}
