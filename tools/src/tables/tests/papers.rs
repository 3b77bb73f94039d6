//! What the papers' texts say of their tables follows from the figures typed here: a mistyped one is found.

use super::super::{eovc, tog, woc, zachmann, Measure, Table};

/// A published number: of a scene, a variant and a column, the first of its cell unless another is asked for.
fn figure(table: &Table, scene: &str, variant: &str, head: &str, number: usize) -> f64 {
    let row = table.published.iter().find(|row| row.scene == scene).unwrap();
    let variant = table.variants.iter().position(|at| at.name == variant).unwrap();
    let column = table.columns.iter().position(|at| at.head == head).unwrap();
    row.figures[variant * table.numbers_in_row() + table.first_number(column) + number]
}

fn assert_near(found: f64, said: f64, by: f64, what: &str) {
    assert!((found - said).abs() <= by, "{what}: {found}, said {said}");
}

#[test]
fn what_the_eovc_thesis_says_of_its_tables_follows_from_them() {
    // IV.2: "speedup factors over CHC++, ROC, and WOC are ... 5.5/2.6/3.9, 14.8/2.9/6.8, and 9.6/1.6/1.7".
    let said = [("FC", [5.5, 2.6, 3.9]), ("RC", [14.8, 2.9, 6.8]), ("ST", [9.6, 1.6, 1.7])];
    for (scene, factors) in said {
        for (method, factor) in ["CHC++", "ROC", "WOC"].into_iter().zip(factors) {
            let of = |head: &str| figure(&eovc::TABLE_2, scene, "", head, 0);
            assert_near(of(method) / of("CR+OF"), factor, 0.2, scene);
        }
    }
    // Table 3's numbers in parentheses.
    for (scene, factor) in [("FN", 0.75), ("FC", 1.38), ("RC", 1.52), ("ST", 1.52)] {
        let of = |head: &str| figure(&eovc::TABLE_3, scene, "", head, 0);
        assert_near(of("NA") / of("CR+OF"), factor, 0.006, scene);
        // Table 4 repeats it for SAH; table 2 rounds it.
        let sah = figure(&eovc::TABLE_4, scene, "SAH", "CR+OF", 0);
        assert_eq!(sah, of("CR+OF"));
        assert_near(sah, figure(&eovc::TABLE_2, scene, "", "CR+OF", 0), 0.051, scene);
    }
}

#[test]
fn what_the_woc_thesis_says_of_its_tables_follows_from_them() {
    let scenes = ["CB", "BL", "PP", "MO"];
    // V.2: "In the ... CB and BL scenes, speed-up factors ... are 1.4-3x, 17-23x, and 3.5-5.4x over VFC, NOHC, and CHC++".
    let over = |scene: &str, head: &str| {
        figure(&woc::TABLE_3, scene, "", head, 0) / figure(&woc::TABLE_3, scene, "", "New culling", 0)
    };
    for (head, [balloons, city]) in [("VFC", [1.4, 3.0]), ("CHC++", [5.4, 3.5]), ("NOHC", [23.0, 17.0])] {
        assert_near(over("BL", head), balloons, 0.3, head);
        assert_near(over("CB", head), city, 0.3, head);
    }
    // "... gains a speedup of 29% over CHC++" (PP).
    assert_near(over("PP", "CHC++"), 1.29, 0.005, "PP");
    // V.1.A: "PSNRs ... mostly > 67 dB and not lower than 49 dB".
    let worst = scenes.map(|scene| figure(&woc::TABLE_1, scene, "", "worst dB", 0));
    assert_eq!(worst.into_iter().reduce(f64::min), Some(49.0));
    let average = scenes.map(|scene| figure(&woc::TABLE_1, scene, "", "average dB", 0));
    assert!(average.iter().all(|mean| *mean > 66.5) && average.iter().filter(|mean| **mean > 67.0).count() >= 3);
    for scene in scenes {
        assert_eq!(figure(&woc::TABLE_3, scene, "", "No culling", 1), 0.0, "{scene}: nothing is culled");
        assert_eq!(figure(&woc::TABLE_3, scene, "", "REF", 1), 100.0, "{scene}: CR is of REF");
        // Table 2's full HD on the GTX 980 is table 3's time, rounded.
        let full = figure(&woc::TABLE_2, scene, "Full-HD", "New culling", 0);
        assert_near(figure(&woc::TABLE_3, scene, "", "New culling", 0), full, 0.051, scene);
    }
}

