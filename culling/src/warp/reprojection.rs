//! What camera and objects did between two frames, as matrices from the last frame's clip space to the new one's.

use crate::{View, World};
use glam::{DAffine3, DMat4};
use shaders::types::Reprojection;

/// What a frame saw, for the next one to be warped from: made when the frame is drawn, as its objects move on afterwards.
#[derive(Clone, Debug, PartialEq)]
pub struct LastFrame {
    view: View,
    transforms: Vec<(u32, DAffine3)>,
    shapes: u64,
}

impl LastFrame {
    /// The view, and where the world's moving objects are now.
    pub fn of(world: &World, view: &View) -> Self {
        LastFrame { view: *view, transforms: world.moving().collect(), shapes: world.shape_revision() }
    }

    /// What it looked through.
    pub fn view(&self) -> &View {
        &self.view
    }
}

/// What the camera did, and what it and each object that can move did, in the order in which the world gives these.
#[derive(Clone, Debug, PartialEq)]
pub struct Reprojections {
    /// For all that cannot move.
    pub camera: Reprojection,
    /// For each object that can.
    pub moving: Vec<Reprojection>,
}

/// The way from the last frame's clip space to the new one's.
///
/// An object whose shape has changed since then has no such way. Its matrix is 0, which no point in front of an eye gives: its pixels
/// go nowhere and hide nothing.
///
/// All of it is f64: a point's world position never appears in floats, so motion is as exact a million metres from the origin
/// as beside it.
///
/// # Panics
/// If the two frames are not of the same world.
pub fn reprojections(last: &LastFrame, world: &World, view: &View) -> Reprojections {
    let moving: Vec<(u32, DAffine3)> = world.moving().collect();
    assert_eq!(moving.len(), last.transforms.len(), "the last frame is of another world");
    let camera = clip_from_last(last.view(), view, &DAffine3::IDENTITY);
    let same_shapes = world.shape_revision() == last.shapes;
    let of_object = |((object, now), (_, before)): (&(u32, DAffine3), &(u32, DAffine3))| {
        if !same_shapes && world.is_deformed(*object) {
            DMat4::ZERO
        } else if now == before {
            camera
        } else {
            clip_from_last(last.view(), view, &(*now * before.inverse()))
        }
    };
    let objects = moving.iter().zip(&last.transforms).map(of_object);
    let gpu = |matrix: DMat4| Reprojection { clip_from_last: matrix.as_mat4().to_cols_array_2d() };
    Reprojections { camera: gpu(camera), moving: objects.map(gpu).collect() }
}

/// The new view's clip space from the last one's (x, y, depth, 1), for what moved by `moved` in the world.
fn clip_from_last(last: &View, view: &View, moved: &DAffine3) -> DMat4 {
    if *moved == DAffine3::IDENTITY && view.same(last) {
        // Exactly, so that what stays keeps its depth to the bit.
        return DMat4::IDENTITY;
    }
    let aspect = f64::from(last.size[0]) / f64::from(last.size[1]);
    // Inverted in two parts, as a turn is its own transpose and the projection alone is sparse: little is lost.
    let view_from_clip = last.projection.clip_from_view(aspect).inverse();
    let relative_from_last_clip = DMat4::from_quat(last.pose.rotation) * view_from_clip;
    let (from, to) = (last.pose.position, view.pose.position);
    let relative_from_last_relative = DAffine3 {
        matrix3: moved.matrix3,
        // (moved.matrix3 - 1) from + moved.translation is how far the last camera's place was carried.
        translation: moved.transform_point3(from) - to,
    };
    view.clip_from_relative() * DMat4::from(relative_from_last_relative) * relative_from_last_clip
}
