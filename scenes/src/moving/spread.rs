//! How far an animated node can be from where it is at one time, while a span of time passes: bounds, never samples.
//!
//! A span has no key inside, so that each track is one value, one line, one arc or one spline there (`Track::between`). Let m be the span's
//! middle, and t any time in it.
//!
//! - **Lines** (LINEAR vectors) lie in the box around both ends; **held values** (STEP) do not move.
//! - **Splines** (CUBICSPLINE) are Bézier curves with control points p0, p0 + L m0 / 3, p1 - L m1 / 3, p1. The part from one t to another has
//!   control points of its own (the curve's polar form), and lies in their convex hull, so in the box around them.
//! - **Arcs** (LINEAR rotations). `slerp` gives a (sin((1-s)θ) a + sin(sθ) b) / sin θ with some θ near the angle: a sum of a and b (or -b) with
//!   weights >= 0, whose direction goes from one to the other without turning back. So the part's directions lie on the arc between its
//!   ends, and none is farther from the middle's than one of them. θ is approximate, so that the length is not quite 1: its square is off
//!   by 2 sin((1-s)θ) sin(sθ) times what does not depend on s, which is most at s = 1/2. There it is measured.
//! - **Splines of rotations** are normalised: with all control points within ρ of λ u, u the middle's direction, the sine of the angle between
//!   any point of the hull and u is at most ρ / λ if that is less than 1; else any rotation is possible.
//!
//! Two unit quaternions that are c apart turn no vector v to places farther than 2 c |v| from each other (and 2 |v| always). One of
//! length n acts as I + n² (R - I), so it is off by at most 2 |n² - 1| |v|.

use crate::animation::{AnimatedNode, Between, Local, Track};
use crate::model::Aabb;
use glam::{DMat3, DQuat, DVec3, DVec4};

/// What evaluation may round, as a part of the largest number in it: less than 16 roundings of 2^-53, of terms that are no larger than 8 times
/// the largest control point.
const ROUNDING: f64 = 1.0 / (1u64 << 44) as f64;

/// A span of time in seconds without a key inside: from one time on, until before another. Either may be infinite.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) from: f64,
    pub(super) until: f64,
}

impl Span {
    /// A time in the span.
    pub(super) fn middle(self) -> f64 {
        let middle = 0.5 * self.from + 0.5 * self.until;
        // Nothing changes before the first and after the last key; and the middle of neighbouring numbers may be the later.
        if middle.is_finite() && middle < self.until {
            middle
        } else {
            self.from
        }
    }
}

/// Where a node can be in its parent while a span passes, against where it is at the span's middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    /// How much longer scale makes a vector, at most, and how far it is from the middle's.
    pub(super) scale: f64,
    pub(super) scale_off: f64,
    /// How much longer rotation makes a vector (1, but for rounding), and how far a vector of length 1 is from where the middle's puts it.
    pub(super) turn: f64,
    pub(super) turn_off: f64,
    /// The longest translation, and how far it is from the middle's.
    pub(super) shift: f64,
    pub(super) shift_off: f64,
}

impl AnimatedNode {
    /// Where it can be while a span passes.
    pub(super) fn spread(&self, span: Span) -> Spread {
        let (translation, rotation, scale) = match self.local {
            Local::Parts { translation, rotation, scale } => (translation, rotation, scale),
            Local::Matrix(matrix) => {
                let (shift, scale) = (matrix.translation.length(), stretch(&matrix.matrix3));
                return Spread { scale, scale_off: 0.0, turn: 1.0, turn_off: 0.0, shift, shift_off: 0.0 };
            }
        };
        let (shift, shift_off) = vectors(self.translation.as_ref(), translation, span);
        let (scales, scale_off) = vectors(self.scale.as_ref(), scale, span);
        let (turn, turn_off) = match &self.rotation {
            Some(track) => turns(track, span),
            None => (1.0 + 2.0 * off_unit(rotation), 0.0),
        };
        let (scale, scale_off) = (scales.max_element(), scale_off.max_element());
        Spread { scale, scale_off, turn, turn_off, shift: shift.length(), shift_off: shift_off.length() }
    }

    /// Times of all keys of its tracks.
    pub(super) fn key_times(&self) -> impl Iterator<Item = f64> + '_ {
        let of = |times: Option<&[f64]>| times.unwrap_or_default().to_vec();
        let tracks = [
            of(self.translation.as_ref().map(Track::times)),
            of(self.rotation.as_ref().map(Track::times)),
            of(self.scale.as_ref().map(Track::times)),
        ];
        tracks.into_iter().flatten()
    }

    /// First and last time of each of its tracks.
    pub(super) fn track_ends(&self) -> impl Iterator<Item = f64> + '_ {
        let tracks = [
            self.translation.as_ref().map(Track::duration_s),
            self.rotation.as_ref().map(Track::duration_s),
            self.scale.as_ref().map(Track::duration_s),
        ];
        tracks.into_iter().flatten().flat_map(|(first, last)| [first, last])
    }
}

/// How much longer a matrix makes a vector, at most: the square of that is the largest eigenvalue of its columns' products with each
/// other, which is at most their largest sum by rows. For columns at right angles it is exact, up to rounding.
pub(super) fn stretch(matrix: &DMat3) -> f64 {
    let squared = matrix.transpose() * *matrix;
    let by_rows = squared.x_axis.abs() + squared.y_axis.abs() + squared.z_axis.abs();
    // Not max_element, which forgets what is not a number.
    let [x, y, z] = by_rows.to_array();
    let largest = if (x + y + z).is_nan() { f64::NAN } else { x.max(y).max(z) };
    largest.sqrt() * (1.0 + ROUNDING)
}

