use super::*;
use std::fs;

/// A copy of the crate's sources that goes when the test ends.
struct Copied(PathBuf);

impl Copied {
    fn new(name: &str) -> Self {
        let root = std::env::temp_dir().join(format!("sightline-reload-{name}-{}", std::process::id()));
        for folder in ["glsl", "generated", "src"] {
            copy(&sources::crate_root().join(folder), &root.join(folder));
        }
        Copied(root)
    }

    /// Replaces the one place of `old` in a shader.
    fn edit(&self, file: &str, old: &str, new: &str) {
        let path = self.0.join("glsl").join(file);
        let text = fs::read_to_string(&path).unwrap();
        assert_eq!(text.matches(old).count(), 1, "{file}: {old}");
        fs::write(&path, text.replace(old, new)).unwrap();
    }
}

impl Drop for Copied {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        match entry.file_type().unwrap().is_dir() {
            true => copy(&entry.path(), &to.join(entry.file_name())),
            false => drop(fs::copy(entry.path(), to.join(entry.file_name())).unwrap()),
        }
    }
}

const ROWS: &str = "example/count_covered.comp";

#[test]
fn what_is_as_it_was_built_is_not_compiled_and_would_pass() {
    let copied = Copied::new("same");
    assert_eq!(Reloader::new(&copied.0).changed(), Ok(vec![]));
    // The text of every stage, formatted or not, is the one in `generated/`, and its SPIR-V what was built in.
    let mut stranger = Reloader::new(&copied.0);
    stranger.running.clear();
    let all = stranger.changed().unwrap();
    for shader in &all {
        let stage = crate::STAGES.iter().find(|stage| stage.name == shader.stage).unwrap();
        let module = stage.modules.iter().find(|module| module.kind == shader.kind).unwrap();
        let bytes: Vec<u8> = shader.words.iter().flat_map(|word| word.to_le_bytes()).collect();
        assert!(bytes == module.spirv, "{}", shader.stage);
    }
    assert_eq!(all.len(), crate::STAGES.iter().map(|stage| stage.modules.len()).sum::<usize>());
}

#[test]
fn an_edit_is_compiled_once_and_taken_back_once() {
    let copied = Copied::new("edit");
    let mut reloader = Reloader::new(&copied.0);
    copied.edit(ROWS, "> 0.0 ?", "<= 0.0 ?");
    let new = reloader.changed().unwrap();
    assert_eq!(new.iter().map(|shader| shader.stage.as_str()).collect::<Vec<_>>(), ["example/count_covered"]);
    assert_eq!(reloader.changed(), Ok(vec![]));
    copied.edit(ROWS, "<= 0.0 ?", "> 0.0 ?");
    assert_ne!(reloader.changed().unwrap(), new);
}

#[test]
fn an_edit_of_an_include_reaches_every_stage_that_includes_it() {
    let copied = Copied::new("include");
    copied.edit("include/grid.glsl", "#define invocation_index()", "// Changed.\n#define invocation_index()");
    let new = Reloader::new(&copied.0).changed().unwrap();
    for (stage, includes) in
        [("example/count_covered", true), ("hzb/reduce_depth", true), ("frustum/test_bounds", false)]
    {
        assert_eq!(new.iter().any(|shader| shader.stage == stage), includes, "{stage}");
    }
}

#[test]
fn an_error_names_file_and_line_and_is_found_again_until_it_is_mended() {
    let copied = Copied::new("error");
    let mut reloader = Reloader::new(&copied.0);
    copied.edit(ROWS, "uint count = 0u;", "uint count = nothing;");
    for _ in 0..2 {
        let errors = reloader.changed().unwrap_err();
        assert!(errors.len() == 1 && errors[0].contains("shaders/glsl/example/count_covered.comp:17"), "{errors:?}");
        assert!(errors[0].contains("nothing"), "{errors:?}");
    }
    copied.edit(ROWS, "uint count = nothing;", "uint count = 0u;");
    assert_eq!(reloader.changed(), Ok(vec![]));
}

#[test]
fn what_rust_has_built_in_cannot_change_while_it_runs() {
    for (file, old, new) in [
        (ROWS, "uvec2 size_px;", "uvec2 size_px; uint more;"),
        (ROWS, "local_size_x = 64", "local_size_x = 32"),
        (ROWS, "binding = 1", "binding = 2"),
        (ROWS, "writeonly buffer", "buffer"),
        ("include/types.glsl", "struct PyramidLevel {", "struct PyramidLevel { uint more;"),
    ] {
        let copied = Copied::new("contract");
        copied.edit(file, old, new);
        match Reloader::new(&copied.0).changed() {
            Ok(_) => panic!("{file}: {new} passed"),
            Err(errors) => assert!(errors.iter().any(|error| error.contains("cargo shaders")), "{errors:?}"),
        }
    }
}

#[test]
fn what_was_generated_since_the_program_was_built_is_noticed() {
    let copied = Copied::new("generated");
    copied.edit(ROWS, "> 0.0 ?", "<= 0.0 ?");
    fs::write(copied.0.join("generated/example.rs"), "another").unwrap();
    let errors = Reloader::new(&copied.0).changed().unwrap_err();
    assert!(errors[0].contains("generated/example.rs is not what the program was built with"), "{errors:?}");
}
