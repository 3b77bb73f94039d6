//! `ref`: ideal culling. Draws exactly the objects that own a pixel of this frame: the physical limit of every table.

mod cache;
mod sets;

pub use cache::{load, save};
pub use sets::VisibleSets;

use crate::roc::depth_plane;
use crate::{Error, Method, OptionInfo, Result, Setup, View, World};
use engine::{Buffer, Frame, Placement, Target};
use glam::DVec3;
use shaders::types::DrawCommand;
use shaders::ResourceId;
use std::sync::Arc;

/// In which order the visible set is drawn.
pub const OPTIONS: &[OptionInfo] = &[OptionInfo {
    name: "order",
    default: "scene",
    values: "scene|near",
    help: "draw in the scene's order, or by where boxes begin along the view, near to far",
}];

struct Reference {
    visible: Arc<VisibleSets>,
    commands: Buffer<DrawCommand>,
    counts: Vec<Buffer<u32>>,
    near_to_far: bool,
    world: ResourceId,
}

/// Makes the method.
///
/// # Errors
/// A run without visible sets.
pub fn make(setup: &Setup<'_>) -> Result<Box<dyn Method>> {
    let needs = || "the visible sets of the run's frames; make them with a truth pass first".to_owned();
    let visible = setup.visible.clone().ok_or_else(|| Error::Missing { method: "ref", needs: needs() })?;
    let count = |index: usize| Buffer::new(setup.gpu, &format!("ref.total{index}"), 1, Placement::Upload);
    Ok(Box::new(Reference {
        visible,
        commands: Buffer::new(setup.gpu, "ref.commands", setup.world.len(), Placement::Upload)?,
        counts: (0..setup.world.ranges().len()).map(count).collect::<std::result::Result<_, _>>()?,
        near_to_far: setup.options.text("order") == "near",
        world: setup.world.id(),
    }))
}

impl Method for Reference {
    /// Writes the commands of the visible set: known beforehand, so not part of the frame.
    fn prepare(&mut self, world: &World, view: &View) -> Result<()> {
        assert_eq!(self.world, world.id(), "this list was made for another world: make the method again");
        let Some(visible) = self.visible.frame(view.frame) else {
            let needs = format!(
                "the visible set of frame {}, but the run's sets have {} frames",
                view.frame,
                self.visible.len()
            );
            return Err(Error::Missing { method: "ref", needs });
        };
        let mut commands = vec![DrawCommand::default(); world.len()];
        for (range, total) in world.ranges().iter().zip(&mut self.counts) {
            let objects = range.first as usize..(range.first + range.count) as usize;
            let mut drawn: Vec<usize> = objects.filter(|object| visible.contains(*object)).collect();
            if self.near_to_far {
                // Numbers of 0 and more have the order of their bits.
                drawn.sort_by_cached_key(|object| begin_of(*object, world, view).to_bits());
            }
            for (place, object) in drawn.iter().enumerate() {
                commands[range.first as usize + place] = world.command(*object as u32);
            }
            total.write(&[drawn.len() as u32])?;
        }
        self.commands.write(&commands)?;
        Ok(())
    }

    fn frame(&mut self, f: &mut Frame, world: &World, view: &View, target: &Target) -> Result<()> {
        world.update(f);
        f.clear(target);
        for (range, total) in world.ranges().iter().zip(&self.counts) {
            let commands = self.commands.all().from(range.first as usize);
            let draw = world.multi_draw(range, commands, Some(total.all()));
            world.draw_indirect(f, draw, view, target);
        }
        Ok(())
    }
}

/// Where an object's box begins, metres along the view; 0 where it reaches the eye, or that is no number.
fn begin_of(object: usize, world: &World, view: &View) -> f64 {
    let [x, y, z, w] = depth_plane(view).map(f64::from);
    let (bounds, along) = (world.host_bounds()[object], DVec3::new(x, y, z));
    let middle = along.dot(bounds.centre() - view.pose.position) + w;
    let begin = middle - along.abs().dot(bounds.half_extent());
    if begin > 0.0 {
        begin
    } else {
        0.0
    }
}
