//! Stages of warping-based culling against their twins, and erosion against its promise.

use culling::warp::twin::{erode_depth, Grid};
use culling::woc::twin::exclude_objects;
use engine::{Buffer, Placement};
use harness::{gpu, Random};
use shaders::types::ERODE_SIDE;
use shaders::{warp, woc};

#[test]
fn eroded_depth_equals_its_twin_at_any_size() {
    let gpu = gpu();
    let mut random = Random::new(17);
    for texels in [[1u32, 1], [2, 3], [1, 257], [257, 1], [4, 4], [5, 9], [63, 65], [64, 64], [161, 97]] {
        let [width, height] = texels;
        let depth: Vec<f32> = (0..width * height).map(|_| random.unit() as f32).collect();
        let warped = Buffer::with_data(&gpu, "warped", &depth, Placement::Storage).unwrap();
        let eroded = Buffer::new(&gpu, "eroded", depth.len(), Placement::Storage).unwrap();
        let mut f = gpu.frame();
        let blocks = width.div_ceil(ERODE_SIDE) * height.div_ceil(ERODE_SIDE);
        f.dispatch(warp::ErodeDepth { warped: warped.all(), eroded: eroded.all(), texels }, blocks);
        f.finish().unwrap();
        let eroded: Vec<f32> = eroded.read().unwrap();
        assert!(eroded == erode_depth(Grid { size: texels, values: &depth }), "{texels:?}");
    }
}

/// Erosion hides nothing that was not hidden, and closes over every lone texel.
#[test]
fn erosion_is_conservative() {
    let mut random = Random::new(18);
    let size = [61, 47];
    let depth: Vec<f32> = (0..size[0] * size[1]).map(|_| random.unit() as f32).collect();
    let eroded = erode_depth(Grid { size, values: &depth });
    assert!(eroded.iter().zip(&depth).all(|(eroded, depth)| eroded <= depth));
    let mut lone = vec![0.25f32; depth.len()];
    lone[25 * size[0] as usize + 30] = 0.75;
    assert!(erode_depth(Grid { size, values: &lone }).iter().all(|depth| *depth == 0.25));
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
