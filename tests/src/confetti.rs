//! Depth buffers that differ from pixel to pixel, at sizes that pyramids get wrong.

use crate::worlds::{cube, shot, sized, Maker};
use crate::Random;
use culling::World;
use engine::Gpu;
use scenes::Projection;
use sightline::run::targets::Targets;

/// Sizes that pyramids get wrong: single rows and columns, odd ones, powers of two and their neighbours.
pub const SIZES: [[u32; 2]; 22] = [
    [1, 1],
    [2, 1],
    [1, 2],
    [3, 1],
    [1, 257],
    [257, 1],
    [2, 2],
    [3, 3],
    [7, 5],
    [8, 8],
    [9, 8],
    [15, 17],
    [16, 16],
    [31, 33],
    [63, 65],
    [64, 64],
    [65, 63],
    [127, 129],
    [161, 97],
    [255, 257],
    [513, 2],
    [640, 359],
];

/// Draws small boxes everywhere, so that depths differ from pixel to pixel; some pixels stay empty.
///
/// # Panics
/// If the device or its validation layer objects, or if a picture of some size shows nothing.
pub fn drawn(gpu: &Gpu, size: [u32; 2], seed: u64) -> (Targets, Vec<f32>) {
    let mut maker = Maker::new("confetti");
    let mut random = Random::new(seed);
    let cube = maker.mesh(cube());
    // One side is a pixel wide at the least.
    let aspect = f64::from(size[0]) / f64::from(size[1]);
    for _ in 0..(size[0] * size[1] / 6).clamp(3, 4000) {
        let at = random.vector() * glam::DVec3::new(aspect, 1.0, 4.0) - glam::DVec3::Z * 5.0;
        let pixel = 2.0 / f64::from(size[1]);
        maker.place(cube, sized(at, glam::DVec3::splat(pixel * random.range(0.5, 5.0))));
    }
    let world = World::new(gpu, &maker.scene).unwrap();
    let targets = Targets::new(gpu, size).unwrap();
    let projection = Projection::Orthographic { half_height: 1.0, near: 0.0, far: 20.0 };
    let view = culling::View::new(&shot(glam::DVec3::ZERO, glam::DVec3::NEG_Z, projection), size, 0, gpu.snap_px());
    let mut f = gpu.frame();
    f.clear(&targets.with_items());
    world.draw_all(&mut f, &view, &targets.with_items());
    f.finish().unwrap();
    let depth = targets.read().unwrap().depth;
    assert!(size[0] * size[1] <= 60 || depth.iter().any(|depth| *depth > 0.0), "nothing was drawn at {size:?}");
    (targets, depth)
}
