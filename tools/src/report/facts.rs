//! What a reader needs to make the run again, and to know that it is the same run.

use crate::results::Results;
use serde::Serialize;
use serde_json::json;
use sha2::{Digest, Sha256};

/// A line of the table of facts.
#[derive(Serialize)]
pub struct Fact {
    name: &'static str,
    value: String,
}

/// Device, command, version, scene and settings with their hashes.
pub fn facts(results: &Results) -> Vec<Fact> {
    let device = &results.device;
    let scene = &results.scene;
    let [width, height] = results.size;
    let hash = if scene.hash.is_empty() { "not recorded" } else { &scene.hash };
    let rows = [
        ("Device", format!("{} ({})", device.name, device.kind)),
        ("Driver", format!("{}, Vulkan {}", device.driver, device.api_version)),
        ("Depth", device.depth_format.clone()),
        ("Stages timed by", device.timer_mode.clone()),
        ("Command", results.command.clone()),
        ("Sightline", results.sightline_version.clone()),
        (
            "Scene",
            format!("{}: {} objects, {} triangles, seed {}", scene.name, scene.objects, scene.triangles, results.seed),
        ),
        ("Scene, SHA-256", hash.to_owned()),
        (
            "Path",
            format!(
                "{} at speed {}, {} frames of {width} × {height} pixels",
                results.path, results.speed, results.frames
            ),
        ),
        ("Settings, SHA-256", settings_hash(results)),
    ];
    rows.into_iter().map(|(name, value)| Fact { name, value }).collect()
}

/// Of all that decides what is drawn, the device aside: two runs with one hash did the same work.
fn settings_hash(results: &Results) -> String {
    let methods: Vec<_> = results.methods.iter().map(|method| json!([method.method, method.options])).collect();
    let settings = json!([
        results.sightline_version,
        results.scene.name,
        results.scene.hash,
        results.scene.moving_bounds,
        results.scene.shading,
        results.device.details.get("samples"),
        results.path,
        results.speed,
        results.seed,
        results.size,
        results.frames,
        methods,
    ]);
    Sha256::digest(settings.to_string()).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::tests::results;

    #[test]
    fn the_settings_hash_knows_settings_and_not_times() {
        let first = settings_hash(&results());
        let mut again = results();
        again.methods[0].frame_ms.median *= 2.0;
        again.device.name = "another".into();
        assert_eq!(settings_hash(&again), first);
        let changes: [fn(&mut Results); 13] = [
            |results| results.seed += 1,
            |results| results.size[0] += 1,
            |results| results.size.swap(0, 1),
            |results| results.sightline_version.push('1'),
            |results| results.scene.name.push('1'),
            |results| results.path.push('1'),
            |results| results.speed += 1.0,
            |results| results.frames += 1,
            |results| results.scene.moving_bounds.push('1'),
            |results| results.scene.shading.push('1'),
            |results| drop(results.device.details.insert("samples".into(), "4".into())),
            |results| results.scene.hash.push('1'),
            |results| drop(results.methods[1].options.insert("search.seeds".into(), 9.into())),
        ];
        for change in changes {
            let mut other = results();
            change(&mut other);
            assert_ne!(settings_hash(&other), first);
        }
    }
}
