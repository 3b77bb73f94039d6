//! Each promise of a scene and each decision about it is broken once, and the law must say so.

use super::cell_worlds::{house, rooms};
use harness::{assert_caught, gpu, laws, Case, Subject};
use scenes::Cells;

fn faults(mut case: Case, lie: fn(&mut Cells)) -> Vec<String> {
    lie(case.scene.cells.as_mut().unwrap());
    laws::no_visible_object_is_culled(&gpu(), &Subject::named("portals"), &case)
}

#[test]
fn a_portal_that_is_missing_is_noticed() {
    assert_caught(&faults(house(), |cells| cells.portals.clear()), "false negatives");
    assert_caught(&faults(rooms(), |cells| cells.portals.clear()), "false negatives");
}

#[test]
fn a_portal_that_is_too_small_is_noticed() {
    let smaller = |cells: &mut Cells| {
        for portal in &mut cells.portals {
            let middle = portal.corners.iter().sum::<glam::DVec3>() / portal.corners.len() as f64;
            portal.corners.iter_mut().for_each(|corner| *corner = middle + 0.3 * (*corner - middle));
        }
    };
    assert_caught(&faults(house(), smaller), "false negatives");
    assert_caught(&faults(rooms(), smaller), "false negatives");
}

#[test]
fn a_portal_to_the_wrong_side_is_noticed() {
    let mirrored = |cells: &mut Cells| {
        cells.portals[0].corners.iter_mut().for_each(|corner| corner.z = -corner.z);
    };
    assert_caught(&faults(house(), mirrored), "false negatives");
}

#[test]
fn a_cell_that_holds_too_little_is_noticed() {
    let lower = |cells: &mut Cells| cells.cells.iter_mut().for_each(|cell| cell.bounds.max.y = cell.bounds.min.y + 2.4);
    assert_caught(&faults(rooms(), lower), "false negatives");
}

/// An eye in a wall that is taken for one in a room sees through the wall.
#[test]
fn walls_that_are_thicker_than_they_say_are_noticed() {
    let thin = |cells: &mut Cells| (cells.half_wall, cells.reach) = (0.01, 0.01);
    assert_caught(&faults(house(), thin), "false negatives");
}
