//! What scripts see of the program: exit codes, and output without colours.

use std::process::{Command, Output};

fn sightline(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_sightline")).args(arguments.split(' ')).output().unwrap()
}

#[test]
fn exit_codes_are_those_that_help_and_man_page_tell() {
    for (arguments, code) in [
        ("scene list", 0),
        ("man bench", 0),
        ("man dance", 1),
        ("shot --scene no-such-scene", 1),
        ("shot --no-such-flag", 2),
        ("dance", 2),
        ("compare no-such-a.json no-such-b.json", 2),
    ] {
        let output = sightline(arguments);
        assert_eq!(output.status.code(), Some(code), "{arguments}: {}", String::from_utf8_lossy(&output.stderr));
    }
    for told in [sightline("--help"), sightline("man")] {
        let text = String::from_utf8(told.stdout).unwrap();
        assert!(text.contains("Exit code: 0 all went well; 1 an error"), "{text}");
        assert!(text.contains("NO_COLOR"), "{text}");
    }
}

#[test]
fn what_is_no_terminal_gets_no_colours() {
    for arguments in ["--help", "shot --no-such-flag", "shot --scene no-such-scene", "scene list"] {
        let output = sightline(arguments);
        assert!(![output.stdout, output.stderr].concat().contains(&0x1b), "{arguments}");
    }
}

/// Each said something twice, or something that helps nobody.
#[test]
fn what_cannot_be_is_said_once_and_in_one_line() {
    for (arguments, expected) in [
        ("shot --scene rooms --method horizon", "sightline: method 'horizon' needs a city: "),
        ("shot --scene boxes --method portals", "sightline: method 'portals' needs cells: "),
        ("shot --scene absent.glb", "sightline: absent.glb: cannot read it: No such file or directory (os error 2)"),
        ("shot --path absent.json", "sightline: absent.json: cannot read it: No such file or directory (os error 2)"),
        ("shot --scale -1", "sightline: there is no scene scale '-1'"),
        ("view --size 100000x10", "sightline: --size: 100000x10: a window has at most 32767 pixels a side"),
        ("view --keys size=100000x10", "100000x10: a window has at most 32767 pixels a side"),
    ] {
        let output = sightline(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{arguments}: {said}");
        assert!(said.contains(expected) && said.lines().count() == 1, "{arguments}: {said}");
        let words = expected.trim_start_matches("sightline: ").trim_end_matches(": ");
        assert_eq!(said.matches(words).count(), 1, "{arguments}: {said}");
    }
}

#[test]
fn all_methods_of_several_samples_are_those_that_can_draw_them() {
    let out = std::env::temp_dir().join(format!("sightline-all-{}", std::process::id()));
    let ran = sightline(&format!(
        "bench --method all --samples 4 --frames 1 --warmup 0 --no-metrics --no-report --scene boxes --scale 0.1 --size 64x36 --out {}",
        out.display()
    ));
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.success(), "{said}");
    assert!(said.contains("left out: method 'eovc' needs one sample a pixel: it casts one ray"), "{said}");
    let results = std::fs::read_to_string(out.join("results.json")).unwrap();
    assert!(results.contains("\"method\": \"hzb\"") && !results.contains("\"method\": \"eovc\""), "{results}");
    std::fs::remove_dir_all(&out).unwrap();
}

#[test]
fn several_samples_a_pixel_are_drawn_or_refused_in_one_line() {
    let out = std::env::temp_dir().join(format!("sightline-samples-{}", std::process::id()));
    let small = format!("--scene boxes --scale 0.2 --size 64x36 --samples 4 --out {}", out.display());
    let ran = sightline(&format!("bench --frames 2 --no-report --method none,hzb {small}"));
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let results = std::fs::read_to_string(out.join("results.json")).unwrap();
    assert!(results.contains("\"samples\": \"4\""), "results say how finely pixels were drawn");
    for (arguments, said) in [
        ("shot --method eovc", "method 'eovc' cannot: it casts one ray"),
        ("shot --method hzb --view warp", "this view warps depths of one sample"),
        ("shot --method hzb --depth-format d16", "leave --depth-format out"),
        ("bench --table tog-2", "table tog-2 warps depths of one sample"),
    ] {
        let refused = sightline(&format!("{arguments} {small}"));
        let error = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(1), "{arguments}: {error}");
        assert!(error.contains(said) && error.lines().count() == 1, "{arguments}: {error}");
    }
    std::fs::remove_dir_all(&out).unwrap();
}

/// A run of a method that loses objects, as `query-lag` does wherever the camera jumps, beside one that cannot.
fn stressed(folder: &std::path::Path, more: &str) -> Output {
    let words =
        "stress --method none,query-lag --case teleports/0 --case near-plane/0 --as-given --bodies 20 --size 64x40";
    sightline(&format!("{words}{more} --out {}", folder.display()))
}

/// What the faults of a failure add up to: lost objects, and pixels that differ or have a wrong colour.
fn sum_of_faults(failure: &serde_json::Value) -> [u64; 2] {
    let faults = failure["faults"].as_array().unwrap().iter().map(|fault| {
        let words: Vec<_> = fault.as_str().unwrap().split(' ').collect();
        let [_, _, lost, _, differing, _, _, wrong, ..] = words.as_slice() else { panic!("{fault}") };
        [lost.parse::<u64>().unwrap(), differing.parse::<u64>().unwrap() + wrong.parse::<u64>().unwrap()]
    });
    faults.fold([0; 2], |sum, fault| [sum[0] + fault[0], sum[1] + fault[1]])
}

