//! The contract is kept both ways, broken files are named with their field, and the tables say what they should.

pub(crate) mod fields;
mod tables;

use super::*;
use crate::results::files::tests::Folder;
use std::fs;

fn method(label: &str, id: &str, median: f64) -> Method {
    Method {
        label: label.into(),
        method: id.into(),
        guarantee: "exact".into(),
        frame_ms: FrameMs { median, p95: median * 1.25, mean: median },
        stages: vec![Stage { name: "draw/all".into(), median_ms: median, share: 1.0, ..Stage::default() }],
        ssim_mean: 1.0,
        drawn_mean: 94_000.0,
        triangles_mean: 18.8e6,
        overdraw_mean: Some(3.456),
        frames: Frames {
            frame_ms: vec![median; 2],
            drawn: vec![94_000; 2],
            psnr_db: vec![None; 2],
            ..Frames::default()
        },
        ..Method::default()
    }
}

/// A run made up: an exact method, one that errs and skips, and the ideal.
pub(crate) fn results() -> Results {
    let mut warped = method("woc[search.seeds=8]", "woc", 12.5);
    warped.guarantee = "approximate: holes are filled from neighbours".into();
    warped.options.insert("search.seeds".into(), 8.into());
    warped.options.insert("bound".into(), "local".into());
    warped.false_negatives = 3;
    warped.differing_pixels_mean = 0.004;
    (warped.psnr_mean_db, warped.psnr_worst_db) = (Some(51.25), Some(48.0625));
    warped.frames.psnr_db = vec![None, Some(48.0625)];
    warped.frames.stages =
        [("warp/search".to_owned(), vec![None, Some(0.5)]), ("draw/all".to_owned(), vec![Some(12.0), Some(11.5)])]
            .into();
    warped.culled_over_ref = 0.9996;
    warped.drawn_mean = 1234.4;
    warped.overdraw_mean = None;
    warped.stages = vec![
        Stage {
            name: "warp/search".into(),
            median_ms: 0.5,
            share: 0.04,
            skipped: 1,
            reason: Some("camera and objects unchanged".into()),
            saved_ms: Some(0.25),
        },
        Stage {
            name: "warp/draw_rapid".into(),
            skipped: 2,
            reason: Some("no rapid objects".into()),
            ..Stage::default()
        },
        Stage { name: "draw/all".into(), median_ms: 12.0, share: 0.96, saved_ms: Some(0.0), ..Stage::default() },
    ];
    Results {
        schema: SCHEMA,
        sightline_version: "0.1.0".into(),
        command: "sightline bench --scene city".into(),
        device: Device {
            name: "llvmpipe".into(),
            kind: "cpu".into(),
            driver: "Mesa 22.3.6".into(),
            api_version: "1.3.230".into(),
            timer_mode: "timestamps".into(),
            depth_format: "D32_SFLOAT (reversed)".into(),
            details: BTreeMap::new(),
        },
        scene: Scene {
            name: "city".into(),
            objects: 94_000,
            triangles: 18_800_000,
            hash: "0f".into(),
            ..Scene::default()
        },
        path: "walk".into(),
        speed: 4.0,
        seed: 7,
        size: [1280, 720],
        frames: 2,
        methods: vec![method("none", "none", 1000.0), warped, method("ref", "ref", 10.0)],
    }
}

/// Writes, spoils the text, reads: the error's one line.
fn error_after(test: &str, from: &str, to: &str) -> String {
    let folder = Folder::new(test);
    let path = folder.0.join("results.json");
    results().write_json(&path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "nothing to spoil: {from}");
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
    let error = Results::read_json(&path).unwrap_err().to_string();
    assert!(error.contains("results.json: "), "{error}");
    assert!(!error.contains('\n'), "{error}");
    error
}

#[test]
fn what_is_written_is_read_back() {
    let folder = Folder::new("results-roundtrip");
    let path = folder.0.join("results.json");
    results().write_json(&path).unwrap();
    assert_eq!(Results::read_json(&path).unwrap(), results());
    assert_eq!(folder.names(), ["results.json"]);
    assert!(results().method("ref").is_some() && results().method("woc").is_none());
}

