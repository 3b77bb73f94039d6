//! A table as text: our scenes' rows, each above the paper's row of the same scene or of the nearest, then the paper's others.

use super::{Measure, PaperScene, Plan, Published, Ratio, Table};
use crate::grid::{milliseconds, Grid};
use crate::results::Results;

/// The table of some runs, one a scene. Fits 120 columns.
pub fn text(table: &Table, plan: &Plan, runs: &[Results]) -> String {
    let heads = ["objects"].into_iter().chain(table.columns.iter().map(|column| column.head)).collect();
    let mut grid = Grid::new(heads, if table.measures.len() > 1 { 20 } else { 24 });
    let mut shown: Vec<&str> = Vec::new();
    for run in runs {
        let ours =
            Block { name: run.scene.name.clone(), objects: run.scene.objects, numbers: numbers(table, plan, run) };
        ours.rows(table, &|value| our_number(table.measures, value), &mut grid);
        let Some((scene, how)) = counterpart(table, run) else { continue };
        published(table, scene, how, &mut grid);
        shown.push(scene.name);
    }
    for scene in table.paper.scenes.iter().filter(|scene| !shown.contains(&scene.name)) {
        published(table, scene, "", &mut grid);
    }
    let mut lines = vec![format!("{}, table {}: {}", table.paper.name, table.number, table.title)];
    lines.extend(run_lines(runs));
    lines.push(String::new());
    lines.extend(grid.lines("scene"));
    lines.push(String::new());
    lines.extend(notes(table, plan, runs));
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// The lines of one scene: for each variant its numbers, and below them their ratios.
struct Block {
    name: String,
    objects: u64,
    /// By variant, column and measure.
    numbers: Vec<Option<f64>>,
}

impl Block {
    fn rows(&self, table: &Table, show: &dyn Fn(&[Option<f64>]) -> String, grid: &mut Grid) {
        let (columns, measures) = (table.columns.len(), table.measures.len());
        let ratios = ratios(table, &self.numbers);
        for (index, variant) in table.variants.iter().enumerate() {
            let row = &self.numbers[index * columns * measures..(index + 1) * columns * measures];
            let cells = [self.objects.to_string()].into_iter().chain(row.chunks(measures).map(show));
            let name = [self.name.as_str(), variant.name].join(" ");
            grid.rows.push((name.trim_end().to_owned(), cells.collect()));
            let Some(label) = ratio_label(table, index) else { continue };
            let row = ratios[index * columns..(index + 1) * columns].iter().map(|ratio| two_decimals(*ratio));
            grid.rows.push((format!("  {label}"), [String::new()].into_iter().chain(row).collect()));
        }
    }
}

/// What a line of ratios is called; none where there is no such line.
fn ratio_label(table: &Table, variant: usize) -> Option<String> {
    match table.ratio {
        Ratio::None => None,
        Ratio::Over(head) => Some(format!("over {head}")),
        Ratio::SpeedUp(head) => Some(format!("speed-up over {head}")),
        Ratio::OverFirstVariant if variant == 0 => None,
        Ratio::OverFirstVariant => Some(format!("over {}", table.variants[0].name)),
    }
}

/// By variant and column: a cell's first number against its base.
fn ratios(table: &Table, numbers: &[Option<f64>]) -> Vec<Option<f64>> {
    let (columns, measures) = (table.columns.len(), table.measures.len());
    let column_of = |head: &str| table.columns.iter().position(|column| column.head == head);
    let at = |variant: usize, column: usize| numbers[(variant * columns + column) * measures];
    let one = |place: usize| {
        let (variant, column) = (place / columns, place % columns);
        let (part, base) = match table.ratio {
            Ratio::None => return None,
            Ratio::Over(head) => (at(variant, column), at(variant, column_of(head)?)),
            Ratio::SpeedUp(head) => (at(variant, column_of(head)?), at(variant, column)),
            Ratio::OverFirstVariant => (at(variant, column), at(0, column)),
        };
        let ratio = part? / base?;
        ratio.is_finite().then_some(ratio)
    };
    (0..table.variants.len() * columns).map(one).collect()
}

fn numbers(table: &Table, plan: &Plan, run: &Results) -> Vec<Option<f64>> {
    let of_place = |label: &Option<String>| {
        let method = label.as_ref().and_then(|label| run.method(label));
        table.measures.iter().map(move |measure| method.map(|method| measure.of(method)))
    };
    plan.labels.iter().flat_map(of_place).collect()
}

/// The paper's row under ours: the same scene by name, otherwise the one with the nearest number of objects.
fn counterpart(table: &Table, run: &Results) -> Option<(&'static PaperScene, &'static str)> {
    let scenes = table.paper.scenes;
    if let Some(same) = scenes.iter().find(|scene| scene.ours == run.scene.name) {
        return Some((same, " (same)"));
    }
    let times_larger = |scene: &&PaperScene| (scene.objects as f64 / run.scene.objects.max(1) as f64).ln().abs();
    let nearest = scenes.iter().min_by(|a, b| times_larger(a).total_cmp(&times_larger(b)));
    nearest.map(|scene| (scene, " (nearest)"))
}

fn published(table: &Table, scene: &PaperScene, how: &str, grid: &mut Grid) {
    let Some(Published { figures, .. }) = table.published.iter().find(|row| row.scene == scene.name) else { return };
    let name = format!("paper {}{how}", scene.name);
    let numbers = figures.iter().copied().map(Some).collect();
    let show = |values: &[Option<f64>]| {
        let decimals = table.decimals;
        let shown = values.iter().map(|value| value.map_or("-".into(), |value| format!("{value:.decimals$}")));
        shown.collect::<Vec<_>>().join(" ")
    };
    Block { name, objects: scene.objects, numbers }.rows(table, &show, grid);
}

/// Our numbers with what digits they deserve. Shares are cut, not rounded: 1.000 is said only of all.
fn our_number(measures: &[Measure], values: &[Option<f64>]) -> String {
    let one = |(measure, value): (&Measure, &Option<f64>)| match (value, measure) {
        (None, _) => "-".to_owned(),
        (Some(value), Measure::FrameMs) => milliseconds(*value),
        (Some(value), Measure::CulledOverTotal | Measure::CulledOverRef) => {
            format!("{:.3}", (value * 1000.0).floor() / 1000.0)
        }
    };
    measures.iter().zip(values).map(one).collect::<Vec<_>>().join(" ")
}

fn two_decimals(ratio: Option<f64>) -> String {
    ratio.map_or("-".into(), |ratio| format!("{ratio:.2}"))
}

/// What ran, on what: a line for the device, and one for each scene.
fn run_lines(runs: &[Results]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for run in runs {
        let device = format!("ours on {} ({}) · {}", run.device.name, run.device.kind, run.device.driver);
        if !lines.contains(&device) {
            lines.push(device);
        }
        let [width, height] = run.size;
        let (name, path, frames) = (&run.scene.name, &run.path, run.frames);
        lines.push(format!("{name}: path {path} · {frames} frames of {width}x{height}"));
    }
    lines
}

fn notes(table: &Table, plan: &Plan, runs: &[Results]) -> Vec<String> {
    let mut lines = vec![
        format!("{}: measured on {}.", table.paper.name, table.paper.measured_on),
        "Compare ratios, not milliseconds. (same): our scene is built after the paper's; (nearest): another scene, whose".to_owned(),
        "number of objects is the nearest; the rest have no scene of ours in this run.".to_owned(),
    ];
    if runs.iter().any(|run| run.device.kind == "cpu") {
        lines.push("Ours ran on a cpu device: its times show that the methods run, and are no results.".to_owned());
    }
    let missing: Vec<&str> = (table.columns.iter().zip(&plan.labels))
        .filter(|(_, label)| label.is_none())
        .map(|(column, _)| column.method)
        .collect();
    if !missing.is_empty() {
        lines.push(format!("-: Sightline does not have these methods yet: {}.", missing.join(", ")));
    }
    lines.extend(table.notes.iter().map(|note| (*note).to_owned()));
    let frames = table.paper.seconds * 60.0;
    let hurried = runs.iter().filter(|run| run.path.contains(" whole") && f64::from(run.frames) < frames);
    if let Some(fewest) = hurried.map(|run| run.frames).min() {
        lines.push(format!(
            "The whole way in {fewest} frames is {:.0} times the {} s of the paper (at 60 Hz): that costs what relies on",
            frames / f64::from(fewest),
            table.paper.seconds
        ));
        lines.push(format!("the last frame. --frames {frames} is its speed."));
    }
    lines
}
