//! Reads a recorded frame with fresh eyes: are any two uses that conflict kept apart by a barrier? All pairs are looked at,
//! from what the shaders declare, without the engine's own book-keeping.

use engine::{Barrier, Op, Point, Recorded, Target};
use shaders::{Access, Bound, BoundStage, ResourceId};

#[derive(Clone, Copy, Debug)]
struct Touch {
    resource: ResourceId,
    point: Point,
    reads: bool,
    writes: bool,
}

fn touch(resource: ResourceId, point: Point, reads: bool, writes: bool) -> Touch {
    Touch { resource, point, reads, writes }
}

fn id(bound: &Bound) -> ResourceId {
    match bound {
        Bound::Buffer { id, .. } => *id,
        Bound::Image(image) => image.id,
    }
}

fn stage(stage: &BoundStage, point: Point) -> Vec<Touch> {
    assert_eq!(stage.info.bindings.len(), stage.resources.len(), "{}: a binding has no resource", stage.info.name);
    let pairs = stage.info.bindings.iter().zip(&stage.resources);
    let touches = pairs.map(|(info, bound)| match info.access {
        Access::Read => touch(id(bound), point, true, false),
        Access::Write => touch(id(bound), point, false, true),
        Access::ReadWrite => touch(id(bound), point, true, true),
    });
    touches.collect()
}

fn target(target: &Target) -> Vec<Touch> {
    let (colour, depth) = match target.samples {
        Some(samples) => (samples.colour.map(|image| image.id), samples.depth.id),
        None => (target.colour.map(|(image, _)| image.id), target.depth.id),
    };
    let colours = colour.into_iter().chain(target.item.map(|image| image.id));
    let mut touches: Vec<_> = colours.map(|image| touch(image, Point::Colour, true, true)).collect();
    touches.push(touch(depth, Point::Depth, true, !target.depth_read_only));
    touches
}

fn touches(op: &Op) -> Vec<Touch> {
    match op {
        Op::Dispatch { stage: bound, .. } => stage(bound, Point::Compute),
        Op::DispatchIndirect { stage: bound, groups } => {
            let mut all = stage(bound, Point::Compute);
            all.push(touch(groups.id, Point::Indirect, true, false));
            all
        }
        Op::Draw { stage: bound, draw, target: to } | Op::Query { stage: bound, draw, target: to, .. } => {
            let mut all = stage(bound, Point::Drawing);
            all.push(touch(id(&draw.commands), Point::Indirect, true, false));
            all.extend(draw.count.map(|count| touch(count.id, Point::Indirect, true, false)));
            all.push(touch(id(&draw.vertices), Point::Vertices, true, false));
            if bound.info.instance_stride > 0 {
                all.push(touch(id(&draw.instances), Point::Vertices, true, false));
            }
            all.push(touch(id(&draw.indices), Point::Vertices, true, false));
            all.extend(target(to));
            all
        }
        Op::Shapes { stage: bound, target: to, .. } => {
            let mut all = stage(bound, Point::Drawing);
            all.extend(target(to));
            all
        }
        Op::Clear { target: to } => target(to),
        Op::Fill { buffer, .. } => vec![touch(id(buffer), Point::Transfer, false, true)],
        Op::Copy { from, to } => {
            vec![touch(id(from), Point::Transfer, true, false), touch(id(to), Point::Transfer, false, true)]
        }
        Op::CopyImage { from, to, .. } => {
            vec![touch(from.id, Point::Transfer, true, false), touch(id(to), Point::Transfer, false, true)]
        }
        Op::FillImage { from, to, .. } => {
            vec![touch(id(from), Point::Transfer, true, false), touch(to.id, Point::Transfer, false, true)]
        }
        Op::ResolveColour { from, to, .. } => {
            vec![touch(from.id, Point::Transfer, true, false), touch(to.id, Point::Transfer, false, true)]
        }
    }
}

fn separates(barrier: &Barrier, earlier: &Touch) -> bool {
    let bit = 1u8 << earlier.point as u8;
    barrier.after & bit != 0 && (!earlier.writes || barrier.written & bit != 0)
}

/// Every pair of steps that conflict over a resource with no barrier between them, one line each.
pub fn hazards(recorded: &[Recorded]) -> Vec<String> {
    let steps: Vec<Vec<Touch>> = recorded.iter().map(|step| touches(&step.op)).collect();
    let mut faults = Vec::new();
    for later in 0..steps.len() {
        for earlier in 0..later {
            let between = || recorded[earlier + 1..=later].iter().filter_map(|step| step.barrier.as_ref());
            for one in &steps[earlier] {
                let conflicts = steps[later]
                    .iter()
                    .any(|other| one.resource == other.resource && ((one.writes && other.reads) || other.writes));
                if conflicts && !between().any(|barrier| separates(barrier, one)) {
                    let (from, to) = (&recorded[earlier].label, &recorded[later].label);
                    faults
                        .push(format!("{from} and {to} conflict over resource {} at {:?}", one.resource.0, one.point));
                }
            }
        }
    }
    faults
}
