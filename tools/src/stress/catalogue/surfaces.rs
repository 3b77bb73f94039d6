//! Surfaces, boxes and lists.

use super::{crowd, filmed, Drill};
use crate::stress::worlds::{
    cube, dust, mesh, shot, sized, special, square, turned, wander, wires, Case, Maker, PERSPECTIVE,
};
use crate::stress::Random;
use glam::{DVec3, Vec3};
use scenes::{Aabb, Topology};

/// Bodies whose faces lie in those of others, and of the wall; some pressed through by a hair.
pub fn coplanar(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("coplanar");
    let kinds = [maker.mesh(cube()), maker.mesh(square())];
    maker.place(kinds[0], sized(DVec3::ZERO, DVec3::new(8.0, 6.0, 1.0)));
    for body in 0..bodies {
        let size = DVec3::new(random.range(0.2, 2.0), random.range(0.2, 2.0), random.range(0.1, 0.9));
        let hair = [0.0, 0.0, 1e-9, -1e-9, 1e-5, -1e-5][body % 6];
        // Its front in that of the wall; a square has no thickness.
        let depth = if body % 2 == 0 { 0.5 - 0.5 * size.z } else { 0.5 } + hair;
        let at = DVec3::new(random.range(-5.0, 5.0), random.range(-4.0, 4.0), depth);
        maker.place(kinds[body % 2], sized(at, size));
    }
    filmed(random, maker).into()
}

/// Cubes exactly equal to their boxes, face to face on a grid, with gaps to look through.
pub fn own_box(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("own box");
    let cube = maker.mesh(cube());
    let side = (bodies as f64 / 3.0).sqrt().ceil().max(2.0);
    let size = 10.0 / side;
    for index in 0..3 * (side * side) as usize {
        if random.below(4) == 0 {
            continue;
        }
        let (x, y, z) = (index % side as usize, index / side as usize % side as usize, index / (side * side) as usize);
        let at = (DVec3::new(x as f64, y as f64, -(z as f64)) - DVec3::new(0.5, 0.5, 0.0) * side) * size;
        maker.place(cube, sized(at, DVec3::splat(size)));
    }
    let eye = DVec3::Z * random.range(7.0, 11.0);
    Case::new("", maker.scene, wander(eye, DVec3::ZERO, PERSPECTIVE)).into()
}

/// Bodies sunk into a thick wall up to half, a thousandth or a hair of their height.
pub fn sunk(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("sunk");
    let cube = maker.mesh(cube());
    maker.place(cube, sized(DVec3::ZERO, DVec3::new(9.0, 6.0, 4.0)));
    for body in 0..bodies {
        let at = random.vector() * DVec3::new(4.0, 2.5, 2.0);
        let size = random.range(0.2, 0.9);
        let out = size * [0.5, 1e-3, 1e-4, 1e-5, 1e-6][body % 5];
        let depth = 2.0 + out - 0.5 * size;
        let side = if at.z > 0.0 { depth } else { -depth };
        maker.place(cube, sized(DVec3::new(at.x, at.y, side), DVec3::splat(size)));
    }
    let eye = DVec3::new(0.4, 0.3, 9.0) + 0.2 * random.vector();
    Case::new("", maker.scene, wander(eye, DVec3::ZERO, PERSPECTIVE)).into()
}

/// Diagonal triangles thinner than a pixel, at all depths, alone and through boards.
pub fn slivers(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies / 2);
    for _ in 0..8 {
        // Higher than an eighth of a pixel at 7 m: thinner ones are outside the raster conditions (footprint.glsl).
        let thin = random.range(0.012, 0.05) as f32;
        let tip = Vec3::new(0.5, random.range(0.3, 0.5) as f32, random.range(-0.5, 0.5) as f32);
        let positions = vec![-tip, tip, tip + Vec3::new(thin, -thin, 0.0)];
        maker.mesh(mesh("sliver", Topology::Triangles, positions, vec![0, 1, 2]));
    }
    for body in 0..bodies {
        let at = DVec3::new(random.range(-4.0, 4.0), random.range(-3.0, 3.0), random.range(-4.0, 2.0));
        let size = DVec3::new(random.range(2.0, 4.0), random.range(2.0, 4.0), random.range(0.0, 1.0));
        maker.place(1 + body as u32 % 8, sized(at, size));
    }
    filmed(random, maker).into()
}

