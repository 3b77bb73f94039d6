//! Warped depth: what must hold of it whatever the twin says.

use super::{warp, Pair, OVER_BOXES};
use culling::warp::Settings;
use culling::View;
use glam::{DVec3, DVec4};
use harness::worlds::{cube, oblique, shot, sized, square, turned, walled, Case, Maker, PERSPECTIVE};
use harness::{gpu, Lab, Random};
use scenes::{Projection, Shot};

/// The farthest depth of each block of pixels.
fn farthest(depth: &[f32], [width, height]: [u32; 2], reduction: u32) -> Vec<f32> {
    let across = width.div_ceil(reduction);
    let mut farthest = vec![f32::INFINITY; (across * height.div_ceil(reduction)) as usize];
    for (pixel, depth) in depth.iter().enumerate() {
        let (x, y) = (pixel as u32 % width / reduction, pixel as u32 / width / reduction);
        let texel = &mut farthest[(y * across + x) as usize];
        *texel = texel.min(*depth);
    }
    farthest
}

#[test]
fn a_still_camera_warps_to_itself_exactly() {
    let gpu = gpu();
    let moving =
        scenes::open("moving-boxes", &scenes::SceneOptions { scale: 0.3, seed: 2, ..Default::default() }).unwrap();
    let shot_of_moving = Shot { seconds: 2.5, ..shot(OVER_BOXES, DVec3::ZERO, PERSPECTIVE) };
    let parallel = Projection::Orthographic { half_height: 3.5, near: -2.0, far: 30.0 };
    let eye = DVec3::new(0.7, 0.4, 7.0);
    let mut cases = vec![Case::new("moving boxes, stopped", moving, vec![shot_of_moving])];
    for projection in [PERSPECTIVE, Projection::Perspective { fov_y: 1.3, near: 0.01, far: None }, parallel, oblique()]
    {
        cases.push(walled(90).filmed(vec![shot(eye, DVec3::ZERO, projection)]));
    }
    for case in cases {
        for reduction in [1, 2, 4] {
            let mut lab = Lab::new(&gpu, &case);
            let settings = Settings { reduction, ..Settings::default() };
            let pair = warp(&mut lab, [&case.shots[0], &case.shots[0]], settings);
            let expected = farthest(&pair.depth, lab.size, reduction);
            assert!(expected.iter().any(|depth| *depth > 0.0), "{}: an empty picture", case.name);
            assert!(pair.warped == expected, "{} reduced by {reduction}", case.name);
        }
    }
}

/// 10 log10(peak^2 / mean square error) over the pixels given, peak being the nearest true depth.
fn psnr_db(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut sum, mut count, mut peak) = (0.0, 0, 0.0f64);
    for (warped, truth) in pairs {
        sum += f64::from(warped - truth).powi(2);
        count += 1;
        peak = peak.max(truth.into());
    }
    10.0 * (peak * peak * f64::from(count) / sum).log10()
}

#[test]
fn a_wall_is_warped_to_where_it_is() {
    let gpu = gpu();
    let mut maker = Maker::new("wall");
    let square = maker.mesh(square());
    let mut place = sized(DVec3::ZERO, DVec3::splat(60.0));
    place.matrix3 = glam::DMat3::from_rotation_y(0.4) * place.matrix3;
    maker.place(square, place);
    let at = |aside: DVec3| shot(DVec3::new(0.0, 0.3, 7.0) + aside, DVec3::new(0.3, 0.0, 0.0) + aside, PERSPECTIVE);
    // The near end of the last wall grows more than 1.5-fold: neighbours end farther apart than the threshold lets pass.
    let steps = [
        (DVec3::new(0.5, 0.2, 0.0), 5, 0.2),
        (DVec3::new(0.1, -0.1, -0.9), 5, 0.001),
        (DVec3::new(0.0, 0.0, -1.7), 16, 0.01),
    ];
    for (aside, iterations, most_holes) in steps {
        let case = Case::new("wall", maker.scene.clone(), vec![at(DVec3::ZERO), at(aside)]).sized([320, 181]);
        let mut lab = Lab::new(&gpu, &case);
        let pair =
            warp(&mut lab, [&case.shots[0], &case.shots[1]], Settings { seeds: 4, iterations, ..Settings::default() });
        let truth = lab.truth(&case.shots[1]).images().depth.clone();
        // Depth of a plane is affine over the picture, so its slopes are those between any neighbours; the source's motion
        // ends within WARP_REACH of its target, in each direction.
        let slope = |step: usize| {
            (f64::from(truth[40 * 320 + 100 + 32 * step]) - f64::from(truth[40 * 320 + 100])).abs() / 32.0
        };
        let most_error = f64::from(shaders::types::WARP_REACH) * (slope(1) + slope(320)) * 1.001 + 1e-6;
        let found = pair.warped.iter().zip(&truth).filter(|(warped, _)| **warped > 0.0);
        let worst = found.clone().map(|(warped, truth)| f64::from((warped - truth).abs())).fold(0.0, f64::max);
        let holes = 1.0 - found.clone().count() as f64 / truth.len() as f64;
        let psnr = psnr_db(found.map(|(warped, truth)| (*warped, *truth)));
        println!(
            "camera by {aside}: PSNR {psnr:.1} dB, worst {worst:.2e} of {most_error:.2e}, holes {:.1} %",
            100.0 * holes
        );
        assert!(worst <= most_error && holes <= most_holes && psnr > 45.0);
    }
}

