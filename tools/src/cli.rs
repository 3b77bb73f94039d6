//! The command line.

use crate::session::SessionOptions;
use anyhow::{bail, Context, Result};
use clap::{Args, Parser, Subcommand, ValueEnum};
use culling::{Entry, Options, METHODS};
use engine::{GpuOptions, TimerMode};
use std::path::PathBuf;

/// A laboratory for indirect-draw occlusion culling: pick a scene, a camera path and methods; see run time against error,
/// stage by stage, against the truth.
#[derive(Debug, Parser)]
#[command(
    name = "sightline",
    version,
    max_term_width = 100,
    after_help = "Start with:\n  sightline bench --scale 0.1\n  sightline bench --scene model.glb --method none,hzb --frames 60\n  sightline shot --method hzb --view overdraw --out overdraw.png"
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Runs methods over a camera path: times, errors against the truth, stage by stage; writes results.json and results.csv
    #[command(after_help = BENCH_HELP)]
    Bench(BenchArgs),
    /// Renders one frame to a PNG: colour, depth, item buffer or overdraw
    Shot(ShotArgs),
    /// Lists scenes; shows or exports one with its camera path
    Scene(SceneArgs),
    /// Lists devices, and says what the chosen one has and lacks
    Info(DeviceArgs),
}

const BENCH_HELP: &str = "Methods may carry options: --method 'none,hzb,hzb[texels=8]', or --set hzb.texels=8 for all of that name.\n\
    Times are interleaved (A B C A B C ...) after warm-up; errors come from a second, untimed pass over the same frames.";

/// Which device, and how it is watched.
#[derive(Args, Clone, Debug)]
pub struct DeviceArgs {
    /// Device index or part of its name (see `sightline info`); the best one if left out
    #[arg(long, value_name = "NAME|INDEX")]
    pub device: Option<String>,
    /// Turn on the validation layer with synchronization validation; any message stops the run. Times then mean little
    #[arg(long)]
    pub validation: bool,
    /// How stages are timed; decided by a self-check if left out
    #[arg(long, value_name = "MODE")]
    pub timer: Option<TimerChoice>,
    /// Put a barrier before every stage, to tell a missing barrier from another fault
    #[arg(long)]
    pub barrier_every_stage: bool,
}

/// How stages are kept apart in time.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TimerChoice {
    /// A timestamp after each stage
    Plain,
    /// A timestamp and a full barrier after each stage
    Split,
}

/// Which scene, path and picture size.
#[derive(Args, Clone, Debug)]
pub struct SceneChoice {
    /// Scene name (see `sightline scene list`), or a .glb or .gltf file
    #[arg(long, value_name = "NAME|FILE", default_value = "city-block")]
    pub scene: String,
    /// Objects of a procedural scene, as a multiple of its standard number
    #[arg(long, value_name = "F", default_value_t = 0.25)]
    pub scale: f64,
    /// Seed of a procedural scene
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Camera path: walk, pan, zoom, rotate, closing-in, still, the scene's own `camera`, or a recorded .json file
    #[arg(long, value_name = "NAME|FILE")]
    pub path: Option<String>,
    /// How fast the camera goes: at 1, a frame is 1/960 of the path's way (16 s at 60 Hz)
    #[arg(long, value_name = "F", default_value_t = 1.0)]
    pub speed: f64,
    /// Spread the path's whole way over the run, however few frames that has
    #[arg(long)]
    pub whole_path: bool,
    /// Frames of the run
    #[arg(long, value_name = "N", default_value_t = 30, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: u32,
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = parse_size)]
    pub size: [u32; 2],
}

/// Which methods.
#[derive(Args, Clone, Debug)]
pub struct MethodChoice {
    /// Methods, separated by commas, or `all`
    #[arg(long, value_name = "A,B,C|all", default_value = "all")]
    pub method: String,
    /// Sets a method's option; may be given several times
    #[arg(long, value_name = "METHOD.OPTION=VALUE")]
    pub set: Vec<String>,
}

