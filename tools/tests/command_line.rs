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
