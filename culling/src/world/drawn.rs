//! What a frame drew, read back from its own draw lists.

use crate::world::World;
use crate::Result;
use engine::{FrameReport, Gpu};
use shaders::types::DrawCommand;
use shaders::Bound;

/// What a frame drew.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Drawn {
    /// By object: it was in at least one draw list.
    pub objects: Vec<bool>,
    /// Commands with an instance.
    pub draws: u64,
    /// Triangles of those commands; lines and points count none.
    pub triangles: u64,
}

/// Reads the draw lists of a finished frame. The method that recorded it must still be as it was.
///
/// # Errors
/// A list that claims more commands than there is room for: a dropped draw must not pass for good culling.
pub fn drawn_objects(gpu: &Gpu, world: &World, report: &FrameReport) -> Result<Drawn> {
    let mut drawn = Drawn { objects: vec![false; world.total()], ..Drawn::default() };
    for draw in &report.draws {
        let count = match draw.count {
            Some(count) => gpu.read_bound::<u32>(&Bound::from(count))?.first().copied().unwrap_or(0),
            None => draw.max_draws,
        };
        if count > draw.max_draws {
            let stage = "pack/write_commands".to_owned();
            return Err(engine::Error::Overflow { stage, count, capacity: draw.max_draws }.into());
        }
        let commands = gpu.read_bound::<DrawCommand>(&draw.commands)?;
        for command in commands.iter().take(count as usize).filter(|command| command.instance_count > 0) {
            if let Some(object) = drawn.objects.get_mut(command.first_instance as usize) {
                *object = true;
            }
            drawn.draws += 1;
            if draw.primitives == engine::Primitives::Triangles {
                drawn.triangles += u64::from(command.index_count / 3);
            }
        }
    }
    Ok(drawn)
}
