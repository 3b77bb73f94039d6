//! Pictures are made small without losing a wrong pixel, and only the worst frame is kept.

use super::*;
use crate::measures::metrics::{compare, Truth};
use crate::run::bench::Seen;
use crate::run::Measured;
use culling::{Drawn, Work};

const WIDTH: u32 = 1300;
const HEIGHT: u32 = 7;

/// A frame in which object 0 covers all, but for so many pixels from the first on that show nothing.
fn frame(holes: usize) -> FrameImages {
    let pixels = (WIDTH * HEIGHT) as usize;
    let mut images = FrameImages {
        width: WIDTH,
        height: HEIGHT,
        colour: vec![[200, 100, 40, 255]; pixels],
        depth: vec![0.5; pixels],
        items: vec![0; pixels],
        seen_through: vec![],
    };
    images.colour[..holes].fill([0, 0, 0, 255]);
    images.depth[..holes].fill(0.0);
    images.items[..holes].fill(crate::measures::metrics::NO_ITEM);
    images
}

fn shown(uri: &DataUri) -> image::RgbImage {
    let bytes = uri.strip_prefix("data:image/png;base64,").unwrap();
    let bytes = base64::engine::general_purpose::STANDARD.decode(bytes).unwrap();
    image::load_from_memory(&bytes).unwrap().into_rgb8()
}

fn look(gallery: &mut Gallery, label: &str, frame_number: usize, holes: usize) {
    let truth = Truth::new(frame(0), 1).unwrap();
    let images = frame(holes);
    let measured = Measured {
        bounds_brought: 0,
        error: compare(&truth, &images, &[true]).unwrap(),
        drawn: Drawn { objects: vec![true], ..Drawn::default() },
        overdraw: 1.0,
        counts: vec![4; images.depth.len()],
        work: Work::default(),
        images,
    };
    gallery.look(&Seen { label, frame: frame_number, truth: truth.images(), measured: &measured }).unwrap();
}

#[test]
fn every_pixel_of_the_source_counts_once() {
    for (width, height) in [(1, 1), (640, 3), (641, 480), (1300, 7), (5000, 1), (3, 5000)] {
        let shrink = Shrink::of(width, height);
        assert!(shrink.to[0] <= WIDEST as usize && shrink.to[1] > 0);
        let width = width as usize;
        let seen = std::cell::RefCell::new(vec![0; width * height as usize]);
        let picture = shrink.picture(|covered| {
            assert!(!covered.is_empty());
            covered.iter().for_each(|&pixel| seen.borrow_mut()[pixel] += 1);
            assert!(covered.iter().all(|&pixel| shrink.place_of(pixel) == shrink.place_of(covered[0])));
            [0; 3]
        });
        assert_eq!([picture.width as usize, picture.height as usize], shrink.to);
        let corner = shrink.place_of(seen.borrow().len() - 1);
        assert_eq!([corner[0] + 1, corner[1] + 1], shrink.to);
        assert!(seen.borrow().iter().all(|times| *times == 1), "{width}x{height}");
    }
}

#[test]
fn a_single_wrong_pixel_stays_red() {
    let marked = small_difference(&frame(0), &frame(1));
    assert_eq!(marked.width, WIDEST);
    let count = |colour: [u8; 3]| marked.pixels.iter().filter(|pixel| **pixel == colour).count();
    assert_eq!(count([255, 0, 0]), 1);
    assert!(count([50, 25, 10]) > 600);
}

#[test]
fn a_frame_is_drawn_around_faults_and_only_around_them() {
    let black = || Picture { width: 40, height: 30, pixels: vec![[0; 3]; 40 * 30] };
    let mut none = black();
    frame_around(&mut none, std::iter::empty());
    assert_eq!(none, black());
    let mut one = black();
    frame_around(&mut one, [[20, 15], [22, 15]].into_iter());
    let yellow = |x: usize, y: usize| one.pixels[y * 40 + x] != [0; 3];
    assert!(yellow(14, 15) && yellow(13, 15) && yellow(28, 15) && yellow(20, 9) && yellow(20, 22));
    assert!(!yellow(12, 15) && !yellow(15, 15) && !yellow(20, 15) && !yellow(21, 16) && !yellow(20, 23));
}

#[test]
fn the_worst_frame_is_kept_and_a_right_one_never() {
    let mut gallery = Gallery::new(4, [("a".to_owned(), "a"), ("b".to_owned(), "b")]);
    for (frame, holes) in [0, 3, 9, 5].into_iter().enumerate() {
        look(&mut gallery, "a", frame, holes);
        look(&mut gallery, "b", frame, 0);
    }
    let worst = gallery.of_method["a"].worst.as_ref().unwrap();
    assert_eq!((worst.frame, worst.error.differing_pixels), (2, 9));
    assert!(gallery.of_method["b"].worst.is_none());
    assert_eq!(gallery.frame, 2);
    let [overdraw, items] = gallery.of_method["b"].buffers.as_ref().unwrap();
    assert_eq!(shown(overdraw).get_pixel(0, 0).0, [0, 255, 0], "four fragments are green");
    assert_ne!(shown(items).get_pixel(0, 0).0, [0; 3]);
}

#[test]
fn missed_objects_decide_where_no_colour_differs() {
    let error = |psnr_db, false_negatives| FrameError {
        psnr_db,
        false_negatives,
        ..compare(&Truth::new(frame(0), 1).unwrap(), &frame(0), &[true]).unwrap()
    };
    let differing = |psnr_db| FrameError { differing_pixels: 1, ..error(Some(psnr_db), 0) };
    assert!(!is_worse(&error(None, 0), None));
    assert!(is_worse(&error(None, 1), None));
    assert!(is_worse(&error(None, 2), Some(&error(None, 1))));
    assert!(!is_worse(&error(None, 1), Some(&error(None, 1))));
    assert!(is_worse(&differing(50.0), Some(&error(None, 9))));
    assert!(!is_worse(&differing(50.0), Some(&differing(40.0))));
}

#[test]
fn of_many_settings_only_the_first_of_each_method_keeps_its_buffers() {
    let methods = |count: usize| (0..count).map(|place| (format!("a[{place}]"), "a")).chain([("b".to_owned(), "b")]);
    for (count, kept) in [(15, 16), (16, 2)] {
        let mut gallery = Gallery::new(1, methods(count));
        methods(count).for_each(|(label, _)| look(&mut gallery, &label, 0, 0));
        assert_eq!(gallery.of_method.values().filter(|pictures| pictures.buffers.is_some()).count(), kept);
    }
}
