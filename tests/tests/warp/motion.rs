//! `warp/measure_motion` against a reprojection in f64.

use super::{warp, Pair, OVER_BOXES};
use culling::warp::Settings;
use culling::View;
use glam::{DAffine3, DVec3, DVec4};
use harness::worlds::{oblique, shot, walled, Case, PERSPECTIVE};
use harness::{assert_none, gpu, Lab};
use scenes::{Projection, Shot};

/// The law: pixels, for motions of up to 200.
const MOST_ERROR_PX: f64 = 0.01;
const LONGEST_PX: f64 = 200.0;
/// Depth is z'/w' with both off by 20u at most (moved.glsl derives it) and twice more by u for the quotient.
const MOST_DEPTH_ERROR: f64 = 42.0 / 16_777_216.0;

fn stored() -> Settings {
    Settings { stored: true, ..Settings::default() }
}

/// Where a pixel of the last view goes, in pixels, and its depth there; none if it lies behind the eye.
fn oracle(last: &View, view: &View, moved: &DAffine3, pixel: [u32; 2], depth: f32) -> Option<(f64, f64, f64)> {
    let [width, height] = last.size.map(f64::from);
    let (x, y) = (f64::from(pixel[0]) + 0.5, f64::from(pixel[1]) + 0.5);
    let clip = DVec4::new(x / width * 2.0 - 1.0, y / height * 2.0 - 1.0, f64::from(depth), 1.0);
    let relative = last.clip_from_relative().inverse() * clip;
    let there = moved.transform_point3(relative.truncate() / relative.w + last.pose.position);
    let now = view.clip_from_relative() * (there - view.pose.position).extend(1.0);
    let place = now / now.w;
    (now.w > 0.0).then_some(((place.x + 1.0) * 0.5 * width - x, (place.y + 1.0) * 0.5 * height - y, place.z))
}

/// The worst error in pixels, and faults; `before` and `now` are the moving objects' places.
fn compare(pair: &Pair, before: &[(u32, DAffine3)], now: &[(u32, DAffine3)]) -> (f64, Vec<String>) {
    let motions = pair.warp.read_motions().unwrap();
    let [width, _] = pair.view.size;
    let (mut worst, mut compared, mut faults) = (0.0f64, 0, Vec::new());
    for (index, motion) in motions.iter().enumerate() {
        let pixel = [index as u32 % width, index as u32 / width];
        if pair.depth[index] == 0.0 {
            if motion.depth != 0.0 {
                faults.push(format!("{pixel:?}: background moves"));
            }
            continue;
        }
        let place =
            |places: &[(u32, DAffine3)]| places.iter().find(|(object, _)| *object == pair.items[index]).map(|p| p.1);
        let moved = place(before).zip(place(now)).map_or(DAffine3::IDENTITY, |(before, now)| now * before.inverse());
        let expected = oracle(pair.last.view(), &pair.view, &moved, pixel, pair.depth[index]);
        let Some((x, y, depth)) = expected.filter(|(x, y, _)| x.hypot(*y) < LONGEST_PX) else { continue };
        let shows = depth > MOST_DEPTH_ERROR && depth < 1.0 - MOST_DEPTH_ERROR;
        if !shows {
            continue;
        }
        compared += 1;
        let error = (f64::from(motion.offset[0]) - x).hypot(f64::from(motion.offset[1]) - y);
        worst = worst.max(error);
        let depth_error = (f64::from(motion.depth) - depth).abs();
        if error.is_nan() || error > MOST_ERROR_PX || depth_error.is_nan() || depth_error > MOST_DEPTH_ERROR {
            faults.push(format!("{pixel:?}: {motion:?} instead of {x}, {y}, {depth}"));
        }
    }
    if compared < motions.len() / 20 {
        faults.push(format!("only {compared} of {} pixels could be compared", motions.len()));
    }
    (worst, faults)
}

fn still_cases() -> Vec<(&'static str, Case, [Shot; 2])> {
    let case = walled(80);
    let projections = [
        ("perspective", PERSPECTIVE),
        ("no far plane", Projection::Perspective { fov_y: 1.2, near: 0.001, far: None }),
        ("far away far plane", Projection::Perspective { fov_y: 1.2, near: 0.01, far: Some(1e7) }),
        ("parallel", Projection::Orthographic { half_height: 4.0, near: -3.0, far: 40.0 }),
        ("oblique", oblique()),
    ];
    let pair = |projection: Projection, aside: DVec3, look: DVec3| {
        let eye = DVec3::new(0.7, 0.4, 7.0);
        [shot(eye, DVec3::ZERO, projection), shot(eye + aside, look, projection)]
    };
    let mut cases = Vec::new();
    for (name, projection) in projections {
        cases.push((name, case.clone(), pair(projection, DVec3::new(0.3, -0.1, -0.5), DVec3::new(0.4, 0.1, 0.0))));
        cases.push((name, case.clone(), pair(projection, DVec3::new(-1.5, 0.6, 1.0), DVec3::new(-0.8, 0.3, 0.5))));
    }
    cases
}

