//! Laws of the bounding volume hierarchy: building, bounds that are no box, refitting.

mod bvh_support;

use bvh_support::{any_boxes, any_split, box_at, SPLITS};
use glam::DVec3;
use proptest::prelude::*;
use scenes::bvh::{BadBounds, Bvh, BvhError, BvhOptions, Split, DEPTH_LIMIT, NO_NODE, REBUILD_FACTOR};
use scenes::{Aabb, SceneOptions, WorldBounds};

fn depth_bound(objects: usize) -> u32 {
    (2 * objects.next_power_of_two().ilog2() + 8).min(DEPTH_LIMIT)
}

fn assert_holds_each_object_once(bvh: &Bvh, boxes: &[Aabb]) {
    assert_eq!(bvh.validate(), Ok(()));
    assert_eq!(bvh.nodes().len(), (2 * boxes.len()).saturating_sub(1));
    for (object, bounds) in boxes.iter().enumerate() {
        let leaf = bvh.nodes()[bvh.leaf_of_object()[object] as usize];
        assert_eq!((leaf.object(), leaf.bounds), (Some(object as u32), *bounds));
    }
}

fn aside(boxes: &[Aabb], split: Split) -> Bvh {
    Bvh::build_with(boxes, BvhOptions { split, bad_bounds: BadBounds::SetAside }).unwrap()
}

proptest! {
    #[test]
    fn every_split_puts_each_object_in_one_leaf_of_a_valid_tree(boxes in any_boxes(0..120), split in any_split()) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        assert_holds_each_object_once(&bvh, &boxes);
        prop_assert_eq!(bvh.split(), split);
        if split != Split::Ploc && !boxes.is_empty() {
            prop_assert!(bvh.depth() <= depth_bound(boxes.len()));
        }
    }

    #[test]
    fn the_same_boxes_give_the_same_tree(boxes in any_boxes(0..120), split in any_split()) {
        let [one, other] = [(); 2].map(|()| Bvh::build(&boxes, split).unwrap());
        prop_assert_eq!(one.nodes(), other.nodes());
        prop_assert_eq!(one.parents(), other.parents());
    }

    #[test]
    fn siblings_are_each_others_and_share_their_parent(boxes in any_boxes(2..60), split in any_split()) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        prop_assert_eq!((bvh.sibling(0), bvh.parents()[0]), (None, NO_NODE));
        for node in 1..bvh.nodes().len() as u32 {
            let sibling = bvh.sibling(node).unwrap();
            prop_assert_eq!(bvh.sibling(sibling), Some(node));
            prop_assert_eq!(bvh.parents()[node as usize], bvh.parents()[sibling as usize]);
            let parent = bvh.nodes()[bvh.parents()[node as usize] as usize];
            prop_assert_eq!(parent.children(), Some([node.min(sibling), node.max(sibling)]));
        }
    }

    #[test]
    fn bad_bounds_are_refused_by_index_or_set_aside(
        boxes in any_boxes(1..40), split in any_split(), at in any::<prop::sample::Index>(), kind in 0..5usize,
    ) {
        let mut boxes = boxes;
        let broken = at.index(boxes.len());
        let good = boxes[broken];
        boxes[broken] = [
            Aabb::EMPTY,
            Aabb { min: good.min.with_y(f64::NAN), max: good.max },
            Aabb { min: good.min, max: good.max.with_z(f64::NAN) },
            Aabb { min: good.min, max: good.max.with_x(f64::INFINITY) },
            Aabb { min: good.max + 1.0, max: good.min - 1.0 },
        ][kind];
        match Bvh::build(&boxes, split) {
            Err(BvhError::BadBounds { object, fault, .. }) => {
                prop_assert_eq!(object, broken);
                prop_assert_eq!(fault, ["inverted", "NaN", "NaN", "infinite", "inverted"][kind]);
            }
            other => prop_assert!(false, "{other:?}"),
        }
        let bvh = aside(&boxes, split);
        prop_assert_eq!(bvh.validate(), Ok(()));
        prop_assert_eq!(bvh.unbounded(), &[broken as u32]);
        prop_assert_eq!(bvh.leaf_of_object()[broken], NO_NODE);
        prop_assert_eq!(bvh.nodes().len(), (2 * (boxes.len() - 1)).saturating_sub(1));
    }

    #[test]
    fn a_refitted_tree_holds_the_new_boxes_in_the_old_shape(boxes in any_boxes(0..80), split in any_split(), seed in 0..1000u32) {
        let built = Bvh::build(&boxes, split).unwrap();
        let offset = |object: usize| f64::from((object as u32).wrapping_mul(2_654_435_761).wrapping_add(seed) % 97);
        let moved: Vec<Aabb> = boxes.iter().enumerate()
            .map(|(object, bounds)| Aabb { min: bounds.min + offset(object), max: bounds.max + offset(object) }).collect();
        let mut refitted = built.clone();
        refitted.refit(&moved).unwrap();
        assert_holds_each_object_once(&refitted, &moved);
        prop_assert_eq!(refitted.parents(), built.parents());
        refitted.refit(&boxes).unwrap();
        prop_assert_eq!(refitted.nodes(), built.nodes());
        prop_assert!(!refitted.needs_rebuild(REBUILD_FACTOR));
    }

    #[test]
    fn cost_is_between_one_and_all_nodes(boxes in any_boxes(1..80), split in any_split()) {
        let bvh = Bvh::build(&boxes, split).unwrap();
        let nodes = bvh.nodes().len() as f64;
        prop_assert!((1.0..=nodes * (1.0 + 1e-12)).contains(&bvh.cost()), "{} of {nodes}", bvh.cost());
    }
}