/// The same thing at the same place several times.
pub fn ties(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("ties");
    let kinds = [maker.mesh(cube()), maker.mesh(square())];
    while maker.scene.objects.len() < bodies {
        let at = random.vector() * DVec3::new(5.0, 3.0, 3.0);
        let size = DVec3::splat(random.range(0.3, 2.0));
        for _ in 0..random.below(4) + 1 {
            maker.place(kinds[random.below(2)], sized(at, size));
        }
    }
    let case = filmed(random, maker);
    let [home, away] = [case.shots[0], case.shots[4]];
    case.filmed(vec![home, home, home, home, away, away, away, home]).into()
}

/// Mirrored bodies, needles, and bodies shrunk to a sheet, a line or a point.
pub fn mirrored(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("mirrored");
    let cube = maker.mesh(cube());
    for body in 0..bodies {
        let at = random.vector() * 5.0;
        let mut size = random.vector();
        (0..body % 4).for_each(|axis| size[axis] = if body % 8 < 4 { 0.0 } else { size[axis] });
        if body % 9 == 0 {
            size *= DVec3::new(1e-4, 3.0, 1e-4);
        }
        let place = turned(random, at, size);
        maker.place(cube, place);
    }
    filmed(random, maker).into()
}

/// Boxes declared up to a thousand times larger than what is in them: they hold the eye and each other.
pub fn loose_bounds(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    for _ in 0..4 {
        let mut loose = cube();
        let reach = random.decade(1.0, 1e3) as f32;
        loose.declared_bounds = Some(Aabb { min: Vec3::splat(-reach).as_dvec3(), max: Vec3::splat(reach).as_dvec3() });
        maker.mesh(loose);
    }
    for object in maker.scene.objects.iter_mut().skip(1) {
        object.mesh = random.below(5) as u32;
    }
    filmed(random, maker).into()
}

/// Declared boxes that are NaN, inverted, empty, infinite or too small.
pub fn bad_bounds(_random: &mut Random, _bodies: usize) -> Drill {
    special::bad_bounds().into()
}

/// Everything in one point, so that every box, node and texel holds all of it.
pub fn one_point(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("one point");
    let cube = maker.mesh(cube());
    for body in 0..bodies.max(4) * 8 {
        let size = if body % 2 == 0 { 1.0 } else { random.range(0.9, 1.1) };
        maker.place(cube, sized(DVec3::ZERO, DVec3::splat(size)));
    }
    let wandering = wander(DVec3::new(0.3, 0.2, 3.0), DVec3::ZERO, PERSPECTIVE);
    Case::new("", maker.scene, wandering).into()
}

/// Boards side by side that all show: lists as long as they can be.
pub fn long_lists(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = Maker::new("long lists");
    let cube = maker.mesh(cube());
    let side = ((bodies * 8) as f64).sqrt().ceil();
    for index in 0..(side * side) as usize {
        let (x, y) = ((index % side as usize) as f64 - 0.5 * side, (index / side as usize) as f64 - 0.5 * side);
        let depth = random.range(-0.1, 0.1);
        maker.place(cube, sized(DVec3::new(x, y, depth) * 8.0 / side, DVec3::splat(7.0 / side)));
    }
    let ahead = |x: f64| shot(DVec3::new(x, 0.1, 8.0), DVec3::ZERO, PERSPECTIVE);
    Case::new("", maker.scene, [0.0, 0.0, 0.05, 2.0, 0.0].map(ahead).to_vec()).into()
}

/// Lines and points between bodies: their rasters reach a pixel out of their boxes.
pub fn lines_and_points(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    let dust = dust(random, 12);
    let (wires, dust) = (maker.mesh(wires()), maker.mesh(dust));
    for object in maker.scene.objects.iter_mut().skip(1) {
        object.mesh = [0, wires, dust][random.below(3)];
    }
    filmed(random, maker).into()
}
