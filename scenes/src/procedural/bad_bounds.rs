//! Bad bounds and good bounds: one street between walls, with objects behind them and before. In `bad-bounds` half of the objects
//! declare boxes larger than the street, so that the eye stands in half of all boxes, and some of the others declare boxes that
//! are wrong (inverted, empty, NaN, infinite, too small). `good-bounds` is the same to the last vertex, with no box declared: the
//! two halves of figure 18 of the EOVC thesis (section V), to compare what bad boxes cost.

use super::parts::Parts;
use super::random::Random;
use super::{shade, sized, turned, Assembly, SceneOptions};
use crate::camera::{Camera, Pose, Projection};
use crate::model::{Aabb, Mesh, Scene, Walk};
use glam::DVec3;

/// Objects at scale 1, beside ground and walls.
const OBJECTS: f64 = 2000.0;
/// Length of the street at scale 1, in metres; as dense at every scale.
const LENGTH: f64 = 120.0;
/// From the middle of the street to its walls, in metres.
const TO_WALL: f64 = 4.0;
/// How far objects stand behind the walls, in metres.
const DEPTH: f64 = 30.0;
/// Length of a wall, and of the gap after it, in metres.
const WALL: [f64; 2] = [10.0, 1.5];
const EYE: f64 = 1.7;
/// Of the objects whose boxes are not oversized, one in so many declares a box that is wrong.
const WRONG_IN: usize = 10;

pub(super) fn make_bad(options: &SceneOptions) -> Scene {
    make(options, "bad-bounds", true)
}

pub(super) fn make_good(options: &SceneOptions) -> Scene {
    make(options, "good-bounds", false)
}

fn make(options: &SceneOptions, name: &str, bad: bool) -> Scene {
    // An even number: half of them are exactly half.
    let pairs = ((0.5 * OBJECTS * options.scale).round() as usize).clamp(8, crate::check::MOST_OBJECTS / 4);
    let stretch = (2.0 * pairs as f64 / OBJECTS).sqrt();
    let (length, depth) = (LENGTH * stretch.max(0.2), DEPTH * stretch.max(0.2));
    let mut assembly = Assembly::new(name);
    surroundings(&mut assembly, length, depth);
    let bodies = bodies(&mut assembly, bad.then_some((2.0 * (length + depth)).ceil()));
    let mut random = Random::new(options.seed, 0);
    for pair in 0..pairs {
        let first_is_oversized = random.chance(0.5);
        for second in [false, true] {
            let body = random.below(PLAIN);
            let oversized = second != first_is_oversized;
            let kind = match (oversized, pair % WRONG_IN) {
                (true, _) => 1,
                (false, 0) => 2 + pair / WRONG_IN % WRONG,
                (false, _) => 0,
            };
            place(&mut assembly, &mut random, bodies[kind][body], [length, depth]);
        }
    }
    let mut scene = assembly.scene;
    let ends = [DVec3::new(0.0, EYE, 0.45 * length), DVec3::new(0.0, EYE, -0.45 * length)];
    scene.cameras = vec![Camera {
        name: "street".into(),
        pose: Pose::looking_at(ends[0], ends[1]),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: Some(8.0 * (length + depth)) },
        aspect: None,
        node: None,
    }];
    scene.walk = Some(Walk { points: ends.to_vec(), length: 0.5 * length, clearance: 1.0 });
    scene
}

/// Ground, and walls on both sides of the street with gaps between them.
fn surroundings(assembly: &mut Assembly, length: f64, depth: f64) {
    let mut parts = Parts::default();
    parts.cuboid([-0.5; 3], [0.5; 3]);
    let cube = assembly.mesh(parts.mesh("block"));
    let ground = DVec3::new(4.0 * (TO_WALL + depth), 1.0, 2.0 * length);
    assembly.place(cube, [0.4, 0.42, 0.4], sized(DVec3::new(0.0, -0.5, 0.0), ground));
    let count = (length / (WALL[0] + WALL[1])).ceil() as usize;
    for wall in 0..2 * count {
        let side = if wall % 2 == 0 { TO_WALL } else { -TO_WALL };
        let z = (wall / 2) as f64 * (WALL[0] + WALL[1]) + 0.5 * (WALL[0] - length);
        let size = DVec3::new(0.4, 6.0 + 0.01 * wall as f64, WALL[0]);
        assembly.place(cube, [0.65, 0.5, 0.4], sized(DVec3::new(side, 0.5 * size.y - 0.01, z), size));
    }
}

/// Nine in ten stand behind the walls, the others on the pavement before them.
fn place(assembly: &mut Assembly, random: &mut Random, mesh: u32, [length, depth]: [f64; 2]) {
    let side = if random.chance(0.5) { 1.0 } else { -1.0 };
    let away =
        if random.chance(0.9) { TO_WALL + 1.2 + random.unit() * depth } else { random.range(2.0, TO_WALL - 1.0) };
    let at = DVec3::new(side * away, random.range(0.0, 2.5), random.range(-0.5, 0.5) * length);
    let tint = [random.unit() as f32, random.unit() as f32, random.unit() as f32];
    let colour = shade(random, tint, 0.2);
    let angle = random.range(0.0, std::f64::consts::TAU);
    assembly.place(mesh, colour, turned(at, angle));
}

/// A name, and how it is built.
type Shape = (&'static str, fn(&mut Parts));

/// Plain shapes, up to a metre in size.
const PLAIN: usize = 4;
/// Ways to be wrong.
const WRONG: usize = 5;

/// Each shape several times: as it is, with an oversized box, and with each kind of wrong one. Without `oversized` (half the
/// side of such a box, metres) nothing is declared.
fn bodies(assembly: &mut Assembly, oversized: Option<f64>) -> [[u32; PLAIN]; 2 + WRONG] {
    let shapes: [Shape; PLAIN] = [
        ("crate", |parts| parts.cuboid([-0.4, 0.0, -0.3], [0.4, 0.7, 0.3])),
        ("drum", |parts| parts.cylinder([0.0; 3], [0.35, 0.35], 0.9, 24)),
        ("cone", |parts| parts.cylinder([0.0; 3], [0.4, 0.0], 0.8, 20)),
        ("ball", |parts| parts.ball([0.0, 0.4, 0.0], [0.4; 3], 10)),
    ];
    std::array::from_fn(|kind| {
        shapes.map(|(name, build)| {
            let mut parts = Parts::default();
            build(&mut parts);
            let mesh = parts.mesh(name);
            let declared_bounds = oversized.and_then(|half| declared(kind, half, &mesh.bounds()));
            let name = if kind == 0 { name.to_owned() } else { format!("{name} {kind}") };
            assembly.mesh(Mesh { name, declared_bounds, ..mesh })
        })
    })
}

/// What a kind of mesh declares, by its true box.
fn declared(kind: usize, half: f64, tight: &Aabb) -> Option<Aabb> {
    let Aabb { min, max } = *tight;
    match kind {
        0 => None,
        1 => Some(Aabb { min: DVec3::splat(-half), max: DVec3::splat(half) }),
        2 => Some(Aabb { min: max, max: min }),
        3 => Some(Aabb::EMPTY),
        4 => Some(Aabb { min: DVec3::NAN, max }),
        5 => Some(Aabb { min, max: DVec3::INFINITY }),
        _ => Some(Aabb { min: tight.centre(), max: tight.centre() }),
    }
}
