//! The judge is judged: methods whose every fault is known, and what `stress` says of each.

use super::{make as make_buggy, Bug};
use culling::{Method, Options, Setup, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use harness::{gpu, Lab, Subject};
use shaders::types::DrawCommand;
use sightline::cli::commands::all_drills;
use sightline::stress::catalogue::{DrillId, CHANCE, FAMILIES};
use sightline::stress::run::Tally;
use sightline::stress::shrink::shrunk;
use sightline::stress::{run, Outcome, Plan};

/// What a method does beside drawing everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Fault {
    /// Nothing: it is right.
    None,
    /// Leaves object 0 out in frames 2 and 5.
    LosesIn2And5,
    /// Draws in reverse order, which only ties show.
    Reversed,
    /// Draws in reverse order, and leaves object 0 out in frame 5.
    ReversedAndLoses,
    /// Leaves object 78 out in frame 8.
    LosesASliver,
    /// Leaves objects 78 and 0 out in frame 8.
    LosesASliverAndAWall,
    /// Draws the view of the frame before.
    Late,
    /// Leaves object 0 out in frames 3 and 6 unless it was told to forget before them, and in all others if it was.
    TrustsForgetting,
}

struct Planted {
    fault: Fault,
    commands: Buffer<DrawCommand>,
    without_some: Buffer<DrawCommand>,
    last: Option<View>,
    told: bool,
}

fn make(setup: &Setup<'_>, fault: Fault) -> culling::Result<Box<dyn Method>> {
    let mut commands = setup.world.commands();
    let made =
        |commands: &[DrawCommand]| Buffer::with_data(setup.gpu, "planted.commands", commands, Placement::Storage);
    let reversed = matches!(fault, Fault::Reversed | Fault::ReversedAndLoses);
    let left_out: &[usize] = match fault {
        Fault::LosesASliver => &[78],
        Fault::LosesASliverAndAWall => &[78, 0],
        _ => &[0],
    };
    let mut some = commands.clone();
    for object in left_out {
        // Drills of these tests have their objects in one range; some have fewer.
        if let Some(command) = some.get_mut(*object) {
            command.instance_count = 0;
        }
    }
    if reversed {
        commands.reverse();
        some.reverse();
    }
    let (commands, without_some) = (made(&commands)?, made(&some)?);
    Ok(Box::new(Planted { fault, commands, without_some, last: None, told: false }))
}

impl Method for Planted {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        let last = self.last.replace(*view).unwrap_or(*view);
        let told = std::mem::take(&mut self.told);
        let loses = match self.fault {
            Fault::None | Fault::Reversed | Fault::Late => false,
            Fault::LosesASliver | Fault::LosesASliverAndAWall => view.frame == 8,
            Fault::LosesIn2And5 => [2, 5].contains(&view.frame),
            Fault::ReversedAndLoses => view.frame == 5,
            // A run may begin after forgetting.
            Fault::TrustsForgetting => view.frame > 0 && told != [3, 6].contains(&view.frame),
        };
        let view = if self.fault == Fault::Late { &last } else { view };
        let commands = if loses { &self.without_some } else { &self.commands };
        world.draw_commands(f, commands.all(), view, target);
        Ok(())
    }

    fn forget(&mut self) -> culling::Result<()> {
        self.told = true;
        Ok(())
    }
}

fn planted(make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>) -> Subject {
    Subject { options: Options::new("planted", &[]), make }
}

const RIGHT: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>> = |setup| make(setup, Fault::None);
const LOSES: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>> = |setup| make(setup, Fault::LosesIn2And5);

const BODIES: usize = 12;

fn judged(gpu: &Gpu, subjects: &[Subject], drills: &[&str]) -> Outcome {
    let drills = drills.iter().map(|drill| DrillId::parse(drill).unwrap()).collect();
    let plan = Plan { subjects: subjects.to_vec(), drills, bodies: BODIES, size: Some([97, 61]), as_given: true };
    run(gpu, &plan, &mut |_, _| Ok(())).unwrap()
}

/// The faults of one method in one drill.
fn faults(gpu: &Gpu, make: fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>, drill: &str) -> Vec<String> {
    let mut failures = judged(gpu, &[planted(make)], &[drill]).failures;
    assert!(failures.len() <= 1, "one failure a method and drill");
    failures.pop().map(|failure| failure.faults).unwrap_or_default()
}

