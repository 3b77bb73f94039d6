//! The papers' tables, run on our scenes and printed beside what was published: `sightline bench --table ID`.
//!
//! A table is one entry of [`TABLES`]: which methods with which settings stand in its columns and rows, what is measured,
//! and the published figures, which are in one module per paper (`tables/eovc.rs`).

mod eovc;
mod print;
#[cfg(test)]
mod tests;

pub use print::text;

use crate::cli::parse_setting;
use crate::results::Method;
use anyhow::{bail, Context, Result};
use culling::{Entry, Options};

/// A published table and how to run it again.
#[derive(Debug)]
pub struct Table {
    /// Its name on the command line.
    pub id: &'static str,
    /// What it shows, in one line.
    pub title: &'static str,
    /// Where it was published, and on what it was measured.
    pub paper: &'static Paper,
    /// Number of the table in the paper.
    pub number: u32,
    /// Decimals of the published figures.
    pub decimals: usize,
    /// Methods from left to right.
    pub columns: &'static [Column],
    /// Settings from top to bottom, within each scene.
    pub variants: &'static [Variant],
    /// What stands in a cell, one number each.
    pub measures: &'static [Measure],
    /// What a cell's first number is compared with, on the line below.
    pub ratio: Ratio,
    /// The published figures by scene, in the paper's order.
    pub published: &'static [Published],
    /// What a reader must know, a line each.
    pub notes: &'static [&'static str],
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
    /// Objects in the paper.
    pub objects: u64,
}

/// A method with settings, and its name at the head of a column.
#[derive(Debug)]
pub struct Column {
    /// The paper's name.
    pub head: &'static str,
    /// The method's id in [`culling::METHODS`]. A method that is not there has an empty column.
    pub method: &'static str,
    /// Options and values.
    pub settings: &'static [(&'static str, &'static str)],
}

/// Settings that all of a row's methods share.
#[derive(Debug)]
pub struct Variant {
    /// The paper's name; empty in a table with one row a scene.
    pub name: &'static str,
    /// Options and values.
    pub settings: &'static [(&'static str, &'static str)],
}

/// The only variant of a table with one row a scene.
const ONE_ROW: &[Variant] = &[Variant { name: "", settings: &[] }];

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Mean frame time in milliseconds.
    FrameMs,
    /// Objects culled over all, C/N.
    CulledOverTotal,
    /// Objects culled over those that ideal culling culls, C/R.
    CulledOverRef,
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

/// A method as it stands in a table: entry and settings.
pub type Chosen = (&'static Entry, Options);

/// Every table that can be run again.
pub const TABLES: &[&Table] = &[&eovc::TABLE_2, &eovc::TABLE_3, &eovc::TABLE_4, &eovc::TABLE_5];

/// The table of that name.
pub fn find(id: &str) -> Result<&'static Table> {
    let ids = || TABLES.iter().map(|table| table.id).collect::<Vec<_>>().join(", ");
    TABLES
        .iter()
        .copied()
        .find(|table| table.id == id)
        .with_context(|| format!("no table '{id}'; there are: {}", ids()))
}

/// What a table runs.
#[derive(Debug, Default)]
pub struct Plan {
    /// The methods, each once, in the order of the table.
    pub methods: Vec<Chosen>,
    /// By variant and column, in this order: the method's label in results, or none where there is no such method.
    pub labels: Vec<Option<String>>,
}

impl Table {
    /// What to run. `sets` are what the user set beyond the table (`METHOD.OPTION=VALUE`).
    ///
    /// # Errors
    /// A method that lacks an option the table needs, or a setting of the user's that the table makes itself.
    pub fn plan(&self, sets: &[String]) -> Result<Plan> {
        let mut plan = Plan::default();
        let places = self.variants.iter().flat_map(|variant| self.columns.iter().map(move |column| (variant, column)));
        for (variant, column) in places {
            let chosen = self.chosen(variant, column, sets)?;
            plan.labels.push(chosen.as_ref().map(|(_, options)| options.label()));
            let Some(chosen) = chosen else { continue };
            if plan.methods.iter().all(|(_, options)| options.label() != chosen.1.label()) {
                plan.methods.push(chosen);
            }
        }
        Ok(plan)
    }

    /// The method of one place, or none if there is no such method.
    fn chosen(&self, variant: &Variant, column: &Column, sets: &[String]) -> Result<Option<Chosen>> {
        let Some(entry) = culling::METHODS.iter().find(|entry| entry.id == column.method) else { return Ok(None) };
        let mut options = entry.default_options();
        let own = || column.settings.iter().chain(variant.settings);
        for set in sets {
            let (method, name, value) = parse_setting(set)?;
            if method != entry.id {
                continue;
            }
            if own().any(|(own, _)| *own == name) {
                bail!("--set {set}: table {} sets {method}.{name} itself; leave it out", self.id);
            }
            options.set(name, value).with_context(|| format!("--set {set}"))?;
        }
        for (name, value) in own() {
            let needs = || format!("table {} cannot be run: its column {} needs {name}={value}", self.id, column.head);
            options.set(name, value).with_context(needs)?;
        }
        Ok(Some((entry, options)))
    }

    /// True if a cell needs the comparison with the truth.
    pub fn needs_truth(&self) -> bool {
        self.measures.iter().any(|measure| *measure != Measure::FrameMs)
    }
}

impl Measure {
    /// What a method's results say.
    pub fn of(self, method: &Method) -> f64 {
        match self {
            Measure::FrameMs => method.frame_ms.mean,
            Measure::CulledOverTotal => method.culled_over_total,
            Measure::CulledOverRef => method.culled_over_ref,
        }
    }
}
