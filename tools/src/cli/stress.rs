//! The arguments of `sightline stress`.

use super::{parse_size, DeviceArgs};
use clap::Args;
use std::path::PathBuf;

/// What `--help` says below the options.
pub const STRESS_HELP: &str = "Every drill is drawn whole, which is the truth, and by each method. An exact method may lose no object and change no\n\
    pixel; approximate methods may be named, and what they lose is a failure all the same.\n\
    Drills of seed 0 run at the methods' settings, the others, and all worlds by chance, at settings by chance: --as-given\n\
    keeps the settings. A failure prints the line that runs it again, is made small and saved below --out.\n\
    Spare px: the least that was left of what a box's rectangle is grown by (rule 4) before a pixel would have lain outside.\n\
    Spare depths: how many representable depths were left before a pixel would have been nearer than its box. Below 0 is a\n\
    fault of the bounds, whatever the methods did. Fewest px: the smallest visible object; at 1, a single pixel decides.\n\n\
    Examples:\n  sightline stress\n  sightline stress --method hzb,eovc --cases 1000 --seed 5000\n  \
    sightline stress --method 'woc-exact[erode=none]' --case near-plane/3 --as-given";

/// What to stress, and how much.
#[derive(Args, Clone, Debug)]
pub struct StressArgs {
    /// Methods, separated by commas, or `all-exact`
    #[arg(long, value_name = "A,B,C|all-exact", default_value = "all-exact")]
    pub method: String,
    /// Sets a method's option; may be given several times
    #[arg(long, value_name = "METHOD.OPTION=VALUE")]
    pub set: Vec<String>,
    /// Keep the settings given, instead of settings by chance
    #[arg(long)]
    pub as_given: bool,
    /// One drill, as failures name it; may be given several times. All if left out
    #[arg(long, value_name = "FAMILY/SEED")]
    pub case: Vec<String>,
    /// Drills of each family of the catalogue
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u64).range(0..=1_000_000))]
    pub seeds: u64,
    /// Worlds and cameras by chance
    #[arg(long, value_name = "N", default_value_t = 25, value_parser = clap::value_parser!(u64).range(0..=100_000_000))]
    pub cases: u64,
    /// The first seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u64,
    /// About how many bodies a drill of the catalogue has
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u64).range(1..=500_000))]
    pub bodies: u64,
    /// Picture size in pixels; each drill's own if left out
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Folder for failures
    #[arg(long, value_name = "DIR", default_value = "stress-out")]
    pub out: PathBuf,
    /// Print the outcome as JSON instead of a table
    #[arg(long)]
    pub json: bool,
    /// Which device
    #[command(flatten)]
    pub device: DeviceArgs,
}
