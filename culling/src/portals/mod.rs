//! `portals`: cells and portals (Zachmann 2008; Luebke & Georges 1995). The scene names its cells and the openings between them
//! ([`scenes::Cells`]). Whoever is in a cell sees what is in other cells through portals alone: through those of the cell, through
//! those of the next cell that lie in the picture of these, and so on. An object is drawn if it reaches into a seen cell, and its
//! picture into that of the portals that the cell is seen through.
//!
//! Nothing is asked of the device. Where the scene's promise does not help (the eye is at a wall, or in it, or walls are
//! thinner than a pixel's error), everything in the view volume is drawn.

pub mod sight;
mod walls;

use crate::frustum::twin::{clip_from_bounds, left_out};
use crate::pack::DrawList;
use crate::world::{gpu_bounds, Still};
use crate::{Error, Method, OptionInfo, Result, Setup, View, World};
use engine::{Buffer, Frame, Placement, Target};
use glam::DAffine3;
use scenes::{Aabb, Cells};
use shaders::types::{Bounds, OBJECT_ALWAYS_KEPT, OBJECT_WIDE_RASTER};
use sight::{start, Rectangle, Sight, Start};
use walls::is_closed;

/// What small things are, and whether a still frame is looked at again.
pub const OPTIONS: &[OptionInfo] = &[crate::world::SKIP_OPTION, crate::world::DETAIL_OPTION];

/// What a scene lacks that `portals` refuses.
pub const NEEDS: &str =
    "cells: a scene that names its rooms and the openings between them, such as rooms, or a glTF file with the extras that \
     scenes/README.md shows; use frustum here";

/// By cell, and last outside of all: where in the picture it is seen, if it is. An error is why everything may be.
pub type Pictures = std::result::Result<Vec<Option<Rectangle>>, &'static str>;

/// Frames of which is remembered what was seen.
const MOST_LOGGED: usize = 1 << 16;

struct Portals {
    cells: Cells,
    /// By cell: the objects that reach into it and stay; last, those that reach out of all.
    members: Vec<Vec<u32>>,
    flags: Vec<u32>,
    kept: Buffer<u32>,
    list: DrawList,
    still: Still,
    seen: Vec<String>,
}

/// Makes the method.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let (gpu, world) = (setup.gpu, setup.world);
    let Some(cells) = world.cells() else {
        return Err(Error::Missing { method: "portals", needs: NEEDS.to_owned() });
    };
    Ok(Box::new(Portals {
        members: members(world, cells),
        cells: cells.clone(),
        flags: world.read_bounds()?.iter().map(|bounds| bounds.flags).collect(),
        kept: Buffer::new(gpu, "portals.kept", world.len(), Placement::Upload)?,
        list: DrawList::new(gpu, "portals.list", world)?,
        still: Still::new(setup.options),
        seen: Vec::new(),
    }))
}

impl Method for Portals {
    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        if self.still.holds(world, view) {
            self.list.skip_packing(f, Still::REASON);
        } else {
            let pictures = seen(&self.cells, view); // 1. which cells are seen, and where in the picture
            self.note(view, &pictures);
            let kept = self.kept(world, view, &pictures); // 2. what is in them, and shows there
            self.kept.write(&kept)?;
            self.list.pack(f, world, self.kept.all()); // 3. in object order
        }
        world.draw(f, &self.list, view, target); // 4. draw it
        Ok(())
    }

    fn choices(&self) -> Vec<String> {
        self.seen.clone()
    }

    fn forget(&mut self) -> Result<()> {
        self.still.forget();
        Ok(())
    }
}

impl Portals {
    fn note(&mut self, view: &View, pictures: &Pictures) {
        if self.seen.len() >= MOST_LOGGED {
            return;
        }
        let all = self.cells.cells.len();
        self.seen.push(match pictures {
            Ok(pictures) => {
                let seen = pictures[..all].iter().flatten().count();
                format!("frame {}: {seen} of {all} cells are seen", view.frame)
            }
            Err(reason) => format!("frame {}: all {all} cells may be seen: {reason}", view.frame),
        });
    }

