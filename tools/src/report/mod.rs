//! `report.html`: one file that shows a run to someone who has never seen Sightline. Plots, tables and pictures of what is in the
//! results; nothing is measured or decided here.
//!
//! The plots are SVG through the same templates as the page, not a plot crate's: such crates write colours and fonts as attributes, which
//! takes away dark mode and print; and know neither an axis that shows 0 beside 0.01 and 10 nor what a reader who cannot see is told.

mod bars;
mod culled;
mod curves;
mod facts;
mod images;
mod measures;
mod pictures;
mod plane;
mod plot;
mod skipped;
mod stages;
#[cfg(test)]
mod tests;
mod words;

pub use images::{DataUri, Gallery, MethodPictures, WorstFrame};

use crate::results::files::write_atomically;
use crate::results::{Method, Results};
use anyhow::Result;
use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, UndefinedBehavior};
use serde::Serialize;
use std::path::Path;

/// Each template under its name.
const TEMPLATES: &[(&str, &str)] = &[
    ("report", include_str!("templates/report.html")),
    ("style", include_str!("templates/style.css")),
    ("plane", include_str!("templates/plane.svg")),
    ("curves", include_str!("templates/curves.svg")),
    ("bars", include_str!("templates/bars.svg")),
    ("tables", include_str!("templates/tables.html")),
    ("pictures", include_str!("templates/pictures.html")),
];

/// Writes the report, whole or not at all. Without a gallery it has no pictures, and says so.
///
/// # Errors
/// The file cannot be written (the error names it), or a template is broken, which is a defect.
pub fn write(results: &Results, gallery: Option<&Gallery>, path: &Path) -> Result<()> {
    let text = html(results, gallery)?;
    write_atomically(path, |to| to.write_all(text.as_bytes()))?;
    Ok(())
}

/// The report as HTML that is also well-formed XML. All text is escaped: labels and scenes carry names of files.
///
/// # Errors
/// A template is broken, which is a defect.
pub fn html(results: &Results, gallery: Option<&Gallery>) -> Result<String> {
    let mut templates = Environment::new();
    templates.set_undefined_behavior(UndefinedBehavior::Strict);
    templates.set_auto_escape_callback(|_| AutoEscape::Html);
    for (name, template) in TEMPLATES {
        templates.add_template(name, template)?;
    }
    let page = Page {
        title: words::title(results),
        sentences: words::sentences(results),
        facts: facts::facts(results),
        measured: is_measured(results),
        plane: plane::plane(results),
        curves: curves::curves(results),
        stages: stages::stages(results),
        culled: culled::culled(results),
        tables: measures::tables(results),
        skipped: skipped::skipped(results),
        pictures: gallery.map(|gallery| pictures::pictures(results, gallery)),
    };
    let text = templates.get_template("report")?.render(Serde(&page))?;
    // Letters that neither XML nor HTML allows, from the name of a file.
    Ok(text.replace(|letter: char| letter.is_control() && letter != '\n' && letter != '\t', "\u{fffd}"))
}

/// What the templates are given. What is none is left out of the page, or a line says why.
#[derive(Serialize)]
struct Page {
    title: String,
    sentences: [String; 3],
    facts: Vec<facts::Fact>,
    measured: bool,
    plane: Option<plane::Plane>,
    curves: Option<curves::Curves>,
    stages: Option<stages::Stages>,
    culled: Option<bars::Bars>,
    tables: Vec<measures::Table>,
    skipped: Vec<skipped::Skipped>,
    pictures: Option<pictures::Pictures>,
}

/// Was the untimed pass run? Without it nothing is known but times.
fn is_measured(results: &Results) -> bool {
    results.methods.iter().any(Method::is_measured)
}

/// The method that ran as `id`, first of its settings.
fn first_of<'a>(results: &'a Results, id: &str) -> Option<&'a Method> {
    results.methods.iter().find(|method| method.method == id)
}

/// A method's median frame time as a multiple of that of the first setting of `id`; none if that did not run or took no time.
fn ratio_to(results: &Results, id: &str, method: &Method) -> Option<f64> {
    if let ("ref", Some(ratio)) = (id, method.ratio_to_ref) {
        return Some(ratio);
    }
    let reference = first_of(results, id)?.frame_ms.median;
    (reference > 0.0).then(|| method.frame_ms.median / reference)
}

/// What the plane shows as a method's time: the multiple of the ideal's, or milliseconds where that did not run.
fn time(results: &Results, method: &Method) -> f64 {
    ratio_to(results, "ref", method).unwrap_or(method.frame_ms.median)
}

/// Ids of methods, each once, in the order of the run: a method's place here is its colour.
fn ids(results: &Results) -> Vec<&str> {
    let mut ids = Vec::new();
    for method in &results.methods {
        if !ids.contains(&method.method.as_str()) {
            ids.push(&method.method);
        }
    }
    ids
}

/// `ref` knows the answer before it draws: a bound, which no method can be asked to beat.
fn is_ideal(method: &Method) -> bool {
    method.method == "ref"
}

/// Drew every frame as the truth: nothing missed, no pixel different.
fn is_faultless(method: &Method) -> bool {
    method.false_negatives == 0 && method.differing_pixels_mean == 0.0 && method.psnr_worst_db.is_none()
}

/// The methods worth choosing: those that no other beats in both time and missed objects; the ideal stands apart. Places in
/// the results, fastest first.
fn front(results: &Results) -> Vec<usize> {
    let real: Vec<usize> = (0..results.methods.len()).filter(|&place| !is_ideal(&results.methods[place])).collect();
    let points: Vec<(f64, f64)> = real
        .iter()
        .map(|&place| (time(results, &results.methods[place]), results.methods[place].object_error_percent))
        .collect();
    crate::measures::pareto::front(&points).into_iter().map(|point| real[point]).collect()
}
