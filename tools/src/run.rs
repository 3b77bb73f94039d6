//! Methods running through the frames of a session: once for the clock, once for the truth.

use crate::metrics::{compare, FrameError, FrameImages, Truth};
use crate::session::Session;
use anyhow::{Context, Result};
use culling::{drawn_objects, Drawn, Entry, Method, Options, Setup, VisibleSets};
use engine::FrameReport;
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
}

/// What is measured of one frame, untimed.
pub struct Measured {
    /// Against the truth.
    pub error: FrameError,
    /// The draw lists.
    pub drawn: Drawn,
    /// Fragments shaded, where the device counts them.
    pub fragments: Option<u64>,
    /// The pictures.
    pub images: FrameImages,
}

impl Contender {
    /// Makes a method for a session.
    pub fn new(session: &Session, entry: &'static Entry, options: Options, visible: &Option<Arc<VisibleSets>>) -> Result<Self> {
        let before = session.gpu.memory_mib();
        let setup = Setup { gpu: &session.gpu, world: &session.world, options: &options, visible: visible.clone() };
        let method = (entry.make)(&setup).with_context(|| format!("method '{}'", options.label()))?;
        let memory_mib = session.gpu.memory_mib() - before;
        Ok(Contender { entry, options, method, memory_mib })
    }

    /// Its label in results.
    pub fn label(&self) -> String {
        self.options.label()
    }

    /// Runs one frame as it is timed: no item buffer, no statistics.
    pub fn timed(&mut self, session: &mut Session, frame: usize) -> Result<FrameReport> {
        self.run(session, frame, false)
    }

    /// Runs one frame with the item buffer on and compares it with the truth.
    pub fn measured(&mut self, session: &mut Session, frame: usize, truth: &Truth) -> Result<Measured> {
        let report = self.run(session, frame, true)?;
        let images = session.targets.read()?;
        let drawn = drawn_objects(&session.gpu, &session.world, &report)?;
        let error = compare(truth, &images, &drawn.objects)
            .with_context(|| format!("method '{}', frame {frame}", self.label()))?;
        Ok(Measured { error, drawn, fragments: report.statistics.map(|counted| counted.fragments), images })
    }

    fn run(&mut self, session: &mut Session, frame: usize, measured: bool) -> Result<FrameReport> {
        let view = session.look(frame)?;
        self.method.prepare(&session.world, &view)?;
        let target = if measured { session.targets.with_items() } else { session.targets.timed() };
        let before = session.gpu.memory_mib();
        let mut f = session.gpu.frame();
        if measured {
            f.count_statistics();
        }
        self.method.frame(&mut f, &session.world, &view, &target)?;
        // Some methods make resources when they first see the target's size.
        self.memory_mib += session.gpu.memory_mib() - before;
        f.finish().with_context(|| format!("method '{}', frame {frame}", self.label()))
    }
}
