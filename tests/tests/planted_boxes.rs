//! The harness can fail, for the methods that test boxes: `roc` and `eovc` are broken on purpose, one defect at a time, and a
//! law must say so. The same frames without a defect keep every law, so it is the defect that is seen.

#[path = "planted_boxes/eovc.rs"]
mod eovc;
#[path = "planted_boxes/roc.rs"]
mod roc;

use culling::{Method, Options, Setup};
use engine::{Buffer, Frame, Gpu};
use harness::{assert_caught, assert_none, gpu, laws, worlds, Case, Subject};

type Make = fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>;
type Law = fn(&Gpu, &Subject, &Case) -> Vec<String>;

fn subject(make: Make) -> Subject {
    Subject { options: Options::new("broken", culling::roc::OPTIONS), make }
}

/// The law holds for the method without a defect, and names the fault of the one with it.
fn caught_by(law: Law, [sound, broken]: [Make; 2], case: &Case, expected: &str) {
    let gpu = gpu();
    assert_none(&law(&gpu, &subject(sound), case));
    assert_caught(&law(&gpu, &subject(broken), case), expected);
}

/// As [`caught_by`], by the law that every exact method must keep.
fn caught(makes: [Make; 2], case: &Case) {
    caught_by(laws::no_visible_object_is_culled, makes, case, "false negatives");
}

/// What boxes are made smaller by besides the defect, where the vertex grid is so coarse that what boxes are grown for its sake makes
/// up for the defect: a line reaches half a pixel past its box, and a grid of 1/16 pixel grows boxes by as much.
fn coarse(gpu: &Gpu, shrink: f32) -> f32 {
    if gpu.snap_px() > 1.0 / 64.0 {
        shrink
    } else {
        1.0
    }
}

/// As [`caught`], in a picture of one of these sizes at least: a coarse vertex grid pads boxes so much that a small picture hides a
/// small defect.
fn caught_at_a_size([sound, broken]: [Make; 2], case: &Case, sizes: [[u32; 2]; 3]) {
    let gpu = gpu();
    let mut seen = Vec::new();
    for case in sizes.map(|size| case.sized(size)) {
        assert_none(&laws::no_visible_object_is_culled(&gpu, &subject(sound), &case));
        if seen.is_empty() {
            seen = laws::no_visible_object_is_culled(&gpu, &subject(broken), &case);
        }
    }
    assert_caught(&seen, "false negatives");
}

/// Runs what was recorded, and changes a buffer in the middle of the frame.
fn edit<T: bytemuck::Pod>(f: &mut Frame, buffer: &mut Buffer<T>, change: impl FnOnce(&mut [T])) -> culling::Result<()> {
    let mut data = f.read(buffer)?;
    change(&mut data);
    Ok(buffer.write(&data)?)
}
