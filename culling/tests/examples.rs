//! Sightline as a library: the examples of `culling`, built and run as they are.

use std::process::Command;

/// Built with the whole workspace, as the tests are: this package alone would ask its dependencies for fewer features, and all of them
/// would be built once more.
fn run(example: &str) -> String {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args(["build", "--quiet", "--workspace", "--example", example]);
    build.args((!cfg!(debug_assertions)).then_some("--release"));
    let built = build.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).output().unwrap();
    assert!(built.status.success(), "{example}: {}", String::from_utf8_lossy(&built.stderr));
    // This test is in `deps`, beside `examples`.
    let this = std::env::current_exe().unwrap();
    let program = this.ancestors().nth(2).unwrap().join("examples").join(example);
    let output = Command::new(program).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{example}: {said}{}", String::from_utf8_lossy(&output.stderr));
    said
}

#[test]
fn a_scene_of_ones_own_is_culled() {
    let said = run("host_methods");
    for line in said.lines() {
        // `hzb, frame 2: 200 of 401 objects drawn in 1.20 ms`
        let words: Vec<&str> = line.split(' ').collect();
        let (frame, drawn): (&str, u32) = (words[2], words[3].parse().unwrap());
        assert_eq!(words[5], "401", "{said}");
        // The view holds the wall and 280 squares, of which it hides all but some 90: at least 6 columns of 14 stay in view.
        let most = if frame == "2:" { 150 } else { 281 };
        assert!((85..=most).contains(&drawn), "{said}");
    }
    assert_eq!(said.lines().count(), 6, "{said}");
}

#[test]
fn a_stage_of_ones_own_agrees_with_its_twin() {
    let said = run("own_stage");
    assert!(said.contains("example/count_covered"), "{said}");
    assert!(said.contains("pixels show something"), "{said}");
}
