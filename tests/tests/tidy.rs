//! The laws that no compiler holds: what is where, what belongs together, and what must not exist.
//!
//! Each law is a function from the workspace's folder to its faults, one line each that names file and remedy;
//! `tidy/planted.rs` plants each fault in a small workspace and sees it caught.

use std::fs;
use std::path::{Path, PathBuf};

#[path = "tidy/circles.rs"]
mod circles;
#[path = "tidy/guides.rs"]
mod guides;
#[path = "tidy/planted.rs"]
mod planted;

const ROOMS: [&str; 6] = ["engine", "shaders", "culling", "scenes", "tests", "tools"];
const FILES: [&str; 5] = ["Cargo.toml", "Cargo.lock", "README.md", "LICENSE", "CHANGELOG.md"];
const LONGEST_FILE: usize = 400;
/// The rooms that a room's manifest must not name, by the keys and packages they have in `Cargo.toml`.
const FORBIDDEN_EDGES: [(&str, &[&str]); 4] = [
    ("shaders", &["engine", "scenes", "culling", "sightline"]),
    ("engine", &["scenes", "culling", "sightline"]),
    ("scenes", &["engine", "shaders", "culling", "sightline", "ash"]),
    ("culling", &["ash", "sightline"]),
];

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn assert_none(faults: Vec<String>) {
    assert!(faults.is_empty(), "\n{}\n", faults.join("\n"));
}

#[test]
fn no_source_file_is_too_long() {
    assert_none(too_long(root()));
}

#[test]
fn every_stage_has_a_twin_or_says_why_not() {
    assert_none(stages_without_twin(root()));
}

#[test]
fn every_method_has_a_test_and_a_place_in_the_docs() {
    assert_none(methods_apart(root()));
}

#[test]
fn guides_tell_of_every_method_and_of_stages_that_there_are() {
    assert_none(guides::guides_apart(root()));
}

#[test]
fn the_top_level_holds_only_the_rooms() {
    assert_none(strangers_at_the_top(root()));
}

#[test]
fn every_room_has_a_readme() {
    assert_none(rooms_without_readme(root()));
}

#[test]
fn no_source_file_is_dead() {
    assert_none(dead_files(root()));
}

#[test]
fn rooms_know_only_what_they_may() {
    assert_none(forbidden_edges(root()));
}

#[test]
fn unsafe_code_is_only_in_the_engine() {
    assert_none(unsafe_outside_the_engine(root()));
}

#[test]
fn modules_use_each_other_in_one_direction() {
    assert_none(circles::module_circles(root()));
}

fn too_long(root: &Path) -> Vec<String> {
    let files = ROOMS.iter().flat_map(|room| files_below(&root.join(room)));
    let sources = files.filter(|file| matches!(extension(file), "rs" | "glsl" | "comp" | "vert" | "frag"));
    let written = sources.filter(|file| !file.components().any(|part| part.as_os_str() == "generated"));
    let lengths = written.map(|file| (read(&file).lines().count(), file));
    let long = lengths.filter(|(lines, _)| *lines > LONGEST_FILE);
    long.map(|(lines, file)| format!("{}: {lines} lines; split it ({LONGEST_FILE} at most)", shown(root, &file)))
        .collect()
}

/// The head comment of a compute shader says `Twin: PATH`, and that file has a function named like the shader; or it says
/// `No twin: ` and why.
fn stages_without_twin(root: &Path) -> Vec<String> {
    let shaders = files_below(&root.join("shaders/glsl")).into_iter().filter(|file| extension(file) == "comp");
    shaders
        .filter_map(|shader| {
            let fault = twin_fault(root, &head_comment(&read(&shader)), stem(&shader))?;
            Some(format!("{}: {fault}", shown(root, &shader)))
        })
        .collect()
}

fn twin_fault(root: &Path, head: &str, stem: &str) -> Option<String> {
    if let Some((_, reason)) = head.split_once("No twin:") {
        let silent = reason.trim().is_empty();
        return silent.then(|| "says `No twin:` without a reason".to_string());
    }
    let Some((_, after)) = head.split_once("Twin:") else {
        return Some("its head comment says neither `Twin: PATH` nor `No twin: REASON`".to_string());
    };
    let path = after.split_whitespace().next().unwrap_or("").trim_end_matches(['.', ',', ';', ')']);
    let function = format!("fn {stem}");
    match fs::read_to_string(root.join(path)) {
        Err(_) => Some(format!("its twin `{path}` does not exist")),
        Ok(twin) if !has_word(&twin, &function) => Some(format!("its twin `{path}` has no `{function}`")),
        Ok(_) => None,
    }
}

