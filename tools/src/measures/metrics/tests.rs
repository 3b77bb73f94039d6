//! The harness can fail: for each measure something is planted, and the measure must notice it (and the others not).

mod fields;

use super::*;
use proptest::prelude::*;

const WIDTH: u32 = 24;
const HEIGHT: u32 = 16;
const OBJECTS: usize = 70;

/// 70 objects, of which object `i` < 64 owns the `i`-th 2 x 2 block left of column 16 (8 blocks a row, 8 rows) and the
/// others nothing; the right third is background. More than 64 objects: the visible set has two words.
fn picture() -> FrameImages {
    let pixels = (WIDTH * HEIGHT) as usize;
    let mut images = FrameImages {
        width: WIDTH,
        height: HEIGHT,
        colour: vec![[10, 20, 40, 255]; pixels],
        depth: vec![0.0; pixels],
        items: vec![NO_ITEM; pixels],
        seen_through: vec![],
    };
    for y in 0..HEIGHT {
        for x in 0..16 {
            let object = (y / 2) * 8 + x / 2;
            let pixel = (y * WIDTH + x) as usize;
            images.colour[pixel] = [object as u8 * 3, 255 - object as u8, 128, 255];
            images.depth[pixel] = 0.1 + object as f32 / 256.0;
            images.items[pixel] = object;
        }
    }
    images
}

fn truth() -> Truth {
    Truth::new(picture(), OBJECTS).unwrap()
}

fn exactly_the_visible(truth: &Truth) -> Vec<bool> {
    (0..truth.object_count()).map(|object| truth.is_visible(object)).collect()
}

/// Takes the object out of picture and draw list, as a method that wrongly culls it would.
fn without(object: u32, images: &mut FrameImages, drawn: &mut [bool]) {
    for pixel in 0..images.items.len() {
        if images.items[pixel] == object {
            images.items[pixel] = NO_ITEM;
            images.depth[pixel] = 0.0;
            images.colour[pixel] = [10, 20, 40, 255];
        }
    }
    drawn[object as usize] = false;
}

#[test]
fn the_visible_set_is_who_owns_a_pixel() {
    let truth = truth();
    assert_eq!(truth.visible_count(), 64);
    assert!(truth.visible_objects().eq(0..64));
    assert!(!truth.is_visible(64) && !truth.is_visible(OBJECTS) && !truth.is_visible(usize::MAX));
}

#[test]
fn ideal_culling_is_without_error() {
    let truth = truth();
    let error = compare(&truth, &picture(), &exactly_the_visible(&truth)).unwrap();
    let expected = FrameError {
        objects: 70,
        ref_visible: 64,
        drawn: 64,
        culled: 6,
        false_negatives: 0,
        false_positives: 0,
        differing_pixels: 0,
        tied_pixels: 0,
        wrong_colour_pixels: 0,
        psnr_db: None,
        ssim: 1.0,
        culled_over_total: 6.0 / 70.0,
        culled_over_ref: 1.0,
        object_error_percent: 0.0,
    };
    assert_eq!(error, expected);
}

#[test]
fn a_dropped_draw_is_a_false_negative_and_differing_pixels() {
    let truth = truth();
    let (mut images, mut drawn) = (picture(), exactly_the_visible(&truth));
    without(63, &mut images, &mut drawn);
    let error = compare(&truth, &images, &drawn).unwrap();
    assert_eq!((error.false_negatives, error.false_positives), (1, 0));
    assert_eq!((error.differing_pixels, error.tied_pixels), (4, 0));
    assert_eq!(error.object_error_percent, 100.0 / 64.0);
    assert_eq!((error.culled, error.drawn), (7, 63));
    assert_eq!(error.culled_over_ref, 7.0 / 6.0);
    assert!(error.psnr_db.unwrap() < 40.0 && error.ssim < 1.0);
}

#[test]
fn an_object_drawn_in_vain_is_a_false_positive() {
    let truth = truth();
    let mut drawn = exactly_the_visible(&truth);
    drawn[69] = true;
    let error = compare(&truth, &picture(), &drawn).unwrap();
    assert_eq!((error.false_negatives, error.false_positives), (0, 1));
    assert_eq!(error.culled_over_ref, 5.0 / 6.0);
    assert_eq!(error.psnr_db, None);
}

#[test]
fn a_tie_is_counted_apart_and_costs_no_likeness() {
    let truth = truth();
    let (mut images, mut drawn) = (picture(), exactly_the_visible(&truth));
    images.items[0] = 65;
    images.colour[0] = [255, 0, 255, 255];
    drawn[65] = true;
    let error = compare(&truth, &images, &drawn).unwrap();
    assert_eq!(error.tied_pixels, 1);
    assert_eq!((error.differing_pixels, error.wrong_colour_pixels), (0, 0));
    assert_eq!((error.psnr_db, error.ssim), (None, 1.0));
}

