//! Bounds of motion contain every motion that they speak for: in any region, and through every tightening step.

use culling::warp::axes::{orient_axes, turned_back, turned_to};
use culling::warp::twin::{self, has_motion, Grid, Tightening};
use glam::Vec2;
use harness::Random;
use shaders::types::{MotionBound, TexelMotion, WARP_REACH};

const ALONG_X: [f32; 2] = [1.0, 0.0];

/// Motions by chance in blobs that move alike, some background, some that leave the picture.
fn motions(random: &mut Random, size: [u32; 2]) -> Vec<TexelMotion> {
    let blobs: Vec<(Vec2, Vec2, f32)> = (0..9)
        .map(|blob| {
            let centre = Vec2::new(random.range(0.0, size[0].into()) as f32, random.range(0.0, size[1].into()) as f32);
            let offset = Vec2::new(random.range(-20.0, 20.0) as f32, random.range(-9.0, 9.0) as f32);
            let depth = if blob == 0 { 0.0 } else { random.unit() as f32 };
            (centre, if blob == 1 { offset * 500.0 } else { offset }, depth)
        })
        .collect();
    let nearest = |texel: Vec2| {
        let distance = |blob: &(Vec2, Vec2, f32)| blob.0.distance_squared(texel);
        blobs.iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).copied().unwrap_or_default()
    };
    let texels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| Vec2::new(x as f32, y as f32)));
    texels
        .map(|texel| {
            let (_, offset, depth) = nearest(texel);
            let jitter = Vec2::new(random.unit() as f32, random.unit() as f32);
            TexelMotion { offset: (offset + jitter).to_array(), depth }
        })
        .collect()
}

fn contains(bound: &MotionBound, offset: [f32; 2]) -> bool {
    (0..2).all(|axis| bound.low[axis] <= offset[axis] && offset[axis] <= bound.high[axis])
}

/// The texels that show somewhere, each with its place and motion.
fn showing(motions: &[TexelMotion], size: [u32; 2]) -> impl Iterator<Item = (Vec2, [f32; 2])> + '_ {
    let own = move |(index, motion): (usize, &TexelMotion)| {
        let texel = [index as u32 % size[0], index as u32 / size[0]];
        let place = Vec2::new(texel[0] as f32 + 0.5, texel[1] as f32 + 0.5);
        has_motion(&twin::bound_of(motion, texel, size, ALONG_X)).then_some((place, motion.offset))
    };
    motions.iter().enumerate().filter_map(own)
}

/// Motions of a region that its bound leaves out.
fn lost_in_regions(motions: &[TexelMotion], how: &Tightening<'_>, random: &mut Random, regions: usize) -> usize {
    let size = how.texels;
    let mut lost = 0;
    for _ in 0..regions {
        let place = |random: &mut Random| {
            Vec2::new(random.range(-5.0, size[0] as f64 + 5.0) as f32, random.range(-5.0, size[1] as f64 + 5.0) as f32)
        };
        let (a, b) = (place(random), place(random));
        let (low, high) = (a.min(b), a.max(b));
        let bound = how.local_bound(low, high);
        let inside = |at: &Vec2| at.cmpge(low).all() && at.cmple(high).all();
        lost += showing(motions, size)
            .filter(|(at, offset)| inside(at) && !contains(&bound, turned_to(*offset, how.axis)))
            .count();
    }
    lost
}

/// Texels that move to a tile whose bound leaves their motion out.
fn lost_by_tightening(motions: &[TexelMotion], how: &Tightening<'_>) -> usize {
    let bounds = twin::tighten_bounds(how);
    let across = how.texels[0].div_ceil(how.tile);
    let mut lost = 0;
    for (at, offset) in showing(motions, how.texels) {
        // Every texel that may take it.
        let end = at + Vec2::from(offset);
        for tile in 0..bounds.len() as u32 {
            let first = Vec2::new((tile % across * how.tile) as f32, (tile / across * how.tile) as f32) + 0.5;
            let last = (first + how.tile as f32 - 1.0).min(Vec2::new(how.texels[0] as f32, how.texels[1] as f32) - 0.5);
            let reached = end.cmpge(first - WARP_REACH).all() && end.cmple(last + WARP_REACH).all();
            lost += usize::from(reached && !contains(&bounds[tile as usize], turned_to(offset, how.axis)));
        }
    }
    lost
}

