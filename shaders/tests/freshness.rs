//! Holds `generated/` to its sources without a shader compiler: by hashes alone.

use shaders::{sources, STAGES};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const REMEDY: &str = "run `cargo shaders` and commit shaders/generated";

/// The lines of `HASHES` for one folder.
fn listed(folder: &str) -> BTreeMap<String, String> {
    let path = sources::crate_root().join("generated").join(sources::HASHES_FILE);
    let text = sources::read_text(&path).unwrap_or_else(|error| panic!("{error}: {REMEDY}"));
    let mut hashes = sources::parse_hashes(&text);
    hashes.retain(|path, _| path.starts_with(folder));
    hashes
}

/// The paths at which two lists differ.
fn differing(a: &BTreeMap<String, String>, b: &BTreeMap<String, String>) -> Vec<String> {
    let paths = a.keys().chain(b.keys());
    let mut paths: Vec<String> = paths.filter(|path| a.get(*path) != b.get(*path)).cloned().collect();
    paths.sort();
    paths.dedup();
    paths
}

#[test]
fn generated_files_are_made_from_these_sources() {
    let now = sources::source_hashes(sources::crate_root()).unwrap();
    let stale = differing(&now, &listed("glsl/"));
    assert!(
        stale.is_empty(),
        "changed since the last generation, or what they include did, or the generator: {stale:#?}\n{REMEDY}"
    );
}

#[test]
fn generated_files_are_untouched() {
    let now = sources::output_hashes(sources::crate_root()).unwrap();
    let touched = differing(&now, &listed("generated/"));
    assert!(touched.is_empty(), "edited by hand, missing or left over: {touched:#?}\n{REMEDY}");
}

#[test]
fn every_module_is_spirv() {
    for stage in STAGES {
        for module in stage.modules {
            let name = stage.name;
            assert_eq!(module.spirv.len() % 4, 0, "{name}: not in words");
            assert_eq!(module.spirv[..4], 0x0723_0203_u32.to_le_bytes(), "{name}: no SPIR-V magic number");
            assert_eq!(module.spirv[4..8], 0x0001_0600_u32.to_le_bytes(), "{name}: not SPIR-V 1.6");
        }
    }
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        match entry.path().is_dir() {
            true => copy_folder(&entry.path(), &to.join(entry.file_name())),
            false => drop(fs::copy(entry.path(), to.join(entry.file_name())).unwrap()),
        }
    }
}

/// A copy of what is hashed, in a folder of its own.
fn copied_crate(name: &str) -> PathBuf {
    let root = std::env::temp_dir().join(format!("sightline-{name}-{}", std::process::id()));
    let _ = fs::remove_dir_all(&root);
    copy_folder(&sources::crate_root().join("glsl"), &root.join("glsl"));
    copy_folder(&sources::crate_root().join("src"), &root.join("src"));
    root
}

/// The paths whose hashes change when a line is added to `file`.
fn changed_by_editing(name: &str, file: &str) -> Vec<String> {
    let root = copied_crate(name);
    let before = sources::source_hashes(&root).unwrap();
    let path = root.join(file);
    fs::write(&path, sources::read_text(&path).unwrap() + "// edited\n").unwrap();
    let after = sources::source_hashes(&root).unwrap();
    fs::remove_dir_all(&root).unwrap();
    differing(&before, &after)
}

#[test]
fn an_edited_shader_is_noticed() {
    assert_eq!(changed_by_editing("shader", "glsl/draw/objects.vert"), ["glsl/draw/objects.vert"]);
}

#[test]
fn an_edited_include_is_noticed_by_all_that_include_it() {
    let changed = changed_by_editing("include", "glsl/include/types.glsl");
    assert!(changed.contains(&"glsl/include/types.glsl".to_owned()));
    assert!(changed.contains(&"glsl/draw/objects.vert".to_owned()), "through transform.glsl: {changed:?}");
    assert!(!changed.contains(&"glsl/draw/objects.frag".to_owned()), "includes nothing: {changed:?}");
}

#[test]
fn an_edited_generator_is_noticed_by_every_shader() {
    let shaders = sources::list(sources::crate_root()).unwrap().len();
    for file in ["src/contract.rs", "src/generator/emit.rs", "src/bin/shader-compiler.rs"] {
        assert_eq!(changed_by_editing("generator", file).len(), shaders, "{file}");
    }
}

#[test]
fn a_stray_file_is_refused() {
    let root = copied_crate("stray");
    fs::write(root.join("glsl/draw/notes.txt"), "").unwrap();
    let error = sources::list(&root).unwrap_err().to_string();
    assert!(error.contains("notes.txt") && error.contains("VERB_NOUN"), "{error}");
    fs::remove_dir_all(&root).unwrap();
}