#[test]
fn an_undrawn_object_is_a_false_negative_even_if_all_its_pixels_are_ties() {
    let truth = truth();
    let (mut images, mut drawn) = (picture(), exactly_the_visible(&truth));
    for item in images.items.iter_mut().filter(|item| **item == 5) {
        *item = 66;
    }
    (drawn[5], drawn[66]) = (false, true);
    let error = compare(&truth, &images, &drawn).unwrap();
    assert_eq!((error.tied_pixels, error.differing_pixels), (4, 0));
    assert_eq!((error.false_negatives, error.false_positives), (1, 1));
}

#[test]
fn one_bit_of_depth_is_noticed() {
    let truth = truth();
    let mut images = picture();
    images.depth[7] = f32::from_bits(images.depth[7].to_bits() ^ 1);
    let error = compare(&truth, &images, &exactly_the_visible(&truth)).unwrap();
    assert_eq!(error.differing_pixels, 1);
    assert_eq!(error.tied_pixels, 0);
    assert_eq!(error.psnr_db, None, "the picture itself is still the same");
}

#[test]
fn one_step_of_one_channel_is_noticed() {
    let truth = truth();
    for channel in 0..3 {
        let mut images = picture();
        images.colour[0][channel] ^= 1;
        let error = compare(&truth, &images, &exactly_the_visible(&truth)).unwrap();
        assert_eq!(error.wrong_colour_pixels, 1);
        assert_eq!(error.differing_pixels, 0);
        // One squared step in 24 * 16 * 3 samples.
        let expected = 10.0 * (255.0f64.powi(2) * 24.0 * 16.0 * 3.0).log10();
        assert!((error.psnr_db.unwrap() - expected).abs() < 1e-9);
        assert!(error.ssim < 1.0, "channel {channel}: {}", error.ssim);
    }
}

#[test]
fn pictures_smaller_than_a_window_are_compared_as_one_window() {
    for (width, height) in [(1, 1), (1, 9), (7, 3)] {
        let pixels = (width * height) as usize;
        let images = FrameImages {
            width,
            height,
            colour: vec![[200, 100, 50, 255]; pixels],
            depth: vec![0.5; pixels],
            items: vec![0; pixels],
            seen_through: vec![],
        };
        let truth = Truth::new(images.clone(), 1).unwrap();
        let same = compare(&truth, &images, &[true]).unwrap();
        assert_eq!((same.ssim, same.psnr_db), (1.0, None));
        let mut other = images;
        other.colour[0] = [0, 0, 0, 255];
        let error = compare(&truth, &other, &[true]).unwrap();
        assert!(error.ssim < 1.0 && error.psnr_db.is_some());
    }
}

#[test]
fn broken_input_is_an_error_that_says_where() {
    let truth = truth();
    let drawn = exactly_the_visible(&truth);
    let with = |change: fn(&mut FrameImages)| {
        let mut images = picture();
        change(&mut images);
        images
    };
    let nan = with(|i| i.depth[WIDTH as usize + 2] = f32::NAN);
    let (x, y) = (2, 1);
    let frame = "method";
    assert_eq!(compare(&truth, &nan, &drawn), Err(MetricError::NanDepth { frame, x, y }));
    assert!(Truth::new(nan, OBJECTS).is_err());
    let unknown = with(|i| i.items[0] = OBJECTS as u32);
    assert!(matches!(compare(&truth, &unknown, &drawn), Err(MetricError::UnknownItem { item: 70, .. })));
    let denied = with(|i| i.items[0] = 68);
    assert_eq!(compare(&truth, &denied, &drawn), Err(MetricError::NotInDrawList { item: 68 }));
    let short = with(|i| i.depth.truncate(5));
    assert!(matches!(compare(&truth, &short, &drawn), Err(MetricError::Size { image: "depth", found: 5, .. })));
    let turned = with(|i| (i.width, i.height) = (HEIGHT, WIDTH));
    assert!(matches!(compare(&truth, &turned, &drawn), Err(MetricError::Sizes { .. })));
    assert!(matches!(compare(&truth, &picture(), &drawn[1..]), Err(MetricError::DrawListLength { .. })));
    let empty = with(|i| {
        *i = FrameImages { width: 0, height: 0, colour: vec![], depth: vec![], items: vec![], seen_through: vec![] }
    });
    assert!(matches!(Truth::new(empty, 0), Err(MetricError::Size { .. })));
}

#[test]
fn an_empty_view_has_no_error_whatever_is_culled() {
    let mut images = picture();
    images.items.fill(NO_ITEM);
    images.depth.fill(0.0);
    let truth = Truth::new(images.clone(), 3).unwrap();
    let error = compare(&truth, &images, &[false; 3]).unwrap();
    assert_eq!((error.object_error_percent, error.culled_over_ref), (0.0, 1.0));
    let nothing = Truth::new(images.clone(), 0).unwrap();
    let error = compare(&nothing, &images, &[]).unwrap();
    assert_eq!((error.culled_over_total, error.culled_over_ref), (0.0, 1.0));
}

