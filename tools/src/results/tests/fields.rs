//! Every field of `results.json` and every column of `results.csv` is tied to its source: no two numbers of the fixture are equal.

use super::*;
use serde_json::{json, Value};
use std::collections::BTreeSet;

/// Three frames with every field filled.
pub(crate) fn distinct() -> Results {
    Results {
        schema: SCHEMA,
        sightline_version: "9.8.7".into(),
        command: "sightline bench".into(),
        device: Device {
            name: "a device".into(),
            kind: "discrete".into(),
            driver: "a driver".into(),
            api_version: "1.3.9".into(),
            timer_mode: "submits".into(),
            depth_format: "D16_UNORM".into(),
            details: [("lacks".to_owned(), "a feature".to_owned())].into(),
        },
        scene: Scene {
            name: "a scene".into(),
            objects: 1001,
            triangles: 1002,
            hash: "cafe".into(),
            moving_bounds: "union".into(),
            shading: "lambert".into(),
        },
        path: "a path".into(),
        speed: 1003.5,
        seed: 1004,
        size: [1005, 1006],
        frames: 3,
        methods: vec![distinct_method()],
    }
}

fn distinct_method() -> Method {
    Method {
        label: "woc[seeds=8]".into(),
        method: "woc".into(),
        options: [("bound".to_owned(), "local".into()), ("seeds".to_owned(), 8.into())].into(),
        guarantee: "approximate: holes".into(),
        frame_ms: FrameMs { median: 1.5, p95: 2.5, mean: 3.5 },
        host_ms: Some(4.5),
        ratio_to_ref: Some(5.5),
        stages: vec![Stage {
            name: "warp/search".into(),
            median_ms: 6.5,
            share: 0.75,
            skipped: 7,
            reason: Some("no change".into()),
            saved_ms: Some(8.5),
        }],
        false_negatives: 9,
        false_negative_frames: 10,
        object_error_percent: 11.5,
        differing_pixels_mean: 12.5,
        tied_pixels_mean: 13.5,
        thin_pixels_mean: 14.5,
        psnr_mean_db: Some(15.5),
        psnr_worst_db: Some(16.5),
        psnr_between_db: [("none".to_owned(), Some(17.5)), ("ref".to_owned(), None)].into(),
        ssim_mean: 18.5,
        drawn_mean: 19.5,
        culled_over_total: 20.5,
        culled_over_ref: 21.5,
        triangles_mean: 22.5,
        draws_mean: 23.5,
        overdraw_mean: Some(24.5),
        queries_mean: 25.5,
        state_changes_mean: 26.5,
        waits_mean: 27.5,
        plane_tests_mean: 28.5,
        rays_mean: 29.5,
        boxes_mean: 30.5,
        bounds_brought_mean: 31.5,
        refits_mean: 32.5,
        node_visits_mean: 33.5,
        device_memory_mib: 34.5,
        flare: Some(FlareErrors {
            when: "same".into(),
            light: "at 1,2,3".into(),
            frames_on_screen: 35,
            shows_mean: Some(36.5),
            error_mean: Some(37.5),
            error_max: Some(38.5),
        }),
        frames: distinct_frames(),
        choices: vec!["woc: it is fast".into()],
    }
}

fn distinct_frames() -> Frames {
    let counts = |from: u64| vec![from, from + 1, from + 2];
    let numbers = |from: f64| vec![from + 0.5, from + 1.5, from + 2.5];
    Frames {
        frame_ms: numbers(100.0),
        drawn: counts(110),
        ref_visible: counts(120),
        false_negatives: counts(130),
        differing_pixels: counts(140),
        tied_pixels: counts(150),
        thin_pixels: counts(160),
        psnr_db: vec![Some(170.5), None, Some(172.5)],
        ssim: numbers(180.0),
        triangles: counts(190),
        draws: counts(200),
        overdraw: numbers(210.0),
        queries: counts(220),
        rays: counts(230),
        boxes: counts(240),
        node_visits: counts(250),
        flare_by_query: numbers(260.0),
        flare_by_oracle: numbers(270.0),
        staged_frame_ms: numbers(280.0),
        stages: [("warp/search".to_owned(), vec![Some(290.5), None, Some(292.5)])].into(),
    }
}

