//! The horizon: which slopes are filled in which direction.
//!
//! The picture is that of an upright camera at the same eye: across, the direction along the ground; up, the slope, which is height over
//! distance along the ground. What hides what does not depend on how the eye turns, so tilted and rolled cameras are no case of
//! their own. Across it is cut at every corner of every building's plan, so a building fills whole columns, and where
//! two buildings meet there is no gap. Within a column a ray enters a building by one side, and 1 over the distance of a side is a
//! cosine of the direction: its least value is at one end of the column, and its largest at most that of the ends over the cosine
//! of half the column.

use super::solids::Prism;
use crate::View;
use glam::{DVec2, DVec3, DVec4};
use scenes::Aabb;

/// Columns that the view is cut into beside the corners.
const LEAST_COLUMNS: u32 = 256;

/// What f64 may be off in angles and slopes, with room: they are quotients of sums of a few products.
const ROUNDING: f64 = 1e-9;

/// A direction along the ground: a number that grows to the right around the eye, from -2 to 2, 0 being ahead.
fn turn_of(direction: DVec2) -> f64 {
    let size = direction.x.abs() + direction.y.abs();
    let across = direction.x / size;
    match (direction.y >= 0.0, direction.x >= 0.0) {
        (true, _) => across,
        (false, true) => 2.0 - across,
        (false, false) => -2.0 - across,
    }
}

/// The direction that [`turn_of`] gives this number, of length 1.
fn direction_of(turn: f64) -> DVec2 {
    let across = if turn.abs() <= 1.0 { turn } else { turn.signum() * 2.0 - turn };
    let ahead = 1.0 - across.abs();
    DVec2::new(across, if turn.abs() <= 1.0 { ahead } else { -ahead }).normalize()
}

/// Where ahead is, along the ground.
#[derive(Clone, Copy, Debug)]
struct Ahead(DVec2);

impl Ahead {
    fn of(view: &View) -> Self {
        let ahead = view.clip_from_relative().row(3);
        Ahead(DVec2::new(ahead.x, ahead.z).try_normalize().unwrap_or(DVec2::Y))
    }

    /// From the ground's x and z to right and ahead.
    fn seen(self, at: DVec2) -> DVec2 {
        DVec2::new(self.0.perp_dot(at), self.0.dot(at))
    }

    /// And back.
    fn on_ground(self, seen: DVec2) -> DVec2 {
        self.0 * seen.y + self.0.perp() * seen.x
    }

    /// The least and the largest turn of what these corners are around; none if it reaches behind the eye, or around it.
    fn turns(self, corners: &[DVec2]) -> Option<[f64; 2]> {
        let turns = corners.iter().map(|corner| turn_of(self.seen(*corner)));
        let [low, high] =
            turns.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], turn| [low.min(turn), high.max(turn)]);
        (high - low < 2.0 - ROUNDING).then_some([low, high])
    }
}

/// An object as seen from the eye.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Corners of its plan, relative to the eye.
    plan: [DVec2; 4],
    /// How near it comes along the ground, in metres.
    pub from: f64,
    /// The least and the largest slope to any of its points.
    slopes: [f64; 2],
}

impl Span {
    /// None if the eye is above, below or in the box: it shows.
    pub fn of(bounds: &Aabb, eye: DVec3) -> Option<Self> {
        let (low, high) = (bounds.min - eye, bounds.max - eye);
        let plan = [(low.x, low.z), (high.x, low.z), (high.x, high.z), (low.x, high.z)].map(DVec2::from);
        let gap = |low: f64, high: f64| low.max(-high).max(0.0);
        let near = DVec2::new(gap(low.x, high.x), gap(low.z, high.z)).length();
        let far = plan.iter().map(|corner| corner.length()).fold(0.0, f64::max);
        let slopes = [low.y / if low.y <= 0.0 { near } else { far }, high.y / if high.y >= 0.0 { near } else { far }];
        let usable = near > 0.0 && slopes.iter().all(|slope| slope.is_finite());
        usable.then_some(Span { plan, from: near, slopes })
    }
}

/// Which slopes are filled: one range a column.
pub struct Horizon {
    ahead: Ahead,
    /// Where columns begin and end, ascending.
    turns: Vec<f64>,
    directions: Vec<DVec2>,
    columns: Vec<Option<[f64; 2]>>,
}

impl Horizon {
    /// Nothing is filled yet; cut for these buildings.
    pub fn new(view: &View, prisms: &[&Prism]) -> Self {
        let ahead = Ahead::of(view);
        let [low, high] = turns_in_view(view, ahead).unwrap_or([-2.0 + ROUNDING, 2.0 - ROUNDING]);
        let even = (0..=LEAST_COLUMNS).map(|cut| low + (high - low) * f64::from(cut) / f64::from(LEAST_COLUMNS));
        let corners = prisms.iter().flat_map(|prism| prism.plan).map(|corner| turn_of(ahead.seen(corner)));
        let mut turns: Vec<f64> = even.chain(corners.filter(|turn| low < *turn && *turn < high)).collect();
        turns.sort_unstable_by(f64::total_cmp);
        turns.dedup();
        let directions = turns.iter().map(|turn| ahead.on_ground(direction_of(*turn))).collect();
        let columns = vec![None; turns.len().saturating_sub(1)];
        Horizon { ahead, turns, directions, columns }
    }

