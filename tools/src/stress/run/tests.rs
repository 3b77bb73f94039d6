//! The judge itself, on frames that were never drawn.

use super::*;

/// A frame of 9 objects with these errors.
fn frame(lost: usize, differing: usize, wrong_colour: usize, tied: usize) -> Played {
    let error = FrameError {
        objects: 9,
        ref_visible: 5,
        drawn: 6,
        culled: 3,
        false_negatives: lost,
        false_positives: 1,
        differing_pixels: differing,
        tied_pixels: tied,
        wrong_colour_pixels: wrong_colour,
        psnr_db: None,
        ssim: 1.0,
        culled_over_total: 0.0,
        culled_over_ref: 0.0,
        object_error_percent: 0.0,
    };
    Played { error, thin: 0, pictures: 1, lists: 1 }
}

fn good() -> Played {
    frame(0, 0, 0, 0)
}

fn drill(name: &str) -> Drill {
    DrillId::parse(name).unwrap().make(4)
}

/// A drill in which each frame differs from the one before.
fn moving() -> Drill {
    drill("creeping/0")
}

#[test]
fn each_kind_of_error_alone_is_a_fault_and_a_tie_or_a_thin_pixel_is_none() {
    let told = |played: &Played| faults_of(&moving(), std::slice::from_ref(played), &[]);
    assert_eq!(told(&frame(1, 0, 0, 0)), ["frame 0: 1 lost, 0 pixels differ, 0 of wrong colour"]);
    assert_eq!(told(&frame(0, 1, 0, 0)), ["frame 0: 0 lost, 1 pixels differ, 0 of wrong colour"]);
    assert_eq!(told(&frame(0, 0, 1, 0)), ["frame 0: 0 lost, 0 pixels differ, 1 of wrong colour"]);
    assert_eq!(told(&frame(0, 0, 0, 7)), [""; 0]);
    assert_eq!(told(&Played { thin: 3, ..good() }), [""; 0]);
    // Excused pixels beside a real one excuse nothing.
    let beside = Played { thin: 3, ..frame(2, 4, 0, 7) };
    assert_eq!(told(&beside), ["frame 0: 2 lost, 4 pixels differ, 0 of wrong colour"]);
}

#[test]
fn two_bad_frames_are_two_faults_and_their_errors_add_up() {
    let frames = [good(), frame(2, 30, 0, 5), good(), Played { thin: 4, ..frame(1, 7, 11, 6) }];
    let faults = faults_of(&moving(), &frames, &[]);
    let expected = [
        "frame 1: 2 lost, 30 pixels differ, 0 of wrong colour",
        "frame 3: 1 lost, 7 pixels differ, 11 of wrong colour",
    ];
    assert_eq!(faults, expected);
    let tally = tally_of(&frames);
    assert_eq!(tally, Tally { runs: 1, object_frames: 36, lost: 3, differing: 48, ties: 11, thin: 4 });
}

#[test]
fn tallies_add_up_by_field() {
    let mut sum = Tally { runs: 1, object_frames: 20, lost: 300, differing: 4_000, ties: 50_000, thin: 600_000 };
    sum.add(&Tally { runs: 7, object_frames: 80, lost: 900, differing: 1_000, ties: 20_000, thin: 300_000 });
    assert_eq!(sum, Tally { runs: 8, object_frames: 100, lost: 1_200, differing: 5_000, ties: 70_000, thin: 900_000 });
}

