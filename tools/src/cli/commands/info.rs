//! `sightline info`: devices, limits, formats, and what is missing.

use super::say;
use crate::cli::DeviceArgs;
use crate::run::session::cache_folder;
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
                    (_, None) => "by self-check",
                }
            ),
        ),
        ("timestamp", format!("{} ns a tick, {} bits", info.timestamp_ns, info.timestamp_bits)),
        ("subgroup", format!("{} lanes", info.subgroup_size)),
        ("largest image", format!("{0} x {0} pixels", info.max_image_px)),
        ("largest buffer", format!("{} MiB for a stage", info.max_storage_bytes >> 20)),
        ("vertex grid", format!("1/{} pixel", (1.0 / info.snap_px).round())),
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
