//! The command line.

mod colours;
pub mod commands;
mod compare;
mod config;
mod device;
mod flares;
mod picture;
mod shot;
mod start;
mod stress;
mod sweep;
#[cfg(test)]
mod tests;
mod view;

pub use colours::coloured;
pub use compare::{CompareArgs, COMPARE_HELP};
pub use config::with_config;
pub use device::{DepthChoice, DeviceArgs, TimerChoice};
pub use flares::FlareChoice;
pub use picture::SampleChoice;
use picture::{bounds_names, fit_names, parse_shading, parse_size};
pub use shot::{ShotArgs, Show};
pub use start::start;
pub use stress::{StressArgs, STRESS_HELP};
pub use sweep::SweepArgs;
pub use view::{view_help, ViewArgs};

use crate::run::session::SessionOptions;
use crate::tables::TABLES;
use anyhow::{bail, Result};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Args, Parser, Subcommand};
use culling::auto::ALLOW_ERROR_OPTION;
use culling::world::{DETAIL_OPTION, SKIP_OPTION};
use culling::{OptionInfo, Shading, METHODS, PARTICULAR};
use scenes::{Fit, MovingBounds, SceneOptions};
use std::path::{Path, PathBuf};

/// A laboratory for indirect-draw occlusion culling: pick a scene, a camera path and methods; see run time against error,
/// stage by stage, against the truth.
#[derive(Debug, Parser)]
#[command(
    name = "sightline",
    version,
    max_term_width = 100,
    after_help = "Start with:\n  sightline bench --scale 0.1\n  sightline bench --scene model.glb --method none,hzb --frames 60\n  sightline shot --method hzb --view overdraw --out overdraw.png\n\nExit code: 0 all went well; 1 an error, which one line on stderr names, a loss that `stress` found, or a gate of `compare` that was true; 2 a command line that cannot be read, or an error of `compare`, so that CI can tell it from a gate.\n\nMessages are coloured on a terminal only, and not there either if NO_COLOR is set; tables and JSON never are."
)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
    /// Takes flags from a TOML file, such as sightline.toml: a table for each command, a key for each flag ([bench] frames = 60). What
    /// is typed counts instead
    #[arg(long, value_name = "FILE", global = true)]
    pub config: Option<PathBuf>,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Runs methods over a camera path: times, errors against the truth, stage by stage; writes results.json, results.csv, report.html and trace.json
    #[command(after_help = BENCH_HELP)]
    Bench(BenchArgs),
    /// Makes a report of a results.json: plots and tables, without the pictures that only `bench` has
    Report(ReportArgs),
    /// Compares two results.json: is B faster than A, what became of the errors; and gates for CI (--fail-if)
    #[command(after_help = COMPARE_HELP)]
    Compare(CompareArgs),
    /// Renders one frame to a PNG: colour, depth, item buffer, overdraw, or the boxes that a method tested
    Shot(ShotArgs),
    /// Opens a window to fly through a scene under any method: freeze culling, switch methods, see depth, overdraw, boxes, errors
    #[command(after_help = view_help())]
    View(ViewArgs),
    /// Runs the numeric catalogue and worlds by chance through every exact method: what is lost, and how near it was
    #[command(after_help = STRESS_HELP)]
    Stress(StressArgs),
    /// Lists scenes; shows or exports one with its camera path
    Scene(SceneArgs),
    /// Lists devices, and says what the chosen one has and lacks
    Info(DeviceArgs),
    /// Prints what makes a shell complete commands, flags and their values
    #[command(
        after_help = "For example:\n  sightline completions bash > ~/.local/share/bash-completion/completions/sightline\n  sightline completions zsh > \"${fpath[1]}/_sightline\"\n  sightline completions fish > ~/.config/fish/completions/sightline.fish"
    )]
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
    /// Prints the manual page, of the program or of one command
    #[command(after_help = "For example:\n  sightline man bench > sightline-bench.1 && man ./sightline-bench.1")]
    Man {
        /// The command; the program itself if left out
        command: Option<String>,
    },
}

const BENCH_HELP: &str = "Methods may carry options: --method 'none,hzb,hzb[texels=8]', or --set hzb.texels=8 for all of that name.\n\
    A table takes its methods and settings from the paper; --set adds what it leaves open (warp.OPTION for a warp on its own).\n\
    The path of eovc-* is spread over --frames: 600 is the thesis' speed (10 s at 60 Hz), fewer are larger steps.\n\
    woc-*, tog-* and lean walk at --speed, of which 960 frames are the whole; some of their rows multiply --speed or --size.\n\
    Times are interleaved (A B C A B C ...) after warm-up; errors come from a second, untimed pass over the same frames.";

/// Frames of the warm-up unless told otherwise: pipelines are compiled, and methods have a past.
const WARMUP: usize = 3;

