//! Laws of the occludee group extraction (EOVC thesis, section III.3).

mod bvh_support;

use bvh_support::{any_boxes, any_split, box_at};
use glam::DVec3;
use proptest::prelude::*;
use scenes::bvh::{extract_groups, extract_groups_from, BadBounds, Bvh, BvhOptions, NodeState, Split};
use scenes::Aabb;
use NodeState::{Group, Nil, Visible};

fn any_tree_with_occluders() -> impl Strategy<Value = (Bvh, Vec<bool>)> {
    (any_boxes(1..100), any_split(), 0.0..1.0f64).prop_flat_map(|(boxes, split, share)| {
        let occluders = prop::collection::vec(prop::bool::weighted(share * share), boxes.len());
        (Just(Bvh::build(&boxes, split).unwrap()), occluders)
    })
}

fn ancestors_and_self(bvh: &Bvh, node: u32) -> impl Iterator<Item = u32> + '_ {
    std::iter::successors(Some(node), |node| bvh.parents().get(*node as usize).copied())
        .take_while(|node| (*node as usize) < bvh.nodes().len())
}

proptest! {
    #[test]
    fn groups_and_occluders_partition_the_leaves((bvh, occluders) in any_tree_with_occluders()) {
        let states = extract_groups(&bvh, &occluders);
        for (object, leaf) in bvh.leaf_of_object().iter().enumerate() {
            let path: Vec<u32> = ancestors_and_self(&bvh, *leaf).collect();
            let marks: Vec<NodeState> = path.iter().map(|node| states[*node as usize]).collect();
            let groups = marks.iter().filter(|mark| **mark == Group).count();
            prop_assert_eq!(groups, usize::from(!occluders[object]));
            // From the leaf up: nil below the group, visible above it; an occluder's path is visible throughout.
            let below = if occluders[object] { 0 } else { marks.iter().position(|mark| *mark == Group).unwrap() };
            prop_assert!(marks[..below].iter().all(|mark| *mark == Nil));
            let above = if occluders[object] { 0 } else { below + 1 };
            prop_assert!(marks[above..].iter().all(|mark| *mark == Visible));
        }
    }

    #[test]
    fn states_are_what_the_occluders_below_say((bvh, occluders) in any_tree_with_occluders()) {
        let mut occluders_below = vec![0; bvh.nodes().len()];
        for (object, leaf) in bvh.leaf_of_object().iter().enumerate() {
            for node in ancestors_and_self(&bvh, *leaf) {
                occluders_below[node as usize] += usize::from(occluders[object]);
            }
        }
        let states = extract_groups(&bvh, &occluders);
        for node in 0..bvh.nodes().len() as u32 {
            let beside = bvh.sibling(node).map_or(1, |sibling| occluders_below[sibling as usize]);
            let expected = match (occluders_below[node as usize], beside) {
                (0, 0) => Nil,
                (0, _) => Group,
                _ => Visible,
            };
            prop_assert_eq!(states[node as usize], expected, "node {}", node);
        }
    }

    #[test]
    fn the_order_of_occluders_does_not_matter((bvh, occluders) in any_tree_with_occluders(), turn in 0..100usize) {
        let mut order: Vec<u32> = (0..occluders.len() as u32).filter(|object| occluders[*object as usize]).collect();
        let states = extract_groups(&bvh, &occluders);
        order.reverse();
        prop_assert_eq!(&extract_groups_from(&bvh, order.iter().copied()), &states);
        let turn = turn % order.len().max(1);
        order.rotate_left(turn);
        let twice = order.iter().chain(&order).copied();
        prop_assert_eq!(&extract_groups_from(&bvh, twice), &states);
    }

    #[test]
    fn all_occluders_leave_no_group(boxes in any_boxes(1..60), split in any_split()) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        let states = extract_groups(&bvh, &vec![true; boxes.len()]);
        prop_assert!(states.iter().all(|state| *state == Visible));
    }

    #[test]
    fn without_an_occluder_the_root_is_the_group(boxes in any_boxes(1..60), split in any_split()) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        let states = extract_groups(&bvh, &vec![false; boxes.len()]);
        prop_assert_eq!(states[0], Group);
        prop_assert!(states[1..].iter().all(|state| *state == Nil));
    }
}

/// Objects 0 1 2 3 in a row, in halves: root 0 over 1 (objects 0, 1) and 2 (objects 2, 3).
fn four_in_a_row() -> Bvh {
    let boxes: Vec<Aabb> = (0..4).map(|x| box_at(DVec3::new(f64::from(x), 0.0, 0.0), 0.4)).collect();
    let bvh = Bvh::build(&boxes, Split::EqualCount).unwrap();
    let objects: Vec<Option<u32>> = bvh.nodes().iter().map(|node| node.object()).collect();
    assert_eq!(objects, [None, None, None, Some(0), Some(1), Some(2), Some(3)]);
    bvh
}

#[test]
fn a_small_tree_node_for_node() {
    let bvh = four_in_a_row();
    assert_eq!(extract_groups(&bvh, &[true, false, false, false]), [Visible, Visible, Group, Visible, Group, Nil, Nil]);
    // The group of the first traversal turns visible in the second.
    let both = [Visible, Visible, Visible, Visible, Group, Group, Visible];
    assert_eq!(extract_groups(&bvh, &[true, false, false, true]), both);
    assert_eq!(extract_groups_from(&bvh, [3, 0]), both);
}

#[test]
fn states_are_numbered_as_a_buffer_of_zeros_needs_it() {
    assert_eq!([Nil as u32, Visible as u32, Group as u32], [0, 1, 2]);
}

#[test]
fn an_empty_tree_has_no_groups() {
    assert!(extract_groups(&Bvh::build(&[], Split::Sah).unwrap(), &[]).is_empty());
}

#[test]
fn an_object_outside_the_tree_marks_nothing() {
    let boxes = [box_at(DVec3::ZERO, 1.0), Aabb::EMPTY, box_at(DVec3::ONE, 1.0)];
    let bvh = Bvh::build_with(&boxes, BvhOptions { bad_bounds: BadBounds::SetAside, ..BvhOptions::default() }).unwrap();
    assert_eq!(extract_groups(&bvh, &[false, true, false]), [Group, Nil, Nil]);
}
