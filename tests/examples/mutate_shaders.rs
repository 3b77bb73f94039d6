//! Turns comparisons and offsets in GLSL, one at a time, and runs the tests of the shader's family on each mutant.
//!
//! `tools/mutate.sh --glsl [FILE...]` calls it; FILE is a path inside `shaders/glsl`, such as `hzb/test_bounds.comp` or
//! `include/footprint.glsl`, and all shaders if none is given. `SIGHTLINE_MUTANTS=K/N` takes one mutant in N, from the K-th on (0 is the first).
//! Needs `glslangValidator`. Nothing is written into the repository: tests read the mutants' SPIR-V from a temporary folder.
//!
//! 1. Find the operators of the file's code, and the opposite of each.
//! 2. For each mutant, compile every shader that the file is part of. Leave out mutants that do not compile or compile to the same bytes.
//! 3. Run the family's tests with these shaders in place of those built in. A mutant is caught if a test fails or does not end.

use anyhow::{bail, ensure, Context, Result};
use harness::replaced;
use shaders::sources::{self, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The tests of each family of shaders: the name of a file in `tests/tests`, and a part of the names of the tests to run, or "" for all.
/// They run in this order until one fails.
const TESTS: [(&str, &[(&str, &str)]); 16] = [
    ("draw", &[("golden", ""), ("materials", "")]),
    ("engine", &[("without", "twin"), ("engine", ""), ("samples", ""), ("depth_formats", "")]),
    ("eovc", &[("stages", "twin"), ("work", "recorded"), ("method_eovc", "")]),
    ("example", &[("engine", "")]),
    ("farthest", &[("method_hom", "")]),
    ("flares", &[("flares", "")]),
    ("frustum", &[("method_frustum", "twin"), ("work", "recorded"), ("method_frustum", "")]),
    (
        "hzb",
        &[
            ("method_hzb", "twin"),
            ("method_hzb_iterative", "twin"),
            ("work", "recorded"),
            ("method_hzb", ""),
            ("method_hzb_iterative", ""),
        ],
    ),
    ("pack", &[("stages", "twin")]),
    ("queries", &[("work", "recorded"), ("method_query_wait", "")]),
    ("roc", &[("method_roc_iterative", "twin"), ("stages", "twin"), ("work", "recorded"), ("method_roc", "")]),
    ("seeds", &[("work", "recorded"), ("method_hzb_iterative", "")]),
    ("translucent", &[("materials", "")]),
    ("warp", &[("warp", "")]),
    ("woc", &[("method_woc", "twin"), ("work", "recorded"), ("method_woc", "")]),
    ("world", &[("stages", "twin"), ("skins", "")]),
];

/// Operators and their mutations. Longer operators come first, so that `<=` is not read as `<`.
const OPERATORS: [(&str, &str); 12] = [
    (" <= ", " < "),
    (" >= ", " > "),
    (" < ", " <= "),
    (" > ", " >= "),
    (" == ", " != "),
    (" != ", " == "),
    (" && ", " || "),
    (" || ", " && "),
    (" + ", " - "),
    (" - ", " + "),
    ("min(", "max("),
    ("max(", "min("),
];

/// Seconds until a test file that has not ended counts as failed; the longest takes a minute on two cores.
const LIMIT_S: &str = "240";

/// One changed operator in a file.
struct Mutant {
    /// A line for the report: file, line, the operator and its mutation.
    name: String,
    /// The whole text of the changed file.
    text: String,
}

/// The folder of the GLSL, a temporary folder, and the program of each test file by its name.
struct Lab {
    glsl: PathBuf,
    folder: PathBuf,
    programs: BTreeMap<String, PathBuf>,
}

fn main() -> Result<()> {
    let wanted: Vec<String> = env::args().skip(1).collect();
    let glsl = sources::crate_root().join("glsl");
    let folder = env::temp_dir().join(format!("sightline-mutants-{}", std::process::id()));
    let lab = Lab { glsl, folder, programs: programs()? };
    let all = sources::list(sources::crate_root())?;
    let files = if wanted.is_empty() { all.iter().map(Source::file).collect() } else { wanted };
    let [first, step] = share()?;

    let (mut caught, mut missed, mut same) = (0, Vec::new(), 0);
    let mut seen = 0;
    for file in &files {
        let text = fs::read_to_string(lab.glsl.join(file)).with_context(|| file.clone())?;
        let users = users_of(file, &all)?;
        ensure!(!users.is_empty(), "{file}: no shader includes it");
        let original = lab.compile(&users, file, &text)?.with_context(|| format!("{file} does not compile"))?;
        ensure!(lab.passes(&users, &original)?, "{file}: its tests fail without a mutation");
        for mutant in mutants(file, &text) {
            seen += 1;
            if (seen - 1) % step != first {
                continue;
            }
            match lab.compile(&users, file, &mutant.text)? {
                Some(compiled) if compiled != original => {
                    if lab.passes(&users, &compiled)? {
                        println!("MISSED {}", mutant.name);
                        missed.push(mutant.name);
                    } else {
                        println!("caught {}", mutant.name);
                        caught += 1;
                    }
                }
                _ => same += 1,
            }
        }
    }
    let _ = fs::remove_dir_all(&lab.folder);
    println!("{caught} caught, {} missed, {same} that do not compile or compile to the same", missed.len());
    Ok(())
}

/// The share of the mutants to try: the first one's number, and the step to the next.
fn share() -> Result<[usize; 2]> {
    let Ok(text) = env::var("SIGHTLINE_MUTANTS") else { return Ok([0, 1]) };
    let numbers = text.split_once('/').and_then(|(k, n)| Some([k.parse().ok()?, n.parse().ok()?]));
    match numbers {
        Some([k, n]) if k < n => Ok([k, n]),
        _ => bail!("SIGHTLINE_MUTANTS={text}: write K/N with K below N, such as 0/8"),
    }
}

/// Builds the tests and returns the program of each file.
fn programs() -> Result<BTreeMap<String, PathBuf>> {
    let mut cargo = Command::new("cargo");
    cargo.args(["test", "--package", "sightline-tests", "--no-run", "--message-format=json-render-diagnostics"]);
    let output = cargo.stderr(Stdio::inherit()).output().context("cargo")?;
    ensure!(output.status.success(), "the tests do not build");
    let mut found = BTreeMap::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let message: serde_json::Value = serde_json::from_str(line)?;
        if let (Some(name), Some(program)) = (message["target"]["name"].as_str(), message["executable"].as_str()) {
            if message["target"]["kind"][0] == "test" {
                found.insert(name.to_owned(), PathBuf::from(program));
            }
        }
    }
    Ok(found)
}

