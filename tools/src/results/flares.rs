//! What lens flares knew of their light: a table of its own, where there are any.

use super::grid::Grid;
use super::{FlareErrors, Results};

/// One row a method: how much of the light shows, and how far from that the flare's brightness was. Empty without flares.
pub fn flares_table(results: &Results) -> String {
    let flares: Vec<(&str, &FlareErrors)> =
        results.methods.iter().filter_map(|method| Some((method.label.as_str(), method.flare.as_ref()?))).collect();
    let Some((_, first)) = flares.first() else { return String::new() };
    let mut grid = Grid::new(vec!["on screen", "shows", "error", "worst"], 34);
    for (label, flare) in &flares {
        let cell = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
        let on_screen = match flare.shows_mean {
            None => "-".to_owned(),
            Some(_) => format!("{} of {}", flare.frames_on_screen, results.frames),
        };
        let cells = vec![on_screen, cell(flare.shows_mean), cell(flare.error_mean), cell(flare.error_max)];
        grid.rows.push(((*label).to_owned(), cells));
    }
    let query =
        if first.when == "same" { "its own query, which it waits for" } else { "the query of the frame before" };
    let mut lines = vec![format!("lens flare of a light {}, each frame's by {query}", first.light)];
    lines.extend(grid.lines("method"));
    if flares.iter().all(|(_, flare)| flare.shows_mean.is_some() && flare.frames_on_screen == 0) {
        lines.push("the light is on the screen in no frame: choose another with --light or --light-at".to_owned());
    }
    lines.iter().map(|line| format!("{line}\n")).collect()
}
