//! What a table runs: its places, filled with methods and warps as far as there are any, gathered into runs.

use super::{Change, Column, Table, Variant};
use crate::run::methods::parse_setting;
use anyhow::{bail, Context, Result};
use culling::{warp, Entry, Options};

/// What columns call a warp on its own, which is no method.
pub(super) const WARP: &str = "warp";

/// A method as it stands in a table: entry and settings.
pub type Chosen = (&'static Entry, Options);

/// What a table runs.
#[derive(Debug, Default)]
pub struct Plan {
    /// What runs together, in the order of the table; one for each change that its variants make to the run itself.
    pub runs: Vec<PlannedRun>,
    /// By variant and column, in this order: what stands there; none where Sightline does not have it.
    pub places: Vec<Option<Place>>,
}

/// What runs over the same frames.
#[derive(Debug)]
pub struct PlannedRun {
    /// What is other than the user says.
    pub change: Change,
    /// The methods, each once, in the order of the table.
    pub methods: Vec<Chosen>,
    /// Warps on their own, each once.
    pub warps: Vec<Options>,
    /// Labels of methods whose pictures are compared, the one to compare with first.
    pub pairs: Vec<[String; 2]>,
}

/// What stands in a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index of its run.
    pub run: usize,
    /// Its label in the run's results.
    pub label: String,
    /// The label of what it stands against.
    pub against: Option<String>,
}

/// What a column asks for, if it is there.
enum Found {
    Method(Chosen),
    Warp(Options),
}

impl Found {
    fn options(&self) -> &Options {
        match self {
            Found::Method((_, options)) | Found::Warp(options) => options,
        }
    }
}

impl Table {
    /// What to run. `sets` are what the user set beyond the table (`METHOD.OPTION=VALUE`).
    ///
    /// # Errors
    /// A method that lacks an option the table needs, or a setting of the user's that the table makes itself.
    pub fn plan(&self, sets: &[String]) -> Result<Plan> {
        let mut plan = Plan::default();
        for variant in self.variants {
            for column in self.columns {
                let place = self.place(&mut plan, variant, column, sets)?;
                plan.places.push(place);
            }
        }
        Ok(plan)
    }

    fn place(&self, plan: &mut Plan, variant: &Variant, column: &Column, sets: &[String]) -> Result<Option<Place>> {
        if matches!(variant.change, Change::NotYet(_)) {
            return Ok(None);
        }
        let against = match column.against {
            Some(other) => Some(self.found(variant, other, sets)?),
            None => None,
        };
        // Nothing stands there without what it stands against.
        let (Some(found), None | Some(Some(_))) = (self.found(variant, column, sets)?, &against) else {
            return Ok(None);
        };
        let run = plan.run(variant.change);
        let against = against.flatten().map(|other| plan.runs[run].add(other));
        let compares = matches!(found, Found::Method(_));
        let label = plan.runs[run].add(found);
        if let Some(other) = against.as_ref().filter(|_| compares) {
            plan.runs[run].pairs.push([other.clone(), label.clone()]);
        }
        Ok(Some(Place { run, label, against }))
    }

    /// What a column asks for, or none if it is not there.
    fn found(&self, variant: &Variant, column: &Column, sets: &[String]) -> Result<Option<Found>> {
        let entry = culling::METHODS.iter().find(|entry| entry.id == column.method);
        let mut found = match entry {
            Some(entry) => Found::Method((entry, entry.default_options())),
            None if column.method == WARP => Found::Warp(Options::new(WARP, warp::OPTIONS)),
            None => return Ok(None),
        };
        let (Found::Method((_, options)) | Found::Warp(options)) = &mut found;
        let own = || column.settings.iter().chain(variant.settings);
        for set in sets {
            let (method, name, value) = setting(set)?;
            if method != column.method {
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
        Ok(Some(found))
    }

    /// What the table names and Sightline does not have, each once.
    pub(super) fn missing(&self) -> Vec<&'static str> {
        let is_there = |id: &str| id == WARP || culling::METHODS.iter().any(|entry| entry.id == id);
        let methods = self.columns.iter().map(|column| column.method).filter(|id| !is_there(id));
        let variants = self.variants.iter().filter_map(|variant| match variant.change {
            Change::NotYet(what) => Some(what),
            _ => None,
        });
        let mut missing: Vec<&str> = Vec::new();
        for name in methods.chain(variants) {
            if !missing.contains(&name) {
                missing.push(name);
            }
        }
        missing
    }
}

/// Method, option and value of what the user set; the method may be a warp on its own.
fn setting(set: &str) -> Result<(&str, &str, &str)> {
    match set.split_once('.') {
        Some((WARP, setting)) => {
            let (name, value) =
                setting.split_once('=').with_context(|| format!("--set {set}: write warp.OPTION=VALUE"))?;
            Ok((WARP, name, value))
        }
        _ => parse_setting(set),
    }
}

impl Plan {
    /// The run of a change, begun if it is new.
    fn run(&mut self, change: Change) -> usize {
        let known = self.runs.iter().position(|run| run.change == change);
        known.unwrap_or_else(|| {
            self.runs.push(PlannedRun { change, methods: Vec::new(), warps: Vec::new(), pairs: Vec::new() });
            self.runs.len() - 1
        })
    }
}

impl PlannedRun {
    /// Adds what is not there yet, and gives its label.
    fn add(&mut self, found: Found) -> String {
        let label = found.options().label();
        match found {
            Found::Method(chosen) if self.methods.iter().all(|(_, options)| options.label() != label) => {
                self.methods.push(chosen);
            }
            Found::Warp(options) if self.warps.iter().all(|options| options.label() != label) => {
                self.warps.push(options);
            }
            _ => {}
        }
        label
    }
}
