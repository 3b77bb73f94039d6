//! Methods that ask the device: occlusion queries count the samples of a box that pass the depth test, and the host decides.
//!
//! | file | method | source |
//! |---|---|---|
//! | [`wait`] | `query-wait`: batches of boxes, each waited for | GPU Gems 29.3; Zachmann 2008, draw-and-wait |
//! | [`lag`] | `query-lag`: answers are read a frame later | GPU Gems 29.4 |
//! | [`chc`] | `chc`: the hierarchy's last cut, queries between draws | Zachmann 2008; Bittner et al. 2004 |
//! | [`chcpp`] | `chc++`: queues, multiqueries, tight bounds | Zachmann 2008; Mattausch et al. 2008 |
//! | [`nohc`] | `nohc`: queries where a cost model says that they pay | Kim 2015, V; Guthe et al. 2006 |
//!
//! Boxes are grown as those of `roc` and `eovc` are (`include/box.glsl`), and what reaches the near plane is not asked about but
//! drawn. So a box without a sample holds nothing visible: an object is left out only if its own box or that of a node above it had
//! none against the depth of what *this* frame drew, or if it is out of view. What earlier frames saw decides what is asked and in
//! which order, never what is left out (but for `query-lag`, which says so).
//!
//! The papers poll: an answer is used as soon as it is there. Here answers come with the end of a submission, after `window` queries or
//! when there is nothing else to do, so that no decision depends on time, and two runs draw the same. The stall is the stage
//! `frame/wait_for_queries`.

pub mod chc;
pub mod chcpp;
mod costs;
mod hierarchy;
pub mod lag;
pub mod multi;
pub mod nohc;
mod place;
mod policy;
mod recording;
mod several;
pub mod wait;

pub use costs::Costs;

use crate::OptionInfo;

/// A box must show by so many samples (Zachmann 2008: "what hardly shows").
pub const MIN_PIXELS_OPTION: OptionInfo = OptionInfo {
    name: "min-pixels",
    default: "1",
    values: "1..=10000",
    help: "draw only what a query counts so many samples of: errors for time; 1 leaves out nothing that shows",
};

/// How many queries are under way at once.
const WINDOW_OPTION: OptionInfo = OptionInfo {
    name: "window",
    default: "64",
    values: "1..=16384",
    help:
        "queries asked before their answers are waited for; fewer know more of what lies in front, and wait more often",
};
