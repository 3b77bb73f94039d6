//! What long runs of `sightline stress` have found, kept.

use engine::Gpu;
use harness::{assert_none, gpu, Subject};
use sightline::stress::catalogue::DrillId;
use sightline::stress::run::Tally;
use sightline::stress::{run, Plan};

/// A method in one drill of the catalogue, with all its bodies; nothing fails.
fn passed(gpu: &Gpu, subject: Subject, drill: &str) -> Tally {
    let drills = vec![DrillId::parse(drill).unwrap()];
    let plan = Plan { subjects: vec![subject], drills, bodies: 600, size: None, as_given: true };
    let outcome = run(gpu, &plan, &mut |_, _| Ok(())).unwrap();
    let failures: Vec<String> = outcome.failures.iter().flat_map(|failure| failure.faults.clone()).collect();
    assert_none(&failures);
    assert_none(&outcome.broken_bounds);
    outcome.methods[0].clone()
}

/// Cube 78 shows its camera a face on edge in frame 8: not a thousandth of a pixel high, one pixel of it is drawn, and its plane, 31 times
/// the face's height beyond its end, is nearer there than the wall that hides the cube. (Exact methods promise depths of primitives of 1/8 pixel and
/// higher, `include/footprint.glsl`.) On a grid of 1/256 pixel, that is: what rounding makes of such a face is another matter on each.
#[test]
fn a_face_seen_on_edge_is_counted_on_its_own() {
    let gpu = gpu();
    let tally = passed(&gpu, Subject::named("hzb"), "creeping/24");
    let thin = if gpu.snap_px() == 1.0 / 256.0 { 1 } else { tally.thin };
    assert_eq!((tally.lost, tally.differing, tally.thin), (0, 0, thin));
}

/// The rays' hierarchy was built where objects were when the method was made, and only fitted to where they are: what rays met told of it.
#[test]
fn rays_do_not_tell_when_their_hierarchy_was_made() {
    passed(&gpu(), Subject::named("hzb-iterative").with("rays", "device"), "moving/26");
}
