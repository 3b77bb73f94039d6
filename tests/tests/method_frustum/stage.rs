//! `frustum/test_bounds` on random boxes and cameras of every kind.

use culling::frustum::twin;
use culling::world::{listed_blocks, unlisted_blocks};
use culling::View;
use engine::{Buffer, Gpu, Placement};
use harness::guarded::{self, UNTOUCHED};
use harness::worlds::special_projections;
use harness::{gpu, Random};
use scenes::{Pose, Shot};
use shaders::types::{Bounds, CullView, BLOCK_OBJECTS, OBJECT_ALWAYS_KEPT};

pub const BOXES: usize = 10_000;

/// Which boxes are kept, of those in `blocks`; others stay untouched.
fn run(gpu: &Gpu, bounds: &[Bounds], blocks: &[u32], view: CullView) -> Vec<u32> {
    let input = Buffer::with_data(gpu, "test.bounds", bounds, Placement::Storage).unwrap();
    let kept = guarded::words(gpu, bounds.len());
    let list = Buffer::with_data(gpu, "test.blocks", &list_of(blocks), Placement::Storage).unwrap();
    let object_count = bounds.len() as u32;
    let stage =
        shaders::frustum::TestBounds { bounds: input.all(), blocks: list.all(), kept: kept.all(), view, object_count };
    let mut f = gpu.frame();
    f.dispatch_indirect(stage, list.all());
    f.finish().unwrap();
    guarded::read(&kept)
}

/// Which boxes are in view as bounds of blocks, in order.
fn run_blocks(gpu: &Gpu, bounds: &[Bounds], view: CullView) -> Vec<u32> {
    let input = Buffer::with_data(gpu, "test.bounds", bounds, Placement::Storage).unwrap();
    let header = [0, 1, 1, 0];
    let words: Vec<u32> = header.into_iter().chain(bounds.iter().map(|_| 7)).collect();
    let list = Buffer::with_data(gpu, "test.blocks", &words, Placement::Storage).unwrap();
    let block_count = bounds.len() as u32;
    let stage = shaders::frustum::TestBlocks { bounds: input.all(), blocks: list.all(), view, block_count };
    let mut f = gpu.frame();
    f.dispatch(stage, block_count);
    f.finish().unwrap();
    let list = list.read().unwrap();
    let mut blocks = unlisted_blocks(&list).to_vec();
    blocks.sort_unstable();
    assert_eq!(list[..3], [blocks.len() as u32, 1, 1], "the grid is not one work group a block");
    blocks
}

/// A list of some blocks, as stages take it.
pub fn list_of(blocks: &[u32]) -> Vec<u32> {
    let header = &listed_blocks(blocks.len() as u32)[..4];
    [header, blocks].concat()
}

pub fn all_blocks() -> Vec<u32> {
    (0..BOXES.div_ceil(BLOCK_OBJECTS as usize) as u32).collect()
}

/// Boxes around a camera, many of them touching a plane of its view volume to within roundings.
pub fn boxes(random: &mut Random, shot: &Shot, view: &View) -> Vec<Bounds> {
    let world_from_clip = view.clip_from_relative().inverse();
    let any = |random: &mut Random| {
        let clip = glam::DVec4::new(random.range(-1.5, 1.5), random.range(-1.5, 1.5), random.decade(1e-6, 1.5), 1.0);
        let at = world_from_clip * clip;
        let relative = if at.w.abs() > 1e-9 { at.truncate() / at.w } else { random.vector() };
        let distance = relative.length().max(1e-3);
        let mut half = random.vector().abs() * distance * random.decade(1e-5, 1.0);
        if random.below(8) == 0 {
            half[random.below(3)] = 0.0;
        }
        (relative, half)
    };
    let bound = |random: &mut Random, index: usize| {
        let (mut relative, half) = any(random);
        if index.is_multiple_of(2) {
            // Moves the box until it just touches the plane.
            let clip = view.clip_from_relative();
            let widen = [1.0, 1.0];
            let plane = twin::planes(widen)[random.below(6)].as_dvec4();
            let row = glam::DVec3::new(plane.dot(clip.x_axis), plane.dot(clip.y_axis), plane.dot(clip.z_axis));
            let value = row.dot(relative) + plane.dot(clip.w_axis) + row.abs().dot(half);
            if row.length_squared() > 0.0 {
                relative -= row * (value / row.length_squared());
            }
        }
        let (centre_high, centre_low) = culling::world::split(relative + shot.pose.position);
        let flags = [0, 0, 0, 1, 2][random.below(5)];
        Bounds { centre_high, centre_low, half_extent: half.as_vec3().to_array(), flags }
    };
    (0..BOXES).map(|index| bound(random, index)).collect()
}