/// Frames 1 to 3 of `ties` are the first again, 5 and 6 are the fourth again.
#[test]
fn a_picture_that_changes_while_nothing_does_is_a_fault_from_the_third_frame_on() {
    let drill = drill("ties/0");
    assert_eq!((0..8).filter(|frame| drill.stands_still(*frame)).collect::<Vec<_>>(), [1, 2, 3, 5, 6]);
    let changes_at = |frame: usize, drill: &Drill| {
        let frames: Vec<_> = (0..8).map(|at| Played { pictures: u64::from(at >= frame), ..good() }).collect();
        faults_of(drill, &frames, &[])
    };
    for frame in [1, 4, 5, 7] {
        assert_eq!(changes_at(frame, &drill), [""; 0], "frame {frame}");
    }
    for frame in [2, 3, 6] {
        let expected = format!("frame {frame}: nothing changed, but the picture did");
        assert_eq!(changes_at(frame, &drill), [expected], "frame {frame}");
    }
    // What a method is told to forget may decide ties anew.
    let forgets = Drill { forgets: vec![3], ..drill };
    assert_eq!(changes_at(3, &forgets), [""; 0]);
    assert_eq!(changes_at(2, &forgets).len(), 1);
}

#[test]
fn another_run_that_draws_something_else_is_a_fault_of_that_frame_and_run() {
    let frames = vec![good(); 3];
    let with = |change: fn(&mut Played)| {
        let mut again = frames.clone();
        change(&mut again[1]);
        again
    };
    let picture = with(|played| played.pictures = 2);
    let list = with(|played| played.lists = 2);
    let same = with(|played| played.thin = 2);
    let told = |again: &[(&str, Vec<Played>)]| faults_of(&moving(), &frames, again);
    assert_eq!(told(&[("one", picture.clone())]), ["frame 1: one draws another picture or list"]);
    assert_eq!(told(&[("one", list.clone())]), ["frame 1: one draws another picture or list"]);
    assert_eq!(told(&[("one", same.clone())]), [""; 0]);
    let both = ["frame 1: one draws another picture or list", "frame 1: two draws another picture or list"];
    assert_eq!(told(&[("one", list), ("two", picture)]), both);
}

fn plan(as_given: bool) -> Plan {
    let subjects = vec![Subject::named("hzb"), Subject::named("eovc")];
    Plan { subjects, drills: Vec::new(), bodies: 7, size: None, as_given }
}

#[test]
fn drills_of_a_seed_run_at_settings_by_chance_and_those_of_seed_0_as_given() {
    let id = |text: &str| DrillId::parse(text).unwrap();
    let label = |plan: &Plan, index, drill: &str| plan.subject(index, id(drill)).options.all();
    let (free, given) = (plan(false), plan(true));
    for index in [0, 1] {
        let plain = free.subjects[index].options.all();
        assert_eq!(label(&free, index, "creeping/0"), plain);
        assert_eq!(label(&given, index, "creeping/5"), plain);
        assert_eq!(label(&given, index, "chance/0"), plain);
        // Any one seed may give the defaults; eight do not, and worlds by chance have no seed that stands for them.
        let tried = |family: &str, seeds: std::ops::Range<u64>| {
            seeds.map(|seed| label(&free, index, &format!("{family}/{seed}"))).collect::<Vec<_>>()
        };
        assert!(tried("creeping", 1..9).iter().any(|options| *options != plain));
        assert!(tried("creeping", 1..9) != tried("teleports", 1..9), "each family has its own");
        assert_eq!(tried("creeping", 1..9), tried("creeping", 1..9), "and the same each time");
        let nulls: Vec<_> = (0..4).map(|seed| label(&free, index, &format!("chance/{seed}"))).collect();
        assert!(nulls.iter().any(|options| *options != plain));
    }
    assert_ne!(free.subject(0, id("chance/0")).options.all(), free.subjects[0].options.all());
}

#[test]
fn a_plan_s_size_takes_the_place_of_a_drill_s_own() {
    let id = DrillId::parse("resize/1").unwrap();
    let own = plan(true).drill(id);
    assert!(own.sizes.len() > 1);
    assert_eq!(own.case.scene.objects.len(), 8, "a wall and seven bodies");
    let sized = Plan { size: Some([31, 17]), ..plan(true) }.drill(id);
    assert!((0..7).all(|frame| sized.size(frame) == [31, 17]));
    assert_eq!(sized.case.shots, own.case.shots);
}
