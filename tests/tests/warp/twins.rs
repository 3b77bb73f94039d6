//! Each stage of the warp against its twin, at sizes that pyramids get wrong and in all settings.

use super::{warp, Pair, OVER_BOXES};
use culling::warp::axes::orient_axes;
use culling::warp::twin::{self, Grid, LastDepth, Search, Tightening};
use culling::warp::{reprojections, Settings};
use glam::DVec3;
use harness::worlds::{shot, walled, Case, PERSPECTIVE};
use harness::{gpu, Lab};
use scenes::Shot;
use shaders::types::TexelMotion;

const SIZES: [[u32; 2]; 9] = [[1, 1], [3, 1], [1, 257], [2, 2], [8, 8], [63, 65], [64, 64], [161, 97], [513, 17]];

fn shots() -> [Shot; 2] {
    let at = |eye: DVec3| shot(eye, DVec3::new(0.1, 0.0, 0.0), PERSPECTIVE);
    [at(DVec3::new(0.7, 0.4, 7.0)), at(DVec3::new(1.1, 0.6, 6.6))]
}

/// The same but for the rounding of a matrix product, which devices may contract.
fn alike(stage: &TexelMotion, twin: &TexelMotion) -> bool {
    let near = |a: f32, b: f32, scale: f32| (a - b).abs() <= scale * 42.0 / 16_777_216.0;
    let places =
        (0..2).all(|axis| near(stage.offset[axis], twin.offset[axis], 1280.0 + 2.0 * stage.offset[axis].abs()));
    places && near(stage.depth, twin.depth, 1.0)
}

fn check(lab: &Lab, pair: &Pair, settings: &Settings, what: &str) {
    let slots = {
        let mut slots = vec![0; lab.world.len()];
        (1..).zip(lab.world.moving()).for_each(|(slot, (object, _))| slots[object as usize] = slot);
        slots
    };
    let matrices = reprojections(&pair.last, &lab.world, &pair.view);
    let depth = Grid { size: pair.view.size, values: &pair.depth[..] };
    let reprojection = |pixel: usize| match slots[pair.items[pixel] as usize] {
        0 => &matrices.camera,
        slot => &matrices.moving[slot - 1],
    };
    let motions = pair.warp.read_motions().unwrap();
    let last = LastDepth { depth, reprojection: &reprojection, reduction: settings.reduction, margin: settings.margin };
    let expected = twin::measure_motion(&last, settings.fastest, settings.footprint);
    let differing = motions.iter().zip(&expected).filter(|(stage, twin)| !alike(stage, twin)).count();
    // Where the new depth is at the near or far plane, rounding may decide whether the texel shows.
    assert!(differing <= motions.len() / 1000, "{what}: {differing} of {} motions", motions.len());

    let texels = pair.warp.texels();
    let motions = Grid { size: texels, values: &motions[..] };
    let (levels, pyramid) = pair.warp.read_pyramid().unwrap();
    let axis = pair.warp.read_axis().unwrap();
    if settings.oriented {
        let expected = orient_axes(motions);
        let apart = (0..2).map(|side| (axis[side] - expected[side]).abs()).fold(0.0, f32::max);
        // A device's square root and division may be off in the last bits.
        assert!(apart < 1e-6, "{what}: {axis:?} instead of {expected:?}");
    } else {
        assert_eq!(axis, [1.0, 0.0], "{what}");
    }
    assert!(pyramid == twin::pyramid(motions, &levels, axis), "{what}: pyramid");
    let tightening = Tightening {
        levels: &levels,
        pyramid: &pyramid,
        coarsest_level: culling::hzb::layout(texels).1,
        texels,
        steps: settings.steps,
        tile: settings.tile,
        keep_last: settings.fill,
        axis,
        lookups: settings.lookups,
    };
    let bounds = pair.warp.read_bounds().unwrap();
    assert!(bounds == twin::tighten_bounds(&tightening), "{what}: bounds");
    let Settings { seeds, iterations, threshold, tile, narrow, fill, .. } = *settings;
    let search = Search { motions, bounds: &bounds, seeds, iterations, threshold, tile, narrow, fill, axis };
    let expected = twin::search_depth(&search, settings.footprint.then_some(&last));
    if settings.footprint {
        // Its depths come from a matrix product again, and so does which of two pixels as far as each other counts.
        let near = |(stage, twin): &(&f32, &f32)| (*stage - *twin).abs() <= 42.0 / 16_777_216.0;
        let differing = pair.warped.iter().zip(&expected).filter(|pair| !near(pair)).count();
        assert!(differing <= expected.len() / 1000, "{what}: {differing} of {} warped depths", expected.len());
    } else {
        assert!(pair.warped == expected, "{what}: warped depth");
    }
}