#[test]
fn fields_have_the_names_of_the_contract() {
    let json = serde_json::to_value(results()).unwrap();
    for field in "schema device scene size frames methods command path speed seed sightline_version".split(' ') {
        assert!(json.get(field).is_some(), "{field}");
    }
    let method = &json["methods"][1];
    let fields = "label method options guarantee frame_ms stages false_negatives false_negative_frames \
        object_error_percent differing_pixels_mean psnr_mean_db psnr_worst_db ssim_mean drawn_mean culled_over_total \
        culled_over_ref triangles_mean draws_mean overdraw_mean queries_mean rays_mean device_memory_mib frames \
        state_changes_mean waits_mean plane_tests_mean";
    for field in fields.split_whitespace() {
        assert!(method.get(field).is_some(), "{field}");
    }
    assert_eq!(json["size"], serde_json::json!([1280, 720]));
    assert_eq!(json["device"]["type"], "cpu");
    assert!(json["methods"][0]["psnr_worst_db"].is_null());
    assert_eq!(method["options"]["search.seeds"], 8);
}

#[test]
fn an_unknown_field_is_ignored() {
    let folder = Folder::new("results-unknown");
    let path = folder.0.join("results.json");
    results().write_json(&path).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replacen('{', "{\"later\": [1, {\"x\": 2}],", 1)).unwrap();
    assert_eq!(Results::read_json(&path).unwrap(), results());
}

#[test]
fn a_broken_field_is_named() {
    let error = error_after("results-type", "\"median\": 12.5", "\"median\": \"fast\"");
    assert!(error.contains(": methods[1].frame_ms.median: invalid type"), "{error}");
    let error = error_after("results-missing", "      \"rays_mean\": 0.0,\n", "");
    assert!(error.contains(": methods[0]: missing field `rays_mean`"), "{error}");
    let error = error_after("results-top", "\"seed\": 7", "\"seed\": -7");
    assert!(error.contains(": seed: invalid value"), "{error}");
    let error = error_after("results-schema", "\"schema\": 1", "\"schema\": 2");
    assert!(error.contains(": schema: is 2, but this program reads 1"), "{error}");
    let error = error_after("results-syntax", "\"label\": \"ref\",", "\"label\": \"ref\" oops");
    assert!(error.contains(": methods[2].label: "), "{error}");
    let error = error_after("results-label", "\"label\": \"ref\"", "\"label\": \"none\"");
    assert!(error.contains(": methods[2].label: `none` is there twice"), "{error}");
    let error = error_after("results-cut", "\"path\": \"walk\",", "}");
    assert!(error.contains("results.json: "), "{error}");
}

#[test]
fn every_cut_of_a_file_is_an_error_and_no_panic() {
    let text = serde_json::to_string(&results()).unwrap();
    for end in (0..text.len()).filter(|&end| text.is_char_boundary(end)) {
        assert!(read::parse(&text[..end]).is_err());
    }
}

#[test]
fn what_breaks_the_contract_is_not_written() {
    let folder = Folder::new("results-refused");
    let path = folder.0.join("results.json");
    let refused = |change: fn(&mut Results)| {
        let mut results = results();
        change(&mut results);
        let error = results.write_json(&path).unwrap_err().to_string();
        assert!(results.write_csv(&path).is_err());
        error
    };
    let twice = refused(|r| r.methods[2].label = "none".into());
    assert!(twice.contains("methods[2].label: `none` is there twice"), "{twice}");
    let nan = refused(|r| r.methods[1].psnr_worst_db = Some(f64::NAN));
    assert!(nan.contains("methods[1].psnr_worst_db: is not a finite number"), "{nan}");
    let nan = refused(|r| _ = r.methods[1].psnr_between_db.insert("none".into(), Some(f64::NAN)));
    assert!(nan.contains("methods[1].psnr_between_db.none: is not a finite number"), "{nan}");
    let nan = refused(|r| r.methods[1].frames.psnr_db[1] = Some(f64::INFINITY));
    assert!(nan.contains("methods[1].frames.psnr_db[1]"), "{nan}");
    let nan = refused(|r| r.methods[1].stages[2].share = f64::NAN);
    assert!(nan.contains("methods[1].stages[2].share"), "{nan}");
    let short = refused(|r| r.methods[0].frames.drawn = vec![1]);
    assert!(short.contains("methods[0].frames.drawn: has 1 entries for 2 frames"), "{short}");
    let short = refused(|r| r.methods[0].frames.boxes = vec![1; 3]);
    assert!(short.contains("methods[0].frames.boxes: has 3 entries for 2 frames"), "{short}");
    let short = refused(|r| _ = r.methods[1].frames.stages.insert("draw/all".into(), vec![None]));
    assert!(short.contains("methods[1].frames.stages.draw/all: has 1 entries for 2 frames"), "{short}");
    let nan = refused(|r| _ = r.methods[1].frames.stages.insert("draw/all".into(), vec![None, Some(f64::NAN)]));
    assert!(nan.contains("methods[1].frames.stages.draw/all[1]: is not a finite number"), "{nan}");
    assert!(folder.names().is_empty());
}

