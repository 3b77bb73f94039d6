//! The main job: methods × frames, once for the clock and once for the truth, into results.

mod flares;
mod folder;
mod measure;
mod pairs;
mod stages;
#[cfg(test)]
mod tests;

use crate::measures::metrics::{FrameImages, MethodErrors};
use crate::measures::stats;
use crate::results::{self, FrameMs, Frames, Results, SCHEMA};
use crate::run::capture::{self, CaptureOrder};
use crate::run::session::Session;
use crate::run::truth::RunTruth;
use crate::run::{Contender, Measured};
pub use folder::{make_folder, ready, write};

use anyhow::Result;
use culling::{Entry, Options, VisibleSets, Work};
use engine::{FrameReport, TimerMode};
use measure::{measure, Followers};
use pairs::Pair;
use stages::{stage_times, stages};
use std::path::PathBuf;
use std::sync::Arc;

/// How a benchmark is run.
pub struct BenchOptions {
    /// Methods and their settings, with unique labels.
    pub methods: Vec<(&'static Entry, Options)>,
    /// Frames run before the clock starts, and before the truth is asked.
    pub warmup: usize,
    /// Measure errors against the truth.
    pub metrics: bool,
    /// Labels of methods whose pictures are compared with each other, the one to compare with first. Needs `metrics`.
    pub pairs: Vec<[String; 2]>,
    /// The frame of each method to capture, if any: as its stages are timed.
    pub capture: Option<CaptureOrder>,
    /// Where visible sets are cached.
    pub cache: Option<PathBuf>,
    /// What was typed, for the results.
    pub command: String,
}

/// Told how far the benchmark is: what it does, steps done, steps in all.
pub type Progress<'a> = &'a mut dyn FnMut(&str, usize, usize);

/// A frame of the untimed pass, as it is measured.
pub struct Seen<'a> {
    /// The method's label.
    pub label: &'a str,
    /// The frame's number, from 0.
    pub frame: usize,
    /// What `none` drew.
    pub truth: &'a FrameImages,
    /// What the method drew, and how far it is from the truth.
    pub measured: &'a Measured,
}

