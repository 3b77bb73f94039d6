//! Occludee groups on the GPU against the thesis' words (`scenes::bvh::extract_groups`), node for node, on trees by chance.

use super::trees::{culled_on_gpu, extracted_on_gpu, Stand};
use culling::eovc::twin::Culled;
use culling::eovc::Tree;
use culling::{View, World};
use engine::Gpu;
use glam::DVec3;
use harness::{gpu, worlds};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};
use scenes::bvh::{Bvh, NodeState, Split, NO_NODE};
use scenes::{Projection, Scene};

/// Objects, each a place and the share of chance that makes it an occluder, and how the tree is split.
#[derive(Clone, Debug)]
struct Sample {
    places: Vec<(DVec3, DVec3)>,
    occluders: Vec<bool>,
    split: Split,
}

fn any_place() -> impl Strategy<Value = (DVec3, DVec3)> {
    let numbers = || prop::array::uniform3(-40.0..40.0f64).prop_map(DVec3::from);
    prop_oneof![
        (numbers(), prop::array::uniform3(0.0..5.0f64).prop_map(DVec3::from)),
        // The same box again and again: no cut tells them apart.
        Just((DVec3::ONE, DVec3::ONE)),
        // On a grid, so that centres are equal in an axis.
        numbers().prop_map(|at| ((at / 20.0).round() * 20.0, DVec3::splat(20.0))),
        numbers().prop_map(|at| (at, DVec3::ZERO)),
    ]
}

fn any_sample() -> impl Strategy<Value = Sample> {
    let count = prop_oneof![Just(0), Just(1), Just(2), 3..20usize, 20..200usize];
    let split = prop_oneof![Just(Split::Sah), Just(Split::Middle), Just(Split::EqualCount)];
    let share = prop_oneof![Just(0.0), Just(1.0), 0.0..1.0f64, 0.0..0.05f64];
    (count, split, share).prop_flat_map(|(count, split, share)| {
        let places = prop::collection::vec(any_place(), count);
        let occluders = prop::collection::vec(prop::bool::weighted(share), count);
        (places, occluders).prop_map(move |(places, occluders)| Sample { places, occluders, split })
    })
}

fn scene(places: &[(DVec3, DVec3)]) -> Scene {
    let mut maker = worlds::Maker::new("groups");
    let cube = maker.mesh(worlds::cube());
    places.iter().for_each(|(at, size)| maker.place(cube, worlds::sized(*at, *size)));
    maker.scene
}

/// What the GPU says: marks, nodes listed as groups, as single objects, and objects hit without a test. All of every box lies
/// in the view volume, far from the near plane: nothing is dropped and nothing is opened.
fn extracted(gpu: &Gpu, stand: &Stand, occluders: &[bool]) -> (Vec<u32>, Vec<u32>, Culled) {
    if stand.tree.is_empty() {
        return Default::default();
    }
    let flags: Vec<u32> = occluders.iter().map(|occluder| u32::from(*occluder)).collect();
    let (marked, groups) = extracted_on_gpu(gpu, stand, &flags);
    // As if there were an occluder even where there is none: else all would be opened.
    let culled = culled_on_gpu(gpu, stand, &groups, false, None);
    (marked, groups, culled)
}

/// How many of the nodes listed lie on the way from a leaf to the root, itself included.
fn groups_above(bvh: &Bvh, leaf: u32, listed: &[u32]) -> usize {
    let above =
        std::iter::successors(Some(leaf), |node| Some(bvh.parents()[*node as usize]).filter(|node| *node != NO_NODE));
    above.filter(|node| listed.binary_search(node).is_ok()).count()
}

fn check(gpu: &Gpu, sample: &Sample) -> Result<(), TestCaseError> {
    let world = World::new(gpu, &scene(&sample.places)).unwrap();
    let tree = Tree::new(gpu, &world, sample.split).unwrap();
    prop_assert_eq!(tree.len(), (2 * world.len()).saturating_sub(1));
    let around = Projection::Orthographic { half_height: 200.0, near: 1.0, far: 1000.0 };
    let view = View::new(&worlds::shot(DVec3::Z * 500.0, DVec3::ZERO, around), [64, 64], 0, gpu.snap_px());
    let nodes = tree.read_nodes().unwrap();
    let stand = Stand { world, tree, view, nodes };
    let bvh = stand.tree.host();
    let (marked, extracted_groups, Culled { groups, singles, hits }) = extracted(gpu, &stand, &sample.occluders);
    let states = scenes::bvh::extract_groups(bvh, &sample.occluders);
    let is = |state: NodeState, leaf: bool| {
        let nodes = (0..states.len()).filter(|node| states[*node] == state && bvh.nodes()[*node].is_leaf() == leaf);
        nodes.map(|node| node as u32).collect::<Vec<u32>>()
    };
    let visible: Vec<u32> = states.iter().map(|state| u32::from(*state == NodeState::Visible)).collect();
    prop_assert_eq!(&marked, &visible, "paths");
    prop_assert_eq!(&groups, &is(NodeState::Group, false), "groups of several objects");
    prop_assert_eq!(&singles, &is(NodeState::Group, true), "groups of one object");
    prop_assert!(hits.is_empty(), "nothing reaches the near plane, but these were hit: {hits:?}");
    let mut all = [groups, singles].concat();
    all.sort_unstable();
    prop_assert_eq!(&extracted_groups, &all, "every group is in the view volume, and none is opened");
    for (object, leaf) in bvh.leaf_of_object().iter().enumerate() {
        let expected = usize::from(!sample.occluders[object]);
        prop_assert_eq!(groups_above(bvh, *leaf, &all), expected, "object {} is in so many groups", object);
    }
    Ok(())
}

#[test]
fn groups_are_the_thesis_groups_and_divide_the_leaves() {
    let gpu = gpu();
    let config = Config { cases: 150, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config.clone(), proptest::test_runner::TestRng::deterministic_rng(config.rng_algorithm))
        .run(&any_sample(), |sample| check(&gpu, &sample))
        .unwrap();
}
