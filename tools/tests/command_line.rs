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
