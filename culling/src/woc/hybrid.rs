//! The hybrid occlusion query (Kim 2015, IV.2): an image-space test sees too much, which is dear where an object is. So the
//! costliest of those it leaves visible must prove by their box, against the depth of all others, that they show.

use crate::boxes::BoxList;
use crate::pack::DrawList;
use crate::world::Still;
use crate::{Result, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Primitives, Target};
use shaders::{roc, woc, BufferRef, Stage};

const PART: &str = "hybrid";

/// Tests candidates by their boxes.
pub(super) struct Hybrid {
    candidates: Buffer<u32>,
    boxes: BoxList,
    rest: Buffer<u32>,
    shown: Buffer<u32>,
    list: DrawList,
}

/// The `most` objects of more than `triangles` triangles that have the most, by object; those that can move are among them.
pub(super) fn candidates(world: &World, most: u32, triangles: u32) -> Vec<u32> {
    let of_triangles = world.ranges().iter().filter(|range| range.primitives == Primitives::Triangles);
    let objects = of_triangles.flat_map(|range| range.first..range.first + range.count);
    let triangles_of = |object: &u32| world.index_count(*object) / 3;
    let mut costly: Vec<u32> = objects.filter(|object| triangles_of(object) > triangles).collect();
    costly.sort_by_key(|object| std::cmp::Reverse(triangles_of(object)));
    costly.truncate(most as usize);
    costly.sort_unstable();
    costly
}

impl Hybrid {
    /// Tests `candidates`, of which there must be one.
    pub(super) fn new(gpu: &Gpu, world: &World, candidates: &[u32]) -> Result<Self> {
        Ok(Hybrid {
            candidates: Buffer::with_data(gpu, "woc.candidates", candidates, Placement::Storage)?,
            boxes: BoxList::new(gpu, "woc.boxes", candidates.len())?,
            rest: Buffer::new(gpu, "woc.hybrid_rest", world.len(), Placement::Storage)?,
            shown: Buffer::new(gpu, "woc.hybrid_shown", world.len(), Placement::Storage)?,
            list: DrawList::new(gpu, "woc.hybrid_list", world)?,
        })
    }

    /// Takes the candidates that are to be tested out of what is to be drawn. Gives the rest.
    pub(super) fn hold(
        &mut self,
        f: &mut Frame,
        world: &World,
        view: &View,
        shown: BufferRef<u32>,
    ) -> Result<BufferRef<u32>> {
        self.boxes.look(view)?;
        let rest = self.rest.all();
        f.copy("woc/copy_shown", shown, rest);
        let stage = woc::HoldCandidates {
            candidates: self.candidates.all(),
            bounds: world.bounds(),
            shown: rest,
            listed: self.boxes.listed(),
            command: self.boxes.command(),
            view: view.cull(),
            candidate_count: self.candidates.len() as u32,
        };
        f.dispatch(stage, 1);
        Ok(rest)
    }

    /// Tests the boxes of those held against the depth of all that was drawn, and draws what shows.
    pub(super) fn draw_shown(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        f.part(PART);
        f.fill("woc/clear_shown", &self.shown, 0);
        let test = roc::TestBoxes {
            bounds: world.bounds(),
            listed: self.boxes.listed(),
            views: self.boxes.view(),
            newly: self.shown.all(),
        };
        f.test_boxes(test, self.boxes.draw(), &target.test_only());
        self.list.pack(f, world, self.shown.all());
        world.draw(f, &self.list, view, target);
        f.part("");
    }

    /// What the boxes let through.
    pub(super) fn list(&self) -> &DrawList {
        &self.list
    }

    /// Boxes that the last frame tested.
    pub(super) fn read_boxes(&self) -> Result<Vec<u32>> {
        self.boxes.read_listed()
    }

    /// Camera and objects unchanged: the list holds.
    pub(super) fn same_again(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        f.part(PART);
        f.skip(roc::TestBoxes::INFO.name, Still::REASON);
        self.list.skip_packing(f, Still::REASON);
        world.draw(f, &self.list, view, target);
        f.part("");
    }

    /// Notes that no object is costly enough.
    pub(super) fn skip(f: &mut Frame, reason: &'static str) {
        f.skip(woc::HoldCandidates::INFO.name, reason);
        f.part(PART);
        f.skip(roc::TestBoxes::INFO.name, reason);
        f.part("");
    }
}
