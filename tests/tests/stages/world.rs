//! `world/move_objects`: what moves is where the host says, and nothing else is touched.

use culling::world::twin::{self, Deformers};
use culling::World;
use engine::{Buffer, Placement};
use harness::{gpu, Random};
use shaders::types::{
    Bounds, Displacement, DrawCommand, Influence, JointPlace, MeshRange, MovedObject, MovedTransform, Object,
    RestVertex, TurnedObject,
};

fn any_object(random: &mut Random) -> Object {
    let three = |random: &mut Random| random.vector().as_vec3().to_array();
    Object {
        column_x: three(random),
        column_y: three(random),
        column_z: three(random),
        origin_high: three(random),
        origin_low: three(random),
        colour: random.bits() as u32,
    }
}

fn any_bounds(random: &mut Random) -> Bounds {
    let three = |random: &mut Random| random.vector().as_vec3().to_array();
    Bounds {
        centre_high: three(random),
        centre_low: three(random),
        half_extent: three(random),
        flags: random.below(8) as u32,
    }
}

#[test]
fn moving_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(61);
    for (count, move_count) in [(1, 1), (65, 64), (1000, 1), (5000, 777)] {
        let mut objects: Vec<Object> = (0..count).map(|_| any_object(&mut random)).collect();
        let mut bounds: Vec<Bounds> = (0..count).map(|_| any_bounds(&mut random)).collect();
        let mut places: Vec<u32> = (0..count as u32).collect();
        random.shuffle(&mut places);
        let moved = |random: &mut Random, index: u32| MovedObject {
            index,
            object: any_object(random),
            bounds: any_bounds(random),
        };
        let moves: Vec<MovedObject> = places[..move_count].iter().map(|index| moved(&mut random, *index)).collect();
        let on_gpu = (
            Buffer::with_data(&gpu, "test.objects", &objects, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.bounds", &bounds, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.moves", &moves, Placement::Upload).unwrap(),
        );
        let mut f = gpu.frame();
        let stage = shaders::world::MoveObjects {
            moves: on_gpu.2.all(),
            objects: on_gpu.0.all(),
            bounds: on_gpu.1.all(),
            move_count: move_count as u32,
        };
        f.dispatch(stage, move_count as u32);
        f.finish().unwrap();
        twin::move_objects(&moves, &mut objects, &mut bounds);
        assert_eq!((on_gpu.0.read().unwrap(), on_gpu.1.read().unwrap()), (objects, bounds), "{count} objects");
    }
}

#[test]
fn turning_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(63);
    for (count, turned_count) in [(1, 1), (65, 64), (5000, 777)] {
        let mut word = || random.bits() as u32;
        let range = |first_index| MeshRange { first_index, index_count: 3, vertex_offset: -1 };
        let meshes: Vec<MeshRange> = (0..9).map(|_| range(word())).collect();
        let command =
            |first_index| DrawCommand { index_count: 6, instance_count: 1, first_index, ..DrawCommand::default() };
        let mut commands: Vec<DrawCommand> = (0..count).map(|_| command(word())).collect();
        let mut object_meshes: Vec<u32> = (0..count).map(|_| word() % 9).collect();
        let mut places: Vec<u32> = (0..count as u32).collect();
        let mut random = Random::new(64);
        random.shuffle(&mut places);
        let turned = |object: &u32| TurnedObject { object: *object, mesh: random.below(9) as u32 };
        let turned: Vec<TurnedObject> = places[..turned_count].iter().map(turned).collect();
        let on_gpu = (
            Buffer::with_data(&gpu, "test.turned", &turned, Placement::Upload).unwrap(),
            Buffer::with_data(&gpu, "test.meshes", &meshes, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.object_meshes", &object_meshes, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.commands", &commands, Placement::Storage).unwrap(),
        );
        let mut f = gpu.frame();
        let stage = shaders::world::TurnObjects {
            turned: on_gpu.0.all(),
            meshes: on_gpu.1.all(),
            object_meshes: on_gpu.2.all(),
            all_commands: on_gpu.3.all(),
            object_count: turned_count as u32,
        };
        f.dispatch(stage, turned_count as u32);
        f.finish().unwrap();
        twin::turn_objects(&turned, &meshes, &mut object_meshes, &mut commands);
        assert_eq!((on_gpu.2.read().unwrap(), on_gpu.3.read().unwrap()), (object_meshes, commands), "{count} objects");
    }
}

