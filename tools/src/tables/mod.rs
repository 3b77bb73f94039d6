//! The papers' tables, run on our scenes and printed beside what was published, and tables of our own: `sightline bench
//! --table ID`.
//!
//! A table is one entry of [`TABLES`]: which methods with which settings stand in its columns and rows, what is measured,
//! and the published figures, which are in one module per paper (`tables/eovc.rs`, `tables/woc.rs`, `tables/tog.rs`). What is
//! ours (`tables/lean.rs`) has no published figures, but goals.

mod eovc;
mod gems;
mod goals;
mod lean;
mod measure;
pub mod persistence;
mod plan;
mod print;
#[cfg(test)]
mod tests;
mod tog;
pub mod warp_errors;
mod woc;
mod zachmann;

pub use goals::Goals;
pub use measure::{Measure, Stages};
pub use persistence::HiddenRuns;
pub use plan::{Chosen, Place, Plan, PlannedRun};
pub use print::text;

use crate::measures::metrics::DepthErrors;
use crate::results::Results;
use crate::run::session::SessionOptions;
use anyhow::{Context, Result};
use std::collections::BTreeMap;

/// A table and how to run it.
#[derive(Debug)]
pub struct Table {
    /// Its name on the command line.
    pub id: &'static str,
    /// What it shows, in one line.
    pub title: &'static str,
    /// Where it was published; or that it was not.
    pub source: Source,
    /// Methods from left to right.
    pub columns: &'static [Column],
    /// Settings from top to bottom, within each scene.
    pub variants: &'static [Variant],
    /// What a cell's times are compared with, on the line below.
    pub ratio: Ratio,
    /// The published figures by scene, in the paper's order; none of a table of ours.
    pub published: &'static [Published],
    /// What a reader must know, a line each.
    pub notes: &'static [&'static str],
    /// What is expected of a method, if anything is.
    pub goals: Option<Goals>,
}

/// Where a table comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// A paper, and the table's number in it.
    Paper(&'static Paper, u32),
    /// A paper that says it in words, or draws it without figures, in this place; what it says is in the table's notes.
    Said(&'static Paper, &'static str),
    /// Sightline: no paper has it, and nothing is published to stand beside it.
    Ours {
        /// Names of the scenes that it is run on.
        scenes: &'static [&'static str],
        /// The path where no row names another, and whether a run goes the whole of it.
        path: (&'static str, bool),
        /// Frames of the warm-up where the user names no number.
        warmup: usize,
    },
}

/// Where a table was published.
#[derive(Debug)]
pub struct Paper {
    /// Short name.
    pub name: &'static str,
    /// Machine, interface and picture size of its measurements.
    pub measured_on: &'static str,
    /// How long its camera sequences last.
    pub seconds: f64,
    /// The path of ours that stands for its sequences, and whether a run goes the whole of it.
    pub path: (&'static str, bool),
    /// Its scenes.
    pub scenes: &'static [PaperScene],
}

/// A scene of a paper.
#[derive(Debug)]
pub struct PaperScene {
    /// Its short name in the paper.
    pub name: &'static str,
    /// The name of the scene of ours that is built after it.
    pub ours: &'static str,
    /// Objects in the paper; none if it does not say.
    pub objects: Option<u64>,
}

/// A method with settings, and its name at the head of a column.
#[derive(Debug)]
pub struct Column {
    /// The paper's name.
    pub head: &'static str,
    /// The method's id in [`culling::METHODS`], or `warp` for depth warping on its own. What is neither has an empty column.
    pub method: &'static str,
    /// Options and values.
    pub settings: &'static [(&'static str, &'static str)],
    /// What stands in a cell, one number each.
    pub shows: &'static [Measure],
    /// Decimals of the published figures.
    pub decimals: usize,
    /// What the method is compared with, where the measure is of two.
    pub against: Option<&'static Column>,
}

impl Column {
    /// A method with its default settings.
    const fn new(head: &'static str, method: &'static str, shows: &'static [Measure], decimals: usize) -> Self {
        Column { head, method, settings: &[], shows, decimals, against: None }
    }

    /// A method with settings.
    const fn with(self, settings: &'static [(&'static str, &'static str)]) -> Self {
        Column { settings, ..self }
    }

    /// A method compared with another.
    const fn against(self, other: &'static Column) -> Self {
        Column { against: Some(other), ..self }
    }
}

/// What all of a row's methods share.
#[derive(Debug)]
pub struct Variant {
    /// The paper's name; empty in a table with one row a scene.
    pub name: &'static str,
    /// Options and values.
    pub settings: &'static [(&'static str, &'static str)],
    /// What it changes of the run itself.
    pub change: Change,
}

impl Variant {
    /// A row of other settings.
    const fn set(name: &'static str, settings: &'static [(&'static str, &'static str)]) -> Self {
        Variant { name, settings, change: Change::Nothing }
    }

