//! What each method culls: C/N and C/R (EOVC thesis, section 5.3).

use super::bars::{bars, Bars, Part, RowData};
use super::is_measured;
use super::plot::number;
use crate::results::{Method, Results};

/// Two bars a method: culled over all objects, and over those that the ideal culls. None if not measured.
pub fn culled(results: &Results) -> Option<Bars> {
    if !is_measured(results) {
        return None;
    }
    let rows = results.methods.iter().map(row).collect();
    let alt = "Share of objects that each method culls, of all objects and of those that ideal culling culls.";
    bars(rows, "percent", 100.0, alt.to_owned())
}

fn row(method: &Method) -> RowData {
    let part = |name: &str, share: f64, class: &str| {
        let length = 100.0 * share;
        vec![Part { length, class: class.to_owned(), tip: format!("{}: {name} {} %", method.label, number(length)) }]
    };
    RowData {
        label: method.label.clone(),
        lanes: vec![part("C/R", method.culled_over_ref, "c0"), part("C/N", method.culled_over_total, "c1")],
        value: format!("{} · {}", number(100.0 * method.culled_over_ref), number(100.0 * method.culled_over_total)),
    }
}
