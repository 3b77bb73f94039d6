//! The options of `eovc`.

use crate::pack::Commands;
use crate::{OptionInfo, Options};

/// How the hierarchy is split, which groups are opened before they are rasterised, and the thesis' accelerations (III.6).
pub const OPTIONS: &[OptionInfo] = &[
    crate::world::SKIP_OPTION,
    crate::world::DETAIL_OPTION,
    OptionInfo {
        name: "of",
        default: "true",
        values: "true|false",
        help: "occluder filtering: the item buffer names the next frame's occluders (thesis III.6.2)",
    },
    OptionInfo {
        name: "every",
        default: "4",
        values: "1..=64",
        help: "frames from one occluder filtering to the next; what comes into view between them is added; 1 is the thesis",
    },
    OptionInfo {
        name: "cr",
        default: "false",
        values: "true|false",
        help: "counter read-back: the host waits for counts and passes exact ones (thesis III.6.1)",
    },
    OptionInfo {
        name: "commands",
        default: "packed",
        values: "packed|zero-instance",
        help: "draw commands packed in object order, or one an object with no instance where nothing is drawn",
    },
    crate::tree::SPLIT_OPTION,
    OptionInfo {
        name: "coherent",
        default: "true",
        values: "true|false",
        help: "open groups that recent frames saw into, instead of casting rays there again; false is the thesis",
    },
];

pub(super) fn commands(options: &Options) -> Commands {
    match options.text("commands") {
        "zero-instance" => Commands::ZeroInstance,
        _ => Commands::Packed,
    }
}