/// The comment lines before the first line of code, joined by blanks.
fn head_comment(shader: &str) -> String {
    let lines = shader.lines().map(str::trim);
    let lines = lines.take_while(|line| line.is_empty() || line.starts_with("//"));
    lines.map(|line| line.trim_start_matches('/').trim()).collect::<Vec<_>>().join(" ")
}

/// Each `Entry { id: "…"` of `culling/src/methods.rs` has `tests/tests/method_ID.rs` and is named in `culling/README.md`;
/// each such test has a method.
fn methods_apart(root: &Path) -> Vec<String> {
    let ids = method_ids(&read(&root.join("culling/src/methods.rs")));
    if ids.is_empty() {
        return vec!["culling/src/methods.rs: no method found; the registry's lines read `id: \"NAME\"`".to_string()];
    }
    let docs = read(&root.join("culling/README.md"));
    let mut faults = Vec::new();
    for id in &ids {
        let test = format!("tests/tests/{}.rs", test_of(id));
        if !root.join(&test).is_file() {
            faults.push(format!("method `{id}` has no test: write {test}"));
        }
        if !docs.contains(&format!("`{id}`")) {
            faults.push(format!("method `{id}` is not named in culling/README.md: add its row"));
        }
    }
    let tests = files_below(&root.join("tests/tests"));
    let tests = tests.iter().map(|test| stem(test)).filter(|test| test.starts_with("method_"));
    for test in tests.filter(|test| !ids.iter().any(|id| test_of(id) == *test)) {
        faults.push(format!("tests/tests/{test}.rs: culling/src/methods.rs has no such method"));
    }
    faults
}

fn method_ids(registry: &str) -> Vec<String> {
    let code = registry.lines().filter(|line| !line.trim_start().starts_with("//"));
    let after_key = code.flat_map(|line| line.split("id: \"").skip(1));
    after_key.filter_map(|rest| rest.split_once('"')).map(|(id, _)| id.to_string()).collect()
}

/// `chc++` is tested by `method_chcpp`, `query-lag` by `method_query_lag`.
fn test_of(id: &str) -> String {
    format!("method_{}", id.replace('-', "_").replace('+', "p"))
}

/// Dot files and what `.gitignore` names may be there as well.
fn strangers_at_the_top(root: &Path) -> Vec<String> {
    let ignored = read(&root.join(".gitignore"));
    let allowed = |name: &str| {
        let is_ignored = ignored.lines().any(|line| line.trim().trim_matches('/') == name);
        name.starts_with('.') || ROOMS.contains(&name) || FILES.contains(&name) || is_ignored
    };
    let names = entries(root).into_iter().map(|path| file_name(&path).to_string());
    names.filter(|name| !allowed(name)).map(|name| format!("{name}: does not belong at the top level")).collect()
}

fn rooms_without_readme(root: &Path) -> Vec<String> {
    let readmes = ROOMS.iter().map(|room| format!("{room}/README.md"));
    readmes
        .filter(|readme| read(&root.join(readme)).trim().is_empty())
        .map(|readme| format!("{readme}: say what belongs in the room, what never does, and how to add one more"))
        .collect()
}

/// A file below `src/` that no `mod` line names is compiled by nobody.
fn dead_files(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for room in ROOMS {
        let manifest = read(&root.join(room).join("Cargo.toml"));
        let source = root.join(room).join("src");
        let files: Vec<_> = files_below(&source).into_iter().filter(|file| extension(file) == "rs").collect();
        for file in &files {
            let inside = shown(&root.join(room), file);
            let is_root = inside == "src/lib.rs" || inside == "src/main.rs" || inside.starts_with("src/bin/");
            let in_manifest = manifest.contains(&format!("\"{inside}\""));
            if !(is_root || in_manifest || is_named_by_a_mod(file, &files)) {
                faults.push(format!("{}: no `mod` names it; delete it or use it", shown(root, file)));
            }
        }
    }
    faults
}

