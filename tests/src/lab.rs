//! The lab of `sightline stress` as tests use it: what it returns as an error fails the test.

use crate::Case;
use culling::{Method, View, VisibleSets};
use engine::Gpu;
use scenes::Shot;
use sightline::measures::metrics::{FrameError, Truth};
use sightline::stress::lab;
pub use sightline::stress::lab::{Subject, Take};
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

/// A scene on the device, with targets.
pub struct Lab(lab::Lab);

impl Deref for Lab {
    type Target = lab::Lab;

    fn deref(&self) -> &lab::Lab {
        &self.0
    }
}

impl DerefMut for Lab {
    fn deref_mut(&mut self) -> &mut lab::Lab {
        &mut self.0
    }
}

/// What the device or its validation layer objects to fails the test.
#[track_caller]
fn good<T>(result: anyhow::Result<T>) -> T {
    result.unwrap_or_else(|error| panic!("{error:#}"))
}

impl Lab {
    /// Puts a case's scene on the device.
    pub fn new(gpu: &Gpu, case: &Case) -> Self {
        Lab(good(lab::Lab::new(gpu, case)))
    }

    /// The same, drawn with so many samples a pixel.
    pub fn with_samples(gpu: &Gpu, case: &Case, samples: u32) -> Self {
        Lab(good(lab::Lab::with_samples(gpu, case, samples)))
    }

    /// Changes the picture's size.
    pub fn resize(&mut self, size: [u32; 2]) {
        good(self.0.resize(size));
    }

    /// Moves the scene to a shot's time and looks through it.
    pub fn look(&mut self, shot: &Shot, frame: usize) -> View {
        good(self.0.look(shot, frame))
    }

    /// The truth of a shot: everything is drawn.
    pub fn truth(&mut self, shot: &Shot) -> Truth {
        good(self.0.truth(shot))
    }

    /// The truth of each shot, and their visible sets.
    pub fn truths(&mut self, shots: &[Shot]) -> (Vec<Truth>, Arc<VisibleSets>) {
        good(self.0.truths(shots))
    }

    /// The visible sets of shots, for a method that draws by them; empty for all others, which never look at them.
    pub fn sets_for(&mut self, subject: &Subject, shots: &[Shot]) -> Arc<VisibleSets> {
        match subject.options.method() {
            "ref" => self.truths(shots).1,
            _ => Arc::default(),
        }
    }

    /// Makes a method for this world.
    pub fn make(&self, subject: &Subject, visible: &Arc<VisibleSets>) -> Box<dyn Method> {
        good(self.0.make(subject, visible))
    }

    /// Runs one frame with the item buffer on.
    pub fn take(&mut self, method: &mut dyn Method, shot: &Shot, frame: usize) -> Take {
        good(self.0.take(method, shot, frame))
    }

    /// The same through a view, of objects where they are now.
    pub fn take_through(&mut self, method: &mut dyn Method, view: &View) -> Take {
        good(self.0.take_through(method, view))
    }

    /// Runs one frame as it is timed, without the item buffer; the items are what an earlier frame left.
    pub fn take_timed(&mut self, method: &mut dyn Method, shot: &Shot, frame: usize) -> Take {
        good(self.0.take_timed(method, shot, frame))
    }

    /// Runs a method, new or not, through all shots.
    pub fn film(&mut self, method: &mut dyn Method, shots: &[Shot]) -> Vec<Take> {
        good(self.0.film(method, shots))
    }
}

/// How far a take is from the truth.
pub fn error_of(truth: &Truth, take: &Take) -> FrameError {
    good(lab::error_of(truth, take))
}