#[test]
fn moving_transforms_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(62);
    for (count, move_count) in [(1, 1), (65, 64), (5000, 777)] {
        let mut objects: Vec<Object> = (0..count).map(|_| any_object(&mut random)).collect();
        let mut places: Vec<u32> = (0..count as u32).collect();
        random.shuffle(&mut places);
        let moved = |index: &u32| MovedTransform { index: *index, object: any_object(&mut random) };
        let moves: Vec<MovedTransform> = places[..move_count].iter().map(moved).collect();
        let on_gpu = (
            Buffer::with_data(&gpu, "test.objects", &objects, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.moves", &moves, Placement::Upload).unwrap(),
        );
        let mut f = gpu.frame();
        let stage = shaders::world::MoveTransforms {
            moves: on_gpu.1.all(),
            objects: on_gpu.0.all(),
            move_count: move_count as u32,
        };
        f.dispatch(stage, move_count as u32);
        f.finish().unwrap();
        twin::move_transforms(&moves, &mut objects);
        assert_eq!(on_gpu.0.read().unwrap(), objects, "{count} objects");
    }
}

#[test]
fn a_moved_world_has_the_bounds_of_one_made_there() {
    let gpu = gpu();
    let scene =
        scenes::open("moving-boxes", &scenes::SceneOptions { scale: 0.3, seed: 2, ..Default::default() }).unwrap();
    let mut world = World::new(&gpu, &scene).unwrap();
    for seconds in [0.0, 3.7, 1e4] {
        let mut there = scene.clone();
        let mut moved = Vec::new();
        scene.motion.transforms_at(seconds, &mut moved);
        assert!(!moved.is_empty(), "the scene does not move");
        moved.iter().for_each(|(object, transform)| there.objects[*object as usize].world_from_object = *transform);
        world.set_time(&scene, seconds).unwrap();
        let mut f = gpu.frame();
        world.update(&mut f);
        f.finish().unwrap();
        let made_there = World::new(&gpu, &there).unwrap();
        assert_eq!(world.read_bounds().unwrap(), made_there.read_bounds().unwrap(), "at {seconds} s");
    }
}

#[test]
fn a_world_that_does_not_move_skips_moving() {
    let gpu = gpu();
    let mut f = gpu.frame();
    World::new(&gpu, &harness::worlds::walled(3).scene).unwrap().update(&mut f);
    let report = f.finish().unwrap();
    assert_eq!(report.skips[0].label, "world/move_objects");
    assert_eq!(report.submissions, 0);
}

fn unit(random: &mut Random) -> [f32; 3] {
    random.vector().as_vec3().try_normalize().unwrap_or(glam::Vec3::Y).to_array()
}

/// Makes random vertices at rest: rigid ones, some on up to eight joints, some that up to a dozen targets displace, and some with both.
fn any_deformers(random: &mut Random, vertices: usize, joints: usize) -> Deformers {
    let three = |random: &mut Random| (random.vector() * 10f64.powi(random.below(9) as i32 - 4)).as_vec3().to_array();
    let place = |random: &mut Random| JointPlace {
        column_x: three(random),
        column_y: three(random),
        column_z: three(random),
        shift: three(random),
    };
    let mut all = Deformers {
        places: (0..joints).map(|_| place(random)).collect(),
        weights: (0..20).map(|_| random.range(-2.0, 2.0) as f32).collect(),
        ..Deformers::default()
    };
    for _ in 0..vertices {
        let (first_influence, first_displacement) = (all.influences.len() as u32, all.displacements.len() as u32);
        let (influence_count, displacement_count) = (random.below(9), random.below(2) * random.below(13));
        let shares = std::array::from_fn(|at| if at < influence_count { random.range(0.01, 1.0) as f32 } else { 0.0 });
        let shares = scenes::weights_of_sum_one(shares);
        for share in shares.into_iter().take(influence_count) {
            all.influences.push(Influence { place: random.below(joints) as u32, share });
        }
        for _ in 0..displacement_count {
            let (weight, position, normal) = (random.below(20) as u32, three(random), unit(random));
            all.displacements.push(Displacement { weight, position, normal });
        }
        all.rest.push(RestVertex {
            position: three(random),
            normal: unit(random),
            first_influence,
            influence_count: influence_count as u32,
            first_displacement,
            displacement_count: displacement_count as u32,
        });
    }
    all
}

