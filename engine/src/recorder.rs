//! What a frame is before it becomes Vulkan: a list of stages with barriers between them. Plain data, readable as text.

use crate::barriers::{Barrier, BarrierTracker, Point, Use};
use crate::target::{Format, Target};
use shaders::{Access, Bound, BoundStage, BufferRef, ImageRef, ResourceId};
use std::fmt::Write;

mod apart;
mod samples;

pub(crate) use apart::apart;
use samples::Unresolved;

/// How indices form primitives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Primitives {
    /// Triangle list.
    #[default]
    Triangles,
    /// Line list, one pixel wide.
    Lines,
    /// Points, one pixel large.
    Points,
}

/// Which sides of triangles show. Means nothing for lines and points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Faces {
    /// Both.
    #[default]
    Both,
    /// The front alone, where corners go round counter-clockwise on the screen.
    Front,
}

/// What a surface does to what lies behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Surface {
    /// Hides it.
    #[default]
    Opaque,
    /// Hides it where the fragment shader does not discard.
    Masked,
    /// Is blended over it by its alpha; never writes depth.
    Translucent,
    /// Is added to it: light; never writes depth.
    Light,
}

impl Surface {
    /// True if it leaves its depth, so that it can hide what lies behind it.
    pub fn hides(self) -> bool {
        matches!(self, Surface::Opaque | Surface::Masked)
    }
}

/// Triangles that a vertex shader makes of numbers alone: no buffer, no command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shapes {
    /// Corners of one.
    pub corners: u32,
    /// How many.
    pub count: u32,
    /// What they do to what lies behind them.
    pub surface: Surface,
}

/// A multi-draw whose commands, and their number, lie on the GPU.
///
/// Within one submission a draw without a count must not follow one with a count: lavapipe (Mesa 22.3) then takes the old
/// count, and drops draws without a word. The engine panics on such a frame rather than let it pass for culling.
#[derive(Clone, Copy, Debug)]
pub struct IndexedIndirect {
    /// Vertices, as the pipeline's generated vertex struct.
    pub vertices: Bound,
    /// What goes on once an instance, as the pipeline's generated instance struct; not looked at by pipelines without one.
    pub instances: Bound,
    /// 32-bit indices.
    pub indices: Bound,
    /// Indexed indirect commands, 20 bytes each, tightly packed.
    pub commands: Bound,
    /// How many commands count, on the GPU; none draws `max_draws`.
    pub count: Option<BufferRef<u32>>,
    /// Commands there is room for.
    pub max_draws: u32,
    /// How indices form primitives.
    pub primitives: Primitives,
    /// Which sides show.
    pub faces: Faces,
    /// What it does to what lies behind it.
    pub surface: Surface,
}

/// A pool of occlusion queries, as steps name it. Like buffers, it lives on while a frame that can name it does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueriesRef {
    /// The driver's handle.
    pub raw: u64,
}

/// One recorded step.
#[derive(Clone, Debug)]
pub enum Op {
    /// A compute stage over a grid of work groups.
    Dispatch {
        /// The stage.
        stage: BoundStage,
        /// Work groups in x and y.
        groups: [u32; 2],
    },
    /// A compute stage over a grid that lies on the GPU: three words.
    DispatchIndirect {
        /// The stage.
        stage: BoundStage,
        /// Work groups in x, y and z.
        groups: BufferRef<u32>,
    },
    /// A drawing stage.
    Draw {
        /// The stage.
        stage: BoundStage,
        /// What is drawn.
        draw: IndexedIndirect,
        /// What it is drawn to.
        target: Target,
    },
    /// A drawing stage, each command counted by an occlusion query.
    Query {
        /// The stage.
        stage: BoundStage,
        /// What is drawn; without a count.
        draw: IndexedIndirect,
        /// Where the counts go.
        queries: QueriesRef,
        /// The query of the first command.
        first_query: u32,
        /// What it is drawn to.
        target: Target,
    },
    /// A drawing stage without buffers; all of it counted by one occlusion query where one is named.
    Shapes {
        /// The stage.
        stage: BoundStage,
        /// What is drawn.
        shapes: Shapes,
        /// The pool, and the query in it.
        query: Option<(QueriesRef, u32)>,
        /// What it is drawn to.
        target: Target,
    },
    /// Colour to black, items to none, depth to far.
    Clear {
        /// What is cleared.
        target: Target,
    },
    /// Every word of a buffer to one value.
    Fill {
        /// The buffer.
        buffer: Bound,
        /// The value.
        value: u32,
    },
    /// One buffer's bytes to another.
    Copy {
        /// The source.
        from: Bound,
        /// The destination, at least as long.
        to: Bound,
    },
    /// All texels of an image to a buffer, row by row from the top.
    CopyImage {
        /// The source.
        from: ImageRef,
        /// What it holds.
        format: Format,
        /// Its width and height in pixels.
        size: [u32; 2],
        /// The destination, with room for all texels.
        to: Bound,
    },
    /// All texels of an image from a buffer.
    FillImage {
        /// The source, which holds all texels.
        from: Bound,
        /// The destination.
        to: ImageRef,
        /// What it holds.
        format: Format,
        /// Its width and height in pixels.
        size: [u32; 2],
    },
    /// The mean of each pixel's samples to an image of one sample.
    ResolveColour {
        /// The source.
        from: ImageRef,
        /// The destination.
        to: ImageRef,
        /// Width and height of both in pixels.
        size: [u32; 2],
    },
}

