//! A compute stage of one's own after a method's frame: how many pixels of each row show something, counted on the device.
//! `cargo run -p sightline-culling --example own_stage`
//!
//! The stage is `shaders/glsl/example/count_covered.comp`; `cargo shaders` made the struct of it. The barrier that makes it wait for
//! the drawing follows from what the shader declares, and its name is the label in captures and in the times below.

use culling::{find, Setup, View, World};
use engine::{Buffer, Format, Gpu, GpuOptions, Image, Placement, Target};
use scenes::{CameraPath, SceneOptions};
use shaders::example;

const SIZE: [u32; 2] = [640, 360];

/// The stage in plain Rust: its twin.
fn count_covered(depth: &[f32], [width, _]: [u32; 2]) -> Vec<u32> {
    depth.chunks(width as usize).map(|row| row.iter().filter(|depth| **depth > 0.0).count() as u32).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&GpuOptions { validation: true, ..GpuOptions::default() })?;
    let scene = scenes::open("boxes", &SceneOptions::default())?;
    let world = World::new(&gpu, &scene)?;
    let colour = Image::new(&gpu, "own.colour", Format::Colour, SIZE)?;
    let depth = Image::new(&gpu, "own.depth", Format::Depth, SIZE)?;
    let covered = Buffer::<u32>::new(&gpu, "own.covered", SIZE[1] as usize, Placement::ReadBack)?;
    let shown = Some((colour.view(), Format::Colour));
    let target = Target {
        size: SIZE,
        colour: shown,
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let options = find("frustum")?.default_options();
    let mut method = (find("frustum")?.make)(&Setup { gpu: &gpu, world: &world, options: &options, visible: None })?;
    let shot = CameraPath::named(&scene, None, 1.0)?.sample(0, 1);

    let mut f = gpu.frame();
    method.frame(&mut f, &world, &View::new(&shot, SIZE, 0, gpu.snap_px()), &target)?;
    f.dispatch(example::CountCovered { depth: depth.view(), covered: covered.all(), size_px: SIZE }, SIZE[1]);
    for stage in f.finish()?.stages {
        println!("{:24} {:8.3} ms", stage.label, stage.ms);
    }
    let rows = covered.read()?;
    let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&depth.read()?);
    if rows != count_covered(&texels, SIZE) {
        return Err("the stage and its twin do not agree".into());
    }
    println!("{} of {} pixels show something", rows.iter().sum::<u32>(), SIZE[0] * SIZE[1]);
    Ok(())
}
