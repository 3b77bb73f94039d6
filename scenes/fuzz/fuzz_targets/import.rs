//! glTF import of any bytes: no panic, no overflow, and, by libFuzzer's `-rss_limit_mb`, no more than 1 GiB. What is accepted must
//! be a scene that can be asked for its bounds, moved and written out.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|file: &[u8]| {
    // A folder that is not there: data files of an input never exist, and nothing of this machine is read.
    let path = Path::new("/nonexistent-folder-of-the-fuzzer/input.glb");
    let Ok(scene) = scenes::import_bytes(path, file) else { return };
    scene.check().expect("import returns scenes that are in order");
    let mut places = Vec::new();
    for seconds in [0.0, 0.5, 1.0e9] {
        scene.motion.transforms_at(seconds, &mut places);
        scene.meshes_at(seconds);
    }
    let _ = scenes::export_glb(&scene, None, 1);
});
