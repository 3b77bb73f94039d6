//! What G. Zachmann's lecture (Computer-Graphik 2, summer 2008, "Culling") draws or says of occlusion queries, measured: queries a second
//! by the size of batches, the naive approach against CHC++, visibility persistence, and how little of a model is seen.

use super::{Column, Measure, Paper, PaperScene, Published, Ratio, Source, Table, Variant, ONE_ROW};

/// The lecture names no device. Its models are the power plant (13 million triangles) and the Double Eagle (82 million); ours stand for
/// the first, and for the city and the many rooms that it speaks of.
const PAPER: Paper = Paper {
    name: "Zachmann 2008",
    measured_on: "two machines that are not named, OpenGL 1.5",
    seconds: 16.0,
    path: ("walk", false),
    scenes: &[
        PaperScene { name: "PP", ours: "powerplant", objects: None },
        PaperScene { name: "rooms", ours: "rooms", objects: None },
        PaperScene { name: "city", ours: "city-block", objects: None },
    ],
};

const WALK: &str = "Ours: the first --frames of a walk of 960, 16 s at 60 Hz, unless told otherwise.";

/// A row of one batch size.
macro_rules! batch {
    ($option:literal, $size:literal) => {
        Variant::set(concat!($option, "=", $size), &[($option, $size)])
    };
}

/// The plot of queries a second: its text has the axes, not the curves.
pub(super) const BATCHES: Table = Table {
    id: "zachmann-batches",
    title: "thousands of queries a second, by how many are asked before the host waits",
    source: Source::Said(&PAPER, "plot of queries a second"),
    columns: &[
        Column::new("k queries/s", "query-wait", &[Measure::ThousandQueriesASecond], 1),
        Column::new("queries", "query-wait", &[Measure::Queries], 0),
        Column::new("waits", "query-wait", &[Measure::Waits], 1),
        Column::new("drawn", "query-wait", &[Measure::Drawn], 0),
        Column::new("ms", "query-wait", &[Measure::FrameMs], 1),
    ],
    variants: &[
        batch!("batch", "1"),
        batch!("batch", "4"),
        batch!("batch", "16"),
        batch!("batch", "64"),
        batch!("batch", "256"),
        batch!("batch", "1024"),
        batch!("batch", "4096"),
    ],
    ratio: Ratio::OverFirstVariant,
    published: &[],
    notes: &[
        "The lecture draws batches of 1 to 4096 for two machines (\"fetching answers is synchronous: send a series of queries,",
        "and read the answers after\"). Its figures are not in the text that we have, so none stand here. Queries a second are",
        "of whole frames, drawing included; what is asked late is hidden by less, so that large batches draw more.",
        WALK,
    ],
    goals: None,
};

const COUNTS: &[Measure] = &[Measure::FrameMs, Measure::Queries, Measure::StateChanges, Measure::Waits];

/// The slides from "draw-and-wait" to CHC++.
pub(super) const CHC: Table = Table {
    id: "zachmann-chc",
    title: "mean frame ms, queries, state changes and waits a frame",
    source: Source::Said(&PAPER, "slides on draw-and-wait, CHC and CHC++"),
    columns: &[
        Column::new("VFC", "frustum", &[Measure::FrameMs], 1),
        Column::new("draw-and-wait", "query-wait", COUNTS, 1),
        Column::new("CHC", "chc", COUNTS, 1),
        Column::new("CHC++", "chc++", COUNTS, 1),
    ],
    variants: ONE_ROW,
    ratio: Ratio::Over("VFC"),
    published: &[],
    notes: &[
        "The lecture draws state changes as colours and has no figures: batches of queries should change state less often than",
        "queries one by one (\"this overhead costs more time than the query itself\"), multiqueries should be fewer. Ratios are",
        "of times.",
        WALK,
    ],
    goals: None,
};

/// "Batch size b (some 20 to 80)".
pub(super) const CHC_BATCHES: Table = Table {
    id: "zachmann-b",
    title: "CHC++ by b: queries, state changes, waits and objects drawn a frame, mean ms",
    source: Source::Said(&PAPER, "slide on batching queries"),
    columns: &[
        Column::new("queries", "chc++", &[Measure::Queries], 0),
        Column::new("changes", "chc++", &[Measure::StateChanges], 1),
        Column::new("waits", "chc++", &[Measure::Waits], 1),
        Column::new("drawn", "chc++", &[Measure::Drawn], 0),
        Column::new("ms", "chc++", &[Measure::FrameMs], 1),
    ],
    variants: &[
        batch!("b", "1"),
        batch!("b", "5"),
        batch!("b", "20"),
        batch!("b", "50"),
        batch!("b", "80"),
        batch!("b", "200"),
        batch!("b", "1000"),
    ],
    ratio: Ratio::OverFirstVariant,
    published: &[],
    notes: &["The lecture takes b = 20 to 80, and has no figures for it.", WALK],
    goals: None,
};

/// One column a number of frames.
macro_rules! hidden_for {
    ($head:literal, $frames:literal) => {
        Column::new($head, "ref", &[Measure::HiddenAgain($frames)], 3)
    };
}

/// The plot of p(t), with the lecture's curve for it below each scene of ours.
pub(super) const PERSISTENCE: Table = Table {
    id: "zachmann-persistence",
    title: "of what was hidden for t frames, the share that is in the next",
    source: Source::Said(&PAPER, "plot of visibility persistence"),
    columns: &[
        hidden_for!("t=1", 1),
        hidden_for!("t=2", 2),
        hidden_for!("t=3", 3),
        hidden_for!("t=5", 5),
        hidden_for!("t=8", 8),
        hidden_for!("t=12", 12),
        hidden_for!("t=20", 20),
    ],
    variants: ONE_ROW,
    ratio: Ratio::None,
    // p(t) = 0.99 - 0.7 e^-t, "surprisingly independent of object and scene".
    published: &[
        Published { scene: "PP", figures: CURVE },
        Published { scene: "rooms", figures: CURVE },
        Published { scene: "city", figures: CURVE },
    ],
    notes: &[
        "The paper's rows are its curve p(t) = 0.99 - 0.7 e^-t. Ours are counted from the item buffers of all frames, from when",
        "an object was last seen; what was hidden from the first frame on is left out. A dash: nothing was hidden so long.",
        WALK,
    ],
    goals: None,
};

pub(super) const CURVE: &[f64] = &[0.732, 0.895, 0.955, 0.985, 0.990, 0.990, 0.990];

/// "Visible polygons: 450k (some 4 %), hidden polygons: 10M (96 %)".
pub(super) const POLYGONS: Table = Table {
    id: "zachmann-polygons",
    title: "triangles of objects that are seen, in millions and in %",
    source: Source::Said(&PAPER, "slide on uses of occlusion culling"),
    columns: &[
        Column::new("seen, M", "ref", &[Measure::MillionTriangles], 2),
        Column::new("seen, %", "ref", &[Measure::TrianglesPercent], 0),
        Column::new("all, M", "none", &[Measure::MillionTriangles], 2),
    ],
    variants: ONE_ROW,
    ratio: Ratio::None,
    published: &[Published { scene: "PP", figures: &[0.45, 4.0, 10.45] }],
    notes: &[
        "The slide names two models and gives one pair of figures, which adds up to less than either has: it is put to the power",
        "plant, which is nearer. Ours counts all triangles of an object of which a pixel shows, the lecture's single polygons.",
        WALK,
    ],
    goals: None,
};