#[test]
fn two_bad_frames_are_both_told_and_counted() {
    let outcome = judged(&gpu(), &[planted(LOSES)], &["creeping/0"]);
    let [failure] = outcome.failures.as_slice() else { panic!("{:?}", outcome.failures) };
    let [second, fifth] = failure.faults.as_slice() else { panic!("{:?}", failure.faults) };
    let pixels = |fault: &str, frame| {
        let rest = fault.strip_prefix(&format!("frame {frame}: 1 lost, ")).unwrap_or_else(|| panic!("{fault}"));
        rest.split(' ').next().unwrap().parse::<u64>().unwrap()
    };
    let differing = [pixels(second, 2), pixels(fifth, 5)];
    assert!(differing.iter().all(|pixels| *pixels > 100), "the wall covers much: {differing:?}");
    let expected = Tally {
        runs: 1,
        object_frames: 10 * (BODIES as u64 + 1),
        lost: 2,
        differing: differing[0] + differing[1],
        ties: 0,
        thin: 0,
    };
    assert_eq!(outcome.methods, [expected]);
}

/// Ties are counted and excused. A lost object beside them is not.
#[test]
fn ties_excuse_themselves_and_nothing_beside_them() {
    let gpu = gpu();
    let outcome = judged(&gpu, &[planted(|s| make(s, Fault::Reversed)), planted(RIGHT)], &["coplanar/0"]);
    assert!(outcome.failures.is_empty(), "{:?}", outcome.failures);
    let [reversed, right] = outcome.methods.as_slice() else { panic!() };
    assert_eq!((reversed.lost, reversed.differing, right.ties), (0, 0, 0));
    assert!(reversed.ties > 0, "a world without ties shows nothing");
    let outcome = judged(&gpu, &[planted(|s| make(s, Fault::ReversedAndLoses))], &["coplanar/0"]);
    let [failure] = outcome.failures.as_slice() else { panic!("{:?}", outcome.failures) };
    assert!(failure.faults.len() == 1 && failure.faults[0].starts_with("frame 5: 1 lost, "), "{:?}", failure.faults);
    assert!(outcome.methods[0].lost == 1 && outcome.methods[0].ties > 0, "{:?}", outcome.methods);
}

/// Object 78 shows one pixel in frame 8, of a face seen on edge (`stress_finds.rs`): it is excused alone, and not beside a wall. Other grids round that
/// face in other ways, and may show no such pixel.
#[test]
fn a_thin_pixel_excuses_itself_and_nothing_beside_it() {
    let gpu = gpu();
    let outcome = |make| {
        let drills = vec![DrillId::parse("creeping/24").unwrap()];
        let plan = Plan { subjects: vec![planted(make)], drills, bodies: 600, size: None, as_given: true };
        let outcome = run(&gpu, &plan, &mut |_, _| Ok(())).unwrap();
        (outcome.methods[0].clone(), outcome.failures.len())
    };
    let (sliver, failures) = outcome(|setup| make(setup, Fault::LosesASliver));
    if gpu.snap_px() == 1.0 / 256.0 {
        assert_eq!((sliver.lost, sliver.differing, sliver.thin, failures), (0, 0, 1, 0));
    }
    let (both, failures) = outcome(|setup| make(setup, Fault::LosesASliverAndAWall));
    assert_eq!((both.thin, failures), (0, 1));
    assert!(both.lost > sliver.lost && both.differing > 100, "{both:?}");
    if gpu.snap_px() == 1.0 / 256.0 {
        assert_eq!(both.lost, 2, "the sliver counts too");
    }
}

/// Drills of even seeds are run again: lists that come in another order in another run are caught there, and are no fault elsewhere.
#[test]
fn every_second_drill_is_run_again() {
    let gpu = gpu();
    // Each second instance draws in another order.
    let found = faults(&gpu, |setup| make_buggy(setup, Bug::UnsortedPacking), "creeping/0");
    assert_eq!(found.len(), 10, "{found:?}");
    assert!(found.iter().all(|fault| fault.ends_with("another run draws another picture or list")), "{found:?}");
    assert_eq!(faults(&gpu, |setup| make_buggy(setup, Bug::UnsortedPacking), "creeping/1"), [""; 0]);
}

#[test]
fn a_run_has_so_many_drills_of_each_family_from_the_first_seed_on() {
    let drills: Vec<String> = all_drills(5, 2, 3).iter().map(ToString::to_string).collect();
    let seeds = |name: &str| if name == CHANCE { 5..8 } else { 5..7 };
    let expected: Vec<String> = FAMILIES
        .iter()
        .flat_map(|family| seeds(family.name).map(move |seed| format!("{}/{seed}", family.name)))
        .collect();
    assert_eq!(drills, expected);
    assert!(all_drills(0, 0, 0).is_empty());
}

/// `stress` never told a method to forget, and nothing noticed.
#[test]
fn methods_are_told_to_forget_before_the_frames_of_the_drill_and_no_others() {
    assert_eq!(DrillId::parse("teleports/0").unwrap().make(BODIES).forgets, [3, 6]);
    let found = faults(&gpu(), |setup| make(setup, Fault::TrustsForgetting), "teleports/0");
    assert_eq!(found, [""; 0]);
}

