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

/// Reads the draw lists of a finished frame, one a draw. The method that recorded it must still be as it was.
///
/// # Errors
/// A list that claims more commands than there is room for: a dropped draw must not pass for good culling.
pub fn draw_lists(gpu: &Gpu, report: &FrameReport) -> Result<Vec<Vec<DrawCommand>>> {
    let counts = report.draws.iter().filter_map(|draw| draw.count.map(Bound::from));
    let wanted: Vec<Bound> = report.draws.iter().map(|draw| draw.commands).chain(counts).collect();
    let mut read = gpu.read_bound_bytes(&wanted)?;
    let mut counts = read.split_off(report.draws.len()).into_iter();
    let mut lists = Vec::with_capacity(read.len());
    for (draw, bytes) in report.draws.iter().zip(read) {
        let count = match draw.count {
            Some(_) => bytemuck::pod_collect_to_vec::<u8, u32>(&counts.next().unwrap_or_default())
                .first()
                .copied()
                .unwrap_or(0),
            None => draw.max_draws,
        };
        if count > draw.max_draws {
            let stage = "pack/write_commands".to_owned();
            return Err(engine::Error::Overflow { stage, count, capacity: draw.max_draws }.into());
        }
        let bytes = &bytes[..(count as usize * size_of::<DrawCommand>()).min(bytes.len())];
        lists.push(bytemuck::pod_collect_to_vec(bytes));
    }
    Ok(lists)
}

/// What a finished frame drew, read back from its draw lists.
///
/// # Errors
/// As [`draw_lists`].
pub fn drawn_objects(gpu: &Gpu, world: &World, report: &FrameReport) -> Result<Drawn> {
    Ok(drawn_by(world, report, &draw_lists(gpu, report)?))
}

/// What a frame drew whose draw lists are these.
pub fn drawn_by(world: &World, report: &FrameReport, lists: &[Vec<DrawCommand>]) -> Drawn {
    let mut drawn = Drawn { objects: vec![false; world.total()], ..Drawn::default() };
    for (draw, commands) in report.draws.iter().zip(lists) {
        for command in commands.iter().filter(|command| command.instance_count > 0) {
            if let Some(object) = drawn.objects.get_mut(command.first_instance as usize) {
                *object = true;
            }
            drawn.draws += 1;
            if draw.primitives == engine::Primitives::Triangles {
                drawn.triangles += u64::from(command.index_count / 3);
            }
        }
    }
    drawn
}
