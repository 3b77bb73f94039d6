//! Every mark of the report is tied to its figure: medians, means and single frames differ, and so do the methods.

use super::*;
use crate::results::tests::fields::distinct;
use crate::results::{FrameMs, Stage};
use serde_json::{json, Value};

/// `none`, a method that errs, and `ref`: medians of 40, 10 and 8 ms, with other means and other single frames.
fn unlike() -> Results {
    let of = |label: &str, id: &str, median: f64, frame_ms: [f64; 3]| {
        let mut method = distinct().methods.remove(0);
        (method.label, method.method, method.ratio_to_ref, method.host_ms) = (label.into(), id.into(), None, None);
        method.frame_ms = FrameMs { median, p95: 1.5 * median, mean: 3.0 * median };
        (method.frames.frame_ms, method.frames.staged_frame_ms) = (frame_ms.into(), vec![60.0; 3]);
        (method.false_negatives, method.false_negative_frames, method.object_error_percent) = (0, 0, 0.0);
        (method.differing_pixels_mean, method.psnr_worst_db) = (0.0, None);
        method.stages = vec![Stage { name: "draw/all".into(), ..Stage::default() }];
        method.frames.stages = [("draw/all".to_owned(), vec![Some(60.0); 3])].into();
        method
    };
    let mut woc = of("woc[seeds=8]", "woc", 10.0, [10.0, 12.0, 16.0]);
    (woc.false_negatives, woc.false_negative_frames, woc.object_error_percent) = (9, 2, 2.0);
    (woc.culled_over_ref, woc.culled_over_total) = (0.875, 0.5);
    woc.frames.staged_frame_ms = vec![10.0, 20.0, 60.0];
    let stage = |name: &str, skipped, reason: Option<&str>| Stage {
        name: name.into(),
        skipped,
        reason: reason.map(str::to_owned),
        ..Stage::default()
    };
    woc.stages = vec![stage("draw/all", 1, Some("no draws")), stage("pack/scan", 0, Some("never"))];
    woc.frames.stages = [
        ("draw/all".to_owned(), vec![Some(3.0), None, Some(6.0)]),
        ("pack/scan".to_owned(), vec![Some(6.0), Some(18.0), Some(42.0)]),
    ]
    .into();
    let mut results = distinct();
    results.methods = vec![of("none", "none", 40.0, [17.0, 18.0, 19.0]), woc, of("ref", "ref", 8.0, [8.0, 9.0, 20.0])];
    results
}

fn json_of(part: &impl Serialize) -> Value {
    serde_json::to_value(part).unwrap()
}

/// Left edge, width, class and tip of each piece of a row.
fn pieces(bars: &Value, row: usize) -> Vec<(f64, f64, String, String)> {
    let number = |piece: &Value, field: &str| piece[field].as_f64().unwrap();
    let text = |piece: &Value, field: &str| piece[field].as_str().unwrap().to_owned();
    let of = |piece: &Value| (number(piece, "x"), number(piece, "width"), text(piece, "class"), text(piece, "tip"));
    bars["rows"][row]["segments"].as_array().unwrap().iter().map(of).collect()
}

fn piece(x: f64, width: f64, class: &str, tip: &str) -> (f64, f64, String, String) {
    (x, width, class.to_owned(), tip.to_owned())
}

