//! The boxes that a method says it tested are those that it counted, and lie where its objects do.

use culling::queries::Costs;
use culling::{Entry, METHODS};
use harness::{assert_caught, assert_none, gpu, sessions, worlds, Case, Lab, Subject};
use sightline::pictures::boxes_view;
use sightline::run::Contender;

/// One line for each frame in which boxes and count differ, or a box is not one of the scene's; `spoil` plants errors.
fn faults(lab: &mut Lab, case: &Case, entry: &Entry, spoil: fn(&mut culling::TestedBoxes)) -> Vec<String> {
    let (_, sets) = lab.truths(&case.shots);
    let mut method = lab.make(&Subject::named(entry.id), &sets);
    let mut faults = Vec::new();
    for (frame, shot) in case.shots.iter().enumerate() {
        method.count_work(true);
        lab.take(&mut *method, shot, frame);
        let place = format!("{} in {}, frame {frame}", entry.id, case.name);
        let counted = method.work().unwrap().boxes;
        let Some(mut boxes) = method.tested_boxes(&lab.world).unwrap() else {
            faults.extend((counted > 0).then(|| format!("{place}: {counted} boxes were tested, but it shows none")));
            continue;
        };
        spoil(&mut boxes);
        let shown = (boxes.groups.len() + boxes.singles.len()) as u64;
        if shown != counted {
            faults.push(format!("{place}: {counted} boxes were tested, but it shows {shown}"));
        }
        let objects = lab.world.all_host_bounds();
        let strange = boxes.singles.iter().filter(|box_| !objects.contains(box_)).count();
        faults.extend((strange > 0).then(|| format!("{place}: {strange} single boxes belong to no object")));
        let holds_two =
            |group: &scenes::Aabb| objects.iter().filter(|inner| group.union(**inner) == *group).count() > 1;
        let small = boxes.groups.iter().filter(|group| !holds_two(group)).count();
        faults.extend((small > 0).then(|| format!("{place}: {small} groups hold fewer than two objects")));
    }
    faults
}

/// `auto` has them where the method it runs has: it begins with one that has.
const BOXES: [&str; 10] =
    ["roc", "roc-iterative", "eovc", "hzb-iterative", "auto", "query-wait", "query-lag", "chc", "chc++", "nohc"];

fn methods_with_boxes() -> Vec<&'static Entry> {
    METHODS.iter().filter(|entry| BOXES.contains(&entry.id)).collect()
}

#[test]
fn boxes_shown_are_boxes_counted() {
    let gpu = gpu();
    let mut all = Vec::new();
    for case in worlds::special() {
        let mut lab = Lab::new(&gpu, &case);
        all.extend(METHODS.iter().flat_map(|entry| faults(&mut lab, &case, entry, |_| ())));
    }
    assert_none(&all);
}

/// `nohc` asks where a query costs less than what it saves. Measured while the machine was busy with something else, no query did, and no
/// box was there to lose: here queries cost nothing.
const QUERIES_PAY: Costs = Costs { query: 0.0, pixel: 0.0, command: 1.0, triangle: 1.0 };

#[test]
fn lost_and_moved_boxes_are_caught() {
    let gpu = gpu();
    QUERIES_PAY.assume(&gpu);
    let case = worlds::walled(40);
    let mut lab = Lab::new(&gpu, &case);
    for entry in methods_with_boxes() {
        let lost = faults(&mut lab, &case, entry, |boxes| _ = boxes.groups.pop().or_else(|| boxes.singles.pop()));
        assert_caught(&lost, "boxes were tested, but it shows");
        let moved = faults(&mut lab, &case, entry, |boxes| {
            boxes.singles.iter_mut().for_each(|box_| box_.max.x += 1.0);
            boxes.groups.iter_mut().for_each(|group| group.max = group.min);
        });
        // Down a hierarchy no single object is asked about here.
        let by_groups = ["chc", "chc++", "nohc"].contains(&entry.id);
        assert_caught(
            &moved,
            if by_groups { "hold fewer than two objects" } else { "single boxes belong to no object" },
        );
    }
}

#[test]
fn methods_without_boxes_say_so() {
    let gpu = gpu();
    let case = worlds::walled(5);
    let mut lab = Lab::new(&gpu, &case);
    let (_, sets) = lab.truths(&case.shots);
    for entry in METHODS {
        let mut method = lab.make(&Subject::named(entry.id), &sets);
        lab.take(&mut *method, &case.shots[0], 0);
        let shown = method.tested_boxes(&lab.world).unwrap().is_some();
        assert_eq!(shown, methods_with_boxes().iter().any(|with| with.id == entry.id), "{}", entry.id);
    }
}

#[test]
fn the_picture_from_above_shows_boxes_and_leaves_the_rest_grey() {
    let gpu = gpu();
    let mut session = sessions::open(&gpu, ("city-block", 0.02, "walk"), 3);
    let entry = culling::find("eovc").unwrap();
    let mut contender = Contender::new(&session, entry, entry.default_options(), &None).unwrap();
    contender.timed(&mut session, 0).unwrap();
    let view = session.look(1).unwrap();
    contender.run(&session, &view, sightline::run::Watched::Items).unwrap();
    let boxes = contender.method.tested_boxes(&session.world).unwrap().unwrap();
    let coloured = |boxes: &culling::TestedBoxes| {
        let picture = boxes_view::from_above(&session, &view, boxes).unwrap();
        assert_eq!([picture.width, picture.height], view.size);
        picture.pixels.iter().filter(|[red, green, blue]| red != green || green != blue).count()
    };
    assert!(coloured(&boxes) > 100);
    assert_eq!(coloured(&culling::TestedBoxes::default()), 0);
}
