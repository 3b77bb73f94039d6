//! The program while its window is open: its device, its frames, and what keys ask of it.

mod events;

use super::camera::FlyCamera;
use super::controls::{Command, Controls};
use super::keys::{Input, Step};
use super::lab::{is_lost, Lab};
use super::reload::HotShaders;
use super::text::Text;
use super::ViewOptions;
use super::{hud, saved, LONGEST_STEP, SCRIPTED_FRAME_S};
use crate::results::output::{one_line, say};
use crate::run::capture::{self, CaptureOrder};
use crate::run::session::SessionOptions;
use anyhow::{anyhow, Context, Result};
use engine::{Format, Gpu, GpuOptions, Image, Panel, Shown};
use scenes::{CameraPath, Scene, Shot};
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::dpi::PhysicalSize;
use winit::event_loop::ActiveEventLoop;
use winit::window::Window;

/// Pixels between the window's edge and the text.
const MARGIN: u32 = 8;
/// What is said where the window is there no more.
const TAKEN_AWAY: &str = "the window system took the window away";

/// The device, and what is shown with it. The window's images go first.
struct Stage {
    shown: engine::Window<Arc<Window>>,
    lab: Lab,
}

/// The program while its window is open.
pub struct App {
    wish: ViewOptions,
    capture: Option<CaptureOrder>,
    script: VecDeque<Step>,
    /// Until it is on a device.
    scene: Option<Scene>,
    stage: Option<Stage>,
    window: Option<Arc<Window>>,
    controls: Option<Controls>,
    hot_shaders: HotShaders,
    path_frame: usize,
    seconds: f64,
    recorded: Vec<Shot>,
    told: String,
    dragging: bool,
    /// The window's size in pixels, as it last said.
    inner_size: [u32; 2],
    out_of_sight: bool,
    rests: bool,
    last: Option<Instant>,
    frames: u32,
    waits: u32,
    recovering: bool,
    failed: Option<anyhow::Error>,
}

impl App {
    /// A program whose window is not open yet.
    pub fn new(wish: ViewOptions, scene: Scene, capture: Option<CaptureOrder>) -> Self {
        App {
            script: wish.keys.clone().unwrap_or_default().into(),
            wish,
            capture,
            scene: Some(scene),
            stage: None,
            window: None,
            controls: None,
            hot_shaders: HotShaders::default(),
            path_frame: 0,
            seconds: 0.0,
            recorded: Vec::new(),
            told: String::new(),
            dragging: false,
            inner_size: [0; 2],
            out_of_sight: false,
            rests: false,
            last: None,
            frames: 0,
            waits: 0,
            recovering: false,
            failed: None,
        }
    }

    /// What became of it, once everything is given back.
    pub fn outcome(mut self) -> Result<()> {
        let gone = self.give_back();
        self.failed.map_or(gone, Err)
    }

    /// Frees what lies on the device. What the validation layer says of that is an error.
    fn give_back(&mut self) -> Result<()> {
        let Some(Stage { shown, lab }) = self.stage.take() else { return Ok(()) };
        let gpu = lab.session.gpu.clone();
        self.scene = Some(lab.into_scene());
        drop(shown);
        match gpu.take_messages().into_iter().next() {
            None => Ok(()),
            Some(message) => Err(anyhow!("validation, closing the window: {}", message.text)),
        }
    }

    fn open(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        let [width, height] = self.wish.session.size;
        let attributes = Window::default_attributes()
            .with_title(format!("sightline: {}", one_line(&self.wish.session.scene.to_string_lossy())))
            .with_inner_size(PhysicalSize::new(width, height));
        let window = event_loop.create_window(attributes).context("the window system gives no window")?;
        self.inner_size = window.inner_size().into();
        self.window = Some(Arc::new(window));
        self.start(self.wish.gpu.clone())
    }

