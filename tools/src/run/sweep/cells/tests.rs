//! A cell is known by everything on which its numbers depend, and measured by its own `ref`.

use super::*;
use crate::results::tests::fields::distinct;
use std::collections::BTreeSet;

fn setting(method: &str, options: &[(&str, &str)]) -> Setting {
    let entry = culling::find(method).unwrap();
    let mut chosen = entry.default_options();
    options.iter().for_each(|(name, value)| chosen.set(name, value).unwrap());
    (entry, chosen)
}

fn plan(base: Vec<Setting>, baseline: Option<Setting>, settings: Vec<Setting>) -> SweepPlan {
    SweepPlan {
        base,
        baseline,
        settings,
        warmup: 3,
        metrics: true,
        command: "a command".into(),
        folder: "a folder".into(),
        fresh: false,
    }
}

fn woc(seeds: &str) -> Setting {
    setting("woc", &[("seeds", seeds)])
}

#[test]
fn each_setting_on_which_numbers_depend_is_in_the_key() {
    type Case = (Results, SweepPlan, Vec<Setting>);
    type Change = fn(&mut Case);
    let case = || -> Case {
        let header = Results { methods: Vec::new(), command: String::new(), ..distinct() };
        (header, plan(vec![], None, vec![]), vec![setting("ref", &[]), woc("2")])
    };
    let changes: [(&str, Change); 22] = [
        ("nothing", |_| ()),
        ("version", |c| c.0.sightline_version = "9.8.8".into()),
        ("device", |c| c.0.device.name = "another".into()),
        ("driver", |c| c.0.device.driver = "another".into()),
        ("depth format", |c| c.0.device.depth_format = "another".into()),
        ("timers", |c| c.0.device.timer_mode = "timestamps".into()),
        ("samples", |c| _ = c.0.device.details.insert("samples".into(), "4".into())),
        ("scene's name", |c| c.0.scene.name = "another".into()),
        ("scene's content", |c| c.0.scene.hash = "beef".into()),
        ("moving bounds", |c| c.0.scene.moving_bounds = "per-frame".into()),
        ("path", |c| c.0.path = "another".into()),
        ("speed", |c| c.0.speed = 2.0),
        ("seed", |c| c.0.seed = 2),
        ("size", |c| c.0.size = [1006, 1005]),
        ("frames", |c| c.0.frames = 4),
        ("shading", |c| c.0.scene.shading = "another".into()),
        ("warm-up", |c| c.1.warmup = 4),
        ("metrics", |c| c.1.metrics = false),
        ("an option", |c| c.2[1] = woc("4")),
        ("a method", |c| c.2[0] = setting("none", &[])),
        ("another setting", |c| c.2.push(woc("4"))),
        ("fewer settings", |c| c.2.truncate(1)),
    ];
    let of = |case: &Case| key_of(&case.0, &case.1, &case.2).unwrap();
    let mut keys = BTreeSet::new();
    for (name, change) in changes {
        let mut changed = case();
        change(&mut changed);
        assert!(keys.insert(of(&changed)), "{name} is not in the key");
    }
    let mut same = case();
    (same.1.command, same.1.folder, same.1.fresh) = ("another".into(), "another".into(), true);
    assert_eq!(of(&same), of(&case()));
}

#[test]
fn each_cell_has_the_baseline_and_four_settings() {
    let grid: Vec<Setting> = ["1", "2", "4", "8", "16"].map(woc).into();
    let (ideal, all) = (setting("ref", &[]), setting("none", &[]));
    let labels = |plan: &SweepPlan| -> Vec<Vec<String>> {
        plan.cells().iter().map(|cell| cell.iter().map(|(_, options)| options.label()).collect()).collect()
    };
    let default = woc("1").1.label();
    let of = |text: [&str; 5]| text.map(|seeds| woc(seeds).1.label());
    let [one, two, four, eight, sixteen] = of(["1", "2", "4", "8", "16"]);
    let found = labels(&plan(vec![all.clone(), ideal.clone()], Some(ideal.clone()), grid.clone()));
    let expected: [&[&str]; 3] = [&["ref", "none"], &["ref", &default, &two, &four, &eight], &["ref", &sixteen]];
    assert_eq!(found, expected);
    // A setting that runs in the first cell is not run again, and without a baseline each cell is alone.
    let found = labels(&plan(vec![woc("2")], None, grid));
    let expected: [&[&str]; 2] = [&[&two], &[&one, &four, &eight, &sixteen]];
    assert_eq!(found, expected);
    assert_eq!(labels(&plan(vec![ideal.clone()], Some(ideal), vec![woc("2")])), [["ref", two.as_str()]]);
}

fn cell(methods: &[(&str, &str, f64)]) -> Results {
    let of = |(label, id, median): &(&str, &str, f64)| {
        let mut method = distinct().methods.remove(0);
        (method.label, method.method) = ((*label).into(), (*id).into());
        // Neither the mean nor the 95th percentile stands in the same relation.
        method.frame_ms = crate::results::FrameMs { median: *median, p95: 100.0 - median, mean: 50.0 + median };
        method
    };
    Results { methods: methods.iter().map(of).collect(), ..distinct() }
}

fn ratios(cell: &Results) -> Vec<Option<f64>> {
    cell.methods.iter().map(|method| method.ratio_to_ref).collect()
}

#[test]
fn ratios_are_multiples_of_ref_in_the_same_cell() {
    let mut found = cell(&[("woc", "woc", 6.0), ("ref", "ref", 4.0), ("ref[x]", "ref", 3.0), ("none", "none", 2.0)]);
    set_ratios(&mut found);
    assert_eq!(ratios(&found), [1.5, 1.0, 0.75, 0.5].map(Some));
    for without in [&[("woc", "woc", 6.0), ("none", "none", 2.0)][..], &[("woc", "woc", 6.0), ("ref", "ref", 0.0)]] {
        let mut found = cell(without);
        set_ratios(&mut found);
        assert_eq!(ratios(&found), [None, None], "{without:?}");
    }
}

#[test]
fn the_baseline_of_the_first_cell_stays_and_new_methods_keep_their_ratios() {
    let mut joined = None;
    for methods in [[("ref", "ref", 4.0), ("woc[a]", "woc", 6.0)], [("ref", "ref", 8.0), ("woc[b]", "woc", 10.0)]] {
        let mut next = cell(&methods);
        set_ratios(&mut next);
        join(&mut joined, next);
    }
    let joined = joined.unwrap();
    let rows: Vec<_> = joined.methods.iter().map(|m| (m.label.as_str(), m.frame_ms.median, m.ratio_to_ref)).collect();
    assert_eq!(rows, [("ref", 4.0, Some(1.0)), ("woc[a]", 6.0, Some(1.5)), ("woc[b]", 10.0, Some(1.25))]);
}