    /// A row of another run.
    const fn run(name: &'static str, change: Change) -> Self {
        Variant { name, settings: &[], change }
    }
}

/// The only variant of a table with one row a scene.
const ONE_ROW: &[Variant] = &[Variant::set("", &[])];

/// What a variant changes of the run itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Nothing.
    Nothing,
    /// Each side of the picture is so many times as long.
    Size(f64),
    /// The camera goes so many times as fast.
    Speed(f64),
    /// It goes another path.
    Path(&'static str),
    /// Meshes of procedural scenes are divided so finely (`--detail-level`).
    Detail(u32),
    /// It needs this, which Sightline does not have: the row stays empty.
    NotYet(&'static str),
}

impl Change {
    /// Makes the change.
    pub fn make(self, session: &mut SessionOptions) {
        match self {
            Change::Size(times) => session.size = session.size.map(|side| (f64::from(side) * times).round() as u32),
            Change::Speed(times) => session.speed *= times,
            Change::Path(name) => session.path = Some(name.into()),
            Change::Detail(level) => session.detail = level,
            Change::Nothing | Change::NotYet(_) => {}
        }
    }

    /// The folder of a changed run below its scene's; none if nothing is changed.
    pub fn folder(self) -> Option<String> {
        match self {
            Change::Size(times) => Some(format!("size-{times}x")),
            Change::Speed(times) => Some(format!("speed-{times}x")),
            Change::Path(name) => Some(format!("path-{name}")),
            Change::Detail(level) => Some(format!("detail-{level}")),
            Change::Nothing | Change::NotYet(_) => None,
        }
    }
}

/// What stands below a line of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ratio {
    /// Nothing.
    None,
    /// The number over that of the column with this head: above 1 is slower.
    Over(&'static str),
    /// That of the column with this head over the number: above 1 is faster.
    SpeedUp(&'static str),
    /// The number over that of the first variant in its column: above 1 is slower.
    OverFirstVariant,
}

/// A paper's figures for one scene.
#[derive(Debug)]
pub struct Published {
    /// The scene's name in the paper.
    pub scene: &'static str,
    /// By variant, column and measure, in this order.
    pub figures: &'static [f64],
}

/// What one run of a plan came to.
#[derive(Debug)]
pub struct Ran {
    /// Scene, device, path and the methods; of a run of warps alone, without methods.
    pub results: Results,
    /// By a warp's label: its errors in each frame that has one before it.
    pub warps: BTreeMap<String, Vec<DepthErrors>>,
    /// How long what was hidden stayed hidden, if a cell needs it.
    pub hidden: Option<HiddenRuns>,
}

/// Every table that can be run again.
pub const TABLES: &[&Table] = &[
    &eovc::TABLE_2,
    &eovc::TABLE_3,
    &eovc::TABLE_4,
    &eovc::TABLE_5,
    &woc::TABLE_1,
    &woc::TABLE_2,
    &woc::TABLE_3,
    &tog::TABLE_2,
    &tog::TABLE_5,
    &tog::TABLE_6,
    &tog::TABLE_7,
    &gems::TABLE,
    &zachmann::BATCHES,
    &zachmann::CHC,
    &zachmann::CHC_BATCHES,
    &zachmann::PERSISTENCE,
    &zachmann::POLYGONS,
    &lean::TABLE,
];

/// The table of that name.
pub fn find(id: &str) -> Result<&'static Table> {
    let ids = || TABLES.iter().map(|table| table.id).collect::<Vec<_>>().join(", ");
    TABLES
        .iter()
        .copied()
        .find(|table| table.id == id)
        .with_context(|| format!("no table '{id}'; there are: {}", ids()))
}

impl Table {
    /// What it is called: its paper and number, or its id.
    pub fn name(&self) -> String {
        match self.source {
            Source::Paper(paper, number) => format!("{}, table {number}", paper.name),
            Source::Said(paper, place) => format!("{}, {place}", paper.name),
            Source::Ours { .. } => format!("Sightline, table {}", self.id),
        }
    }

    /// The paper that published it.
    pub fn paper(&self) -> Option<&'static Paper> {
        match self.source {
            Source::Paper(paper, _) | Source::Said(paper, _) => Some(paper),
            Source::Ours { .. } => None,
        }
    }

    /// The scenes it is run on where none is named: ours that stand for those that it was published of.
    pub fn scenes(&self) -> Vec<&'static str> {
        let is_published = |scene: &&PaperScene| self.published.iter().any(|row| row.scene == scene.name);
        match self.source {
            Source::Paper(paper, _) => paper.scenes.iter().filter(is_published).map(|scene| scene.ours).collect(),
            Source::Said(paper, _) => paper.scenes.iter().map(|scene| scene.ours).collect(),
            Source::Ours { scenes, .. } => scenes.to_vec(),
        }
    }

    /// The path where the user names none, and whether a run goes the whole of it.
    pub fn path(&self) -> (&'static str, bool) {
        match self.source {
            Source::Paper(paper, _) | Source::Said(paper, _) => paper.path,
            Source::Ours { path, .. } => path,
        }
    }

    /// Frames of the warm-up where the user names no number, if the table has its own.
    pub fn warmup(&self) -> Option<usize> {
        match self.source {
            Source::Paper(..) | Source::Said(..) => None,
            Source::Ours { warmup, .. } => Some(warmup),
        }
    }

    /// True if a cell needs the comparison with the truth.
    pub fn needs_truth(&self) -> bool {
        self.columns.iter().flat_map(|column| column.shows).any(|measure| measure.needs_truth())
    }

    /// True if a cell says how long what is hidden stays hidden.
    pub fn needs_hidden_runs(&self) -> bool {
        self.columns.iter().flat_map(|column| column.shows).any(|measure| matches!(measure, Measure::HiddenAgain(_)))
    }

    /// Numbers in a row.
    fn numbers_in_row(&self) -> usize {
        self.columns.iter().map(|column| column.shows.len()).sum()
    }

    /// Where a column's numbers begin in a row.
    fn first_number(&self, column: usize) -> usize {
        self.columns[..column].iter().map(|column| column.shows.len()).sum()
    }
}
