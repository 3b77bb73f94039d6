//! Depth warping: each stage against its twin, and what must hold of motion, bounds and warped depth.

use culling::warp::{LastFrame, Settings, Warp};
use culling::View;
use engine::{Buffer, Placement};
use glam::DVec3;
use harness::Lab;
use scenes::Shot;

#[path = "warp/bounds.rs"]
mod bounds;
#[path = "warp/depth.rs"]
mod depth;
#[path = "warp/motion.rs"]
mod motion;
#[path = "warp/twins.rs"]
mod twins;

/// A place from which the boxes of `moving-boxes` that move are seen.
const OVER_BOXES: DVec3 = DVec3::new(2.0, 9.0, -26.0);

/// A drawn frame, and what the warp made of it for the next one.
struct Pair {
    last: LastFrame,
    view: View,
    /// The last frame's.
    depth: Vec<f32>,
    /// The last frame's.
    items: Vec<u32>,
    warp: Warp,
    warped: Vec<f32>,
}

/// Draws all of the first shot, and warps it to the second.
fn warp(lab: &mut Lab, shots: [&Shot; 2], settings: Settings) -> Pair {
    let truth = lab.truth(shots[0]);
    let view = lab.look(shots[0], 0);
    let last = LastFrame::of(&lab.world, &view);
    let mut warp = Warp::new(&lab.gpu, &lab.world, lab.size, settings).unwrap();
    // Only worlds in which something moves need the item buffer.
    let target = if lab.world.moving().len() > 0 { lab.targets.with_items() } else { lab.targets.timed() };
    let mut f = lab.gpu.frame();
    warp.keep(&mut f, &lab.world, &view, &target);
    f.finish().unwrap();
    let view = lab.look(shots[1], 1);
    let [width, height] = warp.texels();
    let warped = Buffer::new(&lab.gpu, "warped", (width * height) as usize, Placement::Storage).unwrap();
    let mut f = lab.gpu.frame();
    warp.frame(&mut f, &lab.world, &view, warped.all()).unwrap();
    f.finish().unwrap();
    let warped = warped.read().unwrap();
    let images = truth.images();
    Pair { last, view, depth: images.depth.clone(), items: images.items.clone(), warp, warped }
}