/// A step with its label and the barrier before it.
#[derive(Clone, Debug)]
pub struct Recorded {
    /// Stage name, with the part of the frame it belongs to behind a colon.
    pub label: String,
    /// The step.
    pub op: Op,
    /// The barrier before it.
    pub barrier: Option<Barrier>,
}

/// Records steps and derives the barriers between them.
#[derive(Default)]
pub struct Recorder {
    pub(crate) ops: Vec<Recorded>,
    tracker: BarrierTracker,
    part: &'static str,
    samples: Unresolved,
}

impl Recorder {
    /// Names the part of the frame that the following steps belong to ("early", "late"); "" for none.
    pub fn part(&mut self, part: &'static str) {
        self.part = part;
    }

    /// The label that a stage recorded now would get.
    pub fn label(&self, stage: &str) -> String {
        if self.part.is_empty() {
            stage.to_owned()
        } else {
            format!("{stage}:{}", self.part)
        }
    }

    /// Depths are kept with 0 near: the farthest is then the greatest.
    pub(crate) fn standard_depth(&mut self, is_standard: bool) {
        self.samples.standard_depth = is_standard;
    }

    /// Adds a step under the stage name given; before it, what makes the depths that it reads of the samples that they are of.
    pub fn push(&mut self, stage: &str, op: Op) {
        for (stage, op) in self.samples.before(&op) {
            self.add(stage, op);
        }
        self.add(stage, op);
    }

    /// Makes the colours of all targets of several samples that were drawn to.
    pub(crate) fn resolve_colours(&mut self) {
        for (stage, op) in self.samples.colours() {
            self.add(stage, op);
        }
    }

    fn add(&mut self, stage: &str, op: Op) {
        let barrier = self.tracker.next(&uses(&op));
        self.ops.push(Recorded { label: self.label(stage), op, barrier });
    }

    /// Takes what was recorded; what follows is ordered after it by the submission.
    pub(crate) fn take(&mut self) -> Vec<Recorded> {
        self.tracker.cut();
        std::mem::take(&mut self.ops)
    }

    /// The frame as text: one line a step, with each barrier and the resource that made it necessary.
    pub fn text(&self, name: impl Fn(ResourceId) -> String) -> String {
        let mut text = String::new();
        for recorded in &self.ops {
            if let Some(barrier) = &recorded.barrier {
                // Writing to a string does not fail.
                let _ = writeln!(text, "  barrier after {barrier}; for {}", name(barrier.because));
            }
            let _ = writeln!(text, "{} {}", recorded.label, describe(&recorded.op, &name));
        }
        text
    }
}