#[rustfmt::skip]
fn distinct_json() -> Value {
    let mut method = json!({
        "label": "woc[seeds=8]", "method": "woc", "options": { "bound": "local", "seeds": 8 }, "guarantee": "approximate: holes",
        "frame_ms": { "median": 1.5, "p95": 2.5, "mean": 3.5 }, "host_ms": 4.5, "ratio_to_ref": 5.5,
        "stages": [{ "name": "warp/search", "median_ms": 6.5, "share": 0.75, "skipped": 7, "reason": "no change", "saved_ms": 8.5 }],
        "false_negatives": 9, "false_negative_frames": 10, "object_error_percent": 11.5, "differing_pixels_mean": 12.5,
        "tied_pixels_mean": 13.5, "thin_pixels_mean": 14.5, "psnr_mean_db": 15.5, "psnr_worst_db": 16.5,
        "psnr_between_db": { "none": 17.5, "ref": null }, "ssim_mean": 18.5, "drawn_mean": 19.5, "culled_over_total": 20.5,
        "culled_over_ref": 21.5, "triangles_mean": 22.5, "draws_mean": 23.5, "overdraw_mean": 24.5, "queries_mean": 25.5,
        "state_changes_mean": 26.5, "waits_mean": 27.5, "plane_tests_mean": 28.5, "rays_mean": 29.5, "boxes_mean": 30.5,
        "bounds_brought_mean": 31.5, "refits_mean": 32.5, "node_visits_mean": 33.5, "device_memory_mib": 34.5,
        "flare": {
            "when": "same", "light": "at 1,2,3", "frames_on_screen": 35, "shows_mean": 36.5, "error_mean": 37.5, "error_max": 38.5,
        },
        "choices": ["woc: it is fast"],
    });
    method["frames"] = json!({
        "frame_ms": [100.5, 101.5, 102.5], "drawn": [110, 111, 112], "ref_visible": [120, 121, 122],
        "false_negatives": [130, 131, 132], "differing_pixels": [140, 141, 142], "tied_pixels": [150, 151, 152],
        "thin_pixels": [160, 161, 162], "psnr_db": [170.5, null, 172.5], "ssim": [180.5, 181.5, 182.5],
        "triangles": [190, 191, 192], "draws": [200, 201, 202], "overdraw": [210.5, 211.5, 212.5], "queries": [220, 221, 222],
        "rays": [230, 231, 232], "boxes": [240, 241, 242], "node_visits": [250, 251, 252],
        "flare_by_query": [260.5, 261.5, 262.5], "flare_by_oracle": [270.5, 271.5, 272.5],
        "staged_frame_ms": [280.5, 281.5, 282.5], "stages": { "warp/search": [290.5, null, 292.5] },
    });
    json!({
        "schema": 1, "sightline_version": "9.8.7", "command": "sightline bench",
        "device": {
            "name": "a device", "type": "discrete", "driver": "a driver", "api_version": "1.3.9", "timer_mode": "submits",
            "depth_format": "D16_UNORM", "details": { "lacks": "a feature" },
        },
        "scene": { "name": "a scene", "objects": 1001, "triangles": 1002, "hash": "cafe", "moving_bounds": "union", "shading": "lambert" },
        "path": "a path", "speed": 1003.5, "seed": 1004, "size": [1005, 1006], "frames": 3, "methods": [method],
    })
}

#[test]
fn each_field_is_written_and_read_under_its_own_name() {
    let folder = Folder::new("results-fields");
    let path = folder.0.join("results.json");
    distinct().write_json(&path).unwrap();
    let written: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(written, distinct_json());
    assert_eq!(Results::read_json(&path).unwrap(), distinct());
    assert_eq!(Results::read_plain(&path).unwrap(), distinct());
}

