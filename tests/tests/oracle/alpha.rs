//! A masked surface is there where its alpha is at least the cutoff (glTF 2.0, 3.9.4). Alpha that was meant to equal the cutoff was
//! rounded below it: by 8 bits, by interpolation, by the texture filter.

use crate::{drawn, imported, SIZE};
use glam::{DQuat, DVec3};
use harness::oracle::model::{Material, Mesh, Model, Node};
use harness::worlds::{shot, PERSPECTIVE};
use harness::{gpu, Case, Lab};
use scenes::Shot;

/// A floor from under the eye to the far end of the view: a triangle whose corners differ much in distance rounds most.
fn floor(material: Material, alpha: Vec<u8>) -> Mesh {
    Mesh {
        positions: vec![[-80.0, -1.0, 0.0], [80.0, -1.0, 0.0], [80.0, -1.0, -190.0], [-80.0, -1.0, -190.0]],
        indices: vec![0, 1, 2, 0, 2, 3],
        coordinates: vec![[0.0, 0.0], [31.0, 0.0], [31.0, 37.0], [0.0, 37.0]],
        alpha,
        material: Material { double_sided: true, ..material },
        ..Mesh::default()
    }
}

/// Counts the pixels that show the floor, and those that show it without holes.
fn shown(gpu: &engine::Gpu, mesh: Mesh) -> (usize, usize) {
    let views = [
        shot(DVec3::new(0.3, 0.4, 1.0), DVec3::new(3.0, -0.7, -9.0), PERSPECTIVE),
        shot(DVec3::new(-7.0, 5.0, -20.0), DVec3::new(20.0, -1.0, -60.0), PERSPECTIVE),
        shot(DVec3::new(0.0, -0.99, 0.01), DVec3::new(1.0, -1.1, -7.0), PERSPECTIVE),
    ];
    let solid = Mesh { material: Material { cutoff: None, ..mesh.material.clone() }, ..mesh.clone() };
    let count = |mesh: Mesh| {
        let place = (DVec3::ZERO, DQuat::IDENTITY, DVec3::ONE);
        let node = Node { parent: None, place, mesh: Some(0), skin: None, tracks: Vec::new() };
        let scene = imported(&Model { nodes: vec![node], meshes: vec![mesh], skins: Vec::new() }.glb());
        let mut lab = Lab::new(gpu, &Case { name: "floor".into(), scene, shots: views.to_vec(), size: SIZE });
        let pixels = |shot: &Shot| drawn(&mut lab, shot).iter().filter(|item| item.is_some()).count();
        views.iter().map(pixels).sum::<usize>()
    };
    let (shown, all) = (count(mesh), count(solid));
    assert!(all > 1000, "the views show too little of the floor: {all} pixels");
    (shown, all)
}

/// The ways in which a floor can have an alpha everywhere: by its factor, its vertices, its texture, and products of these with 1.
fn floors(alpha: u8, cutoff: f32) -> Vec<(&'static str, Mesh)> {
    let of = |factor: f32, texture: Option<u8>, vertices: &[u8]| {
        let texture = texture.map(|alpha| (4, vec![alpha; 16]));
        floor(Material { cutoff: Some(cutoff), alpha: factor, texture, ..Material::default() }, vertices.to_vec())
    };
    let exact = f32::from(alpha) / 255.0;
    vec![
        ("factor", of(exact, None, &[])),
        ("vertices", of(1.0, None, &[alpha; 4])),
        ("texture", of(1.0, Some(alpha), &[])),
        ("factor, white vertices", of(exact, None, &[255; 4])),
        ("factor, white texture", of(exact, Some(255), &[])),
        ("vertices, white texture", of(1.0, Some(255), &[alpha; 4])),
        ("white vertices, texture", of(1.0, Some(alpha), &[255; 4])),
    ]
}

#[test]
fn alpha_that_equals_the_cutoff_has_no_holes() {
    let gpu = gpu();
    for alpha in [255, 254, 128, 127, 90, 3, 1] {
        let cutoff = f32::from(alpha) / 255.0;
        for (name, mesh) in floors(alpha, cutoff) {
            let (shown, all) = shown(&gpu, mesh);
            assert_eq!(shown, all, "alpha {alpha}/255 by {name} has holes");
        }
    }
}

/// One step of 8 bits less is a hole everywhere.
#[test]
fn alpha_below_the_cutoff_is_a_hole() {
    let gpu = gpu();
    for alpha in [254, 127, 89, 2, 0] {
        for (name, mesh) in floors(alpha, f32::from(alpha + 1) / 255.0) {
            assert_eq!(shown(&gpu, mesh).0, 0, "alpha {alpha}/255 by {name} shows");
        }
    }
}

/// Alpha below the cutoff by a ten-thousandth is a hole, where alpha is not interpolated.
#[test]
fn a_uniform_alpha_is_told_from_the_cutoff_finely() {
    let gpu = gpu();
    for (alpha, cutoff, there) in
        [(0.35, 0.35, true), (0.3499, 0.35, false), (0.3501, 0.35, true), (1.0, 1.0001, false)]
    {
        let material = Material { cutoff: Some(cutoff), alpha, texture: Some((1, vec![255])), ..Material::default() };
        let (shown, all) = shown(&gpu, floor(material, vec![255; 4]));
        assert_eq!(shown, if there { all } else { 0 }, "alpha {alpha} at cutoff {cutoff}");
    }
}

/// Vertices of different alpha: if all have at least the cutoff, there is no hole.
#[test]
fn alpha_that_varies_above_the_cutoff_has_no_holes() {
    let gpu = gpu();
    for vertices in [[128, 128, 128, 255], [128, 200, 128, 200], [255, 128, 128, 128]] {
        let material = Material { cutoff: Some(128.0 / 255.0), alpha: 1.0, ..Material::default() };
        let (shown, all) = shown(&gpu, floor(material, vertices.to_vec()));
        assert_eq!(shown, all, "{vertices:?} has holes");
    }
}
