//! The plane of run time against error: every method and setting as a point, and the front of those worth choosing.

use super::plot::{colour, mark, number, px, text_width, Axis, Scale, Tick, WIDTH};
use super::{front, ids, is_ideal, is_measured, ratio_to, time};
use crate::results::{Method, Results};
use serde::Serialize;

const HEIGHT: f64 = 430.0;
/// Left, right, top and bottom edge of the space for points.
const LEFT: f64 = 80.0;
const RIGHT: f64 = WIDTH - 20.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = HEIGHT - 70.0;
/// Points that all have their label; of more, only those of the front and the ideal.
const LABELLED: usize = 16;
/// Between a label and the next in its row, pixels.
const SPACING: f64 = 8.0;
/// Errors below this are spread evenly, percent: one object of ten thousand is seen to be no zero.
const LINEAR_TO: f64 = 0.01;
/// The least error that the axis reaches up to, percent, so that a plane of exact methods has a scale.
const LEAST_TOP: f64 = 1.0;

/// The plot.
#[derive(Serialize)]
pub struct Plane {
    height: f64,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
    x_ticks: Vec<Tick>,
    y_ticks: Vec<Tick>,
    x_title: String,
    points: Vec<Point>,
    /// The front as a path: up and right of it nothing is worth choosing.
    front: String,
    legend: Vec<Key>,
    all_labelled: bool,
    alt: String,
}

#[derive(Serialize)]
struct Point {
    class: String,
    mark: String,
    tip: String,
    label: Option<Label>,
    on_front: bool,
    ideal: bool,
}

/// A label, and the line that leads from its point to its nearest edge.
#[derive(Serialize)]
struct Label {
    text: String,
    x: f64,
    y: f64,
    from: [f64; 2],
    to: [f64; 2],
}

#[derive(Serialize)]
struct Key {
    id: String,
    class: String,
    mark: String,
    x: f64,
    y: f64,
}

/// None without methods or errors, or if a time cannot be drawn.
pub fn plane(results: &Results) -> Option<Plane> {
    let times: Vec<f64> = results.methods.iter().map(|method| time(results, method)).collect();
    let drawable = !times.is_empty() && times.iter().all(|time| *time > 0.0 && time.is_finite());
    if !is_measured(results) || !drawable {
        return None;
    }
    let least = times.iter().copied().fold(f64::INFINITY, f64::min);
    let most = times.iter().copied().fold(0.0, f64::max);
    let error = results.methods.iter().map(|method| method.object_error_percent).fold(LEAST_TOP, f64::max);
    let x = Axis { scale: Scale::Log, values: [least * 0.9, most * 1.15], pixels: [LEFT, RIGHT] };
    // A gap below 0, so that the marks of exact methods lie free.
    let y = Axis { scale: Scale::Symlog(LINEAR_TO), values: [0.0, error * 1.3], pixels: [BOTTOM - 24.0, TOP] };
    let places: Vec<[f64; 2]> = results
        .methods
        .iter()
        .zip(&times)
        .map(|(method, time)| [x.place(*time), y.place(method.object_error_percent)])
        .collect();
    let front = front(results);
    let legend = legend(&ids(results));
    Some(Plane {
        height: legend.last().map_or(HEIGHT, |key| key.y + 14.0),
        left: LEFT,
        right: RIGHT,
        top: TOP,
        bottom: BOTTOM,
        x_ticks: x.ticks(),
        y_ticks: y.ticks(),
        x_title: x_title(results),
        points: points(results, &places, &front, y.place(0.0)),
        front: front_path(&front.iter().map(|&place| places[place]).collect::<Vec<_>>()),
        legend,
        all_labelled: results.methods.len() <= LABELLED,
        alt: alt(results, &front),
    })
}

fn x_title(results: &Results) -> String {
    match super::first_of(results, "ref") {
        Some(_) => "median frame time as a multiple of ref's (left is faster)".to_owned(),
        None => "median frame time in ms (left is faster); ref did not run".to_owned(),
    }
}

fn alt(results: &Results, front: &[usize]) -> String {
    let of = |&place: &usize| {
        let method = &results.methods[place];
        format!(
            "{} ({} ms, {} % missed)",
            method.label,
            number(method.frame_ms.median),
            number(method.object_error_percent)
        )
    };
    let front: Vec<String> = front.iter().map(of).collect();
    format!(
        "Run time against missed objects of {} settings. On the front: {}.",
        results.methods.len(),
        front.join(", ")
    )
}

fn points(results: &Results, places: &[[f64; 2]], front: &[usize], zero: f64) -> Vec<Point> {
    let ids = ids(results);
    let few = results.methods.len() <= LABELLED;
    let wanted = |place: usize| few || front.contains(&place) || is_ideal(&results.methods[place]);
    let texts: Vec<Option<&str>> = results
        .methods
        .iter()
        .enumerate()
        .map(|(place, method)| wanted(place).then_some(method.label.as_str()))
        .collect();
    let labels = labels(places, &texts, zero);
    let made = results.methods.iter().zip(places).zip(labels).enumerate().map(|(place, ((method, at), label))| {
        let id = ids.iter().position(|id| *id == method.method).unwrap_or(0);
        Point {
            class: colour(id),
            mark: mark(id, at[0], at[1]),
            tip: tip(results, method),
            label,
            on_front: front.contains(&place),
            ideal: is_ideal(method),
        }
    });
    made.collect()
}

