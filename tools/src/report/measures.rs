//! All measures of all methods as tables, each with what it means.

use super::plot::number;
use super::{is_measured, ratio_to};
use crate::results::{Method, Results};
use serde::Serialize;

/// A table of some measures.
#[derive(Serialize)]
pub struct Table {
    title: &'static str,
    columns: Vec<Column>,
    rows: Vec<Row>,
}

#[derive(Serialize)]
struct Column {
    name: &'static str,
    meaning: &'static str,
}

#[derive(Serialize)]
struct Row {
    label: String,
    guarantee: String,
    cells: Vec<String>,
}

type Cell = fn(&Results, &Method) -> Option<f64>;

/// A measure: its name, what it means, where it comes from. Of those that are `None`, [`Measure::nothing`] stands in the table.
struct Measure {
    name: &'static str,
    meaning: &'static str,
    of: Cell,
    nothing: &'static str,
}

const fn measure(name: &'static str, meaning: &'static str, of: Cell) -> Measure {
    Measure { name, meaning, of, nothing: "–" }
}

/// Known without the untimed pass.
const TIMES: &[Measure] = &[
    measure("median ms", "half of the frames took no longer; from first submit to idle device", |_, m| {
        Some(m.frame_ms.median)
    }),
    measure("p95 ms", "95 % of the frames took no longer", |_, m| Some(m.frame_ms.p95)),
    measure("mean ms", "mean frame time", |_, m| Some(m.frame_ms.mean)),
    measure("/none", "median as a multiple of drawing everything", |r, m| ratio_to(r, "none", m)),
    measure("/ref", "median as a multiple of drawing exactly what is visible", |r, m| ratio_to(r, "ref", m)),
    measure("host ms", "median time of the program itself outside the driver", |_, m| m.host_ms),
    measure("memory MiB", "device memory that the method holds", |_, m| Some(m.device_memory_mib)),
];

const ERRORS: &[Measure] = &[
    measure("missed", "false negatives: visible objects that were not drawn, summed over frames", |_, m| {
        Some(m.false_negatives as f64)
    }),
    measure("frames", "frames with at least one missed object", |_, m| Some(f64::from(m.false_negative_frames))),
    measure("object error %", "missed objects in percent of the visible ones", |_, m| Some(m.object_error_percent)),
    measure("diff px", "pixels a frame whose depth is not the truth's", |_, m| Some(m.differing_pixels_mean)),
    measure("tied px", "pixels a frame of equal depth that another object won: no error", |_, m| {
        Some(m.tied_pixels_mean)
    }),
    measure("thin px", "wrong pixels a frame that only a primitive under 1/8 pixel can have made: excused", |_, m| {
        Some(m.thin_pixels_mean)
    }),
    Measure {
        nothing: "identical",
        ..measure("PSNR dB", "likeness of the picture to the truth, mean over the frames that differ", |_, m| {
            m.psnr_mean_db
        })
    },
    Measure {
        nothing: "identical",
        ..measure("worst PSNR", "of the worst frame; below about 40 dB it can be seen", |_, m| m.psnr_worst_db)
    },
    measure("SSIM", "structural similarity to the truth, mean; 1: identical", |_, m| Some(m.ssim_mean)),
];

const WORK: &[Measure] = &[
    measure("drawn", "objects drawn a frame", |_, m| Some(m.drawn_mean)),
    measure("C/N %", "objects culled, of all objects", |_, m| Some(100.0 * m.culled_over_total)),
    measure(
        "C/R %",
        "objects culled, of those that ref culls; above 100 only where visible ones are missed",
        |_, m| Some(100.0 * m.culled_over_ref),
    ),
    measure("triangles", "triangles drawn a frame", |_, m| Some(m.triangles_mean)),
    measure("draws", "draw commands a frame", |_, m| Some(m.draws_mean)),
    measure("overdraw", "fragments shaded for each pixel that shows something", |_, m| m.overdraw_mean),
    measure("queries", "occlusion queries a frame", |_, m| Some(m.queries_mean)),
    measure("state changes", "changes between drawing and testing a frame", |_, m| Some(m.state_changes_mean)),
    measure("waits", "times a frame that the host waited for answers", |_, m| Some(m.waits_mean)),
    measure(
        "plane tests",
        "tests of a box or sphere against a plane of the view volume, by the methods that do no others",
        |_, m| Some(m.plane_tests_mean),
    ),
    measure("rays", "rays cast a frame", |_, m| Some(m.rays_mean)),
    measure("boxes", "boxes rasterised a frame to test what is in them", |_, m| Some(m.boxes_mean)),
    measure("bounds brought", "bounds of moving objects brought to the device a frame", |_, m| {
        Some(m.bounds_brought_mean)
    }),
    measure("refits", "nodes of a hierarchy fitted to changed bounds a frame", |_, m| Some(m.refits_mean)),
    measure("node visits", "tree nodes that rays looked at a frame", |_, m| Some(m.node_visits_mean)),
];

/// Of runs with lens flares.
const FLARES: &[Measure] = &[
    measure("on screen", "measured frames in which the light is on the screen", |_, m| {
        m.flare.as_ref().map(|flare| f64::from(flare.frames_on_screen))
    }),
    measure("shows", "part of the light's block of 16x16 pixels that shows, by the depth buffer, mean", |_, m| {
        m.flare.as_ref()?.shows_mean
    }),
    measure("error", "between that and the flare's brightness, mean", |_, m| m.flare.as_ref()?.error_mean),
    measure("worst", "the same in the worst frame", |_, m| m.flare.as_ref()?.error_max),
];

/// Times always; errors and work only where they were measured, flares where there are any.
pub fn tables(results: &Results) -> Vec<Table> {
    let all = [("Time and memory", TIMES), ("Errors against the truth", ERRORS), ("What was culled and done", WORK)];
    let known = if is_measured(results) { all.len() } else { 1 };
    let flares = ("Lens flare", FLARES);
    let with_flares = known > 1 && results.methods.iter().any(|method| method.flare.is_some());
    let tables = all[..known].iter().chain(with_flares.then_some(&flares));
    tables.map(|(title, measures)| table(results, title, measures)).collect()
}

fn table(results: &Results, title: &'static str, measures: &[Measure]) -> Table {
    let cell =
        |method: &Method, measure: &Measure| (measure.of)(results, method).map_or(measure.nothing.to_owned(), number);
    Table {
        title,
        columns: measures.iter().map(|measure| Column { name: measure.name, meaning: measure.meaning }).collect(),
        rows: results
            .methods
            .iter()
            .map(|method| Row {
                label: method.label.clone(),
                guarantee: method.guarantee.clone(),
                cells: measures.iter().map(|measure| cell(method, measure)).collect(),
            })
            .collect(),
    }
}
