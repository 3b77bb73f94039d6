//! `sightline view`: a window in which a scene is flown through under any method.
//!
//! What keys and mouse change is plain data ([`controls`], [`camera`]), what is drawn needs no window ([`lab`]), and only `app` knows
//! the window system.

mod app;
pub mod camera;
pub mod controls;
mod hud;
pub mod keys;
pub mod lab;
mod pictures;
mod reload;
mod saved;
mod text;

use crate::results::files::{check_file, check_folder};
use crate::run::bench::make_folder;
use crate::run::capture::CaptureOrder;
use crate::run::session::SessionOptions;
use anyhow::{anyhow, bail, Context, Result};
use app::App;
use culling::{Entry, Options};
use engine::GpuOptions;
use std::path::PathBuf;
use std::time::Duration;
use winit::event_loop::EventLoop;

/// Seconds that pass in a frame of a run that nobody watches.
const SCRIPTED_FRAME_S: f64 = 1.0 / 60.0;
/// The longest that a slow frame may carry the camera on.
const LONGEST_STEP: Duration = Duration::from_millis(250);

/// No window system here knows a wider or higher window: X11 counts pixels in 16 bits with a sign, and winit panics at more.
const LARGEST_SIDE: u32 = 32767;

/// Can a window have this size?
fn check_size(size: [u32; 2]) -> Result<()> {
    let [width, height] = size;
    if width.min(height) == 0 || width.max(height) > LARGEST_SIDE {
        bail!("{width}x{height}: a window has at most {LARGEST_SIDE} pixels a side, and at least 1");
    }
    Ok(())
}

/// What a window is opened with.
#[derive(Clone, Debug)]
pub struct ViewOptions {
    /// Scene, path, frames, and the window's first size.
    pub session: SessionOptions,
    /// The first device.
    pub gpu: GpuOptions,
    /// Methods in the order of the Tab key.
    pub methods: Vec<(&'static Entry, Options)>,
    /// Keys that press themselves, one step a frame; the window closes after the session's frames.
    pub keys: Option<Vec<keys::Step>>,
    /// Where to keep what is shown in the last frame; the window closes after it.
    pub screenshot: Option<PathBuf>,
    /// The frame of the window to capture with RenderDoc.
    pub capture: Option<usize>,
    /// Folder of what keys save.
    pub out: PathBuf,
}

impl ViewOptions {
    /// True if nobody watches: time goes on evenly, and the window closes by itself.
    fn is_scripted(&self) -> bool {
        self.keys.is_some() || self.screenshot.is_some()
    }
}

/// Opens the window and stays until it is closed.
///
/// # Errors
/// No display, a device that shows nothing on it, or a scene or method that fails.
pub fn run(wish: ViewOptions) -> Result<()> {
    let options = &wish.session;
    let scene_options = scenes::SceneOptions { scale: options.scale, seed: options.seed, detail: options.detail };
    check_size(options.size).context("--size")?;
    check_places(&wish)?;
    let event_loop = event_loop()?;
    let scene = scenes::open(&options.scene, &scene_options)?;
    if wish.is_scripted() && wish.capture.is_some_and(|frame| frame >= wish.session.frames) {
        bail!("--capture: the window has only {} frames, counted from 0", wish.session.frames);
    }
    let order = wish.capture.map(|frame| {
        make_folder(&wish.out)?;
        CaptureOrder::new(frame, &wish.out)
    });
    let mut app = App::new(wish, scene, order.transpose()?);
    event_loop.run_app(&mut app).context("the window system stopped")?;
    app.outcome()
}

/// Checks before the window opens that pictures and paths can be saved.
fn check_places(wish: &ViewOptions) -> Result<()> {
    check_folder(&wish.out)?;
    let Some(file) = &wish.screenshot else { return Ok(()) };
    match file.parent().filter(|parent| !parent.as_os_str().is_empty() && !parent.is_dir()) {
        // The folder will be made.
        Some(parent) => Ok(check_folder(parent)?),
        None => Ok(check_file(file)?),
    }
}

/// The connection to the window system.
fn event_loop() -> Result<EventLoop<()>> {
    let remedy =
        "run it on a desktop, or as `xvfb-run -a sightline view ...`, or use `sightline shot`, which needs none";
    let there = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !there("DISPLAY") && !there("WAYLAND_DISPLAY") && !there("WAYLAND_SOCKET") {
        return Err(anyhow!("no display: neither DISPLAY nor WAYLAND_DISPLAY is set; {remedy}"));
    }
    if !there("XDG_RUNTIME_DIR") {
        // Mesa's layer that sorts devices asks Wayland too, whose library then prints an error that concerns nobody.
        std::env::set_var("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
    EventLoop::new().map_err(|error| {
        // Only its last words: before them it names a line of the library's source.
        let words = error.to_string();
        anyhow!("no display ({}); {remedy}", words.rsplit(": ").next().unwrap_or_default().trim())
    })
}
