//! The stages of `roc` and `eovc` against their twins, and occludee groups against the thesis' words.

use culling::eovc::{mark_invocations, twin as eovc_twin, Tree};
use culling::{View, World};
use engine::{Buffer, Gpu, Placement};
use harness::{gpu, worlds, Random};
use scenes::bvh::{NodeState, Split};
use shaders::types::{
    DrawCommand, TreeNode, CULL_LEVELS, FILTER_STRIP, FIRST_CULL_LIST, GRID_WORDS, MARKED_LIST, RAY_OBJECTS,
};
use shaders::{eovc, pack, roc};

fn stored<T: bytemuck::Pod>(gpu: &Gpu, data: &[T]) -> Buffer<T> {
    Buffer::with_data(gpu, "test", data, Placement::Storage).unwrap()
}

fn zeros(gpu: &Gpu, len: usize) -> Buffer<u32> {
    Buffer::new(gpu, "test", len, Placement::Storage).unwrap()
}

/// One flag in `rarity` is set; none at all for 0.
fn flags(random: &mut Random, len: usize, rarity: usize) -> Vec<u32> {
    (0..len).map(|_| u32::from(rarity > 0 && random.below(rarity) == 0)).collect()
}

/// A world with its hierarchy, and a look at it.
pub struct Stand {
    pub world: World,
    pub tree: Tree,
    pub view: View,
    pub nodes: Vec<TreeNode>,
}

fn stands(gpu: &Gpu) -> Vec<Stand> {
    let case = worlds::walled(600);
    let stand = |shot: &scenes::Shot| {
        let world = World::new(gpu, &case.scene).unwrap();
        let tree = Tree::new(gpu, &world, Split::Sah).unwrap();
        let nodes = tree.read_nodes().unwrap();
        Stand { view: View::new(shot, [320, 180], 0, gpu.snap_px()), world, tree, nodes }
    };
    case.shots.iter().take(3).map(stand).collect()
}

#[test]
fn selecting_boxes_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(71);
    for Stand { world, view, .. } in stands(&gpu) {
        let drawn = flags(&mut random, world.len(), 5);
        let (on_gpu, boxes, newly) = (stored(&gpu, &drawn), zeros(&gpu, world.len()), zeros(&gpu, world.len()));
        let mut f = gpu.frame();
        let stage = roc::SelectBoxes {
            bounds: world.bounds(),
            drawn: on_gpu.all(),
            boxes: boxes.all(),
            newly: newly.all(),
            view: view.cull(),
            object_count: world.len() as u32,
        };
        f.dispatch(stage, world.len() as u32);
        f.finish().unwrap();
        let twin = culling::roc::twin::select_boxes(&world.read_bounds().unwrap(), &view.cull(), &drawn);
        assert_eq!((boxes.read().unwrap(), newly.read().unwrap()), twin);
        assert!(twin.0.contains(&1), "the case must have boxes to test");
    }
}

#[test]
fn instances_are_listed_in_order() {
    let gpu = gpu();
    let mut random = Random::new(72);
    for (len, rarity) in [(1, 1), (64, 2), (65, 0), (5000, 7)] {
        let chosen = flags(&mut random, len, rarity);
        let counts = culling::pack::twin::count_flags(&chosen);
        let (starts, total) = culling::pack::twin::scan_counts(&counts);
        let (listed, command) = (zeros(&gpu, len), stored(&gpu, &[DrawCommand::default()]));
        let (chosen_gpu, starts, total_gpu) = (stored(&gpu, &chosen), stored(&gpu, &starts), stored(&gpu, &[total]));
        let mut f = gpu.frame();
        let stage = pack::WriteIndices {
            flags: chosen_gpu.all(),
            starts: starts.all(),
            total: total_gpu.all(),
            listed: listed.all(),
            command: command.all(),
            object_count: len as u32,
        };
        f.dispatch(stage, counts.len() as u32);
        f.finish().unwrap();
        let twin = culling::pack::twin::write_indices(&chosen);
        assert_eq!(command.read().unwrap()[0].instance_count as usize, twin.len());
        assert_eq!(listed.read().unwrap()[..twin.len()], twin);
    }
}

/// The numbers that the lists' grids start from: no entries, and one work group for the first.
fn grids(gpu: &Gpu) -> Buffer<u32> {
    let mut words = [0, 1, 1, 0].repeat(24);
    words[0] = 1;
    stored(gpu, &words)
}

fn length_of(grids: &Buffer<u32>, list: u32) -> usize {
    grids.read().unwrap()[(list * GRID_WORDS + 3) as usize] as usize
}

/// What a list holds, ascending.
fn listed(list: &Buffer<u32>, len: usize) -> Vec<u32> {
    let mut entries = list.read().unwrap()[..len].to_vec();
    entries.sort_unstable();
    entries
}

