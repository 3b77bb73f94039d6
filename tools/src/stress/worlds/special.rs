//! The catalogue of worlds that are hard in one way each.

use super::materials::{back_faces, glass_wall, masked_wall, plain_glass};
use super::{cube, dust, mesh, shot, sized, square, turned, walled, wander, wires, Case, Maker, PERSPECTIVE};
use crate::stress::Random;
use glam::{DMat4, DVec3, Vec3};
use scenes::{Mesh, Projection, Shot, Topology};

/// All of them.
pub fn special() -> Vec<Case> {
    vec![
        Case::new("nothing", Maker::new("nothing").scene, wander(DVec3::Z, DVec3::ZERO, PERSPECTIVE)),
        walled(150),
        topologies(),
        flat(),
        touching_boxes(),
        sunk(),
        ties(),
        reflected(),
        projected("parallel camera", Projection::Orthographic { half_height: 3.5, near: -2.0, far: 30.0 }),
        projected("oblique camera", oblique()),
        projected("no far plane", Projection::Perspective { fov_y: 1.3, near: 0.01, far: None }),
        inside_a_box(),
        stepping_into_boxes(),
        creeping(),
        bad_bounds(),
        far_from_the_origin(),
        near_and_far(),
        beyond_floats(),
        masked_wall(),
        glass_wall(),
        plain_glass(),
        back_faces(),
    ]
}

/// Lines and points between triangles, before and behind a wall.
pub fn topologies() -> Case {
    let mut maker = Maker::new("topologies");
    let mut random = Random::new(11);
    let kinds = [maker.mesh(cube()), maker.mesh(wires()), maker.mesh(dust(&mut random, 20))];
    maker.place(kinds[1], sized(DVec3::new(0.0, 0.0, 2.0), DVec3::splat(2.0)));
    maker.place(kinds[0], sized(DVec3::ZERO, DVec3::new(7.0, 5.0, 0.3)));
    for body in 0..200 {
        let depth = if body % 4 == 0 { random.range(0.5, 4.0) } else { random.range(-8.0, -0.4) };
        let at = DVec3::new(random.range(-6.0, 6.0), random.range(-4.0, 4.0), depth);
        let size = DVec3::splat(random.decade(0.01, 1.0));
        let place = turned(&mut random, at, size);
        maker.place(kinds[body % 3], place);
    }
    Case::new("topologies", maker.scene, wander(DVec3::new(0.3, 0.2, 6.0), DVec3::ZERO, PERSPECTIVE))
}

/// Squares, and cubes squeezed to nothing along an axis, some of them edge-on.
fn flat() -> Case {
    let mut maker = Maker::new("flat");
    let mut random = Random::new(12);
    let kinds = [maker.mesh(square()), maker.mesh(cube())];
    maker.place(kinds[0], sized(DVec3::ZERO, DVec3::new(6.0, 6.0, 1.0)));
    for body in 0..150 {
        let at = random.vector() * DVec3::new(6.0, 4.0, 5.0);
        let mut size = DVec3::splat(random.range(0.2, 2.0));
        size[body % 3] = 0.0;
        let place = if body % 2 == 0 { sized(at, size) } else { turned(&mut random, at, size) };
        maker.place(kinds[body / 2 % 2], place);
    }
    Case::new("flat", maker.scene, wander(DVec3::new(0.0, 0.0, 8.0), DVec3::ZERO, PERSPECTIVE))
}

/// Cubes exactly equal to their boxes, face to face, with gaps to look through.
fn touching_boxes() -> Case {
    let mut maker = Maker::new("touching boxes");
    let cube = maker.mesh(cube());
    for index in 0..300 {
        let (x, y, z) = (index % 10, index / 10 % 10, index / 100);
        if (x * 7 + y * 3 + z * 5) % 4 != 0 {
            let at = DVec3::new(f64::from(x) - 4.5, f64::from(y) - 4.5, f64::from(-z));
            maker.place(cube, sized(at, DVec3::ONE));
        }
    }
    Case::new("touching boxes", maker.scene, wander(DVec3::new(0.0, 0.0, 9.0), DVec3::ZERO, PERSPECTIVE))
}