    fn kept(&self, world: &World, view: &View, pictures: &Pictures) -> Vec<u32> {
        let mut kept = vec![0; world.len()];
        let mut show = |object: u32, picture: &Rectangle| {
            let index = object as usize;
            kept[index] |=
                u32::from(kept[index] == 0 && shows(&world.host_bounds()[index], self.flags[index], view, picture));
        };
        let Ok(pictures) = pictures else {
            let whole = Rectangle::whole(view);
            (0..world.len() as u32).for_each(|object| show(object, &whole));
            return kept;
        };
        for (cell, picture) in pictures.iter().enumerate() {
            let Some(picture) = picture else { continue };
            self.members[cell].iter().for_each(|object| show(*object, picture));
            world
                .moving()
                .filter(|(object, _)| is_member(&self.cells, cell, &world.host_bounds()[*object as usize]))
                .for_each(|(object, _)| show(object, picture));
        }
        // What has no bounds may be anywhere.
        for (kept, flags) in kept.iter_mut().zip(&self.flags) {
            *kept |= u32::from(flags & OBJECT_ALWAYS_KEPT != 0);
        }
        kept
    }
}

/// Which cells are seen, and where.
pub fn seen(cells: &Cells, view: &View) -> Pictures {
    let first = match start(cells, view) {
        Start::In(first) => first,
        Start::Anywhere(reason) => return Err(reason),
    };
    let mut sight = Sight::new(cells, view);
    sight.look(&first);
    let outside = cells.cells.len();
    let looked_at = |cell: usize| sight.pictures[cell].is_some() || sight.pictures[outside].is_some();
    if (0..outside).filter(|cell| looked_at(*cell)).all(|cell| is_closed(cells, cell, view)) {
        Ok(sight.pictures)
    } else {
        Err("walls are thinner than what a pixel may be off")
    }
}

/// True if an object is in view, and its picture reaches into a rectangle of it.
fn shows(bounds: &Aabb, flags: u32, view: &View, picture: &Rectangle) -> bool {
    let box_: Bounds = gpu_bounds(bounds, &DAffine3::IDENTITY, flags);
    if box_.flags & OBJECT_ALWAYS_KEPT != 0 {
        return true;
    }
    let cull = view.cull();
    if left_out(&clip_from_bounds(&box_, &cull), box_.flags, &cull) {
        return false;
    }
    let wide = if flags & OBJECT_WIDE_RASTER != 0 { 1.0 } else { 0.0 };
    Rectangle::around(bounds, view, 1.0 + wide).is_none_or(|around| around.meets(picture))
}

/// The objects that stay where they are, by the cells that they reach into.
fn members(world: &World, cells: &Cells) -> Vec<Vec<u32>> {
    let moving: std::collections::HashSet<u32> = world.moving().map(|(object, _)| object).collect();
    let stay = |object: &u32| !moving.contains(object);
    let of_cell = |cell: usize| {
        let objects = (0..world.len() as u32).filter(stay);
        objects.filter(|object| is_member(cells, cell, &world.host_bounds()[*object as usize])).collect()
    };
    (0..=cells.cells.len()).map(of_cell).collect()
}

/// True if something with these bounds reaches into a cell; the last is all that is in none.
fn is_member(cells: &Cells, cell: usize, bounds: &Aabb) -> bool {
    match cells.cells.get(cell) {
        Some(cell) => cell.bounds.min.cmple(bounds.max).all() && bounds.min.cmple(cell.bounds.max).all(),
        // What is in two cells and their wall counts as outside too: that draws more, where outside is seen.
        None => !cells.cells.iter().any(|cell| cell.bounds.contains(bounds.min) && cell.bounds.contains(bounds.max)),
    }
}