/// The shaders that a file is part of: the one that it is, or all that include it.
fn users_of(file: &str, all: &[Source]) -> Result<Vec<Source>> {
    let mut users = Vec::new();
    for source in all {
        let text = fs::read_to_string(sources::crate_root().join("glsl").join(source.file()))?;
        let included = sources::included_by(sources::crate_root(), &text)?;
        if source.file() == file || included.iter().any(|name| file == format!("include/{name}")) {
            users.push(source.clone());
        }
    }
    Ok(users)
}

/// All mutants of a text. Comments, preprocessor lines and layouts are left as they are.
fn mutants(file: &str, text: &str) -> Vec<Mutant> {
    let mut found = Vec::new();
    let mut line_start = 0;
    for (number, line) in text.lines().enumerate() {
        let code = line.split("//").next().unwrap_or(line);
        if !code.starts_with('#') && !code.starts_with("layout") {
            for (at, operator, mutation) in operators(code) {
                let mut changed = text.to_owned();
                changed.replace_range(line_start + at..line_start + at + operator.len(), mutation);
                let name = format!(
                    "{file}:{}: '{}' becomes '{}' at column {}",
                    number + 1,
                    operator.trim(),
                    mutation.trim(),
                    at + 1
                );
                found.push(Mutant { name, text: changed });
            }
        }
        line_start += line.len() + 1;
    }
    found
}

/// Where operators stand in a line, each with its mutation.
fn operators(code: &str) -> Vec<(usize, &'static str, &'static str)> {
    let mut found = Vec::new();
    for at in (0..code.len()).filter(|&at| code.is_char_boundary(at)) {
        if let Some((operator, mutation)) = OPERATORS.iter().find(|(operator, _)| code[at..].starts_with(operator)) {
            found.push((at, *operator, *mutation));
        }
    }
    found
}

impl Lab {
    /// Compiles `users` with `text` in place of `file`, and returns the SPIR-V of each; none if one does not compile.
    fn compile(&self, users: &[Source], file: &str, text: &str) -> Result<Option<Vec<Vec<u8>>>> {
        // The changed file shadows the one of the repository: its folder is searched first.
        let changed = self.folder.join(file);
        let _ = fs::remove_dir_all(&self.folder);
        fs::create_dir_all(changed.parent().context("a file has a folder")?)?;
        fs::write(&changed, text)?;
        let mut compiled = Vec::new();
        for user in users {
            let source = if user.file() == file { changed.clone() } else { self.glsl.join(user.file()) };
            let out = self.folder.join("out.spv");
            let mut compiler = Command::new("glslangValidator");
            compiler.args(["--target-env", "vulkan1.3", "-V"]);
            for folder in [self.folder.join("include"), self.glsl.join("include")] {
                compiler.arg(format!("-I{}", folder.display()));
            }
            let output = compiler.arg("-o").arg(&out).arg(&source).output();
            let output = output.context("glslangValidator (Debian's package glslang-tools)")?;
            if !output.status.success() {
                return Ok(None);
            }
            compiled.push(fs::read(&out)?);
        }
        Ok(Some(compiled))
    }

    /// True if all tests of the families of `users` pass with these shaders.
    fn passes(&self, users: &[Source], compiled: &[Vec<u8>]) -> Result<bool> {
        let mut entries = Vec::new();
        for (index, (user, spirv)) in users.iter().zip(compiled).enumerate() {
            let path = self.folder.join(format!("{index}.spv"));
            fs::write(&path, spirv)?;
            entries.push(format!("{}={}", user.file(), path.display()));
        }
        let families: BTreeSet<&str> = users.iter().map(|user| user.family.as_str()).collect();
        for family in families {
            let tests = TESTS.iter().find(|(name, _)| *name == family);
            for (file, filter) in tests.with_context(|| format!("no tests are named for the family '{family}'"))?.1 {
                if !self.run(file, filter, &entries.join(","))? {
                    return Ok(false);
                }
            }
        }
        Ok(true)
    }

    fn run(&self, file: &str, filter: &str, replaced: &str) -> Result<bool> {
        let program = self.programs.get(file).with_context(|| format!("no file of tests '{file}'"))?;
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut command = Command::new("timeout");
        command.arg(LIMIT_S).arg(program).args([filter].iter().filter(|text| !text.is_empty()));
        command.env(replaced::SHADERS_VARIABLE, replaced).env("CARGO_MANIFEST_DIR", root).current_dir(root);
        Ok(command.stdout(Stdio::null()).stderr(Stdio::null()).status()?.success())
    }
}