/// Bodies half sunk into a wall: the near side of their boxes shows, the far side does not. Some keep only their skin out.
pub fn sunk() -> Case {
    let mut maker = Maker::new("sunk");
    let mut random = Random::new(17);
    let cube = maker.mesh(cube());
    maker.place(cube, sized(DVec3::ZERO, DVec3::new(9.0, 6.0, 4.0)));
    for body in 0..150 {
        let at = random.vector() * DVec3::new(4.0, 2.5, 2.0);
        let size = random.range(0.2, 0.9);
        // Half of its height, or a thousandth of it, is outside.
        let depth = if body % 3 == 0 { 2.0 - 0.499 * size } else { 2.0 };
        let side = if at.z > 0.0 { depth } else { -depth };
        maker.place(cube, sized(DVec3::new(at.x, at.y, side), DVec3::splat(size)));
    }
    Case::new("sunk", maker.scene, wander(DVec3::new(0.4, 0.3, 9.0), DVec3::ZERO, PERSPECTIVE))
}

/// The same thing at the same place several times, and squares that share a plane.
pub fn ties() -> Case {
    let mut maker = Maker::new("ties");
    let mut random = Random::new(13);
    let (cube, square) = (maker.mesh(cube()), maker.mesh(square()));
    for body in 0..60 {
        let at = random.vector() * DVec3::new(5.0, 3.0, 3.0);
        for _ in 0..=body % 3 {
            maker.place(cube, sized(at, DVec3::splat(0.8)));
        }
        let beside = random.vector() * DVec3::new(4.0, 3.0, 0.0) + DVec3::Z;
        maker.place(square, sized(beside, DVec3::splat(2.0)));
    }
    Case::new("ties", maker.scene, wander(DVec3::new(0.2, 0.1, 7.0), DVec3::ZERO, PERSPECTIVE))
}

/// Mirrored bodies, needles, and bodies shrunk to a line or a point.
fn reflected() -> Case {
    let mut maker = Maker::new("reflected");
    let mut random = Random::new(14);
    let cube = maker.mesh(cube());
    for body in 0..200 {
        let at = random.vector() * 5.0;
        let mut size = random.vector();
        if body % 7 == 0 {
            size[body / 7 % 3] = 0.0;
        }
        if body % 14 == 0 {
            size = DVec3::X * size.x;
        }
        if body % 28 == 0 {
            size = DVec3::ZERO;
        }
        if body % 9 == 0 {
            size *= DVec3::new(1e-4, 3.0, 1e-4);
        }
        let place = turned(&mut random, at, size);
        maker.place(cube, place);
    }
    Case::new("reflected", maker.scene, wander(DVec3::new(0.0, 1.0, 9.0), DVec3::ZERO, PERSPECTIVE))
}

fn projected(name: &str, projection: Projection) -> Case {
    let case = walled(150);
    let shots = case.shots.iter().map(|shot| Shot { projection, ..*shot }).collect();
    Case { name: name.into(), ..case.filmed(shots) }
}

/// Off-centre, and with planes of equal depth that lean: near and far plane are oblique.
pub fn oblique() -> Projection {
    let mut clip = PERSPECTIVE.clip_from_view(1.6);
    clip.z_axis.x += 0.3;
    clip.z_axis.y -= 0.2;
    let lean = DMat4::from_cols_array_2d(&[
        [1.0, 0.0, 0.004, 0.0],
        [0.0, 1.0, -0.003, 0.0],
        [0.0, 0.0, 0.98, 0.0],
        [0.0, 0.0, 0.008, 1.0],
    ]);
    Projection::Custom(lean * clip)
}

/// Two slabs at the ends of a box that is empty between them.
fn slabs() -> Mesh {
    let cube_mesh = cube();
    let slab = |x: f32| cube_mesh.positions.iter().map(move |p| *p * Vec3::new(0.1, 1.0, 1.0) + Vec3::new(x, 0.0, 0.0));
    let positions: Vec<Vec3> = slab(-0.45).chain(slab(0.45)).collect();
    let indices = cube_mesh.indices.iter().chain(&cube_mesh.indices).enumerate();
    let indices = indices.map(|(place, index)| index + if place < cube_mesh.indices.len() { 0 } else { 8 }).collect();
    mesh("slabs", Topology::Triangles, positions, indices)
}

/// The eye stands in the box of an object that has nothing there, and in a room.
fn inside_a_box() -> Case {
    let mut maker = Maker::new("inside a box");
    let mut random = Random::new(15);
    let slabs = maker.mesh(slabs());
    let cube = maker.mesh(cube());
    maker.place(slabs, sized(DVec3::ZERO, DVec3::new(6.0, 4.0, 8.0)));
    maker.place(cube, sized(DVec3::ZERO, DVec3::splat(14.0)));
    for _ in 0..150 {
        let at = random.vector() * 9.0;
        let size = DVec3::splat(random.range(0.1, 1.0));
        let place = turned(&mut random, at, size);
        maker.place(cube, place);
    }
    Case::new("inside a box", maker.scene, wander(DVec3::new(0.0, 0.0, 1.5), DVec3::ZERO, PERSPECTIVE))
}

