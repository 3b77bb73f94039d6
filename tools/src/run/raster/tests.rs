//! The rule excuses slivers, and nothing else.

use super::*;
use crate::measures::metrics::compare;
use glam::{DQuat, DVec3, Vec3};
use scenes::{Object, Pose, Projection, Shot, Surface, Topology};

/// Pixels of the picture's side; a pixel is a metre.
const SIDE: u32 = 16;
/// The pixel that the triangles of object 0 cover, on edge.
const AT: usize = 8 * SIDE as usize + 2;
/// Nearer than any bound of object 0 allows, and as near as they allow.
const TOO_NEAR: f32 = 0.95;
const IN_BOUNDS: f32 = 0.5;

fn object(mesh: u32) -> Object {
    Object {
        name: format!("object {mesh}"),
        mesh,
        world_from_object: DAffine3::IDENTITY,
        colour: [1.0; 4],
        dynamic: false,
        translucent: false,
        masked: false,
        surface: Surface::default(),
    }
}

/// A triangle of this width across the middle of column 2, from 2 to 10 m before the camera; and an object elsewhere.
fn scene(width: f32) -> Scene {
    let mesh = |corners: [[f32; 3]; 3]| Mesh {
        name: "triangle".into(),
        topology: Topology::Triangles,
        positions: corners.map(Vec3::from).to_vec(),
        normals: vec![Vec3::Z; 3],
        indices: vec![0, 1, 2],
        ..Mesh::default()
    };
    let left = -5.5 - 0.5 * width;
    let meshes = vec![
        mesh([[left, 4.0, -2.0], [left + width, 0.0, -10.0], [left, -4.0, -6.0]]),
        mesh([[4.0, 4.0, -8.0], [6.0, 4.0, -8.0], [4.0, 6.0, -8.0]]),
    ];
    Scene { name: "on edge".into(), meshes, objects: vec![object(0), object(1)], ..Scene::default() }
}

fn sight(scene: &Scene) -> Sight {
    let bounds = scene.meshes.iter().map(|mesh| {
        let low = mesh.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
        let high = mesh.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        Bounds { centre_high: centre.to_array(), half_extent: half.to_array(), ..Bounds::default() }
    });
    let projection = Projection::Orthographic { half_height: 0.5 * f64::from(SIDE), near: 0.0, far: 16.0 };
    let pose = Pose { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
    let view = View::new(&Shot { pose, projection, seconds: 0.0 }, [SIDE; 2], 0, 1.0 / 256.0);
    Sight { bounds: bounds.collect(), scene_objects: vec![0, 1], view, seconds: 0.0 }
}

/// A picture in which these pixels show these objects at these depths.
fn images(shown: &[(usize, u32, f32)]) -> FrameImages {
    let pixels = (SIDE * SIDE) as usize;
    let mut images = FrameImages {
        width: SIDE,
        height: SIDE,
        colour: vec![[0; 4]; pixels],
        depth: vec![0.0; pixels],
        items: vec![NO_ITEM; pixels],
        seen_through: Vec::new(),
    };
    for &(pixel, item, depth) in shown {
        (images.items[pixel], images.depth[pixel], images.colour[pixel]) = (item, depth, [200; 4]);
    }
    images
}

/// Judges a method whose picture is the truth without the objects that are not in `drawn`.
fn verdict(width: f32, truth: FrameImages, drawn: [bool; 2]) -> (FrameError, u64) {
    let scene = scene(width);
    let shown = |&pixel: &usize| truth.items[pixel] != NO_ITEM && drawn[truth.items[pixel] as usize];
    let pixels = (0..truth.depth.len()).filter(shown);
    let left = images(&pixels.map(|pixel| (pixel, truth.items[pixel], truth.depth[pixel])).collect::<Vec<_>>());
    let truth = Truth::new(truth, 2).unwrap();
    let error = compare(&truth, &left, &drawn).unwrap();
    assert!(is_wrong(&truth, &left, &drawn));
    judged(&scene, &sight(&scene), &truth, (&left, &drawn), error)
}

#[test]
fn a_lost_sliver_that_is_nearer_than_its_bounds_is_excused() {
    let (error, thin) = verdict(0.001, images(&[(AT, 0, TOO_NEAR)]), [false, true]);
    assert_eq!((error.false_negatives, error.differing_pixels, thin), (0, 0, 1));
    assert_eq!((error.psnr_db, error.ssim, error.object_error_percent), (None, 1.0, 0.0));
}

#[test]
fn nothing_else_is() {
    let kept = |(error, thin): (FrameError, u64)| (error.false_negatives, error.differing_pixels, thin);
    let both = [(AT, 0, TOO_NEAR), (AT + 100, 1, IN_BOUNDS)];
    assert_eq!(kept(verdict(0.001, images(&[(AT, 0, IN_BOUNDS)]), [false, true])), (1, 1, 0), "its bounds hold it");
    assert_eq!(kept(verdict(2.0, images(&[(AT, 0, TOO_NEAR)]), [false, true])), (1, 1, 0), "it is high enough");
    assert_eq!(kept(verdict(0.001, images(&both), [false, false])), (2, 2, 0), "the sliver does not explain all");
    // A translucent object owns no pixel that could be thin.
    let seen_through = FrameImages { seen_through: vec![1], ..images(&[(AT, 0, TOO_NEAR)]) };
    assert_eq!(kept(verdict(0.001, seen_through, [false, false])), (2, 1, 0));
    let alone = FrameImages { seen_through: vec![1], ..images(&[]) };
    assert_eq!(kept(verdict(0.001, alone, [true, false])), (1, 0, 0));
}

#[test]
fn a_frame_like_the_truth_asks_for_nothing() {
    let truth = Truth::new(images(&[(AT, 0, TOO_NEAR)]), 2).unwrap();
    assert!(!is_wrong(&truth, truth.images(), &[true, false]));
    assert!(is_wrong(&truth, truth.images(), &[false, false]));
    assert!(is_wrong(&truth, &images(&[(AT, 0, IN_BOUNDS)]), &[true, true]));
}