    /// A building fills what it stands before.
    pub fn add(&mut self, prism: &Prism) {
        let Some([low, high]) = self.ahead.turns(&prism.plan) else { return };
        let first = self.turns.partition_point(|turn| *turn < low);
        for column in first..self.columns.len() {
            if self.turns[column + 1] > high {
                break;
            }
            if let Some(filled) = self.filled(prism, column) {
                self.columns[column] = Some(joined(self.columns[column], filled));
            }
        }
    }

    /// The slopes that a building fills all across a column.
    fn filled(&self, prism: &Prism, column: usize) -> Option<[f64; 2]> {
        let ends = [self.directions[column], self.directions[column + 1]];
        let half = (0.5 * (1.0 + ends[0].dot(ends[1]))).max(0.0).sqrt() - ROUNDING;
        let [foot, top] = prism.heights;
        let entries = ends.map(|end| prism.entry(end));
        let least_entry = entries[0].min(entries[1]);
        let low = foot * if foot <= 0.0 { least_entry } else { entries[0].max(entries[1]) / half };
        let high = if top >= 0.0 {
            top * least_entry
        } else {
            top * ends.map(|end| prism.exit(end)).into_iter().fold(0.0, f64::max) / half
        };
        let [low, high] = [low + ROUNDING * (1.0 + low.abs()), high - ROUNDING * (1.0 + high.abs())];
        (least_entry > 0.0 && half > 0.0 && low < high).then_some([low, high])
    }

    /// True if nothing of the object shows beside or above what is filled, as far as it is in the view.
    pub fn hides(&self, span: &Span) -> bool {
        let (Some([low, high]), Some(first), Some(last)) =
            (self.ahead.turns(&span.plan), self.turns.first(), self.turns.last())
        else {
            return false;
        };
        let (low, high) = ((low - ROUNDING).max(*first), (high + ROUNDING).min(*last));
        if low >= high {
            return false;
        }
        let from = self.turns.partition_point(|turn| *turn <= low).saturating_sub(1);
        let to = self.turns.partition_point(|turn| *turn < high);
        let [flat, steep] = span.slopes;
        let under = |filled: &Option<[f64; 2]>| filled.is_some_and(|[low, high]| low <= flat && steep <= high);
        self.columns[from..to.min(self.columns.len())].iter().all(under)
    }
}

/// Both ranges of slopes if they overlap; else the wider.
fn joined(one: Option<[f64; 2]>, other: [f64; 2]) -> [f64; 2] {
    match one {
        None => other,
        Some(one) if one[0] <= other[1] && other[0] <= one[1] => [one[0].min(other[0]), one[1].max(other[1])],
        Some(one) if one[1] - one[0] >= other[1] - other[0] => one,
        Some(_) => other,
    }
}

/// Between which turns all pixels lie, one more at each border; none if that is all around.
fn turns_in_view(view: &View, ahead: Ahead) -> Option<[f64; 2]> {
    let matrix = view.clip_from_relative();
    let eye = crate::boxes::eye_of(&matrix).truncate();
    let [right, up] = view.size.map(|pixels| 1.0 + 4.0 / f64::from(pixels));
    let rays = [(-right, -up), (right, -up), (right, up), (-right, up)].map(|(x, y)| {
        // Of the points that are seen at a place in the picture, one in front of the eye.
        let rows = [matrix.row(0) - matrix.row(3) * x, matrix.row(1) - matrix.row(3) * y];
        let along = rows[0].truncate().cross(rows[1].truncate());
        let in_front = |ray: DVec3| matrix.row(3).dot(DVec4::from(((eye + ray), 1.0)));
        if in_front(along) >= 0.0 {
            along
        } else {
            -along
        }
    });
    // Straight up or down is in the picture: all directions are.
    let vertical = [DVec3::Y, DVec3::NEG_Y].into_iter().any(|vertical| {
        let clip = matrix * DVec4::from((eye + vertical, 1.0));
        clip.w > 0.0 && clip.x.abs() <= right * clip.w && clip.y.abs() <= up * clip.w
    });
    let finite = rays.iter().all(|ray| ray.is_finite() && ray.x.abs() + ray.z.abs() > 0.0);
    let turns = ahead.turns(&rays.map(|ray| DVec2::new(ray.x, ray.z)));
    turns.filter(|_| !vertical && finite).map(|[low, high]| [low - ROUNDING, high + ROUNDING])
}
