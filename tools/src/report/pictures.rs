//! The pictures as the template shows them.

use super::images::{DataUri, Gallery, WorstFrame};
use super::plot::number;
use crate::results::Results;
use serde::Serialize;

/// Settings whose worst frame is shown; of a sweep's more, only the worst setting of each method.
const SHOWN_IN_FULL: usize = 16;

/// All pictures of a report.
#[derive(Serialize)]
pub struct Pictures {
    /// Worst frames of methods with faults.
    worst: Vec<Worst>,
    /// Labels without a fault.
    right: Vec<String>,
    /// Settings with faults that are not shown.
    left_out: usize,
    /// The frame of the buffers.
    frame: usize,
    buffers: Vec<Buffers>,
}

#[derive(Serialize)]
struct Worst {
    label: String,
    frame: usize,
    fault: String,
    pictures: [DataUri; 3],
}

#[derive(Serialize)]
struct Buffers {
    label: String,
    overdraw: DataUri,
    items: DataUri,
}

/// The pictures in the order of the methods.
pub fn pictures(results: &Results, gallery: &Gallery) -> Pictures {
    let of = |label: &String| gallery.of_method.get(label);
    let seen: Vec<_> = results.methods.iter().filter_map(|method| Some((method, of(&method.label)?))).collect();
    let faulty: Vec<_> =
        seen.iter().filter_map(|(method, pictures)| Some((*method, pictures.worst.as_ref()?))).collect();
    let few = faulty.len() <= SHOWN_IN_FULL;
    let badness = |worst: &WorstFrame| -worst.error.psnr_db.unwrap_or(f64::INFINITY);
    let shown: Vec<_> = faulty
        .iter()
        .filter(|(method, worst)| {
            let mut rivals =
                faulty.iter().filter(|(rival, _)| rival.method == method.method && rival.label != method.label);
            few || rivals.all(|(rival, other)| (badness(other), &rival.label) < (badness(worst), &method.label))
        })
        .collect();
    let buffers = seen.iter().filter_map(|(method, pictures)| {
        let [overdraw, items] = pictures.buffers.clone()?;
        Some(Buffers { label: method.label.clone(), overdraw, items })
    });
    Pictures {
        left_out: faulty.len() - shown.len(),
        worst: shown.into_iter().map(|(method, worst)| shown_worst(&method.label, worst)).collect(),
        right: seen.iter().filter(|(_, p)| p.worst.is_none()).map(|(method, _)| method.label.clone()).collect(),
        frame: gallery.frame,
        buffers: buffers.collect(),
    }
}

fn shown_worst(label: &str, worst: &WorstFrame) -> Worst {
    let error = &worst.error;
    let psnr = error.psnr_db.map_or("colours identical".to_owned(), |psnr| format!("PSNR {} dB", number(psnr)));
    let fault = format!(
        "visible objects missed: {} of {}; pixels of another depth: {}; {psnr}",
        error.false_negatives, error.ref_visible, error.differing_pixels
    );
    Worst { label: label.to_owned(), frame: worst.frame, fault, pictures: worst.pictures.clone() }
}
