//! `hzb/test_bounds` against its twin: random boxes and pyramids, every kind of camera.

use culling::hzb::twin::{self, PyramidTest};
use engine::{Buffer, Gpu, Placement};
use harness::occludees::Occludees;
use harness::worlds::special_projections;
use harness::{gpu, guarded, Random};
use scenes::{Pose, Shot};

const SIZE: [u32; 2] = [161, 97];
/// The last block is not full.
const BOXES: usize = 8_007;

struct Input {
    occludees: Occludees,
    seen: Vec<u32>,
    texels: u32,
}

fn input(random: &mut Random, shot: &Shot, snap_px: f32, texels: u32) -> Input {
    let occludees = Occludees::by_chance(random, shot, SIZE, snap_px, BOXES);
    let seen = (0..BOXES).map(|_| random.below(2) as u32).collect();
    Input { occludees, seen, texels }
}

/// What the stage leaves in `seen` and `newly`.
fn run(gpu: &Gpu, input: &Input) -> [Vec<u32>; 2] {
    let (levels, coarsest_level) = culling::hzb::layout(SIZE);
    let storage = Placement::Storage;
    let texels =
        Buffer::with_data(gpu, "test.texels", &twin::pyramid(&input.occludees.depth, SIZE, &levels), storage).unwrap();
    let levels = Buffer::with_data(gpu, "test.levels", &levels, storage).unwrap();
    let bounds = Buffer::with_data(gpu, "test.bounds", &input.occludees.bounds, storage).unwrap();
    let (seen, newly) = (guarded::words(gpu, BOXES), guarded::words(gpu, BOXES));
    let blocks = culling::world::listed_blocks((BOXES as u32).div_ceil(shaders::types::BLOCK_OBJECTS));
    let blocks = Buffer::with_data(gpu, "test.blocks", &blocks, storage).unwrap();
    let seen_before = Buffer::with_data(gpu, "test.seen_before", &input.seen, storage).unwrap();
    let stage = shaders::hzb::TestBounds {
        bounds: bounds.all(),
        levels: levels.all(),
        pyramid: texels.all(),
        seen_before: seen_before.all(),
        seen: seen.all(),
        newly: newly.all(),
        blocks: blocks.all(),
        view: input.occludees.view,
        object_count: BOXES as u32,
        coarsest_level,
        constants: shaders::hzb::TestBoundsConstants { footprint_texels: input.texels, finest_level: 1 },
    };
    let mut f = gpu.frame();
    f.dispatch_indirect(stage, blocks.all());
    f.finish().unwrap();
    [guarded::read(&seen), guarded::read(&newly)]
}

/// The twin's visible set with every quantity shifted by its rounding.
fn shifted(input: &Input, step: f32) -> Vec<u32> {
    let (levels, coarsest_level) = culling::hzb::layout(SIZE);
    let Occludees { bounds, depth, view, .. } = input.occludees.shifted(step);
    let texels = twin::pyramid(&depth, SIZE, &levels);
    let test = PyramidTest {
        levels: &levels,
        texels: &texels,
        coarsest_level,
        footprint_texels: input.texels,
        finest_level: 1,
    };
    bounds.iter().map(|bounds| u32::from(twin::is_visible(bounds, &view, &test))).collect()
}

#[test]
fn bounds_are_seen_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(41);
    let (mut all, mut visible, mut differ, mut open) = (0, 0, 0, 0);
    for (name, projection) in special_projections() {
        for (round, texels) in [4, 2, 16].into_iter().enumerate() {
            let pose = Pose { position: random.vector() * [1.0, 1e3, 1e6][round], rotation: random.turn() };
            let input = input(&mut random, &Shot { pose, projection, seconds: 0.0 }, gpu.snap_px(), texels);
            let [seen, newly] = run(&gpu, &input);
            let (most, least, twin) = (shifted(&input, 1.0), shifted(&input, -1.0), shifted(&input, 0.0));
            for object in 0..BOXES {
                let place = || format!("{name}, {texels} texels: {:?}", input.occludees.bounds[object]);
                assert!(least[object] <= most[object], "{}", place());
                assert!(
                    (least[object]..=most[object]).contains(&seen[object]),
                    "stage {}, twin {}: {}",
                    seen[object],
                    twin[object],
                    place()
                );
                assert_eq!(newly[object], u32::from(seen[object] == 1 && input.seen[object] == 0), "{}", place());
                differ += usize::from(seen[object] != twin[object]);
                open += usize::from(least[object] != most[object]);
            }
            all += BOXES;
            visible += seen.iter().sum::<u32>() as usize;
        }
    }
    println!("{all} boxes, {visible} visible, {differ} differ from the twin, {open} within roundings of a tie");
    assert!(visible > all / 5 && visible < all * 4 / 5, "{visible} of {all} visible: the input proves little");
    assert!(
        open < all / 50,
        "{open} of {all} boxes are within roundings of a tie: the band is too wide to prove anything"
    );
    assert!(differ < all / 1000, "stage and twin differ in {differ} of {all}");
}
