//! The table of our own that says how near culling comes to its limit, `ref`: scenes with much and with little to cull, seen by a
//! camera that goes slowly, hurries, and cuts. Its goals are those of `auto`, the default choice.

use super::{Change, Column, Goals, Measure, Ratio, Source, Table, Variant};

const TIMES: &[Measure] = &[Measure::MedianMs, Measure::P95Ms];

const fn times(head: &'static str, method: &'static str) -> Column {
    Column::new(head, method, TIMES, 2)
}

/// Frame times from the lightest method to the limit, at three cameras.
pub(super) const TABLE: Table = Table {
    id: "lean",
    title: "median and p95 frame time in ms, by how the camera moves",
    source: Source::Ours {
        scenes: &[
            "city-block",
            "rooms",
            "factory",
            "radial-city",
            "satellite",
            "powerplant",
            "monsters",
            "fantasy",
        ],
        path: ("walk", false),
        // As many as auto's first trials take.
        warmup: 12,
    },
    columns: &[
        times("frustum", "frustum"),
        times("hzb", "hzb"),
        times("roc-iter.", "roc-iterative"),
        times("eovc", "eovc"),
        times("hzb-iter.", "hzb-iterative"),
        times("auto", "auto"),
        times("ref", "ref"),
    ],
    variants: &[
        Variant::run("slow", Change::Speed(1.0)),
        Variant::run("fast", Change::Speed(16.0)),
        Variant::run("cuts", Change::Path("cuts")),
    ],
    ratio: Ratio::Over("ref"),
    published: &[],
    notes: &[
        "slow and fast: --path at --speed, and at 16 times that; cuts: the path of that name, each frame somewhere else.",
        "auto measures while it runs: what it spends on trying methods is in its times, but for its first trials, which fall",
        "into the warm-up (--warmup, 12 frames if left out).",
    ],
    goals: Some(Goals {
        of: "auto",
        limit: "ref",
        over_limit: &[1.25, 1.6, 2.0],
        quick_ms: 5.0,
        over_quick_ms: 1.5,
        over_spread: 1.5,
        base: "frustum",
        over_best: 1.05,
    }),
};