/// `sightline bench`.
#[derive(Args, Clone, Debug)]
pub struct BenchArgs {
    /// Scene, path and size.
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Methods and options.
    #[command(flatten)]
    pub methods: MethodChoice,
    /// Device.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Frames run before the clock starts
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub warmup: u32,
    /// Only times: leave out the truth, the errors and the pictures' measures
    #[arg(long)]
    pub no_metrics: bool,
    /// Captures this frame of each method with RenderDoc
    #[arg(long, value_name = "FRAME")]
    pub capture: Option<usize>,
    /// Prints each stage: ran or skipped, why, and its time
    #[arg(long)]
    pub explain: bool,
    /// Folder for results.json and results.csv
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Prints results.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// What a shot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Show {
    /// The picture
    Colour,
    /// Depth as grey: near is bright
    Depth,
    /// One colour an object
    Items,
    /// How often each pixel was shaded
    Overdraw,
}

/// `sightline shot`.
#[derive(Args, Clone, Debug)]
pub struct ShotArgs {
    /// Scene, path and size.
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Device.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// The method that draws it
    #[arg(long, value_name = "METHOD", default_value = "none")]
    pub method: String,
    /// Sets the method's option; may be given several times
    #[arg(long, value_name = "METHOD.OPTION=VALUE")]
    pub set: Vec<String>,
    /// The frame of the run
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub frame: usize,
    /// What to show
    #[arg(long, value_name = "VIEW", default_value = "colour")]
    pub view: Show,
    /// The PNG file
    #[arg(long, value_name = "FILE", default_value = "out/shot.png")]
    pub out: PathBuf,
}

/// `sightline scene`.
#[derive(Args, Clone, Debug)]
pub struct SceneArgs {
    /// What to do with it; `list` if left out
    #[command(subcommand)]
    pub action: Option<SceneAction>,
}

/// What to do with a scene.
#[derive(Clone, Debug, Subcommand)]
pub enum SceneAction {
    /// Lists the procedural scenes
    List,
    /// Says what a scene holds
    Show(SceneChoice),
    /// Writes a scene and its camera path as a .glb file that reads back identical
    Export {
        /// Scene and path.
        #[command(flatten)]
        scene: SceneChoice,
        /// The .glb file
        #[arg(long, value_name = "FILE")]
        out: PathBuf,
    },
}

impl SceneChoice {
    /// As a session takes it.
    pub fn session(&self) -> SessionOptions {
        SessionOptions {
            scene: self.scene.clone(),
            scale: self.scale,
            seed: self.seed,
            path: self.path.clone(),
            speed: self.speed,
            whole_path: self.whole_path,
            frames: self.frames as usize,
            size: self.size,
        }
    }
}

impl DeviceArgs {
    /// As the engine takes it.
    pub fn gpu(&self) -> GpuOptions {
        GpuOptions {
            device: self.device.clone(),
            validation: self.validation,
            timer: self.timer.map(|choice| match choice {
                TimerChoice::Plain => TimerMode::Plain,
                TimerChoice::Split => TimerMode::Split,
            }),
            cache_dir: crate::session::cache_folder(),
            barrier_every_stage: self.barrier_every_stage,
        }
    }
}

fn parse_size(text: &str) -> std::result::Result<[u32; 2], String> {
    let parts =
        text.split_once(['x', 'X']).and_then(|(width, height)| Some([width.parse().ok()?, height.parse().ok()?]));
    match parts {
        Some(size) if !size.contains(&0) => Ok(size),
        _ => Err("give width and height in pixels, as in 1280x720".to_owned()),
    }
}

