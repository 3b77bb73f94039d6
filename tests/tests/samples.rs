//! Pictures of four samples a pixel: what stages read of depth, and that culling stays right at every sample.

use culling::{Entry, Method, Setup, View, World};
use engine::{Buffer, Frame, KeptSample, Placement, Samples, Target};
use glam::{DVec2, DVec3};
use harness::lab::error_of;
use harness::laws::faults_of;
use harness::{assert_caught, assert_none, gpu, takes_turn, worlds, Case, Lab, Subject};
use scenes::{Projection, Topology};
use sightline::run::samples::SAMPLES;
use sightline::run::session::{Session, SessionOptions};
use sightline::run::Contender;

/// Methods that draw four samples a pixel, and are exact.
const METHODS: [&str; 13] = [
    "none",
    "ref",
    "frustum",
    "frustum-bvh",
    "hzb",
    "hom",
    "woc-exact",
    "roc",
    "roc-iterative",
    "query-wait",
    "chc",
    "chc++",
    "nohc",
];

/// Every object that owns a sample is drawn, and the samples are those of `none`.
fn no_visible_sample_is_lost(lab: &mut Lab, subject: &Subject, case: &Case) -> Vec<String> {
    let (truths, sets) = lab.truths(&case.shots);
    let mut method = lab.make(subject, &sets);
    let takes = lab.film(&mut *method, &case.shots);
    let place = |frame: usize| format!("{}, {}, frame {frame}", subject.options.label(), case.name);
    let pairs = truths.iter().zip(&takes).enumerate();
    pairs.flat_map(|(frame, (truth, take))| faults_of(&place(frame), &error_of(truth, take))).collect()
}

/// Worlds without holes: masked objects have one sample a pixel.
fn cases() -> Vec<Case> {
    let mut cases = worlds::special();
    cases.push(slits());
    cases
}

/// A row of walls with slits between them, each half a pixel wide and somewhere else on the grid of pixels, and bodies behind the slits: for each slit
/// one that shows to the first eye, and three that others see.
fn slits() -> Case {
    let mut maker = worlds::Maker::new("slits");
    let cube = maker.mesh(worlds::cube());
    for slit in 0..40 {
        let x = 0.43 * f64::from(slit) - 8.6;
        maker.place(cube, worlds::sized(DVec3::new(x, 0.0, -10.0), DVec3::new(0.37, 4.0, 0.05)));
        for aside in [1.2, 1.4, 1.6, 1.8] {
            let at = DVec3::new(aside * (x + 0.215), 0.0, -16.0);
            maker.place(cube, worlds::sized(at, DVec3::new(0.12, 1.0, 0.05)));
        }
    }
    Case::new(
        "slits",
        maker.scene,
        worlds::wander(DVec3::new(0.0, 0.1, 0.0), DVec3::new(0.0, 0.0, -10.0), worlds::PERSPECTIVE),
    )
}

/// `hzb` that takes a pixel's depth from another sample.
struct Kept {
    method: Box<dyn Method>,
    kept: KeptSample,
}

impl Method for Kept {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        let samples = target.samples.map(|samples| Samples { kept: self.kept, ..samples });
        self.method.frame(f, world, view, &Target { samples, ..*target })
    }
}

fn keeping(setup: &Setup<'_>, kept: KeptSample) -> culling::Result<Box<dyn Method>> {
    let method = (culling::find("hzb")?.make)(setup)?;
    Ok(Box::new(Kept { method, kept }))
}

fn needs_one_sample(entry: &Entry, lab: &Lab) -> Option<&'static str> {
    entry.needs_one_sample(&lab.world, &entry.default_options(), lab.targets.stray_px())
}

#[test]
fn no_visible_sample_is_culled() {
    let gpu = gpu();
    let mut faults = Vec::new();
    for (place, case) in cases().iter().enumerate() {
        let mut lab = Lab::with_samples(&gpu, case, SAMPLES);
        let slits = case.name == "slits";
        for (method, id) in METHODS.into_iter().enumerate() {
            if !slits && !takes_turn(method, place, 4) {
                continue;
            }
            let entry = culling::find(id).unwrap();
            if needs_one_sample(entry, &lab).is_none() {
                faults.extend(no_visible_sample_is_lost(&mut lab, &Subject::named(id), case));
            }
        }
    }
    assert_none(&faults);
}

/// What is planted is the only difference: with the farthest sample the law holds.
#[test]
fn depths_of_the_nearest_sample_are_noticed() {
    let gpu = gpu();
    let case = slits();
    let mut lab = Lab::with_samples(&gpu, &case, SAMPLES);
    let hzb = Subject::named("hzb");
    let sound = Subject { make: |setup| keeping(setup, KeptSample::Farthest), ..hzb.clone() };
    assert_none(&no_visible_sample_is_lost(&mut lab, &sound, &case));
    let broken = Subject { make: |setup| keeping(setup, KeptSample::Nearest), ..hzb };
    assert_caught(&no_visible_sample_is_lost(&mut lab, &broken, &case), "false negatives");
}

