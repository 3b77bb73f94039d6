//! Made-up runs with a planted change each: the comparison sees it, and the gates do.

mod figures;

use super::*;
use crate::results::tests::results;
use crate::results::Stage;

const PLAIN: CompareOptions<'static> =
    CompareOptions { force: false, stages: true, bootstrap: Bootstrap { resamples: 500, seed: 1 }, by: None };

/// `none`, `woc[search.seeds=8]` and `ref` over 20 frames that differ from each other, with everything measured.
fn run() -> Results {
    let mut run = results();
    run.frames = 20;
    for (place, method) in run.methods.iter_mut().enumerate() {
        let base = 10.0 * (place + 1) as f64;
        let frames = &mut method.frames;
        frames.frame_ms = (0..20).map(|frame| base + f64::from(frame * 7 % 20)).collect();
        (frames.drawn, frames.false_negatives, frames.differing_pixels) = (vec![5; 20], vec![0; 20], vec![0; 20]);
        (frames.psnr_db, frames.stages) = (vec![None; 20], BTreeMap::new());
        (frames.triangles, frames.ssim) = (vec![7; 20], vec![1.0; 20]);
    }
    let method = &mut run.methods[1];
    let draw = method.frames.frame_ms.iter().map(|ms| Some(ms / 2.0)).collect();
    let search = (0..20).map(|frame| (frame % 2 == 0).then_some(1.0 + 0.1 * f64::from(frame))).collect();
    method.frames.stages = [("draw/all".to_owned(), draw), ("warp/search".to_owned(), search)].into();
    run
}

fn woc(run: &mut Results) -> &mut Method {
    &mut run.methods[1]
}

/// The first entry behind the last.
fn turned(times: &[f64]) -> Vec<f64> {
    let mut times = times.to_vec();
    times.rotate_left(1);
    times
}

fn compared(change: impl FnOnce(&mut Results)) -> Comparison {
    let mut b = run();
    change(&mut b);
    compare(&run(), &b, PLAIN).unwrap()
}

/// What a gate says of a run that was changed, against the unchanged one.
fn gate(text: &str, change: impl FnOnce(&mut Results)) -> Result<Outcome> {
    let (a, mut b) = (run(), run());
    change(&mut b);
    let gate: Gate = text.parse().map_err(anyhow::Error::msg)?;
    gate.check(Some(&a), &b, Some(&compare(&a, &b, PLAIN)?))
}

fn fault(text: &str, change: impl FnOnce(&mut Results)) -> String {
    format!("{:#}", gate(text, change).unwrap_err())
}

#[test]
fn a_run_shows_no_difference_to_itself_and_a_slower_stage_is_found() {
    let same = compared(|_| ());
    assert!(same.pairs && same.differences.is_empty());
    for pair in &same.methods {
        let ratio = pair.frame.ratio.unwrap();
        assert_eq!((ratio.ratio, ratio.low, ratio.high), (1.0, 1.0, 1.0));
        assert!(pair.fields.values().all(|change| change.delta.is_none_or(|delta| delta == 0.0)), "{pair:?}");
    }
    let slower = compared(|b| {
        let times = woc(b).frames.stages.get_mut("warp/search").unwrap();
        times.iter_mut().flatten().for_each(|ms| *ms *= 2.0);
    });
    let verdicts = slower.methods[1].stages.iter().map(|stage| (stage.name.as_str(), stage.times.ratio));
    let verdicts: BTreeMap<_, _> = verdicts.map(|(name, ratio)| (name, ratio.map(|ratio| ratio.verdict))).collect();
    assert_eq!(verdicts["warp/search"], Some(Verdict::Slower));
    assert_eq!(verdicts["draw/all"], Some(Verdict::NoDifferenceShown));
    // It ran in neither.
    assert_eq!(verdicts["warp/draw_rapid"], None);
    assert_eq!(slower.methods[1].frame.ratio.unwrap().verdict, Verdict::NoDifferenceShown);
}

