//! `world/move_objects`: what moves is where the host says, and nothing else is touched.

use culling::world::twin;
use culling::World;
use engine::{Buffer, Placement};
use harness::{gpu, Random};
use shaders::types::{Bounds, JointPlace, MovedObject, MovedTransform, Object, RestVertex};

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

/// Vertices and joints of which all kinds of number are among: large and small ones, and weights that are 0.
fn any_skin(random: &mut Random, vertices: usize, joints: usize) -> (Vec<RestVertex>, Vec<JointPlace>) {
    let three = |random: &mut Random| (random.vector() * 10f64.powi(random.below(9) as i32 - 4)).as_vec3().to_array();
    let vertex = |random: &mut Random| RestVertex {
        position: three(random),
        normal: unit(random),
        joints: std::array::from_fn(|_| random.below(joints) as u32),
        weights: scenes::weights_of_sum_one(std::array::from_fn(|_| {
            random.below(4) as f32 * random.vector().x.abs() as f32
        })),
    };
    let rest = (0..vertices).map(|_| vertex(random)).collect();
    let place = |random: &mut Random| JointPlace {
        column_x: three(random),
        column_y: three(random),
        column_z: three(random),
        shift: three(random),
    };
    (rest, (0..joints).map(|_| place(random)).collect())
}

fn unfolded([x, y]: [i16; 2]) -> glam::Vec3 {
    let [x, y] = [x, y].map(|part| f32::from(part) / 32767.0);
    let (z, fold) = (1.0 - x.abs() - y.abs(), (x.abs() + y.abs() - 1.0).max(0.0));
    glam::Vec3::new(x - fold.copysign(x), y - fold.copysign(y), z).normalize_or(glam::Vec3::Z)
}

/// Positions to the bit, normals within the steps of their encoding; no other vertex and no other part of a vertex is touched.
#[test]
fn skinning_equals_its_twin() {
    let gpu = gpu();
    let mut random = Random::new(63);
    for (vertex_count, joints, first_word, stride_words) in
        [(1, 1, 0, 4), (65, 3, 12, 4), (777, 40, 21, 7), (70_000, 9, 4, 7)]
    {
        let (rest, places) = any_skin(&mut random, vertex_count, joints);
        let before: Vec<u32> =
            (0..first_word + vertex_count * stride_words + 9).map(|_| random.bits() as u32).collect();
        let on_gpu = (
            Buffer::with_data(&gpu, "test.rest", &rest, Placement::Storage).unwrap(),
            Buffer::with_data(&gpu, "test.places", &places, Placement::Upload).unwrap(),
            Buffer::with_data(&gpu, "test.vertices", &before, Placement::Storage).unwrap(),
        );
        let mut f = gpu.frame();
        let stage = shaders::world::SkinVertices {
            rest: on_gpu.0.all(),
            places: on_gpu.1.all(),
            vertices: on_gpu.2.all(),
            vertex_count: vertex_count as u32,
            first_word: first_word as u32,
            stride_words: stride_words as u32,
        };
        f.dispatch(stage, vertex_count as u32);
        f.finish().unwrap();
        let mut expected = before;
        let found = on_gpu.2.read().unwrap();
        for (index, vertex) in twin::skin_vertices(&rest, &places).into_iter().enumerate() {
            let at = first_word + index * stride_words;
            expected[at..at + 3].copy_from_slice(&vertex.position.map(f32::to_bits));
            let [low, high] = [found[at + 3] & 0xffff, found[at + 3] >> 16].map(|half| half as u16 as i16);
            let (normal, wanted) = (unfolded([low, high]), unfolded(vertex.normal_snorm16));
            assert!(normal.distance(wanted) < 3e-4, "vertex {index} of {vertex_count}: {normal} is not {wanted}");
            expected[at + 3] = found[at + 3];
        }
        let wrong = found.iter().zip(&expected).filter(|(found, expected)| found != expected).count();
        assert_eq!(wrong, 0, "{vertex_count} vertices");
    }
}