/// True for pixels of the new view whose point the last one did not see, nor anything within two pixels of it; and so for
/// the pixels around them, as the source of a neighbour may be taken.
fn unseen(pair: &Pair, truth: &[f32]) -> Vec<bool> {
    let [width, height] = pair.view.size.map(|side| side as i64);
    let last: &View = pair.last.view();
    let seen_at = |index: usize| {
        let (x, y) = (index as i64 % width, index as i64 / width);
        let clip = |at: i64, side: i64| (at as f64 + 0.5) / side as f64 * 2.0 - 1.0;
        let from = pair.view.clip_from_relative().inverse()
            * DVec4::new(clip(x, width), clip(y, height), f64::from(truth[index]), 1.0);
        let there = from.truncate() / from.w + pair.view.pose.position - last.pose.position;
        let place = last.clip_from_relative() * there.extend(1.0);
        let place = place / place.w;
        let pixel = |at: f64, side: i64| ((at + 1.0) * 0.5 * side as f64).floor() as i64;
        let (x, y) = (pixel(place.x, width), pixel(place.y, height));
        let around = (y - 2..=y + 2).flat_map(|y| (x - 2..=x + 2).map(move |x| (x, y)));
        let mut inside = around.filter(|(x, y)| (0..width).contains(x) && (0..height).contains(y));
        inside.any(|(x, y)| f64::from(pair.depth[(y * width + x) as usize]) < place.z * 1.3)
    };
    let unseen: Vec<bool> = (0..truth.len()).map(|index| truth[index] > 0.0 && !seen_at(index)).collect();
    let within = |x: i64, y: i64| (1..width - 1).contains(&x) && (1..height - 1).contains(&y);
    let all_around =
        |x: i64, y: i64| (y - 1..=y + 1).all(|y| (x - 1..=x + 1).all(|x| unseen[(y * width + x) as usize]));
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| within(x, y) && all_around(x, y)).collect()
}

#[test]
fn holes_are_far_and_filled_only_if_asked() {
    let gpu = gpu();
    let mut maker = Maker::new("pillars");
    let cube = maker.mesh(cube());
    maker.place(cube, sized(DVec3::new(0.0, 0.0, -9.0), DVec3::new(60.0, 40.0, 1.0)));
    let mut random = Random::new(5);
    for pillar in 0..3 {
        let place = turned(&mut random, DVec3::new(2.5 * f64::from(pillar) - 2.5, 0.0, 3.0), DVec3::new(0.9, 0.9, 0.9));
        maker.place(cube, place);
    }
    let at = |aside: f64| shot(DVec3::new(aside, 0.0, 7.0), DVec3::new(aside, 0.0, 0.0), PERSPECTIVE);
    let case = Case::new("pillars", maker.scene, vec![at(0.0), at(0.5)]).sized([320, 181]);
    let mut lab = Lab::new(&gpu, &case);
    let plain = warp(&mut lab, [&case.shots[0], &case.shots[1]], Settings::default());
    let filled = warp(&mut lab, [&case.shots[0], &case.shots[1]], Settings { fill: true, ..Settings::default() });
    let truth = lab.truth(&case.shots[1]).images().depth.clone();
    let unseen = unseen(&plain, &truth);
    let holes: Vec<usize> = (0..truth.len()).filter(|index| unseen[*index]).collect();
    let far = |pair: &Pair| holes.iter().filter(|index| pair.warped[**index] <= 0.0).count();
    println!("{} unseen pixels, {} of them far, {} if filled", holes.len(), far(&plain), far(&filled));
    assert!(holes.len() > 500, "the camera's step uncovers nothing");
    assert_eq!(far(&plain), holes.len(), "depth from nowhere");
    assert!(far(&filled) < holes.len() / 10, "holes stay open");
    // What is no hole is not touched by filling.
    let kept = plain.warped.iter().zip(&filled.warped).all(|(plain, filled)| *plain <= 0.0 || plain == filled);
    assert!(kept, "filling changes what was found");
}

#[test]
fn a_skipped_warp_names_every_stage() {
    let gpu = gpu();
    let mut f = gpu.frame();
    culling::warp::Warp::skip(&mut f, "nothing moved");
    let report = f.finish().unwrap();
    let mut skipped: Vec<_> = report.skips.iter().map(|skip| skip.label.as_str()).collect();
    skipped.sort_unstable();
    // Erosion is the occlusion map's, which asks for it or does not.
    let own = |name: &&str| name.starts_with("warp/") && *name != "warp/erode_depth";
    let stages = shaders::STAGES.iter().map(|stage| stage.name).filter(own);
    assert!(stages.eq(skipped));
}

#[test]
fn a_view_that_shares_nothing_is_all_holes() {
    let gpu = gpu();
    let case = walled(90);
    let mut lab = Lab::new(&gpu, &case);
    let eye = DVec3::new(0.7, 0.4, 7.0);
    let [front, back] = [DVec3::ZERO, 2.0 * eye].map(|target| shot(eye, target, PERSPECTIVE));
    let pair = warp(&mut lab, [&front, &back], Settings::default());
    assert!(pair.depth.iter().any(|depth| *depth > 0.0));
    assert!(pair.warped.iter().all(|depth| *depth <= 0.0));
    // And from nothing comes nothing.
    let pair = warp(&mut lab, [&back, &front], Settings { fill: true, ..Settings::default() });
    assert!(pair.warped.iter().all(|depth| *depth <= 0.0));
}