/// It is exact: what it remembers costs no pixel.
#[test]
fn a_method_that_does_not_forget_is_caught() {
    let gpu = gpu();
    for drill in ["teleports/0", "teleports/1"] {
        assert_eq!(faults(&gpu, |setup| make_buggy(setup, Bug::None), drill), [""; 0], "{drill}");
        let found = faults(&gpu, |setup| make_buggy(setup, Bug::ForgetsNothing), drill);
        let expected = "frame 0: a run after forgetting draws another picture or list";
        assert!(found.iter().any(|fault| fault == expected), "{drill}: {found:?}");
        assert!(found.iter().all(|fault| !fault.contains("lost")), "{drill}: {found:?}");
    }
}

/// A method that is a frame late shows what the truth of the frame before shows: a judge that held methods against that frame would find it right.
#[test]
fn each_frame_is_held_against_its_own_truth() {
    let gpu = gpu();
    assert_eq!(faults(&gpu, RIGHT, "creeping/0"), [""; 0]);
    let late = faults(&gpu, |setup| make(setup, Fault::Late), "creeping/0");
    // Frame 0 has no frame before it; the camera moves in each of the others.
    let frames: Vec<_> = late.iter().map(|fault| fault.split(':').next().unwrap()).collect();
    let expected: Vec<_> = (1..10).map(|frame| format!("frame {frame}")).collect();
    assert_eq!(frames, expected, "{late:?}");
}

#[test]
fn counts_stand_by_family_and_by_method() {
    let drills = ["creeping/0", "creeping/1", "teleports/1"];
    let outcome = judged(&gpu(), &[planted(RIGHT), planted(LOSES)], &drills);
    let frames_of = |drill: &&str| {
        let drill = DrillId::parse(drill).unwrap().make(BODIES);
        (drill.case.shots.len() * drill.case.scene.objects.len()) as u64
    };
    let object_frames: Vec<u64> = drills.iter().map(frames_of).collect();
    let family = |name: &str| {
        let index = FAMILIES.iter().position(|family| family.name == name).unwrap();
        &outcome.families[index].tally
    };
    let (creeping, teleports) = (family("creeping"), family("teleports"));
    assert_eq!((creeping.runs, creeping.object_frames), (4, 2 * (object_frames[0] + object_frames[1])));
    assert_eq!((teleports.runs, teleports.object_frames), (2, 2 * object_frames[2]));
    assert_eq!(creeping.lost, 2 * 2, "the wall shows in frames 2 and 5 of each");
    for (entry, row) in FAMILIES.iter().zip(&outcome.families) {
        let ran = ["creeping", "teleports"].contains(&entry.name);
        assert_eq!(row.tally == Tally::default(), !ran, "{}: {:?}", entry.name, row.tally);
        assert_eq!((row.margin.pixels > 0, row.fewest_pixels.is_some()), (ran, ran), "{}", entry.name);
    }
    let [right, loses] = outcome.methods.as_slice() else { panic!() };
    let all = object_frames.iter().sum();
    assert_eq!((right.runs, right.object_frames, right.lost, right.differing), (3, all, 0, 0));
    assert_eq!((loses.runs, loses.object_frames), (3, all));
    assert_eq!(loses.lost, creeping.lost + teleports.lost);
    assert_eq!(loses.differing, creeping.differing + teleports.differing);
    let failed: Vec<_> = outcome.failures.iter().map(|failure| failure.drill.to_string()).collect();
    let expected = if teleports.lost > 0 { &drills[..] } else { &drills[..2] };
    assert_eq!(failed, expected);
}

/// One object that is left out and the frames until it is: the rest of the drill goes, and the failure stays.
#[test]
fn a_failure_is_made_small_and_stays_a_failure() {
    let gpu = gpu();
    let drill = DrillId::parse("creeping/0").unwrap().make(BODIES);
    let small = shrunk(&gpu, &planted(LOSES), &drill);
    assert_eq!((small.case.shots.len(), small.case.scene.objects.len()), (3, 1), "frame 2 needs two before it");
    let mut lab = Lab::new(&gpu, &small.case);
    let (truths, sets) = lab.truths(&small.case.shots);
    let mut method = lab.make(&planted(LOSES), &sets);
    let takes = lab.film(&mut *method, &small.case.shots);
    let lost: Vec<_> =
        truths.iter().zip(&takes).map(|(truth, take)| harness::lab::error_of(truth, take).false_negatives).collect();
    assert_eq!(lost, [0, 0, 1]);
    // So does one that only a run after forgetting shows. One object alone leaves one list, whether it is drawn early or late.
    let drill = DrillId::parse("teleports/0").unwrap().make(4);
    let small = shrunk(&gpu, &planted(|setup| make_buggy(setup, Bug::ForgetsNothing)), &drill);
    assert_eq!((small.forgets.is_empty(), small.case.scene.objects.len()), (false, 2));
}
