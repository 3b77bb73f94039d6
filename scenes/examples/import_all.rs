//! Imports each file named on the command line and prints one line for it: what is in it, or what is wrong with it.
//!
//! `cargo run --release -p sightline-scenes --example import_all -- FILE...`

use std::path::Path;
use std::time::Instant;

fn main() {
    for file in std::env::args().skip(1) {
        let start = Instant::now();
        match scenes::import(Path::new(&file)) {
            Ok(scene) => {
                let indices = |mesh: u32| scene.meshes[mesh as usize].indices.len();
                let triangles: usize = scene.objects.iter().map(|object| indices(object.mesh) / 3).sum();
                println!(
                    "{file}: {} objects, {} meshes, {triangles} triangles, {} cameras, {} moving; {:.0} ms",
                    scene.objects.len(),
                    scene.meshes.len(),
                    scene.cameras.len(),
                    scene.motion.dynamic_objects().len(),
                    start.elapsed().as_secs_f64() * 1e3
                );
            }
            Err(error) => println!("{error}"),
        }
    }
}
