//! Worlds whose materials decide what hides: holes, glass, and walls that have only one side.

use super::{cube, shot, sized, square, turned, wander, wires, Case, Maker, PERSPECTIVE};
use crate::stress::Random;
use glam::{DVec3, Vec2};
use scenes::{Mesh, Projection, Scene, Surface, Texture, Wrap};

/// A texture of so many squares a side, each second one a hole.
fn holes(squares: u32) -> Texture {
    // Large texels, so that linear filtering leaves holes and solid parts.
    let size = 8 * squares;
    let texel = |at: u32| {
        let (x, y) = (at % size / 8, at / size / 8);
        [200, 60 + 40 * (x % 4) as u8, 90, if (x + y) % 2 == 0 { 255 } else { 0 }]
    };
    let texels = (0..size * size).map(texel).collect();
    Texture { name: "holes".into(), size: [size; 2], texels, wrap: [Wrap::Repeat, Wrap::Mirror] }
}

/// A mesh with its x and y as texture coordinates.
fn mapped(mesh: Mesh) -> Mesh {
    let texture_coordinates = mesh.positions.iter().map(|at| Vec2::new(at.x + 0.5 * at.z, at.y - 0.5 * at.z) + 0.5);
    Mesh { texture_coordinates: texture_coordinates.collect(), ..mesh }
}

/// The same with a colour at each vertex, some of them see-through.
fn tinted(mesh: Mesh) -> Mesh {
    let step = |vertex: usize| (vertex % 4) as f32;
    let colours = (0..mesh.positions.len()).map(|vertex| [1.0, 0.3 * step(vertex), 0.5, step(vertex) / 3.0]);
    Mesh { colours: colours.collect(), ..mesh }
}

/// Bodies before and behind a wall, made of meshes that take turns; `change` makes of each what the world is for.
fn bodies(maker: &mut Maker, meshes: &[u32], count: usize, change: impl Fn(&mut scenes::Object, usize)) {
    let mut random = Random::new(21);
    for body in 0..count {
        let depth = if body % 4 == 0 { random.range(0.4, 3.0) } else { random.range(-8.0, -0.4) };
        let at = DVec3::new(random.range(-6.0, 6.0), random.range(-4.0, 4.0), depth);
        let mut size = DVec3::splat(random.range(0.1, 1.2));
        size.x *= if body % 3 == 0 { -1.0 } else { 1.0 };
        let place = turned(&mut random, at, size);
        maker.place(meshes[body % meshes.len()], place);
        if let Some(object) = maker.scene.objects.last_mut() {
            change(object, body);
        }
    }
}

fn filmed(name: &str, scene: Scene) -> Case {
    Case::new(name, scene, wander(DVec3::new(0.4, 0.3, 7.0), DVec3::ZERO, PERSPECTIVE))
}

/// A wall with holes before bodies, some of which have holes too.
pub fn masked_wall() -> Case {
    let mut maker = Maker::new("masked wall");
    maker.scene.textures = vec![holes(6), holes(2)];
    let meshes =
        [maker.mesh(mapped(square())), maker.mesh(mapped(cube())), maker.mesh(tinted(cube())), maker.mesh(cube())];
    maker.place(meshes[0], sized(DVec3::ZERO, DVec3::new(9.0, 6.0, 1.0)));
    maker.scene.objects[0].masked = true;
    maker.scene.objects[0].surface.texture = Some(0);
    bodies(&mut maker, &meshes[1..], 120, |object, body| {
        object.masked = body % 2 == 0;
        object.surface.cutoff = [0.25, 0.5, 0.9][body % 3];
        object.surface.texture = (body % 5 != 0).then_some(1);
        // Without texture and colours it is there as a whole or not at all.
        object.colour[3] = if body % 7 == 0 { 0.4 } else { 1.0 };
        object.surface.single_sided = body % 4 == 1;
    });
    filmed("masked wall", maker.scene)
}

/// A wall of glass before bodies, some of them of glass, and a solid wall that hides some of those.
pub fn glass_wall() -> Case {
    let mut maker = Maker::new("glass wall");
    maker.scene.textures = vec![holes(3)];
    let meshes = [maker.mesh(mapped(square())), maker.mesh(mapped(cube())), maker.mesh(wires()), maker.mesh(cube())];
    maker.place(meshes[0], sized(DVec3::ZERO, DVec3::new(9.0, 6.0, 1.0)));
    maker.place(meshes[3], sized(DVec3::new(2.0, 0.0, -1.5), DVec3::new(4.0, 6.0, 0.3)));
    (maker.scene.objects[0].translucent, maker.scene.objects[0].colour[3]) = (true, 0.3);
    bodies(&mut maker, &meshes[1..], 120, |object, body| {
        object.translucent = body % 2 == 0;
        object.colour[3] = 0.5;
        object.surface.texture = (body % 3 == 0).then_some(0);
        object.surface.single_sided = body % 4 < 2;
    });
    filmed("glass wall", maker.scene)
}

/// The same without textures: other stages draw it.
pub fn plain_glass() -> Case {
    let mut case = glass_wall();
    case.scene.textures.clear();
    case.scene.objects.iter_mut().for_each(|object| object.surface.texture = None);
    Case { name: "plain glass".into(), ..case }
}

/// Walls that are seen from one side alone, with bodies behind each: one turns its back, one is mirrored, one is both.
pub fn back_faces() -> Case {
    let mut maker = Maker::new("back faces");
    let meshes = [maker.mesh(square()), maker.mesh(cube())];
    for (x, turned_away, mirrored) in [(-4.5, false, false), (-1.5, true, false), (1.5, false, true), (4.5, true, true)]
    {
        let sides = DVec3::new(if mirrored { -2.8 } else { 2.8 }, 6.0, 1.0);
        let mut place = sized(DVec3::new(x, 0.0, 0.0), sides);
        if turned_away {
            place.matrix3 = glam::DMat3::from_rotation_y(std::f64::consts::PI) * place.matrix3;
        }
        maker.place(meshes[0], place);
    }
    let one_sided = Surface { single_sided: true, ..Surface::default() };
    maker.scene.objects.iter_mut().for_each(|wall| wall.surface = one_sided);
    bodies(&mut maker, &meshes[1..], 120, |object, body| object.surface.single_sided = body % 3 > 0);
    filmed("back faces", maker.scene)
}

/// One wall, one body wholly behind it, and a camera that sees no further than the wall's borders: what the wall is made of decides
/// whether the body shows.
pub fn behind(wall: impl FnOnce(&mut Scene)) -> Case {
    let mut maker = Maker::new("behind");
    maker.scene.textures = vec![holes(4)];
    let meshes = [maker.mesh(mapped(square())), maker.mesh(cube())];
    maker.place(meshes[0], sized(DVec3::ZERO, DVec3::new(12.0, 12.0, 1.0)));
    maker.place(meshes[1], sized(DVec3::new(0.0, 0.0, -2.0), DVec3::splat(3.0)));
    wall(&mut maker.scene);
    let camera = Projection::Orthographic { half_height: 3.0, near: -1.0, far: 20.0 };
    let eye = shot(DVec3::Z * 5.0, DVec3::ZERO, camera);
    Case::new("behind", maker.scene, vec![eye; 3])
}
