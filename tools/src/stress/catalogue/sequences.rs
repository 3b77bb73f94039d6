//! What happens from frame to frame.

use super::{before_the_wall, crowd, filmed, Drill};
use crate::stress::worlds::{shot, special, wander, Case, Maker, PERSPECTIVE};
use crate::stress::Random;
use glam::DVec3;
use scenes::animation::Orbit;
use scenes::{Motion, Shot};

/// Along the wall in steps of centimetres: bodies come out by a pixel or two at a time.
pub fn creeping(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let (start, step) = (random.range(-3.0, 0.0), random.range(0.005, 0.06));
    let along = |frame: u32| {
        let eye = DVec3::new(start + step * f64::from(frame), 0.4, 7.0);
        shot(eye, eye - DVec3::Z, PERSPECTIVE)
    };
    Case::new("", maker.scene, (0..10).map(along).collect()).into()
}

/// Jumps to any place and back, told of or not.
pub fn teleports(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let home = shot(before_the_wall(random), DVec3::ZERO, PERSPECTIVE);
    let anywhere = |random: &mut Random| shot(random.vector() * 9.0, random.vector() * 2.0, PERSPECTIVE);
    let (a, b) = (anywhere(random), anywhere(random));
    let case = Case::new("", maker.scene, vec![home, home, a, home, b, b, a, home, home]);
    Drill { forgets: vec![3, 6], ..case.into() }
}

/// The eye jumps from box to box, each time into one that it did not see into before.
pub fn stepping(_random: &mut Random, _bodies: usize) -> Drill {
    special::stepping_into_boxes().into()
}

/// Some seconds into the same view.
fn at_times(case: &Case, seconds: &[f64]) -> Vec<Shot> {
    let shots = case.shots.iter().cycle();
    seconds.iter().zip(shots).map(|(seconds, shot)| Shot { seconds: *seconds, ..*shot }).collect()
}

/// Every second body goes around or swings, before a camera that moves too.
pub fn moving(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    let mut orbits = Vec::new();
    for (index, object) in maker.scene.objects.iter_mut().enumerate().skip(1).step_by(2) {
        object.dynamic = true;
        orbits.push(Orbit {
            object: index as u32,
            base: object.world_from_object,
            centre: object.world_from_object.translation * 0.5,
            axis: random.vector(),
            radians_per_s: random.range(-2.0, 2.0),
            bob: random.vector() * 2.0,
            bob_period_s: random.range(0.5, 3.0),
        });
    }
    maker.scene.motion = Motion::Orbits(orbits);
    let case = filmed(random, maker);
    let shots = at_times(&case, &[0.0, 0.0, 0.02, 0.04, 0.5, 0.5, 3.0, 3.01]);
    case.filmed(shots).into()
}

/// Skeletons bend bodies among walls, which stay as they are for a frame, go on, and are elsewhere at once.
pub fn bending(random: &mut Random, bodies: usize) -> Drill {
    // At scale 1 it has 240 bodies, and a wall for every second.
    deforming(random, "tentacles", bodies as f64 / 360.0)
}

/// Morph targets displace bodies among walls, and skeletons bend a third of them too.
pub fn morphing(random: &mut Random, bodies: usize) -> Drill {
    // At scale 1 it has 180 bodies, and a wall for every second.
    deforming(random, "jellyfish", bodies as f64 / 270.0)
}

fn deforming(random: &mut Random, scene: &str, scale: f64) -> Drill {
    let entry = scenes::procedural::SCENES.iter().find(|entry| entry.name == scene).unwrap();
    let scene = (entry.make)(&scenes::SceneOptions { scale, seed: random.bits(), ..Default::default() });
    let side = 20.0 * (scale * random.range(0.3, 1.0)).sqrt();
    let eye = DVec3::new(random.range(-0.6, 0.6) * side, random.range(0.5, 4.0), side);
    let case = Case::new("", scene, wander(eye, random.vector() * 0.2 * side + DVec3::Y, PERSPECTIVE));
    let start = random.range(0.0, 16.0);
    let shots = at_times(&case, &[0.0, 0.0, 0.02, 0.04, 0.5, 0.5, 7.0, 7.01].map(|later| start + later));
    case.filmed(shots).into()
}

/// Bodies swap places at once: who was hidden stands where one showed, and back. What was known of a place, or of a body, is
/// known of another.
pub fn reuse(random: &mut Random, bodies: usize) -> Drill {
    let mut maker = crowd(random, bodies);
    let mut orbits = Vec::new();
    for (index, object) in maker.scene.objects.iter_mut().enumerate().skip(1) {
        object.dynamic = true;
        // Half a turn around the wall's upright middle a second: front and back change places.
        orbits.push(Orbit {
            object: index as u32,
            base: object.world_from_object,
            centre: DVec3::ZERO,
            axis: DVec3::Y,
            radians_per_s: std::f64::consts::PI,
            bob: DVec3::ZERO,
            bob_period_s: 0.0,
        });
    }
    maker.scene.motion = Motion::Orbits(orbits);
    let case = filmed(random, maker);
    let home = case.shots[0];
    let shots = [0.0, 0.0, 1.0, 1.0, 2.0, 3.0, 3.5, 3.5].map(|seconds| Shot { seconds, ..home });
    case.filmed(shots.to_vec()).into()
}

/// Another size in each frame, with and without movement.
pub fn resize(random: &mut Random, bodies: usize) -> Drill {
    let maker = crowd(random, bodies);
    let any = |random: &mut Random| [random.decade(1.0, 200.0) as u32 + 1, random.decade(1.0, 120.0) as u32 + 1];
    let (a, b) = (any(random), any(random));
    let sizes = vec![a, a, b, [1, 1], a, b, a];
    Drill { sizes, ..filmed(random, maker).into() }
}

/// No body, one body, or all of them behind the eye.
pub fn nothing(random: &mut Random, bodies: usize) -> Drill {
    let eye = before_the_wall(random);
    let (maker, target) = match random.below(3) {
        0 => (Maker::new("nothing"), DVec3::ZERO),
        1 => (crowd(random, 0), DVec3::ZERO),
        _ => (crowd(random, bodies), 2.0 * eye),
    };
    Case::new("", maker.scene, wander(eye, target, PERSPECTIVE)).into()
}
