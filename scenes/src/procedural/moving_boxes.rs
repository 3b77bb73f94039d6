//! Moving boxes: [`super::boxes`], a third of which orbit the middle, spin on the spot or bob.

use super::random::Random;
use super::{boxes, SceneOptions};
use crate::animation::{Motion, Orbit};
use crate::model::Scene;
use glam::DVec3;
use std::f64::consts::TAU;

/// The ground and the wall come first and stay.
const FIXED: usize = 2;

pub(super) fn make(options: &SceneOptions) -> Scene {
    let mut scene = boxes::make(options);
    scene.name = "moving-boxes".into();
    let mut random = Random::new(options.seed, 1);
    let mut orbits = Vec::new();
    for (index, object) in scene.objects.iter_mut().enumerate().skip(FIXED) {
        if index % 3 != 0 {
            continue;
        }
        object.dynamic = true;
        let base = object.world_from_object;
        let still = Orbit {
            object: index as u32,
            base,
            centre: base.translation,
            axis: DVec3::Y,
            radians_per_s: 0.0,
            bob: DVec3::ZERO,
            bob_period_s: 0.0,
        };
        let turn = random.pick(&[-1.0, 1.0]) * TAU;
        orbits.push(match index / 3 % 3 {
            // Around the middle of the wall, through its plane beside it.
            0 => Orbit { centre: DVec3::ZERO, radians_per_s: turn / random.range(20.0, 60.0), ..still },
            1 => {
                let axis = DVec3::new(random.range(-1.0, 1.0), 1.0, random.range(-1.0, 1.0));
                Orbit { axis, radians_per_s: turn / random.range(2.0, 8.0), ..still }
            }
            _ => {
                let bob = DVec3::new(random.range(-2.0, 2.0), random.range(0.5, 4.0), 0.0);
                Orbit { bob, bob_period_s: random.range(2.0, 6.0), ..still }
            }
        });
    }
    scene.motion = Motion::Orbits(orbits);
    scene
}
