//! Builds the tree of a scene by each split and prints time, cost and depth.
//!
//! `cargo run --release -p sightline-scenes --example bvh_build -- [SCENE] [SCALE]`

use scenes::bvh::{Bvh, Split};
use scenes::{Aabb, SceneOptions, WorldBounds};
use std::time::Instant;

const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or("city-block".into());
    let scale = arguments.next().map_or(Ok(1.0), |scale| scale.parse())?;
    let scene = scenes::open(&name, &SceneOptions { scale, ..SceneOptions::default() })?;
    let bounds = WorldBounds::new(&scene);
    let boxes: Vec<Aabb> =
        scene.objects.iter().map(|object| bounds.of(object.mesh, &object.world_from_object)).collect();
    println!("{name}: {} objects; least and median of {RUNS} builds", boxes.len());
    for split in [Split::Sah, Split::Middle, Split::EqualCount, Split::Ploc] {
        let mut times_ms = Vec::new();
        for _ in 0..RUNS {
            let start = Instant::now();
            std::hint::black_box(Bvh::build(&boxes, split)?);
            times_ms.push(start.elapsed().as_secs_f64() * 1e3);
        }
        times_ms.sort_by(f64::total_cmp);
        let mut bvh = Bvh::build(&boxes, split)?;
        let start = Instant::now();
        bvh.refit(&boxes)?;
        let refit_ms = start.elapsed().as_secs_f64() * 1e3;
        println!(
            "{split:?}: {:.1} / {:.1} ms, refit {refit_ms:.1} ms, {} nodes, cost {:.2}, depth {}",
            times_ms[0],
            times_ms[RUNS / 2],
            bvh.nodes().len(),
            bvh.cost(),
            bvh.depth()
        );
    }
    Ok(())
}
