//! The arguments of `sightline bench --sweep`.

use clap::Args;

/// Which options are swept.
#[derive(Args, Clone, Debug, Default)]
pub struct SweepArgs {
    /// Runs all combinations of values, as woc.size=1,2,4 woc.iterations=1..4 (both ends are run), with the methods of --method
    /// (`ref` alone if left out). Finished cells are kept below --out: the same command goes on where it was interrupted
    #[arg(long, value_name = "METHOD.OPTION=VALUES", num_args = 1.., conflicts_with_all = ["table", "capture", "explain", "flares"])]
    pub sweep: Vec<String>,
    /// Runs the sweep's finished cells again
    #[arg(long, requires = "sweep")]
    pub fresh: bool,
}
