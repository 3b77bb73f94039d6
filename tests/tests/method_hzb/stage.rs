//! `hzb/test_bounds` against its twin: random boxes and pyramids, every kind of camera.

use culling::hzb::twin::{self, PyramidTest};
use culling::View;
use engine::{Buffer, Gpu, Placement};
use harness::worlds::special_projections;
use harness::{gpu, Random};
use scenes::{Pose, Shot};
use shaders::types::{Bounds, CullView};

const SIZE: [u32; 2] = [161, 97];
const BOXES: usize = 8_000;
/// One rounding of f32.
const U: f32 = 1.0 / 16_777_216.0;

struct Input {
    bounds: Vec<Bounds>,
    seen: Vec<u32>,
    depth: Vec<f32>,
    view: CullView,
    texels: u32,
}

/// Boxes that the camera sees, of a hundredth of a pixel to half the picture, some about as near as what hides them.
fn input(random: &mut Random, shot: &Shot, snap_px: f32, texels: u32) -> Input {
    let view = View::new(shot, SIZE, 0, snap_px);
    let relative_from_clip = view.clip_from_relative().inverse();
    let (surface, slope) = (random.decade(1e-4, 0.9), random.range(0.0, 0.5));
    let depth_at = |x: f64| surface * (1.0 + slope * x) / (1.0 + slope);
    let holes = random.below(30) + 2;
    let pixels = SIZE[0] as usize * SIZE[1] as usize;
    let depth = |pixel: usize| {
        if pixel % 1009 < holes {
            0.0
        } else {
            depth_at((pixel % SIZE[0] as usize) as f64 / f64::from(SIZE[0])) as f32
        }
    };
    let bound = |random: &mut Random| {
        let (x, y) = (random.range(-1.1, 1.1), random.range(-1.1, 1.1));
        let depth = depth_at(0.5 * x + 0.5) * (1.0 + random.range(-1.0, 1.0) * random.decade(1e-6, 0.8));
        let point = |x: f64, y: f64| {
            let point = relative_from_clip * glam::DVec4::new(x, y, depth, 1.0);
            point.truncate() / point.w
        };
        let at = point(x, y);
        let pixel = (point(x + 2.0 / f64::from(SIZE[0]), y) - at).length();
        let half = random.vector().abs() * pixel * random.decade(0.005, 60.0);
        let (centre_high, centre_low) = culling::world::split(at + shot.pose.position);
        let flags = [0, 0, 0, 0, 1, 4][random.below(6)];
        Bounds { centre_high, centre_low, half_extent: half.as_vec3().to_array(), flags }
    };
    let bounds = (0..BOXES).map(|_| bound(random)).collect();
    let seen = (0..BOXES).map(|_| random.below(2) as u32).collect();
    Input { bounds, seen, depth: (0..pixels).map(depth).collect(), view: view.cull(), texels }
}

/// What the stage leaves in `seen` and `newly`.
fn run(gpu: &Gpu, input: &Input) -> [Vec<u32>; 2] {
    let (levels, coarsest_level) = culling::hzb::layout(SIZE);
    let storage = Placement::Storage;
    let texels = Buffer::with_data(gpu, "test.texels", &twin::pyramid(&input.depth, SIZE, &levels), storage).unwrap();
    let levels = Buffer::with_data(gpu, "test.levels", &levels, storage).unwrap();
    let bounds = Buffer::with_data(gpu, "test.bounds", &input.bounds, storage).unwrap();
    let seen = Buffer::with_data(gpu, "test.seen", &input.seen, storage).unwrap();
    let newly = Buffer::with_data(gpu, "test.newly", &vec![7u32; BOXES], storage).unwrap();
    let stage = shaders::hzb::TestBounds {
        bounds: bounds.all(),
        levels: levels.all(),
        pyramid: texels.all(),
        seen: seen.all(),
        newly: newly.all(),
        view: input.view,
        object_count: BOXES as u32,
        coarsest_level,
        constants: shaders::hzb::TestBoundsConstants { footprint_texels: input.texels },
    };
    let mut f = gpu.frame();
    f.dispatch(stage, BOXES as u32);
    f.finish().unwrap();
    [seen.read().unwrap(), newly.read().unwrap()]
}

/// The twin's visible set with every quantity shifted by `step` times a bound of its rounding: 16u of the picture's size on
/// the screen, 16u of a depth, 16u of what a box's place consists of. At +1 nothing can be more visible, at -1 less.
fn shifted(input: &Input, step: f32) -> Vec<u32> {
    let (levels, coarsest_level) = culling::hzb::layout(SIZE);
    let depth: Vec<f32> = input.depth.iter().map(|depth| depth * (1.0 - 16.0 * U * step)).collect();
    let texels = twin::pyramid(&depth, SIZE, &levels);
    let test = PyramidTest { levels: &levels, texels: &texels, coarsest_level, footprint_texels: input.texels };
    let view = CullView { snap_px: input.view.snap_px + 16.0 * U * SIZE[0] as f32 * step, ..input.view };
    let grown = |bound: &Bounds| {
        let reach = |axis: usize| (bound.centre_high[axis] - view.camera_high[axis]).abs() + bound.half_extent[axis];
        let half = |axis: usize| (bound.half_extent[axis] + 16.0 * U * step * reach(axis)).max(0.0);
        Bounds { half_extent: std::array::from_fn(half), ..*bound }
    };
    input.bounds.iter().map(|bound| u32::from(twin::is_visible(&grown(bound), &view, &test))).collect()
}

#[test]
fn bounds_are_seen_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(41);
    let (mut all, mut visible, mut differ, mut open) = (0, 0, 0, 0);
    for (name, projection) in special_projections() {
        for (round, texels) in [4, 2, 16].into_iter().enumerate() {
            let pose = Pose { position: random.vector() * [1.0, 1e3, 1e6][round], rotation: random.turn() };
            let input = input(&mut random, &Shot { pose, projection, seconds: 0.0 }, gpu.snap_px(), texels);
            let [seen, newly] = run(&gpu, &input);
            let (most, least, twin) = (shifted(&input, 1.0), shifted(&input, -1.0), shifted(&input, 0.0));
            for object in 0..BOXES {
                let place = || format!("{name}, {texels} texels: {:?}", input.bounds[object]);
                assert!(least[object] <= most[object], "{}", place());
                assert!(
                    (least[object]..=most[object]).contains(&seen[object]),
                    "stage {}, twin {}: {}",
                    seen[object],
                    twin[object],
                    place()
                );
                assert_eq!(newly[object], u32::from(seen[object] == 1 && input.seen[object] == 0), "{}", place());
                differ += usize::from(seen[object] != twin[object]);
                open += usize::from(least[object] != most[object]);
            }
            all += BOXES;
            visible += seen.iter().sum::<u32>() as usize;
        }
    }
    println!("{all} boxes, {visible} visible, {differ} differ from the twin, {open} within roundings of a tie");
    assert!(visible > all / 5 && visible < all * 4 / 5, "{visible} of {all} visible: the input proves little");
    assert!(
        open < all / 50,
        "{open} of {all} boxes are within roundings of a tie: the band is too wide to prove anything"
    );
    assert!(differ < all / 1000, "stage and twin differ in {differ} of {all}");
}
