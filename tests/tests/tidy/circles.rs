//! Modules side by side use each other in one direction: those of a room's `lib.rs`, and those of each folder below it.

use crate::{code_of, entries, extension, files_below, has_word, read, shown, stem, ROOMS};
use std::path::Path;

/// Modules side by side that use each other, straight or through others, by `crate::` or `super::`; tests may.
pub fn module_circles(root: &Path) -> Vec<String> {
    let mut faults = Vec::new();
    for room in ROOMS {
        let source = root.join(room).join("src");
        circles_in(root, &source, &[], &mut faults);
    }
    faults
}

/// The modules of a folder, which is the module `path` of the room; then of each folder in it.
fn circles_in(root: &Path, folder: &Path, path: &[String], faults: &mut Vec<String>) {
    let names = declared(folder);
    let mut open: Vec<(String, Vec<String>)> =
        names.iter().map(|module| (module.clone(), used_modules(folder, path, module, &names))).collect();
    // What uses nothing that is left, or is used by nothing that is left, is in no circle.
    loop {
        let before = open.len();
        let left: Vec<String> = open.iter().map(|(module, _)| module.clone()).collect();
        open.retain(|(_, used)| used.iter().any(|one| left.contains(one)));
        let used: Vec<String> = open.iter().flat_map(|(_, used)| used.clone()).collect();
        open.retain(|(module, _)| used.contains(module));
        if open.len() == before {
            break;
        }
    }
    if !open.is_empty() {
        let circle: Vec<String> = open.into_iter().map(|(module, _)| module).collect();
        let place = shown(root, folder);
        faults.push(format!("{place}: {} use each other; move what they share below them", circle.join(", ")));
    }
    for inner in entries(folder).into_iter().filter(|entry| entry.is_dir()) {
        let path: Vec<String> = path.iter().cloned().chain([stem(&inner).to_owned()]).collect();
        circles_in(root, &inner, &path, faults);
    }
}

/// What the `mod` lines of a folder's module name.
fn declared(folder: &Path) -> Vec<String> {
    let heads = [folder.join("lib.rs"), folder.join("mod.rs"), folder.with_extension("rs")];
    let heads: String = heads.iter().map(|head| read(head)).collect();
    let names = heads.lines().filter_map(|line| {
        let (before, name) = line.trim().split_once("mod ")?;
        (before.is_empty() || before.starts_with("pub")).then(|| name.strip_suffix(';'))?
    });
    names.filter(|name| *name != "tests").map(str::to_owned).collect()
}

/// Those of `names` that a module beside them uses; `path` is the module that holds them all.
pub fn used_modules(folder: &Path, path: &[String], module: &str, names: &[String]) -> Vec<String> {
    let from_root: String =
        ["crate"].into_iter().chain(path.iter().map(String::as_str)).map(|one| format!("{one}::")).collect();
    let own = folder.join(module);
    let files = files_below(&own).into_iter().chain([folder.join(format!("{module}.rs"))]);
    let mut used: Vec<&String> = Vec::new();
    for file in files.filter(|file| extension(file) == "rs") {
        let inside = file.strip_prefix(folder).unwrap_or(&file);
        let parts: Vec<&str> = inside.components().filter_map(|part| part.as_os_str().to_str()).collect();
        if parts.iter().any(|part| ["tests", "tests.rs"].contains(part)) {
            continue;
        }
        let code = code_of(read(&file).split("#[cfg(test)]\nmod tests {").next().unwrap_or(""));
        // From a file so deep, the way up to the folder; `mod.rs` is its folder's module.
        let ups = parts.len() - usize::from(parts.last() == Some(&"mod.rs"));
        let found = [paths_after(&code, &from_root), paths_after(&code, &"super::".repeat(ups))].concat();
        used.extend(names.iter().filter(|name| *name != module && found.iter().any(|path| has_word(path, name))));
    }
    names.iter().filter(|name| used.contains(name)).cloned().collect()
}

/// What follows a prefix of a path: the next name, or all names of a group.
fn paths_after<'a>(code: &'a str, prefix: &str) -> Vec<&'a str> {
    let joins = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    let places = code.match_indices(prefix).filter(|(at, _)| !code[..*at].chars().next_back().is_some_and(joins));
    let rest = places.map(|(at, _)| &code[at + prefix.len()..]);
    rest.map(|path| match path.strip_prefix('{') {
        Some(group) => group.split(';').next().unwrap_or(""),
        None => path.split(|letter: char| !(letter.is_alphanumeric() || letter == '_')).next().unwrap_or(""),
    })
    .collect()
}
