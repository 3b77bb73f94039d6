//! Rapid objects (Kim 2015, IV.1): what moves so fast that warping may fail for it is drawn first, and its real depth takes
//! the place of its warped one.

use crate::pack::DrawList;
use crate::world::Still;
use crate::{Result, View, World};
use engine::{Buffer, Frame, Gpu, Placement, Target};
use shaders::types::{Bounds, CullView, RAPID_INVOCATIONS};
use shaders::{draw, woc, BufferRef, Stage};

const PART: &str = "rapid";

/// Finds and draws them.
pub(super) struct Rapid {
    /// How far an object must have moved in the canonical view volume.
    threshold: f32,
    flags: Buffer<u32>,
    remaining: Buffer<u32>,
    list: DrawList,
    views: Buffer<CullView>,
    last: Option<CullView>,
    /// Where moving objects were; none if nothing moves.
    bounds_before: Option<Buffer<Bounds>>,
    drawn: Option<Buffer<f32>>,
}

impl Rapid {
    pub(super) fn new(gpu: &Gpu, world: &World, threshold: f32) -> Result<Self> {
        let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
        let before = || Buffer::new(gpu, "woc.bounds_before", world.len(), Placement::Storage);
        Ok(Rapid {
            threshold,
            flags: flags("woc.rapid")?,
            remaining: flags("woc.remaining")?,
            list: DrawList::new(gpu, "woc.rapid_list", world)?,
            views: Buffer::new(gpu, "woc.views", 2, Placement::Upload)?,
            last: None,
            bounds_before: (world.moving().len() > 0).then(before).transpose()?,
            drawn: None,
        })
    }

    /// Draws those of the objects in `kept` that are rapid and that the last frame drew: those of its `lists`, and the rapid
    /// ones of then. With no last frame none is. Gives the depth drawn so far, by pixel.
    pub(super) fn draw_first(
        &mut self,
        f: &mut Frame,
        gpu: &Gpu,
        world: &World,
        view: &View,
        target: &Target,
        (kept, lists): (BufferRef<u32>, &[&DrawList]),
    ) -> Result<BufferRef<f32>> {
        f.part(PART);
        f.fill("woc/clear_rapid", &self.flags, 0);
        if let Some(last) = self.last {
            self.views.write(&[last, view.cull()])?;
            self.find(f, world, kept, &self.list);
            lists.iter().for_each(|list| self.find(f, world, kept, list));
        }
        self.list.pack(f, world, self.flags.all());
        world.draw(f, &self.list, view, target);
        let pixels = target.size.iter().product::<u32>() as usize;
        let drawn = match self.drawn.take().filter(|drawn| drawn.len() == pixels) {
            Some(drawn) => drawn,
            None => Buffer::new(gpu, "woc.drawn", pixels, Placement::Storage)?,
        };
        f.copy_depth("woc/copy_depth", target, &drawn);
        f.part("");
        Ok(self.drawn.insert(drawn).all())
    }

    fn find(&self, f: &mut Frame, world: &World, kept: BufferRef<u32>, list: &DrawList) {
        for (first_command, count) in list.counts(world) {
            let stage = woc::FindRapid {
                commands: list.commands(),
                count,
                kept,
                bounds_before: self.bounds_before.as_ref().map_or(world.bounds(), Buffer::all),
                bounds_now: world.bounds(),
                views: self.views.all(),
                rapid: self.flags.all(),
                threshold: self.threshold,
                first_command,
            };
            f.dispatch(stage, RAPID_INVOCATIONS);
        }
    }

    /// Takes what was drawn first out of what is to be drawn, and adds it to `visible`. Gives the rest.
    pub(super) fn leave(&self, f: &mut Frame, world: &World, visible: BufferRef<u32>) -> BufferRef<u32> {
        let (remaining, object_count) = (self.remaining.all(), world.len() as u32);
        f.dispatch(woc::LeaveRapid { rapid: self.flags.all(), visible, remaining, object_count }, object_count);
        remaining
    }

    /// Keeps the view, and where moving objects are.
    pub(super) fn keep(&mut self, f: &mut Frame, world: &World, view: &View) {
        self.last = Some(view.cull());
        match &self.bounds_before {
            Some(before) => f.copy("woc/keep_bounds", world.bounds(), before.all()),
            None => f.skip("woc/keep_bounds", "no dynamic objects"),
        }
    }

    /// Forgets the last frame.
    pub(super) fn forget(&mut self) {
        self.last = None;
    }

    /// Camera and objects unchanged: the list, which has long been empty, holds.
    pub(super) fn same_again(&self, f: &mut Frame, world: &World, view: &View, target: &Target) {
        f.part(PART);
        f.skip(woc::FindRapid::INFO.name, Still::REASON);
        self.list.skip_packing(f, Still::REASON);
        world.draw(f, &self.list, view, target);
        f.part("");
        f.skip(woc::LeaveRapid::INFO.name, Still::REASON);
    }

    /// Notes that no object is drawn first.
    pub(super) fn skip(f: &mut Frame, reason: &'static str) {
        f.part(PART);
        for stage in [woc::FindRapid::INFO, draw::Objects::INFO] {
            f.skip(stage.name, reason);
        }
        f.part("");
        f.skip(woc::LeaveRapid::INFO.name, reason);
    }
}
