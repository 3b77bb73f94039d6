//! `roc` with one defect.

use super::{caught, caught_at_a_size, caught_by, coarse, edit, laws, worlds, Make};
use culling::boxes::{box_view, BoxList};
use culling::{DrawList, Method, Setup, View, World};
use engine::{Buffer, Format, Frame, Gpu, Image, Placement, Target};
use shaders::roc;
use shaders::types::{Bounds, BoxView, OBJECT_WIDE_RASTER};

/// What is wrong with the method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Defect {
    Nothing,
    /// A box passes only where nothing was drawn at all: what a depth test the wrong way round leaves of hidden boxes.
    DepthTestAgainstFar,
    /// Boxes are tested against the depth of the frame before.
    StaleDepth,
    FarFaces,
    ShrunkBoxes,
    /// Boxes of lines and points are not widened by the pixel that those cover.
    NarrowBoxes,
    /// Boxes that reach the near plane are rasterised instead of kept.
    NearCrossingTested,
    /// What has come into view loses one flag.
    DroppedFlag,
    NoLateDraw,
    /// What has come into view is not remembered.
    NewlyForgotten,
}

struct Broken {
    defect: Defect,
    gpu: Gpu,
    visible: [Buffer<u32>; 2],
    newly: Buffer<u32>,
    boxes: Buffer<u32>,
    bounds: Buffer<Bounds>,
    views: Buffer<BoxView>,
    box_list: BoxList,
    lists: [DrawList; 2],
    stale: Option<Image>,
    now: usize,
}

fn make(setup: &Setup<'_>, defect: Defect) -> culling::Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let flags = |name: &str| Buffer::new(gpu, name, world.len(), Placement::Storage);
    let mut bounds = world.read_bounds()?;
    for bound in &mut bounds {
        match defect {
            Defect::ShrunkBoxes => bound.half_extent = bound.half_extent.map(|half| 0.5 * half),
            Defect::NarrowBoxes if bound.flags & OBJECT_WIDE_RASTER != 0 => {
                bound.flags &= !OBJECT_WIDE_RASTER;
                bound.half_extent = bound.half_extent.map(|half| coarse(gpu, 0.05) * half);
            }
            _ => (),
        }
    }
    Ok(Box::new(Broken {
        defect,
        gpu: gpu.clone(),
        visible: [flags("broken.visible_even")?, flags("broken.visible_odd")?],
        newly: flags("broken.newly")?,
        boxes: flags("broken.boxes")?,
        bounds: Buffer::with_data(gpu, "broken.bounds", &bounds, Placement::Storage)?,
        views: Buffer::new(gpu, "broken.views", 1, Placement::Upload)?,
        box_list: BoxList::new(gpu, "broken.box_list", world.len())?,
        lists: [DrawList::new(gpu, "broken.early", world)?, DrawList::new(gpu, "broken.late", world)?],
        stale: None,
        now: 0,
    }))
}

/// `culling::roc` as it is, but for the defect.
impl Method for Broken {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        world.update(f);
        f.clear(target);
        self.now = 1 - self.now;
        self.views.write(&[self.looks(view)])?;
        f.fill("roc/clear_flags", &self.visible[self.now], 0);
        self.lists[0].pack(f, world, self.visible[1 - self.now].all());
        world.draw_flagged(f, &self.lists[0], self.visible[self.now].all(), view, target);
        let select = roc::SelectBoxes {
            bounds: world.bounds(),
            drawn: self.visible[1 - self.now].all(),
            boxes: self.boxes.all(),
            newly: self.newly.all(),
            view: view.cull(),
            object_count: world.len() as u32,
        };
        f.dispatch(select, world.len() as u32);
        if self.defect == Defect::NearCrossingTested {
            let kept = f.read(&self.newly)?;
            edit(f, &mut self.boxes, |boxes| boxes.iter_mut().zip(&kept).for_each(|(tested, kept)| *tested |= kept))?;
            edit(f, &mut self.newly, |newly| newly.fill(0))?;
        }
        self.box_list.pack(f, world, self.boxes.all());
        self.test(f, target)?;
        if self.defect == Defect::DroppedFlag {
            edit(f, &mut self.newly, |newly| {
                newly.iter_mut().filter(|flag| **flag != 0).take(1).for_each(|flag| *flag = 0)
            })?;
        }
        self.lists[1].pack(f, world, self.newly.all());
        match self.defect {
            Defect::NoLateDraw => (),
            Defect::NewlyForgotten => world.draw(f, &self.lists[1], view, target),
            _ => world.draw_flagged(f, &self.lists[1], self.visible[self.now].all(), view, target),
        }
        self.keep_depth(f, world, view, target)
    }

    fn forget(&mut self) -> culling::Result<()> {
        self.visible.iter_mut().try_for_each(|flags| Ok(flags.write(&vec![0; flags.len()])?))
    }
}