#[test]
fn what_tog_2018_says_of_its_tables_follows_from_them() {
    // 4.2: "The improvement is pronounced, when N is small (up to 9.68 dB)."
    let psnr = |layers: &str, seeds: &str| figure(&tog::TABLE_2, "MO", layers, seeds, 1);
    let gains = tog::TABLE_2.published[0].figures;
    assert_eq!(gains.iter().copied().reduce(f64::max), Some(9.68));
    for layers in ["L=1", "L=2", "L=3", "L=4"] {
        let of_seeds = ["N=1", "N=2", "N=4"].map(|seeds| psnr(layers, seeds));
        assert!(of_seeds.is_sorted_by(|a, b| a > b), "{layers}: {of_seeds:?}");
        let ssim = figure(&tog::TABLE_2, "MO", layers, "N=1", 0);
        assert_near(ssim, 0.035, 0.006, layers);
    }
    assert_eq!((psnr("L=4", "N=1"), psnr("L=1", "N=32"), psnr("L=2", "N=1")), (9.68, 1.46, 6.03));
    // 5.3: "Our speedup over VFC ... reaches up to 3.4 (BL scene) and 7.1 (CB scene)."
    for (scene, said) in [("BL", 3.4), ("CB", 7.1)] {
        let over = figure(&tog::TABLE_5, scene, "", "VFC", 0) / figure(&tog::TABLE_5, scene, "", "WOC", 0);
        assert_near(over, said, 0.06, scene);
    }
    // Table 6: the total is the sum. "Nearly constant (< 0.71 ms)": motion and warping, which BL has as 0.71.
    for scene in ["YR", "MO", "BL", "CB"] {
        let of = |head: &str| figure(&tog::TABLE_6, scene, "", head, 0);
        let warp = of("Motion generation") + of("Depth warping");
        assert_near(warp + of("Occlusion culling"), of("Total"), 0.001, scene);
        assert!(warp < 0.7101, "{scene}: {warp}");
    }
    for scene in ["MO", "BL", "CB"] {
        let of = |speed: &str, head: &str| figure(&tog::TABLE_7, scene, speed, head, 0);
        // Table 7's speed 1 is table 5's WOC; both slow down with speed, AWOC less: it "maintains good performance".
        assert_eq!(of("1x", "WOC"), figure(&tog::TABLE_5, scene, "", "WOC", 0));
        for head in ["WOC", "AWOC"] {
            let times = ["1x", "2x", "4x", "8x", "16x"].map(|speed| of(speed, head));
            assert!(times.is_sorted(), "{scene} {head}: {times:?}");
        }
        assert!(of("16x", "AWOC") < of("16x", "WOC"), "{scene}");
    }
    // "AWOC never descends below 30 dB" is not quite what the table says: BL has 28.9 at 16x.
    assert_eq!(figure(&tog::TABLE_7, "BL", "16x", "PSNR", 0), 28.9);
}

#[test]
fn the_lectures_curve_is_the_one_that_multiqueries_go_by() {
    let frames = zachmann::PERSISTENCE.columns.iter().map(|column| match column.shows {
        [Measure::HiddenAgain(frames)] => *frames as u64,
        other => panic!("{other:?}"),
    });
    for (frames, figure) in frames.zip(zachmann::CURVE) {
        assert_near(culling::queries::multi::persistence(frames), *figure, 0.000_51, &format!("t={frames}"));
    }
    // "450k (some 4 %), hidden: 10M (96 %)".
    let of = |head: &str| figure(&zachmann::POLYGONS, "PP", "", head, 0);
    assert_near(of("seen, M") / of("all, M") * 100.0, of("seen, %"), 0.5, "visible polygons");
    assert_near(of("all, M") - of("seen, M"), 10.0, 1e-9, "hidden polygons");
}
