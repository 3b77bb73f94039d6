//! Stages of warping-based culling against their twins, and erosion against its promise.

use culling::farthest::twin::fill_from_depth;
use culling::warp::twin::{erode_depth, Grid};
use culling::woc::twin::exclude_objects;
use engine::{Buffer, Placement};
use harness::{gpu, Random};
use shaders::types::{DEPTH_FAR, DEPTH_HOLE, ERODE_SIDE};
use shaders::{warp, woc};

/// Depths by chance with holes in them, and some background.
fn warped(random: &mut Random, [width, height]: [u32; 2]) -> Vec<f32> {
    let texel = |_| match random.unit() {
        chance if chance < 0.2 => DEPTH_HOLE,
        chance if chance < 0.3 => DEPTH_FAR,
        chance => chance as f32,
    };
    (0..width * height).map(texel).collect()
}

#[test]
fn eroded_depth_equals_its_twin_at_any_size() {
    let gpu = gpu();
    let mut random = Random::new(17);
    for texels in [[1u32, 1], [2, 3], [1, 257], [257, 1], [4, 4], [5, 9], [63, 65], [64, 64], [161, 97]] {
        let depth = warped(&mut random, texels);
        let from = Buffer::with_data(&gpu, "warped", &depth, Placement::Storage).unwrap();
        let settings = [
            (true, true, false, 1),
            (true, false, false, 1),
            (false, true, false, 1),
            (true, true, true, 1),
            (false, false, true, 2),
            (true, true, true, 4),
        ];
        for (erode, close, merge, reduction) in settings {
            // The last pixels of the last row and column are missing, as they are in most pictures.
            let size_px = texels.map(|side| (side * reduction).saturating_sub(reduction / 2).max(1));
            let pixels: Vec<f32> = (0..size_px[0] * size_px[1]).map(|_| (0.6 * random.unit()) as f32).collect();
            let drawn = Buffer::with_data(&gpu, "drawn", &pixels, Placement::Storage).unwrap();
            let eroded = Buffer::new(&gpu, "eroded", depth.len(), Placement::Storage).unwrap();
            let constants = warp::ErodeDepthConstants { erode, close, merge, reduction };
            let stage = warp::ErodeDepth {
                warped: from.all(),
                eroded: eroded.all(),
                drawn: drawn.all(),
                texels,
                size_px,
                constants,
            };
            let drawn = merge.then(|| fill_from_depth(&pixels, size_px, reduction.ilog2()));
            let mut f = gpu.frame();
            f.dispatch_over(stage, texels.map(|side| side.div_ceil(ERODE_SIDE)));
            f.finish().unwrap();
            let eroded: Vec<f32> = eroded.read().unwrap();
            let twin = erode_depth(Grid { size: texels, values: &depth }, erode, close, drawn.as_deref());
            assert!(eroded == twin, "{texels:?}, erode: {erode}, close: {close}, merge: {merge} by {reduction}");
        }
    }
}

/// Erosion hides nothing that was not hidden, and closes over every lone texel.
#[test]
fn erosion_is_conservative() {
    let size = [61, 47];
    let depth = warped(&mut Random::new(18), size);
    let eroded = erode_depth(Grid { size, values: &depth }, true, false, None);
    assert!(eroded.iter().zip(&depth).all(|(eroded, depth)| eroded <= depth));
    let lone = painted(size, &[(30, 25, 0.75)]);
    assert!(erode_depth(Grid { size, values: &lone }, true, true, None).iter().all(|depth| *depth == 0.25));
}

/// A picture of one depth with other texels in it.
fn painted(size: [u32; 2], others: &[(u32, u32, f32)]) -> Vec<f32> {
    let mut depth = vec![0.25f32; (size[0] * size[1]) as usize];
    others.iter().for_each(|(x, y, other)| depth[(y * size[0] + x) as usize] = *other);
    depth
}

/// Holes of up to two texels get the farthest depth around them, never a nearer one; wider ones stay holes, and background
/// stays background.
#[test]
fn narrow_holes_are_closed_by_the_farthest_around_them() {
    let size = [40, 30];
    let closed =
        |others: &[(u32, u32, f32)]| erode_depth(Grid { size, values: &painted(size, others) }, false, true, None);
    let at = |depth: &[f32], x: u32, y: u32| depth[(y * size[0] + x) as usize];
    let narrow = closed(&[(10, 10, DEPTH_HOLE), (11, 10, DEPTH_HOLE), (12, 10, 0.125), (9, 10, 0.5)]);
    assert_eq!((at(&narrow, 10, 10), at(&narrow, 11, 10)), (0.25, 0.125));
    let square: Vec<_> = (10..15).flat_map(|y| (10..15).map(move |x| (x, y, DEPTH_HOLE))).collect();
    let wide = closed(&square);
    assert_eq!(wide.iter().filter(|depth| **depth == DEPTH_HOLE).count(), 9, "all but a rim of one texel stays open");
    let sky = closed(&[(10, 10, DEPTH_HOLE), (11, 11, DEPTH_FAR)]);
    assert_eq!((at(&sky, 10, 10), at(&sky, 11, 11), at(&sky, 12, 11)), (DEPTH_FAR, DEPTH_FAR, 0.25));
}

#[test]
fn objects_are_excluded_as_their_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(19);
    for count in [1, 63, 64, 65, 1000] {
        let mut flags = || (0..count).map(|_| u32::from(random.unit() < 0.5)).collect::<Vec<u32>>();
        let (objects, excluded) = (flags(), flags());
        let buffer = |data: &[u32]| Buffer::with_data(&gpu, "flags", data, Placement::Storage).unwrap();
        let (one, other, remaining) = (buffer(&objects), buffer(&excluded), buffer(&objects));
        let mut f = gpu.frame();
        let stage = woc::ExcludeObjects {
            objects: one.all(),
            excluded: other.all(),
            remaining: remaining.all(),
            object_count: count,
        };
        f.dispatch(stage, count);
        f.finish().unwrap();
        assert_eq!(remaining.read().unwrap(), exclude_objects(&objects, &excluded));
    }
}
