//! The key R: shaders as their sources are now, with the feature `hot-reload`.

use super::lab::{is_lost, Lab};
use anyhow::Result;
use shaders::reload::NewShader;

/// Findings of the compiler that the window has room for.
const FINDINGS: usize = 8;

/// What is compiled while the program runs.
#[derive(Default)]
pub struct HotShaders {
    compiler: Compiler,
    /// What runs in place of what was built in.
    replaced: Vec<NewShader>,
}

impl HotShaders {
    /// Puts what was replaced so far on a device that was just opened.
    pub fn put_on(&self, lab: &mut Lab) -> Result<()> {
        lab.replace_shaders(&self.replaced)
    }

    /// Compiles what changed and draws with it from now on. What came of it, to tell on the screen; with any error in a shader, the ones
    /// that run stay.
    ///
    /// # Errors
    /// Only of the device: a shader's errors are told.
    pub fn reload(&mut self, lab: &mut Lab) -> Result<String> {
        let mut compiler = self.compiler.clone();
        let new = match compiler.changed() {
            Ok(new) if new.is_empty() => return Ok("no shader changed".to_owned()),
            Ok(new) => new,
            Err(findings) => return Ok(told(&findings)),
        };
        match lab.replace_shaders(&new) {
            Err(error) if is_lost(&error) => Err(error),
            Err(error) => Ok(told(&[format!("{error:#}")])),
            Ok(()) => {
                self.compiler = compiler;
                let text = format!("reloaded {}", stages(&new).join(", "));
                let is_new = |old: &NewShader| new.iter().any(|new| (&new.stage, new.kind) == (&old.stage, old.kind));
                self.replaced.retain(|old| !is_new(old));
                self.replaced.extend(new);
                Ok(text)
            }
        }
    }
}

/// The stages of shaders, each once, in their order; of many, how many more there are.
fn stages(shaders: &[NewShader]) -> Vec<String> {
    let mut names: Vec<String> = shaders.iter().map(|shader| shader.stage.clone()).collect();
    names.dedup();
    shortened(names, "stages")
}

/// Findings as the window tells them.
fn told(findings: &[String]) -> String {
    let lines: Vec<String> = findings.iter().flat_map(|finding| finding.lines()).map(str::to_owned).collect();
    format!("the old shaders run on:\n{}", shortened(lines, "lines").join("\n"))
}

fn shortened(mut list: Vec<String>, what: &str) -> Vec<String> {
    let more = list.len().saturating_sub(FINDINGS);
    list.truncate(FINDINGS);
    list.extend((more > 0).then(|| format!("and {more} more {what}")));
    list
}

#[cfg(feature = "hot-reload")]
#[derive(Clone)]
struct Compiler(shaders::reload::Reloader);

#[cfg(feature = "hot-reload")]
impl Default for Compiler {
    fn default() -> Self {
        Compiler(shaders::reload::Reloader::new(shaders::sources::crate_root()))
    }
}

#[cfg(feature = "hot-reload")]
impl Compiler {
    fn changed(&mut self) -> Result<Vec<NewShader>, Vec<String>> {
        self.0.changed()
    }
}

/// A program without a shader compiler.
#[cfg(not(feature = "hot-reload"))]
#[derive(Clone, Default)]
struct Compiler;

#[cfg(not(feature = "hot-reload"))]
impl Compiler {
    fn changed(&mut self) -> Result<Vec<NewShader>, Vec<String>> {
        let remedy = "this program has no shader compiler: run `cargo run --release --features hot-reload -- view`";
        Err(vec![remedy.to_owned()])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shaders::ShaderKind;

    #[test]
    fn many_findings_and_stages_are_shortened_and_say_so() {
        let findings: Vec<String> = (0..20).map(|line| format!("file:{line}: wrong\nfile:{line}: here")).collect();
        let text = told(&findings);
        assert_eq!(text.lines().count(), 1 + FINDINGS + 1);
        assert!(text.starts_with("the old shaders run on:\nfile:0: wrong\n") && text.ends_with("and 32 more lines"));
        assert_eq!(told(&findings[..1]).lines().count(), 3);
    }

    #[test]
    fn a_stage_of_two_shaders_is_told_once() {
        let shader = |stage: &str, kind| NewShader { stage: stage.to_owned(), kind, words: Vec::new() };
        let new = [
            shader("draw/objects", ShaderKind::Vertex),
            shader("draw/objects", ShaderKind::Fragment),
            shader("hzb/test_bounds", ShaderKind::Compute),
        ];
        assert_eq!(stages(&new), ["draw/objects", "hzb/test_bounds"]);
    }
}
