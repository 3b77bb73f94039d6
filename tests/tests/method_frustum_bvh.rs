//! The laws of `frustum-bvh`: the same objects as `frustum`, or fewer that an f64 oracle confirms, by fewer tests.

use culling::eovc::Tree;
use culling::frustum::bvh::{walk, Spared};
use culling::frustum::twin::{clip_from_bounds, farthest_along, footprint_widening, oracle_margin, planes, KEPT_BAND};
use scenes::bvh::Split;
use shaders::types::{Bounds, CullView, OBJECT_ALWAYS_KEPT};
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

harness::exact_method_tests!("frustum-bvh");
harness::skipping_method_tests!("frustum-bvh");

const SPARED: [Spared; 4] = [
    Spared { masking: false, coherence: false },
    Spared { masking: true, coherence: false },
    Spared { masking: false, coherence: true },
    Spared { masking: true, coherence: true },
];

/// Objects one by one, each against the planes until one fails: what is kept, and how many tests that takes.
fn one_by_one(bounds: &[Bounds], view: &CullView) -> (Vec<u32>, u64) {
    let mut tests = 0;
    let mut kept = |bound: &Bounds| {
        let clip = clip_from_bounds(bound, view);
        let outside = planes(footprint_widening(bound.flags, view)).iter().any(|plane| {
            tests += 1;
            farthest_along(&clip, *plane) < 0.0
        });
        u32::from(bound.flags & OBJECT_ALWAYS_KEPT != 0 || !outside)
    };
    (bounds.iter().map(&mut kept).collect(), tests)
}

#[test]
fn it_keeps_what_frustum_keeps_but_for_what_an_oracle_leaves_out() {
    let gpu = gpu();
    for case in worlds::special() {
        let mut lab = harness::Lab::new(&gpu, &case);
        let mut tree = Tree::new(&gpu, &lab.world, Split::Sah).unwrap();
        for spared in SPARED {
            let mut failed = vec![0; tree.len()];
            for (frame, shot) in case.shots.iter().enumerate() {
                let view = lab.look(shot, frame).cull();
                tree.follow(&lab.world).unwrap();
                let bounds = lab.world.read_bounds().unwrap();
                let (expected, _) = one_by_one(&bounds, &view);
                let mut kept = tree.unbounded().to_vec();
                walk(tree.host_nodes(), &view, spared, &mut failed, &mut kept);
                for (object, (kept, expected)) in kept.iter().zip(&expected).enumerate() {
                    let margin = oracle_margin(&bounds[object], &view);
                    let place = format!("{}, {spared:?}, frame {frame}, object {object}: {margin}", case.name);
                    assert!(*kept <= *expected, "{place} is kept, but not by frustum");
                    assert!(*kept == *expected || margin < -KEPT_BAND || margin.is_nan(), "{place} is left out");
                }
            }
        }
    }
}

/// Of a city's objects fewer than one test each, where one by one each takes several. Masking spares most of them; what coherence spares
/// is printed: few nodes are outside by a plane that is not among the first.
#[test]
fn it_tests_less_than_one_by_one() {
    let gpu = gpu();
    for run in [("city-block", 0.05, "walk"), ("city-block", 0.05, "rotate"), ("rooms", 0.2, "walk")] {
        let mut session = sessions::open(&gpu, run, 8);
        let tree = Tree::new(&gpu, &session.world, Split::Sah).unwrap();
        let bounds = session.world.read_bounds().unwrap();
        let (mut singly, mut spared_tests) = (0, [0; 4]);
        let mut failed = vec![vec![0; tree.len()]; 4];
        for frame in 0..session.frames() {
            let view = session.look(frame).unwrap().cull();
            singly += one_by_one(&bounds, &view).1;
            for (setting, spared) in SPARED.into_iter().enumerate() {
                let mut kept = tree.unbounded().to_vec();
                spared_tests[setting] += walk(tree.host_nodes(), &view, spared, &mut failed[setting], &mut kept);
            }
        }
        let each = |tests: u64| tests as f64 / (session.frames() * bounds.len()) as f64;
        println!("{run:?}: tests an object {:.4} one by one, tree {:.4?}", each(singly), spared_tests.map(each));
        let [plain, masked, coherent, both] = spared_tests;
        assert!(masked < plain && both < coherent, "{spared_tests:?}");
        assert!(both < singly, "{both} tests, {singly} one by one");
    }
}

/// Both methods count them, and the hierarchy takes fewer than blocks and objects do.
#[test]
fn it_tests_less_than_frustum() {
    let gpu = gpu();
    for run in [("city-block", 0.05, "walk"), ("city-block", 0.05, "rotate"), ("rooms", 0.2, "walk")] {
        let tests = ["frustum", "frustum-bvh"].map(|id| {
            let mut session = sessions::open(&gpu, run, 8);
            let entry = culling::find(id).unwrap();
            let mut contender = Contender::new(&session, entry, entry.default_options(), &None).unwrap();
            let truth = RunTruth::draw(&mut session, || ()).unwrap();
            let tests = |frame| {
                let truth = truth.frame(&mut session, frame).unwrap();
                contender.measured(&mut session, frame, &truth).unwrap().work.plane_tests
            };
            (0..8).map(tests).sum::<u64>()
        });
        println!("{run:?}: plane tests of frustum and frustum-bvh {tests:?}");
        assert!(0 < tests[1] && tests[1] < tests[0], "{run:?}: {tests:?}");
    }
}