/// A busy machine slows all methods, a change of one method only that one.
#[test]
fn by_a_method_that_did_not_change_the_load_of_a_run_falls_out() {
    let (a, mut b) = (run(), run());
    // The machine was half as fast, and the method a quarter slower.
    for (method, times) in b.methods.iter_mut().zip([2.0, 2.5, 2.0]) {
        method.frames.frame_ms.iter_mut().for_each(|ms| *ms *= times);
        method.frames.stages.values_mut().flatten().flatten().for_each(|ms| *ms *= times);
    }
    let by_ref = compare(&a, &b, CompareOptions { by: Some("ref"), ..PLAIN }).unwrap();
    let found: Vec<_> = by_ref.methods.iter().map(|pair| pair.frame.ratio.unwrap()).collect();
    let rounded: Vec<_> = found.iter().map(|ratio| (1e6 * ratio.ratio).round() / 1e6).collect();
    assert_eq!(rounded, [1.0, 1.25, 1.0]);
    let verdicts: Vec<_> = found.iter().map(|ratio| ratio.verdict).collect();
    assert_eq!(verdicts, [Verdict::NoDifferenceShown, Verdict::Slower, Verdict::NoDifferenceShown]);
    let stage = &by_ref.methods[1].stages[0];
    assert!((stage.times.ratio.unwrap().ratio - 1.25).abs() < 1e-6, "{stage:?}");
    let text = text(&by_ref, &b);
    assert!(text.contains("A by") && text.contains("as multiples of ref in the same run"), "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= 120) && !text.contains("every method is"), "{text}");
    let plain = compare(&a, &b, PLAIN).unwrap();
    assert!(plain.methods.iter().all(|pair| pair.frame.ratio.unwrap().verdict == Verdict::Slower));
    assert!(plain.methods.iter().all(|pair| pair.frame.a_by.is_none()));
    let error = compare(&a, &b, CompareOptions { by: Some("hzb"), ..PLAIN }).unwrap_err().to_string();
    assert!(error.contains("--by hzb: A has no method of that label; it has none, woc"), "{error}");
}

#[test]
fn where_all_methods_are_slower_the_machine_is_named() {
    let slow = |b: &mut Results, methods: usize| {
        b.methods[..methods].iter_mut().flat_map(|method| &mut method.frames.frame_ms).for_each(|ms| *ms *= 2.0);
    };
    let warns = |methods: usize| text(&compared(|b| slow(b, methods)), &run()).contains("every method is slower");
    assert_eq!([0, 1, 2, 3].map(warns), [false, false, false, true]);
    // One method alone is every method, but says nothing of the machine.
    let (a, mut b) = (run(), run());
    slow(&mut b, 1);
    b.methods.truncate(1);
    assert!(!text(&compare(&a, &b, PLAIN).unwrap(), &b).contains("every method"));
}

#[test]
fn a_stage_counts_only_the_frames_in_which_it_ran() {
    // Half of its frames are skipped: as zeros they would make its median one of nothing and something.
    let of = |comparison: &Comparison| {
        let stages = &comparison.methods[1].stages;
        stages.iter().find(|stage| stage.name == "warp/search").unwrap().times
    };
    let ran: Vec<f64> = run().methods[1].frames.stages["warp/search"].iter().flatten().copied().collect();
    assert_eq!(of(&compared(|_| ())).a_ms, stats::median(&ran));
    // It ran in as many, but other, frames of B: they are no pairs.
    let shifted = compared(|b| woc(b).frames.stages.get_mut("warp/search").unwrap().rotate_left(1));
    let [pairs, apart] = [true, false].map(|pairs| ratio(&ran, &ran, pairs, PLAIN.bootstrap));
    assert_eq!((of(&compared(|_| ())).ratio, of(&shifted).ratio.is_some()), (pairs, true));
    // Turned by one frame, the times that are there keep their order.
    assert!(of(&shifted).ratio != pairs && of(&shifted).ratio == ratio(&ran, &turned(&ran), false, PLAIN.bootstrap));
    assert_ne!(pairs, apart);
}

#[test]
fn what_only_one_run_has_is_listed() {
    let other = compared(|b| {
        b.methods[0].label = "hzb".into();
        let new = Stage { name: "warp/fill".into(), ..Stage::default() };
        woc(b).stages.retain(|stage| stage.name != "draw/all");
        woc(b).frames.stages.remove("draw/all");
        woc(b).stages.push(new);
        woc(b).frames.stages.insert("warp/fill".into(), vec![Some(1.0); 20]);
        woc(b).options.insert("search.seeds".into(), 9.into());
    });
    assert_eq!((other.only_in_a.clone(), other.only_in_b.clone()), (vec!["none".to_owned()], vec!["hzb".to_owned()]));
    let pair = &other.methods[0];
    assert_eq!(pair.other_options, ["search.seeds 8 in A, 9 in B"]);
    let sides = |name: &str| {
        let times = pair.stages.iter().find(|stage| stage.name == name).unwrap().times;
        (times.a_ms.is_some(), times.b_ms.is_some(), times.ratio.is_some())
    };
    assert_eq!((sides("draw/all"), sides("warp/fill")), ((true, false, false), (false, true, false)));
    let shown = text(&other, &run());
    for line in ["only in A: none", "only in B: hzb", "ran only in A", "ran only in B", "search.seeds 8 in A, 9 in B"] {
        assert!(shown.contains(line), "{line}\n{shown}");
    }
    let (a, mut b) = (run(), run());
    b.methods.iter_mut().for_each(|method| method.label += "x");
    let error = compare(&a, &b, PLAIN).unwrap_err().to_string();
    assert!(error.contains("A has none, woc[search.seeds=8], ref, B has nonex"), "{error}");
}

#[test]
fn runs_that_differ_are_refused_by_name() {
    type Change = fn(&mut Results);
    let changes: [(&str, bool, Change); 17] = [
        ("scene: city in A, rooms in B", true, |b| b.scene.name = "rooms".into()),
        ("objects: 94000 in A, 1 in B", true, |b| b.scene.objects = 1),
        ("triangles: 18800000 in A, 1 in B", true, |b| b.scene.triangles = 1),
        ("contents of the scene: aa in A, bb in B", true, |b| b.scene.hash = "bb".into()),
        ("path: walk in A, pan in B", true, |b| b.path = "pan".into()),
        ("speed: 4 in A, 2 in B", true, |b| b.speed = 2.0),
        ("seed: 7 in A, 8 in B", true, |b| b.seed = 8),
        ("frames: 20 in A, 21 in B", true, |b| b.frames = 21),
        ("size: 1280x720 in A, 720x1280 in B", false, |b| b.size = [720, 1280]),
        ("device: llvmpipe in A, other in B", false, |b| b.device.name = "other".into()),
        ("type of device: cpu in A, discrete in B", false, |b| b.device.kind = "discrete".into()),
        ("driver: Mesa 22.3.6 in A, Mesa 25 in B", false, |b| b.device.driver = "Mesa 25".into()),
        ("depth format: D32_SFLOAT (reversed) in A, D16_UNORM in B", true, |b| {
            b.device.depth_format = "D16_UNORM".into()
        }),
        ("samples a pixel: 1 in A, 4 in B", false, |b| _ = b.device.details.insert("samples".into(), "4".into())),
        ("features that are missing: nothing in A, tiling in B", false, |b| {
            _ = b.device.details.insert("lacks".into(), "tiling".into())
        }),
        ("bounds of what moves: union in A, in-place in B", false, |b| b.scene.moving_bounds = "in-place".into()),
        ("shading: lambert in A, textured in B", true, |b| b.scene.shading = "textured".into()),
    ];
    for (named, other_frames, change) in changes {
        let (mut a, mut b) = (run(), run());
        for run in [&mut a, &mut b] {
            run.scene.hash = "aa".into();
            (run.scene.moving_bounds, run.scene.shading) = ("union".into(), "lambert".into());
            _ = run.device.details.insert("lacks".into(), "nothing".into());
        }
        assert_eq!(differences(&a, &b), []);
        change(&mut b);
        let refusal = compare(&a, &b, PLAIN).unwrap_err().to_string();
        assert!(refusal.contains(named) && refusal.contains("--force"), "{refusal}");
        let forced = compare(&a, &b, CompareOptions { force: true, ..PLAIN }).unwrap();
        assert_eq!(forced.pairs, !other_frames, "{named}");
        assert!(text(&forced, &b).contains(named), "{named}");
    }
    // The timer was chosen by a measurement at each start, so two runs of one command could differ in it.
    let mut timed = run();
    timed.device.timer_mode = "submits".into();
    let both = compare(&run(), &timed, PLAIN).unwrap();
    assert!(both.differences.is_empty() && both.pairs);
    assert!(text(&both, &timed).contains("timers: timestamps in A, submits in B"));
    // A file of before there were hashes says nothing of them.
    let mut old = run();
    old.scene.hash.clear();
    assert!(!run().scene.hash.is_empty());
    assert_eq!(differences(&run(), &old), []);
}

#[test]
fn gates_fire_on_their_fault_and_on_nothing_else() {
    type Change = fn(&mut Results);
    let slower: Change = |b| woc(b).frames.frame_ms.iter_mut().for_each(|ms| *ms *= 1.5);
    let gates: [(&str, Change); 13] = [
        ("woc.false_negatives>3", |b| woc(b).false_negatives = 4),
        ("woc[search.seeds=8].false_negatives != 3", |b| woc(b).false_negatives = 4),
        ("any.psnr_worst_db<48", |b| b.methods[0].psnr_worst_db = Some(47.5)),
        ("none.psnr_worst_db<inf", |b| b.methods[0].psnr_worst_db = Some(99.0)),
        ("none.psnr_worst_db_delta<0", |b| b.methods[0].psnr_worst_db = Some(99.0)),
        ("any.drawn_mean_delta>=0.5", |b| woc(b).drawn_mean += 0.5),
        ("any.frame_ms.median<=5", |b| woc(b).frame_ms.median = 5.0),
        ("woc.stages.warp/search.median_ms == 2", |b| woc(b).stages[0].median_ms = 2.0),
        ("woc.ratio>1.1", slower),
        ("woc.ratio_low>1.1", slower),
        ("woc.ratio_high>1.1", slower),
        ("any.ratio != 1", slower),
        ("any.ratio>1.49", slower),
    ];
    for (text, change) in gates {
        let before = gate(text, |_| ()).unwrap();
        assert!(!before.failed && before.fails.is_empty() && !before.passes.is_empty(), "{before:?}");
        let after = gate(text, change).unwrap();
        assert!(after.failed && after.fails.len() == 1 && gates_text(&[after]).contains("FAILED"), "{text}");
    }
    let failed = gate("any.ratio>1.1", slower).unwrap();
    let figures = failed.fails.iter().map(|found| (found.label.as_str(), found.figure)).collect::<Vec<_>>();
    assert_eq!(figures, [("woc[search.seeds=8]", 1.5)]);
    assert_eq!(failed.passes.len(), 2);
}

#[test]
fn an_id_means_all_its_labels_and_a_label_only_itself() {
    let two = |b: &mut Results| {
        let mut plain = woc(b).clone();
        plain.label = "woc".into();
        plain.false_negatives = 9;
        b.methods.push(plain);
    };
    let of = |text: &str| gate(text, two).unwrap();
    let labels = |found: &[Figure]| found.iter().map(|found| found.label.clone()).collect::<Vec<_>>();
    assert_eq!(labels(&of("woc.false_negatives>0").fails), ["woc[search.seeds=8]", "woc"]);
    assert_eq!(labels(&of("woc[search.seeds=8].false_negatives>0").fails), ["woc[search.seeds=8]"]);
    // The new label has no ratio: it is passed over, and said to be.
    let ratio = of("woc.ratio>1.1");
    assert_eq!(
        (labels(&ratio.passes), ratio.without),
        (vec!["woc[search.seeds=8]".to_owned()], vec!["woc".to_owned()])
    );
}

/// A new measure, too, must not read as measured where its frames are missing.
#[test]
fn of_a_run_of_times_only_times_are_measured() {
    let frames = crate::results::Frames { frame_ms: vec![1.0; 20], ..Default::default() };
    let found = fields::fields(&Method { frames, ..Method::default() }).unwrap();
    let measured: Vec<&str> = found.iter().filter(|(_, v)| v.is_some()).map(|(name, _)| name.as_str()).collect();
    assert_eq!(measured, ["device_memory_mib", "frame_ms.mean", "frame_ms.median", "frame_ms.p95"]);
}

/// What was not measured reads 0 or `null` in the file: a gate on it must not pass.
#[test]
fn a_gate_on_nothing_is_an_error() {
    let no_metrics = |b: &mut Results| {
        for method in &mut b.methods {
            let frame_ms = method.frames.frame_ms.clone();
            method.frames = crate::results::Frames { frame_ms, ..Default::default() };
            (method.false_negatives, method.psnr_worst_db, method.overdraw_mean) = (0, None, None);
        }
    };
    let unmeasured = [
        "false_negatives>0",
        "false_negative_frames>0",
        "object_error_percent>0",
        "psnr_worst_db<49",
        "culled_over_ref<0.9",
        "drawn_mean>9e9",
        "ssim_mean<0.9",
        "triangles_mean>9e9",
        "overdraw_mean>9",
        "drawn_mean_delta>1",
    ];
    for field in unmeasured {
        let error = fault(&format!("any.{field}"), no_metrics);
        assert!(error.contains("no figure") && error.contains("none, woc[search.seeds=8], ref"), "{error}");
    }
    assert!(gate("any.ratio>1.1", no_metrics).is_ok());
    let only_b = |b: &mut Results| woc(b).label = "woc".into();
    assert!(fault("woc.ratio>1.1", only_b).contains("none of woc is in both files"));
    let unmeasured = compared(no_metrics);
    assert_eq!(unmeasured.methods[1].fields["false_negatives"], Change { a: Some(3.0), b: None, delta: None });
    assert!(text(&unmeasured, &run()).contains("3 → -"));
}

#[test]
fn faulty_gates_say_what_there_is() {
    for text in
        ["woc", "woc.ratio", "woc>1", ".ratio>1", "woc.>1", "woc.ratio=1", "woc.ratio>", "woc[a=1].ratio", "a.b!3"]
    {
        assert!(text.parse::<Gate>().unwrap_err().contains("write METHOD.FIELD OP NUMBER"), "{text}");
    }
    assert!("woc.ratio>much".parse::<Gate>().unwrap_err().contains("'much' is no number"));
    assert!("woc.ratio>nan".parse::<Gate>().is_err());
    let label = fault("eovc.ratio>1", |_| ());
    assert!(label.contains("no method 'eovc'; it has none, woc[search.seeds=8], ref"), "{label}");
    let field = fault("woc.speed>1", |_| ());
    let listed = ["'speed'", "false_negatives", "frame_ms.median", "stages.NAME.share", "_delta", "ratio_low"];
    assert!(listed.iter().all(|name| field.contains(name)), "{field}");
    // Settings, frames and texts are no measures.
    for field in ["options.search.seeds", "frames.drawn", "label", "stages.warp/search.reason"] {
        assert!(fault(&format!("woc.{field}>1"), |_| ()).contains("there is no field"), "{field}");
    }
    for field in ["ratio", "ratio_high", "drawn_mean_delta"] {
        let gate: Gate = format!("woc.{field}>1").parse().unwrap();
        let error = gate.check(None, &run(), None).unwrap_err().to_string();
        assert!(error.contains("needs two files"), "{error}");
    }
}

#[test]
fn tables_fit_and_never_hide_a_change() {
    let comparison = compared(|b| {
        woc(b).label += "-and-a-label-that-is-longer-than-all-the-columns-of-the-table-leave-room-for-in-a-line";
        b.methods[0].drawn_mean += 0.001;
        b.methods[2].psnr_worst_db = Some(41.0);
        b.methods[2].false_negatives = 2;
    });
    let shown = text(&comparison, &run());
    assert!(shown.lines().all(|line| line.chars().count() <= 120), "{shown}");
    for change in ["0 → 2", "identical → 41.0", "94.0k (+1e-3)"] {
        assert!(shown.contains(change), "{change}\n{shown}");
    }
    let few = |frames: u32| {
        let mut b = run();
        b.frames = frames;
        text(&comparison, &b).contains("too few")
    };
    assert!(few(FEWEST_FRAMES as u32 - 1) && !few(FEWEST_FRAMES as u32));
}
