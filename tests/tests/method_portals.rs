//! The laws of `portals`, on scenes with cells: its worlds are its own, as it refuses those of the other methods.

#[path = "method_portals/worlds.rs"]
mod cell_worlds;
#[path = "method_portals/planted.rs"]
mod planted;

use cell_worlds::{house, rooms};
use culling::portals::seen;
use harness::{assert_none, gpu, laws, sessions, worlds, Case, Lab, Subject};

fn all(law: fn(&engine::Gpu, &Subject, &Case) -> Vec<String>) {
    let gpu = gpu();
    let subject = Subject::named("portals");
    assert_none(&[rooms(), house()].iter().flat_map(|case| law(&gpu, &subject, case)).collect::<Vec<_>>());
}

#[test]
fn no_visible_object_is_culled() {
    all(laws::no_visible_object_is_culled);
}

#[test]
fn no_visible_object_is_culled_on_any_path() {
    let gpu = gpu();
    for (path, set) in
        [("walk", &[][..]), ("rotate", &[]), ("closing-in", &[]), ("cuts", &[]), ("walk", &[("skip", "false")])]
    {
        assert_none(&sessions::faults(&mut sessions::open(&gpu, ("rooms", 0.2, path), 12), "portals", set));
    }
}

#[test]
fn any_size_is_exact() {
    let gpu = gpu();
    for size in [[1, 1], [1, 257], [641, 359]] {
        assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named("portals"), &house().sized(size)));
    }
}

#[test]
fn the_order_of_objects_does_not_matter() {
    let gpu = gpu();
    assert_none(&laws::the_order_of_objects_does_not_matter(&gpu, &Subject::named("portals"), &rooms()));
}

#[test]
fn a_resize_hides_nothing() {
    all(laws::a_resize_hides_nothing);
}

#[test]
fn a_camera_cut_hides_nothing() {
    all(laws::a_camera_cut_hides_nothing);
}

#[test]
fn two_runs_give_the_same_bytes() {
    all(laws::two_runs_give_the_same_bytes);
}

#[test]
fn decisions_do_not_depend_on_the_pass() {
    all(laws::decisions_do_not_depend_on_the_pass);
}

#[test]
fn a_still_camera_shows_one_picture() {
    all(laws::a_still_camera_shows_one_picture);
}

#[test]
fn skipping_changes_no_pixel() {
    let gpu = gpu();
    assert_none(&laws::skipping_changes_no_pixel(&gpu, &Subject::named("portals"), &rooms()));
}

#[test]
fn a_scene_without_cells_is_refused_in_one_line() {
    let gpu = gpu();
    let case = worlds::walled(5);
    let lab = sightline::stress::lab::Lab::new(&gpu, &case).unwrap();
    let refused = lab.make(&Subject::named("portals"), &Default::default()).err().expect("refused");
    let line = format!("{refused:#}");
    assert!(line.contains("method 'portals' needs cells") && !line.contains('\n'), "{line}");
}

/// The lecture: 20 to 50 % of the model are removed at typical views.
#[test]
fn most_rooms_are_removed_along_the_walk() {
    let gpu = gpu();
    let mut session = sessions::open(&gpu, ("rooms", 0.5, "walk"), 24);
    let cells = session.scene.cells.clone().unwrap();
    let (mut most, mut anywhere) = (0, 0);
    for frame in 0..session.frames() {
        let view = session.look(frame).unwrap();
        match seen(&cells, &view) {
            Ok(pictures) => most = most.max(pictures[..cells.cells.len()].iter().flatten().count()),
            Err(reason) => {
                println!("frame {frame}: {reason}");
                anywhere += 1;
            }
        }
    }
    println!(
        "at most {most} of {} cells are seen, and everything may be in {anywhere} of 24 frames",
        cells.cells.len()
    );
    assert!(2 * most < cells.cells.len() && anywhere <= 2, "{most} cells, {anywhere} frames");
}

#[test]
fn a_file_with_cells_is_culled_like_the_scene_it_was_written_from() {
    let gpu = gpu();
    let case = rooms();
    let file = scenes::export_glb(&case.scene, None, 1).unwrap();
    let scene = scenes::import_bytes(std::path::Path::new("rooms.glb"), &file).unwrap();
    assert_eq!(scene.cells, case.scene.cells, "cells come back as they were");
    let case = Case { scene, ..case };
    assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named("portals"), &case));
    let mut lab = Lab::new(&gpu, &case);
    let mut method = lab.make(&Subject::named("portals"), &Default::default());
    let drawn = lab.take(&mut *method, &case.shots[0], 0).drawn.objects.iter().filter(|drawn| **drawn).count();
    assert!(drawn < case.scene.objects.len() / 2, "{drawn} of {} objects are drawn", case.scene.objects.len());
}