/// The labels take 79.2 pixels, and bars go from 91.2 to 820: 728.8 pixels for 60 ms or for 100 %.
#[test]
fn stages_are_as_long_as_the_mean_of_the_frames_that_timed_them() {
    let stages = json_of(&stages::stages(&unlike()));
    let families: Vec<_> =
        stages["families"].as_array().unwrap().iter().map(|f| (f["name"].clone(), f["class"].clone())).collect();
    let expected = [("draw", "c0"), ("pack", "c1"), ("between stages", "rest")];
    assert_eq!(families, expected.map(|(name, class)| (json!(name), json!(class))));
    let tip = |text: &str| format!("woc[seeds=8]: {text} of the frame");
    let tips = ["draw/all 3 ms, 10 %", "pack/scan 22 ms, 73.3 %", "between stages 5 ms, 16.7 %"].map(tip);
    let [draw, pack, between] = tips.each_ref().map(String::as_str);
    let expected =
        [piece(91.2, 36.4, "c0", draw), piece(127.6, 267.3, "c1", pack), piece(394.9, 60.7, "rest", between)];
    assert_eq!(pieces(&stages["milliseconds"], 1), expected);
    let expected =
        [piece(91.2, 72.9, "c0", draw), piece(164.1, 534.4, "c1", pack), piece(698.5, 121.5, "rest", between)];
    assert_eq!(pieces(&stages["shares"], 1), expected);
    let row = &stages["milliseconds"]["rows"][1];
    assert_eq!(
        (&row["label"], &row["value"], &row["value_x"]),
        (&json!("woc[seeds=8]"), &json!("30 ms"), &json!(461.6))
    );
    assert_eq!(stages["milliseconds"]["rows"][2]["value"], "60 ms");
    let units = ["milliseconds", "shares"].map(|plot| stages[plot]["unit"].as_str().unwrap().to_owned());
    assert_eq!(units, ["ms of the mean frame", "percent of the mean frame"]);
}

#[test]
fn bars_of_what_is_culled_have_their_own_lengths() {
    let culled = json_of(&culled::culled(&{
        let mut results = unlike();
        results.methods.remove(0);
        results.methods.remove(1);
        results
    }));
    let tips = ["C/R 87.5 %", "C/N 50 %"].map(|text| format!("woc[seeds=8]: {text}"));
    assert_eq!(pieces(&culled, 0), [piece(91.2, 637.7, "c0", &tips[0]), piece(91.2, 364.4, "c1", &tips[1])]);
    assert_eq!((&culled["rows"][0]["value"], &culled["rows"][0]["value_x"]), (&json!("87.5 · 50"), &json!(734.9)));
    let lanes = [0, 1].map(|lane| culled["rows"][0]["segments"][lane]["y"].as_f64().unwrap());
    assert_eq!(lanes, [11.0, 20.0]);
    let last = culled["ticks"].as_array().unwrap().last().unwrap();
    assert_eq!(*last, json!({ "at": 820.0, "label": "100" }));
}

#[test]
fn curves_go_through_the_timed_frames() {
    let mut results = unlike();
    results.methods[0] = Method { label: "woc[seeds=2]".into(), method: "woc".into(), ..results.methods[0].clone() };
    results.methods.swap(0, 1);
    let found = json_of(&curves::curves(&results));
    // Three frames from 80 to 710; 0 to 21 ms from 330 up to 20. Curves are in the order of their ends, the slowest first.
    let expected = [
        ("ref", "c1", false, "M80,211.9L395,197.1L710,34.8"),
        ("woc[seeds=2]", "c0", true, "M80,79L395,64.3L710,49.5"),
        ("woc[seeds=8]", "c0", false, "M80,182.4L395,152.9L710,93.8"),
    ];
    let of = |curve: &Value| {
        let text = |field: &str| curve[field].as_str().unwrap().to_owned();
        (text("label"), text("class"), curve["dashed"].as_bool().unwrap(), text("path"))
    };
    let curves: Vec<_> = found["curves"].as_array().unwrap().iter().map(of).collect();
    let curves: Vec<_> = curves.iter().map(|(l, c, d, p)| (l.as_str(), c.as_str(), *d, p.as_str())).collect();
    assert_eq!(curves, expected);
    assert_eq!((&found["curves"][0]["end"], &found["by_ratio"]), (&json!(34.8), &json!(false)));
    // From a ratio of 8 on, times are spread by their ratios: 0.9 to 8.8 ms from 330 up to 20.
    results.methods.truncate(1);
    results.methods[0].frames.frame_ms = vec![1.0, 2.0, 8.0];
    let found = json_of(&curves::curves(&results));
    assert_eq!((&found["curves"][0]["path"], &found["by_ratio"]), (&json!("M80,315.7L395,221.4L710,33"), &json!(true)));
}

