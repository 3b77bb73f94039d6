//! Tables are whole and name what there is; text from made-up results says what it should.

mod papers;
mod runs;

use super::*;
use crate::results::{Device, FrameMs, Frames, Method, Scene, SCHEMA};

#[test]
fn every_table_is_whole() {
    for table in TABLES {
        let numbers = table.variants.len() * table.numbers_in_row();
        let scenes: Vec<&str> = table.published.iter().map(|row| row.scene).collect();
        let of_paper = table.paper().map_or(&[][..], |paper| paper.scenes).iter().map(|scene| scene.name);
        assert_eq!(scenes, of_paper.filter(|name| scenes.contains(name)).collect::<Vec<_>>(), "{}", table.id);
        let has_figures = !matches!(table.source, Source::Ours { .. } | Source::Said(..));
        assert!(!scenes.is_empty() || !has_figures, "{}: what a paper has is published", table.id);
        assert!(scenes.is_empty() || table.paper().is_some(), "{}: published by nobody", table.id);
        let known = |name: &&&str| scenes::procedural::SCENES.iter().any(|scene| scene.name == **name);
        assert_eq!(table.scenes().iter().find(|name| !known(name)), None, "{}: a scene that is not there", table.id);
        assert!(!table.scenes().is_empty(), "{}", table.id);
        for row in table.published {
            assert_eq!(row.figures.len(), numbers, "{} {}", table.id, row.scene);
            assert!(row.figures.iter().all(|figure| *figure >= 0.0), "{} {}", table.id, row.scene);
        }
        if let Ratio::Over(head) | Ratio::SpeedUp(head) = table.ratio {
            assert_eq!(table.columns.iter().filter(|column| column.head == head).count(), 1, "{}: {head}", table.id);
        }
        for column in table.columns {
            let known = culling::find(column.method).is_ok() || column.method == "warp";
            assert!(known, "{}: {} is no method", table.id, column.method);
        }
        assert_eq!(find(table.id).unwrap().id, table.id);
        // What the table sets, its methods have.
        let plan = table.plan(&[]).unwrap();
        assert_eq!(plan.places.len(), table.variants.len() * table.columns.len());
        assert!(plan.runs.iter().all(|run| !run.methods.is_empty() || !run.warps.is_empty()));
    }
    assert!(find("eovc-1").unwrap_err().to_string().contains("there are: eovc-2, eovc-3"));
}

#[test]
fn no_id_is_there_twice() {
    let ids: std::collections::BTreeSet<_> = TABLES.iter().map(|table| table.id).collect();
    assert_eq!(ids.len(), TABLES.len());
}

#[test]
fn methods_that_are_not_there_leave_their_place_empty() {
    const COLUMNS: &[Column] = &[plain("GAP", "no-such-method"), plain("NOC", "none")];
    let table = Table { columns: COLUMNS, variants: ONE_ROW, published: &[], ..small() };
    let plan = table.plan(&[]).unwrap();
    assert_eq!(labels(&plan), [None, Some("none")]);
    assert_eq!(plan.runs[0].methods.len(), 1);
    let text = text(&table, &plan, &[vec![run("city-block", 90_000, &[("none", 8.0)])]]);
    assert!(text.contains("does not have yet: no-such-method"), "{text}");
}

#[test]
fn a_setting_that_a_method_lacks_is_named_with_the_table() {
    const LACKING: &[Column] = &[plain("X", "none").with(&[("warp", "true")])];
    let error = format!("{:#}", Table { columns: LACKING, ..small() }.plan(&[]).unwrap_err());
    assert!(error.contains("table small cannot be run: its column X needs warp=true"), "{error}");
    assert!(error.contains("method 'none' has no option 'warp'"), "{error}");
}

