//! Lens flares: the query counts what the oracle counts, and that is what the depth buffer says; what is used one frame late is late by just
//! one frame; and culling is what it is without them.

use culling::flares::{self, twin, Light, Settings, When};
use culling::{Flare, Guarantee, Method, Setup, View, METHODS};
use engine::{DepthFormat, Error, Extra, Gpu, GpuOptions, TimerMode};
use glam::DVec3;
use harness::hazards::hazards;
use harness::{assert_none, gpu, options, worlds, Case, Lab, Subject, Take};
use scenes::Shot;
use shaders::types::{FLARE_BLOCK_PX, FLARE_SPRITES};
use sightline::run::samples::SAMPLES;

#[path = "flares/bench.rs"]
mod bench;
#[path = "flares/view.rs"]
mod view;

const WHOLE: u64 = (FLARE_BLOCK_PX * FLARE_BLOCK_PX) as u64;

/// Lights ahead of the first shot and aside of that, and at some of the objects.
fn lights(lab: &Lab, shot: &Shot) -> Vec<Light> {
    let turned = |direction: DVec3| shot.pose.rotation * direction;
    let ahead = [DVec3::NEG_Z, DVec3::new(0.31, 0.23, -1.0), DVec3::new(-0.9, 0.05, -1.0)];
    let bounds = lab.world.all_host_bounds();
    let of = |part: usize| bounds.get(part * bounds.len() / 4).map(|bounds| Light::At(bounds.centre()));
    let at = (0..4).filter_map(of);
    let all = ahead.map(|direction| Light::Towards(turned(direction))).into_iter().chain(at);
    // Some worlds have objects at places that are no numbers.
    all.filter(|light| !matches!(light, Light::At(place) if !place.is_finite())).collect()
}

/// A method with a flare.
fn flared(lab: &Lab, subject: &Subject, when: When, light: Light) -> Box<dyn Method> {
    let setup = Setup { gpu: &lab.gpu, world: &lab.world, options: &subject.options, visible: None };
    let method = lab.make(subject, &std::sync::Arc::default());
    flares::after(method, &setup, Settings { when, light }).unwrap_or_else(|error| panic!("{error}"))
}

/// Frames whose work is counted, and what each knew of its light.
fn counted(lab: &mut Lab, method: &mut dyn Method, shots: &[Shot]) -> Vec<(Take, Flare)> {
    method.count_work(true);
    let film = |(frame, shot): (usize, &Shot)| {
        let take = lab.take(method, shot, frame);
        (take, method.work().unwrap().flare.expect("a flare"))
    };
    shots.iter().enumerate().map(film).collect()
}

/// Query, oracle and twin, of every light in every frame: faults, and how many blocks showed in part.
fn apart(gpu: &Gpu, case: &Case, samples: u32) -> (Vec<String>, usize) {
    let mut lab = Lab::with_samples(gpu, case, samples);
    let (mut faults, mut in_part) = (Vec::new(), 0);
    for light in lights(&lab, &case.shots[0]) {
        let mut method = flared(&lab, &Subject::named("none"), When::Next, light);
        for (frame, (take, flare)) in counted(&mut lab, &mut *method, &case.shots).into_iter().enumerate() {
            let view = lab.look(&case.shots[frame], frame);
            let place = light.place(&view);
            let twin = place.map(|place| match samples {
                1 => u64::from(twin::count_block(&take.images.depth, &place.block)),
                _ => u64::from(twin::count_samples(&take.images.depth, &place.block)),
            });
            assert_eq!(flare.of, WHOLE * u64::from(samples));
            if (flare.asked, flare.visible) != (twin, Some(twin.unwrap_or(0))) {
                faults.push(format!("{}, light {light}, frame {frame}: {flare:?}, twin {twin:?}", case.name));
            }
            if flare.asked.is_none() && flare.used != 0 {
                faults.push(format!("{}, light {light}, frame {frame}: {flare:?} off the screen", case.name));
            }
            in_part += usize::from(twin.is_some_and(|count| count > 0 && count < flare.of));
        }
    }
    (faults, in_part)
}

#[test]
fn query_oracle_and_twin_count_the_same() {
    let gpu = gpu();
    let (mut faults, mut in_part) = (Vec::new(), 0);
    for case in worlds::special() {
        let (found, partial) = apart(&gpu, &case, 1);
        faults.extend(found);
        in_part += partial;
    }
    assert_none(&faults);
    assert!(in_part > 50, "{in_part} blocks that show in part prove too little");
}

