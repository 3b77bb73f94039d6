//! Detail culling: methods leave out what is small on the screen, and nothing else.

use culling::world::DETAIL_OPTION;
use culling::{Entry, METHODS};
use harness::sessions::open_at_speed_one;
use harness::{assert_none, gpu};
use sightline::measures::metrics::Truth;
use sightline::run::session::Session;
use sightline::run::truth::RunTruth;
use sightline::run::Contender;

const SMALL_PX: u32 = 12;
const FRAMES: usize = 4;

/// What a run did.
#[derive(Debug, Default)]
struct Run {
    drawn: usize,
    missed: usize,
    faults: Vec<String>,
}

/// Columns and rows of pixels from an object's first to its last.
fn extent(truth: &Truth, size: [u32; 2], object: usize) -> [u32; 2] {
    let owned = truth.images().items.iter().enumerate().filter(|(_, item)| **item as usize == object);
    let pixels: Vec<[u32; 2]> = owned.map(|(pixel, _)| [pixel as u32 % size[0], pixel as u32 / size[0]]).collect();
    [0, 1].map(|axis| {
        let along = || pixels.iter().map(|pixel| pixel[axis]);
        along().max().zip(along().min()).map_or(0, |(last, first)| last - first + 1)
    })
}

fn run(session: &mut Session, truth: &RunTruth, entry: &'static Entry, detail: u32) -> Run {
    let mut options = entry.default_options();
    options.set(DETAIL_OPTION.name, &detail.to_string()).unwrap();
    let visible = Some(truth.sets.clone());
    let mut contender = Contender::new(session, entry, options, &visible).unwrap();
    let mut run = Run::default();
    for frame in 0..session.frames() {
        let truth = truth.frame(session, frame).unwrap();
        let found = contender.measured(session, frame, &truth).unwrap();
        run.drawn += found.error.drawn;
        for object in
            (0..found.drawn.objects.len()).filter(|object| truth.is_visible(*object) && !found.drawn.objects[*object])
        {
            run.missed += 1;
            // As many pixel centres as fit into its width, and one for where it begins.
            let extent = extent(&truth, session.options().size, object);
            if extent.iter().any(|side| *side > detail + 1) {
                run.faults.push(format!("{}, frame {frame}: object {object} of {extent:?} pixels", contender.label()));
            }
        }
    }
    run
}

#[test]
fn what_is_left_out_is_small() {
    let gpu = gpu();
    let mut session = open_at_speed_one(&gpu, ("city-block", 0.05, "walk"), FRAMES);
    let truth = RunTruth::draw(&mut session, || ()).unwrap();
    let methods: Vec<_> = METHODS.iter().filter(|entry| entry.options.contains(&DETAIL_OPTION)).collect();
    // All but those that test nothing.
    assert_eq!(methods.len(), METHODS.len() - 2, "none and ref have no such option");
    for entry in methods {
        let all = run(&mut session, &truth, entry, 0);
        let large = run(&mut session, &truth, entry, SMALL_PX);
        println!(
            "{}: {} drawn, {} without details, {} of them visible",
            entry.id, all.drawn, large.drawn, large.missed
        );
        assert_none(&large.faults);
        assert!(large.drawn < all.drawn && large.missed > 0, "{}: {all:?}, without details {large:?}", entry.id);
    }
}
