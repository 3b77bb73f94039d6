//! The stages of `hzb-iterative` in plain Rust: their definition. A step's lists are in object order.

use crate::boxes::twin::{crosses_near, grown};
use crate::frustum::twin::{clip_from_bounds, footprint_widening, left_out, outside_frustum};
use crate::hzb::twin::{is_visible, PyramidTest};
use crate::pack::twin as pack;
use crate::roc::twin::{depth_of, range_of};
use glam::Vec3;
use shaders::types::*;

/// Out of view, or known to be hidden.
const NOWHERE: BlockSpan = BlockSpan { begin: 1.0, end: 0.0 };

/// Where the blocks in view begin, metres along the view: ranges are cut between the nearest and the farthest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Where the nearest block begins; infinite if none is in view.
    pub nearest: f32,
    /// Where the farthest block begins; 0 if none is in view.
    pub farthest: f32,
}

impl Reach {
    /// The range of a depth.
    pub fn range_of(&self, depth: f32, all: &StepView) -> u32 {
        range_of(depth - self.nearest, self.farthest - self.nearest, all.range_count, all.share)
    }
}

/// Where each block lies along the view, and where those in view begin. Twin of `hzb/measure_blocks`.
pub fn measure_blocks(blocks: &[Bounds], all: &StepView) -> (Vec<BlockSpan>, Reach) {
    let span = |block: &Bounds| {
        if block.flags & OBJECT_ALWAYS_KEPT != 0 {
            return BlockSpan { begin: 0.0, end: 3.0e38 };
        }
        if outside_frustum(&clip_from_bounds(block, &all.view), footprint_widening(block.flags, &all.view)) {
            return NOWHERE;
        }
        let coarse = Vec3::from(block.centre_high) - Vec3::from(all.view.camera_high);
        let centre = coarse + (Vec3::from(block.centre_low) - Vec3::from(all.view.camera_low));
        let [x, y, z, w] = all.depth_plane;
        let (normal, half) = (Vec3::new(x, y, z), Vec3::from(block.half_extent));
        let (middle, reach) = (normal.dot(centre) + w, normal.abs().dot(half));
        let slack = CLIP_ERROR * (normal.abs().dot(centre.abs() + half) + w.abs());
        BlockSpan { begin: (middle - reach - slack).max(0.0), end: (middle + reach + slack).max(0.0) }
    };
    let spans: Vec<BlockSpan> = blocks.iter().map(span).collect();
    let begins = || spans.iter().filter(|span| span.begin <= span.end).map(|span| span.begin);
    let reach = Reach { nearest: begins().fold(f32::INFINITY, f32::min), farthest: begins().fold(0.0, f32::max) };
    (spans, reach)
}

/// Which blocks are due in a step, 1 or 0 each; those found hidden are nowhere from then on. `seen`: what the last frame saw, by object.
/// `spans`: where they were measured to be; in a single range they are not. `pyramid`: of what was drawn before, if anything was. Twin of
/// `hzb/test_blocks`.
pub fn test_blocks(
    (blocks, seen): (&[Bounds], &[u32]),
    mut spans: Option<&mut [BlockSpan]>,
    reach: Reach,
    all: &StepView,
    pyramid: Option<&PyramidTest<'_>>,
    (step, fronts): (u32, bool),
) -> Vec<u32> {
    let range = |depth: f32| reach.range_of(depth, all);
    let mut due = Vec::with_capacity(blocks.len());
    let mut of_block = seen.chunks(BLOCK_OBJECTS as usize);
    let in_view = |block: &Bounds| {
        let widening = footprint_widening(block.flags, &all.view);
        block.flags & OBJECT_ALWAYS_KEPT != 0 || !outside_frustum(&clip_from_bounds(block, &all.view), widening)
    };
    let in_reach =
        |span: &BlockSpan| span.begin <= span.end && (range(span.begin)..=range(span.end) + 1).contains(&step);
    for (index, block) in blocks.iter().enumerate() {
        let was_seen = of_block.next().is_some_and(|objects| objects.iter().any(|seen| *seen != 0));
        let is_due = spans.as_ref().map_or_else(|| in_view(block), |spans| in_reach(&spans[index]));
        let is_due = is_due && (step > 0 || was_seen);
        let kept = block.flags & OBJECT_ALWAYS_KEPT != 0;
        let hides = |pyramid: &PyramidTest<'_>| {
            !is_visible(block, &all.view, pyramid) || fronts && !kept && pyramid.hides_by_fronts(block, &all.view)
        };
        let is_hidden = is_due && pyramid.is_some_and(hides);
        if let Some(spans) = spans.as_mut().filter(|_| is_hidden) {
            spans[index] = NOWHERE;
        }
        due.push(u32::from(is_due && !is_hidden));
    }
    due
}

