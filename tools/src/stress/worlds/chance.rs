//! Worlds and cameras by chance: what nobody thought of.

use super::{cube, dust, oblique, sized, square, turned, wires, Case, Maker};
use crate::stress::Random;
use glam::{DAffine3, DMat3, DQuat, DVec3};
use scenes::{Pose, Projection, Shot};

/// Sizes of pictures: tiny, thin, odd, and powers of two.
const SIZES: [[u32; 2]; 9] = [[1, 1], [2, 3], [1, 65], [129, 1], [31, 17], [64, 64], [97, 33], [33, 95], [128, 72]];

/// A world by seed: 1 to 300 bodies of up to three kinds, often behind walls, at some scale, sometimes far from the origin, and
/// a camera that stands, creeps, turns, comes near and jumps, outside of boxes and inside.
pub fn chance(seed: u64) -> Case {
    let mut random = Random::new(seed);
    let scale = if random.below(3) == 0 { random.decade(1e-3, 1e4) } else { 1.0 };
    let mut maker = Maker::new("chance");
    let meshes = [maker.mesh(cube()), maker.mesh(square()), maker.mesh(wires())];
    let meshes = [meshes[0], meshes[1], meshes[2], maker.mesh(dust(&mut Random::new(seed), 5))];
    walls(&mut maker, &mut random, meshes[0]);
    let bodies = random.decade(1.0, 300.0) as usize;
    let kinds = [(); 3].map(|()| random.below(KINDS.len()));
    for body in 0..bodies {
        KINDS[kinds[body % 3]](&mut maker, &mut random, &meshes, body);
    }
    let mut shots = film(&mut random, scale);
    let away = match random.below(4) {
        0 => random.vector() * 1e6_f64.min(1e7 * scale),
        1 => random.vector() * 1e3 * scale,
        _ => DVec3::ZERO,
    };
    for object in &mut maker.scene.objects {
        let place = &mut object.world_from_object;
        *place = DAffine3 { matrix3: place.matrix3 * scale, translation: place.translation * scale + away };
    }
    shots.iter_mut().for_each(|shot| shot.pose.position = shot.pose.position * scale + away);
    Case { size: SIZES[random.below(SIZES.len())], ..Case::new(&format!("chance {seed}"), maker.scene, shots) }
}

type Kind = fn(&mut Maker, &mut Random, &[u32; 4], usize);

const KINDS: [Kind; 7] = [bodies, grid, needles, flats, specks, shells, bricks];

fn walls(maker: &mut Maker, random: &mut Random, cube: u32) {
    for _ in 0..random.below(3) {
        let at = DVec3::new(random.range(-3.0, 3.0), random.range(-2.0, 2.0), random.range(-1.0, 1.0));
        let size = DVec3::new(random.range(2.0, 10.0), random.range(2.0, 8.0), random.decade(1e-3, 1.0));
        let place = if random.below(2) == 0 { sized(at, size) } else { turned(random, at, size) };
        maker.place(cube, place);
    }
}

fn somewhere(random: &mut Random) -> DVec3 {
    random.vector() * DVec3::new(7.0, 4.0, 8.0)
}

fn bodies(maker: &mut Maker, random: &mut Random, [cube, ..]: &[u32; 4], _: usize) {
    let (at, size) = (somewhere(random), DVec3::splat(random.decade(0.05, 2.0)));
    let place = turned(random, at, size);
    maker.place(*cube, place);
}

/// Unit cubes on a grid, face to face.
fn grid(maker: &mut Maker, random: &mut Random, [cube, ..]: &[u32; 4], _: usize) {
    maker.place(*cube, sized(somewhere(random).round(), DVec3::ONE));
}

/// Long and thinner than a pixel, along an axis or not.
fn needles(maker: &mut Maker, random: &mut Random, [cube, ..]: &[u32; 4], body: usize) {
    let (at, mut size) = (somewhere(random), DVec3::splat(random.decade(1e-5, 1e-2)));
    size[body % 3] = random.range(0.5, 6.0);
    let place = if random.below(2) == 0 { sized(at, size) } else { turned(random, at, size) };
    maker.place(*cube, place);
}

