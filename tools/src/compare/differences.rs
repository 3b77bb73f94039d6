//! Whether two runs may be compared: what else than the program differs between them.

use crate::results::{Method, Results};
use serde::Serialize;

/// Something that should be the same in both runs, and is not.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// What: `size`, `seed`, `device` and so on.
    pub what: &'static str,
    /// A's.
    pub a: String,
    /// B's.
    pub b: String,
    /// Frame i shows something else, so that times cannot be paired by frame.
    pub other_frames: bool,
}

impl std::fmt::Display for Difference {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {} in A, {} in B", self.what, self.a, self.b)
    }
}

/// Name, whether it changes what a frame shows, and value.
type Fact = (&'static str, bool, fn(&Results) -> String);

const FACTS: [Fact; 17] = [
    ("scene", true, |run| run.scene.name.clone()),
    ("objects", true, |run| run.scene.objects.to_string()),
    ("triangles", true, |run| run.scene.triangles.to_string()),
    ("contents of the scene", true, |run| run.scene.hash.clone()),
    ("path", true, |run| run.path.clone()),
    ("speed", true, |run| run.speed.to_string()),
    ("seed", true, |run| run.seed.to_string()),
    ("frames", true, |run| run.frames.to_string()),
    ("size", false, |run| format!("{}x{}", run.size[0], run.size[1])),
    ("device", false, |run| run.device.name.clone()),
    ("type of device", false, |run| run.device.kind.clone()),
    ("driver", false, |run| run.device.driver.clone()),
    ("depth format", true, |run| run.device.depth_format.clone()),
    ("samples a pixel", false, |run| run.device.details.get("samples").map_or("1".to_owned(), String::clone)),
    ("features that are missing", false, |run| run.device.details.get("lacks").cloned().unwrap_or_default()),
    ("bounds of what moves", false, |run| run.scene.moving_bounds.clone()),
    ("shading", true, |run| run.scene.shading.clone()),
];

/// Returns a line if the two runs timed stages differently: times of stages then cannot be compared, frame times can. Older versions
/// chose the timer by a measurement, which could differ in two runs of one command.
pub fn other_timers(a: &Results, b: &Results) -> Option<String> {
    let [a, b] = [a, b].map(|run| &run.device.timer_mode);
    let differ = a != b && !a.is_empty() && !b.is_empty();
    differ.then(|| format!("timers: {a} in A, {b} in B; times of stages cannot be compared, those of frames can"))
}

/// All that differs between two runs and should not. What a file does not say (older ones have no hash of the scene) is
/// taken to be the same.
pub fn differences(a: &Results, b: &Results) -> Vec<Difference> {
    let of =
        |(what, other_frames, value): &Fact| Difference { what, a: value(a), b: value(b), other_frames: *other_frames };
    let all = FACTS.iter().map(of);
    all.filter(|found| found.a != found.b && !found.a.is_empty() && !found.b.is_empty()).collect()
}

/// Options that stand at other values under the same label: a default that changed, or an option that is new or gone.
pub fn other_options(a: &Method, b: &Method) -> Vec<String> {
    let mut names: Vec<&String> = a.options.keys().chain(b.options.keys()).collect();
    names.sort();
    names.dedup();
    let value = |method: &Method, name: &str| method.options.get(name).map_or("none".to_owned(), |v| v.to_string());
    let differing = names.into_iter().filter(|name| a.options.get(*name) != b.options.get(*name));
    differing.map(|name| format!("{name} {} in A, {} in B", value(a, name), value(b, name))).collect()
}
