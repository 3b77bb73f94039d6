//! Meshes that morph targets displace.

use super::moving_support::{points, times, track, vector};
use super::{affine, choices, deformed, gpu_shape, outside, rest, shares, skeleton};
use glam::{DAffine3, DVec3, Vec3};
use proptest::prelude::*;
use scenes::animation::{AnimatedNode, Interpolation, Local, Track};
use scenes::{
    weights_of_sum_one, Aabb, Displacement, MorphTarget, Motion, MovingBounds, MovingBoxes, RestVertex, Scene,
    WorldBounds,
};

/// Up to four targets, each with a weight of its own: some displace one vertex, some many, some far. The result has the keys of the
/// weights, and the targets of a mesh with so many vertices.
type Morphs = (Vec<Track<f64>>, Vec<MorphTarget>, Vec<f64>);

fn morphs(vertices: usize) -> impl Strategy<Value = Morphs> {
    let weight = track(prop_oneof![-1.5..2.5f64, 0.0..1.0f64, Just(0.0)], prop_oneof![-4.0..4.0f64, -300.0..300.0f64]);
    let displacement = prop_oneof![vector(1.0), vector(50.0), Just(DVec3::Y * 1e-3)];
    let target = (weight, prop::collection::vec((any::<prop::sample::Index>(), displacement), 1..8));
    prop::collection::vec(target, 1..5).prop_map(move |targets| {
        let (mut tracks, mut all, mut keys) = (Vec::new(), Vec::new(), Vec::new());
        for (weight, displaced) in targets {
            let Some(track) = weight else { continue };
            let (first, last) = track.duration_s();
            keys.extend([first, last]);
            let by_vertex: std::collections::BTreeMap<u32, DVec3> =
                displaced.into_iter().map(|(at, by)| (at.index(vertices) as u32, by)).collect();
            let displaced = by_vertex.into_iter().map(|(vertex, position)| Displacement {
                vertex,
                position: position.as_vec3(),
                normal: Vec3::ZERO,
            });
            all.push(MorphTarget { weight: tracks.len() as u32, displacements: displaced.collect() });
            tracks.push(track);
        }
        (tracks, all, keys)
    })
}

