//! Bars from left to right, one row a method: a plot that stages and culled objects share.

use super::plot::{fitted, px, text_width, Axis, Scale, Tick, WIDTH};
use serde::Serialize;

const ROW: f64 = 24.0;
const TOP: f64 = 8.0;
/// Space right of the longest bar for the value.
const VALUE: f64 = 80.0;
/// Widest column of labels; longer ones are cut.
const LABELS: f64 = 280.0;

/// The plot.
#[derive(Serialize)]
pub struct Bars {
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    ticks: Vec<Tick>,
    unit: String,
    rows: Vec<Row>,
    alt: String,
}

#[derive(Serialize)]
struct Row {
    label: String,
    tip: String,
    y: f64,
    segments: Vec<Segment>,
    value: String,
    value_x: f64,
}

#[derive(Serialize)]
struct Segment {
    x: f64,
    y: f64,
    width: f64,
    height: f64,
    class: String,
    tip: String,
}

/// What a row shows.
pub struct RowData {
    /// In front of the row.
    pub label: String,
    /// Lanes, one below the other; each a chain of parts.
    pub lanes: Vec<Vec<Part>>,
    /// Behind the row.
    pub value: String,
}

/// A piece of a bar.
pub struct Part {
    /// Its length in the plot's unit.
    pub length: f64,
    /// Its class in the style sheet.
    pub class: String,
    /// What it is, with its value.
    pub tip: String,
}

/// Bars over an axis from 0 to the longest, at least to `least`. None without rows or if all are empty.
pub fn bars(rows: Vec<RowData>, unit: &str, least: f64, alt: String) -> Option<Bars> {
    let length = |lane: &Vec<Part>| lane.iter().map(|part| part.length).sum::<f64>();
    let longest = rows.iter().flat_map(|row| &row.lanes).map(length).fold(least, f64::max);
    if rows.is_empty() || longest <= 0.0 {
        return None;
    }
    let widest = rows.iter().map(|row| text_width(&row.label)).fold(60.0, f64::max);
    let left = px(widest.min(LABELS) + 12.0);
    let axis = Axis { scale: Scale::Linear, values: [0.0, longest], pixels: [left, WIDTH - VALUE] };
    let bottom = TOP + ROW * rows.len() as f64;
    Some(Bars {
        height: bottom + 44.0,
        left,
        right: WIDTH - VALUE,
        top: TOP,
        bottom,
        ticks: axis.ticks(),
        unit: unit.to_owned(),
        rows: rows
            .into_iter()
            .enumerate()
            .map(|(place, data)| row(data, TOP + ROW * place as f64, &axis, widest))
            .collect(),
        alt,
    })
}

fn row(data: RowData, y: f64, axis: &Axis, widest: f64) -> Row {
    const GAP: f64 = 3.0;
    let height = px((ROW - 2.0 * GAP) / data.lanes.len().max(1) as f64);
    let mut segments = Vec::new();
    let mut end = axis.pixels[0];
    for (lane, parts) in data.lanes.into_iter().enumerate() {
        let mut from = 0.0;
        for part in parts.into_iter().filter(|part| part.length > 0.0) {
            let x = axis.place(from);
            from += part.length;
            let width = px(axis.place(from) - x);
            end = end.max(x + width);
            let y = px(y + GAP + height * lane as f64);
            segments.push(Segment { x, y, width, height, class: part.class, tip: part.tip });
        }
    }
    Row {
        label: fitted(&data.label, widest.min(LABELS)),
        tip: data.label,
        y: px(y + ROW / 2.0 + 4.0),
        segments,
        value: data.value,
        value_x: px(end + 6.0),
    }
}
