//! Methods running through the frames of a session: once for the clock, once for the truth.

pub mod bench;
pub mod capture;
pub mod methods;
mod ordered;
pub mod raster;
pub mod samples;
pub mod session;
mod stray;
pub mod sweep;
pub mod targets;
pub mod truth;

use crate::measures::metrics::{compare, FrameError, FrameImages, MetricError, Truth};
use crate::run::session::Session;
use anyhow::{bail, Context, Result};
use culling::auto::ALLOW_ERROR_OPTION;
use culling::world::DETAIL_OPTION;
use culling::{drawn_objects, Drawn, Entry, Guarantee, Method, Options, Setup, View, VisibleSets, Work};
use engine::{DepthFormat, FrameReport};
use std::sync::Arc;

/// A method with its settings, ready to run.
pub struct Contender {
    /// The method's entry in the list.
    pub entry: &'static Entry,
    /// Its options.
    pub options: Options,
    /// The method itself.
    pub method: Box<dyn Method>,
    /// Device memory that it holds beyond scene and targets, MiB.
    pub memory_mib: f64,
    depth: DepthFormat,
}

/// What is measured of a frame beside its time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watched {
    /// Nothing: the frame is as fast as it can be.
    Nothing,
    /// The time of each stage.
    Stages,
    /// Who owns each pixel: the item buffer is on.
    Items,
}

/// What is measured of one frame, untimed.
pub struct Measured {
    /// Against the truth.
    pub error: FrameError,
    /// The draw lists.
    pub drawn: Drawn,
    /// Fragments that passed the early tests, over the pixels that show something; 0 if none does.
    pub overdraw: f64,
    /// How often each pixel was shaded, row-major, top row first.
    pub counts: Vec<u32>,
    /// Queries, boxes and rays.
    pub work: Work,
    /// Bounds of moving objects that the frame brought to the device.
    pub bounds_brought: u64,
    /// The pictures.
    pub images: FrameImages,
}

impl Contender {
    /// Makes a method for a session.
    pub fn new(
        session: &Session,
        entry: &'static Entry,
        options: Options,
        visible: &Option<Arc<VisibleSets>>,
    ) -> Result<Self> {
        let samples = session.targets.samples();
        let refused = || entry.needs_one_sample(&session.world, &options, session.targets.stray_px());
        if let (2.., Some(why)) = (samples, refused()) {
            bail!("--samples {samples}: method '{}' cannot: {why}", options.label());
        }
        let before = session.gpu.memory_mib();
        let setup = Setup { gpu: &session.gpu, world: &session.world, options: &options, visible: visible.clone() };
        let made = (entry.make)(&setup).and_then(|method| culling::translucent::after(method, &setup));
        let made = made.and_then(|method| match session.options().flares {
            None => Ok(method),
            Some(flares) => culling::flares::after(method, &setup, flares),
        });
        let method = match made {
            // The one names the method itself, the other is nothing that a method does.
            Err(error @ (culling::Error::Missing { .. } | culling::Error::Flares { .. })) => return Err(error.into()),
            made => made.with_context(|| format!("method '{}'", options.label()))?,
        };
        let memory_mib = session.gpu.memory_mib() - before;
        Ok(Contender { entry, options, method, memory_mib, depth: session.gpu.depth() })
    }

    /// Its label in results.
    pub fn label(&self) -> String {
        self.options.label()
    }

    /// What it promises, with these options.
    pub fn guarantee(&self) -> Guarantee {
        let tests_bounds = self.entry.options.contains(&DETAIL_OPTION);
        match self.entry.guarantee {
            Guarantee::Exact if tests_bounds && self.depth != DepthFormat::default() => {
                Guarantee::Approximate("bounds allow for reversed D32 depth")
            }
            Guarantee::Exact if self.options.number(DETAIL_OPTION.name) > 0 => {
                Guarantee::Approximate("small things are left out")
            }
            Guarantee::Exact if self.allows_errors() => Guarantee::Approximate(culling::auto::ERRS),
            promised => promised,
        }
    }

    fn allows_errors(&self) -> bool {
        self.entry.options.contains(&ALLOW_ERROR_OPTION) && self.options.text(ALLOW_ERROR_OPTION.name) != "0"
    }