fn describe(op: &Op, name: &impl Fn(ResourceId) -> String) -> String {
    let bindings = |stage: &BoundStage| {
        let one = |(info, bound): (&shaders::BindingInfo, &Bound)| {
            format!("{}={}({:?})", info.name, name(resource(bound)), info.access)
        };
        stage.info.bindings.iter().zip(&stage.resources).map(one).collect::<Vec<_>>().join(" ")
    };
    match op {
        Op::Dispatch { stage, groups: [groups, 1] } => format!("[{groups} groups] {}", bindings(stage)),
        Op::Dispatch { stage, groups: [x, y] } => format!("[{x}x{y} groups] {}", bindings(stage)),
        Op::DispatchIndirect { stage, groups } => format!("[groups from {}] {}", name(groups.id), bindings(stage)),
        Op::Draw { stage, draw, .. } | Op::Query { stage, draw, .. } => {
            let count = draw.count.map_or(String::new(), |count| format!(" count={}", name(count.id)));
            let instances = match stage.info.instance_stride {
                0 => String::new(),
                _ => format!(" instances={}", name(resource(&draw.instances))),
            };
            format!(
                "[up to {} draws] commands={}{count}{instances} {}",
                draw.max_draws,
                name(resource(&draw.commands)),
                bindings(stage)
            )
        }
        Op::Shapes { stage, shapes, .. } => {
            format!("[{} shapes of {} corners] {}", shapes.count, shapes.corners, bindings(stage))
        }
        Op::Clear { target } => format!("depth={}", name(target.depth.id)),
        Op::Fill { buffer, value } => format!("{}={value}", name(resource(buffer))),
        Op::Copy { from, to } => format!("{} to {}", name(resource(from)), name(resource(to))),
        Op::CopyImage { from, to, .. } => format!("{} to {}", name(from.id), name(resource(to))),
        Op::FillImage { from, to, .. } => format!("{} to {}", name(resource(from)), name(to.id)),
        Op::ResolveColour { from, to, .. } => format!("{} to {}", name(from.id), name(to.id)),
    }
}

fn resource(bound: &Bound) -> ResourceId {
    match bound {
        Bound::Buffer { id, .. } => *id,
        Bound::Image(image) => image.id,
    }
}

/// Everything a step touches, from what the shader declares and what the step itself implies.
pub(crate) fn uses(op: &Op) -> Vec<Use> {
    match op {
        Op::Dispatch { stage, .. } => bindings(stage, Point::Compute),
        Op::DispatchIndirect { stage, groups } => {
            let mut uses = bindings(stage, Point::Compute);
            uses.push(Use::read(groups.id, Point::Indirect));
            uses
        }
        Op::Draw { stage, draw, target } | Op::Query { stage, draw, target, .. } => {
            let mut uses = bindings(stage, Point::Drawing);
            if stage.info.instance_stride > 0 {
                uses.push(Use::read(resource(&draw.instances), Point::Vertices));
            }
            uses.push(Use::read(resource(&draw.commands), Point::Indirect));
            uses.extend(draw.count.map(|count| Use::read(count.id, Point::Indirect)));
            uses.push(Use::read(resource(&draw.vertices), Point::Vertices));
            uses.push(Use::read(resource(&draw.indices), Point::Vertices));
            uses.extend(attachments(target));
            uses
        }
        Op::Shapes { stage, target, .. } => {
            let mut uses = bindings(stage, Point::Drawing);
            uses.extend(attachments(target));
            uses
        }
        Op::Clear { target } => attachments(target),
        Op::Fill { buffer, .. } => vec![Use::write(resource(buffer), Point::Transfer)],
        Op::Copy { from, to } => {
            vec![Use::read(resource(from), Point::Transfer), Use::write(resource(to), Point::Transfer)]
        }
        Op::CopyImage { from, to, .. } => {
            vec![Use::read(from.id, Point::Transfer), Use::write(resource(to), Point::Transfer)]
        }
        Op::FillImage { from, to, .. } => {
            vec![Use::read(resource(from), Point::Transfer), Use::write(to.id, Point::Transfer)]
        }
        Op::ResolveColour { from, to, .. } => {
            vec![Use::read(from.id, Point::Transfer), Use::write(to.id, Point::Transfer)]
        }
    }
}

fn bindings(stage: &BoundStage, point: Point) -> Vec<Use> {
    let one = |(info, bound): (&shaders::BindingInfo, &Bound)| Use {
        resource: resource(bound),
        point,
        reads: info.access != Access::Write,
        writes: info.access != Access::Read,
    };
    stage.info.bindings.iter().zip(&stage.resources).map(one).collect()
}

fn attachments(target: &Target) -> Vec<Use> {
    let depth = Use::both(target.drawn_depth().id, Point::Depth);
    let mut uses = vec![Use { writes: !target.depth_read_only, ..depth }];
    uses.extend(target.drawn_colours().map(|(image, _)| Use::both(image.id, Point::Colour)));
    uses
}

#[cfg(test)]
mod tests;
