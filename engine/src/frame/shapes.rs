//! Drawings that the vertex shader makes of numbers alone. They show no object, and no command of theirs lies on the GPU: they may follow
//! draws that count.

use super::{Frame, Queried};
use crate::recorder::{Op, QueriesRef, Shapes};
use crate::target::Target;
use shaders::GraphicsStage;

impl Frame {
    /// Draws shapes to the target, with depth test. Not among the report's draws.
    pub fn draw_shapes<S: GraphicsStage>(&mut self, stage: S, shapes: Shapes, target: &Target) {
        self.shapes(stage, shapes, None, target);
    }

    /// The same, counted by the query: how many samples pass the depth test.
    ///
    /// # Panics
    /// If the pool has no such query.
    pub fn query_shapes<S: GraphicsStage>(&mut self, stage: S, shapes: Shapes, queried: Queried<'_>, target: &Target) {
        let Queried { queries, first } = queried;
        assert!(first < queries.len(), "{}: query {first} of {}", S::INFO.name, queries.len());
        self.shapes(stage, shapes, Some((QueriesRef { raw: queries.raw() }, first)), target);
    }

    fn shapes<S: GraphicsStage>(
        &mut self,
        stage: S,
        shapes: Shapes,
        query: Option<(QueriesRef, u32)>,
        target: &Target,
    ) {
        assert_eq!([S::INFO.vertex_stride, S::INFO.instance_stride], [0; 2], "{}: it reads vertices", S::INFO.name);
        self.recorder.push(S::INFO.name, Op::Shapes { stage: stage.bind(), shapes, query, target: *target });
    }
}
