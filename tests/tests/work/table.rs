//! Which option decides which work.

use super::count::Run;

/// How much more work there is.
#[derive(Clone, Copy)]
pub enum More {
    /// Any number more.
    Strictly,
    /// So many times as much, exactly.
    Times(u64),
}

/// An option, two of its values, and the work that one of them does more of.
#[derive(Clone, Copy)]
pub struct Row {
    /// Methods that have the option; all that do if empty.
    pub methods: &'static [&'static str],
    /// The option's name.
    pub option: &'static str,
    /// The value with less work.
    pub less: &'static str,
    /// The value with more work.
    pub more: &'static str,
    /// The name of a count (`count.rs`).
    pub counted: &'static str,
    /// How much more.
    pub by: More,
    /// Other options, the same in both runs.
    pub base: &'static [(&'static str, &'static str)],
    /// The run; none takes the method's own.
    pub run: Option<Run>,
}

const WALK: Run = ("city-block", 0.02, "walk");
const ROTATE: Run = ("city-block", 0.02, "rotate");
const ROOMS: Run = ("rooms", 0.1, "walk");

impl Row {
    const fn new(
        methods: &'static [&'static str],
        option: &'static str,
        values: [&'static str; 2],
        counted: &'static str,
    ) -> Self {
        let [less, more] = values;
        Row { methods, option, less, more, counted, by: More::Strictly, base: &[], run: None }
    }

    const fn times(self, times: u64) -> Self {
        Row { by: More::Times(times), ..self }
    }

    const fn with(self, base: &'static [(&'static str, &'static str)]) -> Self {
        Row { base, ..self }
    }

    const fn on(self, run: Run) -> Self {
        Row { run: Some(run), ..self }
    }

    /// The run of a method: portals need rooms.
    pub fn run_of(&self, method: &str) -> Run {
        match (self.run, method) {
            (Some((_, _, path)), "portals") => (ROOMS.0, ROOMS.1, path),
            (Some(run), _) => run,
            (None, _) => recorded_run(method),
        }
    }
}

/// Boxes of which some move.
pub const MOVING: Run = ("moving-boxes", 1.0, "walk");

/// The run by which a method's work is recorded.
pub fn recorded_run(method: &str) -> Run {
    if method == "portals" {
        ROOMS
    } else {
        WALK
    }
}

/// `auto` chooses by measured times: its candidates take turns instead.
pub fn recorded_settings(method: &str) -> &'static [(&'static str, &'static str)] {
    if method == "auto" {
        &[("by", "turns")]
    } else {
        &[]
    }
}

const WOC: &[&str] = &["woc", "awoc", "woc-exact"];
const WALKS: &[&str] = &["chc", "chc++", "nohc"];

