//! How far beside a sample a device takes its depth. The specification says: not at all, and no limit tells of devices that do, so it is
//! measured.
//!
//! SwiftShader covers samples where they are (`SetupRoutine.cpp`), and takes each one's depth where it would be with left and right exchanged
//! (`PixelRoutine.cpp` takes the sample's x from the pixel's where it should add it): 0.75 pixel beside two of four.

use super::samples::{Sampled, SAMPLES};
use anyhow::{Context, Result};
use culling::{View, World};
use engine::{Format, Gpu, Image, Target};
use glam::{DAffine3, DQuat, DVec3, Vec2, Vec3};
use scenes::{Mesh, Object, Pose, Projection, Scene, Shot, Surface, Topology};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Measured once a device in a program's run.
static MEASURED: Mutex<BTreeMap<String, f32>> = Mutex::new(BTreeMap::new());

/// Where four samples lie, in pixels from a pixel's upper left corner (Vulkan 1.3, standard sample locations).
const STANDARD: [[f32; 2]; SAMPLES as usize] = [[0.375, 0.125], [0.875, 0.375], [0.125, 0.625], [0.625, 0.875]];

/// The picture that is measured in: two squares.
const SIZE: [u32; 2] = [2 * SIDE_PX, SIDE_PX];
const SIDE_PX: u32 = 8;

/// How far beside a sample its depth is taken at most, in pixels. Less than a step of the vertex grid counts as nothing: bounds have room for that.
///
/// # Errors
/// What the device objects to.
pub(super) fn stray_px(gpu: &Gpu) -> Result<f32> {
    let device = gpu.info().map(|info| info.cache_key.clone()).unwrap_or_default();
    let mut measured = MEASURED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(stray) = measured.get(&device) {
        return Ok(*stray);
    }
    let stray = measure(gpu).context("measuring where samples have their depth")?;
    measured.insert(device, stray);
    Ok(stray)
}

fn measure(gpu: &Gpu) -> Result<f32> {
    let Some(info) = gpu.info() else { return Ok(0.0) };
    if !info.standard_samples {
        // Both are somewhere in the pixel.
        return Ok(std::f32::consts::SQRT_2);
    }
    let places = places(gpu)?;
    let beside = places.iter().zip(STANDARD).map(|(place, standard)| place.distance(standard.into()));
    let stray = beside.fold(0.0, f32::max);
    Ok(if stray < gpu.snap_px() { 0.0 } else { stray })
}

/// Where in a pixel the depth of each of its samples is taken: what squares show there that get nearer to the right, and downwards.
fn places(gpu: &Gpu) -> Result<[Vec2; SAMPLES as usize]> {
    let sampled = Sampled::new(gpu, SIZE, SAMPLES)?;
    let (colour, depth) = (image(gpu, Format::Colour)?, image(gpu, Format::Depth)?);
    let target = Target {
        size: SIZE,
        colour: Some((colour.view(), Format::Colour)),
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: Some(sampled.drawn()),
    };
    let world = World::new(gpu, &squares())?;
    // A pixel is a unit, and so is a sixteenth of the way from the far plane to the near one: depth says how far from the pixel's corner it is.
    let side = f64::from(SIDE_PX);
    let projection = Projection::Orthographic { half_height: 0.5 * side, near: 0.0, far: 2.0 * side };
    let pose = Pose { position: DVec3::Z * side, rotation: DQuat::IDENTITY };
    let mut f = gpu.frame();
    world.update(&mut f);
    f.clear(&target);
    world.draw_all(&mut f, &View::new(&Shot { pose, projection, seconds: 0.0 }, SIZE, 0, gpu.snap_px()), &target);
    f.finish()?;
    let depths = sampled.read_depths()?;
    let width = 4 * SIDE_PX as usize;
    // The pixel right below each square's middle.
    let place = |sample: usize, pixel: u32| {
        let (x, y) = (2 * pixel as usize + (sample & 1), SIDE_PX as usize + (sample >> 1));
        2.0 * SIDE_PX as f32 * (depths[y * width + x] - 0.5)
    };
    let [left, right] = [SIDE_PX / 2, 3 * SIDE_PX / 2];
    Ok(std::array::from_fn(|sample| Vec2::new(place(sample, left), place(sample, right))))
}

fn image(gpu: &Gpu, format: Format) -> engine::Result<Image> {
    Image::new(gpu, "samples.measured", format, SIZE)
}

/// A square to the left of the middle, nearer to the right, and one to the right of it, nearer downwards: both lean by half a right angle.
fn squares() -> Scene {
    let (mut positions, side) = (Vec::new(), SIDE_PX as f32);
    for (left, lean) in [(-side, Vec2::X), (0.0, Vec2::NEG_Y)] {
        for [x, y] in [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]] {
            let at = side * Vec2::new(x, y);
            positions.push(Vec3::new(at.x + left + 0.5 * side, at.y, at.dot(lean)));
        }
    }
    let mesh = Mesh {
        name: "squares".into(),
        topology: Topology::Triangles,
        normals: vec![Vec3::Z; positions.len()],
        positions,
        indices: vec![0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7],
        ..Mesh::default()
    };
    let object = Object {
        name: "squares".into(),
        mesh: 0,
        world_from_object: DAffine3::IDENTITY,
        colour: [1.0; 4],
        dynamic: false,
        translucent: false,
        masked: false,
        surface: Surface::default(),
    };
    Scene { name: "where depth is taken".into(), meshes: vec![mesh], objects: vec![object], ..Scene::default() }
}