/// The eye jumps from box to box, each time into one that it did not see into before: the faces that it might see of the box
/// lie behind and above it.
pub fn stepping_into_boxes() -> Case {
    let mut maker = Maker::new("stepping into boxes");
    let (slabs, cube) = (maker.mesh(slabs()), maker.mesh(cube()));
    let at = |step: i32| DVec3::new(f64::from(step % 3) * 4.0, 0.0, f64::from(step / 3) * 9.0);
    for step in 0..9 {
        maker.place(slabs, sized(at(step), DVec3::new(3.0, 8.0, 8.0)));
        maker.place(cube, sized(at(step) + DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.2, 8.0, 8.0)));
    }
    let look = |step: i32| {
        let eye = at(step) + DVec3::splat(0.2);
        shot(eye, eye - DVec3::X, PERSPECTIVE)
    };
    Case::new("stepping into boxes", maker.scene, [4, 0, 8, 2, 6, 1, 7].map(look).to_vec())
}

/// Along a wall in steps of centimetres: bodies come out from behind it by a pixel or two at a time.
pub fn creeping() -> Case {
    let case = walled(400);
    let shots = (0..12).map(|step| {
        let eye = DVec3::new(-2.0 + 0.03 * f64::from(step), 0.4, 7.0);
        shot(eye, eye - DVec3::Z, PERSPECTIVE)
    });
    Case { name: "creeping".into(), ..case.filmed(shots.collect()) }
}

/// Half of the declared boxes hold the eye, others are inverted, empty, NaN, infinite or too small; nobody has repaired them.
pub fn bad_bounds() -> Case {
    let entry = scenes::procedural::SCENES.iter().find(|entry| entry.name == "bad-bounds").unwrap();
    let scene = (entry.make)(&scenes::SceneOptions { scale: 0.15, seed: 3, ..Default::default() });
    assert!(scene.bounds_faults().len() > 10 && scene.meshes.iter().any(|mesh| mesh.honoured_bounds().is_some()));
    let eye = scene.cameras[0].pose.position;
    Case::new("bad bounds", scene, wander(eye, eye - 12.0 * DVec3::Z, PERSPECTIVE))
}

fn far_from_the_origin() -> Case {
    let away = DVec3::new(1.0e6, 2.0e5, -1.0e6) + DVec3::new(0.123, 0.456, 0.789);
    let mut case = walled(150);
    for object in &mut case.scene.objects {
        object.world_from_object.translation += away;
    }
    for shot in &mut case.shots {
        shot.pose.position += away;
    }
    Case { name: "far from the origin".into(), ..case }
}

/// An object that reaches farther than f32 can be trusted with, among others: every box around it does too.
fn beyond_floats() -> Case {
    let mut case = walled(100);
    let mut huge = case.scene.objects[1].clone();
    huge.world_from_object = sized(DVec3::new(1.0, 0.0, 0.0), DVec3::splat(2.0e38));
    case.scene.objects.push(huge);
    Case { name: "beyond floats".into(), ..case }
}

/// Things from a hundredth of a metre to a thousand kilometres away, near plane at 1 mm, far plane at 10^7 m.
fn near_and_far() -> Case {
    let mut maker = Maker::new("near and far");
    let mut random = Random::new(16);
    let cube = maker.mesh(cube());
    for _ in 0..300 {
        let distance = random.decade(0.01, 1e6);
        let direction = (random.vector() * DVec3::new(0.7, 0.5, 0.2) - DVec3::Z).normalize();
        let size = DVec3::splat(distance * random.range(0.02, 0.4));
        let place = turned(&mut random, direction * distance, size);
        maker.place(cube, place);
    }
    let projection = Projection::Perspective { fov_y: 1.0, near: 1e-3, far: Some(1e7) };
    let stops = [0.0, 0.0, 0.002, 0.1, 5.0, 3e3, 0.0];
    let shots = stops.map(|back| shot(DVec3::Z * back, DVec3::NEG_Z * 10.0, projection));
    Case::new("near and far", maker.scene, shots.to_vec())
}

/// A camera of each kind, by name.
pub fn special_projections() -> Vec<(&'static str, Projection)> {
    vec![
        ("perspective", PERSPECTIVE),
        ("no far plane", Projection::Perspective { fov_y: 1.3, near: 0.01, far: None }),
        ("near and far", Projection::Perspective { fov_y: 0.8, near: 1e-3, far: Some(1e7) }),
        ("parallel", Projection::Orthographic { half_height: 5.0, near: -3.0, far: 40.0 }),
        ("oblique", oblique()),
    ]
}