/// Times of 0.9 to 5.75 times that of `ref` by their ratios from 80 to 880, errors of 0 to 2.6 % from 336 up to 30.
#[test]
fn points_of_the_plane_stand_at_their_time_and_their_error() {
    let found = json_of(&plane::plane(&unlike()));
    let circle = |x: f64, y: f64| format!("M{x},{y}a5,5 0 1 0 10,0a5,5 0 1 0 -10,0Z");
    let expected = [
        ("c0", circle(814.7, 336.0), "none: 40 ms, 5 × ref, 0 % of visible objects missed", true, false),
        ("c1", circle(216.7, 44.4), "woc[seeds=8]: 10 ms, 1.25 × ref, 2 % of visible objects missed", true, false),
        ("c2", circle(120.4, 336.0), "ref: 8 ms, 1 × ref, 0 % of visible objects missed", false, true),
    ];
    for (point, (class, mark, tip, on_front, ideal)) in found["points"].as_array().unwrap().iter().zip(expected) {
        assert_eq!((&point["class"], &point["mark"], &point["tip"]), (&json!(class), &json!(mark), &json!(tip)));
        assert_eq!((&point["on_front"], &point["ideal"]), (&json!(on_front), &json!(ideal)), "{tip}");
    }
    assert_eq!(found["front"], "M221.7,30V44.4H819.7V336H880");
    assert!(found["x_title"].as_str().unwrap().contains("multiple of ref's"));
    let alt = "Run time against missed objects of 3 settings. On the front: woc[seeds=8] (10 ms, 2 % missed), none (40 ms, 0 % missed).";
    assert_eq!(found["alt"], alt);
    let keys: Vec<_> = found["legend"].as_array().unwrap().iter().map(|key| (&key["id"], &key["class"])).collect();
    assert_eq!(keys, [(&json!("none"), &json!("c0")), (&json!("woc"), &json!("c1")), (&json!("ref"), &json!("c2"))]);
    let mut without = unlike();
    without.methods.pop();
    let found = json_of(&plane::plane(&without));
    assert_eq!(found["points"][1]["tip"], "woc[seeds=8]: 10 ms, 2 % of visible objects missed");
    assert!(found["x_title"].as_str().unwrap().contains("in ms"));
}

#[test]
#[rustfmt::skip]
fn each_cell_of_the_tables_is_its_own_field() {
    let mut results = distinct();
    results.methods.push(unlike().methods.remove(0));
    let expected: [(&str, &[(&str, &str)]); 4] = [
        ("Time and memory", &[
            ("median ms", "1.5"), ("p95 ms", "2.5"), ("mean ms", "3.5"), ("/none", "0.0375"), ("/ref", "5.5"), ("host ms", "4.5"),
            ("memory MiB", "34.5"),
        ]),
        ("Errors against the truth", &[
            ("missed", "9"), ("frames", "10"), ("object error %", "11.5"), ("diff px", "12.5"), ("tied px", "13.5"), ("thin px", "14.5"),
            ("PSNR dB", "15.5"), ("worst PSNR", "16.5"), ("SSIM", "18.5"),
        ]),
        ("What was culled and done", &[
            ("drawn", "19.5"), ("C/N %", "2\u{202f}050"), ("C/R %", "2\u{202f}150"), ("triangles", "22.5"), ("draws", "23.5"),
            ("overdraw", "24.5"), ("queries", "25.5"), ("state changes", "26.5"), ("waits", "27.5"), ("plane tests", "28.5"),
            ("rays", "29.5"), ("boxes", "30.5"), ("bounds brought", "31.5"), ("refits", "32.5"), ("node visits", "33.5"),
        ]),
        ("Lens flare", &[("on screen", "35"), ("shows", "36.5"), ("error", "37.5"), ("worst", "38.5")]),
    ];
    let tables = json_of(&measures::tables(&results));
    for (table, (title, cells)) in tables.as_array().unwrap().iter().zip(expected) {
        let row = &table["rows"][0];
        assert_eq!((&table["title"], &row["label"], &row["guarantee"]), (&json!(title), &json!("woc[seeds=8]"), &json!("approximate: holes")));
        let names = table["columns"].as_array().unwrap().iter().map(|column| column["name"].as_str().unwrap());
        let found: Vec<_> = names.zip(row["cells"].as_array().unwrap().iter().map(|cell| cell.as_str().unwrap())).collect();
        assert_eq!(found, cells);
    }
    assert_eq!(tables.as_array().unwrap().len(), 4);
    // `none` has no time of the host, and no ratio to a `ref` that did not run; its worst frame is as the truth.
    assert_eq!(tables[0]["rows"][1]["cells"], json!(["40", "60", "120", "1", "–", "–", "34.5"]));
    assert_eq!(tables[1]["rows"][1]["cells"][7], "identical");
}