impl Broken {
    fn looks(&self, view: &View) -> BoxView {
        let mut looks = box_view(view);
        match self.defect {
            Defect::FarFaces => looks.eye = looks.eye.map(|part| -part),
            Defect::DepthTestAgainstFar => {
                looks.view.clip_from_relative.iter_mut().for_each(|column| column[2] = 0.0);
            }
            _ => (),
        }
        looks
    }

    fn test(&mut self, f: &mut Frame, target: &Target) -> culling::Result<()> {
        let test = roc::TestBoxes {
            bounds: self.bounds.all(),
            listed: self.box_list.listed(),
            views: self.views.all(),
            newly: self.newly.all(),
        };
        let against = match &self.stale {
            Some(stale) => Target { depth: stale.view(), ..*target },
            None => *target,
        };
        f.test_boxes(test, self.box_list.draw(), &against.test_only());
        Ok(())
    }

    /// Draws the frame's depth once more, to be the next frame's.
    fn keep_depth(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> culling::Result<()> {
        if self.defect != Defect::StaleDepth {
            return Ok(());
        }
        f.submit_and_wait()?;
        let depth = Image::new(&self.gpu, "broken.depth", Format::Depth, target.size)?;
        let kept = Target { depth: depth.view(), item: None, ..*target };
        let colour = Image::new(&self.gpu, "broken.colour", Format::Colour, target.size)?;
        let kept = Target { colour: Some((colour.view(), Format::Colour)), ..kept };
        let mut extra = self.gpu.frame();
        extra.clear(&kept);
        world.draw_all(&mut extra, view, &kept);
        extra.finish()?;
        self.stale = Some(depth);
        Ok(())
    }
}

const SOUND: Make = |setup| make(setup, Defect::Nothing);

#[test]
fn a_depth_test_against_the_far_plane_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::DepthTestAgainstFar)], &worlds::walled(150));
}

#[test]
fn a_stale_depth_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::StaleDepth)], &worlds::walled(150));
}

#[test]
fn far_faces_of_boxes_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::FarFaces)], &worlds::special::sunk());
}

#[test]
fn boxes_that_are_too_small_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::ShrunkBoxes)], &worlds::walled(150));
}

#[test]
fn boxes_too_narrow_for_lines_and_points_are_noticed() {
    let sizes = [[161, 97], [320, 193], [640, 386]];
    caught_at_a_size([SOUND, |setup| make(setup, Defect::NarrowBoxes)], &worlds::special::topologies(), sizes);
}

#[test]
fn boxes_at_the_near_plane_that_are_not_kept_are_noticed() {
    caught([SOUND, |setup| make(setup, Defect::NearCrossingTested)], &worlds::special::stepping_into_boxes());
}

#[test]
fn a_dropped_flag_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::DroppedFlag)], &worlds::walled(150));
}

#[test]
fn a_missing_late_draw_is_noticed() {
    caught([SOUND, |setup| make(setup, Defect::NoLateDraw)], &worlds::walled(150));
}

#[test]
fn forgetting_what_came_into_view_is_noticed() {
    let makes: [Make; 2] = [SOUND, |setup| make(setup, Defect::NewlyForgotten)];
    caught_by(laws::what_a_wall_hides_is_culled, makes, &worlds::walled(400), "too many");
}