#[test]
fn bounds_contain_every_motion_that_shows() {
    let mut random = Random::new(91);
    for size in [[1, 1], [7, 5], [64, 33], [65, 64], [97, 61]] {
        let motions = motions(&mut random, size);
        let (levels, coarsest_level) = culling::hzb::layout(size);
        let aslant = orient_axes(Grid { size, values: &motions });
        let settings = [
            (1, 8, false, ALONG_X, 2),
            (3, 8, false, ALONG_X, 2),
            (4, 1, false, ALONG_X, 2),
            (3, 4, true, ALONG_X, 2),
            (3, 4, false, ALONG_X, 4),
            (3, 4, false, aslant, 2),
            (3, 4, false, [0.6, 0.8], 3),
            (2, 8, true, [-0.8, 0.6], 8),
        ];
        for (steps, tile, keep_last, axis, lookups) in settings {
            let pyramid = twin::pyramid(Grid { size, values: &motions }, &levels, axis);
            let (levels, pyramid) = (&levels[..], &pyramid[..]);
            let how =
                Tightening { levels, pyramid, coarsest_level, texels: size, steps, tile, keep_last, axis, lookups };
            assert_eq!(lost_in_regions(&motions, &how, &mut random, 40), 0, "regions of {size:?}");
            assert_eq!(
                lost_by_tightening(&motions, &how),
                0,
                "{size:?}, {steps} steps, tiles of {tile}, along {axis:?}, {lookups} lookups"
            );
        }
    }
}

#[test]
fn tightening_is_worth_its_steps() {
    let size = [97, 61];
    let motions = motions(&mut Random::new(92), size);
    let (levels, coarsest_level) = culling::hzb::layout(size);
    let pyramid = twin::pyramid(Grid { size, values: &motions }, &levels, ALONG_X);
    let area = |steps: u32| -> f64 {
        let how = Tightening {
            levels: &levels,
            pyramid: &pyramid,
            coarsest_level,
            texels: size,
            steps,
            tile: 4,
            keep_last: false,
            axis: ALONG_X,
            lookups: 2,
        };
        let bounds = twin::tighten_bounds(&how);
        let area = |bound: &MotionBound| f64::from((bound.high[0] - bound.low[0]) * (bound.high[1] - bound.low[1]));
        bounds.iter().filter(|bound| has_motion(bound)).map(area).sum()
    };
    let areas = [0, 1, 2, 4].map(area);
    assert!(areas.windows(2).all(|pair| pair[1] <= pair[0]), "{areas:?}");
    assert!(areas[3] < 0.8 * areas[0], "{areas:?}");
}

#[test]
fn a_lost_motion_is_noticed() {
    let size = [64, 33];
    let mut random = Random::new(93);
    let motions = motions(&mut random, size);
    let (levels, coarsest_level) = culling::hzb::layout(size);
    let mut pyramid = twin::pyramid(Grid { size, values: &motions }, &levels, ALONG_X);
    let how = |pyramid: &[MotionBound], random: &mut Random| {
        let (levels, axis) = (&levels[..], ALONG_X);
        let how = Tightening {
            levels,
            pyramid,
            coarsest_level,
            texels: size,
            steps: 3,
            tile: 8,
            keep_last: false,
            axis,
            lookups: 2,
        };
        lost_in_regions(&motions, &how, random, 40) + lost_by_tightening(&motions, &how)
    };
    assert_eq!(how(&pyramid, &mut random), 0);
    for bound in &mut pyramid {
        bound.low[0] += 0.25;
    }
    assert!(how(&pyramid, &mut random) > 0);
}

/// Motions along a slope are bounded far better along it; motions along x or y, or of all directions, stay as they are.
#[test]
fn axes_lie_along_what_moves() {
    let size = [64, 48];
    let mut random = Random::new(94);
    let mut along = |axis: [f32; 2], across: f64| -> Vec<TexelMotion> {
        let motion = |_| {
            let parts = [random.range(-20.0, 20.0) as f32, (across * random.range(-20.0, 20.0)) as f32];
            TexelMotion { offset: turned_back(parts, axis), depth: 0.5 }
        };
        (0..size[0] * size[1]).map(motion).collect()
    };
    let slant = [0.8, 0.6];
    let found = orient_axes(Grid { size, values: &along(slant, 0.01) });
    let parallel = found[0] * slant[0] + found[1] * slant[1];
    assert!(parallel.abs() > 0.999, "{found:?}");
    assert_eq!(orient_axes(Grid { size, values: &along(ALONG_X, 0.0) }), ALONG_X);
    assert_eq!(orient_axes(Grid { size, values: &along([0.0, 1.0], 0.0) }), ALONG_X, "no smaller area");
    let nothing = vec![TexelMotion { offset: [0.0; 2], depth: 0.0 }; (size[0] * size[1]) as usize];
    assert_eq!(orient_axes(Grid { size, values: &nothing }), ALONG_X);
}