/// A frame's number, as a mark.
const FRAME: u32 = 1000;

/// Marked nodes as flags, and the groups beside them, ascending.
pub fn extracted_on_gpu(gpu: &Gpu, stand: &Stand, occluders: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let node_count = stand.tree.len();
    let (occluders, grids) = (stored(gpu, occluders), grids(gpu));
    let [marked, visible, groups] = [(); 3].map(|()| zeros(gpu, node_count));
    let object_count = stand.world.len() as u32;
    let (nodes, leaves, frame) = (stand.tree.nodes(), stand.tree.leaves(), FRAME);
    let (all_marked, all_visible, all_grids) = (marked.all(), visible.all(), grids.all());
    let mut f = gpu.frame();
    let mark = eovc::MarkPaths {
        occluders: occluders.all(),
        leaves,
        nodes,
        marked: all_marked,
        visible: all_visible,
        grids: all_grids,
        object_count,
        frame,
    };
    f.dispatch(mark, mark_invocations(object_count));
    let extract = eovc::ExtractGroups {
        nodes,
        marked: all_marked,
        visible: all_visible,
        groups: groups.all(),
        grids: all_grids,
        frame,
    };
    f.dispatch_indirect(extract, all_grids);
    f.finish().unwrap();
    let marked: Vec<u32> = marked.read().unwrap().iter().map(|mark| u32::from(*mark == FRAME)).collect();
    let set = (0..node_count as u32).filter(|node| marked[*node as usize] != 0).collect::<Vec<_>>();
    assert_eq!(listed(&visible, length_of(&grids, MARKED_LIST)), set, "each marked node is listed once");
    (marked, listed(&groups, length_of(&grids, FIRST_CULL_LIST)))
}

#[test]
fn groups_are_the_thesis_unknown_nodes() {
    let gpu = gpu();
    let mut random = Random::new(73);
    let stand = &stands(&gpu)[0];
    for rarity in [0, 1, 2, 10, 100] {
        let occluders = flags(&mut random, stand.world.len(), rarity);
        let (marked, groups) = extracted_on_gpu(&gpu, stand, &occluders);
        assert_eq!(marked, eovc_twin::mark_paths(stand.tree.host(), &occluders));
        assert_eq!(groups, eovc_twin::extract_groups(&stand.nodes, &marked));
        let chosen: Vec<bool> = occluders.iter().map(|flag| *flag != 0).collect();
        let states = scenes::bvh::extract_groups(stand.tree.host(), &chosen);
        let with = |wanted: NodeState| {
            (0..states.len() as u32).filter(|node| states[*node as usize] == wanted).collect::<Vec<_>>()
        };
        let visible = (0..marked.len() as u32).filter(|node| marked[*node as usize] != 0).collect::<Vec<_>>();
        assert_eq!((visible, groups), (with(NodeState::Visible), with(NodeState::Group)));
    }
}

/// Runs the passes of `eovc/cull_groups` from `groups` on.
pub fn culled_on_gpu(
    gpu: &Gpu,
    stand: &Stand,
    groups: &[u32],
    nothing_hides: bool,
    seen_into: Option<&[bool]>,
) -> eovc_twin::Culled {
    let node_count = stand.nodes.len();
    let mut words = grids(gpu).read().unwrap();
    words[3] = u32::from(!nothing_hides);
    let first = (FIRST_CULL_LIST * GRID_WORDS) as usize;
    (words[first], words[first + 3]) = ((groups.len() as u32).div_ceil(64), groups.len() as u32);
    let grids = stored(gpu, &words);
    let starts = [zeros(gpu, node_count), zeros(gpu, node_count)];
    let mut entries = groups.to_vec();
    entries.resize(node_count, 0);
    let first_starts = stored(gpu, &entries);
    let [groups, singles] = [(); 2].map(|()| zeros(gpu, node_count));
    let hits = zeros(gpu, stand.world.len());
    let commands = [(); 2].map(|()| stored(gpu, &[DrawCommand::default()]));
    let touched: Vec<u32> = (0..node_count)
        .map(|node| if seen_into.is_some_and(|seen_into| seen_into[node]) { FRAME - 1 } else { 0 })
        .collect();
    let touched = stored(gpu, &touched);
    let mut f = gpu.frame();
    for pass in 0..stand.tree.depth() / CULL_LEVELS + 1 {
        let list = FIRST_CULL_LIST + pass;
        let from = if pass == 0 { &first_starts } else { &starts[pass as usize % 2] };
        let cull = eovc::CullGroups {
            nodes: stand.tree.nodes(),
            starts: from.all(),
            unfinished: starts[1 - pass as usize % 2].all(),
            grids: grids.all(),
            groups: groups.all(),
            group_command: commands[0].all(),
            singles: singles.all(),
            single_command: commands[1].all(),
            hits: hits.all(),
            touched: touched.all(),
            view: stand.view.cull(),
            frame: FRAME,
            list,
            constants: eovc::CullGroupsConstants { coherent: seen_into.is_some() },
        };
        f.dispatch_indirect(cull, grids.all().from((list * GRID_WORDS) as usize));
    }
    f.finish().unwrap();
    let count = |which: usize| commands[which].read().unwrap()[0].instance_count as usize;
    let hits = hits.read().unwrap();
    eovc_twin::Culled {
        groups: listed(&groups, count(0)),
        singles: listed(&singles, count(1)),
        hits: (0..hits.len() as u32).filter(|object| hits[*object as usize] != 0).collect(),
    }
}