#[test]
fn stress_fails_with_1_and_its_counts_are_those_of_its_faults() {
    let folder = std::env::temp_dir().join(format!("sightline-stressed-{}", std::process::id()));
    let json = stressed(&folder, " --json");
    let said = String::from_utf8(json.stderr).unwrap();
    assert_eq!(json.status.code(), Some(1), "{said}");
    assert!(said.ends_with("sightline: 2 failures, see above\n"), "{said}");
    let outcome: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let list = |name: &str| outcome[name].as_array().unwrap().clone();
    let number =
        |value: &serde_json::Value, name: &str| value[name].as_u64().unwrap_or_else(|| panic!("{name}: {value}"));
    let failures = list("failures");
    let cases: Vec<_> = failures.iter().map(|failure| (failure["method"].clone(), failure["case"].clone())).collect();
    assert_eq!(cases, [("query-lag".into(), "teleports/0".into()), ("query-lag".into(), "near-plane/0".into())]);

    // By family: in the catalogue's order, each with its own drill, which two methods ran.
    let sums: Vec<_> = failures.iter().map(sum_of_faults).collect();
    let families = list("families");
    for (family, name, sum) in [(&families[0], "near-plane", sums[1]), (&families[1], "teleports", sums[0])] {
        assert_eq!((family["family"].as_str(), number(family, "runs")), (Some(name), 2));
        assert_eq!([number(family, "lost"), number(family, "differing_pixels")], sum, "{name}");
        assert!(sum[0] > 0 && sum[1] > 0);
    }
    assert_eq!((families.len(), number(&families[0], "object_frames")), (2, 2 * 7 * 21));
    assert_eq!(number(&families[1], "object_frames"), 2 * 9 * 21);

    // By method.
    let methods = list("methods");
    let all = [sums[0][0] + sums[1][0], sums[0][1] + sums[1][1]];
    for (method, label, sum) in [(&methods[0], "none", [0; 2]), (&methods[1], "query-lag", all)] {
        assert_eq!((method["label"].as_str(), number(method, "runs")), (Some(label), 2));
        assert_eq!(number(method, "object_frames"), (7 + 9) * 21);
        assert_eq!([number(method, "lost"), number(method, "differing_pixels")], sum, "{label}");
    }

    // Each failure is saved as it was told, smaller, with the pictures of a frame that is wrong.
    for (failure, name) in failures.iter().zip(["0-query-lag-teleports-0", "1-query-lag-near-plane-0"]) {
        let saved = folder.join("failures").join(name);
        let note: serde_json::Value =
            serde_json::from_slice(&std::fs::read(saved.join("drill.json")).unwrap()).unwrap();
        assert_eq!((&note["faults"], &note["drill"]), (&failure["faults"], &failure["case"]));
        let (objects, frames) = (note["objects"].as_array().unwrap().len(), note["frames"].as_array().unwrap().len());
        assert!(
            objects < 21
                && said.contains(&format!("small: {objects} objects, {frames} frames, in {}", saved.display()))
        );
        assert_eq!(note["pictures"], format!("frame {}", frames - 1), "the last frame is the first that fails");
        let [truth, method, difference] =
            ["truth", "method", "difference"].map(|name| std::fs::read(saved.join(format!("{name}.png"))).unwrap());
        assert!(truth != method && truth != difference);
        assert!(std::fs::read(saved.join("scene.glb")).unwrap().starts_with(b"glTF"));
    }

    // The table says the same.
    let table = stressed(&folder, "");
    assert_eq!(table.status.code(), Some(1));
    let table = String::from_utf8(table.stdout).unwrap();
    let row =
        |name: &str| table.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{name}: {table}"));
    let counts = |value: &serde_json::Value| {
        ["runs", "object_frames", "lost", "differing_pixels", "tied_pixels", "thin_pixels"]
            .map(|name| number(value, name).to_string())
    };
    for method in &methods {
        let words: Vec<_> =
            row(method["label"].as_str().unwrap()).split_whitespace().skip(1).map(str::to_owned).collect();
        assert_eq!(words, counts(method));
    }
    for family in &families {
        let rule = family["rule"].as_str().unwrap();
        let words: Vec<_> =
            row(family["family"].as_str().unwrap()).split(rule).nth(1).unwrap().split_whitespace().collect();
        assert_eq!(words[..6], counts(family));
        assert_eq!(
            [words[7], words[8]],
            ["spare_depths", "fewest_pixels"].map(|name| number(family, name).to_string())
        );
        let spare_px = family["spare_px"].as_f64().unwrap();
        assert_eq!(words[6], format!("{spare_px:.5}"));
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn stress_without_a_failure_ends_with_0() {
    let folder = std::env::temp_dir();
    let passed = sightline(&format!(
        "stress --method none --case near-plane/0 --bodies 2 --size 16x16 --out {}",
        folder.display()
    ));
    let said = String::from_utf8_lossy(&passed.stderr).into_owned();
    assert_eq!((passed.status.code(), said.as_str()), (Some(0), ""));
    assert!(String::from_utf8(passed.stdout)
        .unwrap()
        .ends_with("8 of 8 scenes without a meaning were refused by the name of their object\n"));
}
