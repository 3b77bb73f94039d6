//! Tables 1 to 5 of "Efficient object visibility culling" (the EOVC thesis), section IV: what it published, and which of our
//! methods stand in its columns. Its EOVC is our `eovc`; options that the thesis does not have stay at their defaults.

use super::{Column, Measure, Paper, PaperScene, Published, Ratio, Source, Table, Variant, ONE_ROW};

/// Section IV.1 and table 1.
const PAPER: Paper = Paper {
    name: "EOVC thesis",
    measured_on: "GeForce GTX 2080 Ti, OpenGL, 1920x1080",
    seconds: 10.0,
    path: ("closing-in", true),
    scenes: &[
        PaperScene { name: "FN", ours: "fantasy", objects: Some(7_437) },
        PaperScene { name: "FC", ours: "factory", objects: Some(46_600) },
        PaperScene { name: "RC", ours: "radial-city", objects: Some(73_812) },
        PaperScene { name: "ST", ours: "satellite", objects: Some(120_000) },
    ],
};

/// True of every column `EOVC`.
const COHERENT: &str =
    "eovc opens groups that recent frames saw into, which is ours: --set eovc.coherent=false is the thesis' own.";

const NA: &[(&str, &str)] = &[("of", "false"), ("cr", "false")];
const CR: &[(&str, &str)] = &[("of", "false"), ("cr", "true")];
const OF: &[(&str, &str)] = &[("of", "true"), ("every", "1"), ("cr", "false")];
const CR_OF: &[(&str, &str)] = &[("of", "true"), ("every", "1"), ("cr", "true")];

const TIME: &[Measure] = &[Measure::FrameMs];
const SHARES: &[Measure] = &[Measure::CulledOverTotal, Measure::CulledOverRef];

/// Frame times, published with one decimal.
const fn time(head: &'static str, method: &'static str) -> Column {
    Column::new(head, method, TIME, 1)
}

/// Frame times of EOVC, published with two decimals.
const fn eovc(head: &'static str, settings: &'static [(&'static str, &'static str)]) -> Column {
    Column::new(head, "eovc", TIME, 2).with(settings)
}

/// C/N and C/R.
const fn shares(head: &'static str, method: &'static str) -> Column {
    Column::new(head, method, SHARES, 2)
}

/// NA, CR, OF and CR+OF, as in tables 3 and 4.
const ACCELERATIONS: &[Column] = &[eovc("NA", NA), eovc("CR", CR), eovc("OF", OF), eovc("CR+OF", CR_OF)];

/// Table 2.
pub(super) const TABLE_2: Table = Table {
    id: "eovc-2",
    title: "mean frame time of the culling methods in ms",
    source: Source::Paper(&PAPER, 2),
    columns: &[
        time("NOC", "none"),
        time("VFC", "frustum"),
        time("CHC++", "chc++"),
        time("ROC", "roc"),
        time("WOC", "woc"),
        time("REF", "ref"),
        time("OF", "eovc").with(OF),
        time("CR+OF", "eovc").with(CR_OF),
    ],
    variants: ONE_ROW,
    ratio: Ratio::Over("ROC"),
    published: &[
        Published { scene: "FN", figures: &[4.8, 3.3, 8.8, 1.4, 3.3, 0.8, 1.2, 1.8] },
        Published { scene: "FC", figures: &[25.5, 25.7, 9.1, 4.2, 6.3, 0.5, 2.2, 1.6] },
        Published { scene: "RC", figures: &[44.3, 20.3, 32.6, 6.3, 15.0, 0.9, 3.3, 2.2] },
        Published { scene: "ST", figures: &[66.6, 37.1, 88.1, 14.8, 15.9, 6.7, 11.7, 9.2] },
    ],
    notes: &["OF, CR+OF: eovc with occluder filtering, and with counter read-back as well.", COHERENT],
    goals: None,
};

