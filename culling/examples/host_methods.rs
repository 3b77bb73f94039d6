//! Sightline as a library: a scene of one's own under two methods. `cargo run -p sightline-culling --example host_methods`

use culling::{drawn_objects, find, Setup, View, World};
use engine::{Format, Gpu, GpuOptions, Image, Target};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use scenes::{Mesh, Object, Pose, Projection, Scene, Shot, Surface};

const SIZE: [u32; 2] = [640, 360];

/// A wall, and 400 small squares behind it.
fn scene() -> Scene {
    let square = Mesh {
        name: "square".into(),
        positions: [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| Vec3::new(x, y, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        ..Mesh::default()
    };
    let place = |name: &str, at: DVec3, size: f64, colour: [f32; 4]| Object {
        name: name.to_owned(),
        mesh: 0,
        world_from_object: DAffine3 { matrix3: DMat3::from_diagonal(DVec3::splat(size)), translation: at },
        colour,
        dynamic: false,
        translucent: false,
        masked: false,
        surface: Surface::default(),
    };
    let mut objects = vec![place("wall", DVec3::new(0.0, 0.0, -5.0), 6.0, [0.7, 0.5, 0.4, 1.0])];
    for index in 0..400 {
        let at = DVec3::new(f64::from(index % 20) - 9.5, f64::from(index / 20) - 9.5, -12.0);
        objects.push(place("square", at, 0.8, [0.3, 0.5, 0.8, 1.0]));
    }
    Scene { name: "wall".into(), meshes: vec![square], objects, ..Scene::default() }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&GpuOptions { validation: true, ..GpuOptions::default() })?;
    let world = World::new(&gpu, &scene())?;
    let colour = Image::new(&gpu, "host.colour", Format::Colour, SIZE)?;
    let depth = Image::new(&gpu, "host.depth", Format::Depth, SIZE)?;
    let items = Image::new(&gpu, "host.items", Format::Item, SIZE)?;
    let (shown, depth) = (Some((colour.view(), Format::Colour)), depth.view());
    for id in ["hzb", "eovc"] {
        let options = find(id)?.default_options();
        let mut method = (find(id)?.make)(&Setup { gpu: &gpu, world: &world, options: &options, visible: None })?;
        for frame in 0..3 {
            let eye = DVec3::new(0.2 * frame as f64, 0.0, 0.0);
            let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
            let shot = Shot { pose: Pose::looking_at(eye, eye + DVec3::NEG_Z), projection, seconds: 0.0 };
            let view = View::new(&shot, SIZE, frame, gpu.snap_px());
            // Some methods look at who owns which pixel, every few frames.
            let item = method.needs_items(&world, &view).then(|| items.view());
            let target = Target {
                size: SIZE,
                colour: shown,
                item,
                depth,
                depth_read_only: false,
                strictly_nearer: false,
                samples: None,
            };
            let mut f = gpu.frame();
            method.frame(&mut f, &world, &view, &target)?;
            let report = f.finish()?;
            let drawn = drawn_objects(&gpu, &world, &report)?.objects.iter().filter(|drawn| **drawn).count();
            println!("{id}, frame {frame}: {drawn} of {} objects drawn in {:.2} ms", world.len(), report.frame_ms);
        }
    }
    Ok(())
}
