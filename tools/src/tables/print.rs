//! A table as text: our scenes' rows, each above the paper's row of the same scene or of the nearest, then the paper's others.
//! A table of ours has none of the paper's, and its goals below.

use super::goals::goals_text;
use super::measure::decimal;
use super::{Column, Measure, Paper, PaperScene, Place, Plan, Published, Ran, Ratio, Table};
use crate::results::grid::{clipped, Grid};
use crate::results::Results;

/// The table of some runs: by scene, those of the plan. Fits 120 columns.
pub fn text(table: &Table, plan: &Plan, scenes: &[Vec<Ran>]) -> String {
    let heads = ["objects"].into_iter().chain(table.columns.iter().map(|column| column.head)).collect();
    let mut grid = Grid::new(heads, 0);
    let mut shown: Vec<&str> = Vec::new();
    for runs in scenes {
        let Some(Ran { results: first, .. }) = runs.first() else { continue };
        let (name, objects) = (first.scene.name.clone(), Some(first.scene.objects));
        let ours = Block { name, objects, numbers: numbers(table, plan, runs), ours: true };
        ours.rows(table, &mut grid);
        let Some((scene, how)) = counterpart(table, first) else { continue };
        published(table, scene, how, &mut grid);
        shown.push(scene.name);
    }
    let of_paper = table.paper().map_or(&[][..], |paper| paper.scenes);
    for scene in of_paper.iter().filter(|scene| !shown.contains(&scene.name)) {
        published(table, scene, "", &mut grid);
    }
    grid.fill_width();
    let runs: Vec<&Results> = scenes.iter().flatten().map(|ran| &ran.results).collect();
    let mut lines = vec![format!("{}: {}", table.name(), table.title)];
    lines.extend(run_lines(&runs));
    lines.push(String::new());
    lines.extend(grid.lines("scene"));
    lines.extend(goals_text(table, plan, scenes));
    lines.push(String::new());
    lines.extend(notes(table, &runs));
    lines.iter().map(|line| format!("{}\n", line.trim_end())).collect()
}

/// The lines of one scene: for each variant its numbers, and below them their ratios.
struct Block {
    name: String,
    objects: Option<u64>,
    /// By variant, column and measure.
    numbers: Vec<Option<f64>>,
    /// Written as ours, otherwise with the paper's decimals.
    ours: bool,
}

impl Block {
    fn rows(&self, table: &Table, grid: &mut Grid) {
        let (columns, width) = (table.columns.len(), table.numbers_in_row());
        let ratios = ratios(table, &self.numbers);
        let rows = table.variants.iter().zip(self.numbers.chunks(width));
        for (index, (variant, row)) in rows.enumerate() {
            if row.iter().all(Option::is_none) && table.variants.len() > 1 {
                continue;
            }
            let objects = self.objects.map_or("-".to_owned(), |objects| objects.to_string());
            let name = [self.name.as_str(), variant.name].join(" ");
            grid.rows.push((name.trim_end().to_owned(), [objects].into_iter().chain(self.cells(table, row)).collect()));
            let Some(label) = ratio_label(table, index) else { continue };
            let row = ratios[index * columns..(index + 1) * columns].iter().cloned();
            grid.rows.push((format!("  {label}"), [String::new()].into_iter().chain(row).collect()));
        }
    }

