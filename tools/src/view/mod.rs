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
mod saved;
mod text;

use crate::cli::{parse_methods, ViewArgs};
use anyhow::{anyhow, Context, Result};
use app::App;
use std::time::Duration;
use winit::event_loop::EventLoop;

/// Seconds that pass in a frame of a run that nobody watches.
const SCRIPTED_FRAME_S: f64 = 1.0 / 60.0;
/// The longest that a slow frame may carry the camera on.
const LONGEST_STEP: Duration = Duration::from_millis(250);

/// Opens the window and stays until it is closed.
///
/// # Errors
/// No display, a device that shows nothing on it, or a scene or method that fails.
pub fn run(arguments: &ViewArgs) -> Result<()> {
    let methods = parse_methods(&arguments.methods.method, &arguments.methods.sets())?;
    let script = keys::parse_steps(arguments.keys.as_deref().unwrap_or(""))?;
    let options = arguments.scene.session()?;
    let scene_options = scenes::SceneOptions { scale: options.scale, seed: options.seed, detail: options.detail };
    let event_loop = event_loop()?;
    let scene = scenes::open(&options.scene, &scene_options)?;
    let mut app = App::new(arguments, options, scene, methods, script);
    event_loop.run_app(&mut app).context("the window system stopped")?;
    app.outcome()
}

/// The connection to the window system.
fn event_loop() -> Result<EventLoop<()>> {
    let remedy =
        "run it on a desktop, or as `xvfb-run -a sightline view ...`, or use `sightline shot`, which needs none";
    let there = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    if cfg!(target_os = "linux") && !there("DISPLAY") && !there("WAYLAND_DISPLAY") && !there("WAYLAND_SOCKET") {
        return Err(anyhow!("no display: neither DISPLAY nor WAYLAND_DISPLAY is set; {remedy}"));
    }
    EventLoop::new().map_err(|error| {
        // Only its last words: before them it names a line of the library's source.
        let words = error.to_string();
        anyhow!("no display ({}); {remedy}", words.rsplit(": ").next().unwrap_or_default().trim())
    })
}
