//! Depth formats on the device: every method runs with each, and what they lose and cull is measured.
//! `SIGHTLINE_STRESS_CASES=1 cargo test -p sightline-tests --test depth_formats -- --nocapture` prints the table of culling/README.md.

use culling::METHODS;
use engine::{Buffer, DepthFormat, Error, Gpu, GpuOptions, Placement};
use harness::lab::error_of;
use harness::worlds::{walled, Case};
use harness::{options, takes_turn, Lab, Subject};
use scenes::{CameraPath, Projection, SceneOptions, Shot};

/// None if the device lacks the format, which Vulkan lets it of D24 alone (SwiftShader does).
fn open(depth: DepthFormat) -> Option<Gpu> {
    match Gpu::open(&GpuOptions { depth, ..options() }) {
        Err(Error::MissingFeatures { missing, .. }) if depth == DepthFormat::D24 && missing.contains("D24") => None,
        opened => Some(opened.unwrap()),
    }
}

fn no_messages(gpu: &Gpu) {
    let messages = gpu.take_messages();
    assert!(messages.is_empty(), "the validation layer said: {messages:#?}");
}

/// How far a kept depth may be from the depth of the fragment, and from that of another format.
fn step(depth: DepthFormat) -> f32 {
    match depth {
        DepthFormat::ReversedD32 => 0.0,
        // Two roundings and that of reading, at 1.
        DepthFormat::StandardD32 => 2f32.powi(-22),
        DepthFormat::D24 => 2f32.powi(-24) * 2.5,
        DepthFormat::D16 => 1.01 / 65535.0,
    }
}

#[test]
fn every_format_keeps_the_same_depths_to_a_step() {
    let case = walled(300).sized([130, 67]);
    let shot = case.shots[0];
    let exact = Lab::new(&open(DepthFormat::ReversedD32).unwrap(), &case).truth(&shot);
    let exact = &exact.images().depth;
    assert!(exact.iter().any(|depth| *depth > 0.0) && exact.contains(&0.0), "something, and background");
    for depth in DepthFormat::ALL {
        let Some(gpu) = open(depth) else { continue };
        let mut lab = Lab::new(&gpu, &case);
        let truth = lab.truth(&shot);
        let kept = &truth.images().depth;
        let copied = Buffer::<f32>::new(&gpu, "test.copied", kept.len(), Placement::Storage).unwrap();
        let mut frame = gpu.frame();
        frame.copy_depth("test/copy_depth", &lab.targets.timed(), &copied);
        frame.finish().unwrap();
        let copied = copied.read().unwrap();
        for (pixel, ((kept, copied), exact)) in kept.iter().zip(&copied).zip(exact).enumerate() {
            assert!((kept - exact).abs() <= step(depth), "{depth}: pixel {pixel} keeps {kept} of {exact}");
            assert!((kept - copied).abs() <= step(depth).min(2f32.powi(-24)), "{depth}: {copied} is no copy of {kept}");
        }
        no_messages(&gpu);
    }
}

fn with_planes(shots: &[Shot], near: f64, far: f64) -> Vec<Shot> {
    let projection = Projection::Perspective { fov_y: 1.0, near, far: Some(far) };
    shots.iter().map(|shot| Shot { projection, ..*shot }).collect()
}

/// Visible objects, those of them that were not drawn, hidden objects, and those of them that were not drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Row {
    visible: usize,
    lost: usize,
    hidden: usize,
    culled: usize,
}

fn row(gpu: &Gpu, subject: &Subject, case: &Case) -> Row {
    let mut lab = Lab::new(gpu, case);
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &case.shots);
    let mut row = Row::default();
    // In the first frame methods know nothing.
    for (truth, take) in truths.iter().zip(&takes).skip(1) {
        let error = error_of(truth, take);
        let all = lab.world.len();
        row.visible += error.ref_visible;
        row.lost += error.false_negatives;
        row.hidden += all - error.ref_visible;
        row.culled += error.culled - error.false_negatives;
    }
    row
}

#[test]
fn methods_lose_nothing_with_reversed_d32_and_cull_most() {
    let city = scenes::open("city-block", &SceneOptions { scale: 0.05, seed: 1, ..Default::default() }).unwrap();
    let path = CameraPath::named(&city, Some("walk"), 60.0).unwrap();
    let walk: Vec<Shot> = (0..4).map(|frame| path.sample(frame, 960)).collect();
    let cases = [
        ("near 0.1 m, far 2 km", with_planes(&walk, 0.1, 2e3)),
        ("near 1 mm, far 10,000 km", with_planes(&walk, 1e-3, 1e7)),
    ];
    let mut lost_by_others = 0;
    for (index, (name, shots)) in cases.into_iter().enumerate() {
        if !takes_turn(index, 1, 2) {
            continue;
        }
        let case = Case::new("city", city.clone(), shots).sized([320, 180]);
        println!("\n| {name} | {} |", DepthFormat::ALL.map(DepthFormat::name).join(" | "));
        let gpus = DepthFormat::ALL.map(open);
        for entry in METHODS {
            let rows = gpus
                .each_ref()
                .map(|gpu| gpu.as_ref().map_or(Row::default(), |gpu| row(gpu, &Subject::named(entry.id), &case)));
            let shown = rows.map(|row| {
                if row == Row::default() {
                    return "not on this device".to_owned();
                }
                format!("{} of {} lost, {:.1} %", row.lost, row.visible, 100.0 * row.culled as f64 / row.hidden as f64)
            });
            println!("| {} | {} |", entry.id, shown.join(" | "));
            let [reversed, others @ ..] = rows;
            assert!(reversed.visible > 100 && reversed.hidden > 1000, "{}: {reversed:?}", entry.id);
            if entry.guarantee == culling::Guarantee::Exact {
                assert_eq!(reversed.lost, 0, "{name}: {}", entry.id);
                lost_by_others += others.iter().map(|row| row.lost).sum::<usize>();
            }
        }
        gpus.iter().flatten().for_each(no_messages);
    }
    assert!(lost_by_others > 0, "the others lose nothing: then this shows nothing");
}