/// Reads `a,b[option=value,…],c` or `all`, and applies `--set`. Each method may come several times with other options.
pub fn parse_methods(list: &str, sets: &[String]) -> Result<Vec<(&'static Entry, Options)>> {
    let specs =
        if list == "all" { METHODS.iter().map(|entry| entry.id.to_owned()).collect() } else { split_methods(list)? };
    let mut chosen = Vec::new();
    for spec in &specs {
        let (name, inside) = match spec.split_once('[') {
            Some((name, rest)) => (name, rest.trim_end_matches(']')),
            None => (spec.as_str(), ""),
        };
        let entry = culling::find(name)?;
        let mut options = entry.default_options();
        for set in sets {
            let (method, setting) = set.split_once('.').with_context(|| bad_setting(set))?;
            culling::find(method)?;
            if method == name {
                apply(&mut options, setting).with_context(|| format!("--set {set}"))?;
            }
        }
        for setting in inside.split(',').filter(|setting| !setting.is_empty()) {
            apply(&mut options, setting).with_context(|| format!("--method {spec}"))?;
        }
        chosen.push((entry, options));
    }
    check_unique(&chosen)?;
    Ok(chosen)
}

fn apply(options: &mut Options, setting: &str) -> Result<()> {
    let (name, value) = setting.split_once('=').with_context(|| bad_setting(setting))?;
    Ok(options.set(name, value)?)
}

fn bad_setting(setting: &str) -> String {
    format!("'{setting}' is no setting; write METHOD.OPTION=VALUE, as in hzb.texels=8")
}

fn split_methods(list: &str) -> Result<Vec<String>> {
    let (mut specs, mut open) = (vec![String::new()], false);
    for letter in list.chars() {
        match letter {
            '[' if open => bail!("--method {list}: '[' inside '['"),
            '[' => open = true,
            ']' => open = false,
            _ => {}
        }
        match (letter, specs.last_mut()) {
            (',', _) if !open => specs.push(String::new()),
            (letter, Some(last)) => last.push(letter),
            _ => {}
        }
    }
    if open {
        bail!("--method {list}: a '[' is not closed");
    }
    specs.iter_mut().for_each(|spec| *spec = spec.trim().to_owned());
    specs.retain(|spec| !spec.is_empty());
    if specs.is_empty() {
        bail!("--method names no method; write for example --method none,hzb, or all");
    }
    Ok(specs)
}

fn check_unique(chosen: &[(&'static Entry, Options)]) -> Result<()> {
    for (index, (_, options)) in chosen.iter().enumerate() {
        if chosen[..index].iter().any(|(_, earlier)| earlier.label() == options.label()) {
            bail!("method '{}' is there twice; give it other options, or name it once", options.label());
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn methods_carry_their_options() {
        let sets = ["hzb.skip=false".to_owned()];
        let labels: Vec<_> = parse_methods("none,hzb,hzb[texels=8,skip=true]", &sets)
            .unwrap()
            .iter()
            .map(|(_, options)| options.label())
            .collect();
        assert_eq!(labels, ["none", "hzb[skip=false]", "hzb[texels=8]"]);
        assert_eq!(parse_methods("all", &[]).unwrap().len(), METHODS.len());
    }

    #[test]
    fn faulty_methods_are_refused_by_name() {
        let fault = |list: &str, set: &str| {
            let sets: Vec<String> = [set.to_owned()].into_iter().filter(|set| !set.is_empty()).collect();
            format!("{:#}", parse_methods(list, &sets).unwrap_err())
        };
        assert!(fault("nine", "").contains("no method 'nine'"));
        assert!(fault("hzb,hzb", "").contains("'hzb' is there twice"));
        assert!(fault("hzb[texels=8", "").contains("not closed"));
        assert!(fault("hzb", "hzb.texels").contains("is no setting"));
        assert!(fault("hzb", "hxb.texels=4").contains("no method 'hxb'"));
        assert!(fault(",", "").contains("names no method"));
    }

    #[test]
    fn sizes_are_read_or_refused() {
        assert_eq!(parse_size("1280x720"), Ok([1280, 720]));
        for bad in ["0x5", "12", "axb", "-1x5", "1x2x3"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }
}