/// The largest magnitudes of a vector's components, and how far they are from the middle's.
fn vectors(track: Option<&Track<DVec3>>, otherwise: DVec3, span: Span) -> (DVec3, DVec3) {
    let Some(track) = track else { return (otherwise.abs(), DVec3::ZERO) };
    let controls = match track.between(span.from, span.until) {
        Between::Held(value) => return (value.abs(), DVec3::ZERO),
        Between::Linear { ends: [a, b], t } => t.map(|t| a * (1.0 - t) + b * t).to_vec(),
        Between::Cubic { terms, length, t } => {
            part(bezier(terms.map(|term| term.extend(0.0)), length), t).map(|point| point.truncate()).to_vec()
        }
    };
    let size = controls.iter().fold(DVec3::ZERO, |size, point| size.max(point.abs()));
    let Aabb { min, max } = Aabb::from_points(controls).widened(ROUNDING * size);
    let middle = track.at(span.middle());
    (min.abs().max(max.abs()), (max - middle).max(middle - min))
}

/// Returns the smallest and the largest weight within a span.
pub(super) fn weights(track: &Track<f64>, span: Span) -> [f64; 2] {
    let controls = match track.between(span.from, span.until) {
        Between::Held(value) => return [value; 2],
        Between::Linear { ends: [a, b], t } => t.map(|t| a * (1.0 - t) + b * t).to_vec(),
        Between::Cubic { terms, length, t } => part(bezier(terms.map(DVec4::splat), length), t).map(|at| at.x).to_vec(),
    };
    let [least, most] = hull(controls.iter().map(|value| [*value; 2]));
    let rounding = ROUNDING * least.abs().max(most.abs());
    [least - rounding, most + rounding]
}

/// The range around ranges.
fn hull(ranges: impl Iterator<Item = [f64; 2]>) -> [f64; 2] {
    ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], [low, high]| [least.min(low), most.max(high)])
}

impl Track<f64> {
    /// Returns the smallest and the largest value of the track.
    pub(crate) fn range(&self) -> [f64; 2] {
        let times = self.times();
        let starts = std::iter::once(f64::NEG_INFINITY).chain(times.iter().copied());
        let spans = starts.zip(times.iter().copied().chain([f64::INFINITY]));
        let spans = spans.filter(|(from, until)| from < until).map(|(from, until)| Span { from, until });
        hull(spans.map(|span| weights(self, span)))
    }
}

/// How much longer a rotation makes a vector, and how far one of length 1 is from where the middle's puts it.
fn turns(track: &Track<DQuat>, span: Span) -> (f64, f64) {
    let middle = track.at(span.middle());
    match track.between(span.from, span.until) {
        Between::Held(value) => (1.0 + 2.0 * off_unit(value), 0.0),
        Between::Linear { ends: [a, b], t } => {
            let half_way = a.slerp(b, 0.5);
            let off = off_unit(half_way) + off_unit(a) + off_unit(b) + ROUNDING;
            let farthest = t.map(|t| apart(a.slerp(b, t), middle)).into_iter().fold(0.0, f64::max);
            (1.0 + 2.0 * off, (2.0 * (farthest + ROUNDING)).min(2.0) + 4.0 * off)
        }
        Between::Cubic { terms, length, t } => {
            let controls = part(bezier(terms.map(DVec4::from), length), t);
            let mean = controls.iter().sum::<DVec4>() / 4.0;
            let middle = DVec4::from(middle);
            let towards = middle * mean.dot(middle).signum();
            let along = mean.dot(towards);
            let size = controls.iter().map(|point| point.length()).fold(0.0, f64::max);
            let farthest = controls.iter().map(|point| (*point - along * towards).length()).fold(0.0, f64::max);
            let sine = (farthest + ROUNDING * size) / along;
            // Not a number if all control points are 0.
            let off = if sine < 1.0 { 2.0 * sine } else { 2.0 };
            (1.0 + ROUNDING, off + ROUNDING)
        }
    }
}

/// By how much the square of its length is off 1, and what rounding adds.
fn off_unit(rotation: DQuat) -> f64 {
    (rotation.length_squared() - 1.0).abs() + ROUNDING
}

/// How far apart two rotations are as unit quaternions, either of which may be written with the opposite sign.
fn apart(one: DQuat, other: DQuat) -> f64 {
    let (one, other) = (DVec4::from(one.normalize()), DVec4::from(other.normalize()));
    (one - other).length().min((one + other).length())
}

/// Control points of a Hermite spline from its value, out-tangent, next value and in-tangent.
fn bezier([first, leaving, last, arriving]: [DVec4; 4], length: f64) -> [DVec4; 4] {
    [first, first + leaving * (length / 3.0), last - arriving * (length / 3.0), last]
}

/// Control points of the part of a Bézier curve from one parameter to another: its polar form at all mixtures of the two.
fn part(controls: [DVec4; 4], [from, until]: [f64; 2]) -> [DVec4; 4] {
    let polar = |parameters: [f64; 3]| {
        let mut points = controls;
        for (step, t) in parameters.into_iter().enumerate() {
            for point in 0..3 - step {
                points[point] = points[point] * (1.0 - t) + points[point + 1] * t;
            }
        }
        points[0]
    };
    [polar([from; 3]), polar([from, from, until]), polar([from, until, until]), polar([until; 3])]
}