/// The templates put each number where its name says.
#[test]
fn each_mark_stands_in_the_page_as_it_was_computed() {
    let results = unlike();
    let text = html(&results, Some(&gallery())).unwrap();
    let document = parsed(&text);
    let of = |tag: &'static str| document.descendants().filter(move |node| node.has_tag_name(tag));
    let stages = json_of(&stages::stages(&results));
    let plots = [&stages["milliseconds"], &stages["shares"], &json_of(&culled::culled(&results))];
    let rows = plots.into_iter().flat_map(|plot| plot["rows"].as_array().unwrap().clone());
    let expected = rows.flat_map(|row| row["segments"].as_array().unwrap().clone()).map(|piece| {
        let number = |field: &str| piece[field].as_f64().unwrap();
        ["x", "y", "width", "height"].map(number)
    });
    let number = |node: &roxmltree::Node<'_, '_>, name: &str| node.attribute(name).unwrap().parse::<f64>().unwrap();
    let found = of("rect").map(|rect| ["x", "y", "width", "height"].map(|name| number(&rect, name)));
    assert_eq!(found.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
    let (plane, curves) = (json_of(&plane::plane(&results)), json_of(&curves::curves(&results)));
    let mut paths = vec![&plane["front"]];
    paths.extend(plane["points"].as_array().unwrap().iter().map(|point| &point["mark"]));
    paths.extend(curves["curves"].as_array().unwrap().iter().map(|curve| &curve["path"]));
    for path in paths {
        assert!(of("path").any(|node| node.attribute("d") == path.as_str()), "{path}");
    }
    let tables = json_of(&measures::tables(&results));
    let cells = tables.as_array().unwrap().iter().flat_map(|table| table["rows"].as_array().unwrap());
    let cells = cells.flat_map(|row| row["cells"].as_array().unwrap()).map(|cell| cell.as_str().unwrap());
    let found: Vec<&str> = of("td").filter_map(|cell| cell.text()).collect();
    let cells: Vec<&str> = cells.collect();
    assert!(found.windows(cells.len()).any(|window| window == cells), "{found:?}");
}

#[test]
fn sentences_name_the_fastest_right_method_and_the_worst_one() {
    let mut results = unlike();
    // More objects are missed by a method that misses a smaller part; another changes pixels alone.
    let mut more = results.methods[1].clone();
    (more.label, more.method) = ("hzb".into(), "hzb".into());
    (more.false_negatives, more.object_error_percent, more.frame_ms.median) = (90, 1.0, 9.0);
    let mut pixels = results.methods[0].clone();
    (pixels.label, pixels.method, pixels.differing_pixels_mean) = ("warp".into(), "warp".into(), 0.5);
    pixels.frame_ms.median = 5.0;
    let mut right = results.methods[0].clone();
    (right.label, right.method, right.frame_ms.median) = ("roc".into(), "roc".into(), 16.0);
    results.methods.extend([more, pixels, right]);
    let [ran, fastest, errors] = words::sentences(&results);
    assert!(ran.contains("the same 3 frames (1005 × 1006 pixels) of “a scene”, which has 1\u{202f}001 objects and 1\u{202f}002 triangles"), "{ran}");
    assert!(ran.contains("with 6 ways of") && ran.ends_with("on a device."), "{ran}");
    let expected = "Fastest without a single wrong pixel was roc with 16 ms a frame: 0.4 times the time of drawing everything (none) \
        and 2 times the time of drawing exactly what is visible (ref).";
    assert_eq!(fastest, expected);
    let expected =
        "2 of 6 settings missed visible objects, worst woc[seeds=8]: 9 in 2 of 3 frames, 2 % of all that should show; \
        1 setting missed no object but changed pixels.";
    assert_eq!(errors, expected);
    assert_eq!(words::title(&results), "Occlusion culling of a scene: 6 settings");
}

#[test]
fn facts_are_those_of_the_run() {
    let facts = json_of(&facts::facts(&distinct()));
    let found: Vec<_> = facts
        .as_array()
        .unwrap()
        .iter()
        .map(|it| [&it["name"], &it["value"]].map(|text| text.as_str().unwrap()))
        .collect();
    let expected = [
        ["Device", "a device (discrete)"],
        ["Driver", "a driver, Vulkan 1.3.9"],
        ["Depth", "D16_UNORM"],
        ["Stages timed by", "submits"],
        ["Command", "sightline bench"],
        ["Sightline", "9.8.7"],
        ["Scene", "a scene: 1001 objects, 1002 triangles, seed 1004"],
        ["Scene, SHA-256", "cafe"],
        ["Path", "a path at speed 1003.5, 3 frames of 1005 × 1006 pixels"],
    ];
    assert_eq!(found[..9], expected);
    assert_eq!((found[9][0], found[9][1].len()), ("Settings, SHA-256", 64));
}

#[test]
fn skips_are_counted_by_stage_reason_and_method() {
    let mut results = unlike();
    let skipped =
        |skipped, reason: &str| Stage { skipped, reason: Some(reason.into()), ..results.methods[1].stages[0].clone() };
    let (same, other) = (skipped(2, "no draws"), skipped(3, "another"));
    (results.methods[0].stages, results.methods[2].stages) = (vec![same], vec![other]);
    let expected = json!([
        { "stage": "draw/all", "reason": "no draws", "methods": ["none (2 of 3 frames)", "woc[seeds=8] (1 of 3 frames)"] },
        { "stage": "draw/all", "reason": "another", "methods": ["ref (3 of 3 frames)"] },
    ]);
    assert_eq!(json_of(&skipped::skipped(&results)), expected);
}

#[test]
fn pictures_say_their_own_fault() {
    let mut gallery = gallery();
    let mut faulty = gallery.of_method.remove(NASTY).unwrap();
    let error = &mut faulty.worst.as_mut().unwrap().error;
    (error.false_negatives, error.ref_visible, error.differing_pixels, error.psnr_db) = (3, 70, 12, Some(41.3));
    (error.drawn, error.false_positives, error.tied_pixels) = (68, 1, 5);
    gallery.of_method.insert("woc[seeds=8]".into(), faulty);
    let found = json_of(&pictures::pictures(&unlike(), &gallery));
    let uri = |name: &str| format!("data:image/png;base64,{name}");
    let fault = "visible objects missed: 3 of 70; pixels of another depth: 12; PSNR 41.3 dB";
    let shown = ["t", "m", "d"].map(uri);
    let worst = json!({ "label": "woc[seeds=8]", "frame": 1, "fault": fault, "pictures": shown });
    let buffers = json!({ "label": "woc[seeds=8]", "overdraw": uri("o"), "items": uri("i") });
    let expected = json!({ "worst": [worst], "right": ["none"], "left_out": 0, "frame": 1, "buffers": [buffers] });
    assert_eq!(found, expected);
    let text = html(&unlike(), Some(&gallery)).unwrap();
    let document = parsed(&text);
    let images: Vec<_> = document
        .descendants()
        .filter(|node| node.has_tag_name("img"))
        .map(|node| node.attribute("src").unwrap())
        .collect();
    assert_eq!(images, ["t", "m", "d", "o", "i"].map(uri));
}