#[test]
fn they_do_where_pixels_have_four_samples() {
    let gpu = gpu();
    let mut in_part = 0;
    for case in [worlds::walled(150), worlds::special::topologies(), worlds::special::ties()] {
        let (faults, partial) = apart(&gpu, &case, SAMPLES);
        assert_none(&faults);
        in_part += partial;
    }
    assert!(in_part > 10, "{in_part} blocks that show in part prove too little");
}

#[test]
fn they_do_however_depth_is_kept() {
    let case = worlds::walled(150);
    let mut last = None;
    for depth in [DepthFormat::StandardD32, DepthFormat::D24, DepthFormat::D16] {
        let gpu = match Gpu::open(&GpuOptions { depth, timer: Some(TimerMode::Split), ..options() }) {
            // Vulkan lets a device lack this one format (SwiftShader does).
            Err(Error::MissingFeatures { .. }) if depth == DepthFormat::D24 => continue,
            opened => opened.unwrap(),
        };
        let mut lab = Lab::new(&gpu, &case);
        let floats = depth == DepthFormat::StandardD32;
        let mut counts = Vec::new();
        for light in lights(&lab, &case.shots[0]) {
            if !floats && matches!(light, Light::At(_)) {
                continue;
            }
            let mut method = flared(&lab, &Subject::named("none"), When::Next, light);
            for (frame, (_, flare)) in counted(&mut lab, &mut *method, &case.shots).into_iter().enumerate() {
                assert_eq!(Some(flare.asked.unwrap_or(0)), flare.visible, "{depth}, light {light}, frame {frame}");
                counts.extend(flare.asked.filter(|_| matches!(light, Light::Towards(_))));
            }
        }
        assert!(counts.iter().any(|count| *count > 0 && *count < WHOLE), "{depth}: {counts:?}");
        assert!(last.replace(counts.clone()).is_none_or(|last| last == counts), "{depth}: what shows is another");
        assert!(gpu.take_messages().is_empty());
    }
}

/// The comparison can fail: a block beside the real one counts something else.
#[test]
fn a_block_at_another_place_is_noticed() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    let mut noticed = 0;
    for light in lights(&lab, &case.shots[0]) {
        let mut method = flared(&lab, &Subject::named("none"), When::Next, light);
        for (frame, (take, flare)) in counted(&mut lab, &mut *method, &case.shots).into_iter().enumerate() {
            let view = lab.look(&case.shots[frame], frame);
            let Some(place) = light.place(&view) else { continue };
            let mut block = place.block;
            block.from_px[0] += 1;
            block.to_px[0] = (block.to_px[0] + 1).min(block.size_px[0]);
            noticed += usize::from(Some(u64::from(twin::count_block(&take.images.depth, &block))) != flare.asked);
        }
    }
    assert!(noticed > 3, "one pixel aside is noticed {noticed} times");
}

/// A camera that creeps past what hides the light.
fn creeping() -> Vec<Shot> {
    let at = |step: u32| {
        let aside = DVec3::new(0.15 * f64::from(step), 0.03 * f64::from(step), 0.0);
        worlds::shot(DVec3::new(2.6, 1.0, 8.0) + aside, DVec3::new(2.6, 1.0, 0.0) + aside, worlds::PERSPECTIVE)
    };
    (0..16).map(at).collect()
}

#[test]
fn what_is_used_is_the_oracles_count_of_the_frame_before() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    let shots = creeping();
    let light = Light::Towards(DVec3::NEG_Z);
    let mut method = flared(&lab, &Subject::named("hzb"), When::Next, light);
    let flares: Vec<Flare> = counted(&mut lab, &mut *method, &shots).into_iter().map(|(_, flare)| flare).collect();
    assert_eq!(flares[0].used, 0, "nothing is known before the first frame");
    for (frame, pair) in flares.windows(2).enumerate() {
        assert_eq!(Some(pair[1].used), pair[0].visible, "frame {}", frame + 1);
    }
    let changes = flares.windows(2).filter(|pair| pair[0].visible != pair[1].visible).count();
    assert!(changes > 3, "what shows changes in {changes} frames: {flares:?}");
    // After a cut nothing is known again.
    method.forget().unwrap();
    assert_eq!(counted(&mut lab, &mut *method, &shots[..1])[0].1.used, 0);
}

