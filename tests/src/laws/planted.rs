//! Methods that a test breaks on purpose.

use super::no_visible_object_is_culled;
use crate::{assert_caught, assert_none, Case, Subject};
use culling::{Method, Options, Setup};
use engine::Gpu;

/// Makes a method that a test wrote.
pub type Make = fn(&Setup<'_>) -> culling::Result<Box<dyn Method>>;

/// A method loses objects of a case once it has a defect, and none without: so that it is the defect that is noticed.
///
/// # Panics
/// If that is not so.
#[track_caller]
pub fn a_defect_alone_loses_objects(gpu: &Gpu, sound: Make, wrong: Make, case: &Case) {
    let subject = |make| Subject { options: Options::new("broken", culling::roc::OPTIONS), make };
    assert_none(&no_visible_object_is_culled(gpu, &subject(sound), case));
    assert_caught(&no_visible_object_is_culled(gpu, &subject(wrong), case), "false negatives");
}
