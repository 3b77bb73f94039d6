//! Tables 1 to 3 of Kim's thesis (2015), "Efficient occlusion culling with depth warping", section V: what it published, and
//! which of our methods stand in its columns. Its new culling is our `woc`.

use super::{Change, Column, Measure, Paper, PaperScene, Published, Ratio, Source, Table, Variant, ONE_ROW};

/// Section V. Its sequences last 15 to 20 seconds; how many objects the monsters are, it does not say.
const PAPER: Paper = Paper {
    name: "WOC thesis",
    measured_on: "GeForce GTX 980, OpenGL 4.5, 1920x1080",
    seconds: 17.5,
    path: ("walk", false),
    scenes: &[
        PaperScene { name: "CB", ours: "city-block", objects: Some(94_000) },
        PaperScene { name: "BL", ours: "balloons", objects: Some(25_000) },
        PaperScene { name: "PP", ours: "powerplant", objects: Some(8_868) },
        PaperScene { name: "MO", ours: "monsters", objects: None },
    ],
};

/// "The used parameters are: 4 samples in fixed-point iteration" (V.A).
const FOUR_SEEDS: &[(&str, &str)] = &[("seeds", "4")];

const WALK: &str = "Ours: the first --frames of a walk of 960, 16 s at 60 Hz, unless told otherwise.";
const LACKS: &str = "New culling: woc, without the thesis' rapid objects, hybrid queries and shuffled commands.";

/// Table 1.
pub(super) const TABLE_1: Table = Table {
    id: "woc-1",
    title: "errors of warping-based culling against ideal culling",
    source: Source::Paper(&PAPER, 1),
    columns: &[
        Column::new("object error %", "woc", &[Measure::ObjectErrorPercent], 3).with(FOUR_SEEDS),
        Column::new("pixel error", "woc", &[Measure::DifferingPixels], 1).with(FOUR_SEEDS),
        Column::new("average dB", "woc", &[Measure::PsnrMean], 1).with(FOUR_SEEDS),
        Column::new("worst dB", "woc", &[Measure::PsnrWorst], 1).with(FOUR_SEEDS),
    ],
    variants: ONE_ROW,
    ratio: Ratio::None,
    published: &[
        Published { scene: "CB", figures: &[0.058, 2.0, 67.8, 50.5] },
        Published { scene: "BL", figures: &[0.011, 0.4, 69.1, 52.0] },
        Published { scene: "PP", figures: &[0.080, 1.4, 66.8, 49.0] },
        Published { scene: "MO", figures: &[0.002, 0.0, 96.1, 66.8] },
    ],
    notes: &[
        "Object error: visible objects that were not drawn, in % of the visible ones, both summed over frames. Pixel error:",
        "pixels a frame whose depth is not the truth's. dB: PSNR of the picture, average of the frames that differ, and the",
        "worst; ∞: none differs.",
        LACKS,
        WALK,
    ],
    goals: None,
};

/// Table 2; of its four machines the one of the other tables.
pub(super) const TABLE_2: Table = Table {
    id: "woc-2",
    title: "mean frame time of warping-based culling by the picture's size, in ms",
    source: Source::Paper(&PAPER, 2),
    columns: &[Column::new("New culling", "woc", &[Measure::FrameMs], 1).with(FOUR_SEEDS)],
    variants: &[Variant::run("HD", Change::Size(1.0)), Variant::run("Full-HD", Change::Size(1.5))],
    ratio: Ratio::OverFirstVariant,
    published: &[
        Published { scene: "CB", figures: &[6.1, 7.3] },
        Published { scene: "BL", figures: &[3.2, 4.4] },
        Published { scene: "PP", figures: &[7.2, 8.5] },
        Published { scene: "MO", figures: &[2.2, 3.3] },
    ],
    notes: &[
        "Ours: HD is --size, Full-HD 1.5 times its sides, 2.25 times its pixels; left at 1280x720 they are the thesis' sizes.",
        "Of the thesis' four machines this is the GTX 980.",
        LACKS,
        WALK,
    ],
    goals: None,
};

const TIME_AND_CR: &[Measure] = &[Measure::FrameMs, Measure::CulledOverRefPercent];

const fn time_and_cr(head: &'static str, method: &'static str) -> Column {
    Column::new(head, method, TIME_AND_CR, 2)
}

/// Table 3.
pub(super) const TABLE_3: Table = Table {
    id: "woc-3",
    title: "mean frame time in ms, and culled in % of what REF culls (CR)",
    source: Source::Paper(&PAPER, 3),
    columns: &[
        time_and_cr("No culling", "none"),
        time_and_cr("VFC", "frustum"),
        time_and_cr("NOHC", "nohc"),
        time_and_cr("CHC++", "chc++"),
        time_and_cr("New culling", "woc").with(FOUR_SEEDS),
        time_and_cr("REF", "ref"),
    ],
    variants: ONE_ROW,
    ratio: Ratio::Over("New culling"),
    published: &[
        Published {
            scene: "CB",
            figures: &[34.57, 0.0, 22.17, 77.66, 126.13, 97.57, 25.59, 97.52, 7.31, 94.81, 2.93, 100.0],
        },
        Published {
            scene: "BL",
            figures: &[7.71, 0.0, 6.24, 69.66, 101.23, 88.34, 23.73, 87.84, 4.37, 85.35, 1.96, 100.0],
        },
        Published {
            scene: "PP",
            figures: &[40.68, 0.0, 20.82, 55.84, 35.79, 83.37, 11.02, 88.97, 8.52, 83.84, 2.86, 100.0],
        },
        Published {
            scene: "MO",
            figures: &[4.47, 0.0, 2.19, 85.40, 5.48, 94.77, 2.79, 94.83, 3.33, 93.42, 1.40, 100.0],
        },
    ],
    notes: &["Ratios are of times.", LACKS, WALK],
    goals: None,
};
