//! One frame of a run, captured with RenderDoc.

use anyhow::Result;
use engine::{Capture, Gpu};
use std::path::{Path, PathBuf};

/// Which frame RenderDoc captures, and where to.
pub struct CaptureOrder {
    frame: usize,
    folder: PathBuf,
    library: Capture,
}

impl CaptureOrder {
    /// Loads RenderDoc, which has to see the device being opened.
    ///
    /// # Errors
    /// No RenderDoc.
    pub fn new(frame: usize, folder: &Path) -> Result<Self> {
        Ok(CaptureOrder { frame, folder: folder.to_owned(), library: Capture::load()? })
    }

    fn around<T>(&mut self, gpu: &Gpu, label: &str, run: impl FnOnce() -> Result<T>) -> Result<T> {
        let name: String = label.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '-' }).collect();
        self.library.start(gpu, &self.folder.join(name))?;
        let done = run();
        let file = self.library.end(gpu)?;
        tracing::info!("{label}: frame {} captured to {}", self.frame, file.display());
        done
    }
}

/// Runs a frame of a label, and captures what it does on the device if that is ordered, into a file whose name begins with the label.
pub fn around<T>(
    order: &mut Option<CaptureOrder>,
    gpu: &Gpu,
    (frame, label): (usize, &str),
    run: impl FnOnce() -> Result<T>,
) -> Result<T> {
    match order.as_mut().filter(|order| order.frame == frame) {
        Some(order) => order.around(gpu, label, run),
        None => run(),
    }
}
