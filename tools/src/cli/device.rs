//! Which device, and how it is watched.

use clap::{Args, ValueEnum};
use engine::{DepthFormat, GpuOptions, TimerMode};

/// Which device, and how it is watched.
#[derive(Args, Clone, Debug)]
pub struct DeviceArgs {
    /// Device index or part of its name (see `sightline info`); the best one if left out
    #[arg(long, value_name = "NAME|INDEX")]
    pub device: Option<String>,
    /// Turn on the validation layer with synchronization validation; any message stops the run. Times then mean little
    #[arg(long)]
    pub validation: bool,
    /// How stages are timed; decided by the kind of device if left out (a CPU: split)
    #[arg(long, value_name = "MODE")]
    pub timer: Option<TimerChoice>,
    /// Put a barrier before every stage, to tell a missing barrier from another fault
    #[arg(long)]
    pub barrier_every_stage: bool,
    /// How depth is kept, to study what formats cost: bounds are derived for reversed D32, and methods are exact with it alone
    #[arg(long, value_name = "FORMAT", default_value = "d32")]
    pub depth_format: DepthChoice,
    /// Do without these features, as if the device lacked them (`sightline info` lists them): each has a way around it
    #[arg(long, value_name = "FEATURE,...", value_delimiter = ',')]
    pub without: Vec<String>,
}

/// Formats of depth buffers.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum DepthChoice {
    /// 32-bit float, reversed: 1 near, 0 far
    D32,
    /// 32-bit float, 0 near, 1 far
    D32Standard,
    /// 24-bit fixed point
    D24,
    /// 16-bit fixed point
    D16,
}

/// How stages are kept apart in time.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum TimerChoice {
    /// A timestamp after each stage
    Plain,
    /// A timestamp and a full barrier after each stage
    Split,
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
            cache_dir: crate::run::session::cache_folder(),
            barrier_every_stage: self.barrier_every_stage,
            depth: match self.depth_format {
                DepthChoice::D32 => DepthFormat::ReversedD32,
                DepthChoice::D32Standard => DepthFormat::StandardD32,
                DepthChoice::D24 => DepthFormat::D24,
                DepthChoice::D16 => DepthFormat::D16,
            },
            windows: false,
            without: self.without.clone(),
        }
    }
}