#[test]
fn the_csv_has_a_row_per_method_and_a_column_per_stage() {
    let folder = Folder::new("results-csv");
    let path = folder.0.join("results.csv");
    results().write_csv(&path).unwrap();
    let mut csv = csv::Reader::from_path(&path).unwrap();
    let heads = csv.headers().unwrap().clone();
    let column = |name: &str| heads.iter().position(|head| head == name).unwrap();
    let stages: Vec<_> = heads.iter().filter(|head| head.starts_with("stage:")).collect();
    assert_eq!(stages, ["stage:draw/all", "stage:warp/search", "stage:warp/draw_rapid"]);
    let rows: Vec<_> = csv.records().map(|row| row.unwrap()).collect();
    assert_eq!(rows.len(), 3);
    assert_eq!(&rows[1][column("label")], "woc[search.seeds=8]");
    assert_eq!(&rows[1][column("options")], "bound=local;search.seeds=8");
    assert_eq!(&rows[1][column("frame_ms_median")], "12.5");
    assert_eq!(&rows[1][column("stage:warp/search")], "0.5");
    assert_eq!(&rows[0][column("stage:warp/search")], "");
    assert_eq!(&rows[0][column("psnr_worst_db")], "");
    assert_eq!(&rows[2][column("scene")], "city");
}

#[test]
fn the_table_is_aligned_and_says_no_more_than_is_true() {
    let expected = "\
city: 94000 objects, 18.8M triangles · path walk at speed 4 · 2 frames of 1280x720
llvmpipe (cpu) · Mesa 22.3.6 · Vulkan 1.3.230

method               frame  /none    /ref    p95  drawn  C/R %  false neg.  diff px       PSNR  triangles  overdraw
none                  1000   1.00  100.00   1250  94.0k    0.0           0        0  identical      18.8M      3.46
woc[search.seeds=8]  12.50   0.01    1.25  15.62   1234  >99.9           3    <0.01       48.1      18.8M         -
ref                  10.00   0.01    1.00  12.50  94.0k    0.0           0        0  identical      18.8M      3.46

frame: median ms · C/R: culled / culled by ref · diff px: pixels of other depth, mean · PSNR: dB, worst frame
";
    assert_eq!(table(&results()), expected);
}

#[test]
fn what_was_not_measured_is_a_dash_and_an_empty_cell() {
    let mut results = results();
    for method in &mut results.methods {
        method.frames = Frames { frame_ms: method.frames.frame_ms.clone(), ..Frames::default() };
    }
    let text = table(&results);
    let row = text.lines().find(|line| line.starts_with("none")).unwrap();
    assert_eq!(
        row.split_whitespace().collect::<Vec<_>>(),
        ["none", "1000", "1.00", "100.00", "1250", "-", "-", "-", "-", "-", "-", "-"]
    );
    let folder = Folder::new("results-unmeasured");
    let path = folder.0.join("results.csv");
    results.write_csv(&path).unwrap();
    let mut csv = csv::Reader::from_path(&path).unwrap();
    let heads = csv.headers().unwrap().clone();
    let row = csv.records().next().unwrap().unwrap();
    let cell = |name: &str| &row[heads.iter().position(|head| head == name).unwrap()];
    assert_eq!(
        (cell("frame_ms_median"), cell("drawn_mean"), cell("false_negatives"), cell("ssim_mean")),
        ("1000", "", "", "")
    );
}

