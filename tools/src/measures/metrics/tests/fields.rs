//! Every count and figure is tied to its own source: in the fixtures no two of them are equal.

use super::*;

/// Four frames of which three err, each otherwise. In every field the sum, the mean, the median, the extremes and the last value differ.
fn unlike_frames() -> [FrameError; 4] {
    let frame =
        |[objects, ref_visible, drawn]: [usize; 3], [missing, differing, tied, colour]: [usize; 4], psnr_db, ssim| {
            FrameError {
                objects,
                ref_visible,
                drawn,
                culled: objects - drawn,
                false_negatives: missing,
                false_positives: drawn + missing - ref_visible,
                differing_pixels: differing,
                tied_pixels: tied,
                wrong_colour_pixels: colour,
                psnr_db,
                ssim,
                // No sum may take these: they are shares of one frame.
                culled_over_total: 101.0,
                culled_over_ref: 103.0,
                object_error_percent: 107.0,
            }
        };
    [
        frame([100, 50, 60], [2, 30, 7, 1], Some(40.0), 0.875),
        frame([120, 44, 70], [0, 0, 0, 0], None, 1.0),
        frame([80, 20, 30], [5, 90, 11, 4], Some(20.0), 0.25),
        frame([100, 30, 41], [1, 2, 3, 0], Some(45.0), 0.9375),
    ]
}

#[test]
fn each_figure_of_a_method_is_its_own_sum_or_mean() {
    let expected = MethodErrors {
        frames: 4,
        false_negatives: 8,
        false_negative_frames: 3,
        false_positives: 12 + 26 + 15 + 12,
        object_error_percent: 100.0 * 8.0 / 144.0,
        differing_pixels_mean: 30.5,
        tied_pixels_mean: 5.25,
        wrong_colour_pixels: 5,
        psnr_mean_db: Some(35.0),
        psnr_worst_db: Some(20.0),
        ssim_mean: 0.765_625,
        drawn_mean: 50.25,
        ref_visible_mean: 36.0,
        culled_over_total: 199.0 / 400.0,
        culled_over_ref: 199.0 / 256.0,
    };
    let found = MethodErrors::from_frames(&unlike_frames()).unwrap();
    let percent = found.object_error_percent;
    assert!((percent - expected.object_error_percent).abs() < 1e-12, "{percent}");
    assert_eq!(MethodErrors { object_error_percent: expected.object_error_percent, ..found }, expected);
}

#[test]
fn a_frame_without_faults_keeps_its_other_counts() {
    let [frame, ..] = unlike_frames();
    let excused = frame.clone().without_faults();
    let faults = FrameError {
        false_negatives: 2,
        differing_pixels: 30,
        object_error_percent: 107.0,
        psnr_db: Some(40.0),
        ssim: 0.875,
        ..excused.clone()
    };
    assert_eq!(faults, frame);
    let FrameError { false_negatives, differing_pixels, object_error_percent, psnr_db, ssim, .. } = excused;
    assert_eq!((false_negatives, differing_pixels), (0, 0));
    assert_eq!((object_error_percent, psnr_db, ssim), (0.0, None, 1.0));
}

#[test]
fn each_count_of_a_frame_is_its_own() {
    let truth = truth();
    let (mut images, mut drawn) = (picture(), exactly_the_visible(&truth));
    // Three visible objects are missing, and two are drawn in vain.
    [1, 2, 9].into_iter().for_each(|object| without(object, &mut images, &mut drawn));
    (drawn[65], drawn[69]) = (true, true);
    // One of the two wins all four pixels of object 63 and one of object 62.
    let ties = (0..images.items.len()).filter(|&pixel| images.items[pixel] == 63).chain([15 * WIDTH as usize + 12]);
    for pixel in ties.collect::<Vec<_>>() {
        (images.items[pixel], images.colour[pixel]) = (69, [255; 4]);
    }
    for pixel in 0..2 {
        images.colour[pixel][1] ^= 8;
    }
    let error = compare(&truth, &images, &drawn).unwrap();
    let squared = |pixel: usize| -> f64 {
        let (a, b) = (truth.images().colour[pixel], images.colour[pixel]);
        let differs = truth.images().depth[pixel] == images.depth[pixel] && images.items[pixel] == 69;
        if differs {
            0.0
        } else {
            (0..3).map(|c| (f64::from(a[c]) - f64::from(b[c])).powi(2)).sum()
        }
    };
    let mean = (0..images.colour.len()).map(squared).sum::<f64>() / f64::from(WIDTH * HEIGHT * 3);
    let psnr = 10.0 * (255.0f64.powi(2) / mean).log10();
    assert!((error.psnr_db.unwrap() - psnr).abs() < 1e-9, "{error:?}");
    let expected = FrameError {
        objects: 70,
        ref_visible: 64,
        drawn: 63,
        culled: 7,
        false_negatives: 3,
        false_positives: 2,
        differing_pixels: 12,
        tied_pixels: 5,
        wrong_colour_pixels: 2,
        culled_over_total: 7.0 / 70.0,
        culled_over_ref: 7.0 / 6.0,
        object_error_percent: 100.0 * (3.0 / 64.0),
        ..error.clone()
    };
    assert_eq!(error, expected);
}

/// Likeness is the mean over blocks of 8 x 8 pixels, and of the channels the least.
#[test]
fn likeness_is_that_of_the_worst_channel() {
    let truth = truth();
    let drawn = exactly_the_visible(&truth);
    let likeness = |spoilt: &[(usize, u8)]| {
        let mut images = picture();
        for (channel, step) in spoilt {
            // Every other pixel of the block in the top left corner.
            for pixel in (0..8).flat_map(|y| (0..8).map(move |x| y * WIDTH as usize + x)).step_by(2) {
                images.colour[pixel][*channel] ^= step;
            }
        }
        compare(&truth, &images, &drawn).unwrap().ssim
    };
    let [red, blue] = [likeness(&[(0, 8)]), likeness(&[(2, 64)])];
    assert!(blue < red && red < 1.0, "{red} {blue}");
    assert_eq!(likeness(&[(0, 8), (2, 64)]), blue);
    // Five of the six blocks are alike, and no block is less alike than not at all.
    assert!(blue >= 5.0 / 6.0 - 1.0 / 6.0, "{blue}");
}