#[test]
#[rustfmt::skip]
fn each_column_of_the_csv_is_its_own_field() {
    let folder = Folder::new("results-columns");
    let path = folder.0.join("results.csv");
    distinct().write_csv(&path).unwrap();
    let expected = [
        ("device", "a device"), ("scene", "a scene"), ("objects", "1001"), ("path", "a path"), ("speed", "1003.5"), ("seed", "1004"),
        ("width", "1005"), ("height", "1006"), ("frames", "3"), ("label", "woc[seeds=8]"), ("method", "woc"),
        ("options", "bound=local;seeds=8"), ("guarantee", "approximate: holes"), ("frame_ms_median", "1.5"), ("frame_ms_p95", "2.5"),
        ("frame_ms_mean", "3.5"), ("host_ms", "4.5"), ("false_negatives", "9"), ("false_negative_frames", "10"),
        ("object_error_percent", "11.5"), ("differing_pixels_mean", "12.5"), ("tied_pixels_mean", "13.5"), ("psnr_mean_db", "15.5"),
        ("psnr_worst_db", "16.5"), ("ssim_mean", "18.5"), ("drawn_mean", "19.5"), ("culled_over_total", "20.5"),
        ("culled_over_ref", "21.5"), ("triangles_mean", "22.5"), ("draws_mean", "23.5"), ("overdraw_mean", "24.5"),
        ("queries_mean", "25.5"), ("state_changes_mean", "26.5"), ("waits_mean", "27.5"), ("plane_tests_mean", "28.5"),
        ("rays_mean", "29.5"), ("boxes_mean", "30.5"), ("moving_bounds", "union"), ("bounds_brought_mean", "31.5"),
        ("refits_mean", "32.5"), ("node_visits_mean", "33.5"), ("device_memory_mib", "34.5"), ("thin_pixels_mean", "14.5"),
        ("flare_when", "same"), ("flare_shows_mean", "36.5"), ("flare_error_mean", "37.5"), ("flare_error_max", "38.5"),
        ("stage:warp/search", "6.5"),
    ];
    let mut csv = csv::Reader::from_path(&path).unwrap();
    let heads = csv.headers().unwrap().clone();
    let row = csv.records().next().unwrap().unwrap();
    assert_eq!(heads.iter().zip(row.iter()).collect::<Vec<_>>(), expected);
}

/// Of each array of the frames, two entries are refused, and so are four.
#[test]
fn each_array_of_another_length_is_refused_by_its_name() {
    let arrays = |frames: &Value| {
        let plain = frames.as_object().unwrap().iter().filter(|(_, value)| value.is_array());
        plain.map(|(name, _)| format!("/{name}")).chain(["/stages/warp~1search".to_owned()]).collect::<Vec<_>>()
    };
    let names = arrays(&distinct_json()["methods"][0]["frames"]);
    assert_eq!(names.len(), 20);
    for name in names {
        for longer in [false, true] {
            let mut json = distinct_json();
            let array = json.pointer_mut(&format!("/methods/0/frames{name}")).unwrap().as_array_mut().unwrap();
            match longer {
                true => array.push(array[0].clone()),
                false => drop(array.pop()),
            }
            let Err(fault) = read::parse(&json.to_string()) else { panic!("{name} passed, longer: {longer}") };
            let field = format!("methods[0].frames{}", name.replace('/', ".").replace("~1", "/"));
            let length = if longer { 4 } else { 2 };
            assert_eq!((fault.field, fault.fault), (field, format!("has {length} entries for 3 frames")));
        }
    }
}

type Spoil = fn(&mut Method, f64);