/// Table 3.
pub(super) const TABLE_3: Table = Table {
    id: "eovc-3",
    title: "mean frame time of eovc's accelerations in ms",
    source: Source::Paper(&PAPER, 3),
    columns: ACCELERATIONS,
    variants: ONE_ROW,
    ratio: Ratio::SpeedUp("NA"),
    published: &[
        Published { scene: "FN", figures: &[1.37, 2.21, 1.17, 1.83] },
        Published { scene: "FC", figures: &[2.25, 1.86, 2.17, 1.63] },
        Published { scene: "RC", figures: &[3.35, 2.37, 3.27, 2.20] },
        Published { scene: "ST", figures: &[14.00, 11.74, 11.66, 9.22] },
    ],
    notes: &["NA: none; CR: counter read-back; OF: occluder filtering.", COHERENT],
    goals: None,
};

/// Table 4.
pub(super) const TABLE_4: Table = Table {
    id: "eovc-4",
    title: "mean frame time of eovc by how its hierarchy is split, in ms",
    source: Source::Paper(&PAPER, 4),
    columns: ACCELERATIONS,
    variants: &[
        Variant::set("SAH", &[("bvh", "sah")]),
        Variant::set("MID", &[("bvh", "middle")]),
        Variant::set("EQ", &[("bvh", "equal")]),
    ],
    ratio: Ratio::OverFirstVariant,
    published: &[
        Published { scene: "FN", figures: &[1.37, 2.21, 1.17, 1.83, 1.39, 2.26, 1.29, 1.83, 1.41, 2.17, 1.22, 1.90] },
        Published { scene: "FC", figures: &[2.25, 1.86, 2.17, 1.63, 2.28, 1.89, 2.19, 1.71, 2.36, 1.89, 2.30, 1.81] },
        Published { scene: "RC", figures: &[3.35, 2.37, 3.27, 2.20, 3.10, 2.28, 3.28, 2.31, 3.13, 2.37, 3.36, 2.47] },
        Published {
            scene: "ST",
            figures: &[14.00, 11.74, 11.66, 9.22, 13.75, 11.58, 11.54, 9.04, 14.00, 11.75, 11.89, 9.59],
        },
    ],
    notes: &["SAH, MID, EQ: surface area heuristic, middle of the longest axis, equal counts.", COHERENT],
    goals: None,
};

/// Table 5.
pub(super) const TABLE_5: Table = Table {
    id: "eovc-5",
    title: "culling efficiency: C/N and C/R (culled over all objects, and over those that REF culls)",
    source: Source::Paper(&PAPER, 5),
    columns: &[
        shares("VFC", "frustum"),
        shares("CHC++", "chc++"),
        shares("ROC", "roc"),
        shares("WOC", "woc"),
        shares("REF", "ref"),
        shares("EOVC CR", "eovc").with(CR),
        shares("CR+OF", "eovc").with(CR_OF),
    ],
    variants: ONE_ROW,
    ratio: Ratio::None,
    published: &[
        Published {
            scene: "FN",
            figures: &[0.59, 0.65, 0.88, 0.97, 0.88, 0.97, 0.87, 0.96, 0.91, 1.00, 0.75, 0.83, 0.88, 0.97],
        },
        Published {
            scene: "FC",
            figures: &[0.41, 0.41, 0.99, 1.00, 0.98, 0.99, 0.99, 1.00, 0.99, 1.00, 0.91, 0.92, 0.99, 1.00],
        },
        Published {
            scene: "RC",
            figures: &[0.83, 0.85, 0.96, 0.99, 0.96, 0.99, 0.95, 0.98, 0.97, 1.00, 0.96, 0.98, 0.97, 0.99],
        },
        Published {
            scene: "ST",
            figures: &[0.77, 0.81, 0.93, 0.98, 0.94, 0.98, 0.92, 0.97, 0.96, 1.00, 0.92, 0.96, 0.94, 0.98],
        },
    ],
    notes: &["CR, OF: counter read-back, occluder filtering.", COHERENT],
    goals: None,
};
