//! The stages of `roc` and `eovc` against their twins, and occludee groups against the thesis' words.

use culling::eovc::{twin as eovc_twin, Tree};
use culling::{View, World};
use engine::{Buffer, Gpu, Placement};
use harness::{gpu, worlds, Random};
use scenes::bvh::{NodeState, Split};
use shaders::types::{DrawCommand, TreeNode};
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

struct Stand {
    world: World,
    tree: Tree,
    view: View,
    nodes: Vec<TreeNode>,
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

fn marked_on_gpu(gpu: &Gpu, stand: &Stand, occluders: &[u32]) -> Vec<u32> {
    let (occluders, marked) = (stored(gpu, occluders), zeros(gpu, stand.tree.len()));
    let mut f = gpu.frame();
    let stage = eovc::MarkPaths {
        occluders: occluders.all(),
        leaves: stand.tree.leaves(),
        nodes: stand.tree.nodes(),
        marked: marked.all(),
        object_count: stand.world.len() as u32,
    };
    f.dispatch(stage, stand.world.len() as u32);
    f.finish().unwrap();
    marked.read().unwrap()
}

#[test]
fn marked_paths_are_the_thesis_visible_nodes() {
    let gpu = gpu();
    let mut random = Random::new(73);
    let stand = &stands(&gpu)[0];
    for rarity in [0, 1, 2, 10, 100] {
        let occluders = flags(&mut random, stand.world.len(), rarity);
        let marked = marked_on_gpu(&gpu, stand, &occluders);
        assert_eq!(marked, eovc_twin::mark_paths(stand.tree.host(), &occluders));
        let chosen: Vec<bool> = occluders.iter().map(|flag| *flag != 0).collect();
        let states = scenes::bvh::extract_groups(stand.tree.host(), &chosen);
        let visible: Vec<u32> = states.iter().map(|state| u32::from(*state == NodeState::Visible)).collect();
        assert_eq!(marked, visible);
    }
}

#[test]
fn extracted_groups_equal_their_twin() {
    let gpu = gpu();
    let mut random = Random::new(74);
    for stand in stands(&gpu) {
        let occluders = flags(&mut random, stand.world.len(), 20);
        let marked = eovc_twin::mark_paths(stand.tree.host(), &occluders);
        let stamps =
            |random: &mut Random| (0..stand.nodes.len()).map(|_| 5 + random.below(2) as u32).collect::<Vec<_>>();
        let (tested, touched) = (stamps(&mut random), stamps(&mut random));
        for coherent in [false, true] {
            let empty = [DrawCommand::default()];
            let lists =
                [zeros(&gpu, stand.nodes.len()), zeros(&gpu, stand.nodes.len()), zeros(&gpu, stand.world.len())];
            let commands = [stored(&gpu, &empty), stored(&gpu, &empty)];
            let stamps = [stored(&gpu, &marked), stored(&gpu, &tested), stored(&gpu, &touched)];
            let mut f = gpu.frame();
            let stage = eovc::ExtractGroups {
                nodes: stand.tree.nodes(),
                marked: stamps[0].all(),
                groups: lists[0].all(),
                group_command: commands[0].all(),
                singles: lists[1].all(),
                single_command: commands[1].all(),
                hits: lists[2].all(),
                tested: stamps[1].all(),
                touched: stamps[2].all(),
                view: stand.view.cull(),
                node_count: stand.nodes.len() as u32,
                frame: 7,
                most_pixels: 16,
                constants: eovc::ExtractGroupsConstants { coherent },
            };
            f.dispatch(stage, stand.nodes.len() as u32);
            f.finish().unwrap();
            let known = eovc_twin::Coherence { tested: &tested, touched: &touched, frame: 7, most_pixels: 16 };
            let twin = eovc_twin::extract_groups(&stand.nodes, &marked, &stand.view.cull(), coherent.then_some(known));
            for (which, expected) in twin.iter().take(2).enumerate() {
                let count = commands[which].read().unwrap()[0].instance_count as usize;
                let mut found = lists[which].read().unwrap()[..count].to_vec();
                found.sort_unstable();
                assert_eq!(&found, expected, "list {which}, coherent {coherent}");
            }
            let hits = lists[2].read().unwrap();
            let hit: Vec<u32> = (0..hits.len() as u32).filter(|object| hits[*object as usize] != 0).collect();
            assert_eq!(hit, twin[2], "coherent {coherent}");
        }
    }
}

#[test]
fn touched_paths_and_occludees_equal_their_twins() {
    let gpu = gpu();
    let mut random = Random::new(75);
    let stand = &stands(&gpu)[0];
    let mut touched: Vec<u32> = flags(&mut random, stand.nodes.len(), 50).iter().map(|flag| 8 + flag).collect();
    let (touched_gpu, hits, drawn) =
        (stored(&gpu, &touched), flags(&mut random, stand.world.len(), 3), flags(&mut random, stand.world.len(), 3));
    let (hits_gpu, drawn_gpu, newly) = (stored(&gpu, &hits), stored(&gpu, &drawn), zeros(&gpu, stand.world.len()));
    let (node_count, object_count) = (stand.nodes.len() as u32, stand.world.len() as u32);
    let mut f = gpu.frame();
    let (nodes, marks) = (stand.tree.nodes(), touched_gpu.all());
    f.dispatch(eovc::TouchPaths { nodes, touched: marks, node_count, frame: 9 }, node_count);
    let (hits_all, drawn_all) = (hits_gpu.all(), drawn_gpu.all());
    f.dispatch(
        eovc::SelectOccludees { hits: hits_all, drawn: drawn_all, newly: newly.all(), object_count },
        object_count,
    );
    f.finish().unwrap();
    eovc_twin::touch_paths(&stand.nodes, &mut touched, 9);
    assert_eq!(touched_gpu.read().unwrap(), touched);
    assert_eq!(newly.read().unwrap(), eovc_twin::select_occludees(&hits, &drawn));
}