/// Which scene, path and picture size.
#[derive(Args, Clone, Debug)]
pub struct SceneChoice {
    /// Scene name (see `sightline scene list`), or a .glb or .gltf file; city-block if left out. A table takes several,
    /// separated by commas or by giving --scene again; a file whose name holds commas is taken whole if it is there
    #[arg(long, value_name = "NAME|FILE")]
    pub scene: Vec<PathBuf>,
    /// Objects of a procedural scene, as a multiple of its standard number
    #[arg(long, value_name = "F", default_value_t = 0.25, allow_negative_numbers = true)]
    pub scale: f64,
    /// Seed of a procedural scene
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// How finely the meshes of the papers' scenes are divided, 0 to 4: each level has about four times the triangles
    #[arg(long, value_name = "N", default_value_t = SceneOptions::default().detail)]
    pub detail_level: u32,
    /// Camera path: walk, pan, zoom, rotate, closing-in, still, the scene's own `camera`, a recorded .json file, or cuts:
    /// each frame somewhere else on the scene's way (its camera's or its walk), so that no frame is like the one before
    #[arg(long, value_name = "NAME|FILE")]
    pub path: Option<PathBuf>,
    /// How fast the camera goes: at 1, a frame is 1/960 of the path's way (16 s at 60 Hz)
    #[arg(long, value_name = "F", default_value_t = 1.0, allow_negative_numbers = true)]
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
    /// How the rectangle of a file's camera (its aspectRatio, or xmag and ymag) is fitted into the picture: inside (all of it is seen)
    /// or height (as high as the picture; a narrower picture crops it)
    #[arg(long, value_name = "WAY", default_value = Fit::default().name(), value_parser = fit_names())]
    pub fit: Fit,
    /// What is drawn of materials: lambert (one colour an object) or textured; if left out, what the scene has
    #[arg(long, value_name = "lambert|textured", value_parser = parse_shading)]
    pub shading: Option<Shading>,
    /// How the box of what moves is had (GPU Gems 29.5.2): per-frame (where it is, in each frame anew: exact, brought to the device each
    /// time), per-animation (one box for each animation of it, while that plays), union (one box for all that it ever does, never touched)
    /// or in-place (one box for its turns and scales at rest, moved with its middle). All hold it always; looser ones draw more
    #[arg(long, value_name = "WAY", default_value = MovingBounds::default().name(), value_parser = bounds_names())]
    pub bounds: MovingBounds,
}

/// Which methods.
#[derive(Args, Clone, Debug)]
pub struct MethodChoice {
    /// Methods, separated by commas, or `all`; if left out, the default method between what it is to be compared with
    #[arg(long, value_name = "A,B,C|all", default_value_t = default_methods())]
    pub method: String,
    /// Sets a method's option; may be given several times
    #[arg(long, value_name = "METHOD.OPTION=VALUE")]
    pub set: Vec<String>,
    /// Leave out what is smaller on the screen than PX pixels, in all methods but none and ref: their option `detail`
    #[arg(long, value_name = "PX", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=1000))]
    pub detail: u32,
    /// Let `auto` use woc too, which may miss objects, while its checked frames (one in 16) miss no more than PERCENT of theirs: sets
    /// auto.allow-error. Without it `auto` is exact
    #[arg(long, value_name = "PERCENT", value_parser = PossibleValuesParser::new(ALLOW_ERROR_OPTION.values.split('|')))]
    pub allow_error: Option<String>,
    /// Run every stage in every frame, also where it cannot change the result: sets the option `skip` of every method that
    /// has it to false
    #[arg(long)]
    pub no_skip: bool,
}

impl MethodChoice {
    /// What is set: `--detail` and `--no-skip` for every method that has those options, then each `--set`.
    pub fn sets(&self) -> Vec<String> {
        let all = |option: OptionInfo, value: String| {
            let having = METHODS.iter().chain(PARTICULAR).filter(move |entry| entry.options.contains(&option));
            having.map(move |entry| format!("{}.{}={value}", entry.id, option.name))
        };
        let detailed = all(DETAIL_OPTION, self.detail.to_string()).filter(|_| self.detail > 0);
        let skipped = all(SKIP_OPTION, "false".to_owned()).filter(|_| self.no_skip);
        let allowed = self.allow_error.iter().flat_map(|percent| all(ALLOW_ERROR_OPTION, percent.clone()));
        detailed.chain(skipped).chain(allowed).chain(self.set.iter().cloned()).collect()
    }
}