#[test]
fn frames_are_summed_by_their_documented_weights() {
    let truth = truth();
    let drawn = exactly_the_visible(&truth);
    let same = compare(&truth, &picture(), &drawn).unwrap();
    let (mut images, mut fewer) = (picture(), drawn.clone());
    without(0, &mut images, &mut fewer);
    without(1, &mut images, &mut fewer);
    let broken = compare(&truth, &images, &fewer).unwrap();
    let method = MethodErrors::from_frames(&[same.clone(), broken.clone(), same.clone()]).unwrap();
    assert_eq!((method.frames, method.false_negatives), (3, 2));
    assert_eq!(method.false_negative_frames, 1);
    assert_eq!(method.object_error_percent, 100.0 * (2.0 / (3.0 * 64.0)));
    assert_eq!(method.differing_pixels_mean, 8.0 / 3.0);
    assert_eq!(method.psnr_mean_db, broken.psnr_db);
    assert_eq!(method.psnr_worst_db, broken.psnr_db);
    assert_eq!(method.ssim_mean, (1.0 + broken.ssim + 1.0) / 3.0);
    assert_eq!(method.drawn_mean, (64.0 + 62.0 + 64.0) / 3.0);
    assert_eq!(method.culled_over_total, 20.0 / 210.0);
    assert_eq!(method.culled_over_ref, 20.0 / 18.0);
    let worse = FrameError { psnr_db: Some(3.0), wrong_colour_pixels: 2, ..broken.clone() };
    let method = MethodErrors::from_frames(&[broken.clone(), worse]).unwrap();
    assert_eq!(method.psnr_worst_db, Some(3.0));
    assert_eq!(method.psnr_mean_db, Some((broken.psnr_db.unwrap() + 3.0) / 2.0));
    assert_eq!(method.wrong_colour_pixels, 2);
    assert_eq!(MethodErrors::from_frames(&[same]).unwrap().psnr_mean_db, None);
    assert_eq!(MethodErrors::from_frames(&[]), None);
}

proptest! {
    /// Any set of wrongly culled objects: each is counted, with all of its pixels, and nothing else is.
    #[test]
    fn every_dropped_object_is_counted_once(mask in any::<u64>(), extra in 64..OBJECTS) {
        let truth = truth();
        let (mut images, mut drawn) = (picture(), exactly_the_visible(&truth));
        drawn[extra] = true;
        for object in (0..64u32).filter(|object| mask >> object & 1 == 1) {
            without(object, &mut images, &mut drawn);
        }
        let dropped = mask.count_ones() as usize;
        let error = compare(&truth, &images, &drawn).unwrap();
        prop_assert_eq!(error.false_negatives, dropped);
        prop_assert_eq!(error.false_positives, 1);
        prop_assert_eq!(error.differing_pixels, 4 * dropped);
        prop_assert_eq!(error.psnr_db.is_none(), dropped == 0);
        prop_assert_eq!(error.ssim == 1.0, dropped == 0);
        prop_assert_eq!(error.drawn + error.culled, OBJECTS);
        prop_assert_eq!(error.drawn, error.ref_visible - error.false_negatives + error.false_positives);
    }

    /// More error is never less noise.
    #[test]
    fn psnr_falls_as_pixels_are_spoilt(pixels in prop::collection::vec(0..(WIDTH * HEIGHT) as usize, 1..30)) {
        let truth = truth();
        let drawn = exactly_the_visible(&truth);
        let mut images = picture();
        let mut before = f64::INFINITY;
        for pixel in pixels {
            images.colour[pixel] = truth.images().colour[pixel].map(|channel| channel ^ 128);
            let error = compare(&truth, &images, &drawn).unwrap();
            let now = error.psnr_db.unwrap();
            prop_assert!(now <= before && error.ssim < 1.0);
            before = now;
        }
    }
}

#[test]
fn two_methods_are_compared_without_the_truth() {
    let one = picture();
    assert_eq!(psnr_between(&one, &one).unwrap(), None);
    // A tie is as alike as the truth's ties are.
    let mut tied = picture();
    (tied.items[0], tied.colour[0]) = (69, [255, 255, 255, 255]);
    assert_eq!(psnr_between(&one, &tied).unwrap(), None);
    let mut other = picture();
    (other.depth[0], other.colour[0]) = (0.9, [100, 255, 128, 255]);
    let mean = 100.0f64.powi(2) / f64::from(WIDTH * HEIGHT * 3);
    let expected = 10.0 * (255.0f64.powi(2) / mean).log10();
    assert!((psnr_between(&one, &other).unwrap().unwrap() - expected).abs() < 1e-9);
    other.width = 12;
    assert!(matches!(psnr_between(&one, &other), Err(MetricError::Sizes { .. })));
}