    /// Runs one frame as it is timed: without the item buffer, and without timers between its stages.
    pub fn timed(&mut self, session: &mut Session, frame: usize) -> Result<FrameReport> {
        let view = session.look(frame)?;
        self.run(session, &view, Watched::Nothing)
    }

    /// Runs one frame whose stages are timed: as it is timed otherwise, but slower by the timers.
    pub fn staged(&mut self, session: &mut Session, frame: usize) -> Result<FrameReport> {
        let view = session.look(frame)?;
        self.run(session, &view, Watched::Stages)
    }

    /// Runs one frame with the item buffer on and compares it with the truth.
    pub fn measured(&mut self, session: &mut Session, frame: usize, truth: &Truth) -> Result<Measured> {
        let left = self.left(session, frame)?;
        left.against(truth).with_context(|| format!("method '{}', frame {frame}", self.label()))
    }

    /// Runs one frame with the item buffer on and reads its results from the device, for a comparison with the truth.
    fn left(&mut self, session: &mut Session, frame: usize) -> Result<Left> {
        let view = session.look(frame)?;
        self.method.count_work(true);
        let report = self.run(session, &view, Watched::Items)?;
        self.method.count_work(false);
        let work = self.method.work()?;
        let images = session.targets.read_frame(&session.world, &view, &report)?;
        let drawn = drawn_objects(&session.gpu, &session.world, &report)?;
        let counts = fragment_counts(session, &view, &report)?;
        let fragments = counts.iter().map(|count| u64::from(*count)).sum();
        let counts = session.targets.spread(counts);
        let (bounds_brought, samples) = (session.world.bounds_brought(), session.targets.samples());
        Ok(Left { images, drawn, counts, fragments, work, bounds_brought, samples })
    }

    /// Runs one frame through a view.
    pub fn run(&mut self, session: &Session, view: &View, watched: Watched) -> Result<FrameReport> {
        let view = &view.without_details(self.options.number(DETAIL_OPTION.name) as f32);
        self.method.prepare(&session.world, view)?;
        let target = if watched == Watched::Items || self.method.needs_items(&session.world, view) {
            session.targets.with_items()
        } else {
            session.targets.timed()
        };
        let before = session.gpu.memory_mib();
        let mut f = session.gpu.frame();
        f.title(&self.options.label());
        if watched == Watched::Nothing {
            f.without_stage_times();
        }
        self.method.frame(&mut f, &session.world, view, &target)?;
        // Some methods make resources when they first see the target's size.
        self.memory_mib += session.gpu.memory_mib() - before;
        let report = f.finish().with_context(|| format!("method '{}', frame {}", self.label(), view.frame))?;
        if watched == Watched::Nothing {
            self.method.measured(report.frame_ms);
        }
        Ok(report)
    }
}

/// The results of a measured frame, read back from the device.
struct Left {
    images: FrameImages,
    drawn: Drawn,
    /// How often each pixel was shaded.
    counts: Vec<u32>,
    /// The sum of the counts; each pixel counts once, even with several samples.
    fragments: u64,
    work: Work,
    bounds_brought: u64,
    /// Samples a pixel.
    samples: u32,
}

impl Left {
    /// Compares the frame with the truth. Needs no device, so any thread can do it.
    fn against(self, truth: &Truth) -> Result<Measured, MetricError> {
        let Left { images, drawn, counts, fragments, work, bounds_brought, samples } = self;
        let error = compare(truth, &images, &drawn.objects)?;
        let covered = images.depth.iter().filter(|depth| **depth > 0.0).count();
        let covered = covered as f64 / f64::from(samples);
        let overdraw = if covered == 0.0 { 0.0 } else { fragments as f64 / covered };
        Ok(Measured { error, drawn, overdraw, counts, work, bounds_brought, images })
    }
}

/// Draws a finished frame's lists again, in the same order, and counts how often each pixel is shaded. The device's own
/// statistics will not do: lavapipe counts fragments that the early tests stop.
pub fn fragment_counts(session: &mut Session, view: &View, report: &FrameReport) -> Result<Vec<u32>> {
    let target = session.targets.counting(&session.gpu)?;
    let mut f = session.gpu.frame();
    f.clear(&target);
    session.world.draw_again(&mut f, &report.draws, view, &target);
    f.finish().context("counting fragments")?;
    Ok(session.targets.read_counts()?)
}
