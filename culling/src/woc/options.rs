//! What can be set about warping-based occlusion culling.

use crate::farthest::hom::{LEVELS_OPTION, SIZE_OPTION, STRUCTURE_OPTION};
use crate::warp::{ITERATIONS, LOOKUPS, NARROW, ORIENTED, SEEDS, STEPS, THRESHOLD, TILE};
use crate::world::SKIP_OPTION;
use crate::OptionInfo;

/// Erosion of the warped depth.
pub(super) const ERODE: OptionInfo = OptionInfo {
    name: "erode",
    default: "true",
    values: "true|false",
    help: "give each warped texel the farthest depth around it: fewer errors, less culled",
};

/// Closing of holes.
pub(super) const CLOSE: OptionInfo = OptionInfo {
    name: "close",
    default: "true",
    values: "true|false",
    help: "give holes of a texel or two the farthest depth around them; false leaves every hole far",
};

/// `skip`, what the occlusion map is made of, how it is warped, and the refinements.
pub const OPTIONS: &[OptionInfo] = &[
    SKIP_OPTION,
    SIZE_OPTION,
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
    CLOSE,
];