#[test]
fn culled_groups_equal_their_twin() {
    let gpu = gpu();
    let mut random = Random::new(74);
    for stand in stands(&gpu) {
        for rarity in [0, 20] {
            let occluders = flags(&mut random, stand.world.len(), rarity);
            let nothing_hides = !occluders.contains(&1);
            let groups = eovc_twin::extract_groups(&stand.nodes, &eovc_twin::mark_paths(stand.tree.host(), &occluders));
            let seen_into: Vec<bool> = (0..stand.nodes.len()).map(|_| random.below(2) == 0).collect();
            for seen_into in [None, Some(&seen_into[..])] {
                let twin = eovc_twin::cull_groups(&stand.nodes, &groups, &stand.view.cull(), nothing_hides, seen_into);
                assert!(nothing_hides || !twin.groups.is_empty(), "the case must have groups");
                assert_eq!(culled_on_gpu(&gpu, &stand, &groups, nothing_hides, seen_into), twin);
            }
        }
    }
}

#[test]
fn groups_of_too_many_objects_for_a_ray_are_opened() {
    let gpu = gpu();
    let case = worlds::walled(3 * RAY_OBJECTS as usize);
    let world = World::new(&gpu, &case.scene).unwrap();
    let tree = Tree::new(&gpu, &world, Split::Sah).unwrap();
    let nodes = tree.read_nodes().unwrap();
    // From so far away that nothing reaches the near plane.
    let shot = worlds::shot(glam::DVec3::new(0.0, 0.0, 60.0), glam::DVec3::ZERO, worlds::PERSPECTIVE);
    let stand = Stand { view: View::new(&shot, [320, 180], 0, gpu.snap_px()), world, tree, nodes };
    let culled = culled_on_gpu(&gpu, &stand, &[0], false, None);
    assert_eq!(culled, eovc_twin::cull_groups(&stand.nodes, &[0], &stand.view.cull(), false, None));
    assert!(culled.groups.len() > 1);
    let most = culled.groups.iter().map(|group| stand.nodes[*group as usize].object_count).max();
    assert!(most.is_some_and(|most| most <= RAY_OBJECTS), "{most:?}");
}

#[test]
fn occludees_and_filtered_occluders_equal_their_twins() {
    let gpu = gpu();
    let mut random = Random::new(75);
    let len = 1000;
    let (hits, drawn) = (flags(&mut random, len, 3), flags(&mut random, len, 3));
    let (hits_gpu, drawn_gpu, newly) = (stored(&gpu, &hits), stored(&gpu, &drawn), zeros(&gpu, len));
    let object_count = len as u32;
    let select =
        eovc::SelectOccludees { hits: hits_gpu.all(), drawn: drawn_gpu.all(), newly: newly.all(), object_count };
    let mut f = gpu.frame();
    f.dispatch(select, object_count);
    f.finish().unwrap();
    assert_eq!(newly.read().unwrap(), eovc_twin::select_occludees(&hits, &drawn));
    // Pictures of odd sizes, from the truth of a world.
    for size in [[1, 1], [1, 257], [161, 97], [64, 3]] {
        let case = worlds::walled(150).sized(size);
        let mut lab = harness::Lab::new(&gpu, &case);
        let truth = lab.truth(&case.shots[0]);
        let occluders = zeros(&gpu, lab.world.len());
        let strips = [size[0].div_ceil(2), size[1].div_ceil(FILTER_STRIP)];
        let owners = lab.targets.with_items().item.unwrap();
        let mut f = gpu.frame();
        let stage = eovc::FilterOccluders { owners, occluders: occluders.all(), size_px: size, strips };
        f.dispatch(stage, strips[0] * strips[1]);
        f.finish().unwrap();
        let twin = eovc_twin::filter_occluders(&truth.images().items, lab.world.len());
        assert_eq!(occluders.read().unwrap(), twin, "{size:?}");
        assert_eq!(twin.iter().filter(|flag| **flag != 0).count(), truth.visible_count());
    }
}
