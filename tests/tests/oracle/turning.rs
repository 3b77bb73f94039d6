//! Objects that turn inside out in the middle of an animation (glTF 2.0, 3.7.4). One-sided meshes were drawn with the winding of time
//! 0.

use crate::{drawn, imported, pixels, SIZE};
use glam::{DAffine3, DQuat, DVec3};
use harness::oracle::model::{Interpolation, Material, Mesh, Model, Node, Skin, Target, Track};
use harness::oracle::{faults, Side};
use harness::worlds::{shot, PERSPECTIVE};
use harness::{assert_caught, assert_none, gpu, laws, Case, Lab, Subject};
use scenes::Shot;

/// A square of two times `half` metres a side that shows its front to +z.
fn square(half: f32) -> Mesh {
    Mesh {
        positions: vec![[-half, -half, 0.0], [half, -half, 0.0], [half, half, 0.0], [-half, half, 0.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        material: Material { alpha: 1.0, ..Material::default() },
        ..Mesh::default()
    }
}

fn node(parent: Option<usize>, at: DVec3, mesh: Option<usize>) -> Node {
    Node { parent, place: (at, DQuat::IDENTITY, DVec3::ONE), mesh, skin: None, tracks: Vec::new() }
}

/// Mirrors in x and goes back, in two seconds.
fn mirroring(interpolation: Interpolation) -> Track {
    let key = |x: f32| vec![x, 1.0, 1.0];
    let values = match interpolation {
        Interpolation::Cubic => [1.0, -1.0, 1.0].iter().flat_map(|x| [key(0.0), key(*x), key(0.0)]).collect(),
        _ => vec![key(1.0), key(-1.0), key(1.0)],
    };
    Track { target: Target::Scale, interpolation, times: vec![0.0, 1.0, 2.0], values }
}

/// The property that mirrors a wall, with twenty bodies behind it: its own scale, its parent's scale, or the joint that carries it.
#[derive(Clone, Copy, Debug)]
enum By {
    Itself,
    Parent,
    Joint,
}

fn model(by: By, interpolation: Interpolation) -> Model {
    let mut model = Model { meshes: vec![square(3.0), square(1.0)], ..Model::default() };
    model.nodes.push(node(None, DVec3::ZERO, None));
    match by {
        By::Itself => model.nodes[0].mesh = Some(0),
        By::Parent => model.nodes.push(node(Some(0), DVec3::ZERO, Some(0))),
        By::Joint => {
            model.meshes[0].influences = vec![([0, 1, 0, 0], [0.25, 0.75, 0.0, 0.0]); 4];
            // Joint 0 never mirrors, joint 1 does and carries more.
            model.nodes.push(node(Some(0), DVec3::ZERO, None));
            model.skins.push(Skin { joints: vec![0, 1], inverse_binds: vec![DAffine3::IDENTITY; 2] });
            model.nodes.push(Node { skin: Some(0), ..node(None, DVec3::X * 50.0, Some(0)) });
        }
    }
    let turning = if matches!(by, By::Joint) { 1 } else { 0 };
    model.nodes[turning].tracks.push(mirroring(interpolation));
    for body in 0..20 {
        let at = DVec3::new(f64::from(body % 5) - 2.0, f64::from(body / 5) - 1.5, -2.0 - 0.1 * f64::from(body));
        model.nodes.push(Node { place: (at, DQuat::IDENTITY, DVec3::splat(0.4)), ..node(None, at, Some(1)) });
    }
    model
}

/// A camera that creeps along while the wall turns twice. No shot is at the instant at which the wall is flat.
fn shots() -> Vec<Shot> {
    let at = |frame: u32| {
        let aside = 0.01 * f64::from(frame);
        let seconds = 0.15 * f64::from(frame) + 0.02;
        Shot { seconds, ..shot(DVec3::new(aside, 0.1, 8.0), DVec3::X * aside, PERSPECTIVE) }
    };
    (0..13).map(at).collect()
}

#[test]
fn a_mesh_shows_the_side_that_its_current_transform_says() {
    let gpu = gpu();
    let mut found = Vec::new();
    for by in [By::Itself, By::Parent, By::Joint] {
        for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::Cubic] {
            let model = model(by, interpolation);
            let name = format!("{by:?} {interpolation:?}");
            let case = Case { name: name.clone(), scene: imported(&model.glb()), shots: shots(), size: SIZE };
            let mut lab = Lab::new(&gpu, &case);
            let mut faces = [false; 2];
            for (number, shot) in case.shots.iter().enumerate() {
                let surfaces = model.surfaces(shot.seconds);
                faces[usize::from(surfaces[0].side == Side::Clockwise)] = true;
                let said = pixels(&lab, shot, &surfaces);
                found.extend(faults(&format!("{name}, shot {number}"), &said, &drawn(&mut lab, shot), SIZE[0]));
            }
            assert_eq!(faces, [true; 2], "{name} turns");
        }
    }
    assert_none(&found);
}

/// Planted: the side of time 0, as in the fault.
#[test]
fn the_side_of_time_0_is_caught() {
    let gpu = gpu();
    let model = model(By::Itself, Interpolation::Linear);
    let mut scene = imported(&model.glb());
    let case = |scene| Case { name: "wall".into(), scene, shots: shots(), size: SIZE };
    let shot = shots()[6];
    let said = pixels(&Lab::new(&gpu, &case(scene.clone())), &shot, &model.surfaces(shot.seconds));
    // The wall as it is at that time, for ever; drawn as if it had always been mirrored, its front is on the other side.
    let mut places = Vec::new();
    scene.motion.transforms_at(shot.seconds, &mut places);
    scene.motion = scenes::Motion::Still;
    scene.objects[0].world_from_object = places[0].1;
    scene.objects[0].dynamic = false;
    scene.meshes[0].indices.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
    let picture = drawn(&mut Lab::new(&gpu, &case(scene)), &shot);
    assert_caught(&faults("time 0", &said, &picture, SIZE[0]), "but its ray meets Object(0) first");
}

/// A method that keeps draw commands from frame to frame keeps the index range of one side.
#[test]
fn every_exact_method_draws_objects_that_turn() {
    let gpu = gpu();
    for by in [By::Itself, By::Joint] {
        let scene = imported(&model(by, Interpolation::Linear).glb());
        let case = Case { name: format!("{by:?}"), scene, shots: shots(), size: SIZE };
        for entry in culling::METHODS.iter().filter(|entry| entry.guarantee == culling::Guarantee::Exact) {
            assert_none(&laws::no_visible_object_is_culled(&gpu, &Subject::named(entry.id), &case));
        }
    }
}
