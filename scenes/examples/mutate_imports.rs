//! Imports mutations of small files of every kind (`tests/import/corpus.rs`) and of the files on the command line. Counts panics, slow
//! runs and memory. Needs stable Rust alone; `scenes/fuzz` does the same with libFuzzer's coverage.
//!
//! `cargo run -p sightline-scenes --example mutate_imports -- --runs 1000000 [--seed 1] [FILE...]`
//!
//! `--write FOLDER` writes the small files there, as seeds for `tools/fuzz.sh`, and ends.
//!
//! Ends with status 1 after a panic, or a run of more than two seconds. A run is repeated alone by `--seed S --only RUN`.

#[path = "../tests/import/corpus.rs"]
#[allow(dead_code)]
mod corpus;
#[path = "../tests/import/model.rs"]
#[allow(dead_code)]
mod model;

use std::panic::{catch_unwind, AssertUnwindSafe};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Longest that a run may take.
const MOST: Duration = Duration::from_secs(2);

/// The command line.
struct Options {
    runs: u64,
    seed: u64,
    only: Option<u64>,
    /// Where seeds are to be written.
    write: Option<String>,
    files: Vec<String>,
}

/// SplitMix64. The mutations of a run follow from its number.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }
}

fn main() -> ExitCode {
    let options = match options() {
        Ok(options) => options,
        Err(fault) => {
            eprintln!("mutate_imports: {fault}");
            return ExitCode::FAILURE;
        }
    };
    let mut seeds: Vec<(String, Vec<u8>)> =
        corpus::all().into_iter().map(|(name, file)| (name.to_owned(), file)).collect();
    for name in &options.files {
        match std::fs::read(name) {
            Ok(file) => seeds.push((name.clone(), file)),
            Err(error) => eprintln!("mutate_imports: {name}: {error}; it is left out"),
        }
    }
    if let Some(folder) = &options.write {
        let write = |(name, file): &(String, Vec<u8>)| std::fs::write(Path::new(folder).join(name), file);
        return match seeds.iter().try_for_each(write) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("mutate_imports: {folder}: {error}; make the folder first");
                ExitCode::FAILURE
            }
        };
    }
    // A panic is counted and told in one line.
    std::panic::set_hook(Box::new(|panic| eprintln!("panic: {panic}")));
    report(&options, &seeds)
}

fn options() -> Result<Options, String> {
    let mut options = Options { runs: 100_000, seed: 1, only: None, write: None, files: Vec::new() };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        if !word.starts_with('-') {
            options.files.push(word);
            continue;
        }
        let value = words.next().ok_or(format!("{word} needs a value"))?;
        let number = || value.parse::<u64>().map_err(|error| format!("{word} {value}: {error}"));
        match word.as_str() {
            "--runs" => options.runs = number()?,
            "--seed" => options.seed = number()?,
            "--only" => options.only = Some(number()?),
            "--write" => options.write = Some(value),
            _ => return Err(format!("{word} is none of --runs, --seed, --only and --write")),
        }
    }
    Ok(options)
}