#[test]
fn no_object_one_and_two() {
    for split in SPLITS {
        let none = Bvh::build(&[], split).unwrap();
        assert_eq!((none.root(), none.depth(), none.cost(), none.nodes().len()), (None, 0, 0.0, 0));
        assert!(!none.needs_rebuild(REBUILD_FACTOR));
        let one = Bvh::build(&[box_at(DVec3::ONE, 1.0)], split).unwrap();
        assert_eq!((one.root(), one.depth(), one.cost(), one.nodes()[0].object()), (Some(0), 0, 1.0, Some(0)));
        let two = Bvh::build(&[box_at(DVec3::ONE, 1.0), box_at(DVec3::ZERO, 1.0)], split).unwrap();
        assert_eq!((two.depth(), two.nodes()[0].children()), (1, Some([1, 2])));
    }
}

#[test]
fn all_objects_bad_leaves_an_empty_tree_that_remembers_them() {
    let bvh = aside(&[Aabb::EMPTY; 3], Split::Sah);
    assert_eq!((bvh.nodes().len(), bvh.unbounded()), (0, &[0, 1, 2][..]));
}

#[test]
fn a_million_objects_at_a_point_make_a_balanced_tree() {
    let boxes = vec![box_at(DVec3::splat(1e6), 0.0); 1_000_000];
    for split in [Split::Sah, Split::Middle, Split::EqualCount] {
        assert_eq!(Bvh::build(&boxes, split).unwrap().depth(), 20, "{split:?}");
    }
}

#[test]
fn ploc_neither_stalls_nor_chains_where_all_distances_tie() {
    // The bug: a heap took quadratic time (10,000 objects at a point: 3.8 s in a release build) and gave a chain.
    let at =
        |place: fn(f64) -> DVec3| (0..20_000).map(|index| box_at(place(f64::from(index)), 0.0)).collect::<Vec<_>>();
    let ties = [
        ("a point", at(|_| DVec3::ZERO)),
        ("a row", at(|index| DVec3::new(index, 0.0, 0.0))),
        ("a heap and an outlier", at(|index| if index == 0.0 { DVec3::ZERO } else { DVec3::splat(0.9) })),
        ("a grid", at(|index| DVec3::new((index / 100.0).floor(), index % 100.0, 0.0))),
    ];
    for (name, boxes) in ties {
        let bvh = Bvh::build(&boxes, Split::Ploc).unwrap();
        assert_eq!(bvh.split(), Split::Ploc, "{name}");
        assert!(bvh.depth() <= 40, "{name}: depth {}", bvh.depth());
    }
}

#[test]
fn the_most_uneven_spacing_stays_within_the_depth_bound() {
    // Each object twice as far as the last: the middle always cuts off one.
    let spread = |at: f64| box_at(DVec3::new(at, 0.0, 0.0), 0.0);
    let boxes: Vec<Aabb> = (-500..500).map(|power| spread(f64::from(power).exp2())).collect();
    for split in SPLITS {
        let bvh = Bvh::build(&boxes, split).unwrap();
        assert_holds_each_object_once(&bvh, &boxes);
        assert!(bvh.depth() <= depth_bound(boxes.len()) || split == Split::Ploc, "{split:?}: {}", bvh.depth());
        assert!(bvh.depth() <= DEPTH_LIMIT);
    }
    assert_eq!(Bvh::build(&boxes, Split::Middle).unwrap().depth(), depth_bound(boxes.len()), "the bound is not tested");
}

#[test]
fn numbers_at_the_ends_of_f64_are_boxes_too() {
    let most = f64::MAX;
    let mut boxes = vec![Aabb { min: DVec3::splat(-most), max: DVec3::splat(most) }];
    for step in 0..40 {
        let sign = if step % 2 == 0 { 1.0 } else { -1.0 };
        boxes.push(box_at(DVec3::new(sign * most / 2.0, f64::from(step) * 1e300, 0.0), 0.0));
        boxes.push(box_at(DVec3::splat(f64::from(step) * 5e-324), 5e-324));
    }
    for split in SPLITS {
        let bvh = Bvh::build(&boxes, split).unwrap();
        assert_holds_each_object_once(&bvh, &boxes);
        assert!(bvh.cost().is_finite());
        let tiny: Vec<Aabb> = boxes.iter().skip(2).step_by(2).copied().collect();
        let bvh = Bvh::build(&tiny, split).unwrap();
        assert_holds_each_object_once(&bvh, &tiny);
        assert!(bvh.cost().is_finite());
    }
}