#[test]
fn motion_of_a_still_world_is_that_of_the_camera() {
    let gpu = gpu();
    for (name, case, shots) in still_cases() {
        // The paper's size, so that the pixels of the law are real ones.
        let mut lab = Lab::new(&gpu, &case.sized([1280, 720]));
        let pair = warp(&mut lab, [&shots[0], &shots[1]], stored());
        let (worst, faults) = compare(&pair, &[], &[]);
        println!("{name}: worst error {worst:.5} px");
        assert_none(&faults);
    }
}

#[test]
fn motion_a_million_metres_out_is_as_exact() {
    let gpu = gpu();
    let away = DVec3::new(1e6, -3e5, 7e5);
    let mut case = walled(80).sized([1280, 720]);
    case.scene.objects.iter_mut().for_each(|object| object.world_from_object.translation += away);
    let mut lab = Lab::new(&gpu, &case);
    let at = |eye: DVec3| shot(eye + away, DVec3::new(0.1, 0.2, 0.0) + away, PERSPECTIVE);
    let shots = [at(DVec3::new(0.7, 0.4, 7.0)), at(DVec3::new(0.9, 0.5, 6.5))];
    let (worst, faults) = compare(&warp(&mut lab, [&shots[0], &shots[1]], stored()), &[], &[]);
    println!("worst error {worst:.5} px");
    assert_none(&faults);
}

#[test]
fn motion_of_moving_objects_is_theirs_and_the_cameras() {
    let gpu = gpu();
    let scene =
        scenes::open("moving-boxes", &scenes::SceneOptions { scale: 0.5, seed: 2, ..Default::default() }).unwrap();
    let at = |eye: DVec3, seconds: f64| Shot { seconds, ..shot(eye, DVec3::ZERO, PERSPECTIVE) };
    let first = at(OVER_BOXES, 1.0);
    for later in [0.0, 0.05, 0.4] {
        let second = at(OVER_BOXES + DVec3::new(0.2, 0.1, 0.3), 1.0 + later);
        let case = Case::new("moving boxes", scene.clone(), vec![first, second]).sized([640, 359]);
        let mut lab = Lab::new(&gpu, &case);
        lab.look(&first, 0);
        let before: Vec<_> = lab.world.moving().collect();
        let pair = warp(&mut lab, [&first, &second], stored());
        let now: Vec<_> = lab.world.moving().collect();
        let mover = |item: &&u32| before.iter().any(|(object, _)| object == *item);
        let movers = pair.items.iter().filter(mover).count();
        assert!(movers > pair.items.len() / 50, "only {movers} pixels of objects that move");
        let (worst, faults) = compare(&pair, &before, &now);
        println!("{later} s later, {movers} pixels of moving objects: worst error {worst:.5} px");
        assert_none(&faults);
        // What the comparison would say of a warp that leaves out the objects' own motion.
        assert_eq!(compare(&pair, &[], &[]).1.is_empty(), later == 0.0, "forgotten object motion");
    }
}

/// Nobody knows where a pixel of a bent object goes, so that it goes nowhere, and hides nothing; unless no joint has moved.
#[test]
fn what_a_skeleton_has_bent_goes_nowhere() {
    let gpu = gpu();
    let scene = scenes::open("tentacles", &scenes::SceneOptions { scale: 0.2, ..Default::default() }).unwrap();
    let at = |seconds: f64| Shot { seconds, ..shot(DVec3::new(1.0, 2.5, 8.0), DVec3::Y, PERSPECTIVE) };
    for (later, goes) in [(0.3, false), (0.0, true)] {
        let shots = [at(2.0), at(2.0 + later)];
        let mut lab = Lab::new(&gpu, &Case::new("tentacles", scene.clone(), shots.to_vec()).sized([320, 180]));
        let pair = warp(&mut lab, [&shots[0], &shots[1]], stored());
        let (motions, mut bent, mut others) = (pair.warp.read_motions().unwrap(), 0, 0);
        for (index, motion) in motions.iter().enumerate().filter(|(index, _)| pair.depth[*index] != 0.0) {
            if lab.world.is_deformed(pair.items[index]) {
                bent += 1;
                assert_eq!(motion.depth != 0.0, goes, "a pixel of a bent object, {later} s later: {motion:?}");
            } else {
                others += 1;
                assert_eq!(motion.depth, pair.depth[index], "what does not move");
            }
        }
        assert!(bent > 500 && others > 5000, "{bent} pixels of bent objects, {others} of others");
    }
}
