//! The tidy laws can fail: a small workspace that keeps them all, and each fault planted in it alone.

use super::*;

/// A workspace of a few lines in a folder of its own, removed at the end.
struct Workspace(PathBuf);

impl Drop for Workspace {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

impl Workspace {
    fn tidy(test: &str) -> Self {
        let workspace = Self(std::env::temp_dir().join(format!("sightline-tidy-{test}-{}", std::process::id())));
        let _ = fs::remove_dir_all(&workspace.0);
        for room in ROOMS {
            workspace.write(&format!("{room}/README.md"), "What belongs here.");
            workspace.write(&format!("{room}/Cargo.toml"), "[dependencies]\nglam.workspace = true\n");
            workspace.write(&format!("{room}/src/lib.rs"), "//! A room. unsafe? no.\n");
        }
        workspace.write(".gitignore", "target/\n/out/\n");
        workspace.write("target/debug/x", "");
        workspace.write("engine/src/lib.rs", "mod raw;\n");
        workspace.write("engine/src/raw.rs", "unsafe fn raw() {}\n");
        workspace
            .write("shaders/glsl/hzb/test.comp", "// hzb/test. Twin:\n// culling/src/hzb/twin.rs.\n#version 460\n");
        workspace.write("shaders/glsl/draw/id.comp", "// draw/id. No twin: one store\n#version 460\n");
        workspace.write("culling/src/lib.rs", "pub mod hzb;\nmod methods;\nconst NO: &str = \"unsafe ash::\";\n");
        workspace.write("culling/src/hzb/mod.rs", "pub(crate) mod twin;\n");
        workspace.write("culling/src/hzb/twin.rs", "fn test() { sha::hash::<u8>() }\n");
        workspace.write("culling/src/methods.rs", "    Entry { id: \"hzb\" },\n    // Entry { id: \"gone\" },\n");
        workspace.write("culling/README.md", "| `hzb` |");
        workspace.write("tests/tests/method_hzb.rs", "");
        workspace.write(
            "culling/docs/hzb.md",
            "`hzb`: `hzb/test:late` (`a/b.rs`)\n```sh\n`no/stage`\n```\n![One](hzb.png)\n",
        );
        workspace.write("culling/docs/hzb.png", "");
        workspace
    }