/// Footprints reach to a pixel's samples: with those of its centre alone, what shows at one sample is lost.
#[test]
fn footprints_of_centres_are_noticed() {
    let gpu = gpu();
    let mut faults = Vec::new();
    for case in cases().into_iter().filter(|case| ["slits", "walled"].contains(&case.name.as_str())) {
        let mut lab = Lab::with_samples(&gpu, &case, SAMPLES);
        let (truths, sets) = lab.truths(&case.shots);
        for id in ["hzb", "hom"] {
            let mut method = lab.make(&Subject::named(id), &sets);
            for (frame, (shot, truth)) in case.shots.iter().zip(&truths).enumerate() {
                lab.look(shot, frame);
                let view = View::new(shot, case.size, frame, gpu.snap_px());
                let take = lab.take_through(&mut *method, &view);
                faults.extend(faults_of(&format!("{id}, {}, frame {frame}", case.name), &error_of(truth, &take)));
            }
        }
    }
    assert_caught(&faults, "false negatives");
}

/// The resolved depth is the farthest of what the host reads of the samples, to the bit, and the resolved colour their mean.
#[test]
fn pixels_are_what_their_samples_say() {
    let gpu = gpu();
    let case = worlds::walled(100);
    let mut lab = Lab::with_samples(&gpu, &case, SAMPLES);
    let view = lab.look(&case.shots[0], 0);
    let target = lab.targets.timed();
    let pixels = (case.size[0] * case.size[1]) as usize;
    let resolved = Buffer::new(&gpu, "test.resolved", pixels, Placement::Storage).unwrap();
    let mut f = gpu.frame();
    lab.world.update(&mut f);
    f.clear(&target);
    lab.world.draw_all(&mut f, &view, &target);
    f.copy_depth("test/copy_depth", &target, &resolved);
    let report = f.finish().unwrap();
    let samples = lab.targets.read_frame(&lab.world, &view, &report).unwrap();
    let (depth, colour) = (resolved.read().unwrap(), lab.targets.read().unwrap().colour);
    let width = case.size[0] as usize;
    let (mut edges, mut mixed) = (0, 0);
    for pixel in 0..pixels {
        let (x, y) = (2 * (pixel % width), 2 * (pixel / width));
        let at = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(right, down)| (y + down) * 2 * width + x + right);
        let depths = at.map(|sample| samples.depth[sample]);
        let farthest = depths.into_iter().fold(f32::INFINITY, f32::min);
        assert_eq!(depth[pixel].to_bits(), farthest.to_bits(), "pixel {pixel}");
        edges += usize::from(depths.iter().any(|depth| *depth != farthest));
        for channel in 0..3 {
            let sum: u32 = at.iter().map(|sample| u32::from(samples.colour[*sample][channel])).sum();
            let mean = f64::from(sum) / 4.0;
            assert!((f64::from(colour[pixel][channel]) - mean).abs() <= 1.0, "pixel {pixel}: {:?}", colour[pixel]);
        }
        mixed += usize::from(at.iter().any(|sample| samples.items[*sample] != samples.items[at[0]]));
        let shows = at.iter().all(|sample| (samples.depth[*sample] > 0.0) == (samples.items[*sample] != u32::MAX));
        assert!(shows, "pixel {pixel}: who is drawn owns the sample");
    }
    assert!(edges > 100 && mixed > 100, "{edges} pixels with several depths, {mixed} with several owners");
}

/// One line says what cannot be drawn so, and why.
#[test]
fn what_needs_one_sample_says_so() {
    let gpu = gpu();
    let case = worlds::walled(3);
    let lab = Lab::new(&gpu, &case);
    let refusal =
        |entry: &Entry, world: &World, stray_px| entry.needs_one_sample(world, &entry.default_options(), stray_px);
    let refused = |stray_px| {
        let entries = culling::METHODS.iter().filter(|entry| refusal(entry, &lab.world, stray_px).is_some());
        entries.map(|entry| entry.id).collect::<Vec<_>>()
    };
    assert_eq!(refused(0.0), ["hzb-iterative", "eovc", "auto"]);
    let drawing_boxes = ["roc", "roc-iterative", "query-wait", "query-lag", "chc", "chc++", "nohc"];
    let astray = refused(0.75);
    assert!(
        refused(0.0).iter().chain(&drawing_boxes).all(|id| astray.contains(id)) && astray.len() == 10,
        "{astray:?}"
    );
    let moving = Session::on(&gpu, SessionOptions { scene: "moving-boxes".into(), ..small() }).unwrap();
    let reason = |id: &str, session: &Session| refusal(culling::find(id).unwrap(), &session.world, 0.0);
    assert!(reason("woc", &moving).is_some_and(|why| why.contains("item buffer")) && reason("hzb", &moving).is_none());
    let options = SessionOptions { scene: "boxes".into(), samples: SAMPLES, ..small() };
    let session = Session::on(&gpu, options).unwrap();
    let entry = culling::find("eovc").unwrap();
    let error = Contender::new(&session, entry, entry.default_options(), &None).err().unwrap().to_string();
    assert!(error.contains("--samples 4: method 'eovc' cannot: it casts one ray"), "{error}");
}

