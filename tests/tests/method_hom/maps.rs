//! Farthest-depth maps against their twins and against brute force, at sizes that pyramids get wrong.

use culling::farthest::twin::{double_squares, fill_from_depth, Map};
use culling::farthest::{layout, FarthestMap, MapKind, Structure};
use harness::confetti::{drawn, SIZES};
use harness::{assert_caught, assert_none, gpu, Random};

/// Every structure at every reduction.
pub fn kinds() -> Vec<MapKind> {
    let structures = [
        Structure::NBuffer,
        Structure::YMap(0),
        Structure::YMap(1),
        Structure::YMap(2),
        Structure::YMap(4),
        Structure::YMap(8),
        Structure::Mip,
    ];
    structures.into_iter().flat_map(|structure| (0..3).map(move |reduction| MapKind { structure, reduction })).collect()
}

/// The twin's map over a depth buffer.
pub fn map_over(depth: &[f32], size: [u32; 2], kind: MapKind) -> Map {
    Map::over(&fill_from_depth(depth, size, kind.reduction), layout(size, kind))
}

#[test]
fn maps_equal_their_twins_at_any_size() {
    let gpu = gpu();
    for (seed, size) in SIZES.into_iter().enumerate() {
        let (targets, depth) = drawn(&gpu, size, seed as u64);
        for kind in kinds() {
            let map = FarthestMap::new(&gpu, size, kind).unwrap();
            let mut f = gpu.frame();
            map.fill_from_depth(&mut f, &targets.with_items());
            map.build(&mut f);
            f.finish().unwrap();
            let (texels, twin) = (map.read().unwrap(), map_over(&depth, size, kind));
            assert_eq!(texels.len(), twin.texels.len(), "{kind:?} at {size:?}");
            let differ =
                texels.iter().zip(&twin.texels).filter(|(texel, twin)| texel.to_bits() != twin.to_bits()).count();
            assert_eq!(differ, 0, "{kind:?} at {size:?}: texels differ from the twin");
        }
    }
}

/// The farthest depth of a region of the depth buffer, pixel by pixel.
fn brute_force(depth: &[f32], size: [u32; 2], first: [u32; 2], last: [u32; 2]) -> f32 {
    let row = |y: u32| &depth[(y * size[0] + first[0]) as usize..=(y * size[0] + last[0]) as usize];
    (first[1]..=last[1]).flat_map(row).copied().fold(f32::INFINITY, f32::min)
}

/// The region grown to whole squares of `side` pixels: what a map that knows no more than those can say of it.
fn grown(size: [u32; 2], first: [u32; 2], last: [u32; 2], side: u32) -> ([u32; 2], [u32; 2]) {
    let end = |axis: usize| ((last[axis] / side + 1) * side).min(size[axis]) - 1;
    (first.map(|begin| begin / side * side), [end(0), end(1)])
}

/// How many pixels a side a map's answer may be in units of: the base's, times the mip level that the papers choose.
fn units(kind: MapKind, first: [u32; 2], last: [u32; 2]) -> u32 {
    let texels = |axis: usize| (last[axis] >> kind.reduction) - (first[axis] >> kind.reduction) + 1;
    let level = texels(0).min(texels(1)).ilog2();
    let mip = match kind.structure {
        Structure::NBuffer => 0,
        Structure::YMap(levels) => level.min(levels),
        Structure::Mip => level,
    };
    1 << (kind.reduction + mip)
}

/// Regions of all shapes by chance, the whole picture, a row, a column and a pixel.
fn regions(random: &mut Random, size: [u32; 2], count: usize) -> Vec<([u32; 2], [u32; 2])> {
    let end = size.map(|side| side - 1);
    let mut regions = vec![([0, 0], end), ([0, end[1]], end), ([end[0], 0], end), (end, end), ([0, 0], [0, 0])];
    regions.extend((0..count).map(|_| {
        let corners: [[u32; 2]; 2] = std::array::from_fn(|axis| {
            let longest = random.decade(1.0, f64::from(size[axis])) as usize;
            let first = random.below(size[axis] as usize) as u32;
            [first, (first + random.below(longest) as u32).min(end[axis])]
        });
        ([corners[0][0], corners[1][0]], [corners[0][1], corners[1][1]])
    }));
    regions
}