#[test]
fn users_set_what_the_table_leaves_open_and_nothing_else() {
    let set = |text: &str| [text.to_owned()];
    let split = small().plan(&set("eovc.commands=zero-instance")).unwrap();
    assert_eq!(labels(&split)[0], Some("eovc[commands=zero-instance]"));
    assert_eq!(labels(&split)[3], Some("eovc[commands=zero-instance,bvh=equal,coherent=false]"));
    let error = small().plan(&set("eovc.bvh=sah")).unwrap_err().to_string();
    assert!(error.contains("table small sets eovc.bvh itself"), "{error}");
    assert!(small().plan(&set("eovc.nothing=1")).is_err());
    assert!(small().plan(&set("nothing.bvh=sah")).is_err());
    // A method outside the table may be set, and nothing comes of it.
    assert_eq!(small().plan(&set("hzb.texels=8")).unwrap().places, small().plan(&[]).unwrap().places);
}

#[test]
fn what_the_notes_say_of_eovc_is_so() {
    let options = culling::find("eovc").unwrap().default_options();
    assert!(options.flag("coherent"), "the note on coherent groups is out of date");
}

#[test]
fn our_rows_stand_above_the_papers() {
    let plan = small().plan(&[]).unwrap();
    let numbers = [("eovc", 8.0), ("eovc[coherent=false]", 4.0), ("eovc[bvh=equal]", 16.0)];
    let last = ("eovc[bvh=equal,coherent=false]", 2.0);
    let runs = [
        vec![run("city-block", 90_000, &numbers)],
        vec![run("second", 100, &[numbers[0], numbers[1], numbers[2], last])],
    ];
    let expected = "\
A paper, table 7: a small table
ours on llvmpipe (cpu) · Mesa
city-block: path closing-in speed=1.0 whole · 30 frames of 64x36
second: path closing-in speed=1.0 whole · 30 frames of 64x36

scene                  objects      A      B
city-block SAH           90000  8.000  4.000
city-block EQ            90000  16.00      -
  over SAH                       2.00      -
paper L (nearest) SAH   100000    3.0    4.0
paper L (nearest) EQ    100000    6.0    2.0
  over SAH                       2.00   0.50
second SAH                 100  8.000  4.000
second EQ                  100  16.00  2.000
  over SAH                       2.00   0.50
paper S (same) SAH          10    1.0    2.0
paper S (same) EQ           10    0.5    1.0
  over SAH                       0.50   0.50

A paper: measured on a machine.
Compare ratios, not milliseconds. (same): our scene is built after the paper's; (nearest): another scene, whose
number of objects is the nearest; the rest have no scene of ours in this run.
Ours ran on a cpu device: its times show that the methods run, and are no results.
A note.
The whole way in 30 frames is 20 times the 10 s of the paper (at 60 Hz): that costs what relies on
the last frame. --frames 600 is its speed.
";
    assert_eq!(text(&small(), &plan, &runs), expected);
}

#[test]
fn shares_are_cut_and_speed_ups_are_turned_around() {
    const SHARES: &[Measure] = &[Measure::CulledOverTotal, Measure::CulledOverRef];
    const SHARED: &[Column] = &[Column::new("A", "none", SHARES, 2), Column::new("B", "frustum", SHARES, 2)];
    const FIGURES: &[Published] = &[Published { scene: "S", figures: &[0.5, 0.75, 0.9, 1.0] }];
    let mut ran = run("second", 100, &[("none", 8.0), ("frustum", 2.0)]);
    ran.results.methods[1].culled_over_ref = 0.99999;
    let runs = [vec![ran]];
    let shares = Table { columns: SHARED, variants: ONE_ROW, ratio: Ratio::None, published: FIGURES, ..small() };
    let plan = shares.plan(&[]).unwrap();
    assert!(shares.needs_truth());
    let found = text(&shares, &plan, &runs);
    assert!(found.contains("0.000 0.000  0.000 0.999") && found.contains("0.50 0.75    0.90 1.00"), "{found}");
    assert!(!found.contains("over"), "{found}");
    const TIMED: &[Column] = &[plain("A", "none"), plain("B", "frustum")];
    let times = Table { columns: TIMED, ratio: Ratio::SpeedUp("A"), published: &[], ..shares };
    assert!(!times.needs_truth());
    let found = text(&times, &plan, &runs);
    assert!(found.contains("speed-up over A") && found.contains("1.00   4.00"), "{found}");
}