#[test]
fn every_stage_equals_its_twin_at_any_size() {
    let gpu = gpu();
    let [first, second] = shots();
    for size in SIZES {
        for reduction in [1, 2, 4] {
            let case = walled(60).sized(size);
            let mut lab = Lab::new(&gpu, &case);
            for footprint in [false, true] {
                let settings = Settings { reduction, footprint, stored: true, ..Settings::default() };
                let pair = warp(&mut lab, [&first, &second], settings);
                check(&lab, &pair, &settings, &format!("{size:?} reduced by {reduction}, footprint: {footprint}"));
            }
        }
    }
}

#[test]
fn every_stage_equals_its_twin_in_all_settings() {
    let gpu = gpu();
    let [first, second] = shots();
    let base = Settings { stored: true, ..Settings::default() };
    let all = [
        Settings { seeds: 1, iterations: 1, ..base },
        Settings { seeds: 7, iterations: 5, threshold: 0.125, ..base },
        Settings { steps: 0, tile: 16, ..base },
        Settings { steps: 4, tile: 1, narrow: 0.0, ..base },
        Settings { fill: true, tile: 2, ..base },
        Settings { oriented: true, ..base },
        Settings { fastest: 0.04, ..base },
        Settings { oriented: true, lookups: 4, seeds: 3, fill: true, ..base },
        Settings { lookups: 8, tile: 2, reduction: 2, ..base },
        Settings { footprint: true, margin: 0, reduction: 4, ..base },
        Settings { footprint: true, margin: 2, seeds: 3, ..base },
        Settings { fill: true, steps: 0, narrow: 2.0, reduction: 2, ..base },
    ];
    let mut lab = Lab::new(&gpu, &walled(60));
    for settings in all {
        let pair = warp(&mut lab, [&first, &second], settings);
        check(&lab, &pair, &settings, &format!("{settings:?}"));
    }
}

#[test]
fn every_stage_equals_its_twin_where_objects_move() {
    let gpu = gpu();
    let scene =
        scenes::open("moving-boxes", &scenes::SceneOptions { scale: 0.5, seed: 2, ..Default::default() }).unwrap();
    let at = |seconds: f64| Shot { seconds, ..shot(OVER_BOXES, DVec3::ZERO, PERSPECTIVE) };
    let [first, second] = [at(1.0), at(1.1)];
    let mut lab = Lab::new(&gpu, &Case::new("moving boxes", scene, vec![first, second]));
    for footprint in [false, true] {
        let settings = Settings { footprint, ..Settings::default() };
        let pair = warp(&mut lab, [&first, &second], settings);
        check(&lab, &pair, &settings, &format!("moving boxes, footprint: {footprint}"));
    }
}

#[test]
fn motion_computed_where_it_is_looked_up_is_the_motion_stored() {
    let gpu = gpu();
    let [first, second] = shots();
    let base = Settings::default();
    let all = [
        Settings { reduction: 1, ..base },
        Settings { reduction: 1, fill: true, seeds: 3, ..base },
        Settings { reduction: 1, fastest: 0.04, ..base },
        Settings { reduction: 2, footprint: true, ..base },
        Settings { reduction: 4, footprint: true, margin: 0, tile: 1, ..base },
    ];
    for size in SIZES {
        let mut lab = Lab::new(&gpu, &walled(60).sized(size));
        for settings in &all {
            let computed = warp(&mut lab, [&first, &second], *settings);
            let stored = warp(&mut lab, [&first, &second], Settings { stored: true, ..*settings });
            let what = format!("{size:?}, {settings:?}");
            assert_eq!([computed.warp.has_motions(), stored.warp.has_motions()], [false, true], "{what}");
            assert!(computed.warp.read_pyramid().unwrap() == stored.warp.read_pyramid().unwrap(), "{what}: pyramid");
            let bits = |pair: &Pair| pair.warped.iter().map(|depth| depth.to_bits()).collect::<Vec<_>>();
            assert!(bits(&computed) == bits(&stored), "{what}: warped depth");
        }
    }
}