    /// Opens a device and puts the scene on it.
    fn start(&mut self, options: GpuOptions) -> Result<()> {
        let window = self.window.clone().context("there is no window")?;
        let gpu = Gpu::open(&GpuOptions { windows: true, ..options })?;
        let mut shown = engine::Window::new(&gpu, window.clone())?;
        let wanted = self.inner_size;
        let size = shown.size(wanted)?.unwrap_or(self.wish.session.size);
        let mut black = Image::new(&gpu, "view.black", Format::Colour, size)?;
        black.write(&vec![[0; 4]; (size[0] * size[1]) as usize])?;
        let loading = Text::of(&["loading ...".to_owned()], self.scale());
        let panels: Vec<Panel<'_>> = loading.iter().map(|text| panel(text, [MARGIN; 2])).collect();
        shown.show(&black, &panels, wanted)?;
        let scene = self.scene.take().context("the scene is gone")?;
        let options = SessionOptions { size, ..self.wish.session.clone() };
        let mut lab = Lab::new(&gpu, scene, options, self.wish.methods.clone())?;
        self.hot_shaders.put_on(&mut lab)?;
        if self.controls.is_none() {
            let first = lab.session.path().sample(0, lab.session.frames());
            self.seconds = first.seconds;
            self.controls =
                Some(Controls::new(FlyCamera::new(&lab.session.scene, &first.pose), self.wish.methods.len()));
        }
        self.stage = Some(Stage { shown, lab });
        Ok(())
    }

    /// Gives the device back and goes on with another one, or the same anew.
    fn change_device(&mut self, device: Option<String>) -> Result<()> {
        self.give_back()?;
        let options = self.wish.gpu.clone();
        self.start(GpuOptions { device: device.or(options.device.clone()), ..options })
    }

    fn next_device(&mut self) -> Result<()> {
        let found: Vec<String> = engine::adapters()?.into_iter().map(|info| info.name).collect();
        let stage = self.stage.as_ref().context("there is no device")?;
        let now = stage.lab.session.gpu.info().map(|info| info.name.clone());
        let place = found.iter().position(|name| Some(name) == now.as_ref()).unwrap_or(0);
        let next = (place + 1) % found.len().max(1);
        self.change_device(Some(next.to_string()))?;
        self.tell(match found.len() {
            1 => "there is one device: opened anew".to_owned(),
            _ => format!("on {}", found[next]),
        })
    }

    fn tell(&mut self, text: String) -> Result<()> {
        say(&text)?;
        self.told = text;
        Ok(())
    }

    /// Reports a saved file. A full disk does not close a window that someone watches.
    fn tell_saved(&mut self, saved: Result<String>) -> Result<()> {
        match saved {
            Err(error) if !self.wish.is_scripted() => self.tell(format!("{error:#}")),
            saved => self.tell(saved?),
        }
    }

    /// One frame: the next step of the script, the camera, the picture, and the window.
    fn frame(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        self.next_step(event_loop)?;
        let scripted = self.wish.is_scripted();
        let (Some(stage), Some(controls), Some(window)) = (&mut self.stage, &mut self.controls, &self.window) else {
            return Ok(());
        };
        let now = Instant::now();
        let passed = self.last.replace(now).map_or(Duration::ZERO, |last| now - last);
        let step = if scripted { SCRIPTED_FRAME_S } else { passed.min(LONGEST_STEP).as_secs_f64() };
        controls.fly(step);
        if !controls.frozen {
            self.seconds += step;
        }
        let wanted = self.inner_size;
        let Some(size) = stage.shown.size(wanted).map_err(taken_away)? else {
            self.rests = true;
            return self.count(event_loop);
        };
        stage.lab.resize(size)?;
        let shot = next_shot(&mut stage.lab, controls, &mut self.path_frame, &mut self.seconds)?;
        if controls.recording {
            self.recorded.push(shot);
        }
        let gpu = stage.lab.session.gpu.clone();
        let lab = &mut stage.lab;
        capture::around(&mut self.capture, &gpu, (self.frames as usize, "view"), || lab.frame(controls, &shot))?;
        let texts = texts(&stage.lab, controls, &self.told, size, window.scale_factor());
        let panels: Vec<Panel<'_>> = texts.iter().map(|(text, at)| panel(text, *at)).collect();
        let shown = stage.shown.show(stage.lab.picture(), &panels, wanted).map_err(taken_away)?;
        self.rests = shown != Shown::Yes;
        self.count(event_loop)
    }