/// The list of the blocks that are due: header and blocks, in order. Twin of `hzb/list_blocks`.
pub fn list_blocks(due: &[u32]) -> Vec<u32> {
    let listed: Vec<u32> = (0..due.len() as u32).filter(|block| due[*block as usize] != 0).collect();
    let count = listed.len() as u32;
    let across = [count.min(MOST_BLOCKS_ACROSS), count.div_ceil(MOST_BLOCKS_ACROSS), 1, count];
    across.into_iter().chain([count.div_ceil(64), 1, 1, 0]).chain(listed).collect()
}

/// What becomes of each object of the listed blocks in a step: STEP_*; of all others nothing is said. By object, `seen`: it is due a step
/// earlier; `known`: it is known to show, and needs no box and no test against its fronts. Twin of `hzb/test_objects`.
pub fn test_objects(
    (bounds, seen, known): (&[Bounds], &[u32], &[u32]),
    listed: &[u32],
    reach: Reach,
    all: &StepView,
    pyramid: Option<&PyramidTest<'_>>,
    (step, boxes, fronts): (u32, bool, bool),
) -> Vec<Option<u32>> {
    let becomes = |object: usize| {
        let (bound, seen, known) = (&bounds[object], seen[object] != 0, known[object] != 0);
        let kept = bound.flags & OBJECT_ALWAYS_KEPT != 0;
        let begin = if kept { 0.0 } else { depth_of(bound, &all.view, all.depth_plane) };
        if step != reach.range_of(begin, all) + u32::from(!seen) {
            return STEP_HIDDEN;
        }
        let shown = match pyramid {
            Some(pyramid) => is_visible(bound, &all.view, pyramid),
            None => kept || !left_out(&clip_from_bounds(bound, &all.view), bound.flags, &all.view),
        };
        let is_asked = shown && !known && !kept;
        let shown =
            shown && !pyramid.is_some_and(|pyramid| fronts && is_asked && pyramid.hides_by_fronts(bound, &all.view));
        let rasterises = || !kept && !crosses_near(&clip_from_bounds(&grown(bound, &all.view), &all.view));
        match (shown, boxes && pyramid.is_some() && !known && shown && rasterises()) {
            (false, _) => STEP_HIDDEN,
            (true, false) => STEP_SHOWN,
            (true, true) => STEP_TESTED,
        }
    };
    let is_listed = |object: usize| listed.contains(&(object as u32 / BLOCK_OBJECTS));
    (0..bounds.len()).map(|object| is_listed(object).then(|| becomes(object))).collect()
}

/// Where the commands of each listed block begin, and how many there are, of one kind of primitive. Twin of `hzb/scan_blocks`.
pub fn scan_blocks(counts: &[u32]) -> (Vec<u32>, u32) {
    pack::scan_counts(counts)
}

/// The commands of a step, in object order; `becomes` as [`test_objects`] leaves it for the objects of one kind of primitive. Twin of
/// `hzb/write_blocks`.
pub fn write_blocks(
    becomes: &[u32],
    object_meshes: &[u32],
    meshes: &[MeshRange],
    small_indices: u32,
) -> Vec<DrawCommand> {
    let mut commands = pack::write_commands(becomes, object_meshes, meshes);
    for command in &mut commands {
        let is_tested = becomes[command.first_instance as usize] == STEP_TESTED && command.index_count > small_indices;
        command.instance_count = u32::from(!is_tested);
    }
    commands
}