fn report(options: &Options, seeds: &[(String, Vec<u8>)]) -> ExitCode {
    let (mut panics, mut slow, mut accepted) = (0u64, 0u64, 0u64);
    let mut slowest = (Duration::ZERO, 0, String::new());
    let start = Instant::now();
    let runs = options.only.map_or(0..options.runs, |only| only..only + 1);
    for run in runs.clone() {
        let mut random = Random(options.seed.wrapping_mul(0x2545_f491_4f6c_dd1d) ^ run);
        let (name, file) = mutated(seeds, &mut random);
        let (outcome, took) = timed(&file);
        match outcome {
            Ok(legal) => accepted += u64::from(legal),
            Err(_) => {
                panics += 1;
                eprintln!("run {run} of seed {}, a mutation of {name}, panicked", options.seed);
            }
        }
        slow += u64::from(took > MOST);
        if took > slowest.0 {
            slowest = (took, run, name.to_owned());
        }
        if run % 100_000 == 99_999 {
            eprintln!(
                "{} runs, {:.0} s, {panics} panics, slowest {:?}",
                run + 1,
                start.elapsed().as_secs_f64(),
                slowest.0
            );
        }
    }
    let count = runs.end - runs.start;
    println!(
        "{count} runs of {} seeds in {:.0} s: {panics} panics, {slow} over {} s, slowest {:.1} ms (run {}, {}), {:.0} % accepted{}",
        seeds.len(),
        start.elapsed().as_secs_f64(),
        MOST.as_secs(),
        slowest.0.as_secs_f64() * 1e3,
        slowest.1,
        slowest.2,
        100.0 * accepted as f64 / count.max(1) as f64,
        peak_memory().map_or_else(String::new, |mib| format!(", {mib} MiB of memory at most")),
    );
    if panics + slow == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Imports a file and measures the time. A slow import is repeated and the shorter time counts, as a busy machine may have held it up.
fn timed(file: &[u8]) -> (std::thread::Result<bool>, Duration) {
    let once = || {
        let begun = Instant::now();
        (catch_unwind(AssertUnwindSafe(|| used(file))), begun.elapsed())
    };
    let (outcome, took) = once();
    if outcome.is_err() || took < MOST / 20 {
        return (outcome, took);
    }
    (outcome, took.min(once().1))
}

/// Imports a file and uses the scene like a program. Returns whether the file was accepted.
fn used(file: &[u8]) -> bool {
    // The folder does not exist: no data file of an input is found, and nothing of this machine is read.
    let path = Path::new("/nonexistent-folder-of-the-mutations/input.glb");
    let Ok(scene) = scenes::import_bytes(path, file) else { return false };
    if let Err(error) = scene.check() {
        panic!("import returned a scene that is not in order: {error}");
    }
    let mut places = Vec::new();
    for seconds in [0.0, 0.5, 1.0e9] {
        scene.motion.transforms_at(seconds, &mut places);
        scene.meshes_at(seconds);
    }
    let _ = scenes::export_glb(&scene, None, 1);
    true
}

/// A mutation of one seed, and the seed's name.
fn mutated<'a>(seeds: &'a [(String, Vec<u8>)], random: &mut Random) -> (&'a str, Vec<u8>) {
    let (name, file) = &seeds[random.below(seeds.len())];
    let mut file = file.clone();
    match random.below(8) {
        // Bytes behind the JSON: streams and pictures change, and the document stays legal.
        0..=3 => {
            let data = data_start(&file);
            change_bytes(&mut file[data..], random);
        }
        4..=5 => file = change_numbers(&file, random),
        6 => {
            file = change_numbers(&file, random);
            let data = data_start(&file);
            change_bytes(&mut file[data..], random);
        }
        _ => {
            change_bytes(&mut file, random);
            if random.below(4) == 0 {
                file.truncate(random.below(file.len() + 1));
            }
        }
    }
    (name, file)
}

fn data_start(file: &[u8]) -> usize {
    let length = file.get(12..16).and_then(|word| word.try_into().ok()).map_or(0, u32::from_le_bytes) as usize;
    if file.starts_with(b"glTF") && 28 + length < file.len() {
        28 + length
    } else {
        0
    }
}

/// Flips bits, writes telling bytes, or copies a run of bytes over another, in one to eight places.
fn change_bytes(bytes: &mut [u8], random: &mut Random) {
    if bytes.is_empty() {
        return;
    }
    for _ in 0..=random.below(8) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.next() as u8,
            2 => bytes[at] = [0, 1, 0x7f, 0x80, 0xff][random.below(5)],
            3 => {
                let word = [0, 1, 0x7fff_ffff, u32::MAX, 0x7f80_0000, 0x7fc0_0000][random.below(6)].to_le_bytes();
                bytes[at..].iter_mut().zip(word).for_each(|(byte, new)| *byte = new);
            }
            _ => {
                let (from, length) = (random.below(bytes.len()), random.below(32));
                let length = length.min(bytes.len() - at.max(from));
                bytes.copy_within(from..from + length, at);
            }
        }
    }
}

/// Replaces one to four numbers of the JSON.
fn change_numbers(file: &[u8], random: &mut Random) -> Vec<u8> {
    let (mut json, data) = model::parts(file);
    for _ in 0..=random.below(4) {
        let bytes = json.as_bytes();
        let starts: Vec<usize> =
            (1..bytes.len()).filter(|&at| bytes[at].is_ascii_digit() && b":[,".contains(&bytes[at - 1])).collect();
        let Some(&start) = starts.get(random.below(starts.len())) else { break };
        let is_part = |byte: &&u8| byte.is_ascii_digit() || b"+-.eE".contains(byte);
        let end = start + bytes[start..].iter().take_while(is_part).count();
        let number = match random.below(7) {
            0..=2 => random.below(40).to_string(),
            3 => (5119 + random.below(9)).to_string(),
            4 => format!("{}.0", random.below(300)),
            5 => (random.next() >> random.below(64)).to_string(),
            _ => format!("{:e}", f64::from_bits(random.next())).replace("NaN", "1e999").replace("inf", "1e400"),
        };
        json.replace_range(start..end, &number);
    }
    model::joined(&json, data)
}

/// The peak memory of this process in MiB, where the system reports it.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.split_whitespace().next()?.parse::<u64>().ok()? / 1024)
}
