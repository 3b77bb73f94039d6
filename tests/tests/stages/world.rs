//! `world/move_objects`: what moves is where the host says, and nothing else is touched.

use culling::world::twin;
use culling::World;
use engine::{Buffer, Placement};
use harness::{gpu, Random};
use shaders::types::{Bounds, MovedObject, MovedTransform, Object};

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