    /// Counts a frame; a run that nobody watches ends with its last one.
    fn count(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        self.frames += 1;
        if self.wish.is_scripted() && self.frames as usize >= self.wish.session.frames {
            if !self.script.is_empty() {
                return Err(anyhow!(
                    "--keys: {} steps were left after {} frames; give more --frames",
                    self.script.len(),
                    self.frames
                ));
            }
            if let Some(file) = self.wish.screenshot.clone() {
                self.screenshot(Some(&file))?;
            }
            event_loop.exit();
        }
        Ok(())
    }

    fn next_step(&mut self, event_loop: &ActiveEventLoop) -> Result<()> {
        if self.waits > 0 {
            self.waits -= 1;
            return Ok(());
        }
        match (self.script.pop_front(), &self.window) {
            (None, _) | (_, None) => {}
            (Some(Step::Inputs(inputs)), _) => {
                for input in inputs {
                    self.input(input, event_loop)?;
                }
            }
            (Some(Step::Wait(frames)), _) => self.waits = frames.saturating_sub(1),
            (Some(Step::Resize([width, height])), Some(window)) => {
                // A window system that does it at once says so, another one later, by an event.
                let _ = window.request_inner_size(PhysicalSize::new(width, height));
            }
            (Some(Step::Minimise(on)), Some(window)) => window.set_minimized(on),
            (Some(Step::Surface), _) => {
                self.stage.as_mut().map_or(Ok(()), |stage| stage.shown.make_surface_again())?;
            }
            (Some(Step::Screenshot(name)), _) => {
                let file = self.wish.out.join(name);
                self.screenshot(Some(&file))?;
            }
        }
        Ok(())
    }

    fn input(&mut self, input: Input, event_loop: &ActiveEventLoop) -> Result<()> {
        let Some(controls) = &mut self.controls else { return Ok(()) };
        if matches!(input, Input::Down(_)) {
            self.told.clear();
        }
        match controls.handle(input) {
            None => Ok(()),
            Some(Command::Quit) => {
                event_loop.exit();
                Ok(())
            }
            Some(Command::Screenshot) => self.screenshot(None),
            Some(Command::ReloadShaders) => {
                let stage = self.stage.as_mut().context("there is no device yet")?;
                let told = self.hot_shaders.reload(&mut stage.lab)?;
                self.tell(told)
            }
            Some(Command::NextDevice) => self.next_device(),
            Some(Command::SaveCamera) => {
                let stage = self.stage.as_ref().context("there is no scene yet")?;
                let shot = flown(&stage.lab, controls, self.path_frame, self.seconds);
                let file = saved::path(&self.wish.out, "camera", &[shot]);
                self.tell_saved(file.map(|file| format!("{}: give it to --path", file.display())))
            }
            Some(Command::SaveRecording) => {
                let shots = std::mem::take(&mut self.recorded);
                if shots.is_empty() {
                    return self.tell("nothing was recorded".to_owned());
                }
                let (saved, frames) = (saved::path(&self.wish.out, "recording", &shots), shots.len());
                if saved.is_err() {
                    // The recording can be saved again once there is room.
                    self.recorded = shots;
                }
                let told = |file: PathBuf| {
                    format!("{}: {frames} frames; give it to --path, with --frames {frames}", file.display())
                };
                self.tell_saved(saved.map(told))
            }
        }
    }