fn tip(results: &Results, method: &Method) -> String {
    let ratio = ratio_to(results, "ref", method).map_or(String::new(), |ratio| format!(", {} × ref", number(ratio)));
    let [ms, error] = [method.frame_ms.median, method.object_error_percent].map(number);
    format!("{}: {ms} ms{ratio}, {error} % of visible objects missed", method.label)
}

/// A rectangle: left, top, right, bottom.
type Box = [f64; 4];

fn meet(one: &Box, other: &Box) -> bool {
    one[0] < other[2] && other[0] < one[2] && one[1] < other[3] && other[1] < one[3]
}

/// Each label where it covers neither a mark, nor another label, nor the line of no error (at this height): near its point, or
/// else higher or lower with a line to it. One for which there is no such place is left out; the tables have it.
fn labels(points: &[[f64; 2]], texts: &[Option<&str>], zero: f64) -> Vec<Option<Label>> {
    let marks = points.iter().map(|[x, y]| [x - 6.0, y - 6.0, x + 6.0, y + 6.0]);
    let mut taken: Vec<Box> = marks.chain([[LEFT, zero, RIGHT, zero]]).collect();
    let mut labels: Vec<Option<Label>> = points.iter().map(|_| None).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&one, &other| points[one][0].total_cmp(&points[other][0]));
    for place in order {
        let Some(text) = texts[place] else { continue };
        let free = candidates(points[place], text_width(text) + SPACING)
            .find(|space| !taken.iter().any(|other| meet(space, other)));
        if let Some(space) = free {
            taken.push(space);
            labels[place] = Some(label(text, space, points[place]));
        }
    }
    labels
}

fn label(text: &str, space: Box, from: [f64; 2]) -> Label {
    // Letters stand on a line a quarter of the row above its lower edge.
    let baseline = space[3] - 4.0;
    let nearest = [from[0].clamp(space[0], space[2] - SPACING), from[1].clamp(space[1] + 3.0, baseline + 2.0)];
    Label { text: text.to_owned(), x: px(space[0]), y: px(baseline), from, to: nearest.map(px) }
}

/// Spaces for a label of this width, best first, all inside the plot.
fn candidates([x, y]: [f64; 2], width: f64) -> impl Iterator<Item = Box> {
    const ROW: f64 = 16.0;
    let rows = (1..24).flat_map(|row| [-f64::from(row), f64::from(row)]);
    let beside = [[x + 9.0, y - 8.0], [x - 9.0 - width, y - 8.0]];
    let stacked =
        rows.flat_map(move |row| [x + 4.0, x - width / 2.0, x - 4.0 - width].map(|left| [left, y - 8.0 + row * ROW]));
    let all = beside.into_iter().chain(stacked);
    let boxes = all.map(move |[left, top]| [left, top, left + width, top + ROW]);
    boxes.filter(|space| space[0] > LEFT && space[2] < WIDTH && space[1] > TOP - 12.0 && space[3] < BOTTOM)
}

/// Steps from the fastest point down to the one with least error, then on to the right edge.
fn front_path(points: &[[f64; 2]]) -> String {
    let Some([x, y]) = points.first() else { return String::new() };
    let mut path = format!("M{x},{TOP}V{y}");
    for [x, y] in &points[1..] {
        path.push_str(&format!("H{x}V{y}"));
    }
    path + &format!("H{RIGHT}")
}

/// Keys of the methods in rows under the plot.
fn legend(ids: &[&str]) -> Vec<Key> {
    let (mut x, mut y) = (LEFT, HEIGHT);
    let mut keys = Vec::new();
    for (place, id) in ids.iter().enumerate() {
        let width = text_width(id) + 34.0;
        if x + width > RIGHT && x > LEFT {
            (x, y) = (LEFT, y + 20.0);
        }
        let key =
            Key { id: (*id).to_owned(), class: colour(place), mark: mark(place, x + 6.0, y - 4.0), x: x + 17.0, y };
        keys.push(key);
        x += width;
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_cover_no_mark_and_no_label() {
        // Twelve points on one line, some on one spot: as a run of exact methods looks.
        let points: Vec<[f64; 2]> = (0..12).map(|i| [200.0 + 7.0 * f64::from(i / 2), BOTTOM - 24.0]).collect();
        let texts: Vec<Option<&str>> = points.iter().map(|_| Some("roc-iterative")).collect();
        let labels = labels(&points, &texts, BOTTOM - 24.0);
        let spaces: Vec<Box> =
            labels.iter().flatten().map(|l| [l.x, l.y - 12.0, l.x + text_width(&l.text), l.y + 4.0]).collect();
        assert_eq!(spaces.len(), points.len());
        for (place, space) in spaces.iter().enumerate() {
            assert!(spaces[..place].iter().all(|other| !meet(space, other)), "{place}");
            assert!(!meet(space, &[LEFT, BOTTOM - 24.0, RIGHT, BOTTOM - 24.0]), "{place}");
            assert!(points.iter().all(|[x, y]| !meet(space, &[*x, *y, *x, *y])), "{place}");
        }
    }

    #[test]
    fn the_front_steps_down_to_the_right() {
        assert_eq!(front_path(&[]), "");
        assert_eq!(front_path(&[[100.0, 50.0], [120.0, 80.0]]), format!("M100,{TOP}V50H120V80H{RIGHT}"));
    }
}
