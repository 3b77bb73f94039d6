//! `hzb/reduce_depth` and `hzb/reduce_levels` against their twins and against brute force, at sizes that pyramids get wrong.

use culling::hzb::{twin, Pyramid};
use engine::Placement;
use harness::confetti::{drawn, SIZES};
use harness::{gpu, Random};
use shaders::types::PyramidLevel;

/// Where the levels of a pyramid lie, told from its definition alone.
fn levels(size: [u32; 2]) -> (Vec<PyramidLevel>, u32) {
    let mut levels = vec![PyramidLevel { first: 0, width: 0, height: 0 }];
    let (mut first, mut level, mut coarsest) = (0, 0, 0);
    loop {
        level += 1;
        let [width, height] = size.map(|side| side.div_ceil(1 << level));
        levels.push(PyramidLevel { first, width, height });
        first += width * height;
        if width * height == 1 && coarsest == 0 {
            coarsest = level;
        }
        if coarsest > 0 && level % 3 == 0 {
            return (levels, coarsest);
        }
    }
}

/// The texels whose value is not the farthest depth of exactly the pixels that they stand for.
fn wrong_texels(depth: &[f32], size: [u32; 2], levels: &[PyramidLevel], texels: &[f32]) -> usize {
    let mut wrong = 0;
    for (number, level) in levels.iter().enumerate().skip(1) {
        let mut farthest = vec![f32::INFINITY; (level.width * level.height) as usize];
        for (pixel, depth) in depth.iter().enumerate() {
            let (x, y) = ((pixel as u32 % size[0]) >> number, (pixel as u32 / size[0]) >> number);
            let texel = &mut farthest[(y * level.width + x) as usize];
            *texel = texel.min(*depth);
        }
        let found = &texels[level.first as usize..][..farthest.len()];
        wrong += found.iter().zip(&farthest).filter(|(found, farthest)| found.to_bits() != farthest.to_bits()).count();
    }
    wrong
}

#[test]
fn pyramids_hold_the_farthest_depth_of_their_pixels_at_any_size() {
    let gpu = gpu();
    for (seed, size) in SIZES.into_iter().enumerate() {
        let (targets, depth) = drawn(&gpu, size, seed as u64);
        let pyramid = Pyramid::new(&gpu, size).unwrap();
        let mut f = gpu.frame();
        pyramid.reduce(&mut f, &targets.with_items());
        f.finish().unwrap();
        let texels = pyramid.read().unwrap();
        let (levels, _) = levels(size);
        assert_eq!(wrong_texels(&depth, size, &levels, &texels), 0, "stage at {size:?}");
        let twin = twin::pyramid(&depth, size, &levels);
        assert_eq!(wrong_texels(&depth, size, &levels, &twin), 0, "twin at {size:?}");
        assert!(
            twin.iter().zip(&texels).all(|(twin, texel)| twin.to_bits() == texel.to_bits()),
            "stage and twin at {size:?}"
        );
    }
}

#[test]
fn each_reduction_equals_its_twin_on_random_depths() {
    let gpu = gpu();
    for size in SIZES {
        let mut random = Random::new(u64::from(size[0] * 3 + size[1]));
        let (layout, coarsest) = levels(size);
        let source: Vec<f32> = (0..size[0] * size[1]).map(|_| random.decade(1e-7, 1.0) as f32).collect();
        let texels = twin::pyramid(&source, size, &layout);
        // All levels past the first three are wiped, then made again by the stage.
        let mut wiped = texels.clone();
        let kept = layout.get(4).map_or(texels.len(), |level| level.first as usize);
        wiped[kept..].fill(9.0);
        let buffer = engine::Buffer::with_data(&gpu, "test.texels", &wiped, Placement::Storage).unwrap();
        let places = engine::Buffer::with_data(&gpu, "test.levels", &layout, Placement::Storage).unwrap();
        let mut f = gpu.frame();
        for source_level in (3..coarsest).step_by(3) {
            let PyramidLevel { width, height, .. } = layout[source_level as usize + 3];
            let (levels, pyramid, tiles) = (places.all(), buffer.all(), [width, height]);
            f.dispatch(
                shaders::hzb::ReduceLevels { levels, pyramid, source_level, tiles, constants: Default::default() },
                width * height,
            );
        }
        f.finish().unwrap();
        assert_eq!(buffer.read().unwrap(), texels, "{size:?}");
    }
}

#[test]
fn a_lost_column_is_noticed() {
    let size = [9, 5];
    let mut random = Random::new(1);
    let mut depth: Vec<f32> = (0..45).map(|_| random.range(0.5, 1.0) as f32).collect();
    depth[8] = 0.1;
    let (levels, _) = levels(size);
    assert_eq!(wrong_texels(&depth, size, &levels, &twin::pyramid(&depth, size, &levels)), 0);
    // What a reduction that rounds sizes down would have seen.
    let mut without_column = depth.clone();
    (0..5).for_each(|row| without_column[row * 9 + 8] = 1.0);
    assert!(wrong_texels(&depth, size, &levels, &twin::pyramid(&without_column, size, &levels)) > 0);
}
