//! Boxes: a small scene for tests. A wall hides most of some plain bodies; some stand beside and before it. Among them are
//! reflected, skewed, flat and freely turned ones.

use super::parts::Parts;
use super::random::Random;
use super::{shade, sized, Assembly, SceneOptions};
use crate::camera::{Camera, Pose, Projection};
use crate::model::Scene;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// Bodies at scale 1, beside the wall and the ground.
const BODIES: f64 = 400.0;

pub(super) fn make(options: &SceneOptions) -> Scene {
    let count = ((BODIES * options.scale).round() as usize).clamp(8, crate::check::MOST_OBJECTS - 2);
    let mut random = Random::new(options.seed, 0);
    let mut assembly = Assembly::new("boxes");
    let bodies = bodies(&mut assembly);
    // As dense at every scale.
    let side = 20.0 * (count as f64 / BODIES).cbrt();
    assembly.place(
        bodies[0],
        [0.4, 0.42, 0.4],
        sized(DVec3::new(0.0, -0.6, 0.0), DVec3::new(5.0 * side, 1.0, 5.0 * side)),
    );
    let wall = DVec3::new(1.3 * side, 0.75 * side, 0.4);
    assembly.place(bodies[0], [0.65, 0.5, 0.4], sized(DVec3::new(0.0, 0.5 * wall.y - 0.3, 0.0), wall));
    for body in 0..count {
        // Two thirds behind the wall, the others on all sides of it.
        let at = if body % 3 < 2 {
            DVec3::new(random.range(-0.5, 0.5), random.range(0.03, 0.6), random.range(-1.2, -0.1)) * side
        } else {
            DVec3::new(random.range(-1.4, 1.4), random.range(0.03, 0.8), random.range(-1.2, 0.7)) * side
        };
        let mesh = random.pick(&bodies);
        let (red, green, blue) = (random.unit() as f32, random.unit() as f32, random.unit() as f32);
        let colour = shade(&mut random, [red, green, blue], 0.1);
        assembly.place(mesh, colour, DAffine3 { matrix3: shape(&mut random, body), translation: at });
    }
    let mut scene = assembly.scene;
    let eye = DVec3::new(0.15 * side, 0.3 * side, 1.6 * side);
    scene.cameras = vec![Camera {
        name: "front".into(),
        pose: Pose::looking_at(eye, DVec3::new(0.0, 0.25 * side, 0.0)),
        projection: Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: Some(20.0 * side) },
        aspect: None,
        node: None,
    }];
    scene
}

/// Size and turn of a body: each tenth reflected, each tenth skewed, each twentieth flat, each third along the axes.
fn shape(random: &mut Random, body: usize) -> DMat3 {
    let size = random.range(0.3, 1.5);
    let mut scale = DVec3::splat(size);
    if body.is_multiple_of(4) {
        scale *= DVec3::new(random.range(0.2, 2.0), random.range(0.2, 2.0), random.range(0.2, 2.0));
    }
    if body % 10 == 3 {
        scale.x = -scale.x;
    }
    if body % 20 == 7 {
        scale[random.below(3)] = 0.0;
    }
    let turn = DQuat::from_euler(
        glam::EulerRot::YXZ,
        random.range(0.0, std::f64::consts::TAU),
        random.range(-1.5, 1.5),
        random.range(-1.5, 1.5),
    );
    if body % 3 == 1 {
        return DMat3::from_diagonal(scale);
    }
    let skew =
        if body % 10 == 6 { DMat3::from_cols(DVec3::X, DVec3::new(0.4, 1.0, 0.0), DVec3::Z) } else { DMat3::IDENTITY };
    DMat3::from_quat(turn) * DMat3::from_diagonal(scale) * skew
}

/// Meshes of about unit size around the origin.
fn bodies(assembly: &mut Assembly) -> [u32; 5] {
    let mut add = |name: &str, build: fn(&mut Parts)| {
        let mut parts = Parts::default();
        build(&mut parts);
        assembly.mesh(parts.mesh(name))
    };
    [
        add("cube", |parts| parts.cuboid([-0.5; 3], [0.5; 3])),
        add("wedge", |parts| parts.gable([-0.5; 3], [0.5; 3])),
        add("drum", |parts| parts.cylinder([0.0, -0.5, 0.0], [0.5, 0.5], 1.0, 24)),
        add("cone", |parts| parts.cylinder([0.0, -0.5, 0.0], [0.5, 0.0], 1.0, 20)),
        add("ball", |parts| parts.ball([0.0; 3], [0.5; 3], 10)),
    ]
}
