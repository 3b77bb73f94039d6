//! `farthest/test_bounds` against its twin: random boxes and maps of every kind, every kind of camera.

use crate::maps::{kinds, map_over};
use culling::farthest::twin::test_bounds;
use culling::farthest::{MapKind, Structure};
use engine::{Buffer, Gpu, Placement};
use harness::occludees::Occludees;
use harness::worlds::special_projections;
use harness::{gpu, guarded, Random};
use scenes::{Pose, Shot};

const SIZE: [u32; 2] = [161, 97];
/// The last block is not full.
const BOXES: usize = 2_007;

/// What the stage finds visible.
fn run(gpu: &Gpu, input: &Occludees, kept: &[u32], kind: MapKind) -> Vec<u32> {
    let map = map_over(&input.depth, SIZE, kind);
    let storage = Placement::Storage;
    let texels = Buffer::with_data(gpu, "test.texels", &map.texels, storage).unwrap();
    let levels = Buffer::with_data(gpu, "test.levels", &map.levels, storage).unwrap();
    let bounds = Buffer::with_data(gpu, "test.bounds", &input.bounds, storage).unwrap();
    let kept = Buffer::with_data(gpu, "test.kept", kept, storage).unwrap();
    let blocks = culling::world::listed_blocks((BOXES as u32).div_ceil(shaders::types::BLOCK_OBJECTS));
    let blocks = Buffer::with_data(gpu, "test.blocks", &blocks, storage).unwrap();
    let visible = guarded::words(gpu, BOXES);
    let stage = shaders::farthest::TestBounds {
        bounds: bounds.all(),
        kept: kept.all(),
        levels: levels.all(),
        texels: texels.all(),
        blocks: blocks.all(),
        visible: visible.all(),
        view: input.view,
        shape: map.shape,
        object_count: BOXES as u32,
    };
    let mut f = gpu.frame();
    f.dispatch_indirect(stage, blocks.all());
    f.finish().unwrap();
    guarded::read(&visible)
}

/// The twin's visible set with every quantity shifted by `step` of its rounding.
fn twin(input: &Occludees, kept: &[u32], kind: MapKind, step: f32) -> Vec<u32> {
    let shifted = input.shifted(step);
    test_bounds(&shifted.bounds, kept, &shifted.view, &map_over(&shifted.depth, SIZE, kind))
}

/// Boxes before a camera somewhere, and which of them are in the view volume.
fn input(random: &mut Random, gpu: &Gpu, projection: scenes::Projection, far_off: f64) -> (Occludees, Vec<u32>) {
    let pose = Pose { position: random.vector() * far_off, rotation: random.turn() };
    let shot = Shot { pose, projection, seconds: 0.0 };
    let occludees = Occludees::by_chance(random, &shot, SIZE, gpu.snap_px(), BOXES);
    // Without the test of the view volume, which has tests of its own.
    let kept = (0..BOXES).map(|_| u32::from(random.below(8) > 0)).collect();
    (occludees, kept)
}

#[test]
fn bounds_are_seen_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(43);
    let (mut all, mut shown, mut differ, mut open) = (0, 0, 0, 0);
    for (round, (name, projection)) in special_projections().into_iter().enumerate() {
        let (input, kept) = input(&mut random, &gpu, projection, [1.0, 1e3, 1e6][round % 3]);
        for kind in kinds() {
            let visible = run(&gpu, &input, &kept, kind);
            let [most, least, exact] = [1.0, -1.0, 0.0].map(|step| twin(&input, &kept, kind, step));
            for object in 0..BOXES {
                let (found, range) = (visible[object], least[object]..=most[object]);
                let place = || format!("{name}, {kind:?}: {:?}", input.bounds[object]);
                assert!(range.contains(&found), "stage {found}, twin {}, {range:?}: {}", exact[object], place());
                differ += usize::from(found != exact[object]);
                open += usize::from(range.start() != range.end());
            }
            all += BOXES;
            shown += visible.iter().sum::<u32>() as usize;
        }
    }
    println!("{all} boxes, {shown} visible, {differ} differ from the twin, {open} within roundings of a tie");
    assert!(shown > all / 5 && shown < all * 4 / 5, "{shown} of {all} visible: the input proves little");
    assert!(
        open < all / 50,
        "{open} of {all} boxes are within roundings of a tie: the band is too wide to prove anything"
    );
    assert!(differ < all / 1000, "stage and twin differ in {differ} of {all}");
}

/// What a coarser map hides, a finer one hides too: each structure's units are whole squares of the next one's.
#[test]
fn finer_maps_hide_no_less() {
    let gpu = gpu();
    let mut random = Random::new(44);
    let of = |structure, reduction| MapKind { structure, reduction };
    let (n_buffer, y_map, mip) = (Structure::NBuffer, Structure::YMap(2), Structure::Mip);
    let pairs = [
        (of(n_buffer, 0), of(y_map, 0)),
        (of(y_map, 0), of(mip, 0)),
        (of(n_buffer, 0), of(n_buffer, 1)),
        (of(n_buffer, 1), of(n_buffer, 2)),
    ];
    let mut gained = [0; 4];
    for (name, projection) in special_projections() {
        let (mut input, kept) = input(&mut random, &gpu, projection, 1.0);
        // A near wall with holes here and there: what shows depends on how far beyond its region a map looks.
        let wall = |random: &mut Random| if random.below(300) == 0 { 0.0 } else { 1.0 };
        input.depth.fill_with(|| wall(&mut random));
        for (gained, (finer, coarser)) in gained.iter_mut().zip(pairs) {
            let (fine, coarse) = (run(&gpu, &input, &kept, finer), run(&gpu, &input, &kept, coarser));
            let worse = fine.iter().zip(&coarse).filter(|(fine, coarse)| fine > coarse).count();
            assert_eq!(worse, 0, "{name}: {finer:?} shows what {coarser:?} hides");
            *gained += fine.iter().zip(&coarse).filter(|(fine, coarse)| fine < coarse).count();
        }
    }
    println!("hidden by the finer map alone: {gained:?}");
    assert!(gained.iter().all(|gained| *gained > 50), "hardly any map was finer: {gained:?}");
}
