//! The guides in `culling/docs` tell of every method, and of nothing that is not there.

use super::*;

/// Every method is named in a guide; guides name stages that there are, and show pictures that there are; each picture is shown.
pub fn guides_apart(root: &Path) -> Vec<String> {
    let files = files_below(&root.join("culling/docs"));
    let (guides, pictures): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| extension(file) == "md");
    let texts: Vec<(String, String)> = guides.iter().map(|guide| (shown(root, guide), read(guide))).collect();
    let mut faults = Vec::new();
    for id in method_ids(&read(&root.join("culling/src/methods.rs"))) {
        if !texts.iter().any(|(_, text)| text.contains(&format!("`{id}`"))) {
            faults.push(format!("method `{id}` is in no guide: write one in culling/docs"));
        }
    }
    let sources = ["culling/src", "engine/src"].iter().flat_map(|room| files_below(&root.join(room)));
    let code: String = sources.filter(|file| extension(file) == "rs").map(|file| read(&file)).collect();
    let shaders: Vec<String> = files_below(&root.join("shaders/glsl")).iter().map(|file| shown(root, file)).collect();
    for (guide, text) in &texts {
        for stage in stages_in(text) {
            let is_shader = shaders.iter().any(|file| file.starts_with(&format!("shaders/glsl/{stage}.")));
            if !is_shader && !code.contains(&format!("\"{stage}\"")) {
                faults.push(format!("{guide}: there is no stage `{stage}`"));
            }
        }
        for picture in pictures_in(text) {
            if !root.join("culling/docs").join(picture).is_file() {
                faults.push(format!("{guide}: there is no picture {picture}"));
            }
        }
    }
    let is_shown =
        |picture: &PathBuf| texts.iter().any(|(_, text)| pictures_in(text).any(|name| name == file_name(picture)));
    let unused = pictures.iter().filter(|picture| !is_shown(picture));
    faults.extend(unused.map(|picture| format!("{}: no guide shows it", shown(root, picture))));
    faults
}

/// What stands between backticks and looks like a stage, without the part of the frame.
fn stages_in(text: &str) -> impl Iterator<Item = &str> {
    let prose = text.split("```").step_by(2);
    let quoted = prose.flat_map(|prose| prose.split('`').skip(1).step_by(2));
    quoted.map(|name| name.split(':').next().unwrap_or("")).filter(|name| {
        let is_word =
            |word: &str| !word.is_empty() && word.chars().all(|letter| letter.is_ascii_lowercase() || letter == '_');
        name.split_once('/').is_some_and(|(family, stem)| is_word(family) && is_word(stem))
    })
}

/// The files that Markdown images name.
fn pictures_in(text: &str) -> impl Iterator<Item = &str> {
    let images = text.split("![").skip(1);
    images.filter_map(|image| image.split_once("](")?.1.split_once(')')).map(|(file, _)| file)
}
