//! Worlds with cells.

use glam::{DQuat, DVec3};
use harness::{worlds, Case, Random};
use scenes::animation::Orbit;
use scenes::{Aabb, Cell, Cells, Motion, Portal, Pose, Projection, SceneOptions, Shot};
use worlds::{sized, Maker};

/// Furnished rooms: from a room, its doorway, the corridor, a wall and beside it, outside, rolled and without perspective.
pub fn rooms() -> Case {
    let scene = scenes::open("rooms", &SceneOptions { scale: 0.15, ..Default::default() }).unwrap();
    let walk = scene.walk.clone().unwrap();
    let (room, corridor, far) = (walk.points[0], walk.points[1], walk.points[2]);
    let projection = scene.cameras[0].projection;
    let look = |eye: DVec3, target: DVec3| worlds::shot(eye, target, projection);
    let door = room + DVec3::Z * 2.5;
    let rolled = look(corridor, far);
    let parallel = Projection::Orthographic { half_height: 3.0, near: 0.05, far: 100.0 };
    let shots = vec![
        Shot { pose: scene.cameras[0].pose, projection, seconds: 0.0 },
        look(room, corridor),
        look(room, room - DVec3::Z + DVec3::X),
        look(door, corridor),
        look(door, room),
        look(door - DVec3::Z * 0.2, far),
        look(corridor, far),
        look(corridor, corridor + corridor - far + DVec3::Z * 3.0),
        Shot { pose: Pose { rotation: rolled.pose.rotation * DQuat::from_rotation_z(0.8), ..rolled.pose }, ..rolled },
        look(door + DVec3::X * 1.5, corridor),
        look(door + DVec3::new(1.5, 0.0, -0.1), corridor),
        look(door + DVec3::new(1.5, 0.0, -0.2), far),
        look(room, room + DVec3::new(0.1, 3.0, 0.0)),
        look(room + DVec3::new(0.0, 25.0, 40.0), room),
        look(room + DVec3::new(0.0, 1.12, 0.0), far),
        worlds::shot(room, corridor, parallel),
    ];
    Case::new("rooms", scene, shots)
}

/// A room with a window, things within and without, and things that move through it.
pub fn house() -> Case {
    let mut maker = Maker::new("house");
    let mut random = Random::new(17);
    let cube = maker.mesh(worlds::cube());
    // Wound so that it is seen from outside alone.
    let mut brick = worlds::cube();
    brick.indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    let brick = maker.mesh(brick);
    let mut slab = |min: [f64; 3], max: [f64; 3]| {
        let (min, max) = (DVec3::from(min), DVec3::from(max));
        maker.place(brick, sized(0.5 * (min + max), max - min));
        maker.scene.objects.last_mut().unwrap().surface.single_sided = true;
    };
    // Walls are 30 cm thick, and the cell's faces are their middles. The window, in the wall at larger z, is 1 m by 1 m.
    slab([-3.2, -0.15, -3.2], [3.2, 0.15, 3.2]);
    slab([-3.2, 2.85, -3.2], [3.2, 3.15, 3.2]);
    slab([-3.15, 0.0, -3.2], [-2.85, 3.0, 3.2]);
    slab([2.85, 0.0, -3.2], [3.15, 3.0, 3.2]);
    slab([-3.1, 0.0, -3.15], [3.1, 3.0, -2.85]);
    slab([-3.1, 0.0, 2.85], [-0.5, 3.0, 3.15]);
    slab([0.5, 0.0, 2.85], [3.1, 3.0, 3.15]);
    slab([-0.6, 0.0, 2.85], [0.6, 1.0, 3.15]);
    slab([-0.6, 2.0, 2.85], [0.6, 3.0, 3.15]);
    for body in 0..160 {
        let at = if body % 4 == 0 {
            DVec3::new(random.range(-2.5, 2.5), random.range(0.4, 2.6), random.range(-2.5, 2.4))
        } else {
            DVec3::new(random.range(-12.0, 12.0), random.range(-2.0, 6.0), random.range(3.6, 16.0))
        };
        let place = worlds::turned(&mut random, at, DVec3::splat(0.3));
        maker.place(cube, place);
    }
    let mut scene = maker.scene;
    let walls = 9;
    let orbits = (walls..scene.objects.len()).step_by(7).map(|object| Orbit {
        object: object as u32,
        base: scene.objects[object].world_from_object,
        centre: DVec3::new(0.0, 1.5, 3.0),
        axis: DVec3::new(0.1, 1.0, 0.2),
        radians_per_s: 0.9,
        bob: DVec3::ZERO,
        bob_period_s: 0.0,
    });
    let orbits: Vec<Orbit> = orbits.collect();
    orbits.iter().for_each(|orbit| scene.objects[orbit.object as usize].dynamic = true);
    scene.motion = Motion::Orbits(orbits);
    let bounds = Aabb { min: DVec3::new(-3.0, 0.0, -3.0), max: DVec3::new(3.0, 3.0, 3.0) };
    let corners = [(-0.5, 1.0), (0.5, 1.0), (0.5, 2.0), (-0.5, 2.0)].map(|(x, y)| DVec3::new(x, y, 3.0));
    scene.cells = Some(Cells {
        half_wall: 0.14,
        reach: 0.2,
        cells: vec![Cell { name: "room".into(), bounds }],
        portals: vec![Portal { cells: [Some(0), None], corners: corners.to_vec() }],
    });
    let near = Projection::Perspective { fov_y: 1.0, near: 0.02, far: Some(200.0) };
    let look = |eye: [f64; 3], target: [f64; 3]| worlds::shot(eye.into(), target.into(), near);
    let shots = vec![
        look([0.0, 1.5, -2.0], [0.0, 1.5, 3.0]),
        look([2.2, 1.5, 1.5], [0.0, 1.5, 3.0]),
        look([0.0, 1.5, 0.0], [0.0, 1.5, -3.0]),
        look([0.0, 1.5, 3.0], [0.0, 1.5, 9.0]),
        look([0.1, 1.4, 3.0], [0.0, 1.5, -3.0]),
        look([1.5, 1.5, 3.0], [0.0, 1.5, 9.0]),
        look([1.5, 1.5, 2.9], [1.5, 1.5, 9.0]),
        look([1.5, 1.5, 2.82], [1.4, 1.5, 9.0]),
        look([0.0, 1.5, 8.0], [0.0, 1.5, 0.0]),
        look([4.0, 3.5, 9.0], [0.0, 1.5, 3.0]),
        look([0.0, 1.5, -9.0], [0.0, 1.5, 0.0]),
        look([0.0, 20.0, 3.0], [0.0, 0.0, 3.1]),
    ];
    let shots = shots.into_iter().enumerate().map(|(frame, shot)| Shot { seconds: 0.7 * frame as f64, ..shot });
    Case::new("house", scene, shots.collect())
}
