//! The hybrid query and the order of commands: they change what is drawn and how, never what is seen.

use culling::woc::twin::hold_candidates;
use engine::{Buffer, Placement};
use harness::occludees::Occludees;
use harness::worlds::{self, PERSPECTIVE};
use harness::{assert_none, gpu, laws, sessions, Lab, Random, Subject};
use scenes::{Pose, Shot};
use shaders::types::DrawCommand;
use shaders::woc;

const SIZE: [u32; 2] = [161, 97];
const BOXES: usize = 2_000;

#[test]
fn candidates_are_held_as_the_twin_says() {
    let gpu = gpu();
    let mut random = Random::new(71);
    let (mut held, mut differ) = (0, 0);
    for _ in 0..8 {
        let pose = Pose { position: random.vector() * 100.0, rotation: random.turn() };
        let shot = Shot { pose, projection: PERSPECTIVE, seconds: 0.0 };
        let input = Occludees::by_chance(&mut random, &shot, SIZE, gpu.snap_px(), BOXES);
        let candidates: Vec<u32> = (0..BOXES as u32).step_by(5).collect();
        let mut shown: Vec<u32> = (0..BOXES).map(|_| u32::from(random.below(3) > 0)).collect();
        let storage = Placement::Storage;
        let words = |data: &[u32]| Buffer::with_data(&gpu, "test.words", data, storage).unwrap();
        let (of_candidates, of_shown) = (words(&candidates), words(&shown));
        let listed = words(&vec![u32::MAX; candidates.len()]);
        let bounds = Buffer::with_data(&gpu, "test.bounds", &input.bounds, storage).unwrap();
        let command = Buffer::with_data(&gpu, "test.command", &[DrawCommand::default()], storage).unwrap();
        let stage = woc::HoldCandidates {
            candidates: of_candidates.all(),
            bounds: bounds.all(),
            shown: of_shown.all(),
            listed: listed.all(),
            command: command.all(),
            view: input.view,
            candidate_count: candidates.len() as u32,
        };
        let mut f = gpu.frame();
        f.dispatch(stage, 1);
        f.finish().unwrap();
        let count = command.read().unwrap()[0].instance_count as usize;
        let found = listed.read().unwrap()[..count].to_vec();
        let twin = hold_candidates(&candidates, &input.bounds, &input.view, &mut shown);
        held += twin.len();
        // Rounding may decide for boxes that just reach the near plane.
        differ += found.iter().filter(|object| !twin.contains(object)).count();
        differ += twin.iter().filter(|object| !found.contains(object)).count();
        let out = of_shown.read().unwrap();
        assert!(found.iter().all(|object| out[*object as usize] == 0), "a held candidate is still shown");
        assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "boxes out of order");
        assert_eq!(out.iter().sum::<u32>() as usize + count, shown.iter().sum::<u32>() as usize + twin.len());
    }
    assert!(held > 500, "{held} candidates held: nothing is shown");
    assert!(differ <= held / 500, "{differ} of {held} differ");
}

/// Every object a candidate, or some; with the others drawn first, packed, in their places or shuffled.
fn subjects(id: &str) -> Vec<Subject> {
    let sets: [&[(&str, &str)]; 5] = [
        &[("hybrid", "10000"), ("hybrid-triangles", "0")],
        &[("hybrid", "20"), ("hybrid-triangles", "3"), ("rapid", "0"), ("size", "1")],
        &[("hybrid", "10000"), ("hybrid-triangles", "0"), ("commands", "shuffled"), ("rapid", "0.005")],
        &[("commands", "zero-instance")],
        &[("commands", "shuffled"), ("rapid", "0")],
    ];
    let set = |options: &[(&str, &str)]| {
        options.iter().fold(Subject::named(id), |subject, (option, value)| subject.with(option, value))
    };
    sets.iter().map(|options| set(options)).collect()
}

#[test]
fn no_visible_object_is_culled() {
    let gpu = gpu();
    for subject in subjects("woc-exact") {
        for case in worlds::special().into_iter().chain([worlds::walled(300)]) {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &subject, &case));
        }
        assert_none(&laws::skipping_changes_no_pixel(&gpu, &subject, &worlds::walled(100)));
        assert_none(&laws::two_runs_give_the_same_bytes(&gpu, &subject, &worlds::walled(100)));
    }
}

#[test]
fn no_visible_object_is_culled_where_objects_move() {
    let gpu = gpu();
    let all = [("hybrid", "10000"), ("hybrid-triangles", "0"), ("commands", "shuffled")];
    for run in [("moving-boxes", 1.0, "walk"), ("moving-boxes", 1.0, "still"), ("boxes", 1.0, "closing-in")] {
        assert_none(&sessions::faults(&mut sessions::open(&gpu, run, 8), "woc-exact", &all));
    }
}

/// What the boxes hide is not drawn: with all objects but the wall candidates, fewer are drawn than without.
#[test]
fn boxes_hide_what_the_map_does_not() {
    let gpu = gpu();
    let mut case = worlds::walled(400).sized([640, 360]);
    // A wall of two triangles, so that it is no candidate.
    case.scene.meshes.push(worlds::square());
    case.scene.objects[0].mesh = case.scene.meshes.len() as u32 - 1;
    let mut drawn = [("0", 0, 0), ("10000", 0, 0)];
    for (most, objects, boxes) in &mut drawn {
        let coarse = Subject::named("woc").with("size", "4").with("rapid", "0").with("hybrid-triangles", "2");
        let subject = coarse.with("hybrid", most);
        let mut lab = Lab::new(&gpu, &case);
        let mut method = lab.make(&subject, &Default::default());
        for frame in 0..4 {
            let take = lab.take(&mut *method, &case.shots[0], frame);
            *objects = take.drawn.objects.iter().filter(|drawn| **drawn).count();
        }
        *boxes = method.work().unwrap().boxes;
    }
    let [(_, without, no_boxes), (_, with, boxes)] = drawn;
    println!("{without} objects drawn, {with} with {boxes} boxes");
    assert_eq!(no_boxes, 0);
    assert!(boxes as usize >= with && with < without, "{with} of {boxes} boxes drawn, {without} without boxes");
}
