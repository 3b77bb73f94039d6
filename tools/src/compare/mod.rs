//! Two results side by side: is B faster than A, and by how much is that more than noise? What changed in errors? And gates,
//! sentences that must not come true, for CI.

mod bootstrap;
mod gate;

pub use bootstrap::{ratio_interval, Interval};
pub use gate::{Fact, Gate};

use crate::results::{Method, Results};
use anyhow::{bail, Result};
use serde::Serialize;

/// One label that both files have.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The label.
    pub label: String,
    /// The time of B over that of A.
    pub ratio: Interval,
    /// `faster`, `slower`, or `no difference shown`.
    pub verdict: &'static str,
    /// Visible objects missed, A and B.
    pub false_negatives: [u64; 2],
    /// Percent of the visible objects missed, A and B.
    pub object_error_percent: [f64; 2],
    /// Pixels of another depth, mean, A and B.
    pub differing_pixels_mean: [f64; 2],
    /// Worst picture, dB, A and B; none: identical.
    pub psnr_worst_db: [Option<f64>; 2],
    /// Objects drawn, mean, A and B.
    pub drawn_mean: [f64; 2],
    /// C/R, A and B.
    pub culled_over_ref: [f64; 2],
    /// By stage: the time of B over that of A, of stages that both ran.
    pub stages: Vec<(String, Interval)>,
}

/// What two files say together.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Labels of both, in B's order.
    pub rows: Vec<Row>,
    /// Labels of A alone.
    pub only_in_a: Vec<String>,
    /// Labels of B alone.
    pub only_in_b: Vec<String>,
    /// What differs between the runs, where that was forced.
    pub forced: Vec<String>,
}

/// What must be the same for a ratio to mean anything: name and both values, where they differ.
pub fn differences(a: &Results, b: &Results) -> Vec<String> {
    let text = |results: &Results| {
        [
            ("scene", results.scene.name.clone()),
            ("objects", results.scene.objects.to_string()),
            ("triangles", results.scene.triangles.to_string()),
            ("path", results.path.clone()),
            ("speed", results.speed.to_string()),
            ("seed", results.seed.to_string()),
            ("size", format!("{}x{}", results.size[0], results.size[1])),
            ("frames", results.frames.to_string()),
            ("device", results.device.name.clone()),
        ]
    };
    let pairs = text(a).into_iter().zip(text(b));
    let mut found: Vec<String> =
        pairs.filter(|(a, b)| a.1 != b.1).map(|((name, a), (_, b))| format!("{name}: {a} and {b}")).collect();
    let hashes = [&a.scene.hash, &b.scene.hash];
    if hashes[0] != hashes[1] && hashes.iter().all(|hash| !hash.is_empty()) {
        found.push("the scene's contents".into());
    }
    found
}

/// Compares what both files have. `force` compares runs that differ in more than the program.
///
/// # Errors
/// Runs that differ, named, unless forced; no label in common.
pub fn compare(a: &Results, b: &Results, force: bool) -> Result<Comparison> {
    let forced = differences(a, b);
    if !forced.is_empty() && !force {
        bail!("the runs differ in more than the program ({}); --force compares them all the same", forced.join("; "));
    }
    let only = |of: &Results, other: &Results| -> Vec<String> {
        let labels = of.methods.iter().map(|method| method.label.clone());
        labels.filter(|label| other.method(label).is_none()).collect()
    };
    let both = b.methods.iter().filter_map(|new| a.method(&new.label).map(|old| row(old, new)));
    let rows: Vec<Row> = both.collect();
    if rows.is_empty() {
        bail!("no method's label is in both files");
    }
    Ok(Comparison { rows, only_in_a: only(a, b), only_in_b: only(b, a), forced })
}

fn row(a: &Method, b: &Method) -> Row {
    let ratio = ratio_interval(&a.frames.frame_ms, &b.frames.frame_ms);
    let verdict = match ratio {
        Interval { high: Some(high), .. } if high < 1.0 => "faster",
        Interval { low: Some(low), .. } if low > 1.0 => "slower",
        _ => "no difference shown",
    };
    let ran = |times: &[Option<f64>]| times.iter().map(|ms| ms.unwrap_or(0.0)).collect::<Vec<f64>>();
    let stages = b.stages.iter().filter_map(|stage| {
        let [a, b] = [a, b].map(|method| method.frames.stages.get(&stage.name));
        Some((stage.name.clone(), ratio_interval(&ran(a?), &ran(b?))))
    });
    Row {
        label: b.label.clone(),
        ratio,
        verdict,
        false_negatives: [a.false_negatives, b.false_negatives],
        object_error_percent: [a.object_error_percent, b.object_error_percent],
        differing_pixels_mean: [a.differing_pixels_mean, b.differing_pixels_mean],
        psnr_worst_db: [a.psnr_worst_db, b.psnr_worst_db],
        drawn_mean: [a.drawn_mean, b.drawn_mean],
        culled_over_ref: [a.culled_over_ref, b.culled_over_ref],
        stages: stages.collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::tests::results as example;

    fn timed(times: [f64; 8]) -> Results {
        let mut results = example();
        let method = &mut results.methods[0];
        method.frames.frame_ms = times.to_vec();
        results
    }

    #[test]
    fn a_run_equals_itself_and_half_the_time_is_faster() {
        let a = timed([10.0, 11.0, 10.5, 10.2, 10.9, 10.1, 10.4, 10.7]);
        let same = &compare(&a, &a, false).unwrap().rows[0];
        assert_eq!((same.verdict, same.ratio.ratio), ("no difference shown", Some(1.0)));
        let mut b = a.clone();
        b.methods[0].frames.frame_ms.iter_mut().for_each(|ms| *ms *= 0.5);
        assert_eq!(compare(&a, &b, false).unwrap().rows[0].verdict, "faster");
        assert_eq!(compare(&b, &a, false).unwrap().rows[0].verdict, "slower");
    }

    type Change = fn(&mut Results);

    #[test]
    fn runs_that_differ_are_refused_by_name() {
        let a = example();
        let changes: [(&str, Change); 6] = [
            ("scene", |b| b.scene.name = "another".into()),
            ("size", |b| b.size = [1, 2]),
            ("frames", |b| b.frames += 1),
            ("seed", |b| b.seed += 1),
            ("speed", |b| b.speed += 1.0),
            ("device", |b| b.device.name = "another".into()),
        ];
        for (name, change) in changes {
            let mut b = a.clone();
            change(&mut b);
            let refusal = compare(&a, &b, false).unwrap_err().to_string();
            assert!(refusal.contains(&format!("{name}: ")) && refusal.contains("--force"), "{refusal}");
            assert!(compare(&a, &b, true).unwrap().forced[0].starts_with(name));
        }
    }

    #[test]
    fn labels_of_one_file_are_listed() {
        let (a, mut b) = (example(), example());
        b.methods[0].label = "another".into();
        let comparison = compare(&a, &b, false);
        if a.methods.len() > 1 {
            let comparison = comparison.unwrap();
            assert_eq!(comparison.only_in_b, ["another"]);
            assert_eq!(comparison.only_in_a, [a.methods[0].label.clone()]);
        } else {
            assert!(comparison.is_err());
        }
    }
}
