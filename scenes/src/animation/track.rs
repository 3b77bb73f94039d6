//! One animated property: key times, values, and how to go from one to the next (glTF 2.0, appendix C).

use glam::{DQuat, DVec3, DVec4};
use std::sync::Arc;

/// How a property goes from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Holds each value until the next key.
    Step,
    /// Straight lines; rotations along the shorter arc.
    #[default]
    Linear,
    /// Hermite splines: each key has an in-tangent, a value and an out-tangent, in this order.
    CubicSpline,
}

/// What a [`Track`] can animate.
pub trait Interpolate: Copy {
    /// Linear from `a` to `b`, `t` in 0..=1.
    fn linear(a: Self, b: Self, t: f64) -> Self;
    /// The sum of the four terms times their weights.
    fn weighted(terms: [Self; 4], weights: [f64; 4]) -> Self;
    /// All components are finite.
    fn is_finite(self) -> bool;
}

impl Interpolate for DVec3 {
    fn linear(a: Self, b: Self, t: f64) -> Self {
        // Not a.lerp(b, t), whose rounding may miss b at t = 1.
        a * (1.0 - t) + b * t
    }
    fn weighted(terms: [Self; 4], weights: [f64; 4]) -> Self {
        terms.iter().zip(weights).map(|(&term, weight)| term * weight).sum()
    }
    fn is_finite(self) -> bool {
        DVec3::is_finite(self)
    }
}

/// Weights of morph targets.
impl Interpolate for f64 {
    fn linear(a: Self, b: Self, t: f64) -> Self {
        a * (1.0 - t) + b * t
    }
    fn weighted(terms: [Self; 4], weights: [f64; 4]) -> Self {
        terms.iter().zip(weights).map(|(&term, weight)| term * weight).sum()
    }
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

impl Interpolate for DQuat {
    fn linear(a: Self, b: Self, t: f64) -> Self {
        a.slerp(b, t)
    }
    fn weighted(terms: [Self; 4], weights: [f64; 4]) -> Self {
        let sum: DVec4 = terms.iter().zip(weights).map(|(&term, weight)| DVec4::from(term) * weight).sum();
        DQuat::from_vec4(sum.try_normalize().unwrap_or(DVec4::W))
    }
    fn is_finite(self) -> bool {
        DQuat::is_finite(self)
    }
}

/// An animated property. A clone shares its keys.
#[derive(Clone, Debug)]
pub struct Track<T> {
    interpolation: Interpolation,
    times: Arc<[f64]>,
    values: Arc<[T]>,
}

/// What gives a track's values between two times: see [`Track::between`].
pub(crate) enum Between<T> {
    /// One value.
    Held(T),
    /// A part, from one `t` to the other, of the way from one value to the next.
    Linear { ends: [T; 2], t: [f64; 2] },
    /// The same of a spline through two values; terms are the first, what it leaves with, the second, and what it arrives with.
    Cubic { terms: [T; 4], length: f64, t: [f64; 2] },
}

impl<T: Interpolate> Track<T> {
    /// A track with at least one key. `times` are seconds, ascending; `values` has one a key, or three for cubic splines.
    ///
    /// # Errors
    /// What is wrong, as half a sentence: no keys, wrong counts, times that descend, or a number that is not finite.
    pub fn new(interpolation: Interpolation, times: Vec<f64>, values: Vec<T>) -> Result<Self, String> {
        Self::with_times(interpolation, times.into(), values)
    }

    /// Makes a track like [`Track::new`], with times that other tracks share.
    pub(crate) fn with_times(interpolation: Interpolation, times: Arc<[f64]>, values: Vec<T>) -> Result<Self, String> {
        let each = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        if times.is_empty() {
            return Err("it has no keys".into());
        }
        if times.len().checked_mul(each) != Some(values.len()) {
            return Err(format!("{} keys need {each} values each, but there are {}", times.len(), values.len()));
        }
        if !times.iter().all(|time| time.is_finite()) || !values.iter().all(|value| value.is_finite()) {
            return Err("a time or value is not a finite number".into());
        }
        if let Some(key) = (1..times.len()).find(|&key| times[key] < times[key - 1]) {
            return Err(format!("the time of key {key} is before that of key {}", key - 1));
        }
        Ok(Track { interpolation, times, values: values.into() })
    }

    /// True if the track has one value at all times.
    pub(crate) fn is_constant(&self) -> bool
    where
        T: PartialEq,
    {
        let first = self.value(0);
        let keys = (0..self.times.len()).all(|key| self.value(key) == first);
        // The tangents of splines lead away from their values.
        keys && (self.interpolation != Interpolation::CubicSpline || self.times.len() == 1)
    }

    /// Time of the first and the last key in seconds.
    pub fn duration_s(&self) -> (f64, f64) {
        (self.times[0], self.times[self.times.len() - 1])
    }

    /// Returns the values between which a LINEAR or STEP track stays, component by component. None for splines, which can leave the
    /// range of their keys.
    pub(crate) fn values_that_bound(&self) -> Option<&[T]> {
        (self.interpolation != Interpolation::CubicSpline).then_some(&self.values)
    }

    /// Times of all keys in seconds, ascending.
    pub(crate) fn times(&self) -> &[f64] {
        &self.times
    }

    /// The value at a time; the first or last key's outside their times.
    pub fn at(&self, seconds: f64) -> T {
        match self.between(seconds, seconds) {
            Between::Held(value) => value,
            Between::Linear { ends: [a, b], t: [t, _] } => T::linear(a, b, t),
            Between::Cubic { terms, length, t: [t, _] } => {
                let (t2, t3) = (t * t, t * t * t);
                T::weighted(
                    terms,
                    [2.0 * t3 - 3.0 * t2 + 1.0, length * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, length * (t3 - t2)],
                )
            }
        }
    }

    /// What gives the values from one time on until before another, if there is no key after the first and before the other.
    pub(crate) fn between(&self, from: f64, until: f64) -> Between<T> {
        // The number of keys at or before the time. Not a number counts as before all.
        let after = self.times.partition_point(|&time| time <= from);
        if after == 0 {
            return Between::Held(self.value(0));
        }
        let key = after - 1;
        if after == self.times.len() || self.interpolation == Interpolation::Step {
            return Between::Held(self.value(key));
        }
        let length = self.times[after] - self.times[key];
        let t = [from, until].map(|seconds| (seconds - self.times[key]) / length);
        if self.interpolation == Interpolation::Linear {
            return Between::Linear { ends: [self.value(key), self.value(after)], t };
        }
        let terms = [self.value(key), self.values[3 * key + 2], self.value(after), self.values[3 * after]];
        Between::Cubic { terms, length, t }
    }

    fn value(&self, key: usize) -> T {
        match self.interpolation {
            Interpolation::CubicSpline => self.values[3 * key + 1],
            _ => self.values[key],
        }
    }
}
