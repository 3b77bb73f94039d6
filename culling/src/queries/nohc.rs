//! `nohc`: near-optimal hierarchical culling (Guthe et al. 2006, as Kim 2015, V uses it). It walks as [`super::chc`] does, but asks
//! only where a query costs less than what it saves on the average, by a model of costs that is fitted to the device at start-up.
//!
//! - Of a hidden node: query if C(query) < p C(drawing all below it). Else all in view below it is drawn, and the node is taken for
//!   one thing from then on. The chance p that it is still hidden is the persistence of visibility that CHC++ found (Guthe et al.
//!   have one of their own from the pixels that are covered, which a host that reads no picture back does not know).
//! - Of a visible leaf, or of what is taken for one: query once C(query) < (1 - 0.99^k) C(drawing it), k frames after the last.
//!
//! No frame is left out before a still camera: what is visible comes due for a query while nothing else changes, and which frames
//! ran decides what the next view begins with.

use super::chc;
use super::costs::Costs;
use super::hierarchy::Hierarchy;
use super::policy::Policy;
use super::several::BOXES_OPTION;
use super::{MIN_PIXELS_OPTION, WINDOW_OPTION};
use crate::tree::SPLIT_OPTION;
use crate::{Method, OptionInfo, Result, Setup};

/// Queries under way at once, and the hierarchy's split.
pub const OPTIONS: &[OptionInfo] =
    &[crate::world::DETAIL_OPTION, MIN_PIXELS_OPTION, BOXES_OPTION, WINDOW_OPTION, SPLIT_OPTION];

/// Makes the method; measures the device, once in a program's run.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let costs = Costs::of(setup.gpu)?;
    tracing::info!("nohc: {costs}");
    let policy = Policy::by_cost(costs, &Hierarchy::new(setup)?, setup.world);
    chc::walking(setup, "nohc", policy)
}