/// Shown every frame that is measured, one method after the other.
pub type Watch<'a> = &'a mut dyn FnMut(Seen<'_>) -> Result<()>;

/// Everything recorded of one method.
#[derive(Default)]
struct Records {
    timed: Vec<FrameReport>,
    /// The same frames once more, with stage timers.
    staged: Vec<FrameReport>,
    /// The frames of the warm-up before those.
    warm: Vec<FrameReport>,
    errors: Vec<crate::measures::metrics::FrameError>,
    /// Pixels outside the raster conditions, by frame.
    thin: Vec<u64>,
    triangles: Vec<u64>,
    draws: Vec<u64>,
    overdraw: Vec<f64>,
    work: Vec<Work>,
    bounds_brought: Vec<u64>,
}

/// Runs the benchmark.
pub fn bench(session: &mut Session, options: BenchOptions, progress: Progress<'_>) -> Result<Results> {
    bench_watched(session, options, progress, &mut |_| Ok(()))
}

/// Runs the benchmark and shows the frames of the untimed pass; without `metrics` there are none.
pub fn bench_watched(
    session: &mut Session,
    mut options: BenchOptions,
    progress: Progress<'_>,
    watch: Watch<'_>,
) -> Result<Results> {
    let shared_mib = session.gpu.memory_mib();
    let truth = make_truth(session, &options, progress)?;
    let mut contenders = Vec::new();
    for (entry, settings) in &options.methods {
        contenders.push(Contender::new(session, entry, settings.clone(), &truth.sets)?);
    }
    let mut records: Vec<Records> = contenders.iter().map(|_| Records::default()).collect();
    time(session, &mut contenders, &mut records, &mut options, progress)?;
    let mut pairs = Pair::of(&options.pairs, &contenders)?;
    if let Some(images) = &truth.run {
        let followers = Followers { pairs: &mut pairs, progress, watch };
        measure(session, &mut contenders, &mut records, images, &options, followers)?;
    }
    let mut methods: Vec<_> =
        contenders.iter().zip(&records).map(|(contender, records)| method(contender, records, shared_mib)).collect();
    for (method, records) in methods.iter_mut().zip(&records) {
        flares::put(method, session.options().flares.as_ref(), &records.work);
    }
    pairs.iter().for_each(|pair| pair.report(&mut methods));
    Ok(Results { methods, ..header(session, &options.command) })
}

struct MadeTruth {
    run: Option<RunTruth>,
    sets: Option<Arc<VisibleSets>>,
}

fn make_truth(session: &mut Session, options: &BenchOptions, progress: Progress<'_>) -> Result<MadeTruth> {
    let (mut done, frames) = (0, session.frames());
    let mut step = || {
        done += 1;
        progress("drawing the truth", done, frames);
    };
    if options.metrics {
        let truth = RunTruth::draw(session, &mut step)?;
        truth.store(session, options.cache.as_deref());
        let sets = Some(truth.sets.clone());
        return Ok(MadeTruth { run: Some(truth), sets });
    }
    let needs_sets = options.methods.iter().any(|(entry, _)| entry.id == "ref");
    let sets =
        if needs_sets { Some(RunTruth::visible_sets(session, options.cache.as_deref(), &mut step)?) } else { None };
    Ok(MadeTruth { run: None, sets })
}

/// Runs the first frames of the path, so that pipelines are compiled and methods have a past when frame 0 comes.
fn warm_up(session: &mut Session, contenders: &mut [Contender], warmup: usize) -> Result<()> {
    for contender in contenders.iter_mut() {
        contender.method.forget()?;
    }
    for frame in 0..warmup {
        for contender in contenders.iter_mut() {
            contender.timed(session, frame % session.frames())?;
        }
    }
    Ok(())
}

/// Begins the same frames once more, with the same decisions.
fn repeat(session: &mut Session, contenders: &mut [Contender], warmup: usize) -> Result<()> {
    contenders.iter_mut().for_each(|contender| contender.method.repeat());
    warm_up(session, contenders, warmup)
}

/// The same, with stage timers: what a stage costs that no measured frame runs is known from these.
fn repeat_staged(
    session: &mut Session,
    contenders: &mut [Contender],
    records: &mut [Records],
    warmup: usize,
) -> Result<()> {
    for contender in contenders.iter_mut() {
        contender.method.repeat();
        contender.method.forget()?;
    }
    for frame in 0..warmup {
        for (contender, records) in contenders.iter_mut().zip(records.iter_mut()) {
            records.warm.push(contender.staged(session, frame % session.frames())?);
        }
    }
    Ok(())
}

fn time(
    session: &mut Session,
    contenders: &mut [Contender],
    records: &mut [Records],
    options: &mut BenchOptions,
    progress: Progress<'_>,
) -> Result<()> {
    let warmup = options.warmup;
    progress("warming up", 0, session.frames());
    warm_up(session, contenders, warmup)?;
    for frame in 0..session.frames() {
        for (contender, records) in contenders.iter_mut().zip(records.iter_mut()) {
            records.timed.push(contender.timed(session, frame)?);
        }
        progress("timing", frame + 1, session.frames());
    }
    repeat_staged(session, contenders, records, warmup)?;
    for frame in 0..session.frames() {
        for (contender, records) in contenders.iter_mut().zip(records.iter_mut()) {
            let label = contender.label();
            let gpu = session.gpu.clone();
            let run = || contender.staged(session, frame);
            records.staged.push(capture::around(&mut options.capture, &gpu, (frame, &label), run)?);
        }
        progress("timing stages", frame + 1, session.frames());
    }
    Ok(())
}

impl Records {
    fn counted(&self, of: fn(&Work) -> u64) -> Vec<u64> {
        self.work.iter().map(of).collect()
    }

    /// Takes over what was measured, and gives back the pictures.
    fn push(&mut self, (measured, thin): (Measured, u64)) -> FrameImages {
        self.thin.push(thin);
        self.triangles.push(measured.drawn.triangles);
        self.draws.push(measured.drawn.draws);
        self.overdraw.push(measured.overdraw);
        self.work.push(measured.work);
        self.bounds_brought.push(measured.bounds_brought);
        self.errors.push(measured.error);
        measured.images
    }
}

fn method(contender: &Contender, records: &Records, shared_mib: f64) -> results::Method {
    let options = contender.options.all().into_iter().map(|(name, value)| (name, value.into())).collect();
    results::Method {
        label: contender.label(),
        method: contender.entry.id.to_owned(),
        options,
        guarantee: contender.guarantee().to_string(),
        device_memory_mib: shared_mib + contender.memory_mib,
        choices: contender.method.choices(),
        ..recorded(records)
    }
}

/// The figures that come from the recorded frames. The name, options and memory of the method stay empty.
fn recorded(records: &Records) -> results::Method {
    let frame_ms: Vec<f64> = records.timed.iter().map(|report| report.frame_ms).collect();
    let host_ms: Vec<f64> = records.timed.iter().map(|report| report.host_ms).collect();
    let mut method = results::Method {
        frame_ms: FrameMs::from_samples(&frame_ms).unwrap_or_default(),
        host_ms: stats::median(&host_ms),
        stages: stages(&records.staged, &records.warm),
        thin_pixels_mean: mean(&records.thin),
        triangles_mean: mean(&records.triangles),
        draws_mean: mean(&records.draws),
        overdraw_mean: stats::mean(&records.overdraw),
        queries_mean: mean(&records.counted(|work| work.queries)),
        state_changes_mean: mean(&records.counted(|work| work.state_changes)),
        waits_mean: mean(&records.counted(|work| work.waits)),
        plane_tests_mean: mean(&records.counted(|work| work.plane_tests)),
        rays_mean: mean(&records.counted(|work| work.rays)),
        boxes_mean: mean(&records.counted(|work| work.boxes)),
        bounds_brought_mean: mean(&records.bounds_brought),
        refits_mean: mean(&records.counted(|work| work.refits)),
        node_visits_mean: mean(&records.counted(|work| work.node_visits)),
        frames: frames(frame_ms, records),
        ..results::Method::default()
    };
    if let Some(errors) = MethodErrors::from_frames(&records.errors) {
        method.set_errors(&errors);
    }
    method
}

fn mean(values: &[u64]) -> f64 {
    stats::mean(&values.iter().map(|value| *value as f64).collect::<Vec<_>>()).unwrap_or(0.0)
}

fn frames(frame_ms: Vec<f64>, records: &Records) -> Frames {
    let of =
        |value: fn(&crate::measures::metrics::FrameError) -> u64| records.errors.iter().map(value).collect::<Vec<_>>();
    Frames {
        frame_ms,
        drawn: of(|error| error.drawn as u64),
        ref_visible: of(|error| error.ref_visible as u64),
        false_negatives: of(|error| error.false_negatives as u64),
        differing_pixels: of(|error| error.differing_pixels as u64),
        tied_pixels: of(|error| error.tied_pixels as u64),
        thin_pixels: records.thin.clone(),
        psnr_db: records.errors.iter().map(|error| error.psnr_db).collect(),
        ssim: records.errors.iter().map(|error| error.ssim).collect(),
        triangles: records.triangles.clone(),
        draws: records.draws.clone(),
        overdraw: records.overdraw.clone(),
        queries: records.counted(|work| work.queries),
        rays: records.counted(|work| work.rays),
        boxes: records.counted(|work| work.boxes),
        node_visits: records.counted(|work| work.node_visits),
        staged_frame_ms: records.staged.iter().map(|report| report.frame_ms).collect(),
        stages: stage_times(&records.staged),
        ..Frames::default()
    }
}

/// What the device lacks of what is used where present, or does without as `--without` asks: it may cost time.
fn lacking(info: &engine::AdapterInfo) -> (String, String) {
    let lacks: Vec<_> = info.optional.iter().filter(|it| !it.present).map(|it| it.name).collect();
    ("lacks".to_owned(), if lacks.is_empty() { "nothing".to_owned() } else { lacks.join(", ") })
}

/// Samples a pixel, where there are several: sizes are in pixels, errors are of samples.
fn samples(session: &Session) -> Option<(String, String)> {
    let samples = session.targets.samples();
    (samples > 1).then(|| ("samples".to_owned(), samples.to_string()))
}

/// Results of a session without methods: what ran, on what.
pub fn header(session: &Session, command: &str) -> Results {
    let info = session.gpu.info();
    let text = |value: fn(&engine::AdapterInfo) -> String| info.map(value).unwrap_or_default();
    let given = session.options();
    Results {
        schema: SCHEMA,
        sightline_version: env!("CARGO_PKG_VERSION").to_owned(),
        command: command.to_owned(),
        device: results::Device {
            name: text(|info| info.name.clone()),
            kind: text(|info| format!("{:?}", info.kind).to_lowercase()),
            driver: text(|info| info.driver.clone()),
            api_version: text(|info| info.api.clone()),
            timer_mode: match session.gpu.timer_mode() {
                TimerMode::Off => TimerMode::Off.to_string(),
                mode => format!("{mode}, in frames of their own; frame times are taken without"),
            },
            depth_format: session.gpu.depth().to_string(),
            details: info.map(lacking).into_iter().chain(samples(session)).collect(),
        },
        scene: results::Scene {
            name: session.scene.name.clone(),
            objects: session.world.total() as u64,
            triangles: session.world.triangles(),
            hash: session.scene_hash(),
            moving_bounds: session.moving_bounds().map_or_else(String::new, |mode| mode.name().to_owned()),
            shading: session.shading().name().to_owned(),
        },
        path: session.path().describe(),
        speed: given.speed,
        seed: given.seed,
        size: given.size,
        frames: session.frames() as u32,
        methods: Vec::new(),
    }
}