/// `sightline bench`.
#[derive(Args, Clone, Debug)]
pub struct BenchArgs {
    /// Scene, path and size.
    #[command(flatten)]
    pub scene: SceneChoice,
    /// Samples.
    #[command(flatten)]
    pub samples: SampleChoice,
    /// Lens flares.
    #[command(flatten)]
    pub flares: FlareChoice,
    /// Methods and options.
    #[command(flatten)]
    pub methods: MethodChoice,
    /// Runs a table on its scenes (ours that are built after its paper's, unless --scene names some) and prints its figures
    /// beside the published ones; of `lean`, which is ours, goals beside them. The table chooses methods and settings; the
    /// path is its paper's, the whole of closing-in (eovc-*) or a walk (woc-*, tog-*, lean), unless --path names another
    #[arg(long, value_name = "TABLE", value_parser = table_names(), conflicts_with_all = ["method", "detail", "capture", "json", "flares"])]
    pub table: Option<String>,
    /// Sweeps of options.
    #[command(flatten)]
    pub sweeps: SweepArgs,
    /// Device.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Frames run before the clock starts; 3 if left out, and 12 of the table `lean`, in which `auto` tries what there is
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=1_000_000))]
    pub warmup: Option<u32>,
    /// Only times: leave out the truth, the errors and the pictures' measures
    #[arg(long)]
    pub no_metrics: bool,
    /// Captures this frame of each method with RenderDoc, to a file a method in --out; times then mean little
    #[arg(long, value_name = "FRAME")]
    pub capture: Option<usize>,
    /// Prints each stage: ran or skipped, its time, what skipping it saves a frame, and why it was skipped; then the parts of
    /// the frame with their share, and what `auto` chose
    #[arg(long)]
    pub explain: bool,
    /// Leaves out report.html, and the pictures that are collected for it
    #[arg(long)]
    pub no_report: bool,
    /// Folder for results.json, results.csv, report.html and trace.json (for ui.perfetto.dev); of a table, for
    /// table-TABLE.txt and a folder with the first two (or warps.csv) for each scene, and below it for each size or speed
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub out: PathBuf,
    /// Prints results.json instead of the table
    #[arg(long)]
    pub json: bool,
}

/// `sightline report`.
#[derive(Args, Clone, Debug)]
pub struct ReportArgs {
    /// The results that `sightline bench` wrote
    #[arg(value_name = "RESULTS.json")]
    pub results: PathBuf,
    /// The HTML file; the results' name with .html if left out
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
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

impl BenchArgs {
    /// Frames of the warm-up, where a table has so many of its own.
    pub fn warmup(&self, of_table: Option<usize>) -> usize {
        self.warmup.map_or(of_table.unwrap_or(WARMUP), |frames| frames as usize)
    }
}

impl SceneChoice {
    /// As a session takes it.
    ///
    /// # Errors
    /// More than one scene.
    pub fn session(&self) -> Result<SessionOptions> {
        Ok(self.session_of(&self.one_scene()?))
    }

    /// The scene, where only one will do.
    ///
    /// # Errors
    /// More than one scene, or none where `--scene` was given.
    pub fn one_scene(&self) -> Result<PathBuf> {
        match self.scenes()?.as_slice() {
            [] => Ok("city-block".into()),
            [one] => Ok(one.clone()),
            all => {
                let all: Vec<_> = all.iter().map(|scene| scene.display().to_string()).collect();
                let all = all.join(",");
                bail!("--scene {all}: give one scene; only a table of `sightline bench --table` runs several")
            }
        }
    }

    /// Returns all scenes that are named. Each `--scene` is a file of that name, commas included, or else a list. A name that is not
    /// UTF-8 is always a file.
    ///
    /// # Errors
    /// A `--scene` without a name: the default must not run in its place.
    pub fn scenes(&self) -> Result<Vec<PathBuf>> {
        let mut scenes = Vec::new();
        for given in &self.scene {
            match given.to_str().filter(|_| !given.is_file()) {
                None => scenes.push(given.clone()),
                Some(list) => {
                    let before = scenes.len();
                    scenes.extend(list.split(',').map(str::trim).filter(|name| !name.is_empty()).map(PathBuf::from));
                    if scenes.len() == before {
                        bail!("--scene '{list}' names no scene; see `sightline scene list`, or leave --scene out");
                    }
                }
            }
        }
        Ok(scenes)
    }

    /// As a session of one of the scenes takes it.
    pub fn session_of(&self, scene: &Path) -> SessionOptions {
        SessionOptions {
            scene: scene.to_path_buf(),
            scale: self.scale,
            seed: self.seed,
            detail: self.detail_level,
            path: self.path.clone(),
            speed: self.speed,
            whole_path: self.whole_path,
            frames: self.frames as usize,
            size: self.size,
            fit: self.fit,
            shading: self.shading,
            samples: 1,
            bounds: self.bounds,
            flares: None,
        }
    }
}

/// Nothing, the least, the default, and the limit.
fn default_methods() -> String {
    format!("none,frustum,{},ref", culling::default_method().id)
}

fn table_names() -> PossibleValuesParser {
    PossibleValuesParser::new(
        TABLES.iter().map(|table| PossibleValue::new(table.id).help(format!("{}: {}", table.name(), table.title))),
    )
}
