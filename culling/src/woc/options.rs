//! What can be set about warping-based occlusion culling.

use crate::farthest::hom::{LEVELS_OPTION, SIZE_OPTION, STRUCTURE_OPTION};
use crate::pack::Commands;
use crate::warp::{ITERATIONS, LOOKUPS, MARGIN, MOTION, NARROW, ORIENTED, SEEDS, STEPS, THRESHOLD, TILE};
use crate::world::{DETAIL_OPTION, SKIP_OPTION};
use crate::{OptionInfo, Options};

/// How much smaller warp and map are than the picture: a quarter, by measurement, which is faster than full size and misses
/// fewer objects, as each texel stands for its farthest pixel (README).
pub(super) const SIZE: OptionInfo = OptionInfo { default: "4", ..SIZE_OPTION };

/// Erosion of the warped depth. By neighbours, as the thesis does, which misses least; by the footprint less is drawn (README).
pub(super) const ERODE: OptionInfo = OptionInfo {
    name: "erode",
    default: "neighbours",
    values: "footprint|neighbours|none",
    help:
        "give each warped texel the farthest depth of the texels around it, or of the pixels it covered before (faster)",
};

/// Closing of holes.
pub(super) const CLOSE: OptionInfo = OptionInfo {
    name: "close",
    default: "true",
    values: "true|false",
    help: "give holes of a texel or two the farthest depth around them; false leaves every hole far",
};

/// Rapid objects.
pub(super) const RAPID: OptionInfo = OptionInfo {
    name: "rapid",
    default: "0.02",
    values: "0|0.005|0.01|0.02|0.04|0.08",
    help: "draw first what moved farther than this in the canonical view volume, turns of the camera left out; 0 draws nothing first",
};

/// Costly objects that must prove by their box that they show.
pub(super) const HYBRID: OptionInfo = OptionInfo {
    name: "hybrid",
    default: "300",
    values: "0..=10000",
    help: "costliest objects whose boxes are tested too, against the depth of the others; 0 tests none",
};

/// Which objects are costly.
pub(super) const HYBRID_TRIANGLES: OptionInfo = OptionInfo {
    name: "hybrid-triangles",
    default: "100000",
    values: "0..=1000000000",
    help: "triangles that an object must exceed to be one of the costliest",
};

/// How commands lie.
pub(super) const COMMANDS: OptionInfo = OptionInfo {
    name: "commands",
    default: "packed",
    values: "packed|zero-instance|shuffled",
    help: "indirect commands of what is drawn alone, or of every object, in order or spread evenly",
};

/// `skip`, what the occlusion map is made of, how it is warped, and the refinements.
pub const OPTIONS: &[OptionInfo] = &[
    SKIP_OPTION,
    DETAIL_OPTION,
    SIZE,
    STRUCTURE_OPTION,
    LEVELS_OPTION,
    SEEDS,
    ITERATIONS,
    THRESHOLD,
    STEPS,
    TILE,
    NARROW,
    ORIENTED,
    LOOKUPS,
    ERODE,
    MARGIN,
    MOTION,
    CLOSE,
    RAPID,
    HYBRID,
    HYBRID_TRIANGLES,
    COMMANDS,
];

/// How the options want commands to lie.
pub(super) fn commands(options: &Options) -> Commands {
    match options.text(COMMANDS.name) {
        "zero-instance" => Commands::ZeroInstance,
        "shuffled" => Commands::Shuffled,
        _ => Commands::Packed,
    }
}
