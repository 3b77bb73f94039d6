//! Shaders that take the place of those built in.

use engine::{Buffer, Error, Format, Gpu, Image, Placement};
use harness::gpu;
use harness::replaced::{built_in, count_uncovered};
use shaders::example::CountCovered;
use shaders::reload::NewShader;
use shaders::ShaderKind;

const SIZE: [u32; 2] = [7, 3];

/// What `example/count_covered` says of a picture in which nothing is.
fn counted(gpu: &Gpu) -> Vec<u32> {
    let depth = Image::new(gpu, "test.depth", Format::Depth, SIZE).unwrap();
    let colour = Image::new(gpu, "test.colour", Format::Colour, SIZE).unwrap();
    let covered = Buffer::new(gpu, "test.covered", SIZE[1] as usize, Placement::ReadBack).unwrap();
    let target = engine::Target {
        size: SIZE,
        colour: Some((colour.view(), Format::Colour)),
        item: None,
        depth: depth.view(),
        depth_read_only: false,
        strictly_nearer: false,
        samples: None,
    };
    let mut f = gpu.frame();
    f.clear(&target);
    f.dispatch(CountCovered { depth: depth.view(), covered: covered.all(), size_px: SIZE }, SIZE[1]);
    f.finish().unwrap();
    covered.read().unwrap()
}

#[test]
fn a_new_shader_runs_from_the_next_frame_on_and_the_old_one_comes_back() {
    let gpu = gpu();
    for _ in 0..2 {
        assert_eq!(counted(&gpu), [0; 3]);
        gpu.replace_shaders(&[count_uncovered()]).unwrap();
        assert_eq!(counted(&gpu), [7; 3]);
        gpu.replace_shaders(&[built_in("example/count_covered", ShaderKind::Compute)]).unwrap();
    }
    assert_eq!(counted(&gpu), [0; 3]);
}

#[test]
fn what_is_no_shader_of_a_stage_is_refused_by_name_and_the_old_one_stays() {
    let gpu = gpu();
    assert_eq!(counted(&gpu), [0; 3]);
    let good = count_uncovered();
    let faulty = [
        NewShader { stage: "example/count_nothing".to_owned(), ..good.clone() },
        NewShader { kind: ShaderKind::Fragment, ..good.clone() },
        NewShader { words: b"text".map(u32::from).to_vec(), ..good.clone() },
        NewShader { words: Vec::new(), ..good.clone() },
    ];
    for shader in faulty {
        // The good one beside it is not taken either.
        let error = gpu.replace_shaders(&[good.clone(), shader.clone()]).unwrap_err();
        assert!(matches!(&error, Error::NewShader { stage, .. } if *stage == shader.stage), "{error}");
        assert_eq!(counted(&gpu), [0; 3]);
    }
}

#[test]
fn a_shader_that_the_validation_layer_objects_to_leaves_the_old_one() {
    let gpu = gpu();
    assert_eq!(counted(&gpu), [0; 3]);
    // OpCapability Float64, which no device is opened with.
    let mut strange = count_uncovered();
    strange.words.splice(5..5, [2 << 16 | 17, 10]);
    let error = gpu.replace_shaders(&[strange]).unwrap_err();
    assert!(matches!(&error, Error::Validation { .. }), "{error}");
    assert_eq!(counted(&gpu), [0; 3]);
}