#[test]
fn cost_is_the_areas_over_the_roots() {
    // Two unit cubes with one cube between: 3 x 1 x 1 has 14 faces, each cube 6.
    let boxes = [box_at(DVec3::ZERO, 0.5), box_at(DVec3::new(2.0, 0.0, 0.0), 0.5)];
    let cost = Bvh::build(&boxes, Split::Sah).unwrap().cost();
    assert!((cost - (1.0 + 12.0 / 14.0)).abs() < 1e-15, "{cost}");
    // On a line there are no areas: each node counts.
    let line: Vec<Aabb> = (0..5).map(|x| box_at(DVec3::new(f64::from(x), 0.0, 0.0), 0.0)).collect();
    assert_eq!(Bvh::build(&line, Split::Sah).unwrap().cost(), 9.0);
}

#[test]
fn points_on_a_line_are_halved_though_no_cut_has_an_area() {
    let line: Vec<Aabb> = (0..1024).map(|x| box_at(DVec3::new(0.0, f64::from(x), 0.0), 0.0)).collect();
    let depth = Bvh::build(&line, Split::Sah).unwrap().depth();
    assert!(depth <= 11, "{depth}");
}

#[test]
fn sah_is_the_cheapest_cut_in_a_city() {
    let scene = scenes::open("city-block", &SceneOptions { scale: 0.05, ..SceneOptions::default() }).unwrap();
    let bounds = WorldBounds::new(&scene);
    let boxes: Vec<Aabb> =
        scene.objects.iter().map(|object| bounds.of(object.mesh, &object.world_from_object)).collect();
    let cost = |split| Bvh::build(&boxes, split).unwrap().cost();
    let sah = cost(Split::Sah);
    for other in [Split::Middle, Split::EqualCount] {
        assert!(1.1 * sah < cost(other), "{other:?}: {} against {sah}", cost(other));
    }
}

#[test]
fn a_failed_refit_changes_nothing() {
    let boxes: Vec<Aabb> = (0..9).map(|x| box_at(DVec3::splat(f64::from(x)), 0.3)).collect();
    let mut bvh = Bvh::build(&boxes, Split::Sah).unwrap();
    let before = bvh.nodes().to_vec();
    let mut moved: Vec<Aabb> =
        boxes.iter().map(|bounds| Aabb { min: bounds.min + 1.0, max: bounds.max + 1.0 }).collect();
    moved[8] = Aabb::EMPTY;
    assert!(matches!(bvh.refit(&moved), Err(BvhError::BadBounds { object: 8, fault: "inverted", .. })));
    assert_eq!(bvh.nodes(), before);
}

#[test]
fn an_object_set_aside_stays_aside_until_the_tree_is_built_anew() {
    let mut boxes = vec![box_at(DVec3::ZERO, 1.0), Aabb::EMPTY, box_at(DVec3::ONE, 1.0)];
    let mut bvh = aside(&boxes, Split::Sah);
    bvh.refit(&boxes).unwrap();
    boxes[1] = box_at(DVec3::splat(9.0), 1.0);
    bvh.refit(&boxes).unwrap();
    assert_eq!((bvh.validate(), bvh.unbounded()), (Ok(()), &[1][..]));
    assert!(Bvh::build(&boxes, Split::Sah).unwrap().unbounded().is_empty());
}

#[test]
fn a_tree_past_its_factor_asks_to_be_built_anew() {
    let place = |index: usize| DVec3::new((index % 10) as f64, (index / 10 % 10) as f64, (index / 100) as f64) * 10.0;
    let boxes: Vec<Aabb> = (0..1000).map(|index| box_at(place(index), 1.0)).collect();
    let built = Bvh::build(&boxes, Split::Sah).unwrap();
    let after = |boxes: &[Aabb]| {
        let mut bvh = built.clone();
        bvh.refit(boxes).unwrap();
        bvh.needs_rebuild(REBUILD_FACTOR)
    };
    assert!(!after(&boxes), "nothing moved");
    let slid: Vec<Aabb> = (0..1000).map(|index| box_at(place(index) + DVec3::splat(1e3), 1.0)).collect();
    assert!(!after(&slid), "all moved alike");
    let shuffled: Vec<Aabb> = (0..1000).map(|index| box_at(place(index * 387 % 1000), 1.0)).collect();
    assert!(after(&shuffled), "all changed places");
    let mut flown = boxes.clone();
    flown[123] = box_at(DVec3::splat(1e6), 1.0);
    assert!(after(&flown), "one flew away, and the root with it");
    let shrunk: Vec<Aabb> = (0..1000).map(|index| box_at(place(index * 387 % 1000) * 0.01, 0.01)).collect();
    assert!(after(&shrunk), "all changed places, and came closer together");
}