/// Every number of a method that is not whole, with its name.
#[rustfmt::skip]
const NUMBERS: [(&str, Spoil); 43] = [
    ("frame_ms.median", |m, v| m.frame_ms.median = v), ("frame_ms.p95", |m, v| m.frame_ms.p95 = v),
    ("frame_ms.mean", |m, v| m.frame_ms.mean = v), ("host_ms", |m, v| m.host_ms = Some(v)),
    ("ratio_to_ref", |m, v| m.ratio_to_ref = Some(v)), ("object_error_percent", |m, v| m.object_error_percent = v),
    ("differing_pixels_mean", |m, v| m.differing_pixels_mean = v), ("tied_pixels_mean", |m, v| m.tied_pixels_mean = v),
    ("thin_pixels_mean", |m, v| m.thin_pixels_mean = v), ("psnr_mean_db", |m, v| m.psnr_mean_db = Some(v)),
    ("psnr_worst_db", |m, v| m.psnr_worst_db = Some(v)),
    ("psnr_between_db.none", |m, v| _ = m.psnr_between_db.insert("none".into(), Some(v))),
    ("ssim_mean", |m, v| m.ssim_mean = v), ("drawn_mean", |m, v| m.drawn_mean = v),
    ("culled_over_total", |m, v| m.culled_over_total = v), ("culled_over_ref", |m, v| m.culled_over_ref = v),
    ("triangles_mean", |m, v| m.triangles_mean = v), ("draws_mean", |m, v| m.draws_mean = v),
    ("overdraw_mean", |m, v| m.overdraw_mean = Some(v)), ("queries_mean", |m, v| m.queries_mean = v),
    ("state_changes_mean", |m, v| m.state_changes_mean = v), ("waits_mean", |m, v| m.waits_mean = v),
    ("plane_tests_mean", |m, v| m.plane_tests_mean = v), ("rays_mean", |m, v| m.rays_mean = v),
    ("boxes_mean", |m, v| m.boxes_mean = v), ("bounds_brought_mean", |m, v| m.bounds_brought_mean = v),
    ("refits_mean", |m, v| m.refits_mean = v), ("node_visits_mean", |m, v| m.node_visits_mean = v),
    ("device_memory_mib", |m, v| m.device_memory_mib = v), ("flare.shows_mean", |m, v| m.flare.as_mut().unwrap().shows_mean = Some(v)),
    ("flare.error_mean", |m, v| m.flare.as_mut().unwrap().error_mean = Some(v)),
    ("flare.error_max", |m, v| m.flare.as_mut().unwrap().error_max = Some(v)),
    ("stages[0].median_ms", |m, v| m.stages[0].median_ms = v), ("stages[0].share", |m, v| m.stages[0].share = v),
    ("stages[0].saved_ms", |m, v| m.stages[0].saved_ms = Some(v)), ("frames.frame_ms[2]", |m, v| m.frames.frame_ms[2] = v),
    ("frames.psnr_db[2]", |m, v| m.frames.psnr_db[2] = Some(v)), ("frames.ssim[2]", |m, v| m.frames.ssim[2] = v),
    ("frames.overdraw[2]", |m, v| m.frames.overdraw[2] = v), ("frames.flare_by_query[2]", |m, v| m.frames.flare_by_query[2] = v),
    ("frames.flare_by_oracle[2]", |m, v| m.frames.flare_by_oracle[2] = v),
    ("frames.staged_frame_ms[2]", |m, v| m.frames.staged_frame_ms[2] = v),
    ("frames.stages.warp/search[2]", |m, v| _ = m.frames.stages.insert("warp/search".into(), vec![None, None, Some(v)])),
];

/// The names of the numbers of a JSON value that are not whole; of an array of numbers, the last.
fn fractions(value: &Value, name: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Number(number) if number.is_f64() => _ = found.insert(name.to_owned()),
        Value::Object(fields) => {
            let at = |field: &str| if name.is_empty() { field.to_owned() } else { format!("{name}.{field}") };
            fields.iter().for_each(|(field, value)| fractions(value, &at(field), found));
        }
        Value::Array(values) => {
            let last = values.len() - 1;
            fractions(&values[last], &format!("{name}[{last}]"), found);
        }
        _ => {}
    }
}

#[test]
fn each_number_that_is_none_is_refused_by_its_name() {
    let mut all = BTreeSet::new();
    fractions(&distinct_json()["methods"][0], "", &mut all);
    let named: BTreeSet<String> = NUMBERS.iter().map(|(name, _)| (*name).to_owned()).collect();
    assert_eq!(named, all);
    assert!(distinct().check().is_ok());
    for (name, spoil) in NUMBERS {
        for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut results = distinct();
            spoil(&mut results.methods[0], value);
            let Err(fault) = results.check() else { panic!("{name} may be {value}") };
            assert_eq!((fault.field, fault.fault.as_str()), (format!("methods[0].{name}"), "is not a finite number"));
        }
    }
    let mut results = distinct();
    results.speed = f64::INFINITY;
    assert_eq!(results.check().err().map(|fault| fault.field).as_deref(), Some("speed"));
}

