//! The tables on the terminal: one row per method, and one row per stage for `--explain`. Both fit 120 columns.

use super::{Method, Results, Stage};
use crate::results::grid::{clipped, milliseconds, Grid};

/// A longer label gets a line of its own above its numbers: a shortened one could no longer be told from another.
const LABEL_WIDTH: usize = 22;

/// One row per method, in the order asked for: times, ratios to `none` and `ref` where those ran, and errors; a dash where
/// nothing was measured but times (`bench --no-metrics`).
pub fn table(results: &Results) -> String {
    let columns = columns(results);
    let mut grid = Grid::new(columns.iter().map(|column| column.head).collect(), LABEL_WIDTH);
    for method in &results.methods {
        let cells = columns.iter().map(|column| (column.cell)(method)).collect();
        grid.rows.push((method.label.clone(), cells));
    }
    let mut lines = heading(results);
    lines.push(String::new());
    lines.extend(grid.lines("method"));
    lines.push(String::new());
    lines.push(
        "frame: median ms · C/R: culled / culled by ref · diff px: pixels of other depth, mean · PSNR: dB, worst frame"
            .into(),
    );
    lines.extend(results.methods.iter().filter(|method| method.thin_pixels_mean > 0.0).map(thin_line));
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// A line for the excused pixels of a method.
fn thin_line(method: &Method) -> String {
    let thin: u64 = method.frames.thin_pixels.iter().sum();
    let frames = method.frames.thin_pixels.iter().filter(|pixels| **pixels > 0).count();
    clipped(&format!(
        "{}: {thin} wrong pixels in {frames} frames are excused: only primitives under 1/8 pixel can have made them",
        method.label
    ))
}

/// One row per stage of a method: did it run, what it costs, what skipping it saves a frame, and why it was skipped. For
/// `--explain`. A dash stands where that is not known: of a stage that never ran, or was never skipped.
pub fn stages_table(results: &Results, method: &Method) -> String {
    let heads = vec!["ran", "ms", "share", "saved"];
    let mut grid = Grid::new(heads, 34);
    for stage in &method.stages {
        let ms = if stage.skipped >= results.frames { "-".into() } else { milliseconds(stage.median_ms) };
        let share = format!("{:.1} %", 100.0 * stage.share);
        let saved = stage.saved_ms.filter(|_| stage.skipped > 0).map_or("-".into(), milliseconds);
        let cells = vec![ran(stage, results.frames), ms, share, saved];
        grid.rows.push((stage.name.clone(), cells));
    }
    let mut lines = grid.lines("stage");
    let head = lines[0].clone() + "  why skipped";
    lines[0] = head;
    // A long name has a line of its own, so a stage's numbers are on the last of its lines.
    let mut line = 1;
    for stage in &method.stages {
        line += grid.lines_of(&stage.name);
        if let Some(reason) = stage.reason.as_deref().filter(|_| stage.skipped > 0) {
            let with_reason = format!("{}  {reason}", lines[line - 1]);
            lines[line - 1] = clipped(&with_reason);
        }
    }
    let title = format!("{}: {}", method.label, method.guarantee);
    lines.insert(0, clipped(&title));
    lines.iter().map(|line| format!("{line}\n")).collect()
}

fn ran(stage: &Stage, frames: u32) -> String {
    match stage.skipped {
        0 => "ran".into(),
        skipped if skipped >= frames => "skipped".into(),
        skipped => format!("{} of {frames}", frames - skipped),
    }
}

struct Column {
    head: &'static str,
    cell: Box<dyn Fn(&Method) -> String>,
}

fn columns(results: &Results) -> Vec<Column> {
    let mut columns = Vec::new();
    let mut add = |head, cell: Box<dyn Fn(&Method) -> String>| columns.push(Column { head, cell });
    add("frame", Box::new(|m| milliseconds(m.frame_ms.median)));
    for (id, head) in [("none", "/none"), ("ref", "/ref")] {
        let base = results.methods.iter().find(|method| method.method == id);
        if let Some(base) = base.map(|base| base.frame_ms.median) {
            // A sweep's settings are compared within their cells.
            let within = move |m: &Method| m.ratio_to_ref.filter(|_| id == "ref");
            add(
                head,
                Box::new(move |m| within(m).map_or_else(|| ratio(m.frame_ms.median, base), |own| ratio(own, 1.0))),
            );
        }
    }
    add("p95", Box::new(|m| milliseconds(m.frame_ms.p95)));
    let mut measured = |head, cell: fn(&Method) -> String| {
        add(head, Box::new(move |m| if m.is_measured() { cell(m) } else { "-".into() }));
    };
    measured("drawn", |m| quantity(m.drawn_mean));
    measured("C/R %", |m| percent(m.culled_over_ref));
    measured("false neg.", |m| m.false_negatives.to_string());
    measured("diff px", |m| error(m.differing_pixels_mean));
    measured("PSNR", |m| decibels(m.psnr_worst_db));
    measured("triangles", |m| quantity(m.triangles_mean));
    measured("overdraw", |m| overdraw(m.overdraw_mean));
    columns
}

pub(crate) fn heading(results: &Results) -> Vec<String> {
    let Results { scene, device, .. } = results;
    let run = format!(
        "{}: {} objects, {} triangles · path {} at speed {} · {} frames of {}x{}",
        scene.name,
        scene.objects,
        quantity(scene.triangles as f64),
        results.path,
        results.speed,
        results.frames,
        results.size[0],
        results.size[1]
    );
    let on = format!("{} ({}) · {} · Vulkan {}", device.name, device.kind, device.driver, device.api_version);
    vec![clipped(&run), clipped(&on)]
}

fn ratio(part: f64, base: f64) -> String {
    if base > 0.0 {
        format!("{:.2}", part / base)
    } else {
        "-".into()
    }
}

/// One decimal, but never 100.0 for less than all and never 0.0 for more than nothing.
pub(crate) fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    if percent < 100.0 && percent > 99.9 {
        ">99.9".into()
    } else if percent > 0.0 && percent < 0.1 {
        "<0.1".into()
    } else {
        format!("{percent:.1}")
    }
}

/// Never 0 for an error that is there.
pub(crate) fn error(mean: f64) -> String {
    match mean {
        0.0 => "0".into(),
        mean if mean < 0.01 => "<0.01".into(),
        mean if mean < 100.0 => format!("{mean:.2}"),
        mean => format!("{mean:.0}"),
    }
}

pub(crate) fn decibels(psnr: Option<f64>) -> String {
    psnr.map_or("identical".into(), |db| format!("{db:.1}"))
}

fn overdraw(mean: Option<f64>) -> String {
    mean.map_or("-".into(), |mean| format!("{mean:.2}"))
}

/// Whole below 10,000, then with k, M or G.
pub(crate) fn quantity(count: f64) -> String {
    match count {
        count if count < 9999.5 => format!("{count:.0}"),
        count if count < 999.95e3 => format!("{:.1}k", count / 1e3),
        count if count < 999.95e6 => format!("{:.1}M", count / 1e6),
        count => format!("{:.1}G", count / 1e9),
    }
}
