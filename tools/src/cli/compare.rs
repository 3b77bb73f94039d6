//! The arguments of `sightline compare`.

use clap::Args;
use std::path::PathBuf;

/// What `--help` says below the options.
pub const COMPARE_HELP: &str = "The ratio is B's median frame time over A's, with its 95 % bootstrap interval: frames are resampled in pairs. If the\n\
    interval holds 1, no difference is shown. What differs from run to run but not from frame to frame is not in it: on a\n\
    busy machine, repeat the runs.\n\
    Gates: METHOD.FIELD OP NUMBER. METHOD is a label, a method's id (all its labels) or any; FIELD a number of results.json's\n\
    methods (false_negatives, object_error_percent, psnr_worst_db, drawn_mean, frame_ms, ...), the same with _delta (B less A),\n\
    or ratio, ratio_low, ratio_high; OP one of > >= < <= ==. Exit code 1: a gate was true; 2: an error.\n\n\
    Examples:\n  sightline compare before.json after.json --fail-if 'any.ratio_low>1.05' --fail-if 'eovc.false_negatives>0'\n  \
    sightline compare out/results.json --fail-if 'woc.psnr_worst_db<49'";

/// Which results, and what must not be.
#[derive(Args, Clone, Debug)]
pub struct CompareArgs {
    /// results.json of A and of B; with one file alone, only its gates are looked at
    #[arg(value_name = "RESULTS.json", num_args = 1..=2, required = true)]
    pub files: Vec<PathBuf>,
    /// Fails if this is true; may be given several times
    #[arg(long, value_name = "METHOD.FIELD>NUMBER")]
    pub fail_if: Vec<String>,
    /// Compare runs of different scenes, paths, sizes, frames or devices all the same
    #[arg(long)]
    pub force: bool,
    /// Each stage's ratio too
    #[arg(long)]
    pub stages: bool,
    /// Print the comparison as JSON
    #[arg(long)]
    pub json: bool,
}
