//! A scene under a method, frame by frame: what the window shows, without the window.

use super::controls::{Controls, Show};
use super::pictures::{self, Left, Ran, Warping};
use crate::measures::metrics::{compare, FrameError, FrameImages, Truth};
use crate::pictures::png_out::Picture;
use crate::run::session::{Session, SessionOptions};
use crate::run::truth::draw_all_of;
use crate::run::{Contender, Watched};
use anyhow::{Context, Result};
use culling::{drawn_objects, Entry, Options, View, VisibleSets};
use engine::{Format, Gpu, Image};
use scenes::{Scene, Shot};
use shaders::reload::NewShader;
use std::sync::Arc;

/// One frame in so many is run with stage timers, and its lists are read back: both make it slower. The first is a method's second frame:
/// in its first it knows of none before.
const WATCH_EVERY: u64 = 8;
const WATCHED: u64 = 1;

/// What is known of the method that runs, each as of when it was last measured.
#[derive(Default)]
pub(super) struct Known {
    /// Milliseconds of a frame, and whether nothing slowed it down.
    pub(super) frame_ms: Option<(f64, bool)>,
    /// Each stage and its milliseconds.
    pub(super) stages: Vec<(String, f64)>,
    /// Objects drawn.
    pub(super) drawn: Option<usize>,
    /// Against the truth.
    pub(super) error: Option<FrameError>,
    /// What there is to say of the view.
    pub(super) caption: String,
}

/// A scene under a method.
pub struct Lab {
    pub(super) session: Session,
    methods: Vec<(&'static Entry, Options)>,
    /// Its place among the methods; none: no culling.
    running: Option<(Option<usize>, Contender)>,
    ran: Option<Ran>,
    truth: Option<Truth>,
    warping: Option<Warping>,
    pub(super) known: Known,
    composed: Option<Image>,
    /// Of the method that runs.
    frames: u64,
}

impl Lab {
    /// A scene on a device, in pictures of `options.size`.
    pub fn new(
        gpu: &Gpu,
        scene: Scene,
        options: SessionOptions,
        methods: Vec<(&'static Entry, Options)>,
    ) -> Result<Self> {
        Ok(Lab {
            session: Session::with_scene(gpu, scene, options)?,
            methods,
            running: None,
            ran: None,
            truth: None,
            warping: None,
            known: Known::default(),
            composed: None,
            frames: 0,
        })
    }

    /// Gives everything on the device back, and the scene.
    pub fn into_scene(self) -> Scene {
        self.session.scene
    }

    /// Draws in another size from now on.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        if size != self.session.options().size {
            self.session.resize(size)?;
            // Lists of another size are no longer those of this picture.
            (self.ran, self.truth, self.warping, self.composed) = (None, None, None, None);
        }
        Ok(())
    }

    /// The camera jumps: what the method knows of earlier frames is forgotten.
    pub fn forget(&mut self) -> Result<()> {
        self.warping = None;
        Ok(self.running.as_mut().map_or(Ok(()), |(_, contender)| contender.method.forget())?)
    }

    /// Draws with these shaders from now on. On an error all stay as they were.
    pub fn replace_shaders(&mut self, new: &[NewShader]) -> Result<()> {
        self.session.gpu.replace_shaders(new)?;
        // A method before a still camera would leave its stages out.
        self.forget()
    }

    /// The method that runs, by its label.
    pub fn label(&self) -> String {
        self.running.as_ref().map_or(String::new(), |(_, contender)| contender.label())
    }

    /// What there is to say of the view that the last frame showed: what its colours mean, and figures; of the plain picture nothing.
    pub fn caption(&self) -> &str {
        &self.known.caption
    }

    /// The method that runs.
    pub(super) fn contender(&self) -> Option<&Contender> {
        self.running.as_ref().map(|(_, contender)| contender)
    }

