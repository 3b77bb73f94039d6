//! What GPU Gems, chapter 29 ("Efficient Occlusion Culling", D. Sekulic 2004), says of its ways to use occlusion queries, measured by how
//! many triangles objects have.

use super::{Change, Column, Measure, Paper, PaperScene, Ratio, Source, Table, Variant};

/// The chapter has no table, and names no scene; ours are those whose meshes can be divided finely.
const PAPER: Paper = Paper {
    name: "GPU Gems 29",
    measured_on: "\"today's GPUs\" of 2004, such as the GeForce FX family; it has no figures of its own runs",
    seconds: 16.0,
    path: ("walk", false),
    scenes: &[
        PaperScene { name: "many hidden", ours: "factory", objects: None },
        PaperScene { name: "few hidden", ours: "monsters", objects: None },
    ],
};

const TIME: &[Measure] = &[Measure::FrameMs];
const TIME_AND_ERROR: &[Measure] = &[Measure::FrameMs, Measure::ObjectErrorPercent];

/// A query, and a wait, for each object.
const ONE_BY_ONE: &[(&str, &str)] = &[("batch", "1")];

/// Sections 29.2 to 29.4 from left to right, 29.7 from top to bottom.
pub(super) const TABLE: Table = Table {
    id: "gems-29",
    title: "mean frame time in ms (next frame: and missed in %), by triangles",
    source: Source::Said(&PAPER, "sections 29.2 to 29.4 and 29.7"),
    columns: &[
        Column::new("triangles, M", "none", &[Measure::MillionTriangles], 1),
        Column::new("no culling", "none", TIME, 1),
        Column::new("frustum", "frustum", TIME, 1),
        Column::new("one by one", "query-wait", TIME, 1).with(ONE_BY_ONE),
        Column::new("n queries", "query-wait", TIME, 1),
        Column::new("next frame", "query-lag", TIME_AND_ERROR, 1),
        Column::new("REF", "ref", TIME, 1),
    ],
    variants: &[
        Variant::run("level 0", Change::Detail(0)),
        Variant::run("level 1", Change::Detail(1)),
        Variant::run("level 2", Change::Detail(2)),
        Variant::run("level 3", Change::Detail(3)),
    ],
    ratio: Ratio::SpeedUp("frustum"),
    published: &[],
    notes: &[
        "The chapter's claims, which have no table: waiting for each query is slower than drawing (29.3); n queries are much",
        "better, but still stall (29.3.1); reading answers in the next frame stalls by less than 10 % (29.4); objects of some",
        "300 triangles gain little, from 1,000 on speed-ups can be more than double, and nothing is noticeably slower (29.7).",
        "Triangles an object: those of no culling over objects; level N is --detail-level N.",
        "Ours: the first --frames of a walk of 960, 16 s at 60 Hz, unless told otherwise.",
    ],
    goals: None,
};
