//! What can be set about depth warping.

use crate::farthest::hom::SIZE_OPTION;
use crate::{OptionInfo, Options};

/// Seeds of the search. One, by measurement: with tightened bounds and closed holes more cost time and find no more (README).
pub const SEEDS: OptionInfo =
    OptionInfo { name: "seeds", default: "1", values: "1..=64", help: "seeds of the search at each texel (N)" };

/// Iterations of the search.
pub const ITERATIONS: OptionInfo =
    OptionInfo { name: "iterations", default: "4", values: "1..=16", help: "iterations from each seed (T)" };

/// How close a source must come.
pub const THRESHOLD: OptionInfo = OptionInfo {
    name: "threshold",
    default: "0.5",
    values: "0.125|0.25|0.5",
    help: "how close to its texel a source must come, in texels",
};

/// Tightening steps.
pub const STEPS: OptionInfo = OptionInfo {
    name: "steps",
    default: "3",
    values: "0..=8",
    help: "tightening steps of the search bound; 0 takes the bound of all motions",
};

/// Texels that share a search bound.
pub const TILE: OptionInfo = OptionInfo {
    name: "tile",
    default: "4",
    values: "1|2|4|8|16",
    help: "texels of the side of a tile that shares a search bound; 1 is the paper's",
};

/// Which bounds are sampled once.
pub const NARROW: OptionInfo = OptionInfo {
    name: "narrow",
    default: "1",
    values: "0|0.5|1|2",
    help: "width in texels up to which a bound is sampled once; 0 samples all alike",
};

/// Axes of bounds.
pub const ORIENTED: OptionInfo = OptionInfo {
    name: "oriented",
    default: "false",
    values: "true|false",
    help: "bound motion along its principal axes, where that is tighter",
};

/// Texels looked up for a bound.
pub const LOOKUPS: OptionInfo = OptionInfo {
    name: "lookups",
    default: "2",
    values: "2..=8",
    help:
        "pyramid texels a bound may touch in each direction: 2 is the paper's, more is tighter (anisotropic) and slower",
};

/// Erosion by footprint.
const FOOTPRINT: OptionInfo = OptionInfo {
    name: "footprint",
    default: "false",
    values: "true|false",
    help: "give what is found the farthest depth of all pixels that the texel covers where it came from",
};

/// Pixels around a footprint that count too.
pub const MARGIN: OptionInfo = OptionInfo {
    name: "margin",
    default: "1",
    values: "0..=4",
    help: "pixels around a footprint that count too: fewer errors, less culled",
};

/// Where motion comes from.
pub const MOTION: OptionInfo = OptionInfo {
    name: "motion",
    default: "computed",
    values: "computed|stored",
    help:
        "computed: from the depth of a texel, wherever it is looked up, if nothing but the camera moves and one pixel stands \
         for a texel (full size, or erosion by footprint); stored: first all of it, in a buffer, as the papers do",
};

/// Filling of holes.
const FILL: OptionInfo = OptionInfo {
    name: "fill",
    default: "false",
    values: "true|false",
    help: "fill holes from the extremes of the search bound (AWOC), instead of leaving them far",
};

/// Options of a warp on its own. Methods list those they have among their own, and say themselves how they erode and fill.
pub const OPTIONS: &[OptionInfo] = &[
    SIZE_OPTION,
    SEEDS,
    ITERATIONS,
    THRESHOLD,
    STEPS,
    TILE,
    NARROW,
    ORIENTED,
    LOOKUPS,
    FOOTPRINT,
    MARGIN,
    MOTION,
    FILL,
];

/// The same, read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Pixels of a texel's side: 1, 2 or 4.
    pub reduction: u32,
    /// Seeds at each texel, > 0: N in TOG 2018.
    pub seeds: u32,
    /// Iterations from each seed, > 0: T in TOG 2018.
    pub iterations: u32,
    /// How close to its texel a source must come, in texels: above 0, at most 0.5.
    pub threshold: f32,
    /// Tightening steps of the search bound; 0 takes the bound of all motions.
    pub steps: u32,
    /// Texels of the side of a tile that shares a search bound, > 0.
    pub tile: u32,
    /// Width in texels up to which a bound is sampled once.
    pub narrow: f32,
    /// Motion is bounded along its principal axes, where that is tighter.
    pub oriented: bool,
    /// Texels of the motion pyramid that a bound may touch in each direction, > 1.
    pub lookups: u32,
    /// What moves farther in the canonical view volume is left out, because it is drawn ahead; 0 leaves out nothing.
    pub fastest: f32,
    /// What is found gets the farthest depth of all pixels that the texel covers where it came from; the texel's middle pixel
    /// stands for it until then. Otherwise its farthest pixel does, and nothing around it counts.
    pub footprint: bool,
    /// Pixels around a footprint that count too.
    pub margin: u32,
    /// Motion is always stored in a buffer first. Otherwise only where that pays.
    pub stored: bool,
    /// Holes are filled from the extremes of the search bound: not conservative.
    pub fill: bool,
}

impl Settings {
    /// Reads the options of a method that has [`OPTIONS`] among its own; without `footprint` and `fill`, both are false.
    pub fn of(options: &Options) -> Self {
        let fraction = |name: &str| options.text(name).parse().unwrap_or(0.0);
        Settings {
            reduction: options.number(SIZE_OPTION.name),
            seeds: options.number("seeds"),
            iterations: options.number("iterations"),
            threshold: fraction("threshold"),
            steps: options.number("steps"),
            tile: options.number("tile"),
            narrow: fraction("narrow"),
            oriented: options.flag(ORIENTED.name),
            lookups: options.number(LOOKUPS.name).max(2),
            fastest: 0.0,
            footprint: options.flag(FOOTPRINT.name),
            margin: options.number(MARGIN.name),
            stored: options.text(MOTION.name) == "stored",
            fill: options.flag(FILL.name),
        }
    }

    /// True if motion is stored although nothing but the camera moves: it is asked for, a texel's motion takes all its pixels,
    /// or the axes are found from all motions.
    pub fn stores_motion(&self) -> bool {
        self.stored || self.oriented || (self.reduction > 1 && !self.footprint)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Settings::of(&Options::new("warp", OPTIONS))
    }
}
