//! Motions by chance.

use glam::{DAffine3, DMat3, DQuat, DVec3, Vec3};
use proptest::prelude::*;
use scenes::animation::{AnimatedNode, Interpolation, Local, Track};
use scenes::{Object, Surface};

/// The vertex as the GPU turns it: see `clip_from_object` in shaders/glsl/include/transform.glsl.
pub fn gpu_vertex(transform: &DAffine3, position: Vec3) -> DVec3 {
    let columns = transform.matrix3.as_mat3();
    let turned = columns.x_axis * position.x + columns.y_axis * position.y + columns.z_axis * position.z;
    turned.as_dvec3() + transform.translation
}

/// Some times in and around a motion, by chance and at all keys.
pub fn times(keys: &[f64], by_chance: &[f64]) -> Vec<f64> {
    let (first, last) = (keys.iter().copied().fold(0.0, f64::min), keys.iter().copied().fold(1.0, f64::max));
    let inside = by_chance.iter().map(|part| first - 0.1 + part * (last - first + 0.2));
    let around = keys.iter().flat_map(|key| [key.next_down(), *key, key.next_up()]);
    inside.chain(around).chain([-1e6, 1e6]).collect()
}

/// A white object.
pub fn object(name: &str, mesh: u32, world_from_object: DAffine3) -> Object {
    Object {
        name: name.into(),
        mesh,
        world_from_object,
        colour: [1.0; 4],
        dynamic: true,
        translucent: false,
        masked: false,
        surface: Surface::default(),
    }
}

/// Any vector up to a size along each axis.
pub fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-size..size).prop_map(DVec3::from)
}

fn rotation() -> impl Strategy<Value = DQuat> {
    let four = prop::array::uniform4(-1.0..1.0f64).prop_map(DQuat::from_array);
    four.prop_map(|turn| if turn.length() > 1e-3 { turn.normalize() } else { DQuat::IDENTITY })
}

fn interpolation() -> impl Strategy<Value = Interpolation> {
    prop_oneof![Just(Interpolation::Step), Just(Interpolation::Linear), Just(Interpolation::CubicSpline)]
}

/// Key times, some of them equal; values and tangents for as many.
pub fn track<T: scenes::animation::Interpolate + std::fmt::Debug>(
    value: impl Strategy<Value = T>,
    tangent: impl Strategy<Value = T>,
) -> impl Strategy<Value = Option<Track<T>>> {
    let key = (prop_oneof![0.01..2.0f64, Just(0.0)], value, prop::array::uniform2(tangent));
    let keys = prop::collection::vec(key, 1..5);
    let made = (interpolation(), -3.0..3.0f64, keys).prop_map(|(interpolation, start, keys)| {
        let mut seconds = start;
        let times = keys.iter().map(|(step, ..)| {
            seconds += step;
            seconds
        });
        let times = times.collect();
        let splines = interpolation == Interpolation::CubicSpline;
        let values = keys.iter().flat_map(|(_, value, [before, after])| match splines {
            true => vec![*before, *value, *after],
            false => vec![*value],
        });
        Track::new(interpolation, times, values.collect()).expect("a legal track")
    });
    prop::option::weighted(0.6, made)
}

/// A node without a parent, and whether it is to have one.
pub fn node() -> impl Strategy<Value = (AnimatedNode, bool)> {
    let tangent = prop::array::uniform4(-3.0..3.0f64).prop_map(DQuat::from_array);
    let tracks =
        (track(vector(5.0), vector(9.0)), track(rotation(), tangent), track(vector(2.0), vector(3.0)), any::<bool>());
    let matrix = prop::array::uniform9(-1.5..1.5f64).prop_map(|columns| DMat3::from_cols_array(&columns));
    (tracks, vector(4.0), rotation(), vector(1.5), matrix, any::<bool>()).prop_map(
        |((translation, rotation, scale, grows_up), at, turn, size, matrix, fixed)| {
            let moves = translation.is_some() || rotation.is_some() || scale.is_some();
            let place = DAffine3 { matrix3: matrix, translation: at };
            let local = match fixed && !moves {
                true => Local::Matrix(place),
                false => Local::Parts { translation: at, rotation: turn, scale: size },
            };
            (AnimatedNode { parent: None, world_from_root: place, local, translation, rotation, scale }, grows_up)
        },
    )
}

/// A few vertices.
pub fn points() -> impl Strategy<Value = Vec<Vec3>> {
    prop::collection::vec(prop::array::uniform3(-2.0..3.0f32).prop_map(Vec3::from), 1..12)
}
