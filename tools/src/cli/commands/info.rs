//! `sightline info`: devices, limits, formats, and what is missing.

use super::say;
use crate::cli::DeviceArgs;
use crate::run::samples::SAMPLES;
use crate::run::session::cache_folder;
use crate::run::targets::Targets;
use anyhow::Result;
use engine::{adapters, device_lines, Format, Gpu, TimerMode};

/// Prints what there is.
pub fn run(arguments: &DeviceArgs) -> Result<()> {
    say("devices")?;
    for line in device_lines()? {
        say(&format!("  {line}"))?;
    }
    if adapters()?.iter().all(|info| !info.missing.is_empty()) {
        return say("no device can run Sightline: every method needs what is listed as lacking");
    }
    let gpu = Gpu::open(&arguments.gpu())?;
    let Some(info) = gpu.info() else { return Ok(()) };
    let rows = [
        ("chosen", info.to_string()),
        (
            "timers",
            format!(
                "{} ({})",
                gpu.timer_mode(),
                match (gpu.timer_mode(), arguments.timer) {
                    (TimerMode::Off, _) => "stages are not timed",
                    (_, Some(_)) => "by --timer",
                    (_, None) => "by the kind of device",
                }
            ),
        ),
        ("timer check", timer_check(&gpu)?),
        ("timestamp", format!("{} ns a tick, {} bits", info.timestamp_ns, info.timestamp_bits)),
        ("subgroup", format!("{} lanes", info.subgroup_size)),
        ("largest image", format!("{0} x {0} pixels", info.max_image_px)),
        ("largest buffer", format!("{} MiB for a stage", info.max_storage_bytes >> 20)),
        ("vertex grid", format!("1/{} pixel", (1.0 / info.snap_px).round())),
        ("samples", samples(&gpu)),
        (
            "formats",
            [Format::Colour, Format::Item, Format::Depth, Format::Heat].map(|it| it.name(gpu.depth())).join(", "),
        ),
        ("caches", cache_folder().map_or("none (no HOME)".to_owned(), |folder| folder.display().to_string())),
    ];
    for (name, value) in rows {
        say(&format!("{name:<15} {value}"))?;
    }
    for feature in info.needed.iter().chain(&info.optional) {
        say(&format!("{:<15} {}: {}", if feature.present { "has" } else { "lacks" }, feature.name, feature.why))?;
    }
    say("methods         all methods run on this device")
}

/// Measures whether timestamps alone tell stages apart. A busy machine can change the answer.
fn timer_check(gpu: &Gpu) -> Result<String> {
    Ok(match (gpu.check_timers()?, gpu.timer_mode()) {
        (TimerMode::Off, _) => "none: the device has no timestamps".to_owned(),
        (TimerMode::Plain, _) => "timestamps alone charge each stage with its own work (measured now)".to_owned(),
        (TimerMode::Split, TimerMode::Plain) => {
            "timestamps alone charge stages with the work of others (measured now): if it stays so, use --timer split"
                .to_owned()
        }
        (TimerMode::Split, _) => "timestamps alone charge stages with the work of others (measured now)".to_owned(),
    })
}

/// What `--samples` can be, and which methods need 1 because of how the device takes depths.
fn samples(gpu: &Gpu) -> String {
    match Targets::with_samples(gpu, [8; 2], SAMPLES) {
        Err(error) => format!("1 a pixel ({error:#})"),
        Ok(targets) if targets.stray_px() > 0.0 => format!(
            "1 or {SAMPLES} a pixel, whose depths are taken up to {:.2} pixel beside them: methods that draw boxes need 1",
            targets.stray_px()
        ),
        Ok(_) => format!("1 or {SAMPLES} a pixel"),
    }
}
