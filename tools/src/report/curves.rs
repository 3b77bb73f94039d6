//! Frame times along the path (Kim's thesis, figure 10; EOVC thesis, figure 15).

use super::plot::{colour, fitted, px, Axis, Scale, Tick, COLOURS, WIDTH};
use super::{front, ids, is_ideal};
use crate::results::{Method, Results};
use serde::Serialize;

const HEIGHT: f64 = 380.0;
const LEFT: f64 = 80.0;
/// Room for the labels at the ends of the curves.
const RIGHT: f64 = WIDTH - 190.0;
const TOP: f64 = 20.0;
const BOTTOM: f64 = HEIGHT - 50.0;
/// More curves cannot be told apart.
const SHOWN: usize = 12;
/// From this ratio between the slowest and the fastest frame on, times are spread by their ratios.
const WIDE: f64 = 8.0;

/// The plot.
#[derive(Serialize)]
pub struct Curves {
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
    by_ratio: bool,
    curves: Vec<Curve>,
    left_out: usize,
    alt: String,
}

#[derive(Serialize)]
struct Curve {
    class: String,
    dashed: bool,
    path: String,
    label: String,
    tip: String,
    /// Where the curve ends, and where its label is.
    end: f64,
    label_y: f64,
}

/// None if no frame was timed.
pub fn curves(results: &Results) -> Option<Curves> {
    let shown = shown(results);
    let times = || shown.iter().flat_map(|method| method.frames.frame_ms.iter().copied());
    let (least, most) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    if most <= 0.0 {
        return None;
    }
    let by_ratio = least > 0.0 && most / least >= WIDE;
    let y = if by_ratio {
        Axis { scale: Scale::Log, values: [least * 0.9, most * 1.1], pixels: [BOTTOM, TOP] }
    } else {
        Axis { scale: Scale::Linear, values: [0.0, most * 1.05], pixels: [BOTTOM, TOP] }
    };
    // A run of one frame still has a width to be drawn in.
    let last = f64::from(results.frames.saturating_sub(1).max(1));
    let x = Axis { scale: Scale::Linear, values: [0.0, last], pixels: [LEFT, RIGHT] };
    let mut curves: Vec<Curve> = shown.iter().map(|method| curve(results, method, &x, &y)).collect();
    spread(&mut curves);
    Some(Curves {
        height: HEIGHT,
        left: LEFT,
        right: RIGHT,
        top: TOP,
        bottom: BOTTOM,
        x_ticks: x.ticks(),
        y_ticks: y.ticks(),
        by_ratio,
        alt: format!(
            "Frame time of {} settings over {} frames; the tables have their medians.",
            shown.len(),
            results.frames
        ),
        left_out: results.methods.len() - shown.len(),
        curves,
    })
}

/// All, or of many those that tell most: the bounds, the front, and the first setting of each method.
fn shown(results: &Results) -> Vec<&Method> {
    let timed = |place: &usize| !results.methods[*place].frames.frame_ms.is_empty();
    let every = 0..results.methods.len();
    let bounds =
        every.clone().filter(|&place| is_ideal(&results.methods[place]) || results.methods[place].method == "none");
    let firsts = every.clone().filter(|&place| {
        results.methods[..place].iter().all(|earlier| earlier.method != results.methods[place].method)
    });
    let mut places: Vec<usize> = Vec::new();
    for place in bounds.chain(front(results)).chain(firsts).chain(every).filter(timed) {
        if places.len() < SHOWN && !places.contains(&place) {
            places.push(place);
        }
    }
    places.sort_unstable();
    places.into_iter().map(|place| &results.methods[place]).collect()
}

fn curve(results: &Results, method: &Method, x: &Axis, y: &Axis) -> Curve {
    let at = |(frame, ms): (usize, &f64)| format!("{},{}", x.place(frame as f64), y.place(*ms));
    let points: Vec<String> = method.frames.frame_ms.iter().enumerate().map(at).collect();
    let end = method.frames.frame_ms.last().map_or(BOTTOM, |ms| y.place(*ms));
    let id = ids(results).iter().position(|id| *id == method.method).unwrap_or(0);
    let first = super::first_of(results, &method.method).is_some_and(|first| first.label == method.label);
    Curve {
        class: colour(id),
        dashed: !first || id >= COLOURS,
        path: format!("M{}", points.join("L")),
        label: fitted(&method.label, WIDTH - RIGHT - 22.0),
        tip: method.label.clone(),
        end,
        label_y: end,
    }
}

/// Moves labels apart: downward from the topmost, then back up from the bottom.
fn spread(curves: &mut [Curve]) {
    const ROW: f64 = 15.0;
    curves.sort_by(|one, other| one.end.total_cmp(&other.end));
    let mut free = TOP;
    for curve in curves.iter_mut() {
        curve.label_y = px(curve.end.max(free));
        free = curve.label_y + ROW;
    }
    let mut floor = BOTTOM + ROW;
    for curve in curves.iter_mut().rev() {
        curve.label_y = px(curve.label_y.min(floor));
        floor = curve.label_y - ROW;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::tests::results;

    #[test]
    fn each_timed_method_has_a_curve_and_labels_lie_apart() {
        let mut results = results();
        results.methods[1].frames.frame_ms = vec![10.0, 10.1];
        let curves = curves(&results).unwrap();
        assert_eq!(
            curves.curves.iter().map(|curve| curve.label.as_str()).collect::<Vec<_>>(),
            ["none", "woc[search.seeds=8]", "ref"]
        );
        assert!(curves.curves.windows(2).all(|pair| pair[1].label_y - pair[0].label_y >= 14.9));
        assert!(curves.by_ratio && curves.left_out == 0);
    }

    #[test]
    fn of_many_settings_the_bounds_and_the_front_are_kept() {
        let mut results = results();
        let woc = results.methods[1].clone();
        for place in 0..40u32 {
            let mut more = woc.clone();
            more.label = format!("woc[search.seeds={place}]");
            more.frame_ms.median = 20.0 + f64::from(place);
            results.methods.push(more);
        }
        let labels: Vec<_> = shown(&results).into_iter().map(|method| method.label.as_str()).collect();
        assert_eq!(labels.len(), SHOWN);
        assert!(["none", "woc[search.seeds=8]", "ref"].iter().all(|kept| labels.contains(kept)), "{labels:?}");
    }

    #[test]
    fn nothing_timed_has_no_curves() {
        let mut results = results();
        results.methods.iter_mut().for_each(|method| method.frames.frame_ms.clear());
        assert!(curves(&results).is_none());
    }
}
