//! What is drawn with which stage: by what the target holds, what the surface does, and what is asked of the fragments.

use super::{Range, View, World};
use engine::{Frame, IndexedIndirect, Queried, Surface, Target};
use shaders::types::DrawCommand;
use shaders::{draw, BufferRef, GraphicsStage, Stage};

impl World {
    /// The multi-draw of commands for objects of a range: as many as `count` says, or all.
    pub(crate) fn multi_draw(
        &self,
        range: &Range,
        commands: BufferRef<DrawCommand>,
        count: Option<BufferRef<u32>>,
    ) -> IndexedIndirect {
        IndexedIndirect {
            vertices: self.vertices.all().into(),
            instances: self.objects.all().into(),
            indices: self.indices.all().into(),
            commands: commands.into(),
            count,
            max_draws: range.count,
            primitives: range.primitives,
            faces: range.faces,
            surface: range.surface,
        }
    }

    /// Draws every object but the translucent ones.
    pub fn draw_all(&self, f: &mut Frame, view: &View, target: &Target) {
        self.draw_commands(f, self.all_commands.all(), view, target);
    }

    /// Draws from a command for each object, in object order; a command of no instances draws nothing.
    pub fn draw_commands(&self, f: &mut Frame, commands: BufferRef<DrawCommand>, view: &View, target: &Target) {
        if self.is_empty() {
            f.skip(draw::Objects::INFO.name, "no objects");
        }
        for range in &self.ranges {
            let draw = self.multi_draw(range, commands.from(range.first as usize), None);
            self.draw_indirect(f, draw, view, target);
        }
    }

    /// Draws the lists of a finished frame once more, in the same order. They must still be as they were.
    pub fn draw_again(&self, f: &mut Frame, draws: &[IndexedIndirect], view: &View, target: &Target) {
        for draw in draws {
            self.draw_indirect(f, *draw, view, target);
        }
    }

    pub(crate) fn draw_indirect(&self, f: &mut Frame, draw: IndexedIndirect, view: &View, target: &Target) {
        self.draw_or_query(f, (draw, None), view, target);
    }

    /// The same, each command counted by a query.
    pub(crate) fn query_indirect(
        &self,
        f: &mut Frame,
        draw: IndexedIndirect,
        queried: Queried<'_>,
        view: &View,
        target: &Target,
    ) {
        self.draw_or_query(f, (draw, Some(queried)), view, target);
    }

    fn draw_or_query(&self, f: &mut Frame, (draw, queried): MaybeQueried<'_>, view: &View, target: &Target) {
        let (draw, target) = self.prepared(draw, target);
        // A target that holds counts is an overdraw picture: the same draws, counted instead of shaded.
        if matches!(target.colour, Some((_, engine::Format::Heat))) {
            self.draw_counted(f, (draw, queried), view, &target);
        } else if matches!(target.colour, Some((_, engine::Format::Owner))) {
            // What is translucent owns nothing.
            if draw.surface == Surface::Opaque {
                record(f, draw::Owners { view: view.gpu() }, (draw, queried), &target);
            }
        } else if let Some(detail) = &self.detail {
            detail.draw(f, (draw, queried), view, &target);
        } else if target.item.is_some() {
            record(f, draw::ObjectsAndItems { view: view.gpu() }, (draw, queried), &target);
        } else {
            record(f, draw::Objects { view: view.gpu() }, (draw, queried), &target);
        }
    }

    /// The same, and sets the flag of each object of which a fragment passes the tests.
    pub(crate) fn draw_indirect_flagged(
        &self,
        f: &mut Frame,
        draw: IndexedIndirect,
        visible: BufferRef<u32>,
        view: &View,
        target: &Target,
    ) {
        let (draw, target) = self.prepared(draw, target);
        if let Some(detail) = &self.detail {
            detail.draw_flagged(f, draw, visible, view, &target);
        } else if target.item.is_some() {
            f.draw(draw::ObjectsItemsAndFlags { visible, view: view.gpu() }, draw, &target);
        } else {
            f.draw(draw::ObjectsAndFlags { visible, view: view.gpu() }, draw, &target);
        }
    }

    fn draw_counted(&self, f: &mut Frame, draw: MaybeQueried<'_>, view: &View, target: &Target) {
        match &self.detail {
            Some(detail) if draw.0.surface == Surface::Masked => detail.draw_counted(f, draw, view, target),
            _ => record(f, draw::Overdraw { view: view.gpu() }, draw, target),
        }
    }

    /// A draw, maybe of an earlier frame, with plain vertices; and what translucent objects are drawn to: they own no pixel and
    /// write no depth.
    fn prepared(&self, draw: IndexedIndirect, target: &Target) -> (IndexedIndirect, Target) {
        let target = match draw.surface {
            Surface::Translucent | Surface::Light => Target { item: None, depth_read_only: true, ..*target },
            Surface::Opaque | Surface::Masked => *target,
        };
        (IndexedIndirect { vertices: self.vertices.all().into(), ..draw }, target)
    }
}

/// A draw, and where the results of its commands' queries go, if they are counted.
pub(super) type MaybeQueried<'a> = (IndexedIndirect, Option<Queried<'a>>);

/// Draws with a stage.
pub(super) fn record<S: GraphicsStage>(f: &mut Frame, stage: S, (draw, queried): MaybeQueried<'_>, target: &Target) {
    match queried {
        None => f.draw(stage, draw, target),
        Some(queried) => f.query_objects(stage, draw, queried, target),
    }
}