fn is_named_by_a_mod(file: &Path, files: &[PathBuf]) -> bool {
    // A folder's `mod.rs` is the module of that name, one folder up.
    let module = if stem(file) == "mod" { file.parent().unwrap_or(file) } else { file };
    let folder = module.parent().unwrap_or(module);
    let parents = [folder.join("mod.rs"), folder.join("lib.rs"), folder.join("main.rs"), folder.with_extension("rs")];
    let declaration = format!("mod {};", stem(module));
    let declares = |text: &str| {
        text.lines().any(|line| {
            line.trim_start().split_once("mod ").is_some_and(|(before, _)| {
                (before.is_empty() || before.starts_with("pub")) && line.trim_end().ends_with(&declaration)
            })
        })
    };
    let by_path = format!("{}\"]", file_name(file));
    parents.iter().any(|parent| parent != file && declares(&read(parent)))
        || files.iter().any(|other| read(other).lines().any(|line| line.contains("#[path") && line.contains(&by_path)))
}

fn forbidden_edges(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for (room, forbidden) in FORBIDDEN_EDGES {
        for dependency in dependencies(&read(&root.join(room).join("Cargo.toml"))) {
            let plain = dependency.strip_prefix("sightline-").unwrap_or(&dependency);
            if forbidden.contains(&plain) {
                faults.push(format!("{room}/Cargo.toml: {room} must not know {plain}"));
            }
        }
    }
    for file in files_below(&root.join("culling")).iter().filter(|file| extension(file) == "rs") {
        if has_word(&code_of(&read(file)), "ash") {
            faults.push(format!("{}: calls ash; ask the engine instead", shown(root, file)));
        }
    }
    faults
}

/// The names in all sections of dependencies, and the packages that renamed ones stand for.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut inside = false;
    for line in manifest.lines().map(str::trim) {
        if let Some(section) = line.strip_prefix('[') {
            let section = section.trim_end_matches(']');
            inside = section.ends_with("dependencies");
            // [dependencies.NAME]
            names.extend(section.split_once("dependencies.").map(|(_, name)| name.to_string()));
        } else if inside && !line.starts_with('#') {
            names.extend(line.split(['.', '=', ' ']).next().filter(|name| !name.is_empty()).map(str::to_string));
        }
        let package = line.split_once("package = \"").and_then(|(_, rest)| rest.split_once('"'));
        names.extend(package.filter(|_| inside).map(|(name, _)| name.to_string()));
    }
    names
}

fn unsafe_outside_the_engine(root: &Path) -> Vec<String> {
    let rooms = ROOMS.iter().filter(|room| **room != "engine");
    let files = rooms.flat_map(|room| files_below(&root.join(room))).filter(|file| extension(file) == "rs");
    let found = files.filter(|file| has_word(&code_of(&read(file)), "unsafe"));
    found.map(|file| format!("{}: `unsafe` belongs in engine/ only", shown(root, &file))).collect()
}

/// A Rust text without line comments and the insides of strings that end on their line.
fn code_of(text: &str) -> String {
    let mut code = String::with_capacity(text.len());
    for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
        let line = line.replace("\\\\", "").replace("\\\"", "").replace("'\"'", "");
        let outside = line.split('"').step_by(2).collect::<Vec<_>>().join("\"");
        code.push_str(outside.split("//").next().unwrap_or(""));
        code.push('\n');
    }
    code
}

/// Is the word there with no letter, digit or underscore next to it?
fn has_word(text: &str, word: &str) -> bool {
    let joins = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.match_indices(word).any(|(at, _)| {
        !text[..at].chars().next_back().is_some_and(joins) && !text[at + word.len()..].chars().next().is_some_and(joins)
    })
}

/// All files below a folder in the order of their names, without what builds left there.
fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for path in entries(folder) {
        if !path.is_dir() {
            files.push(path);
        } else if file_name(&path) != "target" && !file_name(&path).starts_with('.') {
            files.extend(files_below(&path));
        }
    }
    files
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries =
        fs::read_dir(folder).map(|entries| entries.filter_map(Result::ok).map(|entry| entry.path()).collect());
    let mut entries: Vec<PathBuf> = entries.unwrap_or_default();
    entries.sort();
    entries
}

/// Empty if there is no such file: whoever needs it reports what is missing in it.
fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_default()
}

fn extension(path: &Path) -> &str {
    path.extension().and_then(|name| name.to_str()).unwrap_or("")
}

fn stem(path: &Path) -> &str {
    path.file_stem().and_then(|name| name.to_str()).unwrap_or("")
}

fn file_name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or("")
}

fn shown(root: &Path, path: &Path) -> String {
    path.strip_prefix(root).unwrap_or(path).display().to_string().replace('\\', "/")
}