fn points_and_morphs() -> impl Strategy<Value = (Vec<Vec3>, Morphs)> {
    points().prop_flat_map(|points| {
        let morphs = morphs(points.len());
        (Just(points), morphs)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Meshes with and without a skeleton, and instances anywhere.
    #[test]
    fn displaced_vertices_stay_in_their_box(
        (nodes, keys) in skeleton(), inverse_binds in prop::collection::vec(affine(), 0..3), (points, (weights, targets, weight_keys)) in points_and_morphs(),
        choices in choices(), instance in affine(), by_chance in prop::collection::vec(0.0..1.0f64, 30),
    ) {
        let rest = rest(points, &choices, nodes.len());
        let scene = deformed(nodes, (&inverse_binds, instance), rest, (weights, targets));
        prop_assert!(scene.check().is_ok(), "{:?}", scene.check());
        for mode in MovingBounds::ALL {
            let faults = outside(&scene, mode, &times(&[keys.clone(), weight_keys.clone()].concat(), &by_chance));
            prop_assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }
}

/// A bar of three vertices along x. The first target lifts its end by 2; the second lowers it by 1 and its middle by 0.5.
fn bar(weights: [Track<f64>; 2]) -> Scene {
    let still = AnimatedNode {
        parent: None,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Matrix(DAffine3::IDENTITY),
        translation: None,
        rotation: None,
        scale: None,
    };
    let vertex = |x: f32| RestVertex { position: Vec3::X * x, normal: Vec3::Z, ..RestVertex::default() };
    let displaced = |vertex: u32, y: f32| Displacement { vertex, position: Vec3::Y * y, normal: Vec3::ZERO };
    let targets = vec![
        MorphTarget { weight: 0, displacements: vec![displaced(2, 2.0)] },
        MorphTarget { weight: 1, displacements: vec![displaced(1, -0.5), displaced(2, -1.0)] },
    ];
    let rest = [0.0, 1.0, 2.0].map(vertex).to_vec();
    deformed(vec![still], (&[], DAffine3::IDENTITY), rest, (weights.to_vec(), targets))
}

fn linear(keys: &[(f64, f64)]) -> Track<f64> {
    let (times, values) = keys.iter().copied().unzip();
    Track::new(Interpolation::Linear, times, values).expect("a legal track")
}

fn box_at(scene: &Scene, mode: MovingBounds, seconds: f64) -> Aabb {
    let (bounds, shapes) = (WorldBounds::new(scene), scene.shapes_at(seconds));
    MovingBoxes::new(scene, &bounds, mode).at(0, seconds, &bounds, (0, &DAffine3::IDENTITY), &shapes)
}

#[track_caller]
fn assert_heights(box_: Aabb, [low, high]: [f64; 2]) {
    assert!((box_.min.y - low).abs() < 1e-5 && (box_.max.y - high).abs() < 1e-5, "{box_:?}: {low}..{high} expected");
    assert!(box_.min.x.abs() < 1e-5 && (box_.max.x - 2.0).abs() < 1e-5, "{box_:?}");
}

/// No box is larger than its vertices need. Where two targets move a vertex against each other, only the difference counts.
#[test]
fn boxes_of_displaced_vertices_are_tight() {
    let scene = bar([linear(&[(0.0, 0.0), (2.0, 1.0)]), linear(&[(0.0, 0.0), (2.0, 1.0)])]);
    assert_heights(box_at(&scene, MovingBounds::PerFrame, 0.0), [0.0, 0.0]);
    assert_heights(box_at(&scene, MovingBounds::PerFrame, 1.0), [-0.25, 0.5]);
    assert_heights(box_at(&scene, MovingBounds::PerFrame, 9.0), [-0.5, 1.0]);
    // Once the animation is over.
    assert_heights(box_at(&scene, MovingBounds::PerAnimation, 3.0), [-0.5, 1.0]);
    for mode in [MovingBounds::Union, MovingBounds::InPlace, MovingBounds::PerAnimation] {
        // Spans are short, but both weights may be anything in one: a 64th of the way more than is needed.
        let box_ = box_at(&scene, mode, 1.0);
        assert!((-0.6..=-0.5).contains(&box_.min.y) && (1.0..1.1).contains(&box_.max.y), "{mode:?}: {box_:?}");
    }
}

/// A spline may pass the values of its keys, and so may the box of the mesh.
#[test]
fn splines_of_weights_are_bounded_not_sampled() {
    // From 0 to 0 by 0.75 at the middle: a quarter of the tangents' difference, 3 - (-3), of 2 s, over 4.
    let values = vec![0.0, 0.0, 3.0, -3.0, 0.0, 0.0];
    let spline = Track::new(Interpolation::CubicSpline, vec![0.0, 2.0], values).expect("a legal track");
    let scene = bar([spline, linear(&[(0.0, 0.0)])]);
    assert_heights(box_at(&scene, MovingBounds::PerFrame, 1.0), [0.0, 3.0]);
    for mode in MovingBounds::ALL {
        assert_eq!(outside(&scene, mode, &[-1.0, 0.0, 0.4, 1.0, 1.7, 2.0, 3.0]), Vec::<String>::new());
    }
    let union = box_at(&scene, MovingBounds::Union, 0.0);
    assert!(union.max.y < 3.1, "{union:?}");
}

/// Negative weights turn a displacement round.
#[test]
fn negative_weights_have_room() {
    let scene = bar([linear(&[(0.0, -1.0), (2.0, 0.5)]), linear(&[(0.0, 0.0)])]);
    assert_heights(box_at(&scene, MovingBounds::PerFrame, 0.0), [-2.0, 0.0]);
    assert_heights(box_at(&scene, MovingBounds::Union, 0.0), [-2.0, 1.0]);
}

/// A file with many keys and many vertices took minutes to load. Beyond a limit of work the boxes are those of all weights.
#[test]
fn boxes_of_many_keys_and_vertices_hold_all_weights() {
    let still = || AnimatedNode {
        parent: None,
        world_from_root: DAffine3::IDENTITY,
        local: Local::Matrix(DAffine3::IDENTITY),
        translation: None,
        rotation: None,
        scale: None,
    };
    let sheet = |vertices: u32, keys: u32, skin: &[DAffine3]| {
        let place = |at: u32| Vec3::new(at as f32 / vertices as f32, (at % 7) as f32 * 0.1, 0.0);
        let weights = weights_of_sum_one(shares([1.0]));
        let vertex = |at: u32| RestVertex { position: place(at), normal: Vec3::Z, weights, ..RestVertex::default() };
        let displaced = |vertex: u32| Displacement { vertex, position: Vec3::Y * 4.0, normal: Vec3::ZERO };
        let targets = vec![MorphTarget { weight: 0, displacements: (0..vertices).map(displaced).collect() }];
        // Up to 1 and down again; the last key comes a second later.
        let weight = |key: u32| if key == keys / 2 { 1.0 } else { 0.0 };
        let track = linear(&(0..keys).map(|key| (f64::from(key), weight(key))).collect::<Vec<_>>());
        deformed(vec![still()], (skin, DAffine3::IDENTITY), (0..vertices).map(vertex).collect(), (vec![track], targets))
    };
    let over = 1e6;
    let few = sheet(3000, 16, &[]);
    assert!(box_at(&few, MovingBounds::PerAnimation, over).max.y < 0.61, "it is over");
    let (rigid, bent) = (sheet(3000, 8192, &[]), sheet(3000, 8192, &[DAffine3::IDENTITY]));
    let modes = [MovingBounds::Union, MovingBounds::PerAnimation, MovingBounds::InPlace];
    for (many, mode) in [rigid, bent].iter().flat_map(|scene| modes.map(|mode| (scene, mode))) {
        let faults = outside(many, mode, &[-1.0, 0.0, 4095.5, 4096.0, 4096.25, 8191.0, over]);
        assert_eq!(faults, Vec::<String>::new());
        // No larger than that.
        let box_ = box_at(many, mode, over);
        assert!(box_.min.y.abs() < 1e-4 && (box_.max.y - 4.6).abs() < 1e-4, "{mode:?}: {box_:?}");
    }
}

/// Planted: bounds that ignore a target, and bounds of another time, do not hold the mesh. The tests above would notice.
#[test]
fn bounds_without_a_target_are_caught() {
    let tracks = || [linear(&[(0.0, 0.0), (2.0, 1.0)]), linear(&[(0.0, 0.0), (2.0, -1.0)])];
    let scene = bar(tracks());
    let mut without = bar(tracks());
    without.deformed[0].targets.remove(1);
    let shape = gpu_shape(&scene.deformed[0], &scene.shapes_at(2.0));
    assert!(!box_at(&without, MovingBounds::PerFrame, 2.0).contains(shape[2].as_dvec3()));
    assert!(!box_at(&without, MovingBounds::Union, 2.0).contains(shape[2].as_dvec3()));
    assert!(!box_at(&scene, MovingBounds::PerFrame, 1.0).contains(shape[2].as_dvec3()));
}

#[test]
fn targets_without_a_meaning_are_refused() {
    type Change = fn(&mut Scene);
    let changes: [(Change, &str); 6] = [
        (|scene| scene.deformed[0].targets[1].weight = 2, "morph target 1 has weight 2, but there are 2"),
        (|scene| scene.deformed[0].targets[1].displacements.swap(0, 1), "morph target 1: its vertices do not ascend"),
        (|scene| scene.deformed[0].targets[0].displacements[0].vertex = 3, "or are more than its mesh has"),
        (|scene| scene.deformed[0].targets[0].displacements[0].position.x = 1e38, "take vertex 2 beyond the range"),
        (|scene| scene.deformed[0].targets[0].displacements[0].normal.x = f32::NAN, "take vertex 2 beyond the range"),
        (|scene| scene.motion = Motion::Still, "its mesh is deformed, but nothing moves"),
    ];
    for (index, (change, text)) in changes.into_iter().enumerate() {
        let mut scene = bar([linear(&[(0.0, 0.0), (2.0, 1.0)]), linear(&[(0.0, 0.0), (2.0, 1.0)])]);
        assert!(scene.check().is_ok());
        change(&mut scene);
        let message = scene.check().expect_err("it has no meaning").to_string();
        assert!(message.starts_with("object 'body': ") && message.contains(text), "change {index}: {message}");
    }
}