#[test]
fn the_error_ends_with_the_frame_after_the_camera_stops() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    let shots: Vec<Shot> = case.shots.iter().chain(&creeping()).flat_map(|shot| [*shot; 3]).collect();
    let mut errors = 0;
    for light in lights(&lab, &case.shots[0]) {
        let mut method = flared(&lab, &Subject::named("none"), When::Next, light);
        for (frame, (_, flare)) in counted(&mut lab, &mut *method, &shots).into_iter().enumerate() {
            let is_wrong = Some(flare.used) != flare.visible;
            assert!(!is_wrong || frame % 3 == 0, "light {light}, frame {frame}: {flare:?}");
            errors += usize::from(is_wrong);
        }
    }
    assert!(errors > 5, "{errors} errors prove too little");
}

#[test]
fn who_waits_is_never_wrong_and_the_wait_is_a_stage() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    let light = Light::Towards(DVec3::NEG_Z);
    for (when, waits) in [(When::Same, true), (When::Next, false)] {
        let mut method = flared(&lab, &Subject::named("hzb"), when, light);
        for (frame, (take, flare)) in counted(&mut lab, &mut *method, &creeping()).into_iter().enumerate() {
            assert!(!waits || Some(flare.used) == flare.visible, "frame {frame}: {flare:?}");
            let stalls = take.report.stages.iter().filter(|stage| stage.label == "frame/wait_for_queries:flares");
            assert_eq!(stalls.count(), usize::from(waits), "{when:?}, frame {frame}: {:?}", take.report.stages);
        }
    }
}

/// Twice as much of the light, twice as bright a flare: over the background, where nothing is added to anything else.
#[test]
fn a_flare_is_as_bright_as_its_light_shows() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    // The camera does not turn, so the flare stays where it is.
    let mut method = flared(&lab, &Subject::named("none"), When::Same, Light::Towards(DVec3::NEG_Z));
    let film = |(frame, shot): (usize, &Shot)| {
        let take = lab.take_timed(&mut *method, shot, frame);
        (take.images, method.work().unwrap().flare.unwrap())
    };
    let frames: Vec<_> = creeping().iter().enumerate().map(film).collect();
    let (brightest, most) = frames.iter().max_by_key(|(_, flare)| flare.used).expect("frames");
    let (mut compared, mut in_part) = (0, 0);
    for (images, flare) in &frames {
        in_part += usize::from(flare.used > 0 && flare.used < most.used);
        for pixel in (0..images.depth.len()).filter(|at| images.depth[*at] == 0.0 && brightest.depth[*at] == 0.0) {
            // What is full can be no brighter.
            for channel in (0..3).filter(|channel| brightest.colour[pixel][*channel] < 250) {
                let expected = flare.used as f64 / most.used as f64 * f64::from(brightest.colour[pixel][channel]);
                let found = f64::from(images.colour[pixel][channel]);
                // Half a step for each of the sprites that may lie over each other here, on both sides.
                assert!(
                    (found - expected).abs() <= f64::from(FLARE_SPRITES),
                    "{flare:?}, {pixel}: {found} of {expected}"
                );
                compared += usize::from(expected > 20.0);
            }
        }
    }
    assert!(in_part > 2 && compared > 1000, "{in_part} frames in part, {compared} pixels");
}

/// Culling draws the same lists with a flare, and the same pictures below it; above them, every exact method shows the same flare.
#[test]
fn flares_change_nothing_of_culling() {
    let gpu = gpu();
    let case = worlds::walled(150).filmed(creeping());
    let mut lab = Lab::new(&gpu, &case);
    let exact = METHODS.iter().filter(|entry| entry.guarantee == Guarantee::Exact && entry.id != "ref");
    let ids: Vec<&str> = exact.map(|entry| entry.id).collect();
    assert!(ids.len() > 8, "{ids:?}");
    // The second light has a depth, which must not stay in the buffer.
    let lights = [Light::Towards(DVec3::NEG_Z), Light::At(DVec3::new(5.0, 1.3, -2.0))];
    for (when, light) in When::ALL.into_iter().zip(lights) {
        let mut none = flared(&lab, &Subject::named("none"), when, light);
        let mut methods: Vec<_> = ids
            .iter()
            .map(|id| {
                let subject = Subject::named(id);
                (*id, lab.make(&subject, &std::sync::Arc::default()), flared(&lab, &subject, when, light))
            })
            .collect();
        let mut flared_frames = 0;
        for (frame, shot) in case.shots.iter().enumerate().step_by(3) {
            let truth = lab.take_timed(&mut *none, shot, frame);
            for (id, plain, flared) in &mut methods {
                let below = lab.take_timed(&mut **plain, shot, frame);
                let above = lab.take_timed(&mut **flared, shot, frame);
                assert!(above.commands == below.commands, "{id}, {when:?}, frame {frame}: other lists");
                assert!(above.images.depth == below.images.depth, "{id}, {when:?}, frame {frame}: other depths");
                assert!(above.images.colour == truth.images.colour, "{id}, {when:?}, frame {frame}: another flare");
                flared_frames += usize::from(above.images.colour != below.images.colour);
            }
        }
        assert!(flared_frames >= 2 * ids.len(), "{when:?}: a flare is seen {flared_frames} times");
    }
}