#[test]
fn no_line_is_wider_than_the_terminal() {
    for table in TABLES {
        let plan = table.plan(&[]).unwrap();
        let scene = |name: &str, objects: u64| {
            let run = |planned: &PlannedRun| {
                let methods: Vec<_> = planned.methods.iter().map(|(_, options)| (options.label(), 123_456.0)).collect();
                let methods: Vec<_> = methods.iter().map(|(label, ms)| (label.as_str(), *ms)).collect();
                let mut ran = run(name, objects, &methods);
                let warps = planned.warps.iter().map(|options| (options.label(), vec![errors(0.5, 17.0)]));
                ran.warps = warps.collect();
                ran.results.methods.iter_mut().for_each(|method| method.culled_over_ref = 1.0);
                ran
            };
            plan.runs.iter().map(run).collect::<Vec<_>>()
        };
        let text = text(table, &plan, &[scene("city-block", 94_000), scene("fantasy", 7_437)]);
        for line in text.lines() {
            assert!(line.chars().count() <= 120, "{line}");
        }
        assert!(text.contains("city-block"), "{text}");
    }
}

fn labels(plan: &Plan) -> Vec<Option<&str>> {
    plan.places.iter().map(|place| place.as_ref().map(|place| place.label.as_str())).collect()
}

/// A warp's errors in one frame.
fn errors(ssim: f64, psnr_db: f64) -> DepthErrors {
    DepthErrors {
        psnr_db: Some(psnr_db),
        ssim,
        nearer_psnr_db: None,
        farther_psnr_db: None,
        nearer_percent: 0.0,
        farther_percent: 0.0,
        hole_percent: 0.0,
    }
}

const fn plain(head: &'static str, method: &'static str) -> Column {
    Column::new(head, method, &[Measure::FrameMs], 1)
}

/// Two variants of two columns, of methods and options that are there.
fn small() -> Table {
    static PAPER: Paper = Paper {
        name: "A paper",
        measured_on: "a machine",
        seconds: 10.0,
        path: ("closing-in", true),
        scenes: &[
            PaperScene { name: "S", ours: "second", objects: Some(10) },
            PaperScene { name: "L", ours: "large", objects: Some(100_000) },
        ],
    };
    const COLUMNS: &[Column] = &[plain("A", "eovc"), plain("B", "eovc").with(&[("coherent", "false")])];
    const SPLITS: &[Variant] = &[Variant::set("SAH", &[("bvh", "sah")]), Variant::set("EQ", &[("bvh", "equal")])];
    Table {
        id: "small",
        title: "a small table",
        source: Source::Paper(&PAPER, 7),
        columns: COLUMNS,
        variants: SPLITS,
        ratio: Ratio::OverFirstVariant,
        published: &[
            Published { scene: "S", figures: &[1.0, 2.0, 0.5, 1.0] },
            Published { scene: "L", figures: &[3.0, 4.0, 6.0, 2.0] },
        ],
        notes: &["A note."],
        goals: None,
    }
}

/// Made-up results: labels with mean milliseconds.
fn run(scene: &str, objects: u64, methods: &[(&str, f64)]) -> Ran {
    let method = |(label, ms): &(&str, f64)| Method {
        label: (*label).to_owned(),
        frame_ms: FrameMs { mean: *ms, ..FrameMs::default() },
        frames: Frames::default(),
        ..Method::default()
    };
    let results = Results {
        schema: SCHEMA,
        sightline_version: String::new(),
        command: String::new(),
        device: Device { name: "llvmpipe".into(), kind: "cpu".into(), driver: "Mesa".into(), ..Device::default() },
        scene: Scene { name: scene.into(), objects, triangles: 1, ..Scene::default() },
        path: "closing-in speed=1.0 whole".into(),
        speed: 1.0,
        seed: 1,
        size: [64, 36],
        frames: 30,
        methods: methods.iter().map(method).collect(),
    };
    Ran { results, warps: BTreeMap::new(), hidden: None }
}