    fn write(&self, path: &str, text: &str) {
        let path = self.0.join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn remove(&self, path: &str) {
        fs::remove_file(self.0.join(path)).unwrap();
    }

    fn all_faults(&self) -> Vec<String> {
        let laws = [
            too_long,
            stages_without_twin,
            methods_apart,
            strangers_at_the_top,
            rooms_without_readme,
            dead_files,
            forbidden_edges,
            unsafe_outside_the_engine,
            circles::module_circles,
            guides::guides_apart,
        ];
        laws.iter().flat_map(|law| law(&self.0)).collect()
    }
}

/// Plants one fault: exactly one line must come, and it must name the place.
fn planted(test: &str, expected: &str, plant: impl FnOnce(&Workspace)) {
    let workspace = Workspace::tidy(test);
    assert_eq!(workspace.all_faults(), Vec::<String>::new(), "before planting {test}");
    plant(&workspace);
    let faults = workspace.all_faults();
    assert!(faults.len() == 1 && faults[0].contains(expected), "{test}: {faults:?}");
}

#[test]
fn long_files_are_caught() {
    planted("long", "scenes/src/lib.rs: 401 lines", |w| w.write("scenes/src/lib.rs", &"\n".repeat(401)));
    planted("long-shader", "hzb/a.glsl: 401 lines", |w| w.write("shaders/glsl/hzb/a.glsl", &"\n".repeat(401)));
    planted("generated", "shaders/src/lib.rs", |w| {
        w.write("shaders/generated/mod.rs", &"\n".repeat(401));
        w.write("shaders/src/lib.rs", &"\n".repeat(401));
    });
}

#[test]
fn missing_twins_are_caught() {
    let shader = "shaders/glsl/hzb/test.comp";
    planted("no-word", "neither", |w| w.write(shader, "// hzb/test\n#version 460\n// Twin: culling/src/hzb/twin.rs\n"));
    planted("no-file", "does not exist", |w| w.write(shader, "// Twin: culling/src/hzb/twins.rs\n"));
    planted("no-function", "has no `fn test`", |w| w.write("culling/src/hzb/twin.rs", "fn test_all() {}\n"));
    planted("no-reason", "without a reason", |w| w.write(shader, "// No twin:\n#version 460\n"));
}

#[test]
fn methods_without_test_or_docs_are_caught() {
    planted("no-test", "write tests/tests/method_hzb.rs", |w| w.remove("tests/tests/method_hzb.rs"));
    planted("no-docs", "not named in culling/README.md", |w| w.write("culling/README.md", "hzb"));
    planted("no-method", "method_old.rs: culling/src/methods.rs has no", |w| w.write("tests/tests/method_old.rs", ""));
    assert_eq!(test_of("chc++"), "method_chcpp");
    assert_eq!(test_of("query-lag"), "method_query_lag");
    let empty = Workspace::tidy("no-registry");
    empty.write("culling/src/methods.rs", "");
    assert!(methods_apart(&empty.0)[0].contains("no method found"));
}

#[test]
fn guides_that_tell_of_what_is_not_there_are_caught() {
    let guide = |text: &'static str| move |w: &Workspace| w.write("culling/docs/hzb.md", text);
    planted("no-guide", "method `hzb` is in no guide", guide("hzb ![One](hzb.png)"));
    planted("no-stage", "hzb.md: there is no stage `hzb/tests`", guide("`hzb` `hzb/tests:late` ![One](hzb.png)"));
    planted("no-picture", "hzb.md: there is no picture two.png", guide("`hzb` ![One](hzb.png) ![Two](two.png)"));
    planted("no-use", "hzb.png: no guide shows it", guide("`hzb` (hzb.png)"));
}

#[test]
fn strangers_and_empty_rooms_are_caught() {
    planted("stranger", "docs: does not belong", |w| w.write("docs/a.md", ""));
    planted("stranger-file", "notes.txt: does not belong", |w| w.write("notes.txt", ""));
    planted("no-readme", "tools/README.md", |w| w.write("tools/README.md", "\n"));
}

#[test]
fn dead_files_are_caught() {
    planted("dead", "scenes/src/old.rs: no `mod`", |w| w.write("scenes/src/old.rs", ""));
    planted("dead-folder", "culling/src/roc/mod.rs: no `mod`", |w| w.write("culling/src/roc/mod.rs", ""));
    planted("dead-comment", "engine/src/raw.rs", |w| w.write("engine/src/lib.rs", "// mod raw;\n"));
    planted("dead-suffix", "engine/src/raw.rs", |w| w.write("engine/src/lib.rs", "mod straw;\n"));
    let alive = Workspace::tidy("alive");
    alive.write("scenes/src/lib.rs", "#[path = \"odd/name.rs\"]\nmod other;\nmod path;\n");
    alive.write("scenes/src/odd/name.rs", "");
    alive.write("scenes/src/path.rs", "pub(super) mod way;\n");
    alive.write("scenes/src/path/way.rs", "");
    alive.write("scenes/src/bin/export.rs", "");
    assert_eq!(alive.all_faults(), Vec::<String>::new());
}

#[test]
fn forbidden_edges_are_caught() {
    let uses = |w: &Workspace, room: &str, line: &str| w.write(&format!("{room}/Cargo.toml"), line);
    planted("edge", "engine must not know scenes", |w| uses(w, "engine", "[dependencies]\nscenes.workspace = true\n"));
    planted("edge-dev", "scenes must not know engine", |w| uses(w, "scenes", "[dev-dependencies]\nengine = \"1\"\n"));
    planted("edge-table", "shaders must not know culling", |w| {
        uses(w, "shaders", "[dependencies.culling]\nversion = \"1\"\n");
    });
    planted("edge-renamed", "scenes must not know engine", |w| {
        uses(w, "scenes", "[dependencies]\ngpu = { package = \"sightline-engine\", path = \"..\" }\n");
    });
    planted("edge-ash", "twin.rs: calls ash", |w| w.write("culling/src/hzb/twin.rs", "fn test() { ash::x() }\n"));
    planted("edge-use", "methods.rs: calls ash", |w| {
        w.write("culling/src/methods.rs", "use ash;\nEntry { id: \"hzb\" }\n");
    });
}

#[test]
fn unsafe_code_is_caught() {
    planted("unsafe", "tools/src/lib.rs: `unsafe`", |w| w.write("tools/src/lib.rs", "unsafe impl Send for X {}\n"));
    planted("unsafe-block", "scenes/src/lib.rs", |w| {
        w.write("scenes/src/lib.rs", "let x = \"\\\"\" + unsafe { y };\n")
    });
    let lint = Workspace::tidy("unsafe-lint");
    lint.write("tools/src/lib.rs", "#![forbid(unsafe_code)] // no unsafe\n");
    assert_eq!(lint.all_faults(), Vec::<String>::new());
}

#[test]
fn circles_of_modules_are_caught() {
    let modules = |w: &Workspace, a: &str, b: &str, c: &str| {
        w.write("scenes/src/lib.rs", "pub mod a;\nmod b;\nmod c;\n");
        w.write("scenes/src/a.rs", a);
        w.write("scenes/src/b.rs", b);
        w.write("scenes/src/c/mod.rs", c);
    };
    planted("circle", "scenes/src: a, b use each other", |w| {
        modules(w, "use crate::b::X;\n", "use crate::{a, y};\n", "")
    });
    planted("long-circle", "a, b, c use each other", |w| {
        modules(w, "use crate::b::X;\n", "fn f() { crate::c::g() }\n", "use crate::a;\n");
    });
    let below = |w: &Workspace, a: &str, b: &str| {
        w.write("scenes/src/lib.rs", "mod f;\n");
        w.write("scenes/src/f/mod.rs", "pub mod a;\nmod b;\n");
        w.write("scenes/src/f/a/mod.rs", "mod deep;\n");
        w.write("scenes/src/f/a/deep.rs", a);
        w.write("scenes/src/f/b.rs", b);
    };
    planted("circle-below", "scenes/src/f: a, b use each other", |w| {
        below(w, "use super::super::b::X;\n", "use super::{a, y};\n")
    });
    planted("circle-by-names", "scenes/src/f: a, b use each other", |w| {
        below(w, "use crate::f::b::X;\n", "use crate::f::a;\n")
    });
    let straight = Workspace::tidy("no-circle-below");
    below(&straight, "use super::b::X;\n", "use super::a;\n");
    assert_eq!(straight.all_faults(), Vec::<String>::new(), "a's own module b is another");
    let straight = Workspace::tidy("no-circle");
    let tests = "#[cfg(test)]\nmod tests {\n    use crate::a;\n}\n";
    modules(&straight, "use crate::b::c;\nuse crate::c;\n", tests, "// crate::a\nuse crate::b::X;\n");
    assert_eq!(straight.all_faults(), Vec::<String>::new());
}

/// The law once looked at no file here: the path to this workspace has a folder `tests` in it.
#[test]
fn the_law_of_circles_sees_this_workspace() {
    let names = ["gpu", "memory"].map(str::to_owned);
    assert_eq!(circles::used_modules(&root().join("engine/src"), &[], "frame", &names), ["gpu"]);
}