    fn screenshot(&mut self, name: Option<&Path>) -> Result<()> {
        let stage = self.stage.as_ref().context("nothing is shown yet")?;
        let file = saved::screenshot(&self.wish.out, name, stage.shown.read_shown()?);
        self.tell_saved(file.map(|file| file.display().to_string()))
    }

    fn scale(&self) -> u32 {
        self.window.as_ref().map_or(1, |window| text_scale(window.scale_factor()))
    }

    /// A device that was lost is opened anew, once; any other error ends the program.
    fn settle(&mut self, done: Result<()>, event_loop: &ActiveEventLoop) {
        let done = match done {
            Err(error) if is_lost(&error) && !self.recovering => {
                self.recovering = true;
                tracing::warn!("{error:#}; it is opened anew");
                self.change_device(None)
            }
            Ok(()) => {
                self.recovering = false;
                Ok(())
            }
            Err(error) => Err(error),
        };
        if let Err(error) = done {
            self.failed.get_or_insert(error);
            event_loop.exit();
        }
    }
}

/// A window that took pictures takes no more: another program destroyed it, of which the event may still be on its way.
fn taken_away(error: engine::Error) -> anyhow::Error {
    match error {
        engine::Error::Window { .. } => anyhow!(TAKEN_AWAY),
        error => error.into(),
    }
}

/// The camera as it is flown: with the path's lens.
fn flown(lab: &Lab, controls: &Controls, path_frame: usize, seconds: f64) -> Shot {
    let path: &CameraPath = lab.session.path();
    let on_path = path.sample(path_frame, lab.session.frames());
    if controls.playing {
        return on_path;
    }
    Shot { pose: controls.camera.pose(), seconds, ..on_path }
}

/// The camera of this frame; where the path leads, the hand-flown one goes along.
fn next_shot(lab: &mut Lab, controls: &mut Controls, path_frame: &mut usize, seconds: &mut f64) -> Result<Shot> {
    let shot = flown(lab, controls, *path_frame, *seconds);
    if controls.playing {
        controls.camera.take(&shot.pose);
        *seconds = shot.seconds;
        *path_frame += 1;
        if *path_frame == lab.session.frames() {
            *path_frame = 0;
            lab.forget()?;
        }
    }
    Ok(shot)
}

fn text_scale(window: f64) -> u32 {
    window.round().clamp(1.0, 4.0) as u32
}

/// All text, and where it stands: what runs above, stages below on the left, keys below on the right.
fn texts(lab: &Lab, controls: &Controls, told: &str, size: [u32; 2], scale: f64) -> Vec<(Text, [u32; 2])> {
    let scale = text_scale(scale);
    let below = |text: &Text| size[1].saturating_sub(text.size[1] + MARGIN);
    let mut texts: Vec<(Text, [u32; 2])> = Vec::new();
    let help = Text::of(&hud::help(), scale).filter(|_| controls.help);
    // Where they do not fit side by side, stages are there once the keys are hidden: half of their names would tell nothing.
    let beside = |text: &Text| help.as_ref().is_none_or(|help| text.size[0] + help.size[0] + 3 * MARGIN <= size[0]);
    if let Some(text) = Text::of(&hud::stages(lab), scale).filter(beside) {
        let at = [MARGIN, below(&text)];
        texts.push((text, at));
    }
    if let Some(text) = help {
        let at = [size[0].saturating_sub(text.size[0] + MARGIN), below(&text)];
        texts.push((text, at));
    }
    // Last, so that in a small window it lies over the others.
    let letters = Text::letters(size[0].saturating_sub(2 * MARGIN), scale);
    texts.extend(Text::of(&hud::state(lab, controls, told, letters), scale).map(|text| (text, [MARGIN; 2])));
    texts
}

fn panel(text: &Text, at: [u32; 2]) -> Panel<'_> {
    Panel { at, size: text.size, pixels: &text.pixels }
}