/// Frames that are measured show the picture below: their errors are those of culling.
#[test]
fn frames_that_are_measured_leave_the_flare_out() {
    let gpu = gpu();
    let case = worlds::walled(150);
    let mut lab = Lab::new(&gpu, &case);
    let mut method = flared(&lab, &Subject::named("hzb"), When::Same, Light::Towards(DVec3::NEG_Z));
    for (frame, shot) in creeping().iter().enumerate() {
        let truth = lab.truth(shot);
        let (take, _) = counted(&mut lab, &mut *method, &[*shot]).remove(0);
        assert!(take.images.colour == truth.images().colour, "frame {frame}");
    }
}

#[test]
fn what_is_off_the_screen_costs_nothing() {
    let gpu = gpu();
    let case = worlds::walled(20);
    let mut lab = Lab::new(&gpu, &case);
    let mut method = flared(&lab, &Subject::named("none"), When::Same, Light::Towards(DVec3::Z));
    let (take, flare) = counted(&mut lab, &mut *method, &case.shots[..1]).remove(0);
    assert_eq!((flare.used, flare.asked, flare.visible), (0, None, Some(0)));
    let ran = take.report.stages.iter().map(|stage| stage.label.as_str());
    assert_eq!(ran.filter(|label| label.contains("flares")).count(), 0);
    let skipped = take.report.skips.iter().map(|skip| skip.label.as_str());
    let skipped: Vec<_> = skipped.filter(|label| label.starts_with("flares/")).collect();
    assert_eq!(skipped, ["flares/test_block", "flares/draw_sprites"]);
}

/// The engine's barriers stand between what draws depth, what tests and counts it, and what draws over the picture.
#[test]
fn barriers_keep_the_stages_apart() {
    let gpu = gpu();
    let case = worlds::walled(20);
    for samples in [1, SAMPLES] {
        let mut lab = Lab::with_samples(&gpu, &case, samples);
        let mut method = flared(&lab, &Subject::named("none"), When::Next, Light::Towards(DVec3::NEG_Z));
        for counts in [true, false, false] {
            method.count_work(counts);
            let view: View = lab.look(&creeping()[12], 0);
            let mut f = gpu.frame();
            method.frame(&mut f, &lab.world, &view, &lab.targets.timed()).unwrap();
            assert_none(&hazards(f.recorded()));
            let labels: Vec<&str> = f.recorded().iter().map(|step| step.label.as_str()).collect();
            let count = if samples == 1 { "flares/count_block" } else { "flares/count_samples" };
            assert_eq!(labels.contains(&count), counts, "{labels:?}");
            assert_eq!(labels.contains(&"flares/draw_sprites"), !counts, "{labels:?}");
            f.finish().unwrap();
        }
    }
}

/// One line says what is missing, and what to do.
#[test]
fn what_cannot_be_counted_is_refused() {
    let without = |options: GpuOptions, light: Light| {
        let gpu = Gpu::open(&GpuOptions { timer: Some(TimerMode::Split), ..options }).unwrap();
        let lab = Lab::new(&gpu, &worlds::walled(3));
        let subject = Subject::named("none");
        let setup = Setup { gpu: &gpu, world: &lab.world, options: &subject.options, visible: None };
        let method = lab.make(&subject, &std::sync::Arc::default());
        flares::after(method, &setup, Settings { when: When::Next, light }).err().expect("refused").to_string()
    };
    let imprecise = GpuOptions { without: vec![Extra::OcclusionQueryPrecise.name().to_owned()], ..options() };
    let said = without(imprecise, Light::default());
    assert_eq!(said, "lens flares need 'occlusionQueryPrecise' of the device to count samples; leave --flares out");
    let said = without(GpuOptions { depth: DepthFormat::D16, ..options() }, Light::At(DVec3::ZERO));
    assert!(said.contains("not D16_UNORM; give a direction with --light"), "{said}");
}
