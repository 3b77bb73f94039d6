//! How many depth ranges a frame needs, from what is known before it: how far the view has changed.

use crate::world::{View, World};
use glam::DVec3;
use shaders::types::MOST_STEP_RANGES;

/// How much of the picture may be new before one more range pays, by number of ranges. Measured: see culling/README.md.
const NEW_SHARE: [f64; 3] = [0.1, 0.3, 0.99];

/// How much of the picture must be new for what was seen before to be worth nothing.
const CUT_SHARE: f64 = 0.99;

/// Follows the camera and chooses numbers of ranges.
#[derive(Clone, Debug)]
pub struct Hurry {
    fixed: Option<u32>,
    extent: f64,
    last: Option<View>,
}

impl Hurry {
    /// Always `fixed` ranges, or as many as changes of view ask for.
    pub fn new(fixed: Option<u32>, world: &World) -> Self {
        Self::within(fixed, extent(world))
    }

    /// The same for a scene of this extent, metres.
    pub fn within(fixed: Option<u32>, extent: f64) -> Self {
        Hurry { fixed: fixed.map(|ranges| ranges.clamp(1, MOST_STEP_RANGES)), extent, last: None }
    }

    /// The number of ranges that was asked for.
    pub fn fixed(&self) -> Option<u32> {
        self.fixed
    }

    /// Ranges of the next frame, 1 to [`MOST_STEP_RANGES`]. Call once a frame.
    pub fn ranges(&mut self, view: &View) -> u32 {
        let new = self.new_share(view);
        self.look(view);
        self.fixed.unwrap_or_else(|| ranges_for(new))
    }

    /// True if next to nothing of the last frame is to be seen in this view; of a first frame too.
    pub fn is_cut(&self, view: &View) -> bool {
        self.new_share(view) > CUT_SHARE
    }

    /// How much of the picture a view shows anew, roughly, 0 to 1; all of it in the first frame.
    pub fn new_share(&self, view: &View) -> f64 {
        self.last.as_ref().map_or(1.0, |last| new_share(last, view, self.extent))
    }

    /// Notes a frame's view.
    pub fn look(&mut self, view: &View) {
        self.last = Some(*view);
    }

    /// The next frame is the first.
    pub fn forget(&mut self) {
        self.last = None;
    }
}

fn ranges_for(new_share: f64) -> u32 {
    1 + NEW_SHARE.iter().filter(|share| new_share > **share).count() as u32
}

/// The longest side of what holds all objects, metres; 0 without objects.
fn extent(world: &World) -> f64 {
    let finite = |position: &DVec3| position.is_finite();
    let corners = || world.host_bounds().iter().flat_map(|bounds| [bounds.min, bounds.max]).filter(finite);
    let (low, high) = (corners().fold(DVec3::INFINITY, DVec3::min), corners().fold(DVec3::NEG_INFINITY, DVec3::max));
    (high - low).max_element().max(0.0)
}

/// How much of the picture another view shows anew, roughly, 0 to 1: what a turn brings in at the picture's edge, and what a move uncovers. A
/// move by a hundredth of the scene's extent counts as a picture in ten; another projection as a new picture.
fn new_share(last: &View, view: &View, extent: f64) -> f64 {
    if last.projection != view.projection || last.size != view.size {
        return 1.0;
    }
    // An edge of the picture as a direction from its middle: how much a turn moves, compared with the picture's width.
    let axis = |rotation: glam::DQuat, axis: DVec3| rotation * axis;
    let turned = [DVec3::X, DVec3::Y, DVec3::Z]
        .map(|unit| axis(last.pose.rotation, unit).distance(axis(view.pose.rotation, unit)))
        .into_iter()
        .fold(0.0, f64::max);
    let moved = last.pose.position.distance(view.pose.position);
    let uncovered = if moved == 0.0 { 0.0 } else { 10.0 * moved / extent.max(f64::MIN_POSITIVE) };
    (turned + uncovered).min(1.0)
}
