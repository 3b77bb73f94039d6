//! The title, and three sentences for a reader in a hurry.

use super::plot::number;
use super::{first_of, is_faultless, is_ideal, is_measured, ratio_to, time};
use crate::results::{Method, Results};

/// What was run, in a line.
pub fn title(results: &Results) -> String {
    let count = results.methods.len();
    format!("Occlusion culling of {}: {count} {}", results.scene.name, plural(count, "setting", "settings"))
}

/// What was run; what was fastest; what went wrong.
pub fn sentences(results: &Results) -> [String; 3] {
    [what_ran(results), fastest(results), errors(results)]
}

fn plural<'a>(count: usize, one: &'a str, many: &'a str) -> &'a str {
    if count == 1 {
        one
    } else {
        many
    }
}

fn what_ran(results: &Results) -> String {
    let count = super::ids(results).len();
    let [width, height] = results.size;
    let caution = if results.device.kind == "cpu" { ", a CPU, so compare ratios and not milliseconds" } else { "" };
    format!(
        "Sightline drew the same {} frames ({width} × {height} pixels) of “{}”, which has {} objects and {} triangles, with {count} {} of \
         leaving out what cannot be seen, each frame with one after the other, on {}{caution}.",
        results.frames,
        results.scene.name,
        number(results.scene.objects as f64),
        number(results.scene.triangles as f64),
        plural(count, "way", "ways"),
        results.device.name,
    )
}

/// The fastest method that is right, the ideal apart; of unmeasured ones, the fastest.
fn fastest(results: &Results) -> String {
    let measured = is_measured(results);
    let real = results.methods.iter().filter(|method| !is_ideal(method));
    let right = real.filter(|method| !measured || is_faultless(method));
    let Some(best) = right.min_by(|one, other| time(results, one).total_cmp(&time(results, other))) else {
        return "No method drew all frames without a fault.".to_owned();
    };
    let with = if measured { "Fastest without a single wrong pixel" } else { "Fastest" };
    let against = |id: &str, what: &str| {
        let other = first_of(results, id).filter(|other| other.label != best.label)?;
        let ratio = ratio_to(results, &other.method, best)?;
        Some(format!("{} times the time of {what}", number(ratio)))
    };
    let ratios: Vec<String> =
        [against("none", "drawing everything (none)"), against("ref", "drawing exactly what is visible (ref)")]
            .into_iter()
            .flatten()
            .collect();
    let ratios = if ratios.is_empty() { String::new() } else { format!(": {}", ratios.join(" and ")) };
    format!("{with} was {} with {} ms a frame{ratios}.", best.label, number(best.frame_ms.median))
}

fn errors(results: &Results) -> String {
    if !is_measured(results) {
        return "Errors were not measured (--no-metrics), so nothing here says whether the pictures are right."
            .to_owned();
    }
    let missing: Vec<&Method> = results.methods.iter().filter(|method| method.false_negatives > 0).collect();
    let pixels = results.methods.iter().filter(|method| method.false_negatives == 0 && !is_faultless(method)).count();
    let aside = match pixels {
        0 => String::new(),
        count => {
            format!("; {count} {} no object but changed pixels", plural(count, "setting missed", "settings missed"))
        }
    };
    let worst = missing.iter().max_by(|one, other| one.object_error_percent.total_cmp(&other.object_error_percent));
    let Some(worst) = worst else {
        return format!("No method missed a visible object in any frame{aside}.");
    };
    format!(
        "{} of {} settings missed visible objects, worst {}: {} in {} of {} frames, {} % of all that should show{aside}.",
        missing.len(),
        results.methods.len(),
        worst.label,
        worst.false_negatives,
        worst.false_negative_frames,
        results.frames,
        number(worst.object_error_percent),
    )
}