/// Runs the stage on a buffer with other contents, and returns the buffer.
fn deformed_words(
    gpu: &engine::Gpu,
    by: &Deformers,
    before: &[u32],
    [first_word, stride_words]: [usize; 2],
) -> Vec<u32> {
    let storage = Placement::Storage;
    let (rest, influences) = (
        Buffer::with_data(gpu, "test.rest", &by.rest, storage).unwrap(),
        Buffer::with_data(gpu, "test.influences", &by.influences, storage).unwrap(),
    );
    let (displacements, places, weights, vertices) = (
        Buffer::with_data(gpu, "test.displacements", &by.displacements, storage).unwrap(),
        Buffer::with_data(gpu, "test.places", &by.places, Placement::Upload).unwrap(),
        Buffer::with_data(gpu, "test.weights", &by.weights, Placement::Upload).unwrap(),
        Buffer::with_data(gpu, "test.vertices", before, storage).unwrap(),
    );
    let mut f = gpu.frame();
    let stage = shaders::world::SkinVertices {
        rest: rest.all(),
        influences: influences.all(),
        displacements: displacements.all(),
        places: places.all(),
        weights: weights.all(),
        vertices: vertices.all(),
        vertex_count: by.rest.len() as u32,
        first_word: first_word as u32,
        stride_words: stride_words as u32,
    };
    f.dispatch(stage, by.rest.len() as u32);
    f.finish().unwrap();
    vertices.read().unwrap()
}

fn unfolded([x, y]: [i16; 2]) -> glam::Vec3 {
    let [x, y] = [x, y].map(|part| f32::from(part) / 32767.0);
    let (z, fold) = (1.0 - x.abs() - y.abs(), (x.abs() + y.abs() - 1.0).max(0.0));
    glam::Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize_or(glam::Vec3::Z)
}

/// Counts the vertices in which the stage differs from the twin: positions to the bit, normals within the steps of their encoding.
/// Asserts that no other vertex and no other part of a vertex is touched.
fn wrong_vertices(found: &[u32], before: &[u32], twin: &Deformers, [first_word, stride_words]: [usize; 2]) -> usize {
    let (mut expected, mut wrong) = (before.to_vec(), 0);
    for (index, vertex) in twin.skin_vertices().into_iter().enumerate() {
        let at = first_word + index * stride_words;
        let [low, high] = [found[at + 3] & 0xffff, found[at + 3] >> 16].map(|half| half as u16 as i16);
        let (normal, wanted) = (unfolded([low, high]), unfolded(vertex.normal_snorm16));
        let right = found[at..at + 3] == vertex.position.map(f32::to_bits) && normal.distance(wanted) < 3e-4;
        wrong += usize::from(!right);
        expected[at..at + 4].copy_from_slice(&found[at..at + 4]);
    }
    assert!(found == expected, "words beside the vertices have changed");
    wrong
}

#[test]
fn deforming_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(63);
    for (vertex_count, joints, words) in [(1, 1, [0, 4]), (65, 3, [12, 4]), (777, 40, [21, 7]), (70_000, 9, [4, 7])] {
        let by = any_deformers(&mut random, vertex_count, joints);
        let before: Vec<u32> = (0..words[0] + vertex_count * words[1] + 9).map(|_| random.bits() as u32).collect();
        let found = deformed_words(&gpu, &by, &before, words);
        assert_eq!(wrong_vertices(&found, &before, &by, words), 0, "{vertex_count} vertices");
    }
}

/// The comparison can fail: a target that is left out, weights of another frame, a normal that is not displaced, a joint that is left out.
#[test]
fn other_deformations_are_noticed() {
    let gpu = gpu();
    let mut random = Random::new(64);
    let by = any_deformers(&mut random, 500, 9);
    let before: Vec<u32> = (0..4 * 500).map(|_| random.bits() as u32).collect();
    let found = deformed_words(&gpu, &by, &before, [0, 4]);
    let with = |change: &dyn Fn(&mut Deformers)| {
        let mut twin = by.clone();
        change(&mut twin);
        wrong_vertices(&found, &before, &twin, [0, 4])
    };
    let displaced = by.rest.iter().filter(|vertex| vertex.displacement_count > 0).count();
    let bent = by.rest.iter().filter(|vertex| vertex.influence_count > 1).count();
    assert_eq!(with(&|_| ()), 0);
    let last = |vertex: &mut RestVertex| vertex.displacement_count = vertex.displacement_count.saturating_sub(1);
    assert!(with(&|twin| twin.rest.iter_mut().for_each(last)) > displaced / 2, "a target that is left out");
    let older = |weight: &mut f32| *weight += 0.01;
    assert!(with(&|twin| twin.weights.iter_mut().for_each(older)) > displaced / 2, "weights of another frame");
    let still = |displacement: &mut Displacement| displacement.normal = [0.0; 3];
    assert!(with(&|twin| twin.displacements.iter_mut().for_each(still)) > displaced / 2, "normals stay as they are");
    let joint = |vertex: &mut RestVertex| vertex.influence_count -= u32::from(vertex.influence_count > 1);
    assert!(with(&|twin| twin.rest.iter_mut().for_each(joint)) > bent / 2, "a joint that is left out");
}