/// Where a map is not what brute force says: equal to the farthest depth of the region in the map's units, and so never
/// nearer than that of the region itself.
fn faults(depth: &[f32], size: [u32; 2], kind: MapKind, map: &Map, regions: &[([u32; 2], [u32; 2])]) -> Vec<String> {
    let fault = |&(first, last): &([u32; 2], [u32; 2])| {
        let (found, exact) = (map.farthest_within(first, last), brute_force(depth, size, first, last));
        let (grown_first, grown_last) = grown(size, first, last, units(kind, first, last));
        let expected = brute_force(depth, size, grown_first, grown_last);
        let place = format!("{kind:?} at {size:?}, {first:?} to {last:?}");
        if found > exact {
            Some(format!("{place}: {found} is nearer than {exact}"))
        } else if found != expected {
            Some(format!("{place}: {found} is not {expected}"))
        } else {
            None
        }
    };
    regions.iter().filter_map(fault).collect()
}

fn depths(random: &mut Random, size: [u32; 2]) -> Vec<f32> {
    (0..size[0] * size[1]).map(|_| random.decade(1e-7, 1.0) as f32).collect()
}

#[test]
fn regions_have_the_farthest_depth_that_brute_force_finds() {
    let mut random = Random::new(17);
    for size in SIZES {
        let depth = depths(&mut random, size);
        let regions = regions(&mut random, size, if size[0] * size[1] > 10_000 { 40 } else { 300 });
        for kind in kinds() {
            assert_none(&faults(&depth, size, kind, &map_over(&depth, size, kind), &regions));
        }
    }
}

#[test]
fn no_region_takes_more_lookups_than_a_loop_may_have() {
    // lavapipe ends loops at 65,535 turns without a word: a region looked up in part would hide what shows.
    for size in [[1, 1], [3, 700], [1280, 720], [7680, 4320], [16_384, 16_384]] {
        for kind in kinds() {
            let (levels, shape) = layout(size, kind);
            let last_mip = levels[shape.mip_levels as usize];
            let squares = [last_mip.width, last_mip.height].map(|side| side.div_ceil(1 << shape.coarsest_square));
            let thin = u64::from(last_mip.width.max(last_mip.height));
            assert!(
                u64::from(squares[0]) * u64::from(squares[1]) <= 256.max(thin),
                "{kind:?} at {size:?}: {squares:?}"
            );
        }
    }
}

#[test]
fn an_n_buffer_of_the_pictures_size_is_exact() {
    let mut random = Random::new(18);
    let (size, kind) = ([161, 97], MapKind { structure: Structure::NBuffer, reduction: 0 });
    let depth = depths(&mut random, size);
    let map = map_over(&depth, size, kind);
    for (first, last) in regions(&mut random, size, 300) {
        assert_eq!(map.farthest_within(first, last), brute_force(&depth, size, first, last), "{first:?} to {last:?}");
    }
}

#[test]
fn maps_that_lose_something_are_noticed() {
    let mut random = Random::new(19);
    let size = [261, 191];
    let depth = depths(&mut random, size);
    let regions = regions(&mut random, size, 300);
    let found = |kind: MapKind, spoil: &dyn Fn(&mut Map)| {
        let mut map = map_over(&depth, size, kind);
        spoil(&mut map);
        faults(&depth, size, kind, &map, &regions)
    };
    for kind in kinds() {
        // The last column of the base, as a reduction that rounds sizes down loses it.
        let lost_column = |map: &mut Map| {
            let (width, height) = (map.levels[0].width as usize, map.levels[0].height as usize);
            let mut base = map.texels[..width * height].to_vec();
            base.chunks_mut(width).for_each(|row| row[width - 1] = 1.0);
            *map = Map::over(&base, (map.levels.clone(), map.shape));
        };
        assert_caught(&found(kind, &lost_column), "is nearer");
    }
    for structure in [Structure::NBuffer, Structure::YMap(2)] {
        // Squares that overlap by a texel, and so lack their last row and column.
        let narrow_squares = |map: &mut Map| {
            let squares = map.levels[map.shape.squares_after as usize..].to_vec();
            let (source, doubled) = (squares[1], squares[2]);
            let narrow = double_squares(&map.texels, source, doubled, 1);
            map.texels[doubled.first as usize..][..narrow.len()].copy_from_slice(&narrow);
        };
        assert_caught(&found(MapKind { structure, reduction: 0 }, &narrow_squares), "is nearer");
    }
}