#[test]
fn another_schema_and_a_missing_label_are_refused() {
    for schema in [SCHEMA - 1, SCHEMA + 1] {
        let fault = Results { schema, ..distinct() }.check().err().unwrap();
        assert_eq!((fault.field.as_str(), fault.fault), ("schema", format!("is {schema}, but this program reads 1")));
        // The schema is read before the fields, which may be others.
        let fault = read::parse(&json!({ "schema": schema }).to_string()).err().unwrap();
        assert_eq!((fault.field.as_str(), fault.fault), ("schema", format!("is {schema}, but this program reads 1")));
    }
    let mut results = distinct();
    results.methods.push(Method { label: String::new(), ..distinct_method() });
    let fault = results.check().err().unwrap();
    assert_eq!((fault.field.as_str(), fault.fault.as_str()), ("methods[1].label", "is empty"));
}

#[test]
fn control_characters_are_escaped_for_a_terminal_alone() {
    let folder = Folder::new("results-plain");
    let path = folder.0.join("results.json");
    let mut results = distinct();
    results.scene.name = "a\u{1b}[2Jb".into();
    _ = results.methods[0].options.insert("c\u{7}".into(), "d\u{9b}".into());
    results.write_json(&path).unwrap();
    assert_eq!(Results::read_json(&path).unwrap(), results);
    let plain = Results::read_plain(&path).unwrap();
    assert_eq!(plain.scene.name, "a\\u{1b}[2Jb");
    assert_eq!(plain.methods[0].options["c\\u{7}"], "d\\u{9b}");
    assert_eq!(plain.methods[0].frames, results.methods[0].frames);
    // Labels that are equal once they are escaped are refused.
    results.methods.push(Method { label: "e\u{7}".into(), ..distinct_method() });
    results.methods.push(Method { label: "e\\u{7}".into(), ..distinct_method() });
    results.write_json(&path).unwrap();
    let error = Results::read_plain(&path).unwrap_err().to_string();
    assert!(error.contains("methods[2].label: `e\\u{7}` is there twice"), "{error}");
}

#[test]
fn the_comparison_with_the_truth_fills_its_own_fields() {
    let errors = MethodErrors {
        frames: 1,
        false_negatives: 2,
        false_negative_frames: 3,
        false_positives: 4,
        object_error_percent: 5.5,
        differing_pixels_mean: 6.5,
        tied_pixels_mean: 7.5,
        wrong_colour_pixels: 8,
        psnr_mean_db: Some(9.5),
        psnr_worst_db: Some(10.5),
        ssim_mean: 11.5,
        drawn_mean: 12.5,
        ref_visible_mean: 13.5,
        culled_over_total: 14.5,
        culled_over_ref: 15.5,
    };
    let mut method = distinct_method();
    method.set_errors(&errors);
    let expected = Method {
        false_negatives: 2,
        false_negative_frames: 3,
        object_error_percent: 5.5,
        differing_pixels_mean: 6.5,
        tied_pixels_mean: 7.5,
        psnr_mean_db: Some(9.5),
        psnr_worst_db: Some(10.5),
        ssim_mean: 11.5,
        drawn_mean: 12.5,
        culled_over_total: 14.5,
        culled_over_ref: 15.5,
        ..distinct_method()
    };
    assert_eq!(method, expected);
}

#[test]
fn frame_times_of_a_hundred_frames_have_their_own_ranks() {
    // The fastest frames come last, so that order is not taken for rank; the mean is above the median by one slow frame.
    let mut samples: Vec<f64> = (1..=100).rev().map(f64::from).collect();
    let FrameMs { median, p95, mean } = FrameMs::from_samples(&samples).unwrap();
    assert_eq!((median, mean), (50.5, 50.5));
    assert!((p95 - 95.05).abs() < 1e-9, "{p95}");
    samples[0] = 1100.0;
    let FrameMs { median, p95, mean } = FrameMs::from_samples(&samples).unwrap();
    assert_eq!((median, mean), (50.5, 60.5));
    assert!((p95 - 95.05).abs() < 1e-9, "{p95}");
    assert_eq!(FrameMs::from_samples(&[1.0, f64::NAN]), None);
}
