//! The arguments of `sightline compare`.

use crate::compare::{Bootstrap, CompareOptions, Gate};
use clap::Args;
use std::path::PathBuf;

/// What `--help` says below the options.
pub const COMPARE_HELP: &str =
    "A is the run before a change, B the one after it. B/A is the ratio of their median frame times.\n\
    Its 95 % interval comes from resampling frames, in pairs. `faster` and `slower` need the whole\n\
    interval on one side of 1, and at least 6 frames. What held during one whole run, such as another\n\
    load of the machine, is in the ratio, but not in the interval: where that can be, run both again, or\n\
    compare by a method that did not change (--by ref): methods are timed by turns, so that it has the same load.\n\
    Even on a quiet machine, one row in 20 shows a difference that is none.\n\n\
    A gate is a sentence that must not be true: METHOD.FIELD OP NUMBER.\n  \
    METHOD  a label of B, a method's id (all its labels), or any\n  \
    FIELD   a number of the method's row in B, by its name in results.json (false_negatives,\n          \
    psnr_worst_db, frame_ms.median, stages.NAME.median_ms; a wrong name lists all), the same\n          \
    with _delta (B less A), or B/A: ratio, and the ends of its interval: ratio_low, ratio_high\n  \
    OP      > >= < <= == !=\n\
    Pictures identical to the truth have an infinite PSNR. A gate on what was not measured is an\n\
    error, not a pass.\n\n\
    Exit code: 0 no gate failed, 1 a gate failed, 2 an error.\n\n\
    Examples:\n  \
    sightline compare before/results.json after/results.json --stages\n  \
    sightline compare before/results.json after/results.json --by ref --fail-if 'any.ratio_low>1.05'\n  \
    sightline compare out/results.json --fail-if 'eovc.false_negatives>0' --fail-if 'any.ssim_mean<1'";

/// `sightline compare`.
#[derive(Args, Clone, Debug)]
pub struct CompareArgs {
    /// A's results.json and B's; or B's alone, for its gates
    #[arg(value_name = "RESULTS.json", num_args = 1..=2, required = true)]
    pub files: Vec<PathBuf>,
    /// Fails (exit code 1) if this is true, as in 'eovc.false_negatives>0'; may be given several times
    #[arg(long, value_name = "METHOD.FIELD OP NUMBER")]
    pub fail_if: Vec<Gate>,
    /// Compares times as multiples of this method's in the same run, such as ref: what slowed a whole run falls out. Gates on
    /// ratio, ratio_low and ratio_high then are of these
    #[arg(long, value_name = "LABEL")]
    pub by: Option<String>,
    /// Also compares each stage
    #[arg(long)]
    pub stages: bool,
    /// Compares runs of different scenes, paths, speeds, seeds, sizes, frames or devices all the same
    #[arg(long)]
    pub force: bool,
    /// How often frames are drawn anew for an interval
    #[arg(long, value_name = "N", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(100..=1_000_000))]
    pub resamples: u32,
    /// Seed of the resamples: the same files and seed give the same intervals
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
    /// Prints the comparison and the gates as JSON instead of tables; infinities are null
    #[arg(long)]
    pub json: bool,
}

impl CompareArgs {
    /// As the comparison takes them.
    pub fn options(&self) -> CompareOptions<'_> {
        let bootstrap = Bootstrap { resamples: self.resamples, seed: self.seed };
        CompareOptions { force: self.force, stages: self.stages, bootstrap, by: self.by.as_deref() }
    }
}