/// On a device that takes depths beside samples, boxes of costly objects and of translucent ones are drawn too.
#[test]
fn whoever_draws_boxes_beside_a_map_is_refused_where_depths_stray() {
    let gpu = gpu();
    let glass = Lab::new(&gpu, &worlds::materials::plain_glass());
    let walled = Lab::new(&gpu, &worlds::walled(3));
    for (id, set, lab, cause) in [
        ("hom", "", &glass, "translucent objects"),
        ("woc-exact", "11", &walled, "option hybrid=0"),
        ("woc-exact", "", &walled, ""),
        ("frustum", "", &glass, ""),
        ("ref", "", &glass, ""),
    ] {
        let entry = culling::find(id).unwrap();
        let mut options = entry.default_options();
        if !set.is_empty() {
            options.set("hybrid-triangles", set).unwrap();
        }
        let astray = entry.needs_one_sample(&lab.world, &options, 0.75);
        assert_eq!(astray.is_some(), !cause.is_empty(), "{id}: {astray:?}");
        assert!(astray.is_none_or(|why| why.contains(cause)), "{id}: {astray:?}");
        assert_eq!(entry.needs_one_sample(&lab.world, &options, 0.0), None, "{id}");
    }
}

/// Where samples are is found by edges that move over a pixel in steps of the vertex grid, and where their depths are by leaning squares: what is
/// between the two is the stray, on any device.
#[test]
fn the_stray_of_depths_is_told() {
    let gpu = gpu();
    let step = f64::from(gpu.snap_px()).max(1.0 / 64.0);
    let mut places = [[[0.0; 2]; 2]; SAMPLES as usize];
    let level = leaning(DVec2::ZERO);
    let mut lab = Lab::with_samples(&gpu, &level, SAMPLES);
    for (axis, to) in [DVec2::X, DVec2::NEG_Y].into_iter().enumerate() {
        for taken in 0..(1.0 / step) as u32 {
            // The square's left, or upper, edge is so far into the pixel.
            let into = step * (f64::from(taken) + 0.5);
            let depths = depths_of_pixel(&mut lab, to * (-20.0 - into));
            let covered = places.iter_mut().zip(depths).filter(|(_, depth)| *depth > 0.0);
            covered.for_each(|(place, _)| place[0][axis] = into);
        }
        let mut lab = Lab::with_samples(&gpu, &leaning(to), SAMPLES);
        let depths = depths_of_pixel(&mut lab, DVec2::ZERO);
        places.iter_mut().zip(depths).for_each(|(place, depth)| place[1][axis] = 100.0 * (f64::from(depth) - 0.5));
    }
    let beside = places.map(|[covered, depth]| DVec2::from(depth).distance(covered.into()));
    let most = beside.into_iter().fold(0.0, f64::max);
    let told = f64::from(lab.targets.stray_px());
    assert!((most - told).abs() < 2.0 * step, "{places:?}: {most} pixels, not {told}");
    println!("depths are taken {told} pixel beside their samples at most");
}

/// A square of 40 pixels a side in the middle of 64, nearer by a unit a pixel that way.
fn leaning(to: DVec2) -> Case {
    let mut maker = worlds::Maker::new("leaning");
    let corners = [[-20.0, -20.0], [20.0, -20.0], [20.0, 20.0], [-20.0, 20.0]].map(DVec2::from);
    let corners = corners.map(|at| at.extend(at.dot(to)).as_vec3());
    let mesh = maker.mesh(worlds::mesh("square", Topology::Triangles, corners.to_vec(), vec![0, 1, 2, 0, 2, 3]));
    maker.place(mesh, worlds::sized(DVec3::ZERO, DVec3::ONE));
    Case::new("leaning", maker.scene, Vec::new()).sized([64, 64])
}

/// Depths of the samples of the pixel right below the picture's middle, a unit a pixel and 100 from near to far.
fn depths_of_pixel(lab: &mut Lab, eye: DVec2) -> [f32; SAMPLES as usize] {
    let eye = eye.extend(50.0);
    let parallel = Projection::Orthographic { half_height: 32.0, near: 0.0, far: 100.0 };
    let truth = lab.truth(&worlds::shot(eye, eye - DVec3::Z, parallel));
    let width = truth.images().width as usize;
    std::array::from_fn(|sample| truth.images().depth[(64 + (sample >> 1)) * width + 64 + (sample & 1)])
}

fn small() -> SessionOptions {
    SessionOptions { size: [64, 36], frames: 2, scale: 0.1, ..SessionOptions::default() }
}
