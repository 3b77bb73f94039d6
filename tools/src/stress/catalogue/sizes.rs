//! Sizes and places that eat digits, and sizes of pictures.

use super::{crowd, filmed, through, Drill};
use crate::stress::worlds::{cube, shot, sized, turned, wander, Case, Maker, PERSPECTIVE};
use crate::stress::Random;
use glam::{DAffine3, DVec3};
use scenes::Projection;

/// The whole world at a millionth, a thousandth, a thousand times and a thousand million times its size.
pub fn scaled(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let mut case = filmed(random, maker);
    let scale = [1e-6, 1e9, 1e-3, 1e3, random.decade(1e-6, 1e9)][random.below(5)];
    for object in &mut case.scene.objects {
        let place = &mut object.world_from_object;
        *place = DAffine3 { matrix3: place.matrix3 * scale, translation: place.translation * scale };
    }
    case.shots.iter_mut().for_each(|shot| shot.pose.position *= scale);
    through(case, &[Projection::Perspective { fov_y: 1.0, near: 0.1 * scale, far: Some(200.0 * scale) }]).into()
}

/// Bodies from a thousandth of a millimetre to a million kilometres, side by side.
pub fn tiny_and_huge(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("tiny and huge");
    let cube = maker.mesh(cube());
    for _ in 0..bodies {
        let size = random.decade(1e-6, 1e9);
        let direction = (random.vector() * DVec3::new(1.0, 0.8, 0.3) - DVec3::Z).normalize();
        let at = direction * size * random.range(1.5, 40.0);
        let place = turned(random, at, DVec3::splat(size));
        maker.place(cube, place);
    }
    let projection = Projection::Perspective { fov_y: 1.1, near: 1e-6, far: None };
    let stops = [0.0, 0.0, 1e-6, 1e-2, 50.0, 1e6, 0.0];
    let shots = stops.map(|back| shot(DVec3::Z * back, DVec3::NEG_Z * (1.0 + back), projection));
    Case::new("", maker.scene, shots.to_vec()).into()
}

/// A world of metres, up to a million kilometres from the origin.
pub fn far_away(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let mut case = filmed(random, maker);
    let distance = [1e9, 1e6, random.decade(1e4, 1e9)][random.below(3)];
    let away = random.vector().normalize_or(DVec3::X) * distance;
    case.scene.objects.iter_mut().for_each(|object| object.world_from_object.translation += away);
    case.shots.iter_mut().for_each(|shot| shot.pose.position += away);
    case.into()
}

/// Bodies of sizes and at places that f32 holds as denormal numbers, or not at all.
pub fn denormal(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    for body in 0..bodies / 2 {
        let tiny = random.decade(1e-45, 1e-36);
        let at = random.vector() * DVec3::new(3.0, 2.0, 4.0);
        let size = match body % 4 {
            0 => DVec3::splat(tiny),
            1 => DVec3::new(1.0, tiny, 1.0),
            2 => DVec3::new(1.0, 0.5, tiny),
            _ => DVec3::splat(0.5),
        };
        let at = if body % 4 == 3 { at + DVec3::splat(tiny) } else { at };
        maker.place(0, sized(at, size));
    }
    filmed(random, maker).into()
}

/// Bodies of a hundredth of a pixel to two, and slits of such widths between boards.
pub fn sub_pixel(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("sub-pixel");
    let cube = maker.mesh(cube());
    // At 7 m, 97 pixels high, one pixel is 7.9 cm.
    let pixel = 0.079;
    let mut left = -4.0;
    while left < 4.0 {
        let width = random.range(0.2, 1.2);
        maker.place(cube, sized(DVec3::new(left + 0.5 * width, 0.0, 0.0), DVec3::new(width, 5.0, 0.1)));
        left += width + pixel * random.decade(0.01, 2.0);
    }
    for body in 0..bodies {
        let at = DVec3::new(random.range(-4.0, 4.0), random.range(-2.5, 2.5), random.range(-5.0, 1.5));
        let size = pixel * random.decade(0.01, 2.0);
        let place = if body % 2 == 0 { sized(at, DVec3::splat(size)) } else { turned(random, at, DVec3::splat(size)) };
        maker.place(cube, place);
    }
    Case::new("", maker.scene, wander(DVec3::new(0.1, 0.05, 7.0), DVec3::ZERO, PERSPECTIVE)).into()
}

/// Bodies of two to nine pixels at any place of the grid of texels, that look out by a pixel behind others: a footprint of
/// which a row or a column of texels is left out loses them.
pub fn footprints(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("footprints");
    let cube = maker.mesh(cube());
    let pixel = 10.0 / 97.0;
    for _ in 0..bodies {
        let corner = DVec3::new(random.range(-80.0, 80.0).floor(), random.range(-48.0, 48.0).floor(), 0.0) * pixel;
        let mut pixels = |low: f64, high: f64| random.range(low, high).floor() * pixel;
        let (width, height) = (pixels(2.0, 10.0), pixels(2.0, 10.0));
        let depth = random.range(-8.0, -2.0);
        let middle = corner + DVec3::new(0.5 * width, 0.5 * height, 0.0);
        maker.place(cube, sized(middle + DVec3::Z * depth, DVec3::new(width, height, 0.1)));
        // A board before it that leaves one column or row of its pixels open.
        let (open_x, open_y) = if random.below(2) == 0 { (pixel, 0.0) } else { (0.0, pixel) };
        let side = if random.below(2) == 0 { 0.5 } else { -0.5 };
        let board = middle + DVec3::new(side * open_x, side * open_y, depth + 0.5);
        maker.place(cube, sized(board, DVec3::new(width - open_x, height - open_y, 0.1)));
    }
    let projection = Projection::Orthographic { half_height: 5.0, near: 0.0, far: 20.0 };
    let ahead = |eye: DVec3| shot(eye, eye - DVec3::Z, projection);
    let eye = DVec3::Z * 5.0;
    let aside = DVec3::X * 0.5 * pixel;
    Case::new("", maker.scene, [eye, eye, eye + aside, eye + 3.0 * aside, eye].map(ahead).to_vec()).into()
}

/// Pictures of one row or column, and of powers of two and their neighbours.
pub fn thin_targets(random: &mut Random, bodies: usize) -> Drill {
    const SIDES: [u32; 10] = [1, 2, 3, 31, 32, 33, 63, 65, 127, 129];
    let maker = crowd(random, bodies);
    let any = |random: &mut Random| SIDES[random.below(SIDES.len())];
    let size = match random.below(3) {
        0 => [1, any(random)],
        1 => [any(random), 1],
        _ => [any(random), any(random)],
    };
    filmed(random, maker).sized(size).into()
}