/// Of no height at all.
fn flats(maker: &mut Maker, random: &mut Random, [cube, square, ..]: &[u32; 4], body: usize) {
    let (at, mut size) = (somewhere(random), DVec3::splat(random.decade(0.1, 3.0)));
    size[random.below(3)] = 0.0;
    let place = if random.below(2) == 0 { sized(at, size) } else { turned(random, at, size) };
    maker.place(if body.is_multiple_of(2) { *cube } else { *square }, place);
}

/// Lines and points.
fn specks(maker: &mut Maker, random: &mut Random, [_, _, wires, dust]: &[u32; 4], body: usize) {
    let (at, size) = (somewhere(random), DVec3::splat(random.decade(1e-3, 1.0)));
    let place = turned(random, at, size);
    maker.place(if body.is_multiple_of(2) { *wires } else { *dust }, place);
}

/// Wires as large as the world: their boxes hold the eye.
fn shells(maker: &mut Maker, random: &mut Random, [_, _, wires, _]: &[u32; 4], body: usize) {
    if body.is_multiple_of(10) {
        let (at, size) = (0.3 * somewhere(random), DVec3::splat(random.range(5.0, 20.0)));
        let place = turned(random, at, size);
        maker.place(*wires, place);
    }
}

/// Boxes that share planes with walls and with each other, pressed through each other by a hair.
fn bricks(maker: &mut Maker, random: &mut Random, [cube, ..]: &[u32; 4], _: usize) {
    let step = 0.5;
    let at = (somewhere(random) / step).round() * step + DVec3::splat(random.decade(1e-8, 1e-3));
    maker.place(*cube, sized(at, DVec3::splat(step) * DVec3::new(1.0, 2.0, 3.0)));
}

fn projection(random: &mut Random, scale: f64) -> Projection {
    match random.below(6) {
        0 => Projection::Orthographic {
            half_height: scale * random.range(0.5, 8.0),
            near: -3.0 * scale,
            far: 40.0 * scale,
        },
        1 => Projection::Perspective { fov_y: random.range(0.1, 2.5), near: 0.01 * scale, far: None },
        2 if scale == 1.0 => oblique(),
        3 => Projection::Perspective { fov_y: 1.0, near: 1e-3 * scale, far: Some(1e5 * scale) },
        _ => Projection::Perspective { fov_y: random.range(0.4, 1.6), near: 0.1 * scale, far: Some(200.0 * scale) },
    }
}

/// Nine frames. Positions are those of the unscaled world, planes those of the scaled one.
fn film(random: &mut Random, scale: f64) -> Vec<Shot> {
    let projection = projection(random, scale);
    let axis_aligned = random.below(3) == 0;
    let eye =
        if axis_aligned { somewhere(random).round() + DVec3::Z * 8.0 } else { somewhere(random) + DVec3::Z * 4.0 };
    let target = if axis_aligned { eye - DVec3::Z } else { 0.3 * somewhere(random) };
    let mut shot = Shot { pose: Pose::looking_at(eye, target), projection, seconds: 0.0 };
    let mut shots = vec![shot; 2];
    for _ in 0..7 {
        let pose = &mut shot.pose;
        match random.below(6) {
            0 => (),
            1 => pose.position += random.vector() * 0.05,
            2 => pose.position += pose.rotation * DVec3::new(random.range(-0.5, 0.5), 0.0, random.range(-1.0, 0.2)),
            3 => pose.rotation *= DQuat::from_rotation_y(random.range(-0.3, 0.3)),
            4 => pose.rotation = DQuat::from_mat3(&DMat3::IDENTITY),
            _ => *pose = Pose::looking_at(somewhere(random), 0.5 * somewhere(random)),
        }
        shots.push(shot);
    }
    shots
}
