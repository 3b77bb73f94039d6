//! glTF files from elsewhere, from the file to the pixel: those of Debian's assimp-testmodels, where it is installed.

use harness::{assert_none, gpu, sessions};
use sightline::run::session::{Session, SessionOptions};
use sightline::run::truth::draw_everything;
use std::path::Path;

const FOLDER: &str = "/usr/share/assimp/models/glTF2";

/// File, and how many pixels of 160x120 it must cover at the least.
const FILES: [(&str, usize); 7] = [
    ("BoxTextured-glTF/BoxTextured.gltf", 1000),
    ("BoxTextured-glTF-Binary/BoxTextured.glb", 1000),
    ("BoxTextured-glTF-Embedded/BoxTextured.gltf", 1000),
    ("2CylinderEngine-glTF-Binary/2CylinderEngine.glb", 1000),
    ("cameras/Cameras.gltf", 1),
    ("glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", 1000),
    ("simple_skin/simple_skin.gltf", 100),
];

fn open(gpu: &engine::Gpu, file: &str, frames: usize) -> Session {
    let scene = format!("{FOLDER}/{file}");
    assert!(Path::new(&scene).is_file(), "{scene} is missing: install assimp-testmodels (tools/setup.sh does)");
    let size = [160, 120];
    let options =
        SessionOptions { scene: scene.clone().into(), frames, size, whole_path: true, ..SessionOptions::default() };
    let good = |session: anyhow::Result<Session>| session.unwrap_or_else(|error| panic!("{scene}: {error:#}"));
    let session = good(Session::on(gpu, options.clone()));
    // Flat ones show nothing from behind, where the path leads too; that is what tests/materials.rs is for.
    let mut seen_from_both_sides = session.scene.clone();
    seen_from_both_sides.objects.iter_mut().for_each(|object| object.surface.single_sided = false);
    good(Session::with_scene(gpu, seen_from_both_sides, options))
}

fn covered(session: &mut Session) -> usize {
    let images = draw_everything(session, 0).unwrap();
    if let Some(folder) = std::env::var_os("SIGHTLINE_TEST_PICTURES") {
        let name = session.options().scene.with_extension("png").file_name().unwrap_or_default().to_owned();
        sightline::pictures::png_out::Picture::colour(&images).write(&Path::new(&folder).join(name)).unwrap();
    }
    images.items.iter().filter(|item| **item != sightline::measures::metrics::NO_ITEM).count()
}

#[test]
fn files_from_elsewhere_are_drawn_and_culled_without_error() {
    let gpu = gpu();
    let mut faults = Vec::new();
    for (file, least) in FILES {
        let mut session = open(&gpu, file, 4);
        let pixels = covered(&mut session);
        if pixels < least {
            faults.push(format!("{file}: covers {pixels} pixels, not {least}"));
        }
        faults.extend(sessions::faults(&mut session, "hzb", &[]));
    }
    assert_none(&faults);
}

#[test]
fn every_primitive_mode_is_drawn() {
    let gpu = gpu();
    let mut faults = Vec::new();
    for mode in 0..16 {
        let file = format!("glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_{mode:02}.gltf");
        let mut session = open(&gpu, &file, 2);
        if covered(&mut session) == 0 {
            faults.push(format!("{file}: no pixel was drawn"));
        }
        faults.extend(sessions::faults(&mut session, "hzb", &[]));
    }
    assert_none(&faults);
}