    /// What views are made of.
    fn left(&mut self) -> Left<'_> {
        Left {
            session: &mut self.session,
            contender: self.running.as_ref().map(|(_, contender)| contender),
            ran: self.ran.as_ref(),
            truth: self.truth.as_ref(),
            warping: &mut self.warping,
            caption: &mut self.known.caption,
        }
    }

    /// Draws one frame as the controls have it; [`Lab::picture`] is then what to show.
    pub fn frame(&mut self, controls: &Controls, shot: &Shot) -> Result<()> {
        let frozen = if controls.frozen { self.ran.as_ref().map(|ran| ran.view) } else { None };
        self.known.caption.clear();
        let composed = match frozen {
            Some(seen) => Some(self.frozen_frame(controls, shot, &seen)?),
            None => self.live_frame(controls, shot)?,
        };
        match composed {
            Some(picture) => self.compose(&picture)?,
            None => self.composed = None,
        }
        self.frames += 1;
        Ok(())
    }

    /// What the last frame is to show.
    pub fn picture(&self) -> &Image {
        self.composed.as_ref().unwrap_or(self.session.targets.colour())
    }

    /// The method draws what it does not cull. None: the picture is on the device as it is to be shown.
    fn live_frame(&mut self, controls: &Controls, shot: &Shot) -> Result<Option<Picture>> {
        let view = self.session.look_through(shot, 0)?;
        let needs_truth = controls.truth || controls.show == Show::FalsePositives;
        self.ready(controls, &view)?;
        if let (Some((_, contender)), true) = (&mut self.running, self.session.options().flares.is_some()) {
            // What is compared is the picture below a lens flare.
            contender.method.count_work(needs_truth);
        }
        let plain = controls.show == Show::Colour && !needs_truth;
        let watched = match (plain, self.frames % WATCH_EVERY) {
            (false, _) => Watched::Items,
            (true, WATCHED) => Watched::Stages,
            (true, _) => Watched::Nothing,
        };
        self.run(&view, watched)?;
        if plain {
            self.truth = None;
            self.known.error = None;
            return Ok(None);
        }
        let images = self.session.targets.read()?;
        let picture = pictures::of(&mut self.left(), controls, &view, &images)?;
        if needs_truth {
            self.compare(&view, &images)?;
        } else {
            (self.truth, self.known.error) = (None, None);
        }
        let picture = match controls.show {
            Show::FalsePositives => pictures::false_positives(&mut self.left(), &view, &images),
            _ => picture,
        };
        Ok(Some(picture))
    }

    /// The lists that were drawn through `seen`, drawn again as the eye sees them, and what `seen` covers in lines.
    fn frozen_frame(&mut self, controls: &Controls, shot: &Shot, seen: &View) -> Result<Picture> {
        // Objects stay where they were when culling was frozen.
        let eye = View::new(shot, self.session.options().size, 0, self.session.gpu.snap_px());
        let target = self.session.targets.with_items();
        let ran = self.ran.as_ref().context("nothing was drawn yet")?;
        let mut f = self.session.gpu.frame();
        f.clear(&target);
        self.session.world.draw_again(&mut f, &ran.report.draws, &eye, &target);
        f.finish().context("drawing frozen lists")?;
        let images = self.session.targets.read()?;
        let mut picture = match controls.show {
            Show::FalsePositives => pictures::false_positives(&mut self.left(), &eye, &images),
            _ => pictures::of(&mut self.left(), controls, &eye, &images)?,
        };
        crate::pictures::boxes_view::draw_view(&mut picture, &self.session, &eye, seen);
        Ok(picture)
    }

    /// Makes the method that the controls ask for, if it is another one. `ref` is made anew for each view: it has to know beforehand
    /// what that shows.
    fn ready(&mut self, controls: &Controls, view: &View) -> Result<()> {
        let wanted = controls.culling.then_some(controls.method);
        let (entry, options) = match wanted.and_then(|method| self.methods.get(method)) {
            Some((entry, options)) => (*entry, options.clone()),
            None => {
                let none = culling::find("none")?;
                (none, none.default_options())
            }
        };
        let is_ideal = entry.id == "ref";
        let there = self.running.as_ref().is_some_and(|(place, _)| *place == wanted);
        if there && !is_ideal {
            return Ok(());
        }
        let visible = if is_ideal {
            let mut sets = VisibleSets::new(self.session.world.total());
            sets.push_items(&draw_all_of(&self.session, view)?.visible_items());
            Some(Arc::new(sets))
        } else {
            None
        };
        if !there {
            (self.known, self.frames) = (Known::default(), 0);
        }
        // The one before gives its memory back first.
        (self.running, self.ran) = (None, None);
        let contender = Contender::new(&self.session, entry, options, &visible)?;
        self.running = Some((wanted, contender));
        Ok(())
    }

    fn run(&mut self, view: &View, watched: Watched) -> Result<()> {
        let (_, contender) = self.running.as_mut().context("no method runs")?;
        let report = contender.run(&self.session, view, watched)?;
        self.known.frame_ms = match (watched, self.known.frame_ms) {
            (Watched::Stages, Some(known)) => Some(known),
            _ => Some((report.frame_ms, watched == Watched::Nothing)),
        };
        let mut drawn = None;
        if watched != Watched::Nothing {
            self.known.stages = report.stages.iter().map(|stage| (stage.label.clone(), stage.ms)).collect();
            let found = drawn_objects(&self.session.gpu, &self.session.world, &report)?;
            self.known.drawn = Some(found.objects.iter().filter(|drawn| **drawn).count());
            drawn = Some(found);
        }
        self.ran = Some(Ran { view: *view, report, drawn });
        Ok(())
    }

    fn compare(&mut self, view: &View, images: &FrameImages) -> Result<()> {
        let truth =
            Truth::new(draw_all_of(&self.session, view).context("drawing the truth")?, self.session.world.total())?;
        let drawn = self.ran.as_ref().and_then(|ran| ran.drawn.as_ref()).context("what was drawn is not known")?;
        self.known.error = Some(compare(&truth, images, &drawn.objects)?);
        self.truth = Some(truth);
        Ok(())
    }

    fn compose(&mut self, picture: &Picture) -> Result<()> {
        let size = [picture.width, picture.height];
        let fitting = self.composed.take().filter(|image| image.size() == size);
        let mut image = match fitting {
            Some(image) => image,
            None => Image::new(&self.session.gpu, "view.composed", Format::Colour, size)?,
        };
        let pixels: Vec<[u8; 4]> = picture.pixels.iter().map(|&[red, green, blue]| [red, green, blue, 255]).collect();
        image.write(&pixels)?;
        self.composed = Some(image);
        Ok(())
    }
}

/// True if the device stopped answering.
pub(super) fn is_lost(error: &anyhow::Error) -> bool {
    let lost = |error: &engine::Error| matches!(error, engine::Error::DeviceLost { .. });
    error.chain().any(|cause| {
        cause.downcast_ref::<engine::Error>().is_some_and(lost)
            || matches!(cause.downcast_ref::<culling::Error>(), Some(culling::Error::Engine(inner)) if lost(inner))
    })
}