#[test]
fn boxes_are_kept_as_twin_and_oracle_say() {
    let gpu = gpu();
    let mut random = Random::new(21);
    let (mut near_ties, mut kept_outside, mut all) = (0, 0, 0);
    for (name, projection) in special_projections() {
        for away in [0.0, 1e3, 1e6] {
            let pose = Pose { position: random.vector() * away, rotation: random.turn() };
            let shot = Shot { pose, projection, seconds: 0.0 };
            let view = View::new(&shot, [161, 97], 0, gpu.snap_px());
            let bounds = boxes(&mut random, &shot, &view);
            let kept = run(&gpu, &bounds, &all_blocks(), view.cull());
            let twin = twin::test_bounds(&bounds, &all_blocks(), &view.cull());
            let kept_boxes =
                |kept: &[u32]| (0..BOXES as u32).filter(|index| kept[*index as usize] == 1).collect::<Vec<_>>();
            assert_eq!(kept_boxes(&twin), twin::test_blocks(&bounds, &view.cull()));
            let blocks = run_blocks(&gpu, &bounds, view.cull());
            assert_eq!(kept_boxes(&kept), blocks, "{name}: blocks are tested otherwise than objects");
            for ((bound, kept), twin) in bounds.iter().zip(&kept).zip(&twin) {
                let margin = twin::oracle_margin(bound, &view.cull());
                all += 1;
                near_ties += usize::from(kept != twin);
                kept_outside += usize::from(margin < 0.0 && *kept == 1);
                if margin >= -twin::KEPT_BAND {
                    assert_eq!(*kept, 1, "{name}, {away} m out: {bound:?} is inside by {margin:e} but was culled");
                }
                if margin < -twin::ROUNDING_BAND {
                    assert_eq!(*kept, 0, "{name}, {away} m out: {bound:?} is outside by {margin:e} but was kept");
                }
                let in_band = (-twin::ROUNDING_BAND..-twin::KEPT_BAND).contains(&margin);
                assert!(kept == twin || in_band, "{name}: stage {kept}, twin {twin}, margin {margin:e}: {bound:?}");
            }
        }
    }
    assert!(all >= 100_000, "{all} boxes are too few");
    assert!(kept_outside > all / 100, "hardly any box lies near a plane: {kept_outside} of {all}");
    assert!(near_ties < all / 100, "stage and twin differ in {near_ties} of {all}");
}

#[test]
fn objects_of_blocks_out_of_view_are_not_looked_at() {
    let gpu = gpu();
    let mut random = Random::new(23);
    let shot = Shot {
        pose: Pose { position: random.vector(), rotation: random.turn() },
        projection: special_projections()[0].1,
        seconds: 0.0,
    };
    let view = View::new(&shot, [161, 97], 0, gpu.snap_px());
    let bounds = boxes(&mut random, &shot, &view);
    let blocks: Vec<u32> = all_blocks().into_iter().filter(|_| random.below(2) == 1).collect();
    let kept = run(&gpu, &bounds, &blocks, view.cull());
    let whole = run(&gpu, &bounds, &all_blocks(), view.cull());
    for (object, (kept, whole)) in kept.iter().zip(whole).enumerate() {
        let looked_at = blocks.contains(&(object as u32 / BLOCK_OBJECTS));
        assert_eq!(*kept, if looked_at { whole } else { UNTOUCHED }, "object {object}");
    }
    assert!(kept.contains(&1) && kept.contains(&0) && kept.contains(&UNTOUCHED));
}

#[test]
fn what_is_left_out_as_too_small_is_what_the_twin_leaves_out() {
    let gpu = gpu();
    let mut random = Random::new(22);
    let (mut left_out, mut differ, mut all) = (0, 0, 0);
    for (_, projection) in special_projections() {
        let pose = Pose { position: random.vector(), rotation: random.turn() };
        let shot = Shot { pose, projection, seconds: 0.0 };
        let view = View::new(&shot, [161, 97], 0, gpu.snap_px());
        let bounds = boxes(&mut random, &shot, &view);
        let (whole, detailed) = (view.cull(), view.without_details(9.0).cull());
        let (kept, without) = (run(&gpu, &bounds, &all_blocks(), whole), run(&gpu, &bounds, &all_blocks(), detailed));
        let twin = twin::test_bounds(&bounds, &all_blocks(), &detailed);
        for index in 0..bounds.len() {
            assert!(without[index] <= kept[index], "{:?} is kept because it is small", bounds[index]);
            left_out += kept[index] - without[index];
            differ += usize::from(without[index] != twin[index]);
            all += 1;
        }
    }
    assert!(left_out as usize > all / 10, "hardly any box is small: {left_out} of {all}");
    assert!(differ < all / 100, "stage and twin differ in {differ} of {all}");
}

#[test]
fn boxes_without_a_meaning_are_kept() {
    let gpu = gpu();
    let shot = harness::worlds::shot(glam::DVec3::ZERO, glam::DVec3::NEG_Z, harness::worlds::PERSPECTIVE);
    let view = View::new(&shot, [8, 8], 0, gpu.snap_px()).cull();
    let odd = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, 0.0];
    let mut bounds: Vec<Bounds> = Vec::new();
    for centre in odd {
        for half in odd {
            let flags = if centre.is_finite() && half.is_finite() && half >= 0.0 { 0 } else { OBJECT_ALWAYS_KEPT };
            bounds.push(Bounds {
                centre_high: [centre; 3],
                centre_low: [0.0; 3],
                half_extent: [half.max(0.0); 3],
                flags,
            });
        }
    }
    let kept = run(&gpu, &bounds, &[0], view);
    for (bound, kept) in bounds.iter().zip(kept) {
        assert!(kept == 1 || bound.flags == 0, "{bound:?} has no meaning, but was culled");
    }
}