#[test]
fn ratios_are_left_out_without_their_base() {
    let mut results = results();
    results.methods.retain(|method| method.method == "woc");
    let table = table(&results);
    assert!(!table.contains("/none") && !table.contains("/ref"));
    results.methods.clear();
    assert!(super::table(&results).contains("method"));
}

#[test]
fn no_line_is_wider_than_the_terminal_and_no_label_is_cut() {
    let mut results = results();
    let long = format!("chc++[{}]", "visibility.frames=10,".repeat(12));
    results.methods[1].label = long.clone();
    results.device.driver = "Mesa ".repeat(40);
    for method in &mut results.methods {
        method.frame_ms.median = 123_456_789.0;
        method.false_negatives = 9_999_999_999;
        method.psnr_worst_db = Some(-100.0);
        method.triangles_mean = 9.0e14;
    }
    let text = table(&results) + &stages_table(&results, &results.methods[1]);
    for line in text.lines() {
        assert!(line.chars().count() <= 120, "{line}");
    }
    assert!(table(&results).replace('\n', "").contains(&long));
}

#[test]
fn the_stages_table_gives_every_skip_its_reason() {
    let mut results = results();
    let expected = "\
woc[search.seeds=8]: approximate: holes are filled from neighbours
stage                ran     ms   share  saved  why skipped
warp/search       1 of 2  0.500   4.0 %  0.250  camera and objects unchanged
warp/draw_rapid  skipped      -   0.0 %      -  no rapid objects
draw/all             ran  12.00  96.0 %      -
";
    assert_eq!(stages_table(&results, &results.methods[1]), expected);
    results.methods[1].stages[1].name = "warp/".repeat(10);
    let found = stages_table(&results, &results.methods[1]);
    let reason = found.lines().find(|line| line.ends_with("no rapid objects"));
    assert!(reason.unwrap().contains("skipped"), "{found}");
}

#[test]
fn a_stage_that_did_not_run_is_null_in_that_frame() {
    let json = serde_json::to_value(results()).unwrap();
    let frames = &json["methods"][1]["frames"];
    assert_eq!(frames["stages"]["warp/search"], serde_json::json!([null, 0.5]));
    for field in "boxes node_visits rays".split(' ') {
        assert!(frames[field].is_array(), "{field}");
    }
}

#[test]
fn parts_of_the_frame_and_what_is_between_stages_add_up_to_it() {
    let mut method = method("eovc", "eovc", 10.0);
    let stage = |name: &str| Stage { name: name.into(), ..Stage::default() };
    method.stages = ["draw/clear", "pack/scan:mapping", "draw/flags:mapping", "pack/scan:occludees"].map(stage).into();
    let times = [vec![Some(1.0), Some(1.0)], vec![Some(2.0), None], vec![Some(3.0), Some(1.0)], vec![None, Some(4.0)]];
    method.frames.stages = method.stages.iter().map(|stage| stage.name.clone()).zip(times).collect();
    let expected = "\
part            mean ms  of frame
no part           1.000    10.0 %
mapping           3.000    30.0 %
occludees         2.000    20.0 %
between stages    4.000    40.0 %
";
    assert_eq!(parts_table(&method), expected);
    method.stages.truncate(1);
    assert_eq!(parts_table(&method), "", "a method without parts has no breakdown");
}

#[test]
fn frame_times_of_nothing_are_nothing() {
    assert_eq!(FrameMs::from_samples(&[]), None);
    let one = FrameMs::from_samples(&[2.0]).unwrap();
    assert_eq!((one.median, one.p95, one.mean), (2.0, 2.0, 2.0));
}

#[test]
fn settings_of_a_sweep_are_compared_within_their_cells() {
    let mut results = results();
    assert!(table(&results).contains("1.25"), "12.5 ms of 10 ms");
    results.methods[1].ratio_to_ref = Some(7.75);
    let swept = table(&results);
    assert!(swept.contains("7.75") && !swept.contains("1.25 "), "{swept}");
}
