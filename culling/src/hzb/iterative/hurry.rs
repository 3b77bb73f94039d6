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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use scenes::{Pose, Projection, Shot};

    const PROJECTION: Projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: Some(200.0) };

    fn view(position: DVec3, rotation: DQuat, projection: Projection, size: [u32; 2]) -> View {
        View::new(&Shot { pose: Pose { position, rotation }, projection, seconds: 0.0 }, size, 0, 0.0)
    }

    fn at(x: f64) -> View {
        view(DVec3::new(x, 0.0, 0.0), DQuat::IDENTITY, PROJECTION, [160, 90])
    }

    fn turned(angle: f64, axis: DVec3) -> View {
        view(DVec3::ZERO, DQuat::from_axis_angle(axis, angle), PROJECTION, [160, 90])
    }

    fn after_origin() -> Hurry {
        let mut hurry = Hurry::within(None, 200.0);
        hurry.look(&at(0.0));
        hurry
    }

    #[test]
    fn a_zoom_or_another_size_is_a_cut() {
        let hurry = after_origin();
        assert_eq!(hurry.new_share(&at(0.0)), 0.0);
        let zooms = [
            Projection::Perspective { fov_y: 0.99, near: 0.1, far: Some(200.0) },
            Projection::Perspective { fov_y: 1.0, near: 0.2, far: Some(200.0) },
            Projection::Orthographic { half_height: 5.0, near: 0.1, far: 200.0 },
        ];
        for projection in zooms {
            let zoomed = view(DVec3::ZERO, DQuat::IDENTITY, projection, [160, 90]);
            assert!(hurry.is_cut(&zoomed), "{projection:?}");
            assert_eq!(hurry.new_share(&zoomed), 1.0, "{projection:?}");
        }
        let [narrow, low] = [[159, 90], [160, 89]].map(|size| view(DVec3::ZERO, DQuat::IDENTITY, PROJECTION, size));
        assert!(hurry.is_cut(&narrow) && hurry.is_cut(&low));
    }

    #[test]
    fn a_move_by_a_hundredth_of_the_extent_shows_a_tenth_of_the_picture_anew() {
        let hurry = after_origin();
        // Each of these is a product and a quotient, rounded to 2^-53.
        let is = |view: &View, share: f64| (hurry.new_share(view) - share).abs() < 1e-15;
        assert!(is(&at(2.0), 0.1) && is(&at(-6.0), 0.3) && is(&at(20.0), 1.0) && is(&at(500.0), 1.0));
        assert!(hurry.is_cut(&at(19.9)) && !hurry.is_cut(&at(19.7)));
    }

    #[test]
    fn a_turn_counts_by_the_axis_that_it_moves_most() {
        let hurry = after_origin();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            // The chord of the angle, whatever the axis; sines and cosines of the quaternion are good to a few 2^-53.
            let chord = 2.0 * (0.5 * 0.2_f64).sin();
            assert!((hurry.new_share(&turned(0.2, axis)) - chord).abs() < 1e-14, "{axis}");
        }
        let both = view(DVec3::new(2.0, 0.0, 0.0), DQuat::from_axis_angle(DVec3::Y, 0.2), PROJECTION, [160, 90]);
        assert!((hurry.new_share(&both) - 0.1 - 2.0 * 0.1_f64.sin()).abs() < 1e-14, "a turn and a move add up");
        assert_eq!(hurry.new_share(&turned(2.0, DVec3::Y)), 1.0);
    }

    #[test]
    fn the_more_is_new_the_more_ranges_there_are() {
        let ranges = |x: f64| after_origin().ranges(&at(x));
        assert_eq!([0.0, 1.9, 2.1, 5.9, 6.1, 19.7, 19.9, 100.0].map(ranges), [1, 1, 2, 2, 3, 3, 4, 4]);
        let [at_a_step, behind] = [0.1, 0.100_1].map(ranges_for);
        assert_eq!((at_a_step, behind), (1, 2), "a share is exceeded, not reached");
    }

    #[test]
    fn each_frame_is_compared_with_the_one_before() {
        let mut hurry = Hurry::within(None, 200.0);
        let ranges: Vec<u32> = [0.0, 3.0, 6.0, 6.0, 12.5].map(|x| hurry.ranges(&at(x))).into();
        assert_eq!(ranges, [4, 2, 2, 1, 3], "of a first frame all is new");
        hurry.forget();
        assert_eq!(hurry.ranges(&at(12.5)), 4, "after a reset too");
    }

    #[test]
    fn a_fixed_number_of_ranges_stays_whatever_the_view_does() {
        let fixed = |ranges: u32| {
            let mut hurry = Hurry::within(Some(ranges), 200.0);
            let chosen = [0.0, 0.0, 100.0].map(|x| hurry.ranges(&at(x)));
            assert_eq!(chosen, [chosen[0]; 3]);
            assert_eq!(hurry.fixed(), Some(chosen[0]));
            assert!(hurry.is_cut(&at(0.0)), "the view is followed all the same");
            chosen[0]
        };
        assert_eq!([0, 1, 3, 5, 9].map(fixed), [1, 1, 3, 5, MOST_STEP_RANGES]);
        assert_eq!(Hurry::within(None, 200.0).fixed(), None);
    }

    #[test]
    fn without_an_extent_any_move_is_a_cut_and_none_is_not() {
        let mut hurry = Hurry::within(None, 0.0);
        hurry.look(&at(0.0));
        assert_eq!(hurry.new_share(&at(0.0)), 0.0);
        assert!(hurry.is_cut(&at(1e-6)));
    }
}