    fn cells(&self, table: &Table, row: &[Option<f64>]) -> Vec<String> {
        let cell = |index: usize| {
            let column = &table.columns[index];
            let values = &row[table.first_number(index)..];
            let one = |(measure, value): (&Measure, &Option<f64>)| match value {
                None => "-".to_owned(),
                Some(value) if self.ours => measure.shown(*value),
                Some(value) => decimal(*value, column.decimals),
            };
            column.shows.iter().zip(values).map(one).collect::<Vec<_>>().join(" ")
        };
        (0..table.columns.len()).map(cell).collect()
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

/// By variant and column: a cell's times against their bases, each; a dash where there are none.
fn ratios(table: &Table, numbers: &[Option<f64>]) -> Vec<String> {
    let (columns, width) = (table.columns.len(), table.numbers_in_row());
    let column_of = |head: &str| table.columns.iter().position(|column| column.head == head);
    let at = |variant: usize, column: usize, number: usize| {
        let is_time = table.columns[column].shows.get(number)?.is_time();
        numbers[variant * width + table.first_number(column) + number].filter(|_| is_time)
    };
    let one = |variant: usize, column: usize, number: usize| {
        let at = |variant, column| at(variant, column, number);
        let (part, base) = match table.ratio {
            Ratio::None => return None,
            Ratio::Over(head) => (at(variant, column), at(variant, column_of(head)?)),
            Ratio::SpeedUp(head) => (at(variant, column_of(head)?), at(variant, column)),
            Ratio::OverFirstVariant => (at(variant, column), at(0, column)),
        };
        let ratio = part? / base?;
        ratio.is_finite().then_some(ratio)
    };
    let cell = |place: usize| {
        let (variant, column) = (place / columns, place % columns);
        let times = table.columns[column].shows.iter().enumerate().filter(|(_, measure)| measure.is_time());
        let ratios: Vec<String> = times.map(|(number, _)| two_decimals(one(variant, column, number))).collect();
        if ratios.is_empty() {
            "-".to_owned()
        } else {
            ratios.join(" ")
        }
    };
    (0..table.variants.len() * columns).map(cell).collect()
}

fn numbers(table: &Table, plan: &Plan, runs: &[Ran]) -> Vec<Option<f64>> {
    let columns = table.columns.iter().cycle();
    let of_place = |(place, column): (&Option<Place>, &Column)| {
        let number = |measure: &Measure| {
            let place = place.as_ref()?;
            measure.of(runs.get(place.run)?, place)
        };
        column.shows.iter().map(number).collect::<Vec<_>>()
    };
    plan.places.iter().zip(columns).flat_map(of_place).collect()
}

/// The paper's row under ours: the same scene by name, otherwise the one with the nearest number of objects.
fn counterpart(table: &Table, run: &Results) -> Option<(&'static PaperScene, &'static str)> {
    let is_published = |scene: &&PaperScene| table.published.iter().any(|row| row.scene == scene.name);
    let paper = table.paper()?;
    let scenes = || paper.scenes.iter().filter(is_published);
    if let Some(same) = scenes().find(|scene| scene.ours == run.scene.name) {
        return Some((same, " (same)"));
    }
    let times_larger = |objects: u64| (objects as f64 / run.scene.objects.max(1) as f64).ln().abs();
    let known = scenes().filter_map(|scene| Some((scene, times_larger(scene.objects?))));
    let nearest = known.min_by(|(_, a), (_, b)| a.total_cmp(b));
    nearest.map(|(scene, _)| (scene, " (nearest)"))
}

fn published(table: &Table, scene: &PaperScene, how: &str, grid: &mut Grid) {
    let Some(Published { figures, .. }) = table.published.iter().find(|row| row.scene == scene.name) else { return };
    let name = format!("paper {}{how}", scene.name);
    let numbers = figures.iter().copied().map(Some).collect();
    Block { name, objects: scene.objects, numbers, ours: false }.rows(table, grid);
}

fn two_decimals(ratio: Option<f64>) -> String {
    ratio.map_or("-".into(), |ratio| format!("{ratio:.2}"))
}

/// What ran, on what: a line for the device, and one for each scene.
fn run_lines(runs: &[&Results]) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for run in runs {
        let device = format!("ours on {} ({}) · {}", run.device.name, run.device.kind, run.device.driver);
        if !lines.contains(&device) {
            lines.push(device);
        }
        let size = |run: &Results| format!("{} frames of {}x{}", run.frames, run.size[0], run.size[1]);
        let mut paths: Vec<&str> = Vec::new();
        for other in runs.iter().filter(|other| (&other.scene.name, size(other)) == (&run.scene.name, size(run))) {
            if !paths.contains(&other.path.as_str()) {
                paths.push(&other.path);
            }
        }
        let line = clipped(&format!("{}: path {} · {}", run.scene.name, paths.join(", "), size(run)));
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines
}

fn notes(table: &Table, runs: &[&Results]) -> Vec<String> {
    let mut lines = match table.paper() {
        Some(paper) => vec![
            format!("{}: measured on {}.", paper.name, paper.measured_on),
            "Compare ratios, not milliseconds. (same): our scene is built after the paper's; (nearest): another scene, whose".to_owned(),
            "number of objects is the nearest; the rest have no scene of ours in this run.".to_owned(),
        ],
        None => vec!["Ours: no paper has this table, and no figures are published for it. Compare ratios, not milliseconds.".to_owned()],
    };
    if runs.iter().any(|run| run.device.kind == "cpu") {
        lines.push("Ours ran on a cpu device: its times show that the methods run, and are no results.".to_owned());
    }
    let missing = table.missing();
    if !missing.is_empty() {
        lines.push(format!("Empty or left out is what Sightline does not have yet: {}.", missing.join(", ")));
    }
    lines.extend(table.notes.iter().map(|note| (*note).to_owned()));
    lines.extend(errors_line(runs).filter(|_| table.goals.is_some()));
    lines.extend(table.paper().map_or(Vec::new(), |paper| hurry(paper, runs)));
    lines
}

/// What the methods lost, all together: times of a method that draws less than there is say nothing.
fn errors_line(runs: &[&Results]) -> Option<String> {
    let methods = || runs.iter().flat_map(|run| &run.methods);
    methods().next()?;
    if methods().any(|method| method.frames.drawn.is_empty()) {
        return Some("Errors were not measured (--no-metrics).".to_owned());
    }
    let lost: u64 = methods().map(|method| method.false_negatives).sum();
    let pixels: u64 = methods().flat_map(|method| &method.frames.differing_pixels).sum();
    Some(format!("In all frames of all methods {lost} visible objects were lost, and {pixels} pixels have another depth than the truth."))
}

/// What a run that hurries along its whole way must say.
fn hurry(paper: &Paper, runs: &[&Results]) -> Vec<String> {
    let frames = paper.seconds * 60.0;
    let hurried = runs.iter().filter(|run| run.path.contains(" whole") && f64::from(run.frames) < frames);
    let Some(fewest) = hurried.map(|run| run.frames).min() else { return Vec::new() };
    vec![
        format!(
            "The whole way in {fewest} frames is {:.0} times the {} s of the paper (at 60 Hz): that costs what relies on",
            frames / f64::from(fewest),
            paper.seconds
        ),
        format!("the last frame. --frames {frames} is its speed."),
    ]
}