/// Every option that decides work which can be counted.
pub const ROWS: &[Row] = &[
    // Still cameras: what cannot change is not done again. `auto` needs turns, as its choice by time may change.
    Row::new(&[], "skip", ["true", "false"], "stages").on(("city-block", 0.02, "still")),
    Row::new(&[], "detail", ["40", "0"], "drawn"),
    // By tighter volumes fewer objects are kept.
    Row::new(&["frustum"], "test", ["box", "sphere"], "drawn").on(ROTATE),
    Row::new(&["frustum"], "test", ["sphere", "sphere-box"], "plane_tests").on(ROTATE),
    Row::new(&["frustum-bvh"], "masking", ["true", "false"], "plane_tests"),
    Row::new(&["frustum-bvh"], "coherence", ["true", "false"], "plane_tests").on(ROTATE),
    Row::new(&["frustum-bvh"], "bvh", ["sah", "equal"], "plane_tests"),
    Row::new(&["hzb"], "texels", ["16", "2"], "drawn"),
    Row::new(&["hzb-iterative"], "ranges", ["1", "5"], "stages"),
    Row::new(&["hzb-iterative"], "boxes", ["false", "true"], "boxes"),
    Row::new(&["hzb-iterative"], "fronts", ["objects", "none"], "boxes"),
    Row::new(&["hzb-iterative"], "small", ["1000000", "0"], "boxes"),
    Row::new(&["hzb-iterative"], "finest", ["1", "3"], "boxes"),
    Row::new(&["hzb-iterative"], "texels", ["16", "2"], "boxes").with(&[("fronts", "none")]),
    Row::new(&["hzb-iterative"], "every", ["4", "1"], "eovc/filter_occluders").times(4),
    Row::new(&["hom"], "structure", ["n-buffer", "mip"], "drawn"),
    Row::new(&["hom"], "levels", ["0", "5"], "drawn"),
    Row::new(&["hom"], "size", ["1", "4"], "drawn"),
    Row::new(WOC, "size", ["1", "4"], "drawn"),
    Row::new(WOC, "structure", ["n-buffer", "mip"], "drawn"),
    Row::new(WOC, "levels", ["0", "5"], "drawn"),
    Row::new(WOC, "erode", ["none", "neighbours"], "drawn"),
    Row::new(WOC, "close", ["true", "false"], "drawn").with(&[("erode", "none")]).on(ROTATE),
    Row::new(WOC, "margin", ["0", "4"], "drawn").with(&[("erode", "footprint")]),
    Row::new(WOC, "motion", ["computed", "stored"], "warp/measure_motion").with(&[("size", "1")]),
    Row::new(WOC, "oriented", ["false", "true"], "warp/orient_axes"),
    Row::new(WOC, "rapid", ["0", "0.005"], "woc/find_rapid"),
    Row::new(WOC, "hybrid", ["0", "300"], "boxes").with(&[("hybrid-triangles", "0")]),
    Row::new(WOC, "hybrid-triangles", ["1000000000", "0"], "boxes"),
    Row::new(WOC, "commands", ["zero-instance", "packed"], "pack/count_flags"),
    Row::new(&["roc-iterative"], "ranges", ["1", "6"], "stages"),
    Row::new(&["roc-iterative"], "beyond", ["visible", "tested"], "boxes").with(&[("first", "5"), ("ranges", "2")]),
    Row::new(&["roc-iterative"], "first", ["1", "0"], "boxes").with(&[("beyond", "visible")]),
    Row::new(&["roc-iterative"], "factor", ["2", "4"], "boxes").with(&[
        ("first", "2"),
        ("ranges", "2"),
        ("beyond", "visible"),
    ]),
    Row::new(&["eovc"], "of", ["false", "true"], "eovc/filter_occluders"),
    Row::new(&["eovc"], "every", ["4", "1"], "eovc/filter_occluders").times(4),
    Row::new(&["eovc"], "cr", ["false", "true"], "submissions"),
    Row::new(&["eovc"], "commands", ["zero-instance", "packed"], "pack/count_flags"),
    Row::new(&["eovc"], "bvh", ["sah", "equal"], "boxes"),
    Row::new(&["eovc"], "coherent", ["true", "false"], "rays"),
    Row::new(&["query-wait"], "batch", ["1024", "1"], "waits"),
    Row::new(&["query-lag"], "every", ["5", "1"], "queries"),
    Row::new(&[], "min-pixels", ["1000", "1"], "drawn"),
    Row::new(&["query-wait", "query-lag", "chc", "chc++", "nohc"], "boxes", ["1", "8"], "boxes"),
    Row::new(WALKS, "window", ["64", "1"], "waits"),
    Row::new(&["chc", "chc++"], "bvh", ["sah", "equal"], "queries"),
    Row::new(&["chc++"], "n_av", ["10", "1"], "queries"),
    Row::new(&["chc++"], "b", ["50", "1"], "state_changes"),
    Row::new(&["chc++"], "d_max", ["0", "3"], "boxes"),
    Row::new(&["chc++"], "s_max", ["1", "3"], "boxes"),
    Row::new(&["chc++"], "multi", ["true", "false"], "queries"),
];

/// Options that decide no work which is counted, and why.
pub const NO_WORK: &[(&[&str], &str, &str)] = &[
    (&["ref"], "order", "the order of draws, not their number"),
    (&["nohc"], "bvh", "it asks by measured times; queries/costs.rs and queries/nohc.rs hold its decisions"),
    (&["auto"], "by", "who chooses, not how much is done"),
    (&["auto"], "allow-error", "which candidates there are; which of them runs is decided by measured times"),
    (&["hzb-iterative"], "factor", "where ranges end, not how many there are"),
    (&["hzb-iterative"], "rays", "who casts them; method_hzb_iterative.rs holds what they find"),
    (WOC, "seeds", "rounds of a loop inside a shader; warp.rs holds what they find"),
    (WOC, "iterations", "rounds of a loop inside a shader; warp.rs holds what they find"),
    (WOC, "threshold", "when a loop inside a shader ends; warp.rs holds what it finds"),
    (WOC, "steps", "rounds of a loop inside a shader; warp.rs holds the bounds"),
    (WOC, "tile", "invocations of a shader; warp.rs holds the bounds"),
    (WOC, "narrow", "rounds of a loop inside a shader; warp.rs holds what they find"),
    (WOC, "lookups", "rounds of a loop inside a shader; warp.rs holds the bounds"),
];
